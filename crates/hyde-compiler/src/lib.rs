//! From source text to a program: the stages in order, and each stage as text.
//!
//! Start reading at [`compile`] in `pipeline.rs`.

mod candidates;
mod diagnosis;
mod emit;
mod ideal;
mod load;
mod named;
mod pipeline;
mod states;
mod write_back;
mod written;

pub use candidates::{Additions, Candidate, Knob, candidates};
pub use diagnosis::DiagnosisPlan;
pub use emit::{Stage, emit, kernels_as_c};
pub use hyde_flatten::{Form, FreeInputs, Header, TableFile};
pub use hyde_jit::Backend;
pub use ideal::{changed, ideals};
pub use load::{File, Find, Packages, Place, check_name, load};
pub use pipeline::{Compiled, Request, analyze, compile, compile_with};
pub use states::States;
pub use write_back::{Calibrated, Found, Written, write_back};
pub use written::with_written;
