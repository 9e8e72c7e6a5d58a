//! `energy_ledger_closure`, `ledger_open`: does every joule of a run have its place?
//!
//! Two drives at rtol 1e-8, the worse counts: inertias, a damped bar and a friction that stops them, and the Y axis
//! setting off, with its motor, belt, screw, frictions and backlash.

use super::promise::{Figure, Measured, Promise, Session, count};
use crate::Example;
use crate::random_ledger::open;
use hyde_experiment::{EnergyLedger, Options};

pub(super) const FIGURE: Figure = Figure {
    name: "energy_ledger_closure",
    unit: "relative",
    promise: Promise::AtMost(1e-6),
    measure,
};

/// Random chains of bodies whose ledger does not close.
pub(super) const OPEN: Figure = Figure {
    name: "ledger_open",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure: |_: &Session| count(60, open),
};

/// The remainders of all components over the energy that passed.
fn measure(_: &Session) -> Result<Measured, String> {
    let small = closure("tests/models/ledger.hyde", "turn", None)?;
    let axis = closure("examples/y_axis/axis.hyde", "positioning", Some(0.3))?;
    Ok(Measured::Value(small.max(axis)))
}

fn closure(path: &str, experiment: &str, stop_s: Option<f64>) -> Result<f64, String> {
    let options = Options {
        rtol: Some(1e-8),
        stop_s,
        ..Options::default()
    };
    let example = Example::load(path, Some(experiment))?.ledger();
    let (compiled, run) = example.run_with(&options)?;
    let sums = run.results.energies.as_ref();
    let sums = sums.ok_or("the run has no ledger")?;
    Ok(EnergyLedger::new(&compiled.program.experiment.ledger, sums).closure())
}
