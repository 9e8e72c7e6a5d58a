//! A diagnosis in one order: on the terminal, as JSON, as a page.
//!
//! ```text
//! terminal     80 columns                                         diagnosed/text.rs
//! JSON         `report.json`: book/src/report.schema.json         diagnosed/json.rs
//! page         `report.html`                                      diagnosed/page.rs, diagnosed/found.rs
//! plain words  its paragraph                                      diagnosed/plain.rs
//! ```

mod found;
mod json;
mod page;
mod plain;
mod text;

pub use json::json;
pub use page::html;
pub use text::{text, wrapped};

use hyde_study::diagnosis::{Diagnosed, Tried, named, suspicion, timing, verdict};
