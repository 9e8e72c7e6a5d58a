//! The limit tests of effects: what a thousandth of a size does is a thousandth of what the size does (E3).
//!
//! Tested on the model of an experiment, `model B = A with E(size = …) on site;`, at the size written there, or at the tenth
//! or hundredth of it at which the events still come in the order of the plain model.

use super::{Tested, Verdict};
use crate::asked::Asked;
use crate::runs::{How, project_of, solved};
use crate::settings::Setting;
use crate::{Loaded, Refused};
use hyde_compiler::Compiled;
use hyde_experiment::{Answer, LIMIT_LEFT, LIMIT_PART, Run, limit};
use hyde_program::Program;
use hyde_sim::EventKind;
use hyde_units::{NamedUnit, significant};

/// What the runs err by of the largest value, and the tolerance of their steps, whose errors add up: a thousandth of a small
/// effect is to stand above it.
const ERROR: f64 = 1e-9;
const RTOL: f64 = 0.1 * ERROR;
/// States are compared this part of the run away from any event.
const AWAY: f64 = 0.01;
/// The parts of the written size that are tried as the typical one.
const PARTS: [f64; 3] = [1.0, 0.1, 0.01];

/// A size of an effect on the model of an experiment.
pub struct Size {
    /// Full name of the parameter.
    pub path: String,
    /// Its value there, SI, and the unit of that.
    value: f64,
    unit: NamedUnit,
}

/// Which sizes are tested.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Neutral {
    /// Those that the model gives a value.
    LeftOut,
    /// All; those at zero with a tenth of their range.
    AtATenth,
}

/// The sizes of the effects on the model of an experiment.
pub fn sizes(program: &Program, run: &Run, neutral: Neutral) -> Vec<Size> {
    let sizes = program.parameters.iter().filter(|p| p.is_size);
    sizes
        .flat_map(|parameter| parameter.place..parameter.place + parameter.len)
        .filter_map(|place| {
            let (parameter, path) = program.parameter_at(place)?;
            let given = run.parameters[place];
            let largest = parameter
                .range
                .map_or(0.0, |(from, to)| from.abs().max(to.abs()));
            let value = match (given == 0.0, neutral) {
                (false, _) => given,
                (true, Neutral::AtATenth) => 0.1 * largest,
                (true, Neutral::LeftOut) => return None,
            };
            Some(Size {
                value,
                unit: NamedUnit::usual(parameter.dimension),
                path,
            })
        })
        .collect()
}

/// Tests one size of an experiment: runs without it, with a thousandth of it, and with it.
///
/// # Errors
/// A run cannot be done.
pub fn tested(
    loaded: &Loaded,
    asked: &Asked,
    size: &Size,
    how: &How,
) -> Result<Tested, Box<Refused>> {
    let experiment = asked.experiment.as_deref().unwrap_or_default();
    let name = format!("{experiment}: {}", size.path);
    let how = How {
        rtol: Some(RTOL),
        ..how.clone()
    };
    let at = |value: f64| {
        let mut project = project_of(loaded, asked).map_err(Box::new)?;
        let unit = (value != 0.0).then(|| size.unit.clone());
        let setting = Setting::of(size.path.clone(), value, unit);
        project.settings.push(setting);
        solved(project, &how, |_| {}).map_err(Box::new)
    };
    let skipped = |found: &str| Tested {
        name: name.clone(),
        verdict: Verdict::Skipped,
        found: found.to_owned(),
    };
    if size.value == 0.0 {
        return Ok(skipped(
            "it is 0 and has no range: write `in 0 .. …` after it",
        ));
    }
    let plain = at(0.0)?;
    // A strong effect on a small machine is no longer proportional to its size: then a smaller one is tried.
    let mut failed: Option<Tested> = None;
    for part in PARTS {
        let full = at(part * size.value)?;
        let small = at(LIMIT_PART * part * size.value)?;
        if order(&full) != order(&plain) || order(&small) != order(&plain) {
            continue;
        }
        let runs = [&plain, &small, &full].map(|(compiled, run)| (&compiled.program, &run.results));
        let answers = limit(runs[0], runs[1], runs[2], AWAY * plain.1.stop_s);
        let seen: Vec<&Answer> = answers.iter().filter(|a| a.is_seen(ERROR)).collect();
        let worst = seen
            .iter()
            .map(|answer| answer.left())
            .max_by(f64::total_cmp);
        let Some(worst) = worst else {
            return Ok(failed.unwrap_or_else(|| skipped("it changes no state")));
        };
        let test = Tested {
            name: name.clone(),
            verdict: match worst <= LIMIT_LEFT {
                true => Verdict::Passed,
                false => Verdict::Failed,
            },
            found: format!(
                "at {} of its size, {} of its effect remains (limit {})",
                percent(LIMIT_PART),
                percent(worst),
                percent(LIMIT_LEFT)
            ),
        };
        if test.verdict == Verdict::Passed {
            return Ok(test);
        }
        failed = failed.or(Some(test));
    }
    Ok(failed.unwrap_or_else(|| {
        skipped("it changes the order of the events: test it on a smaller model")
    }))
}

/// What happened in a run, in order: the transitions, and which sign relations changed to.
fn order((_, run): &(Compiled, Run)) -> Vec<(usize, usize, usize)> {
    let events = run.results.events.iter();
    events
        .map(|event| match event.kind {
            EventKind::Transition {
                automaton,
                from,
                to,
            } => (automaton, from, to),
            EventKind::When => (usize::MAX, 0, 0),
            EventKind::Relation(truth) => (usize::MAX, 1, usize::from(truth)),
            EventKind::Slide {
                automaton, after, ..
            } => (
                automaton.unwrap_or(usize::MAX),
                2,
                after.unwrap_or(usize::MAX),
            ),
        })
        .collect()
}

/// A part as percent, for people.
fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, 3))
}
