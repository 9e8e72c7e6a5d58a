//! Observers on the bench axis: their fixed steps against the exact run, and what calibration finds in records that the
//! exact run has made.

use crate::points::{Random, parameters};
use hyde_calibrate::{Innovations, Joint, Observer, Problem, Recording, Varied, fit};
use hyde_compiler::{Backend, Compiled};
use hyde_experiment::Options;
use hyde_signal::{Column, Table};
use hyde_tests::{Example, Loaded, bench_axis};
use std::collections::BTreeMap;

/// The bench axis as an observer runs it.
fn bench() -> (Example, Loaded, Compiled) {
    observed(bench_axis::declared().unwrap())
}

/// With few cells: above half the sampling rate a record says nothing.
fn observed(example: Example) -> (Example, Loaded, Compiled) {
    let example = example.observed().set("screw.n", 6.0);
    let loaded = example.parse().unwrap();
    let compiled = loaded.compile(&example, Backend::Native).unwrap();
    (example, loaded, compiled)
}

/// The record with its measured columns replaced by those of an exact run with the recorded current, and `noise` times
/// what the experiment declares added to them.
fn made(
    example: &Example,
    loaded: &Loaded,
    set: &[(&str, f64)],
    noise: f64,
) -> BTreeMap<String, Table> {
    let options = Options {
        rtol: Some(1e-7),
        set: set
            .iter()
            .map(|(name, value)| ((*name).to_owned(), *value))
            .collect(),
        ..Options::default()
    };
    let (_, run) = example.run_with(&options).unwrap();
    let record = &loaded.tables["file"];
    let deviations = [
        0.02,
        1e-4 * std::f64::consts::TAU / 12.0_f64.sqrt(),
        4e-3 / 0.05,
        4.2e-7,
    ];
    let mut random = Random(1);
    let columns = record.columns().iter().map(|column| {
        let Some(channel) = run
            .channels
            .iter()
            .position(|channel| channel.name == column.name())
        else {
            return column.clone();
        };
        // The tacho channel is measured in volts.
        let sd = noise
            * if channel == 2 {
                4e-3
            } else {
                deviations[channel]
            };
        let values = run.channels[channel]
            .simulated
            .iter()
            .map(|value| value + sd * random.normal());
        let values: Vec<f64> = values.collect();
        assert_eq!(
            values.len(),
            column.values().len(),
            "every row is in the run"
        );
        match column.unit() {
            Some(unit) => Column::new(column.name(), unit.clone(), values),
            None => Column::raw(column.name(), values),
        }
    });
    let table = Table::every(1e-3, columns.collect()).unwrap();
    BTreeMap::from([("file".to_owned(), table)])
}

fn mean_square(list: &[f64]) -> f64 {
    list.iter().map(|r| r * r).sum::<f64>() / list.len() as f64
}

/// Innovations of fixed steps in a record of an exact run, the observer that of the axis without an effect: of the noise, a
/// thousandth of a chi2 unit in a thousand samples.
fn follow_the_exact_run((example, loaded, compiled): &(Example, Loaded, Compiled)) {
    let (_, _, declared) = bench();
    let of = |program| Recording::new("strokes", program, loaded.tables.clone(), &[]).unwrap();
    let real = of(&declared.program);
    let observer = Observer::new(&declared.program, std::slice::from_ref(&real), &[]).unwrap();
    let program = &compiled.program;
    let exact = Recording::new("exact", program, made(example, loaded, &[], 0.0), &[]).unwrap();
    let innovations = Innovations::of(program, &exact, &observer, &[]).unwrap();
    for (channel, list) in innovations.channels.iter().enumerate() {
        let rms = mean_square(list).sqrt();
        assert!(rms < 3e-2, "channel {channel}: {rms}");
    }
}

/// The bench axis with an effect.
fn with(effect: &str) -> (Example, Loaded, Compiled) {
    observed(bench_axis::with(&format!("Effects.{effect}")).unwrap())
}

/// Friction acts some 100 times in the record.
#[test]
fn fixed_steps_follow_the_exact_run_through_stick_and_slip() {
    follow_the_exact_run(&bench());
}

/// Where the axis begins to slide, this drag is steeper than at the speed v1 by a factor of 27 000.
#[test]
fn fixed_steps_follow_the_exact_run_with_a_drag_that_is_steepest_at_rest() {
    follow_the_exact_run(&with("PowerDrag(k = 100 [N], p = 0.34) on guide"));
}

/// At speed, the axis goes as far in a step as the first spring bends.
#[test]
fn fixed_steps_follow_the_exact_run_with_springs_that_slip_one_after_the_other() {
    follow_the_exact_run(&with("SlipSprings(part = 0.6, z0 = 15 [um]) on guide"));
}

/// At 40 turns a second it turns nearly once in the longest step.
#[test]
fn fixed_steps_follow_the_exact_run_with_a_torque_that_turns_within_a_step() {
    follow_the_exact_run(&with("Cogging(As = 0.3 [N.m], N = 48) on motor.shaft"));
}

/// How far derivatives of innovations along a run are from differences of runs, each as a part of its size: the small axis
/// with what is written, by its uncertain parameters and others. The least over some steps, in deviations of the priors.
fn off_from_differences(with: &str, others: &[String], steps: &[f64]) -> BTreeMap<String, f64> {
    let example = Example::load("tests/models/small_axis/axis.hyde", Some("moves")).unwrap();
    let example = example
        .rewritten(") of Axis", ") of Other")
        .rewritten(
            "experiment moves",
            &format!("model Other = Axis{with};\n\nexperiment moves"),
        )
        .observed();
    let loaded = example.parse().unwrap();
    let compiled = loaded.compile(&example, Backend::Native).unwrap();
    let program = &compiled.program;
    let recordings = [Recording::new("strokes", program, loaded.tables.clone(), &[]).unwrap()];
    let p = parameters(program, &[]);
    let mut varied = Varied::uncertain(program, &p);
    for name in others {
        let own = Varied::of(program, name, &p).into_iter();
        varied.extend(own.map(|own| Varied {
            prior: Some(0.1 * own.nominal),
            ..own
        }));
    }
    // That of the axis as it is declared: it knows no bristles.
    let declared = Example::load("tests/models/small_axis/axis.hyde", Some("moves")).unwrap();
    let declared = declared.observed();
    let plain = declared
        .parse()
        .unwrap()
        .compile(&declared, Backend::Native)
        .unwrap();
    let record = Recording::new("strokes", &plain.program, loaded.tables.clone(), &[]).unwrap();
    let observer = Observer::new(&plain.program, &[record], &[]).unwrap();
    let problem = Problem {
        program,
        recordings: &recordings,
        observer: &observer,
        varied: &varied,
        set: &[],
        fold: None,
        reached: None,
    };
    let values: Vec<f64> = varied.iter().map(|varied| varied.nominal).collect();
    let derivatives = problem.derivatives(&values).unwrap();
    let off = |(number, varied): (usize, &Varied)| {
        let at = |part: f64| -> Vec<f64> {
            let mut values = values.clone();
            values[number] += part * varied.scale();
            let found = problem.innovations(&values).unwrap();
            found
                .into_iter()
                .flat_map(|own| own.channels)
                .flatten()
                .collect()
        };
        let off = |step: f64| {
            let (more, less) = (at(step), at(-step));
            let pairs = more.iter().zip(&less);
            let differences: Vec<f64> = pairs.map(|(a, b)| (a - b) / (2.0 * step)).collect();
            let pairs = derivatives[number].iter().zip(&differences);
            let off: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
            (mean_square(&off) / mean_square(&differences)).sqrt()
        };
        let least = steps.iter().copied().map(off).fold(f64::MAX, f64::min);
        (varied.name.clone(), least)
    };
    varied.iter().enumerate().map(off).collect()
}

/// Where the small axis comes to rest it sticks and slides back dozens of times: what has stuck in between forgets how fast it
/// was, and forces jump. Both were missed once, and the derivative by the stiffness of the contact was three times its size
/// off. What is left is of a belt that swings faster than rows come.
#[test]
fn innovations_change_along_a_run_as_differences_of_runs_do() {
    for (name, part) in off_from_differences("", &[], &[1e-3]) {
        let most = if name.starts_with("belt") { 0.3 } else { 0.1 };
        assert!(part < most, "{name}: off by {part}");
    }
}

/// Bristles follow in a row or in a thousand, by how fast they slide, a drag is steepest at rest, a nut softest where it is
/// loaded least. With one linear part for all of it, the derivative by a bristle's way was once five times its size off.
#[test]
fn innovations_change_as_differences_of_runs_do_where_equations_bend() {
    for (effect, own) in [
        (
            "CableDrag(F = 40 [N], z0 = 20 [mm]) on saddle.a",
            ["F", "z0"].as_slice(),
        ),
        (
            "PreSliding(part = 0.5, z0 = 10 [um]) on guide",
            &["part", "z0", "Tb"],
        ),
        (
            "SlipSprings(part = 0.6, z0 = 15 [um]) on guide",
            &["part", "z0"],
        ),
        (
            "Stribeck(dF = 40 [N], vs = 5 [mm/s]) on guide",
            &["dF", "vs"],
        ),
        ("PowerDrag(k = 40 [N], p = 0.34) on guide", &["k", "p"]),
        ("QuadraticDrag(k = 100 [N]) on saddle.a", &["k"]),
        (
            "SoftNut(part = 0.5, e0 = 5 [um]) on screw.contact",
            &["part", "e0"],
        ),
        ("NutBacklash(gap = 8 [um]) on screw", &["gap"]),
        ("ScrewCompliance(part = 0.1) on screw", &["part"]),
        (
            "Signals.TorqueRipple(As = 0.05, N = 6, emf_part = 0.4) on motor",
            &["As", "emf_part"],
        ),
    ] {
        let (kind, rest) = effect.split_once('(').unwrap();
        let kind = kind.trim_start_matches("Signals.");
        let (_, site) = rest.split_once(" on ").unwrap();
        let own: Vec<String> = own
            .iter()
            .map(|own| format!("{site}.{kind}.{own}"))
            .collect();
        // Over one step or the other an event happens that does not over the others.
        let steps = [1e-3, 1e-4, 1e-5];
        let off = off_from_differences(&format!(" with Effects.{effect}"), &own, &steps);
        for name in own
            .iter()
            .map(String::as_str)
            .chain(["guide.F", "guide.b", "bearing.T"])
        {
            assert!(off[name] < 0.1, "{effect}: {name} is off by {}", off[name]);
        }
    }
}

#[test]
fn calibration_finds_the_parameters_that_a_record_was_made_with() {
    let (example, loaded, compiled) = bench();
    let program = &compiled.program;
    let truth = [
        ("saddle.M", 325.0),
        ("guide.F", 250.0),
        ("motor.Jm", 8.4e-3),
    ];
    let recording =
        Recording::new("made", program, made(&example, &loaded, &truth, 1.0), &[]).unwrap();
    let recordings = [recording];
    let observer = Observer::new(program, &recordings, &[]).unwrap();
    let p = parameters(program, &[]);
    let mut varied = Varied::uncertain(program, &p);
    assert_eq!(varied.len(), 12);
    varied.retain(|varied| truth.iter().any(|(name, _)| varied.name == *name));
    let problem = Problem {
        program,
        recordings: &recordings,
        observer: &observer,
        varied: &varied,
        set: &[],
        fold: None,
        reached: None,
    };
    let found = fit(&Joint::of(&problem), 1).unwrap();
    assert!(found.converged);
    for parameter in &found.parameters {
        let (_, value) = truth
            .iter()
            .find(|(name, _)| *name == parameter.name)
            .unwrap();
        // Three standard deviations of the three together.
        let off = (parameter.value - value).abs() / parameter.deviation;
        assert!(
            off < 3.5,
            "{}: {} for {value}, {off} deviations",
            parameter.name,
            parameter.value
        );
        assert!(
            !parameter.left_range && !parameter.at_bound && !parameter.untold,
            "{}",
            parameter.name
        );
    }
    // Four channels of 10 000 rows: 1 within four times sqrt(2/40000), and what a gain of roundness costs.
    let (after, _) = found.parts[0];
    assert!((0.97..1.03).contains(&after), "{after}");
    let before = Innovations::of(program, &recordings[0], &observer, &[]).unwrap();
    assert!(before.chi() > 1.1);
    // The same from any number of threads, to the last bit.
    let problem = Problem {
        varied: &varied[..2],
        ..problem
    };
    let start = [310.0, 260.0];
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        pool.install(|| problem.solve(&start)).unwrap()
    };
    let (one, three) = (of(1), of(3));
    assert_eq!(one.cost().to_bits(), three.cost().to_bits());
    assert_eq!(one.values, three.values);
}
