//! From source text to a program: the stages in order, and each stage as text.
//!
//! Start reading at [`compile`] in `pipeline.rs`.

mod alone;
mod diagnosis;
mod emit;
mod ideal;
mod known;
mod library_trees;
mod load;
mod modifications;
mod named;
mod parses;
mod pipeline;
mod refusals;
mod states;
mod write_back;
mod write_values;
mod written;

pub use alone::{Alone, alone};
pub use diagnosis::DiagnosisPlan;
pub use emit::{Stage, emit, kernels_as_c};
pub use hyde_analysis::beside_time;
pub use hyde_flatten::{FUNCTIONS, usage};
pub use hyde_flatten::{FmuInterface, Form, FreeInputs, Header, TableFile, fmu_has_no_equations};
pub use hyde_ir::{LawShape, Prior, Quantity};
pub use hyde_jit::Backend;
pub use ideal::{changed, covers, ideals};
pub use known::{
    Additions, Candidate, Knob, LawSite, LawVariable, Laws, Meaning, MeaningOf, ValueOf,
    candidates, laws, meaning,
};
pub use load::{File, Find, Packages, Place, check_name, load};
pub use modifications::modifications;
pub use parses::parses;
pub use pipeline::{Compiled, Request, analyze, compile, compile_unless, compile_with};
pub use states::States;
pub use write_back::{Calibrated, Found, Written, write_back};
pub use write_values::{NewValue, write_values};
pub use written::with_written;
