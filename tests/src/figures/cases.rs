//! `cases_given_right`: the share of the cases in `tests/cases` that get the right answer.

use super::promise::{Figure, Measured, Promise};
use crate::cases;

pub(super) const FIGURE: Figure = Figure {
    name: "cases_given_right",
    unit: "%",
    promise: Promise::Exactly(100.0),
    measure: |_| {
        let hyde = std::env::current_exe().map_err(|error| error.to_string())?;
        let folders = cases::folders()?;
        let right = folders
            .iter()
            .filter(|folder| match cases::check(folder, &hyde) {
                Ok(()) => true,
                Err(reason) => {
                    tell(folder, &reason);
                    false
                }
            })
            .count();
        #[allow(clippy::cast_precision_loss, reason = "some hundred cases")]
        let share = 100.0 * right as f64 / folders.len() as f64;
        Ok(Measured::Value(share))
    },
};

#[allow(clippy::print_stderr, reason = "a figure that falls short says where")]
fn tell(folder: &std::path::Path, reason: &str) {
    eprintln!("{}: {reason}", folder.display());
}
