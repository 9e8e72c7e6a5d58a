//! The tests of experiments: what they expect, and whether the effects on their models vanish with their sizes.
//!
//! ```text
//! limits     the limit test of the size of an effect          experiment_tests/limits.rs
//! ```

mod limits;

pub use limits::{Neutral, Size, sizes, tested as limit};

use crate::asked::Asked;
use crate::runs::{How, project_of, solved};
use crate::{Loaded, Refused};

/// What was tested, and what came of it.
pub struct Tested {
    /// The experiment, with the size for the limit test of an effect.
    pub name: String,
    /// What came of it.
    pub verdict: Verdict,
    /// What was found, in a few words.
    pub found: String,
}

/// What came of a test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// It passed.
    Passed,
    /// It failed.
    Failed,
    /// Nothing was decided.
    Skipped,
}

impl Verdict {
    /// The word of a table.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Skipped => "skipped",
        }
    }
}

/// What came of an experiment.
pub struct Outcome {
    /// Its tests.
    pub tests: Vec<Tested>,
    /// What could not be run.
    pub refused: Vec<Refused>,
    /// The experiment itself was run.
    pub ran: bool,
}

/// Tests an experiment: what it expects, then the sizes of the effects on its model.
pub fn experiment(loaded: &Loaded, asked: &Asked, how: &How) -> Outcome {
    let name = asked.experiment.clone().unwrap_or_default();
    let solved = project_of(loaded, asked).and_then(|project| solved(project, how, |_| {}));
    let (compiled, run) = match solved {
        Ok(solved) => solved,
        Err(refused) => {
            let test = Tested {
                name,
                verdict: Verdict::Failed,
                found: "could not be run, see above".to_owned(),
            };
            return Outcome {
                tests: vec![test],
                refused: vec![refused],
                ran: false,
            };
        }
    };
    let count = run.measures.iter().filter(|m| m.expectation).count();
    let broken = run.measures.iter().filter(|measure| !measure.holds);
    let broken: Vec<String> = broken
        .map(|measure| {
            let why = measure.missing.as_ref();
            let why = why.map_or(String::new(), |missing| format!(": {}", missing.text()));
            format!("{}{why}", measure.name)
        })
        .collect();
    let mut tests = vec![Tested {
        verdict: match (count, broken.len()) {
            (0, 0) => Verdict::Skipped,
            (_, 0) => Verdict::Passed,
            _ => Verdict::Failed,
        },
        found: match (count, broken.as_slice()) {
            (0, []) => "expects nothing".to_owned(),
            (1, []) => "1 expectation holds".to_owned(),
            (count, []) => format!("{count} expectations hold"),
            (_, broken) => format!("does not hold: {}", broken.join("; ")),
        },
        name,
    }];
    let mut refused = Vec::new();
    for size in sizes(&compiled.program, &run, Neutral::LeftOut) {
        match limit(loaded, asked, &size, how) {
            Ok(test) => tests.push(test),
            Err(own) => refused.push(*own),
        }
    }
    Outcome {
        tests,
        refused,
        ran: true,
    }
}
