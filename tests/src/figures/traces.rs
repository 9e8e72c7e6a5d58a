//! `layouts_right` and `mutated_records_misread`: traces in the layouts that drive software leaves.

use super::promise::{Figure, Measured, Promise};
use crate::traces::{Mutated, Outcome, layouts};

pub(super) const LAYOUTS: Figure = Figure {
    name: "layouts_right",
    unit: "%",
    promise: Promise::Exactly(100.0),
    measure: |session| {
        let folder = session.data.join("traces");
        if !folder.is_dir() {
            return Ok(Measured::Absent(format!(
                "traces of drive software in `{}`",
                folder.display()
            )));
        }
        let all = layouts(&folder)?;
        for (name, reason) in &all {
            if let Some(reason) = reason {
                tell(&format!("{name}: {reason}"));
            }
        }
        let right = all.iter().filter(|(_, reason)| reason.is_none()).count();
        #[allow(clippy::cast_precision_loss, reason = "some files")]
        let share = 100.0 * right as f64 / all.len() as f64;
        Ok(Measured::Value(share))
    },
};

/// So many files are drawn.
const FILES: u64 = 1000;

pub(super) const MUTATED: Figure = Figure {
    name: "mutated_records_misread",
    unit: "of 1000",
    promise: Promise::Exactly(0.0),
    measure: |_| {
        let mut misread = 0_u32;
        for seed in 0..FILES {
            let outcome = std::panic::catch_unwind(|| Mutated::of(seed).outcome());
            let wrong = match outcome {
                Ok(Outcome::Right | Outcome::Refused(_)) => None,
                Ok(Outcome::Misread(reason)) => Some(reason),
                Err(_) => Some("the reader panics".to_owned()),
            };
            if let Some(reason) = wrong {
                tell(&format!("file {seed}: {reason}"));
                misread += 1;
            }
        }
        Ok(Measured::Value(f64::from(misread)))
    },
};

#[allow(clippy::print_stderr, reason = "a figure that falls short says where")]
fn tell(text: &str) {
    eprintln!("{text}");
}
