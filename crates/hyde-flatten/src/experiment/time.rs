//! Times that an experiment sets.

use crate::dimension::Dim;
use crate::instance::{InstanceId, Typed};
use crate::model::Model;
use hyde_units::Dimension;

/// Demands that a value is a time.
pub(super) fn agree_time(
    model: &mut Model<'_, '_>,
    value: &Typed,
    what: &'static str,
    instance: InstanceId,
) {
    let time = Typed {
        dim: Dim::known(Dimension::TIME),
        ..value.clone()
    };
    model.agree(&time, value, what, instance);
}
