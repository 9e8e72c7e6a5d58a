//! [`Integrator`]: the state, with a solver if there is anything to solve.
//!
//! The places left open for speed (own Newton iteration with the model's own linear solver, time events without restart)
//! are here and in hyde-ida, behind this type.

use crate::failure::{Failure, FailureKind};
use crate::setup::Setup;
use crate::state::State;
use hyde_ida::{Error, Ida, LinearMethod, Options, Pattern};

/// The state of a run and the solver that advances it.
pub(crate) struct Integrator<'a> {
    solver: Solver<'a>,
    pub(crate) t: f64,
    pub(crate) y: Vec<f64>,
    pub(crate) yp: Vec<f64>,
    tolerances: (f64, f64),
    /// Factor of the tolerances that the solver gets.
    share: f64,
    /// Steps since the last start, and the part of the tolerances that a step is given.
    steps: u32,
    part: u32,
    /// The largest value of each unknown so far, and those that the tolerances were made with.
    largest: Vec<f64>,
    allowed: Vec<f64>,
}

/// The solver bounds the error of a step; over a long smooth stretch the errors of many steps add up, an oscillation
/// without losses shows it as drifting energy. So the tolerance of a step falls with the steps since the last start, from
/// this many on, down to a part of the tolerance asked for. At order 5 that is 2.8 times the steps at most. It never
/// falls below what rounding leaves: there steps become a hundred times shorter and no better.
const SMOOTH_AFTER: u32 = 12;
const LEAST_PART: u32 = 512;
const LEAST_RTOL: f64 = 2e-11;
const LEAST_ATOL: f64 = 1e-2 * LEAST_RTOL;

enum Solver<'a> {
    /// No continuous unknowns: time passes in strides, for guards may still move with it.
    Nothing(Box<State<'a>>, f64),
    Ida(Box<Ida<State<'a>>>),
}

impl<'a> Integrator<'a> {
    /// Starts a solver from consistent values.
    pub(crate) fn new(
        state: State<'a>,
        setup: &Setup<'_>,
        t: f64,
        y: Vec<f64>,
        yp: Vec<f64>,
        first_step_s: f64,
    ) -> Result<Self, Box<Failure>> {
        let program = state.program;
        let stride = state.delays.max_step_s();
        if program.n_unknowns == 0 {
            return Ok(Self {
                solver: Solver::Nothing(
                    Box::new(state),
                    setup.max_step_s.min(setup.row_spacing()).min(stride),
                ),
                t,
                y,
                yp,
                tolerances: (setup.rtol, setup.atol),
                share: 1.0,
                steps: 0,
                part: 1,
                largest: Vec::new(),
                allowed: Vec::new(),
            });
        }
        // A force that holds a state still must bound the steps, or its guards are stepped over. Without guards it need
        // not, and a transistor amplifier at rtol 1e-8 takes 47 times the steps with it. Without states nothing else would.
        let guarded = program.relations.iter().any(|relation| !relation.scheduled);
        let moves = state.differential.contains(&true);
        let states_alone = moves && (!guarded || !program.selections.is_empty());
        let share = if states_alone {
            share_of_states(&state)
        } else {
            1.0
        };
        let mut options = Options::new(
            share * setup.rtol,
            vec![share * setup.atol; program.n_unknowns],
            state.differential.clone(),
        );
        options.max_step_s = setup.max_step_s.min(state.inputs.max_step_s()).min(stride);
        options.suppress_algebraic = states_alone;
        options.first_step_s = Some(first_step_s);
        options.linear_method = LinearMethod::Auto;
        let failed = |error: Error| Failure::new(FailureKind::Solver(error.to_string()), t);
        let jacobian = program.jacobian();
        let pattern = Pattern::new(
            program.n_unknowns,
            jacobian.column_starts.clone(),
            jacobian.rows.clone(),
        );
        let pattern = pattern.map_err(|error| failed(Error::from(error)))?;
        let ida = Ida::new(state, pattern, options, t, &y, &yp).map_err(failed)?;
        Ok(Self {
            solver: Solver::Ida(Box::new(ida)),
            t,
            y,
            yp,
            tolerances: (setup.rtol, setup.atol),
            share,
            steps: 0,
            part: 1,
            largest: vec![0.0; program.n_unknowns],
            allowed: vec![0.0; program.n_unknowns],
        })
    }

    /// The relative and the absolute tolerance of the run.
    pub(crate) fn tolerances(&self) -> (f64, f64) {
        self.tolerances
    }

    pub(crate) fn state(&self) -> &State<'a> {
        match &self.solver {
            Solver::Nothing(state, _) => state,
            Solver::Ida(ida) => ida.system(),
        }
    }

    pub(crate) fn state_mut(&mut self) -> &mut State<'a> {
        match &mut self.solver {
            Solver::Nothing(state, _) => state,
            Solver::Ida(ida) => ida.system_mut(),
        }
    }

    /// One step, never past `stop`. Returns where the step began.
    pub(crate) fn step(&mut self, stop: f64) -> Result<f64, Box<Failure>> {
        let before = self.t;
        self.steps = self.steps.saturating_add(1);
        let part = self.steps / SMOOTH_AFTER;
        if part.is_power_of_two()
            && (2..=LEAST_PART).contains(&part)
            && self.steps.is_multiple_of(SMOOTH_AFTER)
            && self.tolerances.0 >= LEAST_RTOL * f64::from(part)
        {
            self.set_tolerances(part)?;
        } else if self.has_grown() {
            self.set_tolerances(self.part)?;
        }
        match &mut self.solver {
            Solver::Nothing(_, stride) => self.t = stop.min(before + *stride),
            Solver::Ida(ida) => {
                if let Err(error) = ida.step(stop) {
                    return Err(self.failure(&error));
                }
                self.t = ida.t();
                self.y.copy_from_slice(ida.y());
                self.yp.copy_from_slice(ida.yp());
            }
        }
        self.apply_pins();
        for (largest, value) in self.largest.iter_mut().zip(&self.y) {
            *largest = largest.max(value.abs());
        }
        Ok(before)
    }

    /// The solution at a time within the last step.
    pub(crate) fn interpolate(&mut self, t: f64, y: &mut [f64], yp: &mut [f64]) {
        match &self.solver {
            Solver::Ida(ida) if t.to_bits() != self.t.to_bits() => {
                let inside = ida
                    .interpolate(t, 0, y)
                    .and_then(|()| ida.interpolate(t, 1, yp));
                if inside.is_err() {
                    y.copy_from_slice(&self.y);
                    yp.copy_from_slice(&self.yp);
                }
            }
            Solver::Ida(_) | Solver::Nothing(..) => {
                y.copy_from_slice(&self.y);
                yp.copy_from_slice(&self.yp);
            }
        }
        let state = self.state_mut();
        state.apply_pins(y, yp);
        state.put_on_surfaces(t, y, yp);
    }

    /// Starts anew after an event.
    pub(crate) fn restart(&mut self, first_step_s: f64) -> Result<(), Box<Failure>> {
        self.apply_pins();
        if self.steps >= 2 * SMOOTH_AFTER || self.has_grown() {
            self.set_tolerances(1)?;
        }
        self.steps = 0;
        if let Solver::Ida(ida) = &mut self.solver {
            // States chosen anew are the ones whose errors count from here.
            let differential = ida.system().differential.clone();
            let started = ida
                .set_differential(&differential)
                .and_then(|()| ida.reinit(self.t, &self.y, &self.yp, Some(first_step_s)));
            if let Err(error) = started {
                return Err(self.failure(&error));
            }
        }
        Ok(())
    }

    /// The largest value of each unknown so far; none where there is nothing to solve.
    pub(crate) fn largest(&self) -> &[f64] {
        &self.largest
    }

    pub(crate) fn statistics(&self) -> hyde_ida::Statistics {
        match &self.solver {
            Solver::Ida(ida) => ida.statistics(),
            Solver::Nothing(..) => hyde_ida::Statistics::default(),
        }
    }

    /// Whether an algebraic variable is twice as large as the tolerances know.
    fn has_grown(&self) -> bool {
        let mut pairs = self.largest.iter().zip(&self.allowed);
        let atol = self.tolerances.1 / self.tolerances.0;
        pairs.any(|(largest, allowed)| *largest > 2.0 * allowed.max(atol))
    }

    /// The tolerances of a step. A force is the difference of large ones wherever it passes zero, so that an absolute
    /// tolerance made for states would ask for less than rounding: algebraic variables are measured by the largest value
    /// they had.
    fn set_tolerances(&mut self, part: u32) -> Result<(), Box<Failure>> {
        let (rtol, atol) = self.tolerances;
        self.part = part;
        let part = f64::from(part);
        if let Solver::Ida(ida) = &mut self.solver {
            let least = atol.min(LEAST_ATOL);
            self.allowed.copy_from_slice(&self.largest);
            let differential = &ida.system().differential;
            let atol: Vec<f64> = differential
                .iter()
                .zip(&self.allowed)
                .map(|(state, largest)| {
                    let own = if *state {
                        atol
                    } else {
                        atol.max(rtol * largest)
                    };
                    self.share * (own / part).max(least)
                })
                .collect();
            if let Err(error) = ida.set_tolerances(self.share * rtol / part, &atol) {
                return Err(self.failure(&error));
            }
        }
        Ok(())
    }

    /// Exact values where modes fix states, and on the surfaces that the run slides on.
    fn apply_pins(&mut self) {
        let Self {
            solver, t, y, yp, ..
        } = self;
        let state: &mut State<'_> = match solver {
            Solver::Nothing(state, _) => state,
            Solver::Ida(ida) => ida.system_mut(),
        };
        state.apply_pins(y, yp);
        state.put_on_surfaces(*t, y, yp);
    }

    /// What the solver says, with the equation and the unknown it stumbled over.
    fn failure(&self, error: &Error) -> Box<Failure> {
        let program = self.state().program;
        let Error::Failed(failed) = error else {
            return Failure::new(FailureKind::Solver(error.to_string()), self.t);
        };
        let kind = match failed.kind {
            hyde_ida::FailureKind::Residual | hyde_ida::FailureKind::Jacobian => {
                FailureKind::NotFinite
            }
            hyde_ida::FailureKind::ErrorTest => FailureKind::Solver(format!(
                "the error of a step stays too large, down to a step of {:.1e} s",
                failed.step_s
            )),
            hyde_ida::FailureKind::Convergence => FailureKind::Solver(format!(
                "Newton's method does not converge, down to a step of {:.1e} s",
                failed.step_s
            )),
            hyde_ida::FailureKind::SingularJacobian => {
                FailureKind::Solver("the Jacobian is singular".to_owned())
            }
            hyde_ida::FailureKind::TooMuchWork
            | hyde_ida::FailureKind::TooMuchAccuracy
            | hyde_ida::FailureKind::RootFunction
            | hyde_ida::FailureKind::InitialConditions
            | hyde_ida::FailureKind::Refused
            | hyde_ida::FailureKind::Other => {
                FailureKind::Solver(format!("{} ({})", failed.message, failed.flag))
            }
        };
        let mut failure = Failure::new(kind, failed.t);
        // Without an equation of its own the unknown leads to the one that it was matched to.
        if let Some(row) = failed.equation.or(failed.unknown) {
            failure = failure.at_row(program, row, &self.y);
        }
        if let Some(unknown) = failed.unknown {
            failure = failure.at_unknown(program, unknown, &self.y);
        }
        failure
    }
}

/// Where the errors of states alone count, IDA leaves the others out of the norm but divides by the number of all
/// unknowns. The factor undoes that: the norm is the mean over the states.
fn share_of_states(state: &State<'_>) -> f64 {
    let states = state.differential.iter().filter(|&&is| is).count();
    (states as f64 / state.differential.len() as f64).sqrt()
}
