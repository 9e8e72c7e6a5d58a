//! About what a model was linearised, and what was assumed there: in words and as JSON.

use hyde_experiment::{Assumption, Linear, ModeShape, Pole, Poles, mode_shape};
use hyde_program::Program;
use hyde_report::{Block, Table};
use hyde_sim::PointTime;
use hyde_units::significant;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// Shares of the energy are told down to this.
const LEAST_SHARE: f64 = 0.05;
/// Width of a list in a line.
const WIDTH: usize = 54;

/// The line that says which pole grows, first of all; none where none does.
pub fn unstable(program: &Program, linear: &Linear, poles: &Poles) -> Option<String> {
    let all = poles.unstable();
    let first = all.first()?;
    let what = if first.oscillates() {
        let mode = first.mode();
        format!(
            "{} Hz with damping {}",
            significant(mode.frequency_hz, 4),
            significant(mode.damping, 3)
        )
    } else {
        format!("a pole at +{} 1/s", significant(first.s.re, 3))
    };
    let mut text = format!(
        "UNSTABLE: {what} doubles every {} s",
        significant(first.doubling_s(), 3)
    );
    let place = place(program, linear, (poles, first));
    if !place.is_empty() {
        let _ = write!(text, "; {place}");
    }
    match all.len() - 1 {
        0 => {}
        1 => text.push_str("; and 1 more pole grows"),
        more => {
            let _ = write!(text, "; and {more} more poles grow");
        }
    }
    text.push('\n');
    Some(text)
}

/// Where the energy of a pole is; where no energy is declared, the state that takes most part in it.
fn place(program: &Program, linear: &Linear, (poles, pole): (&Poles, &Pole)) -> String {
    let shape = mode_shape(program, linear, (poles, pole));
    let shares = shape.as_ref().map_or_else(String::new, shares);
    if !shares.is_empty() {
        return shares;
    }
    let parts = poles.participation(pole).unwrap_or_default();
    let states = parts.iter().zip(&linear.states);
    let most = states.max_by(|a, b| a.0.total_cmp(b.0));
    match (shape, most) {
        (Some(_), Some((_, state))) => format!("mostly in `{}`", program.unknown_name(*state)),
        _ => "in clocked parts alone".to_owned(),
    }
}

/// Where the energy of a shape is, the largest shares first: `97 % table.rocking`.
pub fn shares(shape: &ModeShape) -> String {
    let mut sorted: Vec<_> = shape
        .shares
        .iter()
        .filter(|share| share.2 > LEAST_SHARE)
        .collect();
    sorted.sort_by(|a, b| b.2.total_cmp(&a.2));
    let mut text = String::new();
    for (component, account, share) in sorted {
        let dot = if component.is_empty() { "" } else { "." };
        let percent = significant(100.0 * share, 2);
        let part = format!("{percent} % {component}{dot}{account}");
        let comma = if text.is_empty() { "" } else { ", " };
        if text.len() + comma.len() + part.len() > WIDTH {
            break;
        }
        text.push_str(comma);
        text.push_str(&part);
    }
    text
}

/// About what it is linearised, with the table of what is assumed there.
pub fn text(program: &Program, linear: &Linear, time: PointTime) -> String {
    let mut text = format!("linearised {}\n", place_of(linear, time));
    if linear.assumptions.is_empty() {
        return text;
    }
    text.push_str("assumed there:\n");
    for assumption in &linear.assumptions {
        let (what, taken) = told(program, linear, assumption);
        let _ = writeln!(text, "  {what:<24} {taken}");
    }
    text
}

/// The same for a page.
pub fn blocks(program: &Program, linear: &Linear, time: PointTime) -> Vec<Block> {
    let mut blocks = vec![Block::Text(format!(
        "Linearised {}.",
        place_of(linear, time)
    ))];
    if !linear.assumptions.is_empty() {
        let row = |assumption: &Assumption| {
            let (what, taken) = told(program, linear, assumption);
            vec![what, taken]
        };
        blocks.push(Block::Table(Table {
            rows: linear.assumptions.iter().map(row).collect(),
            ..Table::with_columns(&["assumed there", ""])
        }));
    }
    blocks
}

/// Where the run is that it is linearised about.
fn place_of(linear: &Linear, time: PointTime) -> String {
    let mut text = match time {
        PointTime::Start => "at the start".to_owned(),
        PointTime::At(_) => format!("at {} s of the run", significant(linear.point.t, 4)),
        PointTime::Steady => format!(
            "at the steady state, reached at {} s of the run",
            significant(linear.point.t, 3)
        ),
    };
    if let Some(delayed) = &linear.delayed {
        let shortest = delayed.times.iter().copied().fold(f64::INFINITY, f64::min);
        let _ = write!(
            text,
            "; because of its delays it has infinitely many modes: above about {} Hz some are omitted",
            significant(4.0 / shortest, 2)
        );
    }
    text
}

/// What an assumption is about, and what is assumed.
fn told(program: &Program, linear: &Linear, assumption: &Assumption) -> (String, String) {
    match assumption {
        Assumption::Mode(mode) => {
            let automaton = &program.automata[mode.automaton];
            let (run, taken) = (&automaton.modes[mode.of_run], &automaton.modes[mode.taken]);
            let told = match mode.asked {
                true => format!("{taken}, as requested; in the run {run}"),
                false => format!(
                    "{taken}, in the run {run} (`--in {}={run}`)",
                    automaton.name
                ),
            };
            (automaton.name.clone(), told)
        }
        Assumption::Switch { condition, taken } => (
            format!("`{condition}`"),
            format!("at its switching point, taken as {taken}"),
        ),
        Assumption::Event {
            condition,
            automaton,
        } => {
            let what = match automaton {
                Some(automaton) => {
                    let automaton = &program.automata[*automaton];
                    let mode = linear.point.z[automaton.place] as usize;
                    format!("{}, at its exit", automaton.modes[mode])
                }
                None => "at its switching point, taken as not yet true".to_owned(),
            };
            let name = automaton.map(|automaton| program.automata[automaton].name.clone());
            match name {
                Some(name) => (name, format!("{what} `{condition}`")),
                None => (format!("`{condition}`"), what),
            }
        }
        Assumption::Slide(condition) => (
            format!("`{condition}`"),
            "the run slides along it; one side is taken".to_owned(),
        ),
        Assumption::Kink(name) => (
            name.clone(),
            "an expression without events is at its kink; one side is taken".to_owned(),
        ),
    }
}

/// What is assumed, as JSON.
pub fn listed(program: &Program, linear: &Linear) -> Value {
    let one = |assumption: &Assumption| {
        let (about, assumed) = told(program, linear, assumption);
        let kind = match assumption {
            Assumption::Mode(_) => "mode",
            Assumption::Switch { .. } => "switch",
            Assumption::Event { .. } => "event",
            Assumption::Slide(_) => "slide",
            Assumption::Kink(_) => "kink",
        };
        json!({ "kind": kind, "about": about, "assumed": assumed })
    };
    linear.assumptions.iter().map(one).collect()
}

/// The same as JSON, with what the poles say of stability.
pub fn json(
    program: &Program,
    linear: &Linear,
    time: PointTime,
    poles: &Poles,
) -> Map<String, Value> {
    let at = match time {
        PointTime::Start => "start",
        PointTime::At(_) => "time",
        PointTime::Steady => "steady",
    };
    let modes: Map<String, Value> = program
        .automata
        .iter()
        .map(|automaton| {
            let mode = linear.point.z[automaton.place] as usize;
            (automaton.name.clone(), json!(automaton.modes[mode]))
        })
        .collect();
    let pole = |pole: &Pole| {
        let mode = pole.mode();
        json!({
            "s": [pole.s.re, pole.s.im], "frequency_hz": mode.frequency_hz, "damping": mode.damping,
            "doubling_s": pole.doubling_s(),
        })
    };
    let clocks = program.clocks.iter().map(|clock| clock.name.as_str());
    let clocks: Vec<&str> = clocks.collect();
    let closed = poles.period_s;
    let closed = closed.map(|period| json!({ "period_s": period, "clocks": clocks }));
    let unstable: Vec<Value> = poles.unstable().iter().map(pole).collect();
    let real: Vec<f64> = poles.real().iter().map(|pole| pole.s.re).collect();
    let found = [
        ("point", json!({ "at": at, "t_s": linear.point.t })),
        ("modes_taken", Value::Object(modes)),
        ("assumptions", listed(program, linear)),
        ("stable", unstable.is_empty().into()),
        ("unstable", unstable.into()),
        ("real_poles", real.into()),
        ("closed_loop", closed.into()),
    ];
    let pairs = found.into_iter();
    pairs.map(|(key, value)| (key.to_owned(), value)).collect()
}
