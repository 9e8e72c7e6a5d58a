//! Candidates: every effect at every site of a model where it fits, and models with some of them put on.

use crate::command::{report, write};
use crate::driven_body::{SLOW, diagnosed};
use crate::unknown_effects::make;
use hyde_compiler::{Additions, Backend, Calibrated, Candidate, DiagnosisPlan, Found, write_back};
use hyde_diag::Diagnostics;
use hyde_experiment::Options;
use hyde_tests::{Example, Loaded};

fn bench() -> (Example, Loaded, Vec<Candidate>) {
    let example = Example::load("examples/bench_axis/axis.hyde", Some("bench")).unwrap();
    let example = example.whole_library();
    let loaded = example.parse().unwrap();
    let candidates = loaded.candidates(&example).unwrap();
    (example, loaded, candidates)
}

fn of<'c>(candidates: &'c [Candidate], effect: &str) -> Vec<&'c Candidate> {
    let found: Vec<_> = candidates.iter().filter(|c| c.effect == effect).collect();
    assert!(!found.is_empty(), "{effect} fits nowhere");
    found
}

#[test]
fn connectors_that_are_one_site_are_named_by_the_one_with_the_state() {
    let (.., candidates) = bench();
    let cogging = of(&candidates, "Effects.Cogging");
    let sites: Vec<&str> = cogging.iter().map(|c| c.site.as_str()).collect();
    assert_eq!(sites, ["motor.shaft", "pulley.a", "screw.b"]);
    assert_eq!(cogging[0].aliases[..2], ["bearing.a", "belt.a"]);
    // The free end of the pulley turns with the other for good, though nothing is connected to it.
    assert!(cogging[1].aliases.contains(&"pulley.b".to_owned()));
    let rocking = of(&candidates, "Effects.Rocking");
    assert_eq!(rocking.len(), 1, "{rocking:?}");
    assert_eq!(rocking[0].site, "saddle.a");
    assert!(rocking[0].aliases.contains(&"screw.nut".to_owned()));
}

#[test]
fn a_candidate_tells_its_sizes_and_shapes() {
    let (.., candidates) = bench();
    let stribeck = of(&candidates, "Effects.Stribeck")
        .into_iter()
        .find(|candidate| candidate.site == "guide")
        .unwrap();
    assert_eq!(
        (stribeck.name(), stribeck.instance.as_str()),
        ("Stribeck", "Stribeck")
    );
    assert_eq!(stribeck.package, "Effects");
    let (size, shape) = (&stribeck.sizes[0], &stribeck.shapes[0]);
    assert_eq!((size.name.as_str(), size.value), ("dF", 0.0));
    assert_eq!(size.range, Some((0.0, 1000.0)));
    assert_eq!((shape.name.as_str(), shape.value), ("vs", 0.005));
    assert!(!shape.integer);
    assert!(of(&candidates, "Effects.Cogging")[0].shapes[0].integer);
}

/// Compiled with these on the bench axis, kept though neutral, and the paths of their instances.
fn kept(names: &[&str]) -> (Example, Loaded, hyde_compiler::Compiled, Vec<String>) {
    let (example, loaded, candidates) = bench();
    let mut additions = Additions::kept();
    let paths = names
        .iter()
        .map(|name| additions.put(loaded.own_file(), of(&candidates, name)[0]))
        .collect();
    let compiled = loaded.compile_with(&example, &additions, Backend::Native);
    let compiled = compiled.unwrap();
    (example, loaded, compiled, paths)
}

#[test]
fn sizes_and_shapes_of_what_is_kept_are_plain_parameters() {
    let (_, _, compiled, paths) = kept(&["Effects.Cogging", "Effects.LeadError"]);
    assert_eq!(paths, ["motor.shaft.Cogging", "screw.LeadError"]);
    for name in [
        "motor.shaft.Cogging.As",
        "motor.shaft.Cogging.N",
        "screw.LeadError.order",
    ] {
        let (parameter, _) = compiled.program.parameter(name).unwrap();
        assert!(!parameter.structural, "{name}");
    }
}

#[test]
fn the_second_of_an_effect_at_a_site_is_numbered() {
    let (_, _, compiled, paths) = kept(&["Effects.Cogging", "Effects.Cogging"]);
    assert_eq!(paths, ["motor.shaft.Cogging", "motor.shaft.Cogging2"]);
    assert!(
        compiled
            .program
            .parameter("motor.shaft.Cogging2.N")
            .is_some()
    );
}

#[test]
fn what_is_kept_at_neutral_changes_nothing_until_it_is_set() {
    let (example, loaded, kept, _) = kept(&["Effects.LeadError", "Effects.Pull"]);
    let plain = loaded.compile(&example, Backend::Native).unwrap();
    let run = |compiled: &hyde_compiler::Compiled, set: &[(&str, f64)]| {
        let options = Options {
            stop_s: Some(0.5),
            set: set
                .iter()
                .map(|(name, value)| ((*name).to_owned(), *value))
                .collect(),
            ..Options::default()
        };
        let run = hyde_experiment::run(&compiled.program, &loaded.tables, &options).unwrap();
        run.channels
            .iter()
            .map(|channel| channel.rms)
            .collect::<Vec<_>>()
    };
    // Adding 0 to a number gives the same number; but without the lead error the equations are affine, and solved by one
    // iteration of Newton's method.
    for (plain, kept) in run(&plain, &[]).iter().zip(run(&kept, &[])) {
        assert!((plain - kept).abs() <= 1e-9 * plain, "{plain}, {kept}");
    }
    assert_ne!(
        run(&plain, &[]),
        run(&kept, &[("screw.LeadError.as", 4e-6)])
    );
    assert_ne!(run(&plain, &[]), run(&kept, &[("saddle.a.Pull.F", 100.0)]));
}

#[test]
fn one_program_holds_all_candidates_that_exchange_nothing() {
    let (example, loaded, candidates) = bench();
    let mut additions = Additions::kept();
    let mut sizes = Vec::new();
    for candidate in candidates.iter().filter(|c| c.replaces.is_empty()) {
        let path = additions.put(loaded.own_file(), candidate);
        sizes.extend(
            candidate
                .sizes
                .iter()
                .map(|size| format!("{path}.{}", size.name)),
        );
    }
    let compiled = loaded.compile_with(&example, &additions, Backend::Native);
    let compiled = compiled.unwrap();
    assert!(sizes.len() >= 10, "{sizes:?}");
    for size in &sizes {
        assert!(
            compiled.program.parameter(size).unwrap().0.is_size,
            "{size}"
        );
    }
}

#[test]
fn what_was_found_is_written_down_and_compiles_to_the_same_numbers() {
    let (example, loaded, candidates) = bench();
    let of = |effect| of(&candidates, effect)[0];
    let value = |name: &str, value| (name.to_owned(), value);
    let found = [
        Found {
            candidate: of("Effects.Stribeck"),
            values: vec![value("dF", 181.25), value("vs", 0.00798)],
        },
        Found {
            candidate: of("Effects.Cogging"),
            values: vec![value("As", 0.28), value("Ac", -0.1), value("N", 12.0)],
        },
        Found {
            candidate: of("Effects.Cogging"),
            values: vec![value("As", 0.01), value("N", 24.0)],
        },
    ];
    let plain = loaded.compile(&example, Backend::Native).unwrap();
    let calibrated = [("saddle.M", 318.25), ("screw.contact.k", 1.6125e8)];
    let calibrated = calibrated.map(|(path, value)| Calibrated {
        path: path.to_owned(),
        value,
        unit: plain.program.parameter(path).unwrap().0.unit.clone(),
    });
    let mut p = vec![0.0; plain.program.n_parameters];
    plain.program.kernels.parameters(&[], &mut p);
    let about = ["Found by a test, from no record.".to_owned()];
    let written = write_back(
        &loaded.file,
        example.text(),
        ("Axis", Some("bench")),
        (&found, &calibrated),
        (&plain.program, &p),
        &about,
    );
    let behind = written
        .text
        .strip_prefix(example.text().trim_end())
        .unwrap();
    insta::assert_snapshot!("written_back", behind);
    let experiment = written.experiment.unwrap();
    assert_eq!(
        (written.model.as_str(), experiment.as_str()),
        ("Axis2", "bench2")
    );
    let again = example.replaced(&written.text, &experiment);
    let again = again.compile(Backend::Native).unwrap();
    let mut p = vec![0.0; again.program.n_parameters];
    again.program.kernels.parameters(&[], &mut p);
    let expected = [
        ("guide.Stribeck.dF", 181.25),
        ("guide.Stribeck.vs", 0.00798),
        ("motor.shaft.Cogging.N", 12.0),
        ("motor.shaft.Cogging2.As", 0.01),
        ("motor.shaft.Cogging2.N", 24.0),
        ("saddle.M", 318.25),
        ("screw.contact.k", 1.6125e8),
    ];
    for (name, value) in expected {
        let (parameter, _) = again.program.parameter(name).unwrap();
        // Seven digits are written.
        assert!((p[parameter.place] / value - 1.0).abs() < 1e-6, "{name}");
    }
}

#[test]
fn a_diagnosis_says_which_effects_may_be_tried() {
    let (_, loaded, candidates) = bench();
    let mut diagnostics = Diagnostics::new();
    let plan = DiagnosisPlan::read(&loaded.file, "bench", &mut diagnostics).unwrap();
    assert!(!diagnostics.has_errors());
    assert_eq!(
        (plan.calibration.as_str(), plan.max_effects, plan.seed),
        ("bench", 3, 1)
    );
    // `Effects.*` has the packages below it as well.
    for effect in ["Effects.Stribeck", "Effects.Signals.DeadTime"] {
        assert!(plan.selects(of(&candidates, effect)[0]), "{effect}");
    }
    let single = DiagnosisPlan {
        candidates: vec!["Effects.Stribeck".to_owned()],
        ..plan
    };
    let selected = candidates.iter().filter(|c| single.selects(c));
    assert!(selected.map(|c| c.name()).all(|name| name == "Stribeck"));
}

/// It reads what its host does not have, which only the compiler tells.
const BROKEN: &str = "effect Broken on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(w*time);
end Broken;
";

#[test]
fn an_effect_that_cannot_be_put_on_the_model_is_told() {
    let found = diagnosed(&[BROKEN, SLOW], |t| {
        ((3.0 * t).cos(), (3.0 * t).sin() / 3.0)
    });
    assert_eq!(found["verdict"], "none");
    let doubts: Vec<&str> = found["doubts"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|own| own.as_str())
        .collect();
    let told = "Broken at a was not tried because it cannot be added to the model: ";
    assert!(doubts.iter().any(|own| own.starts_with(told)), "{doubts:?}");
    assert!(!doubts.iter().any(|own| own.contains("Slow")), "{doubts:?}");
}

/// An inertia of 1.5e-3 kg.m2 forwards and 6.5e-3 backwards: steps by the derivatives of one direction do not end at the
/// acceleration of the other.
#[test]
fn an_inertia_that_is_four_times_as_large_backwards_is_found() {
    let folder = tempfile::tempdir().unwrap();
    let with = " with Effects.ShaftDirectionalInertia(dJ = -2.5e-3 [kg.m2]) on rotor.a";
    let axis = make(folder.path(), &[], "", with);
    let study = "
diagnose sides of calibrate small
  candidates Effects.ShaftDirectionalInertia, Effects.ShaftLoad;
  max_effects 2;
end sides;
";
    write(&folder.path().join("axis.hyde"), &format!("{axis}{study}"));
    let found = report(folder.path(), &["diagnose", "axis.hyde", "sides"]);
    assert_eq!(found["verdict"], "effect", "{}", found["sentence"]);
    let effect = &found["effects"][0];
    assert_eq!(effect["effect"], "ShaftDirectionalInertia");
    let size = effect["size"].as_f64().unwrap();
    assert!((size / -2.5e-3 - 1.0).abs() < 0.01, "{size}");
}
