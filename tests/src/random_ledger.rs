//! Random bodies with springs, dampers, contacts, gears, frictions and drives: does their energy ledger close?
//!
//! What drives them from outside is known by itself as well: force times speed over the rows of the results.

use crate::Example;
use crate::differential::bodies;
use hyde_experiment::{EnergyLedger, Options};

/// Of the energy that passed, what may be missing in all balances together.
const CLOSES: f64 = 1e-6;

/// What is wrong with the ledger of the bodies of a seed; nothing if it closes.
///
/// # Errors
/// The model does not compile or does not run.
pub fn open(seed: u64) -> Result<Option<String>, String> {
    open_in(&bodies::random(seed).text)
}

/// The same for a text whose experiment `run` measures the supplied energy.
pub(crate) fn open_in(text: &str) -> Result<Option<String>, String> {
    let with_text = |reason: String| format!("{reason}\n{text}");
    let example = Example::load("tests/models/ledger.hyde", None)?.replaced(text, "run");
    let found = example.ledger().run_with(&Options::default());
    let (compiled, run) = found.map_err(|error| with_text(format!("{error:?}")))?;
    let sums = run.results.energies.as_ref();
    let sums = sums.ok_or("the run has no ledger")?;
    let ledger = EnergyLedger::new(&compiled.program.experiment.ledger, sums);
    if ledger.closure() > CLOSES || ledger.closure().is_nan() {
        let list: Vec<String> = ledger.entries.iter().map(|e| format!("{e:?}")).collect();
        let reason = format!("the remainders are {:e}", ledger.closure());
        return Ok(Some(with_text(format!("{reason}\n{}", list.join("\n")))));
    }
    let measure = run.measures.first().ok_or("the work is not measured")?;
    let supplied = ledger.total().supplied;
    let off = (supplied - measure.value).abs();
    Ok((off > CLOSES * ledger.passed).then(|| {
        let reason = format!(
            "{supplied} J are supplied, but the drive does {} J",
            measure.value
        );
        with_text(reason)
    }))
}
