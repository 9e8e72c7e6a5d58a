//! What drives a plant: the columns of its record and what is delayed, at the ends of a step and within it.

use super::driven::Plant;
use super::lengths::{shortest_steps, size_of};
use crate::records::Recording;
use hyde_program::Program;

impl Plant<'_> {
    /// What drives the axis where a row begins.
    pub(crate) fn read_inputs(&mut self) {
        if !self.past.is_empty() {
            let at = self.row as f64;
            let (begin, end) = &mut self.late;
            self.past.over(at, at, begin, end);
        }
        self.read_inputs_at_start();
    }

    /// What drives the axis where a step begins.
    pub(crate) fn read_inputs_at_start(&mut self) {
        interpolate(
            self.program,
            self.recording,
            self.row,
            self.index,
            &mut self.u,
        );
        self.u[2 * self.program.columns.len()..].copy_from_slice(&self.late.0);
    }

    /// What drives the axis where a step ends.
    pub(crate) fn read_inputs_at_end(&mut self, index: usize) {
        interpolate(self.program, self.recording, self.row, index, &mut self.u);
        self.u[2 * self.program.columns.len()..].copy_from_slice(&self.late.1);
    }

    /// What drives the axis within a step: `index` shortest steps into the row, a part of the step on.
    pub(crate) fn read_inputs_within(&mut self, index: usize, part: f64) {
        let u = &mut self.room.u_within;
        interpolate(self.program, self.recording, self.row, index, u);
        let (begin, end) = &self.late;
        let delayed = u[2 * self.program.columns.len()..].iter_mut();
        for ((delayed, begin), end) in delayed.zip(begin).zip(end) {
            *delayed = begin + part * (end - begin);
        }
    }

    /// Delayed values of the next step, the rates following where they jump; false where it is too long for what arrives within.
    pub(crate) fn read_past(&mut self) -> bool {
        let rows = shortest_steps() as f64;
        let from = self.row as f64 + self.index as f64 / rows;
        let to = from + size_of(self.level) as f64 / rows;
        if self.level < self.past.level(from, to) {
            return false;
        }
        let (begin, end) = &mut self.late;
        self.past.over(from, to, begin, end);
        if self.u[2 * self.program.columns.len()..] != *begin {
            self.read_inputs_at_start();
            self.make_consistent();
        }
        true
    }
}

/// Columns at a part of a row: where it begins what steps has its new value, and linear ones are on their way to the next.
pub(crate) fn interpolate(
    program: &Program,
    recording: &Recording,
    row: usize,
    index: usize,
    u: &mut [f64],
) {
    let part = index as f64 / shortest_steps() as f64;
    for (number, (column, read)) in recording.columns.iter().zip(&program.columns).enumerate() {
        let last = column.len() - 1;
        let (now, then) = (column[row.min(last)], column[(row + 1).min(last)]);
        let linear = read.continuous && !read.next;
        u[2 * number] = if linear {
            now + (then - now) * part
        } else {
            now
        };
        u[2 * number + 1] = now;
    }
}
