//! [`Runs`]: innovations of the stage's model with an effect put on: how they change with a small size, along the track of the
//! stage where that serves, and what they are at any size.

use super::hypothesis::{Hypothesis, Knob};
use super::products::Products;
use super::projection::Projection;
use super::stage::{Ground, flat};
use crate::observer::{Innovations, Shape, Slopes, Track, along, changes};
use crate::records::Recording;
use hyde_program::Program;
use nalgebra::{DMatrixView, DVector};
use rayon::prelude::*;
use std::ops::Range;

/// Numerics: the part of its range that a size is given to differentiate by it.
const SMALL: f64 = 1e-4;

/// Innovations of a model with the effect at some sizes.
pub(crate) struct Runs<'s> {
    pub(crate) ground: &'s Ground<'s>,
    pub(crate) program: &'s Program,
    /// Where the stage takes the observer.
    pub(crate) tracks: &'s [Track<'s>],
    pub(crate) values: Vec<(String, f64)>,
    pub(crate) sizes: Vec<String>,
    pub(crate) shapes: Vec<String>,
}

impl Runs<'_> {
    /// How innovations change from what they are without the effect; `None` where it cannot be run, or where they become so
    /// large that no parameter could answer it.
    pub(crate) fn change(
        &self,
        sizes: &[f64],
        shapes: &[f64],
        plain: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        let set = self.set(sizes, shapes);
        let run = |recording: &Recording| {
            let observer = self.ground.observer;
            Innovations::of(self.program, recording, observer, &set).ok()
        };
        let each: Option<Vec<Innovations>> = self.ground.recordings.par_iter().map(run).collect();
        Some(DVector::from_vec(flat(&each?)) - plain)
    }

    /// Products of the changes of innovations a unit of each size, for some shapes; and the innovations.
    pub(crate) fn products(
        &self,
        hypothesis: &Hypothesis,
        projection: &Projection,
        shapes: &[Vec<f64>],
    ) -> Option<(Products, DVector<f64>)> {
        let count = hypothesis.sizes.len();
        let mut products = Products::new(projection.parameters(), shapes.len(), count);
        let mut innovations = Vec::new();
        for (number, record) in projection.records.iter().enumerate() {
            let recording = &self.ground.recordings[number];
            let (channels, step_s) = (recording.channels.len(), recording.step_s);
            let all = self.shapes(hypothesis, recording, shapes);
            let mut add = |few: Range<usize>, tracks: &[Track<'_>]| {
                let mut forces = Slopes::new(self.program, &all[few.clone()], tracks);
                let mut adding = products.adding(few, record, channels, step_s);
                let each = |_, changes: DMatrixView<'_, f64>| adding.row(changes);
                along(&tracks[0], recording, &mut forces, each);
                adding.end();
            };
            // Shapes along one route are differentiated at once.
            let mut together: Vec<Track<'_>> = Vec::new();
            for (next, shape) in shapes.iter().enumerate() {
                let track = self.track(number, &self.set(&vec![0.0; count], shape))?;
                if together
                    .first()
                    .is_some_and(|known| !known.runs_with(&track))
                {
                    add(next - together.len()..next, &together);
                    together.clear();
                }
                together.push(track);
            }
            add(shapes.len() - together.len()..shapes.len(), &together);
            innovations.push(together.first()?.route.innovations.clone());
        }
        Some((products, DVector::from_vec(flat(&innovations))))
    }

    /// The changes of innovations a unit of each size.
    pub(crate) fn columns(&self, hypothesis: &Hypothesis, shapes: &[f64]) -> Option<Vec<Vec<f64>>> {
        let count = hypothesis.sizes.len();
        let set = self.set(&vec![0.0; count], shapes);
        let mut columns = vec![Vec::new(); count];
        for (number, recording) in self.ground.recordings.iter().enumerate() {
            let all = self.shapes(hypothesis, recording, &[shapes.to_vec()]);
            let track = [self.track(number, &set)?];
            let mut forces = Slopes::new(self.program, &all, &track);
            let changes = changes(&track[0], recording, &mut forces);
            for (column, change) in columns.iter_mut().zip(changes.column_iter()) {
                column.extend(change.iter());
            }
        }
        Some(columns)
    }

    /// The track of a record with a shape of the effect: that of the stage, as it is or with what the effect brings along, or one
    /// of its own.
    fn track(&self, number: usize, set: &[(usize, f64)]) -> Option<Track<'_>> {
        let (known, recording) = (&self.tracks[number], &self.ground.recordings[number]);
        if known.serves(self.program, &recording.parameters(self.program, set)) {
            return Some(known.clone());
        }
        known
            .carrying(self.program, recording, set)
            .or_else(|| Track::new(self.program, recording, self.ground.observer, set).ok())
    }

    /// Every shape, and what its sizes change, a little above 0: many are nothing but a corner at 0.
    fn shapes(
        &self,
        hypothesis: &Hypothesis,
        recording: &Recording,
        shapes: &[Vec<f64>],
    ) -> Vec<Shape> {
        let small: Vec<f64> = hypothesis
            .sizes
            .iter()
            .map(|size| SMALL * largest(size))
            .collect();
        let of = |shape: &Vec<f64>| {
            let p = |sizes: &[f64]| recording.parameters(self.program, &self.set(sizes, shape));
            let here = p(&small);
            let without = |which: usize| {
                let mut sizes = small.clone();
                sizes[which] = 0.0;
                let without = p(&sizes);
                let pairs = here.iter().zip(&without).enumerate();
                let changes = pairs.map(|(place, (here, without))| (place, here - without));
                let changes = changes.filter(|(_, change)| *change != 0.0);
                changes
                    .map(|(place, change)| (place, change / small[which]))
                    .collect()
            };
            Shape {
                by_size: (0..small.len()).map(without).collect(),
                p: here,
            }
        };
        shapes.iter().map(of).collect()
    }

    fn set(&self, sizes: &[f64], shapes: &[f64]) -> Vec<(usize, f64)> {
        let mut values = self.values.clone();
        let own = self.sizes.iter().zip(sizes);
        let own = own.chain(self.shapes.iter().zip(shapes));
        values.extend(own.map(|(name, &value)| (name.clone(), value)));
        self.ground.set_in(self.program, &values)
    }
}

/// The largest value of a size.
pub(crate) fn largest(size: &Knob) -> f64 {
    // The positive side, where there is one: many sizes cannot be negative.
    if size.range.1 > 0.0 {
        size.range.1
    } else {
        size.range.0
    }
}
