//! Batches: a `sweep` planned case by case, each case solved on its own, and everything about a batch that can be said without
//! touching a file.
//!
//! ```text
//! Study --Draft--> what is written           draft.rs       lists, ranges, choices (vary.rs), how ranges are filled
//!       --Plan---> the cases                  plan.rs        case k is a pure function of the plan; layout.rs, sample.rs
//! Case  --varied-> a file to compile          variant.rs     models, components, effects, stimuli; once per variant
//!       --solve--> Outcome                    solve.rs       measures, or why there are none: never an end of the batch
//!       --encode-> bytes in a journal         outcome.rs, journal.rs
//! all   --rows---> the data set, its summary  dataset.rs, summary.rs; over time as quantiles: envelope.rs
//! ```
//! Nothing here depends on the order in which cases are solved, nor on who solves them: `identity.rs` says when two batches
//! are one, `shard.rs` which cases are whose. The command line keeps the bytes.

mod dataset;
mod draft;
mod envelope;
mod identity;
mod journal;
mod layout;
mod outcome;
mod plan;
mod sample;
mod shard;
mod solve;
mod summary;
mod variant;
mod vary;

pub use dataset::{Dataset, Measured, ROWS};
pub use draft::{Choice, Draft};
pub use envelope::{Enveloped, envelope};
pub use identity::{Identity, digest};
pub use journal::{HEADER_LEN, Scanned, header, record, scan};
pub use outcome::{Fault, Outcome, Trajectory};
pub use plan::{Case, Input, Model, Plan, Value, Variant};
pub use shard::{indices, shards};
pub use solve::{Wanted, solve};
pub use summary::{Gathered, MeasureSummary, QUANTILES, Summary, Worst};
pub use variant::{record_files, varied};
