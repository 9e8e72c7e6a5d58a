//! From source text to a program: the stages in order, and each stage as text.
//!
//! Start reading at [`compile`] in `pipeline.rs`.

mod emit;
mod fits;
mod load;
mod pipeline;

pub use emit::{Stage, emit};
pub use fits::{Fit, fits};
pub use hyde_flatten::Header;
pub use hyde_jit::Backend;
pub use load::{File, Packages, load};
pub use pipeline::{Compiled, Request, analyze, compile};
