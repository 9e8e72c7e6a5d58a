//! Linear systems: what one does in a step, and products of small dense matrices, which an observer does most.
//!
//! ```text
//! exponential    exp(A h) and its integrals, for steps of dyadic lengths      linear/exponential.rs
//! dense          products with vectors and low-rank additions                 linear/dense.rs
//! ```

mod dense;
mod exponential;

pub(crate) use dense::{
    SIDE_BY_SIDE, add_low_rank, add_low_rank_across, add_product, set_product, set_products,
};
pub(crate) use exponential::{Step, phi1, steps};
