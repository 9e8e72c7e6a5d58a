//! Effects on two small hosts: each of the library vanishes with its size, is seen at a typical one, and a neutral one leaves
//! the model as it is.

use crate::models::{Solved, close, model, solve};
use hyde_compiler::{Additions, Backend, Candidate, Compiled, Stage};
use hyde_experiment::{Answer, LIMIT_LEFT, LIMIT_PART, Options, Run, limit};
use hyde_tests::{Example, Loaded};
use std::collections::BTreeSet;

/// The tolerance of the experiments in the file.
const RTOL: f64 = 1e-9;
/// What an event leaves behind, above all an impact in the nut, has died out after this time in s.
const AWAY: f64 = 0.03;
/// The part of its range that is taken for the typical size of an effect.
const TYPICAL: f64 = 0.1;
/// The parts of that at which the limit is tried: all of the range shows a weak effect; a strong one on this small host may
/// change the order of the events, or be no longer proportional to its size.
const PARTS: [f64; 4] = [10.0, 1.0, 0.1, 0.01];
/// Effects that are not there at all below some size: a limit that is never reached.
const THRESHOLDS: [&str; 1] = ["CurrentLimit"];
/// Shapes that suit these hosts: the nut is soft, and the torques in the belts are small.
const SHAPES: [(&str, f64); 3] = [
    ("screw.contact.SoftNut.e0", 20e-6),
    ("belt.BeltSlack.T0", 0.5),
    ("belt.SlackSpan.F0", 10.0),
];

/// The rms difference over the noise from which an effect counts as seen: over the 900 rows of a run its chi squared is
/// then 56, above the 40 at which a diagnosis begins to look.
const SEEN: f64 = 0.25;

/// What the hosts' sensors read, each with the standard deviation of its noise and of what it rounds to, SI.
const SENSORS: [(&str, f64); 4] = [
    ("amplifier.measured_i", 0.02),
    ("encoder.phi", 6.3e-4 / 3.46),
    ("tacho.V6", 4e-3),
    ("scale.s", 0.42e-6),
];

/// A host of the file, with every effect of the library once, at the first of its sites.
struct Host {
    model: &'static str,
    example: Example,
    loaded: Loaded,
    candidates: Vec<Candidate>,
}

impl Host {
    fn of(model_name: &'static str, experiment: &'static str) -> Self {
        let example = model("effects", Some(experiment)).whole_library();
        let loaded = example.parse().unwrap();
        let mut candidates: Vec<Candidate> = Vec::new();
        for candidate in loaded.candidates(&example).unwrap() {
            let known = candidates.iter().any(|own| own.effect == candidate.effect);
            if !known && candidate.effect.starts_with("Effects.") {
                candidates.push(candidate);
            }
        }
        Self {
            model: model_name,
            example,
            loaded,
            candidates,
        }
    }

    /// The screw drive.
    fn new() -> Self {
        Self::of("Host", "plain")
    }

    /// Both, the second with what fits nowhere on the first.
    fn both() -> [Self; 2] {
        let (first, mut second) = (Self::new(), Self::of("Direct", "direct"));
        let known: BTreeSet<String> = first.candidates.iter().map(|c| c.effect.clone()).collect();
        let is_new = |candidate: &Candidate| !known.contains(&candidate.effect);
        second.candidates.retain(is_new);
        [first, second]
    }

    /// The run with a size of a candidate at a value; its other sizes are 0.
    fn run(&self, candidate: &Candidate, size: &str, value: f64) -> (Compiled, Run) {
        let mut additions = Additions::kept();
        let path = additions.put(self.loaded.own_file(), candidate);
        let name = format!("{path}.{size}");
        // Twice: a size that shapes the equations is set before they are made.
        let example = self.example.clone().set(&name, value);
        let compiled = self
            .loaded
            .compile_with(&example, &additions, Backend::Native);
        let compiled = compiled.unwrap_or_else(|error| panic!("{name} = {value}: {error}"));
        // What takes minutes on a machine is given the shortest time of its range.
        let slow = candidate
            .signature
            .iter()
            .filter(|(mark, _)| mark == "time");
        let slow = slow.filter_map(|(_, shape)| {
            let shape = candidate
                .shapes
                .iter()
                .find(|knob| Some(&knob.name) == shape.as_ref())?;
            Some((format!("{path}.{}", shape.name), shape.range?.0))
        });
        let own = SHAPES.iter().filter(|(shape, _)| shape.starts_with(&path));
        let own = own.map(|(shape, value)| ((*shape).to_owned(), *value));
        let options = Options {
            set: slow.chain(own).chain([(name.clone(), value)]).collect(),
            ..Options::default()
        };
        let run = hyde_experiment::run(&compiled.program, &self.loaded.tables, &options);
        let run = run.unwrap_or_else(|error| panic!("{name} = {value}: {error:?}"));
        (compiled, run)
    }
}

#[test]
fn every_effect_of_the_library_fits_somewhere_on_a_host() {
    let hosts = Host::both();
    let candidates = || hosts.iter().flat_map(|host| &host.candidates);
    let fitting: BTreeSet<&str> = candidates().map(|c| c.effect.as_str()).collect();
    let known = hosts[0].loaded.file.effects_known();
    let missing: Vec<String> = known
        .filter(|name| name.starts_with("Effects.") && !fitting.contains(name.as_str()))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
    assert!(fitting.len() > 90, "{}", fitting.len());
}

#[test]
fn what_is_said_of_an_effect_is_complete() {
    let hosts = Host::both();
    let candidates = || hosts.iter().flat_map(|host| &host.candidates);
    let names: BTreeSet<&str> = candidates().map(Candidate::name).collect();
    for candidate in candidates() {
        let name = &candidate.effect;
        assert!(!candidate.doc.is_empty(), "{name} has no text");
        assert!(!candidate.signature.is_empty(), "{name} leaves no mark");
        assert!(!candidate.confounds.is_empty(), "{name} is like no other");
        assert!(!candidate.sizes.is_empty(), "{name} has no size");
        for other in &candidate.confounds {
            assert!(
                names.contains(other.as_str()),
                "{name} is taken for {other}, which is not there"
            );
        }
        for knob in candidate.sizes.iter().chain(&candidate.shapes) {
            let range = knob.range;
            let inside =
                range.is_some_and(|(from, to)| from < to && (from..=to).contains(&knob.value));
            assert!(inside, "{name}.{} = {} in {range:?}", knob.name, knob.value);
        }
        assert!(
            candidate.sizes.iter().all(|size| size.value == 0.0),
            "{name}"
        );
    }
}

#[test]
fn every_effect_vanishes_with_its_size_and_is_seen_at_a_typical_one() {
    let mut wrong = Vec::new();
    for host in Host::both() {
        for candidate in &host.candidates {
            for size in &candidate.sizes {
                let (from, to) = size.range.unwrap();
                let typical = TYPICAL * from.abs().max(to.abs());
                let what = format!("{}.{}", candidate.effect, size.name);
                let plain = host.run(candidate, &size.name, 0.0);
                // Slow or small as this host is, all of the range may be needed.
                let is_seen =
                    |value: f64| seen(&plain, &host.run(candidate, &size.name, value)) >= SEEN;
                if !is_seen(typical) && !is_seen(typical / TYPICAL) {
                    wrong.push(format!("{what} is not seen"));
                }
                if let Err(reason) = vanishes(&host, candidate, &size.name, typical, &plain) {
                    wrong.push(format!("{what}: {reason}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The largest rms difference of a sensor between two runs, over its noise.
fn seen(plain: &(Compiled, Run), full: &(Compiled, Run)) -> f64 {
    let of = |(compiled, run): &(Compiled, Run), name: &str| {
        let column = compiled.program.output(name)?;
        let values = run.results.column(column).unwrap();
        let times = run.results.time.iter().copied();
        // Events have two rows: those of the grid are common.
        let rows = times.zip(values.iter().copied());
        let rows = rows
            .filter(|(t, _)| ((t * 1e3).round() - t * 1e3).abs() < 1e-9)
            .map(|(t, value)| ((t * 1e3).round() as i64, value));
        Some(rows.collect::<std::collections::BTreeMap<i64, f64>>())
    };
    let one = |(name, noise): (&str, f64)| {
        let (Some(a), Some(b)) = (of(plain, name), of(full, name)) else {
            return 0.0;
        };
        let squares: Vec<f64> = a
            .iter()
            .filter_map(|(t, a)| Some((a - b.get(t)?).powi(2)))
            .collect();
        assert!(squares.len() > 800, "{name}: {} rows", squares.len());
        (squares.iter().sum::<f64>() / squares.len() as f64).sqrt() / noise
    };
    SENSORS.into_iter().map(one).fold(0.0, f64::max)
}

/// Whether a thousandth of a size leaves a thousandth of its effect, at the typical size or at a part of that.
fn vanishes(
    host: &Host,
    candidate: &Candidate,
    size: &str,
    typical: f64,
    plain: &(Compiled, Run),
) -> Result<(), String> {
    let mut found = Vec::new();
    for part in PARTS {
        let (full, small) = (
            host.run(candidate, size, part * typical),
            host.run(candidate, size, LIMIT_PART * part * typical),
        );
        let runs = [plain, &small, &full].map(|(compiled, run)| (&compiled.program, &run.results));
        let answers = limit(runs[0], runs[1], runs[2], AWAY);
        let seen: Vec<&Answer> = answers.iter().filter(|a| a.is_seen(RTOL)).collect();
        // It is small but there: a test that compared nothing would pass too.
        let gone = THRESHOLDS.contains(&candidate.name());
        let good = |answer: &&Answer| {
            answer.left() <= LIMIT_LEFT && (gone || answer.left() >= 0.1 * LIMIT_PART)
        };
        if !seen.is_empty() && seen.iter().all(good) {
            return Ok(());
        }
        let worst = seen.iter().map(|answer| answer.left()).fold(0.0, f64::max);
        found.push(format!("{worst:.2e} of {} states at {part}", seen.len()));
    }
    Err(found.join(", "))
}

#[test]
fn a_neutral_effect_leaves_the_flat_model_but_for_its_parameters() {
    for host in Host::both() {
        let plain = flat(host.model, "");
        for candidate in &host.candidates {
            let (effect, site) = (&candidate.effect, &candidate.site);
            let path = format!("{site}.{}", candidate.name());
            let with = |sizes: &str| {
                let text = format!(
                    "\nmodel With = {} with {effect}{sizes} on {site};\n",
                    host.model
                );
                flat("With", &text)
            };
            let neutral = with("");
            let without = without_parameters(&neutral, &path);
            assert_ne!(neutral, without, "{effect}: its parameters are listed");
            assert_eq!(without, plain, "{effect}");
            let size = &candidate.sizes[0];
            let value = TYPICAL * size.range.unwrap().1;
            let unit = size.quantity.dimension.usual_unit();
            let present = with(&format!("({} = {value:e} [{unit}])", size.name));
            assert_ne!(without_parameters(&present, &path), plain, "{effect}");
        }
    }
}

#[test]
fn a_neutral_effect_leaves_the_run_to_the_last_bit() {
    let host = Host::new();
    let plain = solve("effects", "plain");
    let compiled = |candidates: &[&Candidate]| {
        let mut additions = Additions::new();
        for candidate in candidates {
            additions.put(host.loaded.own_file(), candidate);
        }
        let compiled = host
            .loaded
            .compile_with(&host.example, &additions, Backend::Native);
        let compiled = compiled.unwrap();
        let run = hyde_experiment::run(&compiled.program, &host.loaded.tables, &Options::default());
        Solved {
            compiled,
            run: run.unwrap(),
        }
    };
    // All at once, but for what exchanges the same component.
    let neutral = compiled(&host.candidates.iter().collect::<Vec<_>>());
    assert_eq!(plain.run.results.time, neutral.run.results.time);
    for state in ["rotor.phi", "rotor.w", "saddle.s", "saddle.v"] {
        assert_eq!(plain.column(state), neutral.column(state), "{state}");
    }
}

#[test]
fn only_neutral_sizes_are_structural() {
    let dragged = |value: f64| {
        let text = "\nmodel Dragged = Host with Viscous on saddle.a;\n";
        let example = model("effects", Some("plain")).and(text).model("Dragged");
        let (compiled, run) = example.set("saddle.a.Viscous.b", value).run().unwrap();
        Solved { compiled, run }
    };
    let structural = |solved: &Solved| {
        let program = &solved.compiled.program;
        program
            .parameter("saddle.a.Viscous.b")
            .unwrap()
            .0
            .structural
    };
    // From one size to another the same program serves: the compiled value is not in its equations.
    let compiled = dragged(500.0);
    assert!(structural(&dragged(0.0)));
    assert!(!structural(&compiled));
    let options = Options {
        set: vec![("saddle.a.Viscous.b".to_owned(), 1000.0)],
        ..Options::default()
    };
    let program = &compiled.compiled.program;
    let moved = hyde_experiment::run(program, &std::collections::BTreeMap::new(), &options);
    let moved = moved.unwrap();
    let fresh = dragged(1000.0);
    let column = program.output("saddle.s").unwrap();
    assert_eq!(
        moved.results.column(column).unwrap(),
        fresh.column("saddle.s")
    );
}

#[test]
fn a_lead_error_takes_from_the_motor_what_it_gives_the_nut() {
    // partial(advance, thn) is that of the wrapped advance.
    let text = "\nmodel With = Host with LeadError(as = 5 [um]) on screw;\n";
    let text = flat("With", text);
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

#[test]
fn a_wrap_may_delay_the_value_that_the_site_had() {
    let echo = solve("effects", "echo");
    // At 1 s the site had 2*1, and 2*0.75 a quarter of a second before: no echo of an echo.
    close(
        *echo.column("doubled.y").last().unwrap(),
        2.0 + 3.0 * 1.5,
        1e-9,
    );
}

/// The library's effects as its chapter lists them: name, type, sizes and shapes.
#[test]
fn the_book_lists_every_effect_as_it_is() {
    let path = hyde_tests::root().join("book/src/library.md");
    #[allow(clippy::disallowed_methods, reason = "the test reads the book")]
    let text = std::fs::read_to_string(path).unwrap();
    let hosts = Host::both();
    for candidate in hosts.iter().flat_map(|host| &host.candidates) {
        let names = |knobs: &[hyde_compiler::Knob]| {
            let names: Vec<&str> = knobs.iter().map(|knob| knob.name.as_str()).collect();
            match names.as_slice() {
                [] => String::new(),
                names => format!("`{}`", names.join(" ")),
            }
        };
        let on = candidate.host.rsplit('.').next().unwrap();
        let row = format!(
            "| `{}` | `{on}` | {} | {} | {} |",
            candidate.name(),
            names(&candidate.sizes),
            names(&candidate.shapes),
            candidate.doc
        );
        assert!(text.contains(&row), "the chapter wants {row}");
    }
}

/// The flat form of a model of the file, or of what is written behind it, without the line that names it.
fn flat(name: &str, text: &str) -> String {
    let example = model("effects", None).whole_library().and(text).model(name);
    let text = example.emit(Stage::Flat);
    let text = text.unwrap_or_else(|error| panic!("{name}: {error}"));
    let lines = text.lines().skip(1).map(|line| format!("{line}\n"));
    lines.collect()
}

/// The lines that are not parameters of the effect on this path.
fn without_parameters(flat: &str, path: &str) -> String {
    let lines = flat.lines().filter(|line| !line.contains(path));
    lines.map(|line| format!("{line}\n")).collect()
}
