//! [`Track`]: where an observer takes the plant along a record, row by row: what tangents are differentiated along.
//!
//! An effect of size 0 changes no run. So one track serves every effect that brings no unknowns, modes or delays of its
//! own ([`Track::serves`]): its equations are evaluated where the model without it has been.

use crate::configuration::{Configuration, Places, inverse};
use crate::dense::set_product;
use crate::gain::Observer;
use crate::observer::{Innovations, measured, whitened};
use crate::plant::{Leg, Plant, Unsupported};
use crate::recording::Recording;
use hyde_program::{Point, Program, Workspace};
use nalgebra::DMatrix;
use std::ops::Range;

/// A run of an observer over a record.
pub(crate) struct Track<'p> {
    program: &'p Program,
    pub(crate) innovations: Innovations,
    /// The observer of this very model.
    pub(crate) observer: Observer,
    pub(crate) places: Places,
    /// Combinations of modes met.
    pub(crate) configurations: Vec<Configuration<'p>>,
    pub(crate) rows: Vec<Passed>,
    legs: Vec<Leg>,
    /// Of each row: unknowns, their rates and what drives the axis, before the correction and after it.
    values: Vec<f64>,
    memories: Vec<Vec<f64>>,
}

/// A row: everything before its correction, and after it.
pub(crate) struct Passed {
    t: f64,
    /// Numbers of the combinations of modes.
    pub(crate) modes: [usize; 2],
    memory: [usize; 2],
    /// The steps that led here.
    legs: Range<usize>,
    /// Positions that modes fix.
    pub(crate) pinned: Vec<usize>,
}

/// Before the correction of a row, and after it.
#[derive(Clone, Copy)]
pub(crate) enum When {
    Before,
    After,
}

impl<'p> Track<'p> {
    /// Runs the observer over a record, parameters `set`.
    pub(crate) fn new(
        program: &'p Program,
        recording: &'p Recording,
        observer: &Observer,
        set: &[(usize, f64)],
    ) -> Result<Self, Unsupported> {
        let mut plant = Plant::new(program, recording, set)?;
        let observer = observer.of(&plant);
        if let Some(tolerances) = observer.tolerances() {
            plant.tolerances = tolerances;
        }
        let channels = recording.channels.len();
        let counted = recording.rows() - recording.first_row;
        let width = 2 * (2 * plant.y.len() + plant.u.len());
        let mut found = Innovations {
            channels: vec![Vec::with_capacity(counted); channels],
        };
        let mut rows = Vec::with_capacity(recording.rows());
        let mut values = Vec::with_capacity(width * recording.rows());
        let (mut legs, mut memories) = (Vec::new(), Vec::new());
        let shown = measured(program);
        let (mut outputs, mut error) = (vec![0.0; channels], vec![0.0; channels]);
        let mut increment = vec![0.0; plant.places.states.len()];
        for row in 0..recording.rows() {
            let first_leg = legs.len();
            legs.append(&mut plant.legs);
            let before = keep(&plant, &mut values, &mut memories);
            let (at, workspace) = plant.point();
            let t = at.t;
            shown.evaluate(at, workspace, &mut outputs);
            for (channel, (error, shown)) in error.iter_mut().zip(&outputs).enumerate() {
                let difference = recording.channels[channel][row] - shown;
                if row >= recording.first_row {
                    let value = whitened(difference, observer.deviations[channel]);
                    found.channels[channel].push(value);
                }
                // A value that is missing corrects nothing.
                *error = if difference.is_finite() {
                    difference
                } else {
                    0.0
                };
            }
            set_product(&observer.gain, &error, &mut increment);
            plant.begin_row(&increment);
            let after = keep(&plant, &mut values, &mut memories);
            rows.push(Passed {
                t,
                modes: [before.0, after.0],
                memory: [before.1, after.1],
                legs: first_leg..legs.len(),
                pinned: plant.pinned.iter().map(|(place, _)| *place).collect(),
            });
            if row + 1 < recording.rows() {
                plant.advance();
            }
        }
        let configurations = std::mem::take(&mut plant.configurations);
        Ok(Self {
            program,
            innovations: found,
            observer,
            places: plant.places,
            configurations: configurations.into_iter().map(|(_, own)| own).collect(),
            rows,
            legs,
            values,
            memories,
        })
    }

    /// Whether another program has the same unknowns, modes and memory, so that it can be evaluated here.
    pub(crate) fn serves(&self, other: &Program) -> bool {
        let own = self.program;
        let same = own.n_unknowns == other.n_unknowns
            && own.n_memory == other.n_memory
            && own.relations.len() == other.relations.len()
            && own.delays.len() == other.delays.len()
            && own.columns.len() == other.columns.len()
            && own.automata.len() == other.automata.len();
        same && (0..own.n_unknowns)
            .all(|number| own.unknown_name(number) == other.unknown_name(number))
            && own
                .automata
                .iter()
                .zip(&other.automata)
                .all(|(a, b)| a.place == b.place)
            && own.columns.iter().zip(&other.columns).all(|(a, b)| a == b)
    }

    /// Where a row was, with some parameters.
    pub(crate) fn point<'a>(&'a self, row: usize, when: When, p: &'a [f64]) -> Point<'a> {
        let (n, passed) = (self.program.n_unknowns, &self.rows[row]);
        let width = self.values.len() / self.rows.len();
        let values = &self.values[row * width..][..width];
        let (before, after) = values.split_at(width / 2);
        let (values, memory) = match when {
            When::Before => (before, passed.memory[0]),
            When::After => (after, passed.memory[1]),
        };
        let (y, rest) = values.split_at(n);
        let (yp, u) = rest.split_at(n);
        Point {
            t: passed.t,
            y,
            yp,
            z: &self.memories[memory],
            u,
            p,
        }
    }

    /// The steps that led to a row.
    pub(crate) fn legs(&self, row: usize) -> &[Leg] {
        &self.legs[self.rows[row].legs.clone()]
    }

    /// What a unit of the residuals of a program that this track serves makes of rates and algebraic variables, in a
    /// combination of modes: the inverse of dF/dv.
    pub(crate) fn inverse(
        &self,
        program: &Program,
        configuration: usize,
        p: &[f64],
        workspace: &mut Workspace,
    ) -> Option<DMatrix<f64>> {
        let known = &self.configurations[configuration];
        if std::ptr::eq(program, self.program) {
            return Some(known.inverse.clone());
        }
        inverse(program, &self.places, known.made.point(p), workspace)
    }
}

/// Keeps where a plant is: the numbers of its modes and of its memory.
fn keep(plant: &Plant<'_>, values: &mut Vec<f64>, memories: &mut Vec<Vec<f64>>) -> (usize, usize) {
    values.extend_from_slice(&plant.y);
    values.extend_from_slice(&plant.yp);
    values.extend_from_slice(&plant.u);
    if memories.last() != Some(&plant.z) {
        memories.push(plant.z.clone());
    }
    (plant.current, memories.len() - 1)
}
