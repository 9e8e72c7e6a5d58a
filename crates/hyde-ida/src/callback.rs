//! The functions IDA calls, and the panics they park.
//!
//! A panic must not unwind through C. As in git2-rs, it is caught and kept, IDA is told that the call failed for good,
//! and the solver resumes the panic when IDA has returned.

use std::any::Any;
use std::ffi::{c_int, c_void};
use std::mem::ManuallyDrop;
use std::panic::{self, AssertUnwindSafe};
use std::ptr::NonNull;

use sundials_sys as sys;

use crate::convergence::Convergence;
use crate::operations::{error_weights, find_not_finite};
use crate::steep::Steep;
use crate::vector::{values, values_mut};
use crate::{Recoverable, SparseSolver, System};

const DONE: c_int = 0;
/// IDA tries again with a smaller step.
const TRY_SMALLER: c_int = 1;
const FATAL: c_int = -1;

/// What the callbacks of one solver work on; IDA carries a pointer to it as its user data.
pub(crate) struct Bridge<S> {
    pub(crate) system: S,
    pub(crate) linear: SparseSolver,
    /// The Jacobian's values, in the order of the pattern.
    pub(crate) jacobian: Vec<f64>,
    pub(crate) rtol: f64,
    pub(crate) atol: Vec<f64>,
    pub(crate) n_roots: usize,
    /// Why the last callback that failed did, until a residual succeeds.
    pub(crate) fault: Option<Fault>,
    pub(crate) residual_evaluations: u64,
    pub(crate) jacobian_evaluations: u64,
    pub(crate) root_evaluations: u64,
    pub(crate) convergence: Convergence,
    /// There where the equations are steep.
    pub(crate) steep: Option<Steep>,
    panic: Option<Box<dyn Any + Send>>,
}

/// Why a callback failed, as far as it is known.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Fault {
    Residual { equation: Option<usize> },
    Jacobian { place: Option<(usize, usize)> },
    Singular { unknown: usize },
    Roots { root: Option<usize> },
}

/// A bridge at a fixed address, reached through this pointer by us and through its copies by IDA, never both at once.
pub(crate) struct BridgeBox<S>(NonNull<Bridge<S>>);

impl<S> Bridge<S> {
    pub(crate) fn new(system: S, linear: SparseSolver, rtol: f64, atol: Vec<f64>) -> Self
    where
        S: System,
    {
        Self {
            jacobian: vec![0.0; linear.pattern().n_entries()],
            n_roots: system.n_roots(),
            system,
            linear,
            rtol,
            atol,
            fault: None,
            residual_evaluations: 0,
            jacobian_evaluations: 0,
            root_evaluations: 0,
            convergence: Convergence::new(),
            steep: None,
            panic: None,
        }
    }

    fn failed(&mut self, fault: Fault) -> c_int {
        self.fault = Some(fault);
        TRY_SMALLER
    }
}

impl<S> BridgeBox<S> {
    pub(crate) fn new(bridge: Bridge<S>) -> Self {
        Self(NonNull::from(Box::leak(Box::new(bridge))))
    }

    pub(crate) fn user_data(&self) -> *mut c_void {
        self.0.as_ptr().cast()
    }

    pub(crate) fn get(&self) -> &Bridge<S> {
        // SAFETY: the box is ours; IDA reaches it only in calls that borrow the solver, and with it this, mutably.
        unsafe { self.0.as_ref() }
    }

    pub(crate) fn get_mut(&mut self) -> &mut Bridge<S> {
        // SAFETY: as above.
        unsafe { self.0.as_mut() }
    }

    /// The system; IDA must be freed before.
    pub(crate) fn into_system(self) -> S {
        let own = ManuallyDrop::new(self);
        // SAFETY: the pointer came from a box, and is not dropped a second time.
        unsafe { Box::from_raw(own.0.as_ptr()) }.system
    }

    /// Lets a parked panic go on.
    pub(crate) fn resume_panic(&mut self) {
        if let Some(payload) = self.get_mut().panic.take() {
            panic::resume_unwind(payload);
        }
    }
}

impl<S> Drop for BridgeBox<S> {
    fn drop(&mut self) {
        // SAFETY: the pointer came from a box, and IDA is freed before (the order of the solver's fields).
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

/// `IDAResFn`.
pub(crate) unsafe extern "C" fn residual<S: System>(
    t: f64,
    y: sys::N_Vector,
    yp: sys::N_Vector,
    out: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: IDA gives the user data of this solver, and distinct vectors that are ours until we return.
    let (bridge, y, yp, out) = unsafe {
        (
            reach::<S>(user_data),
            values(y),
            values(yp),
            values_mut(out),
        )
    };
    guarded(bridge, |bridge| {
        bridge.residual_evaluations += 1;
        if let Some(steep) = &mut bridge.steep {
            steep.at(t, y, yp);
        }
        let evaluated = bridge.system.residual(t, y, yp, out);
        match outcome(evaluated, out) {
            Ok(()) => {
                bridge.fault = None;
                DONE
            }
            Err(equation) => bridge.failed(Fault::Residual { equation }),
        }
    })
}

/// `IDALsJacFn`. The values stay in the bridge; the matrix IDA hands around is empty.
pub(crate) unsafe extern "C" fn jacobian<S: System>(
    t: f64,
    cj: f64,
    y: sys::N_Vector,
    yp: sys::N_Vector,
    _residual: sys::N_Vector,
    _matrix: sys::SUNMatrix,
    user_data: *mut c_void,
    _scratch1: sys::N_Vector,
    _scratch2: sys::N_Vector,
    _scratch3: sys::N_Vector,
) -> c_int {
    // SAFETY: as in `residual`.
    let (bridge, y, yp) = unsafe { (reach::<S>(user_data), values(y), values(yp)) };
    guarded(bridge, |bridge| {
        bridge.jacobian_evaluations += 1;
        let evaluated = bridge.system.jacobian(t, cj, y, yp, &mut bridge.jacobian);
        match outcome(evaluated, &bridge.jacobian) {
            Ok(()) => DONE,
            Err(entry) => {
                let place_of = |entry| {
                    bridge
                        .linear
                        .pattern()
                        .entries()
                        .find(|&(.., at)| at == entry)
                };
                let place = entry
                    .and_then(place_of)
                    .map(|(row, column, _)| (row, column));
                bridge.failed(Fault::Jacobian { place })
            }
        }
    })
}

/// `IDARootFn`.
pub(crate) unsafe extern "C" fn roots<S: System>(
    t: f64,
    y: sys::N_Vector,
    yp: sys::N_Vector,
    out: *mut f64,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: as in `residual`; `out` has an entry for each root function, as many as IDA was told. C has not
    // initialised it; a root function that is not written has no value.
    let (bridge, y, yp, out) = unsafe {
        let bridge = reach::<S>(user_data);
        (0..bridge.n_roots).for_each(|root| out.add(root).write(f64::NAN));
        let out = std::slice::from_raw_parts_mut(out, bridge.n_roots);
        (bridge, values(y), values(yp), out)
    };
    guarded(bridge, |bridge| {
        bridge.root_evaluations += 1;
        let evaluated = bridge.system.roots(t, y, yp, out);
        match outcome(evaluated, out) {
            Ok(()) => DONE,
            Err(root) => bridge.failed(Fault::Roots { root }),
        }
    })
}

/// `IDAEwtFn`: the error weights, in one pass.
pub(crate) unsafe extern "C" fn weights<S: System>(
    y: sys::N_Vector,
    weights: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: as in `residual`.
    let (bridge, y, weights) = unsafe { (reach::<S>(user_data), values(y), values_mut(weights)) };
    guarded(bridge, |bridge| {
        error_weights(bridge.rtol, &bridge.atol, y, weights);
        DONE
    })
}

/// `SUNNonlinSolConvTestFn`: whether the last correction is one.
pub(crate) unsafe extern "C" fn converged<S: System>(
    newton: sys::SUNNonlinearSolver,
    _correction: sys::N_Vector,
    last: sys::N_Vector,
    tolerance: f64,
    weights: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: as in `residual`; the solvers and the vectors are valid.
    let (bridge, norm, last, weights, iteration, cj) = unsafe {
        let bridge = reach::<S>(user_data);
        let (mut iteration, mut cj) = (0, 0.0);
        sys::SUNNonlinSolGetCurIter(newton, &raw mut iteration);
        sys::IDAGetCurrentCj(bridge.convergence.ida(), &raw mut cj);
        let norm = sys::N_VWrmsNorm(last, weights);
        (bridge, norm, values(last), values(weights), iteration, cj)
    };
    guarded(bridge, |bridge| {
        let convergence = &mut bridge.convergence;
        let Some(steep) = &mut bridge.steep else {
            return convergence.test(iteration, norm, cj, tolerance);
        };
        let code = convergence.test_each(iteration, (last, norm), weights, cj, tolerance);
        if iteration == 0 && convergence.is_old() {
            bridge.jacobian_evaluations += 1;
            let old = (bridge.linear.pattern(), bridge.jacobian.as_slice());
            if !steep.serves(&mut bridge.system, old, cj, weights) {
                return sys::SUN_NLS_CONV_RECVR;
            }
        }
        code
    })
}

/// The linear solver's `setup`: factors the Jacobian.
pub(crate) unsafe extern "C" fn factor<S: System>(
    solver: sys::SUNLinearSolver,
    _matrix: sys::SUNMatrix,
) -> c_int {
    // SAFETY: the content of our linear solver is the user data.
    let bridge = unsafe { reach::<S>((*solver).content) };
    guarded(bridge, |bridge| {
        bridge.convergence.renew();
        match bridge.linear.factor(&bridge.jacobian) {
            Ok(()) => DONE,
            Err(singular) => bridge.failed(Fault::Singular {
                unknown: singular.unknown,
            }),
        }
    })
}

/// The linear solver's `solve`.
pub(crate) unsafe extern "C" fn solve<S: System>(
    solver: sys::SUNLinearSolver,
    _matrix: sys::SUNMatrix,
    x: sys::N_Vector,
    b: sys::N_Vector,
    _tolerance: f64,
) -> c_int {
    // SAFETY: as in `residual` and `factor`; `x` and `b` are distinct.
    let (bridge, x, b) = unsafe { (reach::<S>((*solver).content), values_mut(x), values(b)) };
    guarded(bridge, |bridge| {
        x.copy_from_slice(b);
        bridge.linear.solve(x);
        DONE
    })
}

/// The bridge that IDA carries as user data.
///
/// # Safety
/// `user_data` must be that of a `BridgeBox` of the same `S`, to whose bridge nothing else refers during `'a`: so it is
/// in a callback, of which IDA calls one at a time.
unsafe fn reach<'a, S>(user_data: *mut c_void) -> &'a mut Bridge<S> {
    // SAFETY: given by the caller.
    unsafe { &mut *user_data.cast::<Bridge<S>>() }
}

/// Calls `body` with the bridge; parks a panic.
fn guarded<S>(bridge: &mut Bridge<S>, body: impl FnOnce(&mut Bridge<S>) -> c_int) -> c_int {
    if bridge.panic.is_some() {
        return FATAL;
    }
    match panic::catch_unwind(AssertUnwindSafe(|| body(&mut *bridge))) {
        Ok(code) => code,
        Err(payload) => {
            bridge.panic = Some(payload);
            FATAL
        }
    }
}

/// Fails if the model says so (with no index) or an output is not finite (with its index).
fn outcome(evaluated: Result<(), Recoverable>, out: &[f64]) -> Result<(), Option<usize>> {
    match evaluated {
        Err(Recoverable) => Err(None),
        Ok(()) => find_not_finite(out).map_or(Ok(()), |index| Err(Some(index))),
    }
}
