//! Which effects fit where on a model.

use crate::pipeline::{Request, input};
use hyde_diag::Diagnostics;
pub use hyde_flatten::{Additions, Candidate, Knob};

/// Every effect of the files loaded at every site of the model where it fits; `None` if the model has errors.
///
/// Put one on the model with [`Additions::put`] and [`crate::compile_with`].
pub fn candidates(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Vec<Candidate>> {
    if diagnostics.has_errors() {
        return None;
    }
    hyde_flatten::candidates(&input(request, &Additions::new()), diagnostics)
}
