//! [`State`]: the model where the run is, with everything a kernel needs. It is the system that IDA solves.

mod loose;
mod parameters;
mod sliding;
mod surfaces;
mod without_effect;

use crate::delays::Delays;
use crate::failure::Failure;
use crate::foreign::ForeignInstances;
use crate::inputs::Inputs;
use crate::moment::{At, Moment};
use crate::released::Released;
use crate::residual_partials::ResidualPartials;
use crate::setup::Setup;
use crate::slide::{Slide, Surface};
use hyde_ida::{Recoverable, System};
use hyde_program::{Function, Point, Program, SomeRows, TickWrt, Workspace};
pub(crate) use parameters::places_to_find;

/// The model between and during calls of the solver.
pub(crate) struct State<'a> {
    pub(crate) program: &'a Program,
    pub(crate) p: Vec<f64>,
    /// The relative and the absolute tolerance of the run.
    pub(crate) tolerances: (f64, f64),
    /// The memory.
    pub(crate) z: Vec<f64>,
    pub(crate) inputs: Inputs<'a>,
    pub(crate) delays: Delays,
    u: Vec<f64>,
    workspace: Workspace,
    pub(crate) partials: ResidualPartials,
    /// States that the current modes fix, with their values.
    pub(crate) pinned: Vec<(usize, f64)>,
    /// The value of each guard's root function of states where it became true last: its zero as far as it could be located.
    pub(crate) located: Vec<(usize, f64)>,
    /// Relations that are at their zero since the last event, with how far from it their root functions may be: within
    /// that a sign says nothing, until they have once been farther.
    pub(crate) doubtful: Vec<(usize, f64)>,
    /// What initial equations determine.
    pub(crate) released: Released,
    /// The parameters that do not follow from those that initial equations find.
    pub(crate) said: Option<Vec<(usize, f64)>>,
    /// Relations that are evaluated with the equations, with how far from zero they are until then.
    pub(crate) loose: Vec<(usize, f64)>,
    /// Switches that are held at their surfaces.
    pub(crate) slides: Vec<Slide>,
    pub(crate) differential: Vec<bool>,
    /// The instances of the program's foreign parts, made at their first ticks.
    pub(crate) foreign: ForeignInstances,
}

impl<'a> State<'a> {
    pub(crate) fn new(program: &'a Program, setup: &Setup<'a>) -> Result<Self, Box<Failure>> {
        let mut state = Self {
            program,
            p: setup.parameters.clone(),
            tolerances: (setup.rtol, setup.atol),
            z: vec![0.0; program.n_memory],
            inputs: Inputs::new(program, setup)?,
            delays: Delays::new(program, setup.start_s),
            u: vec![0.0; 2 * program.columns.len() + program.delays.len()],
            workspace: Workspace::new(program.n_work),
            partials: ResidualPartials::zeros(program.partials(Function::Residual).len()),
            pinned: Vec::new(),
            located: Vec::new(),
            doubtful: Vec::new(),
            released: Released::default(),
            said: None,
            loose: Vec::new(),
            slides: Vec::new(),
            differential: program.differential(&vec![0.0; program.n_memory]),
            foreign: ForeignInstances::new(program, setup.stop_s),
        };
        state.inputs.read(setup.start_s, &mut state.u);
        state.read_delayed(setup.start_s);
        Ok(state)
    }

    /// The values of a function; while sliding the mean of the sides, with the rows of consistent values.
    pub(crate) fn evaluate(&mut self, function: Function, at: At<'_>, out: &mut [f64]) {
        if self.slides.is_empty() {
            self.evaluate_side(function, at, out);
        } else if function == Function::Residual {
            self.sliding_residual(at, Surface::Rate, out);
        } else {
            let weights = self.weights(at);
            let values = self.mean(&weights, &mut |state| {
                let mut side = vec![0.0; out.len()];
                state.evaluate_side(function, at, &mut side);
                side
            });
            out.copy_from_slice(&values);
        }
    }

    /// The same as a list.
    pub(crate) fn values(&mut self, function: Function, at: At<'_>) -> Vec<f64> {
        let mut out = vec![0.0; self.program.rows(function)];
        self.evaluate(function, at, &mut out);
        out
    }

    /// The derivative of a function by the time alone, by a difference: the time, and record columns and delayed values that
    /// move with it, have no other.
    pub(crate) fn by_time(&mut self, function: Function, at: At<'_>) -> Vec<f64> {
        if !self.moves_by_time(function) {
            return vec![0.0; self.program.rows(function)];
        }
        let step = self.inputs.difference_s(at.t);
        let later = self.values(function, at.later(step));
        let now = self.values(function, at);
        let pairs = later.into_iter().zip(now);
        pairs.map(|(later, now)| (later - now) / step).collect()
    }

    /// Whether a function may change with the time alone.
    pub(crate) fn moves_by_time(&self, function: Function) -> bool {
        function != Function::Residual || self.program.timed || !self.slides.is_empty()
    }

    /// The values of a function with the memory as it is.
    pub(crate) fn evaluate_side(&mut self, function: Function, at: At<'_>, out: &mut [f64]) {
        self.read_continuous(at.t);
        self.read_loose(at);
        let program = self.program;
        let (point, workspace) = self.point(at);
        program.kernels.evaluate(function, point, workspace, out);
        if !all_finite(out) {
            self.evaluate_beyond(function, at, out);
        }
    }

    /// The same of some rows.
    pub(crate) fn evaluate_rows(&mut self, rows: &dyn SomeRows, at: At<'_>, out: &mut [f64]) {
        let side = |state: &mut Self, out: &mut [f64]| {
            state.read_continuous(at.t);
            state.read_loose(at);
            let (point, workspace) = state.point(at);
            rows.evaluate(point, workspace, out);
            if !all_finite(out) {
                state.replace_not_finite(at, out, |point, workspace, own| {
                    rows.evaluate(point, workspace, own);
                });
            }
        };
        if self.slides.is_empty() {
            return side(self, out);
        }
        let weights = self.weights(at);
        let values = self.mean(&weights, &mut |state| {
            let mut values = vec![0.0; out.len()];
            side(state, &mut values);
            values
        });
        out.copy_from_slice(&values);
    }

    /// The derivatives of a function, in the program's order; while sliding the mean of the sides.
    pub(crate) fn partials(&mut self, function: Function, at: At<'_>) -> Vec<f64> {
        if self.slides.is_empty() {
            return self.partials_side(function, at);
        }
        let weights = self.weights(at);
        self.mean(&weights, &mut |state| state.partials_side(function, at))
    }

    /// The derivatives of a function with the memory as it is.
    pub(crate) fn partials_side(&mut self, function: Function, at: At<'_>) -> Vec<f64> {
        self.read_continuous(at.t);
        self.read_loose(at);
        let mut out = vec![0.0; self.program.partials(function).len()];
        let program = self.program;
        let (point, workspace) = self.point(at);
        program
            .kernels
            .partials(function, point, workspace, &mut out);
        out
    }

    /// The derivatives of a function by parameters and memory, in the order of the kernel.
    pub(crate) fn still_partials(&mut self, function: Function, at: At<'_>, out: &mut [f64]) {
        self.read_continuous(at.t);
        let program = self.program;
        let (point, workspace) = self.point(at);
        program
            .kernels
            .still_partials(function, point, workspace, out);
    }

    /// The derivatives of a tick, with every column read at `t` and delayed values as they were just before.
    pub(crate) fn tick_partials(
        &mut self,
        clock: usize,
        at: At<'_>,
        delayed: &[f64],
    ) -> Vec<(usize, TickWrt, f64)> {
        self.inputs.read(at.t, &mut self.u);
        self.delayed_mut().copy_from_slice(delayed);
        let program = self.program;
        let (point, workspace) = self.point(at);
        program.kernels.tick_partials(clock, point, workspace)
    }

    /// Truth of every reaction's condition with the memory as it is.
    pub(crate) fn conditions(&mut self, at: At<'_>) -> Vec<bool> {
        let mut out = vec![0.0; self.program.reactions.len()];
        let program = self.program;
        let (point, workspace) = self.point(at);
        program.kernels.conditions(point, workspace, &mut out);
        out.into_iter().map(|truth| truth != 0.0).collect()
    }

    /// The memory after a tick, with every column read at `t`, and delayed values as they were just before.
    pub(crate) fn tick(&mut self, clock: usize, at: At<'_>, delayed: &[f64]) {
        if self.slides.is_empty() {
            self.z = self.tick_side(clock, at, delayed);
            return;
        }
        let weights = self.weights(at);
        let mut after = self.mean(&weights, &mut |state| state.tick_side(clock, at, delayed));
        for slide in &self.slides {
            for (place, _) in slide.settings(self.program, 0) {
                after[place] = self.z[place];
            }
        }
        self.z = after;
    }

    /// The memory after a tick, with the memory as it is.
    fn tick_side(&mut self, clock: usize, at: At<'_>, delayed: &[f64]) -> Vec<f64> {
        self.inputs.read(at.t, &mut self.u);
        self.delayed_mut().copy_from_slice(delayed);
        let mut after = self.z.clone();
        let program = self.program;
        let (point, workspace) = self.point(at);
        program.kernels.tick(clock, point, workspace, &mut after);
        after
    }

    /// The matrix that consistent values are solved with.
    pub(crate) fn consistent_matrix(&mut self, at: At<'_>, matrix: &mut [f64]) {
        self.mean_residual_partials(at);
        self.program.jacobian().assemble_consistent(
            self.partials.values(),
            &self.differential,
            matrix,
        );
        if !self.slides.is_empty() {
            self.exchange_rows(at, matrix);
        }
    }

    /// `dF/dy` times a vector and `dF/dy'` times another, summed into `out`.
    pub(crate) fn directional(&mut self, at: At<'_>, dy: &[f64], dyp: &[f64], out: &mut [f64]) {
        self.mean_residual_partials(at);
        out.iter_mut().for_each(|value| *value = 0.0);
        let jacobian = self.program.jacobian();
        let add = |row: &mut f64, product: f64| *row += product;
        jacobian.products(self.partials.values(), (dy, dyp), out, add);
        if !self.slides.is_empty() {
            self.exchange_in(at, dy, out);
        }
    }

    /// Puts exact values where modes fix states.
    pub(crate) fn apply_pins(&self, now: &mut Moment) {
        for &(state, value) in &self.pinned {
            now.y[state] = value;
            now.yp[state] = 0.0;
        }
    }

    /// All record columns and delayed values at a time.
    pub(crate) fn read_all(&mut self, t: f64) -> &[f64] {
        self.inputs.read(t, &mut self.u);
        self.read_delayed(t);
        &self.u
    }

    /// The delayed values at a time.
    pub(crate) fn delayed_at(&mut self, t: f64) -> &[f64] {
        self.read_delayed(t);
        self.delayed()
    }

    /// The delayed values as they were last read.
    pub(crate) fn delayed(&self) -> &[f64] {
        &self.u[2 * self.program.columns.len()..]
    }

    fn delayed_mut(&mut self) -> &mut [f64] {
        &mut self.u[2 * self.program.columns.len()..]
    }

    /// What is delayed had the values at this point for ever before; where they are finite.
    pub(crate) fn guess_past(&mut self, at: At<'_>) {
        let past = self.values(Function::Delayed, at);
        if past.iter().all(|value| value.is_finite()) {
            self.delays.set_past(at.t, &past);
        }
    }

    /// Reads what the continuous equations use of the world outside: columns and the past.
    #[inline]
    fn read_continuous(&mut self, t: f64) {
        if !self.u.is_empty() {
            self.inputs.read_continuous(t, &mut self.u);
            self.read_delayed(t);
        }
    }

    fn read_delayed(&mut self, t: f64) {
        let first = 2 * self.program.columns.len();
        self.delays.read(t, &mut self.u[first..]);
    }

    /// The derivatives of the residual; while sliding the mean of the sides, before rows are exchanged.
    fn mean_residual_partials(&mut self, at: At<'_>) {
        if self.slides.is_empty() {
            self.residual_partials(at);
        } else {
            let values = self.sliding_partials(at);
            self.partials.take(values, None);
        }
    }

    pub(crate) fn residual_partials(&mut self, at: At<'_>) {
        let read = self.affine_in();
        if read.is_some_and(|read| self.partials.are_of(&self.z[..read], &self.p)) {
            return;
        }
        self.read_continuous(at.t);
        self.read_loose(at);
        let program = self.program;
        let mut values = self.partials.room();
        let (point, workspace) = self.point(at);
        program
            .kernels
            .partials(Function::Residual, point, workspace, &mut values);
        if !all_finite(&values) {
            self.with_own_truths(at, |state| {
                let (point, workspace) = state.point(at);
                let kernels = &program.kernels;
                kernels.partials(Function::Residual, point, workspace, &mut values);
            });
        }
        let of = read.map(|read| (&self.z[..read], self.p.as_slice()));
        self.partials.take(values, of);
    }

    /// The coefficients of an affine residual (see [`System::coefficients`]) and the choice of states at a point; none where
    /// states may be chosen anew.
    pub(crate) fn coefficients_at(&mut self, at: At<'_>) -> Option<u64> {
        self.affine_in()
            .filter(|_| self.program.selections.is_empty())?;
        self.residual_partials(at);
        self.coefficients()
    }

    /// Where the residual is affine, its derivatives follow from parameters and so many places of the memory.
    fn affine_in(&self) -> Option<usize> {
        let straight = self.slides.is_empty() && self.loose.is_empty();
        self.program.affine_in.filter(|_| straight)
    }

    /// The model at a point, with the room that kernels work in.
    pub(crate) fn point<'s>(&'s mut self, at: At<'s>) -> (Point<'s>, &'s mut Workspace) {
        let At { t, y, yp } = at;
        let point = Point {
            t,
            y,
            yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        };
        (point, &mut self.workspace)
    }
}

/// Whether all values are finite.
#[inline]
fn all_finite(values: &[f64]) -> bool {
    // To the end: without a way out the loop takes several at a time, and none waits for the one before.
    values
        .iter()
        .fold(true, |all, value| all & value.is_finite())
}

impl System for State<'_> {
    fn coefficients(&self) -> Option<u64> {
        self.affine_in().map(|_| self.partials.changes())
    }

    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        if self.slides.is_empty() {
            self.evaluate_side(Function::Residual, At { t, y, yp }, out);
        } else {
            self.sliding_residual(At { t, y, yp }, Surface::Place, out);
        }
        Ok(())
    }

    fn jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        let at = At { t, y, yp };
        self.mean_residual_partials(at);
        self.program
            .jacobian()
            .assemble(self.partials.values(), 1.0, cj, values);
        if !self.slides.is_empty() {
            self.exchange_rows(at, values);
        }
        Ok(())
    }
}
