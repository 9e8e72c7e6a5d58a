//! Effects on small hosts: each of the library vanishes with its size, and a neutral one leaves the model as it is.

use crate::models::{Solved, close, model, solve};
use hyde_compiler::Stage;
use hyde_experiment::{LIMIT_LEFT, LIMIT_PART, Options, limit};
use hyde_tests::root;
use std::collections::BTreeSet;

/// Sizes of an effect with a typical value each, SI.
type Sizes = &'static [(&'static str, f64)];

/// Effect, instance path, its sizes with a typical value in SI: a tenth of the range; of the cogging on this small
/// motor, and of the windage, which would be the greater part of what acts, a hundredth.
const EFFECTS: [(&str, &str, Sizes); 10] = [
    ("Stribeck", "guide.Stribeck", &[("dF", 100.0)]),
    ("SqrtDrag", "guide.SqrtDrag", &[("k", 100.0)]),
    (
        "PositionFriction",
        "guide.PositionFriction",
        &[("Fs", 100.0), ("Fc", 100.0)],
    ),
    ("Cogging", "motor.a.Cogging", &[("As", 0.1), ("Ac", 0.1)]),
    ("Pull", "saddle.a.Pull", &[("F", 100.0)]),
    ("Viscous", "saddle.a.Viscous", &[("b", 1000.0)]),
    ("Rocking", "saddle.a.Rocking", &[("m", 100.0)]),
    ("NutBacklash", "screw.NutBacklash", &[("gap", 10e-6)]),
    (
        "LeadError",
        "screw.LeadError",
        &[("as", 5e-6), ("ac", 5e-6)],
    ),
    ("Windage", "rotor.hub.Windage", &[("T", 0.1)]),
];

/// The tolerance of the experiments in the file.
const RTOL: f64 = 1e-9;
/// What an event leaves behind, above all an impact in the nut, has died out after this time in s.
const AWAY: f64 = 0.03;

#[test]
fn every_effect_of_the_library_is_here() {
    let library = root().join("crates/hyde-library/models/Effects.hyde");
    #[allow(
        clippy::disallowed_methods,
        reason = "the test reads the library's text"
    )]
    let text = std::fs::read_to_string(library).unwrap();
    let declared: BTreeSet<&str> = text
        .lines()
        .filter_map(|line| line.strip_prefix("effect ")?.split(' ').next())
        .collect();
    let tested: BTreeSet<&str> = EFFECTS.iter().map(|(name, ..)| *name).collect();
    assert!(!declared.is_empty());
    let missing: Vec<_> = declared.difference(&tested).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn every_effect_vanishes_with_its_size() {
    for (effect, path, sizes) in EFFECTS {
        for (size, typical) in sizes {
            let name = format!("{path}.{size}");
            let run = |value: f64| solved(effect, &[(&name, value)]);
            let (plain, small, full) = (run(0.0), run(LIMIT_PART * typical), run(*typical));
            let [plain, small, full] =
                [&plain, &small, &full].map(|run| (&run.compiled.program, &run.run.results));
            let answers = limit(plain, small, full, AWAY);
            let seen: Vec<_> = answers
                .iter()
                .filter(|answer| answer.is_seen(RTOL))
                .collect();
            assert!(seen.len() >= 2, "{name}: {answers:?}");
            for answer in seen {
                let left = answer.left();
                assert!(left <= LIMIT_LEFT, "{name}: {left} of {answer:?} is left");
                // It is small but there: a test that compared nothing would pass too.
                assert!(left >= 0.1 * LIMIT_PART, "{name}: {left} of {answer:?}");
            }
        }
    }
}

#[test]
fn a_neutral_effect_leaves_the_flat_model_but_for_its_parameters() {
    for (effect, path, sizes) in EFFECTS {
        let host = if effect == "Windage" { "Fan" } else { "Host" };
        let plain = flat(host, &[]);
        let neutral = flat(&format!("With{effect}"), &[]);
        let without = without_parameters(&neutral, path);
        assert_ne!(neutral, without, "{effect}: its parameters are listed");
        assert_eq!(without, plain, "{effect}");
        let (size, typical) = sizes[0];
        let present = flat(
            &format!("With{effect}"),
            &[(&format!("{path}.{size}"), typical)],
        );
        assert_ne!(without_parameters(&present, path), plain, "{effect}");
    }
}

#[test]
fn a_neutral_effect_leaves_the_run_to_the_last_bit() {
    let plain = solve("effects", "plain");
    for (effect, ..) in EFFECTS.iter().filter(|(effect, ..)| *effect != "Windage") {
        let neutral = solve("effects", effect);
        assert_eq!(plain.run.results.time, neutral.run.results.time, "{effect}");
        for state in ["motor.phi", "motor.w", "saddle.s", "saddle.v"] {
            assert_eq!(
                plain.column(state),
                neutral.column(state),
                "{effect}: {state}"
            );
        }
    }
}

#[test]
fn only_neutral_sizes_are_structural() {
    let structural = |value: f64| {
        let solved = solved("Stribeck", &[("guide.Stribeck.dF", value)]);
        let program = &solved.compiled.program;
        program.parameter("guide.Stribeck.dF").unwrap().0.structural
    };
    assert!(structural(0.0));
    assert!(!structural(80.0));
    // From one size to another the same program serves: the compiled value is not in its equations.
    let compiled = solved("Viscous", &[("saddle.a.Viscous.b", 500.0)]);
    let options = Options {
        set: vec![("saddle.a.Viscous.b".to_owned(), 1000.0)],
        ..Options::default()
    };
    let program = &compiled.compiled.program;
    let moved = hyde_experiment::run(program, &std::collections::BTreeMap::new(), &options);
    let moved = moved.unwrap();
    let fresh = solved("Viscous", &[("saddle.a.Viscous.b", 1000.0)]);
    let column = program.output("saddle.s").unwrap();
    assert_eq!(
        moved.results.column(column).unwrap(),
        fresh.column("saddle.s")
    );
}

#[test]
fn a_lead_error_takes_from_the_motor_what_it_gives_the_nut() {
    // partial(advance, thn) is that of the wrapped advance.
    let text = flat("WithLeadError", &[("screw.LeadError.as", 5e-6)]);
    let slope = "screw.LeadError.as*(cos(screw.LeadError.order*screw.thn)*screw.LeadError.order)";
    let loads = text
        .lines()
        .find(|line| line.contains("der(screw.w[1])") && line.contains("screw.contact.F"));
    let loaded = loads.unwrap();
    assert!(loaded.contains(slope), "{loaded}");
}

#[test]
fn effects_add_up_on_several_sites_of_one_model() {
    // Two weights pull on two masses; on the second also drag: M*der(v) = F - b*v from rest.
    let several = solve("effects", "several");
    let end = |name: &str| *several.column(name).last().unwrap();
    // v = F/M*t at 1 s with F = 30 N, M = 10 kg; rtol 1e-9.
    close(end("one.v"), 3.0, 1e-7);
    // v = F/b*(1 - exp(-b*t/M)) with b = 20 N.s/m.
    close(end("two.v"), 1.5 * (1.0 - (-2.0_f64).exp()), 1e-7);
    for name in ["one.a.Pull.F", "two.a.Pull.F", "two.a.Viscous.b"] {
        assert!(several.compiled.program.parameter(name).is_some(), "{name}");
    }
}

#[test]
fn wraps_of_one_site_compose_in_the_order_written() {
    let order = solve("effects", "order");
    // (F + 3 N) twice, then half of (2*F): the first written is the inner one.
    close(order.column("first.push.F")[0], 2.0 * (5.0 + 3.0), 1e-12);
    close(order.column("second.push.F")[0], 2.0 * 5.0 + 3.0, 1e-12);
}

/// An experiment of the file with some sizes set.
fn solved(experiment: &str, set: &[(&str, f64)]) -> Solved {
    let mut example = model("effects", Some(experiment));
    for (name, value) in set {
        example = example.set(name, *value);
    }
    let (compiled, run) = example
        .run()
        .unwrap_or_else(|error| panic!("{experiment} at {set:?}: {error}"));
    Solved { compiled, run }
}

/// The flat form of a model of the file with some sizes set, without the line that names it.
fn flat(name: &str, set: &[(&str, f64)]) -> String {
    let mut example = model("effects", None).model(name);
    for (name, value) in set {
        example = example.set(name, *value);
    }
    let text = example.emit(Stage::Flat);
    let text = text.unwrap_or_else(|error| panic!("{name} at {set:?}: {error}"));
    let lines = text.lines().skip(1).map(|line| format!("{line}\n"));
    lines.collect()
}

/// The lines that are not parameters of the effect on this path.
fn without_parameters(flat: &str, path: &str) -> String {
    let lines = flat.lines().filter(|line| !line.contains(path));
    lines.map(|line| format!("{line}\n")).collect()
}
