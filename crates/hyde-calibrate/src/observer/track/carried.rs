//! [`Track::carrying`]: what an effect of size 0 brings along. It does not act on the axis, but the axis drives it: a body on
//! a spring swings behind the table, whatever it weighs. Where its equations are linear in its own unknowns, or each of its
//! states flows on its own, they are solved along the track, and no set of shapes needs a run of the axis.
//!
//! ```text
//! over a row      x' = A x + g
//! A constant      exact, g cubic: its values at both ends, and its slopes as far as states of the axis make it
//! A diagonal      exact, A and g those of the middle of the row: bristles bend over the faster the faster they slide
//! x' = f(x)       x += T phi1(f' T) f a few times a row, each state on its own (Hochbruck and Ostermann, Acta Numerica 19,
//!                 2010, 209, section 2.4): springs that slip
//! ```

use super::Track;
use super::counterparts::Counterparts;
use super::equations::{Equations, Flow};
use super::vectors::Vectors;
use crate::linear::{phi1, set_product};
use crate::observer::over_record::When;
use crate::plant::Plant;
use crate::records::Recording;
use hyde_program::{Point, Program, Workspace};
use std::sync::Arc;

/// Parts of a row in which states flow that are not linear.
const PARTS: u32 = 8;
/// By this part of their way states are moved to see how their flow changes.
const NEAR: f64 = 1e-3;

/// Unknowns that an effect brings, along a track.
#[derive(Clone)]
pub(crate) struct Carried {
    /// The unknowns of the route's program in the vector of this one.
    pub(super) counterparts: Counterparts,
    /// Where its own are.
    pub(super) own: Vec<usize>,
    /// Its equations that are those of the route's program, in the order of these.
    pub(super) equations: Vec<usize>,
    /// Of each row, before the correction and after it: its own unknowns, and their rates.
    pub(super) values: Vec<f64>,
}

impl Carried {
    /// Where a row was, in the vectors of the program.
    pub(super) fn point<'a>(
        &self,
        row: usize,
        when: When,
        at: Point<'a>,
        room: &'a mut Vectors,
    ) -> Point<'a> {
        self.placed(self.at(row, when), at, room)
    }

    /// A part of the way to a row: what is its own goes there evenly.
    pub(super) fn within<'a>(
        &self,
        row: usize,
        part: f64,
        at: Point<'a>,
        room: &'a mut Vectors,
    ) -> Point<'a> {
        let ends = self
            .at(row - 1, When::After)
            .iter()
            .zip(self.at(row, When::Before));
        let values: Vec<f64> = ends
            .map(|(begin, end)| begin + part * (end - begin))
            .collect();
        self.placed(&values, at, room)
    }

    /// A point of the route in the vectors of the program, with its own unknowns and their rates.
    fn placed<'a>(&self, values: &[f64], at: Point<'a>, room: &'a mut Vectors) -> Point<'a> {
        let (y, yp) = values.split_at(self.own.len());
        room.reach(self.counterparts.positions.len() + self.own.len());
        self.counterparts.put(at, room);
        room.put(&self.own, y, yp);
        room.in_place(at)
    }

    /// Its own unknowns in a row, and their rates.
    fn at(&self, row: usize, when: When) -> &[f64] {
        let count = self.own.len();
        let first = 4 * count * row
            + match when {
                When::Before => 0,
                When::After => 2 * count,
            };
        &self.values[first..][..2 * count]
    }
}

impl<'p> Track<'p> {
    /// The track of a program that has all unknowns of this one, be it under other names, and some of its own that do not act
    /// on them with parameters `set`; `None` where it is not so, or where they are not linear.
    pub(crate) fn carrying(
        &self,
        program: &'p Program,
        recording: &'p Recording,
        set: &[(usize, f64)],
    ) -> Option<Self> {
        if self.carried.is_some() || !self.moves_as(program) {
            return None;
        }
        let start = Plant::new(program, recording, set).ok()?;
        let possible = Counterparts::possible(self.route.program, program);
        let mut possible = possible.into_iter();
        possible.find_map(|counterparts| self.carrying_beside(counterparts, program, &start))
    }

    /// The same with these counterparts of the unknowns, from where the model starts.
    fn carrying_beside(
        &self,
        counterparts: Counterparts,
        program: &'p Program,
        start: &Plant<'p>,
    ) -> Option<Self> {
        let (route, p) = (&self.route, &start.p);
        if !counterparts.have_rates_alike(&route.places, &start.places) {
            return None;
        }
        // An equation stands in the row of the unknown that it determines.
        let of_axis = counterparts.positions.clone();
        if !self.has_equations_of(program, p, &of_axis, &counterparts) {
            return None;
        }
        let carried = |counterparts, own, equations, values| Self {
            route: Arc::clone(route),
            carried: Some(Carried {
                counterparts,
                own,
                equations,
                values,
            }),
        };
        if of_axis.len() == program.n_unknowns {
            return Some(carried(counterparts, Vec::new(), of_axis, Vec::new()));
        }
        let equations = Equations::new(self, program, &counterparts, &start.places, p)?;
        if of_axis.iter().any(|number| equations.rows.contains(number)) {
            return None;
        }
        let states = &equations.own[..equations.states];
        let mut x: Vec<f64> = states.iter().map(|&own| start.y[own]).collect();
        let count = route.rows.len();
        let mut values = Vec::with_capacity(4 * count * equations.own.len());
        let mut end = Vectors {
            y: start.y.clone(),
            yp: start.yp.clone(),
        };
        let mut begin = end.clone();
        let mut solver = Solver::new(&equations, Workspace::new(program.n_work));
        for row in 0..count {
            for when in [When::Before, When::After] {
                let at = route.point(row, when, p);
                counterparts.put(at, &mut end);
                if row > 0 && matches!(when, When::Before) {
                    solver.step(&mut x, &begin, &mut end, at, route.step_s);
                }
                solver.answer(&x, &mut end, at);
                values.extend(equations.own.iter().map(|&own| end.y[own]));
                values.extend(equations.own.iter().map(|&own| end.yp[own]));
                std::mem::swap(&mut begin, &mut end);
            }
        }
        Some(carried(counterparts, equations.own, of_axis, values))
    }
}

/// Solves equations of what is brought.
struct Solver<'e> {
    equations: &'e Equations<'e>,
    workspace: Workspace,
    residual: Vec<f64>,
    /// Rates of the states, and below them algebraic variables.
    v: Vec<f64>,
    /// Within a row.
    middle: Vectors,
    /// What a flow starts from.
    from: Vec<f64>,
}

impl<'e> Solver<'e> {
    fn new(equations: &'e Equations<'e>, workspace: Workspace) -> Self {
        let count = equations.own.len();
        Self {
            equations,
            workspace,
            residual: vec![0.0; count],
            v: vec![0.0; count],
            middle: Vectors::default(),
            from: Vec::new(),
        }
    }

    /// v where the axis is, with some states.
    fn solve(&mut self, states: impl Iterator<Item = f64>, here: &mut Vectors, at: Point<'_>) {
        let Equations { own, .. } = self.equations;
        for &place in own {
            (here.y[place], here.yp[place]) = (0.0, 0.0);
        }
        for (&place, value) in own.iter().zip(states) {
            here.y[place] = value;
        }
        let equations = &self.equations.residual;
        equations.evaluate(here.in_place(at), &mut self.workspace, &mut self.residual);
        set_product(&self.equations.by_residual, &self.residual, &mut self.v);
    }

    /// Sets its states, their rates and its algebraic variables.
    fn answer(&mut self, x: &[f64], here: &mut Vectors, at: Point<'_>) {
        self.solve(x.iter().copied(), here, at);
        for (number, (&place, value)) in self.equations.own.iter().zip(&self.v).enumerate() {
            if number < x.len() {
                here.yp[place] = *value;
            } else {
                here.y[place] = *value;
            }
        }
    }

    /// Takes its states on by a row's time, from where all is known to where the axis is.
    fn step(
        &mut self,
        x: &mut [f64],
        begin: &Vectors,
        end: &mut Vectors,
        at: Point<'_>,
        time: f64,
    ) {
        let n = x.len();
        let Equations { own, of_axis, .. } = self.equations;
        let from = &mut self.from;
        from.clear();
        match &self.equations.flow {
            Flow::Constant { drivers, over } => {
                from.extend_from_slice(x);
                from.extend(own[..n].iter().map(|&place| begin.yp[place]));
                from.extend(drivers.iter().map(|&place| begin.yp[place]));
                from.extend(drivers.iter().map(|&place| end.yp[place]));
                from.extend(drivers.iter().map(|&place| end.y[place] - begin.y[place]));
                self.solve(std::iter::repeat_n(0.0, n), end, at);
                self.from.extend_from_slice(&self.v[..n]);
                set_product(over, &self.from, x);
            }
            Flow::Diagonal { linear } => {
                let parts = if *linear { 1 } else { PARTS };
                let mut middle = std::mem::take(&mut self.middle);
                let time = time / f64::from(parts);
                for part in 0..parts {
                    let at_part = (f64::from(part) + 0.5) / f64::from(parts);
                    between(begin, end, at_part, &mut middle);
                    let (own, row) = (at_part * (1.0 - at_part), time * f64::from(parts));
                    for &place in of_axis {
                        let change = end.y[place] - begin.y[place];
                        let slopes = (begin.yp[place] * row - change) * (1.0 - at_part)
                            - (end.yp[place] * row - change) * at_part;
                        middle.y[place] += own * slopes;
                    }
                    self.flow_on(x, &mut middle, at, time);
                }
                self.middle = middle;
            }
        }
    }

    /// Takes states that do not act on each other on by a time, the axis being where it is in the middle of it.
    fn flow_on(&mut self, x: &mut [f64], middle: &mut Vectors, at: Point<'_>, time: f64) {
        self.solve(x.iter().copied(), middle, at);
        self.from.clear();
        self.from.extend_from_slice(&self.v[..x.len()]);
        let moved = |(x, f): (&f64, &f64)| NEAR * (time * f).abs().max(NEAR * x.abs());
        let steps: Vec<f64> = x.iter().zip(&self.from).map(moved).collect();
        let pairs = x.iter().zip(&steps);
        self.solve(pairs.map(|(x, step)| x + step), middle, at);
        for (((x, f), with), step) in x.iter_mut().zip(&self.from).zip(&self.v).zip(&steps) {
            if *step > 0.0 {
                *x += time * phi1((with - f) / step * time) * f;
            }
        }
    }
}

/// Unknowns and their rates a part of the way from one place to another.
fn between(begin: &Vectors, end: &Vectors, part: f64, there: &mut Vectors) {
    let on = |(a, b): (&f64, &f64)| a + part * (b - a);
    there.y.clear();
    there.y.extend(begin.y.iter().zip(&end.y).map(on));
    there.yp.clear();
    there.yp.extend(begin.yp.iter().zip(&end.yp).map(on));
}
