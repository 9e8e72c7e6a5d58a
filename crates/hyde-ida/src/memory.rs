//! The C objects of one IDA solver, made once and freed together.

use std::ffi::{c_int, c_void};
use std::ptr::{self, NonNull};

use sundials_sys as sys;

use crate::callback::{self, BridgeBox};
use crate::context::Context;
use crate::failure::accept;
use crate::vector::Vector;
use crate::{Error, Options, System};

/// IDA gives up a step after this many failed error tests. Its own 10 are too few for a start from rest, where its
/// first guess of the step size knows nothing.
const ERROR_TEST_FAILURES: c_int = 30;

/// IDA's memory with the solvers and the matrix it refers to.
pub(crate) struct Memory {
    ida: *mut c_void,
    newton: sys::SUNNonlinearSolver,
    linear: sys::SUNLinearSolver,
    matrix: sys::SUNMatrix,
}

impl Memory {
    /// Makes a solver that starts at `t`, `y`, `yp` and calls back to the bridge.
    pub(crate) fn new<S: System>(
        context: &Context,
        bridge: &BridgeBox<S>,
        options: &Options,
        t: f64,
        y: &Vector,
        yp: &Vector,
    ) -> Result<Self, Error> {
        // SAFETY: the context is valid. Each function gets valid objects of this context; the callbacks get, as user
        // data, the bridge whose type they were made for, which lives as long as the solver. A failure drops `memory`,
        // which frees what has been made.
        unsafe {
            let mut memory = Self {
                ida: ptr::null_mut(),
                newton: ptr::null_mut(),
                linear: ptr::null_mut(),
                matrix: ptr::null_mut(),
            };
            memory.ida = NonNull::new(sys::IDACreate(context.raw()))
                .ok_or(Error::OutOfMemory)?
                .as_ptr();
            memory.linear = new_linear_solver::<S>(context, bridge.user_data())?;
            memory.matrix = new_matrix(context)?;
            let accept = |flag| accept(flag, context, t);
            let ida = memory.ida;
            accept(sys::IDASetMaxOrd(ida, c_int::from(options.max_order)))?;
            accept(sys::IDAInit(
                ida,
                Some(callback::residual::<S>),
                t,
                y.raw(),
                yp.raw(),
            ))?;
            accept(sys::IDASetUserData(ida, bridge.user_data()))?;
            accept(sys::IDAWFtolerances(ida, Some(callback::weights::<S>)))?;
            accept(sys::IDASetLinearSolver(ida, memory.linear, memory.matrix))?;
            accept(sys::IDASetJacFn(ida, Some(callback::jacobian::<S>)))?;
            if options.watch_convergence {
                memory.newton = NonNull::new(sys::SUNNonlinSol_Newton(y.raw(), context.raw()))
                    .ok_or(Error::OutOfMemory)?
                    .as_ptr();
                accept(sys::IDASetNonlinearSolver(ida, memory.newton))?;
                // IDA has put its own test in.
                let known = bridge.user_data();
                let test: sys::SUNNonlinSolConvTestFn = Some(callback::converged::<S>);
                accept(sys::SUNNonlinSolSetConvTestFn(memory.newton, test, known))?;
            }
            accept(sys::IDASetSuppressAlg(
                ida,
                c_int::from(options.suppress_algebraic),
            ))?;
            accept(sys::IDASetMaxErrTestFails(ida, ERROR_TEST_FAILURES))?;
            Ok(memory)
        }
    }

    pub(crate) fn ida(&self) -> *mut c_void {
        self.ida
    }

    /// Where the last internal step ended, in s, which may be beyond the time returned.
    pub(crate) fn time(&self) -> f64 {
        self.read(sys::IDAGetCurrentTime)
    }

    /// Internal steps since the last restart.
    pub(crate) fn steps(&self) -> u64 {
        self.read(sys::IDAGetNumSteps).unsigned_abs()
    }

    /// What one of IDA's functions `IDAGet…` for a single number gives.
    pub(crate) fn read<T: Default>(
        &self,
        get: unsafe extern "C" fn(*mut c_void, *mut T) -> c_int,
    ) -> T {
        let mut value = T::default();
        // SAFETY: the memory is valid, and these functions only write the number.
        unsafe { get(self.ida, &raw mut value) };
        value
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: the objects are ours, valid or null; IDA, which refers to the others, goes first.
        unsafe {
            sys::IDAFree(&raw mut self.ida);
            if !self.newton.is_null() {
                sys::SUNNonlinSolFree(self.newton);
            }
            sys::SUNLinSolFreeEmpty(self.linear);
            sys::SUNMatFreeEmpty(self.matrix);
        }
    }
}

/// A direct linear solver that works on the bridge. Without an `initialize`, it keeps its analysis when IDA restarts.
unsafe fn new_linear_solver<S: System>(
    context: &Context,
    user_data: *mut c_void,
) -> Result<sys::SUNLinearSolver, Error> {
    unsafe extern "C" fn direct(_: sys::SUNLinearSolver) -> sys::SUNLinearSolver_Type {
        sys::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
    }
    // SAFETY: the context is valid, and a new linear solver has a table of operations of its own.
    unsafe {
        let solver = sys::SUNLinSolNewEmpty(context.raw());
        let fields = solver.as_mut().ok_or(Error::OutOfMemory)?;
        fields.content = user_data;
        let ops = &mut *fields.ops;
        ops.gettype = Some(direct);
        ops.setup = Some(callback::factor::<S>);
        ops.solve = Some(callback::solve::<S>);
        Ok(solver)
    }
}

/// A matrix without content, which IDA demands: the values are in the bridge, all written at each evaluation, so there
/// is nothing to set to zero.
unsafe fn new_matrix(context: &Context) -> Result<sys::SUNMatrix, Error> {
    unsafe extern "C" fn custom(_: sys::SUNMatrix) -> sys::SUNMatrix_ID {
        sys::SUNMatrix_ID_SUNMATRIX_CUSTOM
    }
    unsafe extern "C" fn zero(_: sys::SUNMatrix) -> sys::SUNErrCode {
        0
    }
    // SAFETY: as in `new_linear_solver`.
    unsafe {
        let matrix = sys::SUNMatNewEmpty(context.raw());
        let ops = &mut *matrix.as_mut().ok_or(Error::OutOfMemory)?.ops;
        ops.getid = Some(custom);
        ops.zero = Some(zero);
        Ok(matrix)
    }
}
