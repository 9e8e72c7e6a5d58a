//! What a calibrated model lacks: every effect at every site is scored, survivors are fitted, the best is taken in, and on.
//!
//! ```text
//! hypothesis     an effect at a site, with sizes and shapes; a model with some put on     diagnosis/hypothesis.rs
//! thresholds     every number that decides an answer                                 diagnosis/thresholds.rs
//! inquiry        a model on records, with all that may be missing of it                diagnosis/inquiry.rs
//! projection     what a change of innovations gains once parameters have answered it      diagnosis/projection.rs
//! grid           the values of its shapes that are tried                                   diagnosis/grid.rs
//! products       sums over rows that scores are made of                                   diagnosis/products.rs
//! runs           innovations of the model with an effect put on, and their tangents       diagnosis/runs.rs
//! scan           scores of an effect over its shapes and sizes                            diagnosis/scan.rs
//! trial          a survivor fitted together with all parameters, and judged on folds      diagnosis/trial.rs
//! contest        survivors beside each other: gates, and which of them is taken in        diagnosis/contest.rs
//! profile        the last of a fit: numbers of effects at the bottom of their profiles    diagnosis/profile.rs
//! evidence       what gains have to reach, and what is left to explain                    diagnosis/evidence.rs
//! search         what is missing, one effect after the other                              diagnosis/search.rs
//! answer         what was found: the verdict, its findings, the model                     diagnosis/answer.rs
//! finding        an effect that was taken in, with its quantities                          diagnosis/finding.rs
//! forward        its branches, two at most, and their rounds                              diagnosis/forward.rs
//! pair           two effects that show only together                                      diagnosis/pair.rs
//! exchange       earlier effects once more against their rivals                           diagnosis/exchange.rs
//! apart          what alternatives are to each other, and what would tell them apart      diagnosis/apart.rs
//! alike          whether two effects do the same wherever the axis is                     diagnosis/alike.rs
//! prune          back: what is not missed any more                                        diagnosis/prune.rs
//! undetermined   shapes that the records do not determine stay as declared                diagnosis/undetermined.rs
//! spread         intervals over all values that the records allow of such shapes          diagnosis/spread.rs
//! whole          orders of angles that are likelier whole numbers                         diagnosis/whole.rs
//! holding        an observer that holds the modes of what was found, too                 diagnosis/holding.rs
//! edges          what an effect with modes may leave of what it explains                  diagnosis/edges.rs
//! claims         the last gate: what is claimed is told from its neutral value            diagnosis/claims.rs
//! calibrated     a model with states of its own calibrated with a gain for them           diagnosis/calibrated.rs
//! curve          an effect that was found over its variable, with what the records say    diagnosis/curve.rs
//! command timing whether the model puts a replayed command out when it was recorded       diagnosis/command_timing.rs
//! unknown        a law of the model's own variables where no effect known is it           diagnosis/unknown.rs
//! ```

mod alike;
mod answer;
mod apart;
mod calibrated;
mod claims;
mod command_timing;
mod contest;
mod curve;
mod edges;
mod evidence;
mod exchange;
mod finding;
mod forward;
mod grid;
mod holding;
mod hypothesis;
mod inquiry;
mod pair;
mod products;
mod profile;
mod projection;
mod prune;
mod runs;
mod scan;
mod search;
mod spread;
mod stage;
mod thresholds;
mod trial;
mod undetermined;
mod unknown;
mod unknowns;
mod whole;

pub(crate) use projection::Projection;
pub(crate) use stage::{Ground, Stage, flat};

pub use answer::{Diagnosis, Verdict};
pub use apart::{Alternative, Experiment, Relation};
pub use claims::FoundModel;
pub use command_timing::{CommandTiming, Commands, Uncompared, Why, moved_columns};
pub use curve::{CurvePoint, FoundCurve, Over};
pub use evidence::Gates;
pub use finding::{Finding, Quantity};
pub use forward::Round;
pub use hypothesis::{Built, Hypothesis, Knob};
pub use inquiry::{Author, Inquiry};
pub use scan::Score;
pub use search::diagnose;
pub use thresholds::{TABLE, Threshold, Thresholds};
pub use trial::{Rejection, Trial};
pub use unknown::{
    Factor, FoundLaw, Kind, LatentForce, Law, LawVariable, Map, Panel, Scales, Seen, Site, Summand,
    Unknown, Variable, Written,
};
