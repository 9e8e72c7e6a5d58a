//! Some rows of a function as a kernel of their own: code of what they read alone, made once and kept for who asks again.

use crate::compiled::{Backend, Code, Compiled};
use crate::routine::Routine;
use hyde_ir::dae::{Dae, Function};
use hyde_program::{Point, SomeRows, Workspace};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Code of some rows of functions, by the rows.
#[derive(Default)]
pub(crate) struct Known {
    codes: Mutex<BTreeMap<Wanted, Arc<Code>>>,
}

/// Rows of a function.
type Wanted = (Function, Vec<usize>);

impl Known {
    /// The code of some rows.
    pub(crate) fn code(
        &self,
        dae: &Dae,
        function: Function,
        rows: &[usize],
        backend: Backend,
    ) -> Arc<Code> {
        let mut codes = self.codes.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || {
            let routine = Routine::some_rows(dae, function, rows);
            Arc::new(Code::new(dae, &routine, backend))
        };
        let code = codes.entry((function, rows.to_vec())).or_insert_with(make);
        Arc::clone(code)
    }
}

/// A kernel of some rows.
pub(crate) struct Chosen<'c> {
    pub(crate) compiled: &'c Compiled,
    pub(crate) code: Arc<Code>,
    pub(crate) count: usize,
}

impl SomeRows for Chosen<'_> {
    fn evaluate(&self, at: Point<'_>, workspace: &mut Workspace, out: &mut [f64]) {
        self.compiled.check(at, workspace);
        assert!(out.len() >= self.count, "room for every value");
        self.code.run(at, workspace, out);
    }
}
