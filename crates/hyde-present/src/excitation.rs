//! What to record next: a design and a comparison of signals, as text, as JSON and as the file of the signal.

pub mod file;
pub mod table;
pub mod text;
