//! A language server for Hyde: what an editor asks about a text, answered with the functions of hyde-study.
//!
//! ```text
//! server        messages in and out, and the pause before a full check     server.rs
//! capabilities  what both agree on at the beginning                        capabilities.rs
//! check         a full check, on a thread of its own                       check.rs
//! answer        each request with its answer                               answer.rs
//! documents     the texts that are open, over the files of the disk        documents.rs
//! analysis      a text with the packages it names, parsed                  analysis.rs
//! scope         what a name means                                          scope.rs
//! place         which names are known at a place, what a bracket is about  place.rs
//! values        values, spreads and dimensions                             values.rs
//! lens          commands over experiments and diagnoses                    lens.rs
//! outcome       how such a command ended                                   outcome.rs
//! nobody        a host that runs none, for tests and fuzz targets          nobody.rs
//! runs          the last run of each file: its values and its failure      runs.rs, course.rs
//! occurrences   every name of a file with its meaning                      occurrences.rs
//! position      places as the protocol counts them                         position.rs
//! ```
//! Start reading at [`serve`] in `server.rs`. Nothing here opens files of its own or prints: files are those of a
//! [`hyde_study::world::World`], and what needs the machine is asked of a [`Host`].

mod analysis;
mod answer;
mod before;
mod capabilities;
mod check;
mod complete;
mod course;
mod describe;
mod documents;
mod fixes;
mod inlay;
mod lens;
mod nobody;
mod occurrences;
mod outcome;
mod outline;
mod place;
mod position;
mod publish;
mod rename;
mod runs;
mod scope;
mod server;
mod signature;
mod tokens;
mod uri;
mod values;

pub use lens::{Action, Order};
pub use nobody::Nobody;
pub use outcome::{Course, Courses, Failure, Label, Outcome};
pub use server::{Ended, Host, PAUSE, serve};
