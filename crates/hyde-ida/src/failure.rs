//! What IDA's return codes mean, and which unknown or equation is to blame.

use std::ffi::c_int;
use std::ptr;

use sundials_sys as sys;

use crate::callback::{Bridge, Fault};
use crate::context::Context;
use crate::solver::Ida;
use crate::vector::{Vector, values};
use crate::{Error, Failure, FailureKind, System};

/// Makes an error of a return code that is one. For calls whose arguments we have checked: only memory can be missing.
pub(crate) fn accept(flag: c_int, context: &Context, t: f64) -> Result<(), Error> {
    if flag >= 0 {
        return Ok(());
    }
    let message = context.take_messages();
    if flag == sys::IDA_MEM_FAIL {
        return Err(Error::OutOfMemory);
    }
    Err(Error::Failed(Box::new(Failure {
        kind: kind(flag, None, false),
        t,
        step_s: 0.0,
        unknown: None,
        equation: None,
        residual: None,
        root: None,
        flag: name(flag),
        message,
    })))
}

impl<S: System> Ida<S> {
    /// Makes an error of a return code that is one.
    pub(crate) fn accept(&self, flag: c_int) -> Result<(), Error> {
        accept(flag, &self.context, self.t)
    }

    /// Tells of the failure IDA has just returned with; `initial` if from a search for initial conditions.
    pub(crate) fn failure(&self, flag: c_int, initial: bool) -> Failure {
        let bridge = self.bridge.get();
        let mut failure = Failure {
            kind: kind(flag, bridge.fault, initial),
            t: self.memory.time(),
            step_s: self.memory.read(sys::IDAGetCurrentStep),
            unknown: None,
            equation: None,
            residual: None,
            root: None,
            flag: name(flag),
            message: self.context.take_messages(),
        };
        match (failure.kind, bridge.fault) {
            (FailureKind::ErrorTest, _) => {
                failure.unknown = self.worst_error(self.suppress_algebraic)
            }
            (FailureKind::Convergence, _) => {
                failure.unknown = self.worst_error(false);
                failure.equation = self.worst_residual();
            }
            (FailureKind::InitialConditions, _) => failure.equation = self.worst_residual(),
            (FailureKind::Residual, Some(Fault::Residual { equation })) => {
                failure.equation = equation
            }
            (
                FailureKind::Jacobian,
                Some(Fault::Jacobian {
                    place: Some((equation, unknown)),
                }),
            ) => {
                (failure.equation, failure.unknown) = (Some(equation), Some(unknown));
            }
            (FailureKind::SingularJacobian, Some(Fault::Singular { unknown })) => {
                failure.unknown = Some(unknown)
            }
            (FailureKind::RootFunction, Some(Fault::Roots { root })) => failure.root = root,
            _ => {}
        }
        if matches!(
            failure.kind,
            FailureKind::Convergence | FailureKind::InitialConditions
        ) {
            let last = self.last_residual();
            failure.residual = failure
                .equation
                .and_then(|row| last.and_then(|own| own.get(row).copied()));
        }
        failure
    }

    /// The unknown with the largest weighted error, or correction by Newton's method, in the last attempt.
    fn worst_error(&self, states_only: bool) -> Option<usize> {
        let weights = self.weights()?;
        // SAFETY: the vector is one of this solver's, and not in use.
        unsafe { sys::IDAGetEstLocalErrors(self.memory.ida(), self.scratch.raw()) };
        let errors = self
            .scratch
            .as_slice()
            .iter()
            .zip(weights.as_slice())
            .zip(&self.differential);
        largest(errors.map(|((error, weight), &state)| {
            if state || !states_only {
                error * weight
            } else {
                0.0
            }
        }))
    }

    /// The equation with the largest residual in the last attempt, divided by the largest change that one unknown could
    /// bring about within its tolerance: only so can residuals of different units be compared.
    fn worst_residual(&self) -> Option<usize> {
        let weights = self.weights()?;
        let Bridge {
            linear, jacobian, ..
        } = self.bridge.get();
        let mut changes = vec![0.0_f64; weights.as_slice().len()];
        for (equation, unknown, entry) in linear.pattern().entries() {
            let change = jacobian[entry].abs() / weights.as_slice()[unknown];
            changes[equation] = changes[equation].max(change);
        }
        let residual = self.last_residual()?;
        largest(residual.iter().zip(&changes).map(|(residual, change)| {
            if *residual == 0.0 {
                0.0
            } else {
                residual / change
            }
        }))
    }

    fn weights(&self) -> Option<Vector> {
        let weights = Vector::new(self.y().len(), &self.context).ok()?;
        // SAFETY: both are valid.
        unsafe { sys::IDAGetErrWeights(self.memory.ida(), weights.raw()) };
        Some(weights)
    }

    /// The residual IDA evaluated last.
    fn last_residual(&self) -> Option<&[f64]> {
        let (mut t, mut cj, mut user_data, mut residual) =
            (0.0, 0.0, ptr::null_mut(), ptr::null_mut());
        let mut others = [ptr::null_mut(); 4];
        let [y_predicted, yp_predicted, y, yp] = &mut others;
        // SAFETY: IDA writes pointers to vectors of its own, which live as long as its memory and which it writes to
        // only in calls that borrow the solver mutably.
        unsafe {
            let ida = self.memory.ida();
            let (t, cj) = (&raw mut t, &raw mut cj);
            sys::IDAGetNonlinearSystemData(
                ida,
                t,
                y_predicted,
                yp_predicted,
                y,
                yp,
                &raw mut residual,
                cj,
                &raw mut user_data,
            );
            (!residual.is_null()).then(|| values(residual))
        }
    }
}

/// The index of the number largest in magnitude, a NaN being larger than all others; none if all are 0.
fn largest(values: impl Iterator<Item = f64>) -> Option<usize> {
    let magnitude = |value: f64| {
        if value.is_nan() {
            f64::INFINITY
        } else {
            value.abs()
        }
    };
    let (index, value) = values
        .map(magnitude)
        .enumerate()
        .max_by(|(_, a), (_, b)| a.total_cmp(b))?;
    (value > 0.0).then_some(index)
}

fn kind(flag: c_int, fault: Option<Fault>, initial: bool) -> FailureKind {
    match (flag, fault) {
        (sys::IDA_TOO_MUCH_WORK, _) => FailureKind::TooMuchWork,
        (sys::IDA_TOO_MUCH_ACC, _) => FailureKind::TooMuchAccuracy,
        (sys::IDA_ERR_FAIL, _) => FailureKind::ErrorTest,
        (sys::IDA_RTFUNC_FAIL, _) => FailureKind::RootFunction,
        (sys::IDA_ILL_INPUT, _) => FailureKind::Refused,
        (_, Some(Fault::Residual { .. })) => FailureKind::Residual,
        (_, Some(Fault::Jacobian { .. })) => FailureKind::Jacobian,
        (_, Some(Fault::Singular { .. })) => FailureKind::SingularJacobian,
        (sys::IDA_CONV_FAIL, _) if !initial => FailureKind::Convergence,
        (sys::IDA_CONV_FAIL | sys::IDA_LINESEARCH_FAIL | sys::IDA_NO_RECOVERY, _) => {
            FailureKind::InitialConditions
        }
        _ => FailureKind::Other,
    }
}

fn name(flag: c_int) -> &'static str {
    match flag {
        sys::IDA_TOO_MUCH_WORK => "IDA_TOO_MUCH_WORK",
        sys::IDA_TOO_MUCH_ACC => "IDA_TOO_MUCH_ACC",
        sys::IDA_ERR_FAIL => "IDA_ERR_FAIL",
        sys::IDA_CONV_FAIL => "IDA_CONV_FAIL",
        sys::IDA_LINIT_FAIL => "IDA_LINIT_FAIL",
        sys::IDA_LSETUP_FAIL => "IDA_LSETUP_FAIL",
        sys::IDA_LSOLVE_FAIL => "IDA_LSOLVE_FAIL",
        sys::IDA_RES_FAIL => "IDA_RES_FAIL",
        sys::IDA_REP_RES_ERR => "IDA_REP_RES_ERR",
        sys::IDA_RTFUNC_FAIL => "IDA_RTFUNC_FAIL",
        sys::IDA_FIRST_RES_FAIL => "IDA_FIRST_RES_FAIL",
        sys::IDA_LINESEARCH_FAIL => "IDA_LINESEARCH_FAIL",
        sys::IDA_NO_RECOVERY => "IDA_NO_RECOVERY",
        sys::IDA_NLS_SETUP_FAIL => "IDA_NLS_SETUP_FAIL",
        sys::IDA_NLS_FAIL => "IDA_NLS_FAIL",
        sys::IDA_ILL_INPUT => "IDA_ILL_INPUT",
        sys::IDA_BAD_EWT => "IDA_BAD_EWT",
        sys::IDA_VECTOROP_ERR => "IDA_VECTOROP_ERR",
        _ => "an unexpected return code",
    }
}
