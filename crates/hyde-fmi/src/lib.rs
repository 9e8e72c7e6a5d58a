//! A model as an FMU, the exchange format of FMI (<https://fmi-standard.org>): what `hyde export fmu` writes, and what the
//! library in the archive runs.
//!
//! ```text
//! kept           what an FMU holds of its model, and the bytes of that   kept.rs
//! model          the model compiled from it                              model.rs
//! interface      its variables with their value references               interface.rs
//! description    modelDescription.xml of FMI 3 and FMI 2                 description.rs, fmi_3_0.rs, fmi_2_0.rs, xml.rs
//! reference      what it is expected to compute: FMI-LS-REF              reference.rs
//! archive        the files of the FMU in one                             archive.rs
//! instance       a run that an importer sets, steps and asks             instance.rs
//! ```
//! Exporter and library make the interface by the same function from the same model, so value references agree. Nothing here
//! knows C: `hyde-fmu` is the boundary.

mod archive;
mod description;
mod fmi_2_0;
mod fmi_3_0;
mod instance;
mod interface;
mod kept;
mod model;
mod reference;
mod running;
mod xml;

pub use archive::{ArchiveError, Version, archive};
pub use description::Described;
pub use hyde_units::Kind;
pub use instance::{Arrival, Instance, Interface as Use, Progress, Refusal, Saved, Update};
pub use interface::{Causality, Interface, Source, Variability, Variable};
pub use kept::{Kept, RESOURCE};
pub use model::{Chosen, Model, Uncompiled};
pub use reference::Reference;
