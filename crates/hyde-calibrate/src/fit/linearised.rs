//! Innovations and how they change with parameters: what least squares follow and scans are made of.
//!
//! Tangents are errors of the states along one run ([`changes`]). Differences are taken over a small part of what the
//! data tell about a parameter, each an observer's run of its own: all of them, and all records, at the same time.

use super::least_squares::Problem;
use super::varied::Varied;
use crate::observer::{Direction, Innovations, Own, Track, changes};
use crate::plant::{Unsupported, past_differs};
use crate::records::Recording;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

/// Differences of runs are taken over this part of a parameter's scale, those of kernels over this one.
const DIFFERENCE: f64 = 0.1;
const SMALL: f64 = 1e-4;
/// Parameters that one run is differentiated by.
const AT_ONCE: usize = 16;

/// How innovations are differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Slopes {
    /// Along one run, guards taken to act when they do.
    Tangents,
    /// By differences of runs.
    Differences,
}

/// Innovations and their derivatives, record by record.
pub(crate) struct Linearised {
    pub(crate) innovations: Vec<Innovations>,
    /// Of each record: a column a parameter, in units of its scale, channels below each other.
    pub(crate) derivatives: Vec<DMatrix<f64>>,
}

impl Problem<'_> {
    /// How whitened innovations change with each parameter, a unit its scale, along one run: what fits follow and scans are
    /// made of. Records, channels and rows one behind the other, as in [`Innovations`].
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn derivatives(&self, values: &[f64]) -> Result<Vec<Vec<f64>>, Unsupported> {
        let found = self.linearise(values, Slopes::Tangents)?.derivatives;
        let of = |number: usize| -> Vec<f64> {
            let columns = found.iter().map(|own| own.column(number));
            columns
                .flat_map(|own| own.iter().copied().collect::<Vec<_>>())
                .collect()
        };
        Ok((0..self.varied.len()).map(of).collect())
    }

    /// Innovations and their derivatives: by tangents along one run, or by differences of runs.
    pub(crate) fn linearise(
        &self,
        values: &[f64],
        slopes: Slopes,
    ) -> Result<Linearised, Unsupported> {
        match slopes {
            Slopes::Tangents if !self.varied.is_empty() => {
                let set = self.settings(values);
                let tracks = Track::all(self.program, self.recordings, self.observer, &set)?;
                self.linearise_on(&tracks, values)
            }
            Slopes::Tangents | Slopes::Differences => self.by_differences(values),
        }
    }

    /// The same by tangents, where the tracks of the records with these values are known.
    pub(crate) fn linearise_on(
        &self,
        tracks: &[Track<'_>],
        values: &[f64],
    ) -> Result<Linearised, Unsupported> {
        let set = self.settings(values);
        let direction = |recording: &Recording, number: usize| {
            let varied = &self.varied[number];
            let step = difference(varied, values[number], SMALL);
            let mut set = set.clone();
            set.push((varied.place, values[number] + step));
            Direction {
                p: recording.parameters(self.program, &set),
                step: step / varied.scale(),
            }
        };
        // What is delayed arrives at other instants: no kernel tells what that does.
        let first = self.recordings.first();
        let first = first.filter(|_| !self.program.delays.is_empty());
        let own = first.map(|first| (first, first.parameters(self.program, &set)));
        let delays = |&number: &usize| {
            own.as_ref().is_some_and(|(first, p)| {
                past_differs(self.program, p, &direction(first, number).p)
            })
        };
        let (late, along): (Vec<usize>, Vec<usize>) = (0..self.varied.len()).partition(delays);
        if along.is_empty() {
            return self.by_differences(values);
        }
        let p: Vec<Vec<f64>> = self
            .recordings
            .iter()
            .map(|recording| recording.parameters(self.program, &set))
            .collect();
        let parts: Vec<&[usize]> = along.chunks(AT_ONCE).collect();
        let looks: Vec<(usize, &[usize])> = (0..self.recordings.len())
            .flat_map(|record| parts.iter().map(move |part| (record, *part)))
            .collect();
        let (found, late_columns) = rayon::join(
            || -> Vec<DMatrix<f64>> {
                let each = looks.into_par_iter().map(|(record, part)| {
                    let recording = &self.recordings[record];
                    let own = part.iter().map(|&number| direction(recording, number));
                    let own: Vec<Direction> = own.collect();
                    let here = (&tracks[record], p[record].as_slice());
                    let mut forces = Own::new(self.program, here, &own);
                    changes(&tracks[record], recording, &mut forces)
                });
                each.collect()
            },
            || self.moved_runs(values, &late),
        );
        let late_columns = late_columns?;
        // Where an observer holds a plant only by what bends, small errors grow along a run until no number holds them.
        if found.iter().flatten().any(|change| !change.is_finite()) {
            return self.by_differences(values);
        }
        let mut found = found.into_iter();
        let (mut innovations, mut derivatives) = (Vec::new(), Vec::new());
        let records = self.recordings.iter().zip(tracks).zip(late_columns);
        for ((recording, track), moved) in records {
            let mut own = track.route.innovations.clone();
            let rows = own.channels.iter().map(Vec::len).sum();
            let mut matrix = DMatrix::zeros(rows, self.varied.len());
            let mut numbers = along.iter();
            for part in found.by_ref().take(parts.len()) {
                for (column, &number) in part.column_iter().zip(numbers.by_ref()) {
                    matrix.set_column(number, &column);
                }
            }
            if let Some(fold) = self.fold {
                fold.keep(&mut own, recording);
                fold.keep_rows(&mut matrix, recording);
            }
            for (&number, (size, moved)) in late.iter().zip(&moved) {
                matrix.set_column(number, &change(moved, &own, *size));
            }
            innovations.push(own);
            derivatives.push(matrix);
        }
        Ok(Linearised {
            innovations,
            derivatives,
        })
    }

    fn by_differences(&self, values: &[f64]) -> Result<Linearised, Unsupported> {
        let all: Vec<usize> = (0..self.varied.len()).collect();
        let (own, moved) = rayon::join(
            || self.innovations(values),
            || self.moved_runs(values, &all),
        );
        let innovations = own?;
        let of_record = |(own, moved): (&Innovations, Vec<(f64, Innovations)>)| {
            let columns = moved.iter().map(|(size, moved)| change(moved, own, *size));
            DMatrix::from_columns(&columns.collect::<Vec<_>>())
        };
        Ok(Linearised {
            derivatives: innovations.iter().zip(moved?).map(of_record).collect(),
            innovations,
        })
    }

    /// Of each record: innovations with each of some parameters moved, and by how much of its scale.
    fn moved_runs(
        &self,
        values: &[f64],
        numbers: &[usize],
    ) -> Result<Vec<Vec<(f64, Innovations)>>, Unsupported> {
        let run = |recording: &Recording, number: usize| {
            let move_by = difference(&self.varied[number], values[number], DIFFERENCE);
            let mut values = values.to_vec();
            values[number] += move_by;
            let found = self.run(recording, &self.settings(&values))?;
            Ok((move_by / self.varied[number].scale(), found))
        };
        let each = self.recordings.par_iter();
        let of = |recording| {
            let numbers = numbers.par_iter();
            numbers.map(|&number| run(recording, number)).collect()
        };
        each.map(of).collect()
    }
}

/// How innovations change a unit, from runs.
fn change(moved: &Innovations, own: &Innovations, size: f64) -> DVector<f64> {
    let (moved, own) = (
        moved.channels.iter().flatten(),
        own.channels.iter().flatten(),
    );
    let change: Vec<f64> = moved
        .zip(own)
        .map(|(moved, own)| (moved - own) / size)
        .collect();
    DVector::from_vec(change)
}

/// How far a parameter is moved for a difference: inwards where it is at its upper bound.
fn difference(varied: &Varied, value: f64, part: f64) -> f64 {
    let size = part * varied.scale();
    if value + size > varied.bounds.1 {
        -size
    } else {
        size
    }
}
