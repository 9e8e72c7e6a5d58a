//! The fixed-step form of a program, driven by a record: as cheap as a search needs it, as exact as one wants.
//!
//! ```text
//! driven         a program at an instant of a record, and the steps of a row            plant/driven.rs
//! inputs         the columns that drive it, within a row                                plant/inputs.rs
//! past           delayed values of them                                                 plant/past.rs
//! configuration  the model in one combination of modes, linearised once                 plant/configuration.rs
//! gains          what corrects it there, for each kind of row                           plant/gains.rs
//! model          rates and algebraic variables where the states are                     plant/model.rs
//! secants        what answers residuals where derivatives differ from point to point    plant/secants.rs
//! stepping       a step: the linear part exactly, the rest in two stages                plant/stepping.rs
//! events         reactions that fire at its end                                         plant/events.rs
//! leg            a step that was taken, for those who follow                            plant/leg.rs
//! outputs        what measured channels show, and its derivatives by the states         plant/outputs.rs
//! lengths        how long steps are                                                     plant/lengths.rs
//! unsupported    why a program has no such form                                         plant/unsupported.rs
//! snapshot       a plant at a row, to come back to                                      plant/snapshot.rs
//! ```

mod configuration;
mod driven;
mod events;
mod gains;
mod inputs;
mod leg;
mod lengths;
mod model;
mod outputs;
mod past;
mod secants;
mod snapshot;
mod stepping;
mod unsupported;

pub(crate) use configuration::{
    Configuration, Places, arranged, partials, uneven, v_column, x_column,
};
pub(crate) use driven::Plant;
pub(crate) use gains::Gains;
pub(crate) use leg::{Instant, Leg, length};
pub(crate) use lengths::{LEVELS, shortest_steps, size_of};
pub(crate) use outputs::{measured, output_matrix};
pub(crate) use past::past_differs;
pub(crate) use snapshot::Snapshot;
pub use unsupported::Unsupported;
