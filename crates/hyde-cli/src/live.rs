//! `hyde live`: a page in the browser that shows an experiment and runs it again when the file or a slider changes.
//!
//! ```text
//! session    the model, what it is set to, its runs       live/session.rs
//! frequencies  the natural frequencies beside the curves  live/frequencies.rs
//! sliders    the parameters that can be moved             live/sliders.rs
//! worker     one thing after the other, the newest first  live/worker.rs
//! watched    the files of the model on the disk           live/watched.rs
//! server     the page and its requests, loopback only     live/server.rs
//! updates    what is sent to open pages                   live/updates.rs
//! ```

mod frequencies;
mod server;
mod session;
mod sliders;
mod updates;
mod watched;
mod worker;

pub(crate) use server::serve;
pub(crate) use session::Session;
