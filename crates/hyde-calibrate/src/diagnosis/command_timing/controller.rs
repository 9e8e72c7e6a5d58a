//! [`Controller`]: the clocked parts that put a command out, run beside the track of an observer.

use super::{Uncompared, Why};
use crate::observer::{Place, Track, Vectors, When};
use crate::records::Recording;
use hyde_program::{Constant, Function, Point, Program, TickWrt, Workspace, Wrt};

/// Numerics: periods of the clock by which the record is moved, either way.
const PERIODS: i64 = 3;
/// Numerics: a clock ticks with the rows of a record if its times are multiples of theirs but for this part of a row.
const WITH_ROWS: f64 = 1e-3;

/// The clocked parts that put a command out.
pub(super) struct Controller<'p> {
    program: &'p Program,
    /// What the model has for the command, and what was recorded.
    outputs: [usize; 2],
    pub(super) clocks: Vec<Ticks>,
    /// The places of the memory that they write, and those that hold what they put out.
    own: Vec<usize>,
    /// Channels that measure one unknown: channel, output, position, derivative.
    measured: Vec<(usize, usize, usize, f64)>,
}

/// When a clock ticks, in rows, and what it declares.
pub(super) struct Ticks {
    pub(super) clock: usize,
    every: i64,
    first: i64,
    /// From its tick to the change of what is held.
    delay: i64,
    pub(super) period_s: f64,
    pub(super) delay_s: f64,
}

impl Ticks {
    /// `None` where the clock does not tick with the rows.
    fn of(program: &Program, recording: &Recording, p: &[f64], clock: usize) -> Option<Self> {
        let in_rows = |which| {
            let rows = program.kernels.constant(which, p)? / recording.step_s;
            let whole = rows.round();
            ((rows - whole).abs() <= WITH_ROWS * whole.max(1.0)).then_some(whole as i64)
        };
        let every = in_rows(Constant::Period(clock)).filter(|every| *every >= 1)?;
        let delay_s = program.kernels.constant(Constant::Delay(clock), p)?;
        Some(Self {
            clock,
            every,
            first: in_rows(Constant::Phase(clock))?,
            delay: (delay_s / recording.step_s - WITH_ROWS).ceil().max(0.0) as i64,
            period_s: program.kernels.constant(Constant::Period(clock), p)?,
            delay_s,
        })
    }

    /// A command that the clock puts out, and that is not compared.
    pub(super) fn uncompared(&self, replayed: usize, why: Why) -> Uncompared {
        Uncompared {
            replayed,
            clock: self.clock,
            why,
        }
    }
}

impl<'p> Controller<'p> {
    /// That of a replayed command, in a record; `None` where no clocked part puts it out.
    pub(super) fn of(
        program: &'p Program,
        recording: &Recording,
        p: &[f64],
        replayed: usize,
    ) -> Option<Result<Self, Uncompared>> {
        let command = &program.experiment.replayed[replayed];
        let needed = needed(program, command.output, p);
        let number = *needed.first()?;
        let because = |clock: usize, why: Why| {
            Some(Err(Uncompared {
                replayed,
                clock,
                why,
            }))
        };
        if !program.foreign.is_empty() {
            return because(number, Why::Parts);
        }
        if command.column.is_none() {
            return because(number, Why::Columns);
        }
        let mut clocks = Vec::new();
        for clock in needed {
            let Some(ticks) = Ticks::of(program, recording, p, clock) else {
                let period_s = program.kernels.constant(Constant::Period(clock), p);
                let why = Why::Clock {
                    period_s: period_s.unwrap_or(f64::NAN),
                    step_s: recording.step_s,
                };
                return because(clock, why);
            };
            clocks.push(ticks);
        }
        let writes = |own: &Ticks| {
            let held = program.holds.iter().filter(|hold| hold.clock == own.clock);
            let held = held.flat_map(|hold| hold.target..hold.target + hold.len);
            let targets = program.kernels.tick_targets(own.clock);
            targets.into_iter().chain(held).collect::<Vec<usize>>()
        };
        Some(Ok(Self {
            program,
            outputs: [command.output, command.recorded],
            own: clocks.iter().flat_map(writes).collect(),
            clocks,
            measured: measured(program, p),
        }))
    }

    /// The rows by which the record is moved at most.
    pub(super) fn most(&self) -> i64 {
        PERIODS * self.clocks.iter().map(|own| own.every).max().unwrap_or(1)
    }

    /// What it puts out in each row, and what was recorded.
    pub(super) fn along(
        &self,
        track: &Track<'_>,
        recording: &Recording,
        p: &[f64],
    ) -> [Vec<f64>; 2] {
        let program = self.program;
        let command = program.kernels.some_rows(Function::Outputs, &self.outputs);
        let shown: Vec<usize> = self.measured.iter().map(|own| own.1).collect();
        let shown = program.kernels.some_rows(Function::Outputs, &shown);
        let mut workspace = Workspace::new(program.n_work);
        let (mut room, mut outputs) = (Vectors::default(), vec![0.0; self.measured.len()]);
        let mut memory: Option<Vec<f64>> = None;
        let mut pending: Vec<(i64, usize, Vec<f64>)> = Vec::new();
        let mut found = [Vec::new(), Vec::new()];
        for row in 0..recording.rows() {
            let at = track.point(Place::Row(row, When::After), p, &mut room);
            let mut z = at.z.to_vec();
            if let Some(memory) = &memory {
                self.own.iter().for_each(|&place| z[place] = memory[place]);
            }
            let mut y = at.y.to_vec();
            shown.evaluate(at, &mut workspace, &mut outputs);
            for (&(channel, _, position, derivative), output) in self.measured.iter().zip(&outputs)
            {
                let error = recording.error(channel, row, *output);
                if error.is_finite() {
                    y[position] += error / derivative;
                }
            }
            for own in self.ticking(row as i64) {
                let at = Point { y: &y, z: &z, ..at };
                let mut after = z.clone();
                program
                    .kernels
                    .tick(own.clock, at, &mut workspace, &mut after);
                z = after;
                let holds = program.holds.iter().filter(|hold| hold.clock == own.clock);
                pending.extend(holds.map(|hold| {
                    let values = z[hold.source..hold.source + hold.len].to_vec();
                    (row as i64 + own.delay, hold.target, values)
                }));
            }
            pending.retain(|(when, target, values)| {
                let due = *when <= row as i64;
                if due {
                    z[*target..*target + values.len()].copy_from_slice(values);
                }
                !due
            });
            let mut values = [0.0; 2];
            let at = Point { y: &y, z: &z, ..at };
            command.evaluate(at, &mut workspace, &mut values);
            let each = found.iter_mut().zip(values);
            each.for_each(|(list, value)| list.push(value));
            memory = Some(z);
        }
        found
    }

    /// The clocks that tick in a row, in the order of the data.
    fn ticking(&self, row: i64) -> impl Iterator<Item = &Ticks> {
        let order = self.program.clock_order.iter();
        let known = order.filter_map(|&clock| self.clocks.iter().find(|own| own.clock == clock));
        known.filter(move |own| row >= own.first && (row - own.first) % own.every == 0)
    }
}

/// The clocks by which an output changes, and those that they read.
fn needed(program: &Program, output: usize, p: &[f64]) -> Vec<usize> {
    let entries = program.kernels.still_entries(Function::Outputs);
    let mut read: Vec<usize> = entries
        .iter()
        .filter(|entry| entry.row == output)
        .filter_map(|entry| match entry.wrt {
            Wrt::Memory(place) => Some(place),
            Wrt::Unknown(_)
            | Wrt::Derivative(_)
            | Wrt::Parameter(_)
            | Wrt::Delayed(_)
            | Wrt::Time => None,
        })
        .collect();
    let start = Start::of(program, p);
    let at = start.point(p);
    let mut workspace = Workspace::new(program.n_work);
    let mut clocks: Vec<usize> = Vec::new();
    while let Some(place) = read.pop() {
        let held = program
            .holds
            .iter()
            .find(|hold| (hold.target..hold.target + hold.len).contains(&place))
            .map(|hold| hold.clock);
        let all = 0..program.clocks.len();
        let writes = |clock: &usize| program.kernels.tick_targets(*clock).contains(&place);
        let Some(clock) = held.or_else(|| all.into_iter().find(writes)) else {
            continue;
        };
        if !clocks.contains(&clock) {
            clocks.push(clock);
            let partials = program.kernels.tick_partials(clock, at, &mut workspace);
            read.extend(partials.into_iter().filter_map(|(_, wrt, _)| match wrt {
                TickWrt::Memory(place) => Some(place),
                TickWrt::Unknown(_)
                | TickWrt::Derivative(_)
                | TickWrt::Delayed(_)
                | TickWrt::Parameter(_) => None,
            }));
        }
    }
    clocks
}

/// Channels that measure one unknown alone, as it is: channel, output, position, derivative.
fn measured(program: &Program, p: &[f64]) -> Vec<(usize, usize, usize, f64)> {
    let start = Start::of(program, p);
    let at = start.point(p);
    let entries = program.partials(Function::Outputs);
    let mut values = vec![0.0; entries.len()];
    let mut workspace = Workspace::new(program.n_work);
    program
        .kernels
        .partials(Function::Outputs, at, &mut workspace, &mut values);
    let channels = program.experiment.measured.iter().enumerate();
    let plain = channels.filter(|(_, own)| own.preparation.is_empty() && own.late.is_none());
    plain
        .filter_map(|(channel, own)| {
            let mut by = entries.iter().zip(&values);
            let mut by = by.by_ref().filter(|(entry, _)| entry.row == own.output);
            let ((entry, value), None) = (by.next()?, by.next()) else {
                return None;
            };
            match entry.wrt {
                Wrt::Unknown(position) if *value != 0.0 => {
                    Some((channel, own.output, position, *value))
                }
                Wrt::Unknown(_)
                | Wrt::Derivative(_)
                | Wrt::Parameter(_)
                | Wrt::Memory(_)
                | Wrt::Delayed(_)
                | Wrt::Time => None,
            }
        })
        .collect()
}

/// The start values of a program, with nothing that drives it: where structure is asked for.
struct Start {
    y: Vec<f64>,
    z: Vec<f64>,
    /// Zeros, for rates and for what drives it.
    nothing: Vec<f64>,
}

impl Start {
    fn of(program: &Program, p: &[f64]) -> Self {
        let (mut y, mut z) = (vec![0.0; program.n_unknowns], vec![0.0; program.n_memory]);
        program.kernels.start(p, &mut y, &mut z);
        let driving = 2 * program.columns.len() + program.delays.len();
        Self {
            nothing: vec![0.0; driving.max(y.len())],
            y,
            z,
        }
    }

    fn point<'a>(&'a self, p: &'a [f64]) -> Point<'a> {
        Point {
            t: 0.0,
            y: &self.y,
            yp: &self.nothing[..self.y.len()],
            z: &self.z,
            u: &self.nothing,
            p,
        }
    }
}
