//! Candidates: every effect at every site of a model where it fits, and models with some of them put on.

use hyde_compiler::{Additions, Backend, Candidate};
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
    // Adding 0 to a number gives the same number, bit for bit.
    assert_eq!(run(&plain, &[]), run(&kept, &[]));
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
