//! What is known of a model beside its program: which effects fit where on it, and what its expressions mean.

use crate::load::with_package;
use crate::pipeline::{Request, input};
use hyde_diag::Diagnostics;
pub use hyde_flatten::{
    Additions, Candidate, Knob, LawSite, LawVariable, Laws, Meaning, MeaningOf, ValueOf,
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

/// The package of the library that has shapes of laws: no model has to import it.
const SHAPES: &str = "Laws";

/// The sites of the model where a law may act, and the shapes that the library and the files loaded have for one; `None` if
/// the model has errors.
pub fn laws(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Option<Laws> {
    if diagnostics.has_errors() {
        return None;
    }
    let (sources, file) = with_package(request.sources, request.file, SHAPES);
    let request = Request {
        sources: &sources,
        file: &file,
        ..*request
    };
    hyde_flatten::laws(&input(&request, &Additions::new()), diagnostics)
}

/// What the expressions and parameters of the user's file mean in the model, as far as they are understood, errors or not.
pub fn meaning(request: &Request<'_>, diagnostics: &mut Diagnostics) -> Meaning {
    hyde_flatten::meaning(&input(request, &Additions::new()), diagnostics)
}
