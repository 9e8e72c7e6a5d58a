//! The limit tests of effects: what a thousandth of a size does is a thousandth of what the size does (E3).
//!
//! Tested on the model of an experiment, `model B = A with E(size = …) on site;`, at the size written there, or at the tenth
//! or hundredth of it at which the events still come in the order of the plain model.

use crate::args::ModelArgs;
use crate::commands::run::solved;
use crate::commands::test::{Tested, Verdict, percent, run_args};
use crate::exit::Exit;
use crate::project::Project;
use hyde_compiler::Compiled;
use hyde_experiment::{Answer, LIMIT_LEFT, LIMIT_PART, Run, limit};
use hyde_program::Program;
use hyde_sim::EventKind;
use hyde_syntax::ast::{Class, ClassBody, ClassKind, Element, Item, Prefix, Reference};

/// Relative tolerance of the runs: a thousandth of a small effect is to stand above it.
const RTOL: f64 = 1e-9;
/// States are compared this part of the run away from any event.
const AWAY: f64 = 0.01;
/// The parts of the written size that are tried as the typical one.
const PARTS: [f64; 3] = [1.0, 0.1, 0.01];

/// A size of an effect on the model of an experiment.
pub(crate) struct Size {
    /// Full name of the parameter.
    path: String,
    /// Its value there, SI, and the unit of that.
    value: f64,
    unit: String,
}

/// The sizes, other than zero, of the effects that a model was given by name.
pub(crate) fn sizes(project: &Project, program: &Program, run: &Run) -> Vec<Size> {
    let mut found = Vec::new();
    let mut model = class(project, &project.model);
    for _ in 0..project.file.files.len() + 40 {
        let Some(ClassBody::Short { base, effects, .. }) = model.map(|class| &class.body) else {
            break;
        };
        for used in effects {
            let effect = last_word(&used.effect);
            for site in &used.sites {
                let site = hyde_syntax::format_reference(site);
                for size in declared_sizes(project, effect) {
                    let path = format!("{site}.{effect}.{size}");
                    if let Some((parameter, _)) = program.parameter(&path)
                        && run.parameters[parameter.place] != 0.0
                    {
                        found.push(Size {
                            value: run.parameters[parameter.place],
                            unit: parameter.dimension.usual_unit(),
                            path,
                        });
                    }
                }
            }
        }
        model = class(project, last_word(base));
    }
    found
}

/// Tests one size: runs without it, with a thousandth of it, and with it.
pub(crate) fn tested(args: &ModelArgs, size: &Size) -> Result<Tested, Exit> {
    let name = format!(
        "{}: {}",
        args.experiment.as_deref().unwrap_or_default(),
        size.path
    );
    let at = |value: f64| {
        let mut args = args.clone();
        let unit = if value == 0.0 { "" } else { &size.unit };
        args.settings
            .push(format!("{}={value:e} [{unit}]", size.path).replace(" []", ""));
        let (_, compiled, run, _) = solved(&run_args(&args, Some(RTOL)))?;
        Ok::<_, Exit>((compiled, run))
    };
    let plain = at(0.0)?;
    for part in PARTS {
        let full = at(part * size.value)?;
        let small = at(LIMIT_PART * part * size.value)?;
        if order(&full) != order(&plain) || order(&small) != order(&plain) {
            continue;
        }
        let runs = [&plain, &small, &full].map(|(compiled, run)| (&compiled.program, &run.results));
        let answers = limit(runs[0], runs[1], runs[2], AWAY * plain.1.stop_s);
        let seen: Vec<&Answer> = answers.iter().filter(|a| a.is_seen(RTOL)).collect();
        let worst = seen
            .iter()
            .map(|answer| answer.left())
            .max_by(f64::total_cmp);
        let Some(worst) = worst else {
            return Ok(Tested {
                name,
                verdict: Verdict::Skipped,
                found: "not seen in any state".to_owned(),
            });
        };
        return Ok(Tested {
            name,
            verdict: if worst <= LIMIT_LEFT {
                Verdict::Passed
            } else {
                Verdict::Failed
            },
            found: format!(
                "{} of it leaves {} of its effect, at most {} may",
                percent(LIMIT_PART),
                percent(worst),
                percent(LIMIT_LEFT)
            ),
        });
    }
    Ok(Tested {
        name,
        verdict: Verdict::Skipped,
        found: "it changes the order of the events: test it on a smaller model".to_owned(),
    })
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

fn class<'p>(project: &'p Project, name: &str) -> Option<&'p Class> {
    let items = project.file.files.iter().flat_map(|(_, file)| &file.items);
    items
        .filter_map(of_class)
        .find(|class| class.name.text == name)
}

fn of_class(item: &Item) -> Option<&Class> {
    match item {
        Item::Class(class) => Some(class),
        Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
    }
}

/// The names that an effect, or one it extends, declares as `size`.
fn declared_sizes(project: &Project, effect: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut waiting = vec![effect.to_owned()];
    let mut turns = 0;
    while let (Some(name), true) = (waiting.pop(), turns < 40) {
        turns += 1;
        let known = class(project, &name).filter(|class| class.kind == ClassKind::Effect);
        let Some(ClassBody::Long { elements, .. }) = known.map(|class| &class.body) else {
            continue;
        };
        for element in elements {
            if let Element::Extends(base, _) = element {
                waiting.push(last_word(base).to_owned());
            }
            if let Element::Declaration(declaration) = element
                && declaration.prefixes.contains(&Prefix::Size)
            {
                let names = declaration.declarators.iter();
                found.extend(names.map(|declarator| declarator.name.text.clone()));
            }
        }
    }
    found
}

fn last_word(name: &Reference) -> &str {
    name.parts.last().map_or("", |part| part.name.text.as_str())
}
