//! A model as one C11 file with its header, for controllers and hardware in the loop: no dependencies but `<math.h>` and
//! `<string.h>`, no allocation, a fixed step.
//!
//! ```text
//! fixed_step   what a program is with a fixed step, or why it cannot be       fixed_step.rs
//! names        names of C for inputs, parameters and outputs                  names.rs
//! elimination  the order in which equations are eliminated                    elimination.rs, elimination.c
//! factors      the factors of the matrix in this order, as straight lines     factors.rs
//! header       the header: the interface                                      header.rs
//! source       tables and kernels around the runtime                          source.rs
//! runtime.c    the step itself, the same for every model                      runtime.c
//! ```
//! A step is one of implicit Euler with Newton's method. The factors of its matrix are kept for the modes that they are of; where
//! all equations are affine, one iteration is a step. Otherwise they are kept while they converge. What happens in a step
//! happens at its end: modes change, conditions become true, clocks tick on the values before (as in hyde-sim). Start values
//! are those that the exporting machine found consistent.

mod elimination;
mod factors;
mod fixed_step;
mod header;
mod names;
mod refusals;
mod source;

pub use fixed_step::{FixedStep, Start};

/// A header and a source.
#[derive(Clone, Debug)]
pub struct Written {
    /// `NAME.h`
    pub header: String,
    /// `NAME.c`
    pub source: String,
}

/// Writes a model with the C code of its kernels ([`hyde_study::Project::kernels_as_c`]).
#[must_use]
pub fn written(model: &FixedStep<'_>, kernels: &str) -> Written {
    let names = names::Names::of(model);
    let order = elimination::Elimination::of(model);
    let factors = factors::Factors::of(model.program, &order);
    let coefficients = model.program.kernels.coefficients();
    Written {
        header: header::text(model, &names, (&factors, &coefficients)),
        source: source::text(model, &names, (&order, &factors, &coefficients), kernels),
    }
}
