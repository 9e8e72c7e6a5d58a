//! [`Past`]: delayed values of what drives the axis. The record has them before a run begins, so an observer runs a model
//! with a dead time at any lateness, nought included, and innovations change smoothly with it.
//!
//! ```text
//! u held      ____      a jump of row k arrives within a row: the step that it falls into has the mean of both sides,
//!         ___|          and is short enough for its place in the step not to show
//! u linear    ____
//!         ___/          so is the step into which a kink falls
//! ```
//! What depends on states is not known beforehand: a model that delays such a thing is refused.

use super::inputs::interpolate;
use super::lengths::shortest_steps;
use super::unsupported::Unsupported;
use crate::records::Recording;
use hyde_program::{Constant, Function, Point, Program, Workspace, Wrt};

/// A step into which a jump falls is at least so short, and one into which a kink does: a row's time over 2^level.
const JUMP_LEVEL: usize = 5;
const KINK_LEVEL: usize = 4;

/// Delayed values of a run.
pub(crate) struct Past {
    /// How late each is, in rows.
    late: Vec<f64>,
    /// What is delayed, where each row begins and where it ends: a list a row.
    rows: Vec<Vec<(f64, f64)>>,
}

impl Past {
    pub(crate) fn new(
        program: &Program,
        recording: &Recording,
        p: &[f64],
    ) -> Result<Self, Unsupported> {
        let count = program.delays.len();
        let mut past = Self {
            late: Vec::new(),
            rows: Vec::new(),
        };
        if count == 0 {
            return Ok(past);
        }
        let late = |number| {
            let late_s = program.kernels.constant(Constant::Lateness(number), p);
            late_s.map(|late_s| late_s.max(0.0) / recording.step_s)
        };
        let late: Option<Vec<f64>> = (0..count).map(late).collect();
        let Some(late) = late.filter(|_| is_known(program)) else {
            return Err(Unsupported::Delay);
        };
        past.late = late;
        let (y, z) = (vec![0.0; program.n_unknowns], vec![0.0; program.n_memory]);
        let mut workspace = Workspace::new(program.n_work);
        let mut u = vec![0.0; 2 * program.columns.len() + count];
        let (mut begin, mut end) = (vec![0.0; count], vec![0.0; count]);
        for row in 0..recording.rows() {
            for (index, values) in [(0, &mut begin), (shortest_steps(), &mut end)] {
                interpolate(program, recording, row, index, &mut u);
                let part = index as f64 / shortest_steps() as f64;
                let at = Point {
                    t: recording.start_s + recording.step_s * (row as f64 + part),
                    y: &y,
                    yp: &y,
                    z: &z,
                    u: &u,
                    p,
                };
                program
                    .kernels
                    .evaluate(Function::Delayed, at, &mut workspace, values);
            }
            let pairs = begin.iter().copied().zip(end.iter().copied());
            past.rows.push(pairs.collect());
        }
        Ok(past)
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.late.is_empty()
    }

    /// The level that a step has at least, between two places in rows, for what arrives within it.
    pub(crate) fn level(&self, from: f64, to: f64) -> usize {
        let of = |number: usize| {
            let Some(row) = self.border(number, from, to) else {
                return 0;
            };
            let slope = |row| self.value(number, row, 1.0) - self.value(number, row, 0.0);
            match self.jump(number, from, to) {
                Some(_) => JUMP_LEVEL,
                None if slope(row).to_bits() != slope(row + 1).to_bits() => KINK_LEVEL,
                None => 0,
            }
        };
        (0..self.late.len()).map(of).max().unwrap_or(0)
    }

    /// The values where a step begins and where it ends; over a jump the mean.
    pub(crate) fn over(&self, from: f64, to: f64, begin: &mut [f64], end: &mut [f64]) {
        for (number, (begin, end)) in begin.iter_mut().zip(end).enumerate() {
            let late = self.late[number];
            let (row, part) = place(from - late);
            let first = self.value(number, row, part);
            let last = match part + (to - from) {
                part if part <= 1.0 + ROUNDING => self.value(number, row, part),
                part => self.value(number, row + 1, part - 1.0),
            };
            (*begin, *end) = match self.jump(number, from, to) {
                Some((place, next)) => {
                    let before = self.value(number, row, 1.0);
                    let behind = self.value(number, row + 1, to - late - place);
                    let part = (place - (from - late)) / (to - from);
                    let mean = 0.5 * (part * (first + before) + (1.0 - part) * (next + behind));
                    (mean, mean)
                }
                None => (first, last),
            };
        }
    }

    /// The row in the past that ends within a step.
    fn border(&self, number: usize, from: f64, to: f64) -> Option<isize> {
        let late = self.late[number];
        let (row, _) = place(from - late);
        ((row + 1) as f64 + ROUNDING < to - late).then_some(row)
    }

    /// Where in the past a jump lies that arrives within a step, and the value behind it.
    fn jump(&self, number: usize, from: f64, to: f64) -> Option<(f64, f64)> {
        let row = self.border(number, from, to)?;
        let (before, behind) = (
            self.value(number, row, 1.0),
            self.value(number, row + 1, 0.0),
        );
        (before.to_bits() != behind.to_bits()).then_some(((row + 1) as f64, behind))
    }

    fn value(&self, number: usize, row: isize, part: f64) -> f64 {
        let Ok(row) = usize::try_from(row) else {
            return self.rows[0][number].0;
        };
        let (begin, end) = self.rows[row.min(self.rows.len() - 1)][number];
        begin + (end - begin) * part.min(1.0)
    }
}

/// Whether a parameter vector has another past than a model's own: what is delayed, or how late it is, is not the same.
pub(crate) fn past_differs(program: &Program, p: &[f64], other: &[f64]) -> bool {
    let late = |p: &[f64], number| program.kernels.constant(Constant::Lateness(number), p);
    let moved = |place: usize| p[place].to_bits() != other[place].to_bits();
    let still = || program.kernels.still_entries(Function::Delayed);
    (0..program.delays.len()).any(|number| late(p, number) != late(other, number))
        || !program.delays.is_empty()
            && still()
                .iter()
                .any(|entry| matches!(entry.wrt, Wrt::Parameter(place) if moved(place)))
}

/// Two places in rows are the same that are so near.
const ROUNDING: f64 = 1e-9;

/// Row and part of it of a place in rows.
fn place(at: f64) -> (isize, f64) {
    let row = (at + ROUNDING).floor();
    (row as isize, (at - row).max(0.0))
}

/// Whether what is delayed is made of columns, parameters and time alone.
fn is_known(program: &Program) -> bool {
    let of_record = |wrt: Wrt| matches!(wrt, Wrt::Parameter(_) | Wrt::Time);
    let moving = program.partials(Function::Delayed).iter();
    let still = program.kernels.still_entries(Function::Delayed);
    moving.map(|entry| entry.wrt).all(of_record)
        && still.iter().map(|entry| entry.wrt).all(of_record)
}
