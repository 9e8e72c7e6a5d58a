//! What is known of a model beside its program: which effects fit where on it, and what its expressions mean.

use crate::pipeline::{Request, input};
use hyde_diag::Diagnostics;
pub use hyde_flatten::{
    Additions, Candidate, Knob, LawSite, LawVariable, Meaning, MeaningOf, ValueOf,
};

/// Every effect of the files loaded at every site of the model where it fits; `None` if the model has errors.
///
/// Put one on the model with [`Additions::put`] and [`crate::compile_with`].
pub fn candidates(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Vec<Candidate>> {
    if diagnostics.has_errors() {
        return None;
    }
    hyde_flatten::candidates(&input(request, &Additions::new()), diagnostics)
}

/// The sites of the model where a law may act; `None` if the model has errors.
pub fn law_sites(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Vec<LawSite>> {
    if diagnostics.has_errors() {
        return None;
    }
    hyde_flatten::law_sites(&input(request, &Additions::new()), diagnostics)
}

/// What the expressions and parameters of the user's file mean in the model, as far as they are understood, errors or not.
pub fn meaning(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Meaning {
    hyde_flatten::meaning(&input(request, &Additions::new()), diagnostics)
}
