//! The clocked parts of a linearised system: what each tick makes of memory, samples and inputs (S3), and when.

use crate::linearize::{Dense, Parts, Through};
use hyde_program::{Constant, Function, Point, Program, TickWrt, Workspace, Wrt};
use nalgebra::DMatrix;

/// The linearised clocked parts. Of the memory only what ticks write is kept; all else does not change.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// In the order in which clocks that tick together run.
    pub clocks: Vec<Clocked>,
    /// Held values by memory: selects what each holds.
    pub select: DMatrix<f64>,
    /// Of each held value the clock that changes it, by its place in `clocks`.
    pub holder: Vec<usize>,
    /// The program's outputs by memory.
    pub outputs: DMatrix<f64>,
    /// Positions of the memory that is kept.
    pub written: Vec<usize>,
}

/// One clock: memory after its tick is `memory*m + by_state*x + by_input*u + by_held*h`, all just before the tick.
#[derive(Clone, Debug)]
pub struct Clocked {
    /// Period in s.
    pub period: f64,
    /// First tick in s.
    pub phase: f64,
    /// From the tick to the change of held values, in s.
    pub delay: f64,
    /// Memory by memory before.
    pub memory: DMatrix<f64>,
    /// Memory by states.
    pub by_state: DMatrix<f64>,
    /// Memory by inputs.
    pub by_input: DMatrix<f64>,
    /// Memory by held values before the tick.
    pub by_held: DMatrix<f64>,
}

/// The clocked parts at an operating point; `None` where nothing is held.
pub(crate) fn sampled(
    program: &Program,
    at: Point<'_>,
    work: &mut Workspace,
    parts: &Parts<'_>,
    (inputs, held): (&[usize], &[usize]),
) -> Option<Sampled> {
    if program.clocks.is_empty() || held.is_empty() {
        return None;
    }
    let partials: Vec<_> = program
        .clock_order
        .iter()
        .map(|&clock| program.kernels.tick_partials(clock, at, work))
        .collect();
    let mut written: Vec<usize> = partials.iter().flatten().map(|(row, ..)| *row).collect();
    written.sort_unstable();
    written.dedup();
    let place = |position: usize| written.binary_search(&position).ok();
    let size = written.len();
    let directions = program.kernels.parameter_directions(inputs, at.p);
    let mut clocks = Vec::new();
    for (&clock, partials) in program.clock_order.iter().zip(&partials) {
        let constant = |which| program.kernels.constant(which, at.p).unwrap_or(f64::NAN);
        let mut memory = DMatrix::<f64>::identity(size, size);
        let mut samples = Dense::zeros(size, program.n_unknowns, parts.nu, held.len(), parts.nd);
        for row in partials.iter().filter_map(|(row, ..)| place(*row)) {
            memory[(row, row)] = 0.0;
        }
        for &(row, wrt, value) in partials {
            let Some(row) = place(row) else { continue };
            match wrt {
                TickWrt::Memory(position) => {
                    if let Some(column) = place(position) {
                        memory[(row, column)] += value;
                    } else if let Some(column) = held.iter().position(|&held| held == position) {
                        samples.by_held[(row, column)] += value;
                    }
                }
                TickWrt::Unknown(column) => samples.by_unknown[(row, column)] += value,
                TickWrt::Derivative(column) => samples.by_derivative[(row, column)] += value,
                TickWrt::Delayed(column) => samples.by_delayed[(row, column)] += value,
                TickWrt::Parameter(place) => {
                    for (column, direction) in directions.iter().enumerate() {
                        samples.by_input[(row, column)] += value * direction[place];
                    }
                }
            }
        }
        let Through {
            by_state,
            by_input,
            by_held,
            by_delayed: _,
        } = parts.through(&samples);
        clocks.push(Clocked {
            period: constant(Constant::Period(clock)),
            phase: constant(Constant::Phase(clock)),
            delay: constant(Constant::Delay(clock)),
            memory,
            by_state,
            by_input,
            by_held,
        });
    }
    let mut select = DMatrix::zeros(held.len(), size);
    let sources = program.holds.iter();
    let sources = sources.flat_map(|hold| hold.source..hold.source + hold.len);
    for (row, source) in sources.enumerate() {
        // A source that no tick changes is held as it is.
        if let Some(column) = place(source) {
            select[(row, column)] = 1.0;
        }
    }
    let holder = program.holds.iter().flat_map(|hold| {
        let clock = program
            .clock_order
            .iter()
            .position(|&clock| clock == hold.clock);
        std::iter::repeat_n(clock.unwrap_or(0), hold.len)
    });
    let mut outputs = DMatrix::zeros(program.rows(Function::Outputs), size);
    let entries = program.kernels.still_entries(Function::Outputs);
    let mut values = vec![0.0; entries.len()];
    let kernels = &program.kernels;
    kernels.still_partials(Function::Outputs, at, work, &mut values);
    for (entry, value) in entries.iter().zip(values) {
        if let Wrt::Memory(position) = entry.wrt
            && let Some(column) = place(position)
        {
            outputs[(entry.row, column)] += value;
        }
    }
    Some(Sampled {
        outputs,
        holder: holder.collect(),
        clocks,
        select,
        written,
    })
}
