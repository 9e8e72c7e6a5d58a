//! [`Connection`]: connectors that are joined.

use crate::instance::InstanceId;
use hyde_diag::Origin;

/// A connector and whether it is seen from outside its component: an inside one of the set.
pub(super) type Side = (InstanceId, bool);

/// A `connect` of connectors, as written.
pub(crate) struct Connection {
    pub(super) sides: Vec<Side>,
    pub(super) origin: Origin,
}

impl Connection {
    /// A connection that the compiler makes.
    pub(crate) fn joining(sides: Vec<Side>, origin: Origin) -> Self {
        Self { sides, origin }
    }
}
