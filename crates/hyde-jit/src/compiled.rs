//! [`Compiled`]: the kernels of a DAE, by machine code or by interpretation.

use crate::interpret::{Frame, Interpreter};
use crate::native::Native;
use crate::routine::{self, Leaf, Routine, Slot, Step};
use crate::some_rows::{Chosen, Known, Wanted};
use crate::still::Still;
use hyde_ir::dae::{self, Dae, Space};
use hyde_ir::{ClockId, Expr, ExprId, Id as _, Index, ParamId, VariableKind};
use hyde_program::{
    Coefficients, Constant, Function, Kernels, PartialEntry, Point, SomeRows, TickWrt, Workspace,
    Wrt,
};
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// How numbers are made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Backend {
    /// Machine code by Cranelift.
    #[default]
    Native,
    /// The interpreter of the IR: slow, the oracle of the tests.
    Interpreter,
}

/// The kernels of a DAE.
pub(crate) struct Compiled {
    pub(crate) dae: Dae,
    backend: Backend,
    /// One for each function, in the order of [`Function::ALL`].
    values: Vec<Kernel>,
    partials: Vec<Kernel>,
    ticks: Vec<Kernel>,
    conditions: Kernel,
    /// Parameters in the order of computation.
    parameters: Vec<(ParamId, Interpreter)>,
    start: Interpreter,
    still: OnceLock<Still>,
    some_rows: Known,
    bending: OnceLock<Vec<usize>>,
    /// The length of the vector of inputs, delayed values included.
    n_inputs: usize,
}

/// A kernel, made at its first use.
struct Kernel {
    routine: Routine,
    /// How many values it writes.
    count: usize,
    code: OnceLock<Code>,
}

/// What runs a routine.
pub(crate) enum Code {
    Native(Box<Native>),
    Interpreter(Interpreter),
}

impl Code {
    /// Machine code, or the interpreter where it is asked for or Cranelift makes no code for this machine.
    pub(crate) fn new(dae: &Dae, routine: &Routine, backend: Backend) -> Self {
        let native = match backend {
            Backend::Native => Native::new(dae, routine),
            Backend::Interpreter => None,
        };
        match native {
            Some(native) => Self::Native(Box::new(native)),
            None => Self::Interpreter(Interpreter::new(dae, routine)),
        }
    }

    #[inline(always)]
    pub(crate) fn run(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]) {
        match self {
            Self::Native(native) => native.run(at, workspace, out),
            Self::Interpreter(interpreter) => {
                interpreter.run(&mut Frame::at(at, &mut workspace.work, out));
            }
        }
    }
}

impl Compiled {
    pub(crate) fn new(dae: Dae, backend: Backend) -> Self {
        let kernel = |routine: Routine, count: usize| Kernel {
            routine,
            count,
            code: OnceLock::new(),
        };
        let values = Function::ALL
            .into_iter()
            .map(|f| kernel(Routine::values(&dae, f), dae.rows(f)))
            .collect();
        let entries = |f| dae.partials(f).iter().map(|partial| partial.range.len());
        let partials = Function::ALL
            .into_iter()
            .map(|f| kernel(partials_of(&dae, f), entries(f).sum()))
            .collect();
        let ticks = dae
            .ticks
            .ids()
            .map(|clock| kernel(Routine::tick(&dae, clock), dae.n_memory))
            .collect();
        let conditions = kernel(Routine::conditions(&dae), dae.reactions.len());
        let parameters = dae
            .parameter_order
            .iter()
            .map(|&param| {
                (
                    param,
                    Interpreter::new(&dae, &Routine::parameter(&dae, param)),
                )
            })
            .collect();
        let start = Interpreter::new(&dae, &start_routine(&dae));
        let n_inputs = 2 * dae.columns.len() + dae.n_delayed();
        Self {
            dae,
            backend,
            values,
            partials,
            ticks,
            conditions,
            parameters,
            start,
            still: OnceLock::new(),
            some_rows: Known::default(),
            bending: OnceLock::new(),
            n_inputs,
        }
    }

    #[inline]
    fn run(&self, kernel: &Kernel, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]) {
        let code = kernel
            .code
            .get_or_init(|| Code::new(&self.dae, &kernel.routine, self.backend));
        self.check(at, workspace);
        assert!(out.len() >= kernel.count, "room for every value");
        code.run(at, workspace, out);
    }

    /// Machine code does not check bounds: the lengths are checked here, at every call.
    #[inline]
    pub(crate) fn check(&self, at: Point<'_>, workspace: &Workspace) {
        let dae = &self.dae;
        let enough = at.y.len() >= dae.n_unknowns
            && at.yp.len() >= dae.n_unknowns
            && at.z.len() >= dae.n_memory
            && at.u.len() >= self.n_inputs
            && at.p.len() >= dae.n_parameters.1
            && workspace.work.len() >= dae.n_work;
        assert!(
            enough,
            "a kernel is called with vectors of its program's lengths"
        );
    }
}

impl Kernels for Compiled {
    fn parameters(&self, set: &[(usize, f64)], p: &mut [f64]) {
        let set: BTreeMap<usize, f64> = set.iter().copied().collect();
        // What the parameters before this one are.
        let mut known = p.to_vec();
        for (param, code) in &self.parameters {
            let place = self.dae.parameter_places[*param];
            let own = place..place + self.dae.parameters[*param].size();
            code.run(&mut Frame::of_parameters(&known, p));
            for (&position, &value) in set.range(own.clone()) {
                p[position] = value;
            }
            known[own.clone()].copy_from_slice(&p[own]);
        }
    }

    fn start(&self, p: &[f64], y: &mut [f64], z: &mut [f64]) {
        y.iter_mut()
            .chain(z.iter_mut())
            .for_each(|value| *value = 0.0);
        let mut out = vec![0.0; y.len() + z.len()];
        self.start.run(&mut Frame::of_parameters(p, &mut out));
        y.copy_from_slice(&out[..y.len()]);
        z.copy_from_slice(&out[y.len()..]);
    }

    fn constant(&self, which: Constant, p: &[f64]) -> Option<f64> {
        self.evaluate_known(self.constant_value(which)?, p, &[])
    }

    fn evaluate(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    ) {
        self.run(&self.values[function as usize], at, workspace, out);
    }

    fn some_rows(&self, function: Function, rows: &[usize]) -> Box<dyn SomeRows + '_> {
        self.chosen(Wanted::Rows(function, rows.to_vec()), rows.len())
    }

    fn bending_rows(&self) -> &[usize] {
        self.bending
            .get_or_init(|| crate::bending::bending_rows(&self.dae))
    }

    fn coefficients(&self) -> Coefficients {
        crate::bending::coefficients(&self.dae)
    }

    fn entries(&self, function: Function) -> Vec<PartialEntry> {
        entries(self.dae.partials(function))
    }

    fn sliding_cells(&self) -> Vec<(usize, usize)> {
        hyde_analysis::sliding_cells(&self.dae)
    }

    fn partials(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    ) {
        self.run(&self.partials[function as usize], at, workspace, out);
    }

    fn still_entries(&self, function: Function) -> Vec<PartialEntry> {
        self.still().entries(function).to_vec()
    }

    fn still_partials(
        &self,
        function: Function,
        at: Point<'_>,
        workspace: &mut Workspace,
        out: &mut [f64],
    ) {
        self.check(at, workspace);
        let still = self.still();
        still.partials(function, at, workspace, out);
    }

    fn some_still_partials(&self, function: Function, numbers: &[usize]) -> Box<dyn SomeRows + '_> {
        self.chosen(Wanted::Still(function, numbers.to_vec()), numbers.len())
    }

    fn parameter_directions(&self, chosen: &[usize], p: &[f64]) -> Vec<Vec<f64>> {
        self.still().parameter_directions(chosen, p)
    }

    fn start_partials(&self, p: &[f64]) -> Vec<(usize, usize, f64)> {
        self.still().start_partials(p)
    }

    fn instant_partials(&self, which: Constant, p: &[f64]) -> Vec<(usize, f64)> {
        match self.constant_value(which) {
            Some(id) => self.still().instant_partials(id, p),
            None => Vec::new(),
        }
    }

    fn conditions(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]) {
        self.run(&self.conditions, at, workspace, out);
    }

    fn tick(&self, clock: usize, at: Point<'_>, workspace: &mut Workspace, after: &mut [f64]) {
        self.run(&self.ticks[clock], at, workspace, after);
    }

    fn tick_partials(
        &self,
        clock: usize,
        at: Point<'_>,
        workspace: &mut Workspace,
    ) -> Vec<(usize, TickWrt, f64)> {
        self.check(at, workspace);
        self.still().tick_partials(clock, at, workspace)
    }

    fn tick_targets(&self, clock: usize) -> Vec<usize> {
        let place = |assignment: &dae::ClockedAssignment| {
            let base = self.dae.place(assignment.var)?.base;
            let elements = assignment.range.iter().map(|c| assignment.index.at(c));
            let positions = elements.filter_map(|e| Some(base + usize::try_from(e).ok()?));
            Some(positions.collect::<Vec<_>>())
        };
        let ticks = &self.dae.ticks[ClockId::from_index(clock)];
        ticks
            .assignments
            .iter()
            .filter_map(place)
            .flatten()
            .collect()
    }

    fn measures(&self, p: &[f64], reductions: &[f64], out: &mut [f64]) {
        for (measure, value) in self.dae.experiment.measures.iter().zip(out) {
            *value = self
                .evaluate_known(measure.value, p, reductions)
                .unwrap_or(f64::NAN);
        }
    }
}

impl Compiled {
    /// The value of an expression of parameters and reductions; `None` where it reads anything else.
    fn evaluate_known(&self, id: ExprId, p: &[f64], reductions: &[f64]) -> Option<f64> {
        let leaf = |expr: Expr| {
            let value = if let Expr::Param(param, index) = expr {
                let offset = usize::try_from(index.offset).unwrap_or(0);
                p.get(self.dae.parameter_places[param] + offset)
            } else if let Expr::Var(var, _) = expr
                && let VariableKind::Reduction(number) = self.dae.variables[var].kind
            {
                reductions.get(number)
            } else {
                None
            };
            value.copied().ok_or(())
        };
        self.dae.exprs.evaluate_known(id, leaf).ok()
    }

    /// The expression of a number that parameters alone determine.
    fn constant_value(&self, which: Constant) -> Option<ExprId> {
        let dae = &self.dae;
        let experiment = &dae.experiment;
        let option = |name: &str| {
            experiment
                .solve
                .iter()
                .find(|(known, _)| known == name)
                .map(|(_, value)| *value)
        };
        let stepped = |bode: usize| experiment.bodes.get(bode)?.stepped.as_ref();
        Some(match which {
            Constant::Period(clock) => dae.ticks[ClockId::from_index(clock)].period,
            Constant::Delay(clock) => dae.ticks[ClockId::from_index(clock)].delay,
            Constant::Phase(clock) => dae.ticks[ClockId::from_index(clock)].phase,
            Constant::Lateness(number) => {
                let each = dae.delays.iter();
                let mut each = each.flat_map(|delay| delay.range.iter().map(|_| delay.time));
                each.nth(number)?
            }
            Constant::TimeEvent(relation) => {
                dae.relations[hyde_ir::RelationId::from_index(relation)].time_event?
            }
            Constant::Turning(number) => *dae.turning.get(number)?,
            Constant::Start => experiment.start?,
            Constant::Stop => experiment.stop?,
            Constant::Every => experiment.every?,
            Constant::Skip => experiment.skip?,
            Constant::Rtol => option("rtol")?,
            Constant::Atol => option("atol")?,
            Constant::MaxStep => option("max_step")?,
            Constant::Noise(channel) => experiment.measured.get(channel)?.noise?,
            Constant::Rounding(channel) => experiment.measured.get(channel)?.rounding?,
            Constant::Wrap(channel) => experiment.measured.get(channel)?.period?,
            Constant::BandFrom(bode) => experiment.bodes.get(bode)?.band?.0,
            Constant::BandTo(bode) => experiment.bodes.get(bode)?.band?.1,
            Constant::RespondsAt(bode) => experiment.bodes.get(bode)?.at.time()?,
            Constant::CutAt(cut) => experiment.cuts.get(cut)?.at.time()?,
            Constant::SearchedFrom(cut) => experiment.cuts.get(cut)?.band?.0,
            Constant::SearchedTo(cut) => experiment.cuts.get(cut)?.band?.1,
            Constant::Amplitude(bode) => stepped(bode)?.amplitude,
            Constant::Points(bode) => stepped(bode)?.points,
            Constant::Settle(bode) => stepped(bode)?.settle,
            Constant::Periods(bode) => stepped(bode)?.periods,
            Constant::Level(bode) => stepped(bode)?.keep?.1,
            Constant::Radius(figure) => match experiment.figures.get(figure)?.kind {
                hyde_ir::flat::FigureKind::Circle(_, radius) => radius,
                hyde_ir::flat::FigureKind::Panels(..) => return None,
            },
            Constant::ShownFrom(figure) => experiment.figures.get(figure)?.within?.0,
            Constant::ShownTo(figure) => experiment.figures.get(figure)?.within?.1,
        })
    }

    /// A part of a function as a kernel of its own, which writes so many values.
    fn chosen(&self, wanted: Wanted, count: usize) -> Box<dyn SomeRows + '_> {
        Box::new(Chosen {
            compiled: self,
            code: self.some_rows.code(&self.dae, wanted, self.backend),
            count,
        })
    }

    /// Derivatives by parameters and memory, made at the first use.
    fn still(&self) -> &Still {
        self.still
            .get_or_init(|| Still::new(&self.dae, self.backend))
    }
}

/// Every routine of a DAE, for printing.
pub(crate) fn routines(dae: &Dae) -> Vec<Routine> {
    let mut list = Vec::new();
    for function in Function::ALL {
        list.push(Routine::values(dae, function));
        list.push(partials_of(dae, function));
    }
    list.push(Routine::conditions(dae));
    list.extend(dae.ticks.ids().map(|clock| Routine::tick(dae, clock)));
    list.retain(|routine| !routine.steps.is_empty());
    list
}

/// The places of a list of derivatives, value by value.
pub(crate) fn entries(partials: &[dae::Partial]) -> Vec<PartialEntry> {
    let mut found = Vec::new();
    for partial in partials {
        for counter in partial.range.iter() {
            let at = |index: Index| usize::try_from(index.at(counter)).unwrap_or(usize::MAX);
            let wrt = match partial.wrt {
                dae::Wrt::Unknown(index) => Wrt::Unknown(at(index)),
                dae::Wrt::Derivative(index) => Wrt::Derivative(at(index)),
                dae::Wrt::Parameter(index) => Wrt::Parameter(at(index)),
                dae::Wrt::Memory(index) => Wrt::Memory(at(index)),
                dae::Wrt::Delayed(index) => Wrt::Delayed(at(index)),
                dae::Wrt::Time => Wrt::Time,
            };
            found.push(PartialEntry {
                row: at(partial.row),
                wrt,
            });
        }
    }
    found
}

/// The routine of a function's derivatives.
fn partials_of(dae: &Dae, function: Function) -> Routine {
    let name = format!("{}_partials", routine::name(function));
    Routine::partials(dae, name, dae.partials(function))
}

/// Start values of the vector, then of the memory.
fn start_routine(dae: &Dae) -> Routine {
    let n = i32::try_from(dae.n_unknowns).unwrap_or(0);
    let steps = dae.starts.iter().map(|start| {
        let base = i32::try_from(start.place.base).unwrap_or(0)
            + if start.place.space == Space::Memory {
                n
            } else {
                0
            };
        let target = Index {
            offset: start.index.offset + base,
            ..start.index
        };
        Step {
            range: start.range,
            slot: Slot::Out,
            target,
            value: start.value,
        }
    });
    let routine = Routine::plain("start", steps.collect());
    debug_assert!(
        routine.steps.iter().all(|step| dae.exprs.below(&[step.value]).into_iter().all(|id| {
            !matches!(routine.leaf(dae, dae.exprs[id]), Some(Leaf::Load(slot, _)) if slot != Slot::Parameter)
        })),
        "start values are of parameters alone"
    );
    routine
}
