//! What came of a sweep: its summary as text and JSON, its page, its trajectories.

pub mod over_time;
pub mod page;
pub mod tell;
