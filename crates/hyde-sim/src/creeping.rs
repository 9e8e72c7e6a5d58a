//! [`Creeping`]: whether IDA takes short steps that bring nothing.
//!
//! Where a fast, damped part follows a slow one, an error of the slow part within its tolerance is many times the tolerance
//! of a rate that follows it. At order 1, with what is left of such errors in the values of earlier steps, each longer step
//! fails the error test, and the run creeps with steps that nothing asks for (a filter of 1 kHz beside a slide: up to 700 000
//! steps where 26 of a one-step method do). A method without a past does not see those errors: it damps what is stiff in each
//! step anew.

use crate::state::State;
use hyde_ida::Ida;

/// So many steps are looked at together, and so many failures of the error test among them are too many.
const STEPS: u32 = 200;
const FAILURES: u64 = 100;

/// What was counted when IDA was looked at last.
#[derive(Default)]
pub(crate) struct Creeping {
    steps: u32,
    failures: u64,
}

impl Creeping {
    /// Counts a step that is about to begin; whether the last ones failed the error test once for every two that were taken.
    pub(crate) fn seen(&mut self, ida: &Ida<State<'_>>) -> bool {
        self.steps += 1;
        if self.steps < STEPS {
            return false;
        }
        let failures = ida.statistics().error_test_failures;
        let new = failures - std::mem::replace(&mut self.failures, failures);
        self.steps = 0;
        new >= FAILURES
    }
}
