//! Which effects fit where on a model.

use crate::pipeline::{Request, flatten};
use hyde_diag::Diagnostics;
pub use hyde_ir::flat::Fit;

/// Every effect of the files loaded with the sites of the model that it fits on; `None` if the model has errors.
pub fn fits(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Vec<Fit>> {
    flatten(request, diagnostics).map(|flat| flat.fits)
}
