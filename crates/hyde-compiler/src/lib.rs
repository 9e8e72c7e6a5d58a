//! From source text to a program: the stages in order, and each stage as text.
//!
//! Start reading at [`compile`] in `pipeline.rs`.

mod emit;
mod load;
mod pipeline;

pub use emit::{Stage, emit};
pub use hyde_flatten::Header;
pub use hyde_jit::Backend;
pub use load::{File, load};
pub use pipeline::{Compiled, Request, analyze, compile};
