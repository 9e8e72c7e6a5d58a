//! Some rows of a function, or some of its derivatives by parameters and memory, as a kernel of their own: code of what they
//! read alone, made once and kept for who asks again.

use crate::compiled::{Backend, Code, Compiled};
use crate::routine::{self, Routine};
use hyde_ir::Range;
use hyde_ir::dae::{Dae, Function, Partial};
use hyde_program::{Point, SomeRows, Workspace};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Code of parts of functions.
#[derive(Default)]
pub(crate) struct Known {
    codes: Mutex<BTreeMap<Wanted, Arc<Code>>>,
}

/// A part of a function.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Wanted {
    /// Rows.
    Rows(Function, Vec<usize>),
    /// Derivatives by parameters and memory, by number.
    Still(Function, Vec<usize>),
}

impl Known {
    /// The code of a part of a function.
    pub(crate) fn code(&self, dae: &Dae, wanted: Wanted, backend: Backend) -> Arc<Code> {
        let mut codes = self.codes.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(code) = codes.get(&wanted) {
            return Arc::clone(code);
        }
        let code = Arc::new(match &wanted {
            Wanted::Rows(function, rows) => {
                Code::new(dae, &Routine::some_rows(dae, *function, rows), backend)
            }
            Wanted::Still(function, numbers) => still(dae, *function, numbers, backend),
        });
        codes.insert(wanted, Arc::clone(&code));
        code
    }
}

/// The code of some derivatives by parameters and memory.
fn still(dae: &Dae, function: Function, numbers: &[usize], backend: Backend) -> Code {
    let mut dae = dae.clone();
    let list = hyde_analysis::still_partials(&mut dae, function);
    let each = list.iter().flat_map(|partial| {
        let counters = partial.range.iter();
        counters.map(move |counter| Partial {
            range: Range {
                first: counter,
                last: counter,
            },
            ..partial.clone()
        })
    });
    let each: Vec<Partial> = each.collect();
    let chosen: Vec<Partial> = numbers.iter().map(|&number| each[number].clone()).collect();
    let name = format!("some_{}_still_partials", routine::name(function));
    Code::new(&dae, &Routine::partials(&dae, name, &chosen), backend)
}

/// A kernel of a part of a function.
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
