//! A self-test as tables and as JSON.

mod json;
mod text;

pub use json::report as json;
pub use text::text;
