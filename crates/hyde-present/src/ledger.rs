//! The energy ledger as a table for people and as JSON for programs.

use hyde_compiler::Compiled;
use hyde_experiment::{EnergyLedger, LedgerEntry, Run};
use hyde_units::significant;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Shares of the energy that passed below this are printed as nothing.
const NOTHING: f64 = 1e-12;

/// The ledger of a run, if it was asked for.
pub fn of(compiled: &Compiled, run: &Run) -> Option<EnergyLedger> {
    let sums = run.results.energies.as_ref()?;
    Some(EnergyLedger::new(&compiled.program.experiment.ledger, sums))
}

/// The table, of at most 80 columns.
pub fn text(ledger: &EnergyLedger) -> String {
    let mut out = format!(
        "\n  {:<20} {:>10} {:>10} {:>10} {:>10} {:>10}\n",
        "energy [J]", "received", "supplied", "stored", "heat", "remainder"
    );
    let number = |value: f64| {
        if value.abs() <= NOTHING * ledger.passed {
            "0".to_owned()
        } else {
            significant(value, 4)
        }
    };
    let mut line = |name: &str, entry: &LedgerEntry| {
        let values = [
            entry.received,
            entry.supplied,
            entry.stored + entry.at_events,
            entry.dissipated,
            entry.remainder,
        ];
        let _ = write!(out, "  {name:<20}");
        for value in values {
            let _ = write!(out, " {:>10}", number(value));
        }
        out.push('\n');
    };
    for entry in &ledger.entries {
        let idle = [
            entry.received,
            entry.supplied,
            entry.stored,
            entry.dissipated,
            entry.at_events,
        ];
        if idle
            .iter()
            .any(|value| value.abs() > NOTHING * ledger.passed)
        {
            let name = if entry.component.is_empty() {
                "the model"
            } else {
                &entry.component
            };
            line(name, entry);
        }
    }
    let total = ledger.total();
    line("all", &total);
    if total.at_events.abs() > NOTHING * ledger.passed {
        let _ = writeln!(
            out,
            "  change of stored energy at events: {} J",
            significant(total.at_events, 4)
        );
    }
    let _ = writeln!(
        out,
        "  energy transferred: {} J; balance error relative to it: {}",
        significant(ledger.passed, 4),
        significant(ledger.closure(), 2)
    );
    out
}

/// The ledger as JSON.
pub fn json(ledger: &EnergyLedger) -> Value {
    let entries: Vec<Value> = ledger
        .entries
        .iter()
        .map(|entry| {
            json!({
                "component": entry.component, "received": entry.received, "supplied": entry.supplied,
                "stored": entry.stored, "at_events": entry.at_events, "dissipated": entry.dissipated,
                "remainder": entry.remainder,
            })
        })
        .collect();
    json!({ "unit": "J", "passed": ledger.passed, "closure": ledger.closure(), "components": entries })
}
