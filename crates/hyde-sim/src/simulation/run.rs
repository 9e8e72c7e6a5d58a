//! [`Run`]: a run as its followers see it.

use crate::clocks::Schedule;
use crate::consistent::Consistent;
use crate::integrator::Integrator;
use crate::results::Results;

/// A run that is followed.
pub(super) struct Run<'r, 'a> {
    pub(super) integrator: &'r mut Integrator<'a>,
    pub(super) consistent: &'r mut Consistent,
    pub(super) schedule: &'r Schedule,
    pub(super) results: &'r mut Results,
}
