//! [`Equations`]: what a person writes of a problem, and the kernels and the program made of it.
//!
//! A derivative is written with its place, so that the order of [`Kernels::entries`] is that of [`Kernels::partials`].

use hyde_diag::{InstancePath, Origin, Sources, Span};
use hyde_program::{
    Coefficients, Constant, Derivatives, Experiment, Function, InitialCondition, Kernels, Output,
    PartialEntry, Point, Program, SomeRows, TickWrt, UnknownBlock, Workspace, Wrt,
};
use hyde_sim::{Failure, Results, Setup, simulate};
use hyde_units::{Dimension, NamedUnit};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The relative and the absolute tolerance of every run here.
pub(crate) const RTOL: f64 = 1e-8;
pub(crate) const ATOL: f64 = 1e-10;

/// A derivative: row of the function, with respect to what, value. A place stands in the list in every mode.
pub(crate) type Partial = (usize, Wrt, f64);

/// The mathematics of a problem.
pub(crate) trait Equations: Send + Sync + 'static {
    /// The declared parameters.
    fn declared(&self) -> Vec<f64>;

    /// The parameters that follow from the declared ones; they stand behind them.
    fn derived(&self, _declared: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    /// Start values; vectors come in as zeros.
    fn start(&self, p: &[f64], y: &mut [f64], z: &mut [f64]);

    /// A number that parameters alone determine.
    fn constant(&self, _which: Constant, _p: &[f64]) -> Option<f64> {
        None
    }

    /// The values of a function, as many as it has rows.
    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64>;

    /// Its derivatives by unknowns, their derivatives and time.
    fn partials(&self, function: Function, at: Point<'_>) -> Vec<Partial>;

    /// Its derivatives by declared parameters, those by way of derived ones included.
    fn parameter_partials(&self, _function: Function, _at: Point<'_>) -> Vec<Partial> {
        Vec::new()
    }

    /// The derivatives of the start values by declared parameters: row (vector, then memory), parameter, value.
    fn start_partials(&self, _p: &[f64]) -> Vec<(usize, usize, f64)> {
        Vec::new()
    }

    /// Truth of every reaction's condition.
    fn conditions(&self, _z: &[f64]) -> Vec<f64> {
        Vec::new()
    }

    /// What a tick writes to the memory.
    fn tick(&self, _clock: usize, _at: Point<'_>, _after: &mut [f64]) {}

    /// The derivatives of that.
    fn tick_partials(&self, _clock: usize, _at: Point<'_>) -> Vec<(usize, TickWrt, f64)> {
        Vec::new()
    }
}

/// A program of the equations, its tables but for unknowns, outputs and initial conditions empty: every state starts at
/// its start value.
pub(crate) fn program(
    equations: impl Equations,
    unknowns: Vec<UnknownBlock>,
    n_memory: usize,
    outputs: &[&str],
) -> Program {
    let declared = equations.declared();
    let states = unknowns.iter().filter(|block| block.differential);
    let initial = states.map(|block| InitialCondition::Fixed {
        state: block.offset,
        len: block.len,
        firmness: hyde_program::Firmness::Given,
        yields: false,
        origin: crate::by_hand::origin("start"),
    });
    let n_unknowns = unknowns.iter().map(|block| block.len).sum();
    Program {
        name: String::new(),
        initial: initial.collect(),
        unknowns,
        n_unknowns,
        n_memory,
        affine_in: None,
        n_work: 0,
        n_parameters: declared.len() + equations.derived(&declared).len(),
        parameters: Vec::new(),
        record_values: Vec::new(),
        columns: Vec::new(),
        outputs: outputs.iter().map(|name| output(name)).collect(),
        relations: Vec::new(),
        automata: Vec::new(),
        reactions: Vec::new(),
        assignments: Vec::new(),
        pins: Vec::new(),
        selections: Vec::new(),
        clocks: Vec::new(),
        clock_order: Vec::new(),
        holds: Vec::new(),
        delays: Vec::new(),
        turning: 0,
        angles: 0,
        exponential: false,
        timed: true,
        foreign: Vec::new(),
        derivatives: Derivatives::default(),
        experiment: Experiment::default(),
        notes: Vec::new(),
        kernels: Arc::new(ByHand {
            equations,
            n_unknowns,
            n_memory,
        }),
    }
}

/// A state at a position of the solver's vector; its equation comes from the instance of that name.
pub(crate) fn state(name: &str, offset: usize, instance: &str) -> UnknownBlock {
    UnknownBlock {
        name: name.to_owned(),
        first: None,
        offset,
        len: 1,
        differential: true,
        origins: vec![origin(instance)],
    }
}

/// An algebraic variable, likewise.
pub(crate) fn algebraic(name: &str, offset: usize, instance: &str) -> UnknownBlock {
    UnknownBlock {
        differential: false,
        ..state(name, offset, instance)
    }
}

/// Somewhere in the instance.
pub(crate) fn origin(instance: &str) -> Origin {
    let file = Sources::new().add("by hand", "");
    Origin::source(Span::new(file, 0, 0), &InstancePath::root().child(instance))
}

/// Runs a program from 0 with some parameters set, rows at the times given.
pub(crate) fn run(
    program: &Program,
    set: &[(usize, f64)],
    rows_s: Vec<f64>,
) -> Result<Results, Box<Failure>> {
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(set, &mut p);
    let records = BTreeMap::new();
    let stop = rows_s.last().copied().unwrap();
    let setup = Setup {
        rtol: RTOL,
        atol: ATOL,
        // Closed forms over many periods and turns.
        conserve: true,
        rows_s,
        ..Setup::new(p, &records, stop)
    };
    simulate(program, &setup)
}

/// The column of an output.
pub(crate) fn column(program: &Program, results: &Results, name: &str) -> Vec<f64> {
    let column = results.column(program.output(name).unwrap()).unwrap();
    column.into_owned()
}

fn output(name: &str) -> Output {
    Output {
        name: name.to_owned(),
        dimension: Dimension::DIMENSIONLESS,
        unit: NamedUnit::usual(Dimension::DIMENSIONLESS),
        discrete: false,
        auxiliary: false,
        same_as: None,
    }
}

/// The kernels of equations written by hand.
struct ByHand<E> {
    equations: E,
    n_unknowns: usize,
    n_memory: usize,
}

impl<E: Equations> ByHand<E> {
    /// What is found at some point; places of derivatives are the same at all.
    fn somewhere<T>(&self, of: impl Fn(Point<'_>) -> T) -> T {
        let mut p = self.equations.declared();
        p.extend(self.equations.derived(&p));
        let (y, z) = (vec![1.0; self.n_unknowns], vec![0.0; self.n_memory]);
        of(Point {
            t: 0.0,
            y: &y,
            yp: &y,
            z: &z,
            u: &[],
            p: &p,
        })
    }
}

impl<E: Equations> Kernels for ByHand<E> {
    fn parameters(&self, set: &[(usize, f64)], p: &mut [f64]) {
        let mut declared = self.equations.declared();
        for &(position, value) in set {
            declared[position] = value;
        }
        let derived = self.equations.derived(&declared);
        p.copy_from_slice(&[declared, derived].concat());
    }

    fn start(&self, p: &[f64], y: &mut [f64], z: &mut [f64]) {
        y.fill(0.0);
        z.fill(0.0);
        self.equations.start(p, y, z);
    }

    fn constant(&self, which: Constant, p: &[f64]) -> Option<f64> {
        self.equations.constant(which, p)
    }

    fn evaluate(&self, function: Function, at: Point<'_>, _: &mut Workspace, out: &mut [f64]) {
        out.copy_from_slice(&self.equations.values(function, at));
    }

    fn some_rows(&self, function: Function, rows: &[usize]) -> Box<dyn SomeRows + '_> {
        panic!("no problem here is asked for rows {rows:?} of {function:?} alone")
    }

    fn some_still_partials(&self, function: Function, numbers: &[usize]) -> Box<dyn SomeRows + '_> {
        panic!("no problem here is asked for derivatives {numbers:?} of {function:?} alone")
    }

    fn bending_rows(&self) -> &[usize] {
        panic!("no problem here is asked what bends")
    }

    fn coefficients(&self) -> Coefficients {
        panic!("no problem here is asked for its coefficients")
    }

    fn entries(&self, function: Function) -> Vec<PartialEntry> {
        let partials = self.somewhere(|at| self.equations.partials(function, at));
        let places = partials.into_iter().map(|(row, wrt, _)| (row, wrt));
        places.map(|(row, wrt)| PartialEntry { row, wrt }).collect()
    }

    fn partials(&self, function: Function, at: Point<'_>, _: &mut Workspace, out: &mut [f64]) {
        let partials = self.equations.partials(function, at);
        assert_eq!(partials.len(), out.len(), "as many values as entries");
        for (value, (_, _, partial)) in out.iter_mut().zip(partials) {
            *value = partial;
        }
    }

    fn still_entries(&self, function: Function) -> Vec<PartialEntry> {
        let partials = self.somewhere(|at| self.equations.parameter_partials(function, at));
        let places = partials.into_iter().map(|(row, wrt, _)| (row, wrt));
        places.map(|(row, wrt)| PartialEntry { row, wrt }).collect()
    }

    fn still_partials(
        &self,
        function: Function,
        at: Point<'_>,
        _: &mut Workspace,
        out: &mut [f64],
    ) {
        let partials = self.equations.parameter_partials(function, at);
        assert_eq!(partials.len(), out.len(), "as many values as entries");
        for (value, (_, _, partial)) in out.iter_mut().zip(partials) {
            *value = partial;
        }
    }

    /// The derivatives of the equations count those by way of derived parameters.
    fn parameter_directions(&self, chosen: &[usize], p: &[f64]) -> Vec<Vec<f64>> {
        let unit = |&place: &usize| {
            let mut direction = vec![0.0; p.len()];
            direction[place] = 1.0;
            direction
        };
        chosen.iter().map(unit).collect()
    }

    fn start_partials(&self, p: &[f64]) -> Vec<(usize, usize, f64)> {
        self.equations.start_partials(p)
    }

    fn instant_partials(&self, which: Constant, _p: &[f64]) -> Vec<(usize, f64)> {
        panic!("no instant of a problem here depends on parameters: {which:?}")
    }

    fn conditions(&self, at: Point<'_>, _: &mut Workspace, out: &mut [f64]) {
        out.copy_from_slice(&self.equations.conditions(at.z));
    }

    fn tick(&self, clock: usize, at: Point<'_>, _: &mut Workspace, after: &mut [f64]) {
        self.equations.tick(clock, at, after);
    }

    fn tick_partials(
        &self,
        clock: usize,
        at: Point<'_>,
        _: &mut Workspace,
    ) -> Vec<(usize, TickWrt, f64)> {
        self.equations.tick_partials(clock, at)
    }

    fn tick_targets(&self, clock: usize) -> Vec<usize> {
        let partials = self.somewhere(|at| self.equations.tick_partials(clock, at));
        partials.into_iter().map(|(row, _, _)| row).collect()
    }

    fn measures(&self, _p: &[f64], _reductions: &[f64], out: &mut [f64]) {
        assert!(out.is_empty(), "no problem here has an experiment");
    }
}
