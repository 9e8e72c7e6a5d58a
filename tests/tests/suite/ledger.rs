//! The energy ledger: every joule is told, and the modes say where theirs are.

use crate::models::{Solved, close, model};
use hyde_experiment::{EnergyLedger, LedgerEntry, linearize, mode_shape, parameters, poles};
use hyde_tests::random_ledger::open;
use std::collections::BTreeMap;

fn turned() -> Solved {
    let outcome = model("ledger", Some("turn")).ledger().run();
    let (compiled, run) = outcome.unwrap();
    Solved { compiled, run }
}

fn ledger(solved: &Solved) -> EnergyLedger {
    let sums = solved.run.results.energies.as_ref().unwrap();
    EnergyLedger::new(&solved.compiled.program.experiment.ledger, sums)
}

fn entry<'a>(ledger: &'a EnergyLedger, component: &str) -> &'a LedgerEntry {
    let mut entries = ledger.entries.iter();
    entries.find(|e| e.component == component).unwrap()
}

#[test]
fn every_joule_is_told() {
    let turned = turned();
    let ledger = ledger(&turned);
    // The promise at rtol 1e-8.
    assert!(ledger.closure() <= 1e-6, "{:e}", ledger.closure());
    // What friction took is its torque times the way, piece by piece of one direction.
    let (phi, f) = (turned.column("drag.a.phi"), turned.column("drag.f"));
    let mut heat = 0.0;
    for row in 1..phi.len() {
        heat += 0.5 * (f[row] + f[row - 1]) * (phi[row] - phi[row - 1]);
    }
    // Rows every millisecond, and at every event.
    close(entry(&ledger, "drag").dissipated, heat, 1e-4 * heat);
    // The inertia has what its speed says.
    let w = turned.column("one.w").last().copied().unwrap();
    close(entry(&ledger, "one").stored, 0.5 * 0.02 * w * w, 1e-9);
    // The source says nothing of itself: what it gave it was supplied.
    let push = entry(&ledger, "push");
    close(push.supplied, -push.received, 0.0);
    close(ledger.total().received, 0.0, 1e-9 * ledger.passed);
}

#[test]
fn the_ledgers_of_random_chains_close() {
    for seed in 0..60 {
        assert_eq!(open(seed).unwrap(), None, "seed {seed}");
    }
}

#[test]
fn an_impact_is_a_loss_at_an_event() {
    let outcome = model("ledger", Some("bounce")).ledger().run();
    let (compiled, run) = outcome.unwrap();
    let ledger = ledger(&Solved { compiled, run });
    // Half of the speed is left: three quarters of m*g*h = 1 kg * 10 m/s2 * 1 m are lost at the first impact.
    close(ledger.total().at_events, -7.5, 1e-6);
}

#[test]
fn a_mode_tells_where_its_energy_is() {
    let example = model("ledger", Some("turn")).free_inputs().ledger();
    let compiled = example.compile(hyde_compiler::Backend::Native).unwrap();
    let program = &compiled.program;
    let p = parameters(program, &BTreeMap::new(), &[]).unwrap();
    let linear = linearize(program, &BTreeMap::new(), &p, &[], &[]).unwrap();
    let poles = poles(&linear);
    let found = poles.oscillating();
    let shape = mode_shape(program, &linear, (&poles, &found[0])).unwrap();
    let share = |component: &str, account: &str| {
        let mut shares = shape.shares.iter();
        shares
            .find(|s| s.0 == component && s.1 == account)
            .unwrap()
            .2
    };
    // Two inertias on a spring: half of the energy is the spring's, and what moves has the rest in proportion to 1/J but
    // for the shaft's own inertia of 0.01 kg.m2. The damping of 3.6 % shifts it by a tenth of that.
    close(share("shaft", "twist"), 0.5, 5e-3);
    close(shape.shares.iter().map(|s| s.2).sum(), 1.0, 1e-12);
    assert!(share("one", "kinetic") > 1.7 * share("two", "kinetic"));
}
