//! The curves that a page shows of a run where none were asked for: what the run is about, by what it means.
//!
//! First what measures and expectations read and what the model declares beside its components, then states, by quantity:
//! positions before speeds, currents and forces; of the forces between components those of the largest rms. What is only a
//! number inside a controller comes where nothing else is left.

use crate::figures;
use hyde_experiment::{Run, flows};
use hyde_program::{Output, Program};
use hyde_report::{Panel, time_panel};
use hyde_signal::Series;
use hyde_units::{Dimension, drawn_in, shown};
use std::collections::BTreeSet;

/// Panels in a figure, and curves in a panel.
const PANELS: usize = 6;
const CURVES: usize = 4;
/// What moves less than this part of what moves most in its panel is a line along its axis.
const SEEN: f64 = 1e-3;

/// What the values of an SI unit are called on an axis, in the order of their panels.
const QUANTITIES: [(&str, &str); 16] = [
    ("m", "position"),
    ("rad", "angle"),
    ("m/s", "speed"),
    ("rad/s", "angular speed"),
    ("A", "current"),
    ("N", "force"),
    ("N.m", "torque"),
    ("V", "voltage"),
    ("K", "temperature"),
    ("Pa", "pressure"),
    ("W", "power"),
    ("J", "energy"),
    ("m/s2", "acceleration"),
    ("rad/s2", "angular acceleration"),
    ("Hz", "frequency"),
    ("s", "time"),
];

/// What the values of a dimension are called; nothing where there is no one word for it.
pub fn quantity(dimension: Dimension) -> &'static str {
    let unit = dimension.usual_unit();
    let known = QUANTITIES.iter().find(|(own, _)| *own == unit);
    known.map_or("", |(_, word)| word)
}

/// Why a variable is drawn, the stronger reason later.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Reason {
    /// A state of a component.
    State,
    /// A force between components.
    Flow,
    /// Declared in the model itself, beside its components.
    OfTheModel,
    /// Read by a measure or an expectation.
    Read,
}

/// A curve to draw.
struct Curve {
    output: usize,
    reason: Reason,
    /// How much it moves, in SI.
    range: f64,
}

/// The panels of a run.
pub fn of_run(program: &Program, run: &Run) -> Vec<Panel> {
    let mut groups: Vec<(String, Vec<Curve>)> = Vec::new();
    for curve in curves(program, run) {
        let (unit, _) = drawn_in(&program.outputs[curve.output].unit);
        match groups.iter_mut().find(|(known, _)| *known == unit) {
            Some((_, list)) => list.push(curve),
            None => groups.push((unit, vec![curve])),
        }
    }
    for (_, list) in &mut groups {
        choose(list, run);
    }
    groups.retain(|(_, list)| !list.is_empty());
    let strongest = |list: &[Curve]| list.iter().map(|curve| curve.reason).max();
    groups.sort_by_key(|(_, list)| place(program, &list[0]));
    // Too many: those go that there is the weakest reason for, the last of them first.
    while groups.len() > PANELS {
        let weakest = groups.iter().map(|(_, list)| strongest(list)).min();
        match groups
            .iter()
            .rposition(|(_, list)| Some(strongest(list)) == weakest)
        {
            Some(at) => drop(groups.remove(at)),
            None => break,
        }
    }
    let panel = |(unit, list): &(String, Vec<Curve>)| {
        let line = |own: &Curve| {
            let name = &program.outputs[own.output].name;
            figures::curve(name, own.output, program, run)
        };
        let lines = list.iter().map(line).collect();
        let dimension = program.outputs[list[0].output].dimension;
        time_panel(quantity(dimension), shown(unit), lines)
    };
    groups.iter().map(panel).collect()
}

/// Every variable that there is a reason to draw.
fn curves(program: &Program, run: &Run) -> Vec<Curve> {
    let flows: BTreeSet<usize> = flows(program, &run.results)
        .iter()
        .map(|flow| flow.output)
        .collect();
    let states = program.unknowns.iter();
    let states = states.filter(|block| block.differential && block.first.is_none());
    let states: BTreeSet<&str> = states.map(|block| block.name.as_str()).collect();
    let is_read = |name: &str| {
        let mut reductions = program.experiment.reductions.iter();
        reductions.any(|reduction| reads(&reduction.text, name))
    };
    let reason = |number: usize, output: &Output| {
        if output.auxiliary {
            None
        } else if is_read(&output.name) {
            Some(Reason::Read)
        } else if !output.name.contains('.') && !output.name.contains('[') {
            Some(Reason::OfTheModel)
        } else if flows.contains(&number) {
            Some(Reason::Flow)
        } else {
            let is_state = states.contains(output.name.as_str());
            is_state.then_some(Reason::State)
        }
    };
    let outputs = program.outputs.iter().enumerate();
    outputs
        .filter_map(|(output, known)| {
            Some(Curve {
                reason: reason(output, known)?,
                range: range(run.results.series(output)?),
                output,
            })
        })
        .collect()
}

/// Whether an expression as it is written reads a variable.
fn reads(text: &str, name: &str) -> bool {
    let in_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
    text.match_indices(name).any(|(at, _)| {
        let (before, after) = (&text[..at], &text[at + name.len()..]);
        !before.ends_with(in_word) && !after.starts_with(|c| in_word(c) || c == '[')
    })
}

/// Of the curves in one panel those with the strongest reasons, and of these those that move most; none that stands still
/// beside one that moves, and none twice.
fn choose(list: &mut Vec<Curve>, run: &Run) {
    list.sort_by(|a, b| b.reason.cmp(&a.reason).then(b.range.total_cmp(&a.range)));
    let most = list.iter().map(|curve| curve.range).fold(0.0, f64::max);
    list.retain(|curve| curve.reason == Reason::Read || curve.range >= SEEN * most);
    let mut kept: Vec<Curve> = Vec::new();
    for curve in list.drain(..) {
        let series = |curve: &Curve| run.results.series(curve.output);
        if kept.len() < CURVES && !kept.iter().any(|own| series(own) == series(&curve)) {
            kept.push(curve);
        }
    }
    // In the order of the model.
    kept.sort_by_key(|curve| curve.output);
    *list = kept;
}

/// The place of a panel: by its quantity; what has no word comes last, what is read before the rest of its kind.
fn place(program: &Program, curve: &Curve) -> usize {
    let unit = program.outputs[curve.output].dimension.usual_unit();
    let known = QUANTITIES.iter().position(|(own, _)| *own == unit);
    let unread = usize::from(curve.reason < Reason::OfTheModel);
    known.unwrap_or(QUANTITIES.len() + unread)
}

/// From the least to the largest value.
fn range(series: &Series) -> f64 {
    let finite = || series.iter().filter(|value| value.is_finite());
    finite().fold(f64::MIN, f64::max) - finite().fold(f64::MAX, f64::min)
}
