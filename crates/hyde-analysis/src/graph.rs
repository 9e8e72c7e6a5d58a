//! Graph algorithms on integers: they know nothing of equations.

mod matching;
mod tarjan;

pub use matching::{Bipartite, Matching};
pub use tarjan::strongly_connected_components;
