//! Record columns over time: read linearly by continuous equations, held by clocks (C4).

use crate::failure::{Failure, FailureKind};
use crate::setup::Setup;
use hyde_program::Program;
use hyde_signal::{Cursor, Signal};

/// A column that a program reads and the records do not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InputError {
    /// The record.
    pub record: String,
    /// The column.
    pub column: String,
}

/// The doubles between two instants of a difference of time, at least: rounding of the instants is no part of it.
const RESOLUTIONS: f64 = 131_072.0;

/// The columns of a run.
pub(crate) struct Inputs<'a> {
    columns: Vec<Input<'a>>,
    /// Numbers of those the continuous equations read.
    continuous: Vec<usize>,
    /// Numbers of those of them that step at rows, and the instant that they were read at last: between events they stay.
    stepped: Vec<usize>,
    since_s: f64,
    start_s: f64,
}

struct Input<'a> {
    signal: Signal<'a>,
    /// The instants at which it jumps.
    jumps: Vec<f64>,
    mean_step_s: f64,
    next: bool,
    cursor: Cursor,
}

impl<'a> Inputs<'a> {
    pub(crate) fn new(program: &Program, setup: &Setup<'a>) -> Result<Self, Box<Failure>> {
        let mut columns = Vec::new();
        for column in &program.columns {
            let table = setup.records.get(&column.record);
            let Some(signal) =
                table.and_then(|table| table.reading(&column.column).signal(&column.column))
            else {
                let message = format!(
                    "the record `{}` has no column `{}`",
                    column.record, column.column
                );
                return Err(Failure::new(FailureKind::Input(message), setup.start_s));
            };
            let mean_step_s = table
                .and_then(hyde_signal::Table::mean_step)
                .unwrap_or(f64::INFINITY);
            columns.push(Input {
                jumps: match column.continuous {
                    true => signal.jumps().collect(),
                    false => Vec::new(),
                },
                signal,
                mean_step_s,
                next: column.next,
                cursor: Cursor::default(),
            });
        }
        let numbers = |read: &dyn Fn(&hyde_program::Column) -> bool| {
            let all = program.columns.iter().enumerate();
            all.filter(|(_, column)| read(column))
                .map(|(number, _)| number)
                .collect()
        };
        Ok(Self {
            columns,
            continuous: numbers(&|column| column.continuous),
            stepped: numbers(&|column| column.stepped),
            since_s: setup.start_s,
            start_s: setup.start_s,
        })
    }

    /// Reads the columns that the continuous equations use: the linear value at 2k, the held one at 2k + 1.
    pub(crate) fn read_continuous(&mut self, t: f64, u: &mut [f64]) {
        for &number in &self.continuous {
            self.columns[number].read(t, &mut u[2 * number..2 * number + 2]);
        }
        for &number in &self.stepped {
            let mut held = [0.0; 2];
            self.columns[number].read(self.since_s, &mut held);
            u[2 * number + 1] = held[1];
            if self.columns[number].next {
                u[2 * number] = held[0];
            }
        }
    }

    /// Reads the columns that step anew at an event. Whether one of them changes.
    pub(crate) fn enter(&mut self, t: f64) -> bool {
        let mut changed = false;
        for &number in &self.stepped {
            let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
            self.columns[number].read(self.since_s, &mut before);
            self.columns[number].read(t, &mut after);
            changed |= before[1].to_bits() != after[1].to_bits();
        }
        self.since_s = t;
        changed
    }

    /// The instant that columns which step were read at last.
    pub(crate) fn since_s(&self) -> f64 {
        self.since_s
    }

    /// Reads those columns as they were at an instant.
    pub(crate) fn stay_since(&mut self, t: f64) {
        self.since_s = t;
    }

    /// Reads all columns.
    pub(crate) fn read(&mut self, t: f64, u: &mut [f64]) {
        for (number, column) in self.columns.iter_mut().enumerate() {
            column.read(t, &mut u[2 * number..2 * number + 2]);
        }
    }

    /// The next instant after `t` at which a column that the equations read jumps.
    pub(crate) fn next_jump(&self, t: f64) -> f64 {
        let later = |&number: &usize| {
            let jumps = &self.columns[number].jumps;
            jumps.get(jumps.partition_point(|&jump| jump <= t)).copied()
        };
        let jumps = self.continuous.iter().filter_map(later);
        let row = |&number: &usize| {
            let column = &self.columns[number];
            let mut cursor = column.cursor;
            column
                .signal
                .next_instant(t + 1e-12 + 1e-13 * t.abs(), &mut cursor)
        };
        let rows = self.stepped.iter().filter_map(row);
        jumps.chain(rows).fold(f64::INFINITY, f64::min)
    }

    /// A step of time for a difference: a ten-millionth of the time since the start, more where the clock does not resolve it,
    /// and not beyond the next row of a column that the equations
    /// read, for there it has a kink. A row that is nearer than a thousandth of the step counts as reached.
    pub(crate) fn difference_s(&self, t: f64) -> f64 {
        let since = 1e-7 * (1e-3 + (t - self.start_s).abs());
        let step = since.max(RESOLUTIONS * (t.abs().next_up() - t.abs()));
        let left = |&number: &usize| {
            let column = &self.columns[number];
            let mut cursor = column.cursor;
            Some(column.signal.next_instant(t, &mut cursor)? - t)
        };
        let each = self.continuous.iter().filter_map(left);
        each.filter(|left| *left >= 1e-3 * step)
            .fold(step, f64::min)
    }

    /// A step that does not skip rows of the columns that the equations read.
    pub(crate) fn max_step_s(&self) -> f64 {
        let spacing = |&number: &usize| self.columns[number].mean_step_s;
        2.0 * self
            .continuous
            .iter()
            .map(spacing)
            .fold(f64::INFINITY, f64::min)
    }
}

impl Input<'_> {
    fn read(&mut self, t: f64, out: &mut [f64]) {
        // A tick at k times the period and a row at the same decimal number may differ by rounding.
        let now = t + 1e-12 + 1e-13 * t.abs();
        if self.next {
            let value = self.signal.next(now, &mut self.cursor);
            out[0] = value;
            out[1] = value;
        } else {
            out[0] = self.signal.linear(t, &mut self.cursor);
            out[1] = self.signal.held(now, &mut self.cursor);
        }
    }
}
