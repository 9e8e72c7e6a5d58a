//! [`Track`]: where an observer takes the plant along a record, row by row: what tangents are differentiated along.
//!
//! An effect of size 0 changes no run. So one track serves every effect that brings no modes or delays of its own: its
//! equations are evaluated where the model without it has been ([`Track::serves`]), and where they are linear its own
//! unknowns are carried along ([`Track::carrying`]).

mod carried;
mod equations;

use super::gain::Observer;
use super::innovations::Innovations;
use super::over_record::{When, run_while};
use crate::plant::{Configuration, Instant, Leg, Places, Plant, Unsupported, inverse};
use crate::records::Recording;
use carried::Carried;
pub(crate) use carried::Vectors;
use hyde_program::{Point, Program, Workspace};
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};
use std::sync::Arc;

/// A run of an observer over a record, in the vectors of a program.
pub(crate) struct Track<'p> {
    pub(crate) route: Arc<Route<'p>>,
    /// The states and algebraic variables of the route.
    pub(crate) places: Places,
    /// If this is another program than the route's: what it has beside.
    carried: Option<Carried>,
}

/// What a run of an observer has met, whatever else is carried along it.
pub(crate) struct Route<'p> {
    program: &'p Program,
    /// The time of a row, s.
    pub(crate) step_s: f64,
    pub(crate) innovations: Innovations,
    /// The observer of this very model.
    pub(crate) observer: Observer,
    /// Combinations of modes, each once or linear at several points.
    pub(crate) configurations: Vec<Configuration<'p>>,
    /// Of each the first one of the same modes.
    pub(crate) same_modes: Vec<usize>,
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
    /// Numbers of the states that modes fix.
    pub(crate) fixed: Vec<usize>,
}

impl<'p> Track<'p> {
    /// Runs the observer over a record, parameters `set`.
    pub(crate) fn new(
        program: &'p Program,
        recording: &'p Recording,
        observer: &Observer,
        set: &[(usize, f64)],
    ) -> Result<Self, Unsupported> {
        let (mut plant, observer) = observer.on(program, recording, set)?;
        let width = 2 * (2 * plant.y.len() + plant.u.len());
        let mut values = Vec::with_capacity(width * recording.rows());
        let mut innovations = Innovations::empty(recording, &observer);
        let mut rows = Vec::with_capacity(recording.rows());
        let (mut legs, mut memories) = (Vec::new(), Vec::new());
        plant.legs = Some(Vec::new());
        let mut before = (0, 0);
        let _end = run_while(&mut plant, &observer, |plant, row, when, error| {
            let here = keep(plant, &mut values, &mut memories);
            match when {
                When::Before => {
                    before = here;
                    if row >= recording.first_row {
                        innovations.add(error, recording.readings(row), &observer);
                    }
                }
                When::After => {
                    let first_leg = legs.len();
                    plant.legs.iter_mut().for_each(|own| legs.append(own));
                    rows.push(Passed {
                        t: plant.time(),
                        modes: [before.0, here.0],
                        memory: [before.1, here.1],
                        legs: first_leg..legs.len(),
                        fixed: plant.fixed_states(),
                    });
                }
            }
            ControlFlow::Continue(())
        });
        let configurations = std::mem::take(&mut plant.configurations);
        let first = |(modes, _): &(Vec<u64>, _)| {
            let mut all = configurations.iter();
            all.position(|(own, _)| own == modes).unwrap_or_default()
        };
        let same_modes = configurations.iter().map(first).collect();
        let route = Route {
            same_modes,
            program,
            step_s: recording.step_s,
            innovations,
            observer,
            configurations: configurations.into_iter().map(|(_, own)| own).collect(),
            rows,
            legs,
            values,
            memories,
        };
        Ok(Self {
            route: Arc::new(route),
            places: plant.places,
            carried: None,
        })
    }

    /// Those of all records.
    pub(crate) fn all(
        program: &'p Program,
        recordings: &'p [Recording],
        observer: &Observer,
        set: &[(usize, f64)],
    ) -> Result<Vec<Self>, Unsupported> {
        let each = recordings.par_iter();
        each.map(|recording| Self::new(program, recording, observer, set))
            .collect()
    }

    /// Whether another program has the same unknowns, modes and memory, so that it can be evaluated here.
    pub(crate) fn serves(&self, other: &Program) -> bool {
        self.moves_as(other) && names(self.route.program) == names(other)
    }

    /// Whether another program has the same modes and memory.
    fn moves_as(&self, other: &Program) -> bool {
        let own = self.route.program;
        let places = |program: &Program| -> Vec<usize> {
            program.automata.iter().map(|own| own.place).collect()
        };
        own.n_memory == other.n_memory
            && own.relations.len() == other.relations.len()
            && own.delays.len() == other.delays.len()
            && own.columns == other.columns
            && places(own) == places(other)
    }

    /// Where a row was, with some parameters.
    pub(crate) fn point<'a>(
        &'a self,
        row: usize,
        when: When,
        p: &'a [f64],
        room: &'a mut Vectors,
    ) -> Point<'a> {
        let at = self.route.point(row, when, p);
        match &self.carried {
            None => at,
            Some(carried) => carried.point(row, when, at, room),
        }
    }

    /// An instant on the way to a row, with some parameters.
    pub(crate) fn within<'a>(
        &'a self,
        row: usize,
        instant: &'a Instant,
        p: &'a [f64],
        room: &'a mut Vectors,
    ) -> Point<'a> {
        let at = instant.point(p);
        let Some(carried) = &self.carried else {
            return at;
        };
        let rows = &self.route.rows;
        let (begin, end) = (rows[row - 1].t, rows[row].t);
        carried.within(row, (at.t - begin) / (end - begin), at, room)
    }

    /// The steps that led to a row.
    pub(crate) fn legs(&self, row: usize) -> &[Leg] {
        &self.route.legs[self.route.rows[row].legs.clone()]
    }

    /// What a unit of the residuals of this program, or of one that this track serves, makes of rates and algebraic
    /// variables, in a combination of modes: the inverse of dF/dv.
    pub(crate) fn inverse(
        &self,
        program: &Program,
        configuration: usize,
        p: &[f64],
        workspace: &mut Workspace,
    ) -> Option<DMatrix<f64>> {
        if self.carried.is_none() && std::ptr::eq(program, self.route.program) {
            return Some(self.route.configurations[configuration].inverse.clone());
        }
        let mut room = Vectors::default();
        let at = self.made(configuration, p, &mut room);
        inverse(program, &self.places, at, workspace)
    }

    /// Where a combination of modes is linear, with some parameters.
    pub(crate) fn made<'a>(
        &'a self,
        configuration: usize,
        p: &'a [f64],
        room: &'a mut Vectors,
    ) -> Point<'a> {
        let at = self.route.configurations[configuration].made.point(p);
        match &self.carried {
            None => at,
            Some(carried) => carried.at_rest(at, room),
        }
    }
}

impl Route<'_> {
    /// Where a row was, in the vectors of the route's program.
    fn point<'a>(&'a self, row: usize, when: When, p: &'a [f64]) -> Point<'a> {
        let passed = &self.rows[row];
        let width = self.values.len() / self.rows.len();
        let values = &self.values[row * width..][..width];
        let (before, after) = values.split_at(width / 2);
        let (values, memory) = match when {
            When::Before => (before, passed.memory[0]),
            When::After => (after, passed.memory[1]),
        };
        let unknowns = self.program.n_unknowns;
        let (y, rest) = values.split_at(unknowns);
        let (yp, u) = rest.split_at(unknowns);
        Point {
            t: passed.t,
            y,
            yp,
            z: &self.memories[memory],
            u,
            p,
        }
    }
}

/// The names of the unknowns of a program.
fn names(program: &Program) -> Vec<String> {
    let each = 0..program.n_unknowns;
    each.map(|number| program.unknown_name(number)).collect()
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
