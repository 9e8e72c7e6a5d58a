//! [`Track`]: where an observer takes the plant along a record, row by row: what tangents are differentiated along.
//!
//! An effect of size 0 changes no run. So one track serves every effect that brings no modes or delays of its own: its
//! equations are evaluated where the model without it has been ([`Track::serves`]), and where they are linear, or each state
//! flows on its own, its own unknowns are carried along ([`Track::carrying`]).

mod bends;
mod carried;
mod counterparts;
mod equations;
mod splitting;
mod vectors;

use super::gain::Observer;
use super::innovations::Innovations;
use super::over_record::{When, run_while};
use crate::plant::{Configuration, Instant, Leg, Places, Plant, Unsupported, arranged, partials};
use crate::records::Recording;
use bends::Bends;
pub(crate) use bends::Passing;
use carried::Carried;
use counterparts::{Counterparts, names};
use hyde_program::{Point, Program, Workspace, Wrt};
use nalgebra::DMatrix;
use rayon::prelude::*;
pub(crate) use splitting::{Bend, Forcing, acting};
use std::ops::{ControlFlow, Range};
use std::sync::Arc;
pub(crate) use vectors::Vectors;

/// How far from each other derivatives may be that are the same number, of the largest of their equation.
const SAME: f64 = 1e-9;

/// A run of an observer over a record, in the vectors of a program.
#[derive(Clone)]
pub(crate) struct Track<'p> {
    pub(crate) route: Arc<Route<'p>>,
    /// If this is another program than the route's: what it has beside.
    carried: Option<Carried>,
}

/// What a run of an observer has met, whatever else is carried along it.
pub(crate) struct Route<'p> {
    pub(crate) program: &'p Program,
    /// Its parameters.
    pub(crate) p: Vec<f64>,
    /// Its states and algebraic variables.
    pub(crate) places: Places,
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
    bends: Bends,
}

/// A place on a track.
#[derive(Clone, Copy)]
pub(crate) enum Place<'a> {
    /// A row, before its correction or after it.
    Row(usize, When),
    /// An instant on the way to a row.
    Within(usize, &'a Instant),
}

/// A row: everything before its correction, and after it.
pub(crate) struct Passed {
    t: f64,
    /// Numbers of the combinations of modes.
    pub(crate) modes: [usize; 2],
    memory: [usize; 2],
    /// The steps that led here.
    pub(crate) legs: Range<usize>,
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
            p: std::mem::take(&mut plant.p),
            places: plant.places,
            bends: Bends::new(configurations.len(), rows.len(), legs.len()),
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

    /// Whether another program has the same unknowns, equations, modes and memory with some parameters, so that it can be
    /// evaluated here.
    pub(crate) fn serves(&self, other: &Program, p: &[f64]) -> bool {
        let equations: Vec<usize> = (0..other.n_unknowns).collect();
        self.moves_as(other)
            && names(self.route.program) == names(other)
            && self.has_equations_of(other, p, &equations, &Counterparts::same(equations.len()))
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

    /// The point at a place, with some parameters.
    pub(crate) fn point<'a>(
        &'a self,
        place: Place<'a>,
        p: &'a [f64],
        room: &'a mut Vectors,
    ) -> Point<'a> {
        let at = match place {
            Place::Row(row, when) => self.route.point(row, when, p),
            Place::Within(_, instant) => instant.point(p),
        };
        let Some(carried) = &self.carried else {
            return at;
        };
        match place {
            Place::Row(row, when) => carried.point(row, when, at, room),
            Place::Within(row, _) => {
                let rows = &self.route.rows;
                let (begin, end) = (rows[row - 1].t, rows[row].t);
                carried.within(row, (at.t - begin) / (end - begin), at, room)
            }
        }
    }

    /// Whether another track of the same program is along the same route, its equations in the same places: directions on both
    /// are differentiated by the same matrices.
    pub(crate) fn runs_with(&self, other: &Self) -> bool {
        let equations = |track: &Self| {
            let carried = track.carried.as_ref();
            carried.map(|own| own.equations.clone())
        };
        Arc::ptr_eq(&self.route, &other.route) && equations(self) == equations(other)
    }

    /// The steps that led to a row.
    pub(crate) fn legs(&self, row: usize) -> &[Leg] {
        &self.route.legs[self.route.rows[row].legs.clone()]
    }

    /// The number in the route's program of an equation of the program that is evaluated here; `None` of what is carried
    /// along.
    pub(crate) fn equation(&self, number: usize) -> Option<usize> {
        match &self.carried {
            None => Some(number),
            Some(carried) => carried.equations.iter().position(|&own| own == number),
        }
    }

    /// Whether some equations of another program, with some parameters, are those of the route, one by one, by their
    /// derivatives where it is linear.
    fn has_equations_of(
        &self,
        other: &Program,
        p: &[f64],
        equations: &[usize],
        counterparts: &Counterparts,
    ) -> bool {
        let route = &self.route;
        let Some(first) = route.configurations.first() else {
            return false;
        };
        let mut there = Vectors::default();
        there.reach(other.n_unknowns);
        let at = first.made.point(p);
        counterparts.put(at, &mut there);
        let own = derivatives(route.program, first.made.point(&route.p));
        let others = derivatives(other, there.in_place(at));
        own.iter().zip(&others).all(|(own, others)| {
            let others = others
                .select_rows(equations)
                .select_columns(&counterparts.positions);
            let same = |row: usize| {
                let (own, other) = (own.row(row), others.row(row));
                let near = SAME * own.amax();
                let pairs = own.iter().zip(other.iter().zip(&counterparts.signs));
                // Where a power is steepest it has no slope, and tells nothing.
                let mut apart = pairs.map(|(own, (other, sign))| (own - sign * other).abs() > near);
                !apart.any(|apart| apart)
            };
            own.shape() == others.shape() && (0..own.nrows()).all(same)
        })
    }
}

/// Derivatives of the residual by all unknowns, and by all rates.
fn derivatives(program: &Program, at: Point<'_>) -> [DMatrix<f64>; 2] {
    let values = partials(program, at, &mut Workspace::new(program.n_work));
    let by_unknown = |wrt| {
        let Wrt::Unknown(column) = wrt else {
            return None;
        };
        Some(column)
    };
    let by_rate = |wrt| {
        let Wrt::Derivative(column) = wrt else {
            return None;
        };
        Some(column)
    };
    [
        arranged(program, &values, by_unknown),
        arranged(program, &values, by_rate),
    ]
}

impl Route<'_> {
    /// The time of a row, s.
    pub(crate) fn time(&self, row: usize) -> f64 {
        self.rows[row].t
    }

    /// Where a row was, in the vectors of the route's program.
    pub(crate) fn point<'a>(&'a self, row: usize, when: When, p: &'a [f64]) -> Point<'a> {
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
