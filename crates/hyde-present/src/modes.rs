//! Natural frequencies and damping ratios: of one experiment, of several side by side, over a parameter, and parameters from
//! measured ones.

pub mod inverse;
pub mod over;
pub mod page;

use crate::{assumed, assumptions};
use hyde_experiment::{Linear, ModeShape, NaturalMode, Poles};
use hyde_program::Program;
use hyde_report::Block;
use hyde_study::modes::Modes;
use hyde_units::significant;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// The modes of experiments as a table: of one with the shares of the energy and, if so, its real poles.
#[must_use]
pub fn text(all: &[Modes], real: bool) -> String {
    match all {
        [one] => with_energy(one, real),
        several => side_by_side(several),
    }
}

/// The modes of the first experiment as JSON, those of the others in a list.
#[must_use]
pub fn json(all: &[Modes]) -> Value {
    let mut value = json!({ "ok": true });
    let mut all = all.iter();
    for (key, part) in all.next().map(of_experiment).unwrap_or_default() {
        value[key] = part;
    }
    let listed = |found: &Modes| {
        let mut listed = of_experiment(found);
        listed.insert("experiment".to_owned(), json!(found.name));
        Value::Object(listed)
    };
    let others: Vec<Value> = all.map(listed).collect();
    if !others.is_empty() {
        value["with"] = others.into();
    }
    value
}

fn of_experiment(found: &Modes) -> Map<String, Value> {
    let program = &found.prepared.compiled.program;
    let modes = found.modes.iter().zip(&found.shapes);
    let modes = modes.map(|(mode, shape)| of_mode(program, &found.linear, mode, shape.as_ref()));
    let time = found.prepared.time;
    let mut json = assumed::json(program, &found.linear, time, &found.poles);
    json.insert("notes".to_owned(), found.notes.clone().into());
    json.insert("modes".to_owned(), modes.collect());
    json
}

/// The line that says what grows.
fn unstable(found: &Modes) -> Option<String> {
    let program = &found.prepared.compiled.program;
    assumed::unstable(program, &found.linear, &found.poles)
}

/// About what it is linearised, with what is assumed.
fn about(found: &Modes) -> String {
    let program = &found.prepared.compiled.program;
    loop_told(program, &found.linear, &found.poles)
        + &assumed::text(program, &found.linear, found.prepared.time)
        + &assumptions::text(&found.notes)
}

/// The same for a page.
fn blocks(found: &Modes) -> Vec<Block> {
    let program = &found.prepared.compiled.program;
    let told = loop_told(program, &found.linear, &found.poles);
    let notes = found.notes.iter().cloned().map(Block::Text);
    let about = assumed::blocks(program, &found.linear, found.prepared.time);
    let about = about.into_iter();
    [Block::Text(told)]
        .into_iter()
        .chain(about)
        .chain(notes)
        .collect()
}

/// Which loop the modes are those of.
fn loop_told(program: &Program, linear: &Linear, poles: &Poles) -> String {
    let clocks: Vec<&str> = program
        .clocks
        .iter()
        .map(|clock| clock.name.as_str())
        .collect();
    let clocks = clocks.join("`, `");
    match poles.period_s {
        Some(period) => format!(
            "closed loop of the clocks `{clocks}`, exact over their common period of {} ms:\n  \
             frequencies {} Hz apart cannot be distinguished; the list has the one\n  \
             nearest to a mode of the plant; for the plant alone use `--open`\n",
            significant(1e3 * period, 4),
            significant(1.0 / period, 4)
        ),
        None if !linear.b_held.is_empty() => {
            format!("plant alone: the outputs of the clocks `{clocks}` stay constant\n")
        }
        None => String::new(),
    }
}

/// Below this a damping ratio is what rounding leaves of a model without damping.
const UNDAMPED: f64 = 1e-9;

/// A damping ratio as it is shown.
fn damping(ratio: f64) -> String {
    match ratio.abs() < UNDAMPED {
        true => "0".to_owned(),
        false => significant(ratio, 3),
    }
}

fn with_energy(found: &Modes, real: bool) -> String {
    let mut text = unstable(found).unwrap_or_default();
    let _ = writeln!(text, "{:>12} {:>10}   energy", "f [Hz]", "damping");
    for (mode, shape) in found.modes.iter().zip(&found.shapes) {
        let energy = shape.as_ref().map(assumed::shares);
        let line = format!(
            "{:>12} {:>10}   {}",
            significant(mode.frequency_hz, 5),
            damping(mode.damping),
            energy.unwrap_or_else(|| "only in clocked parts".to_owned())
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    if found.modes.is_empty() {
        text.push_str("no pole oscillates\n");
    }
    if real {
        let _ = writeln!(text, "{:>12} {:>10}", "1/s", "T [s]");
        for pole in &found.real {
            let rate = significant(pole.s.re, 5);
            let _ = writeln!(text, "{rate:>12} {:>10}", significant(-1.0 / pole.s.re, 3));
        }
    }
    text.push_str(&about(found));
    text
}

/// The frequencies of several experiments in Hz, in order, and by how much each differs from that of the first.
fn side_by_side(all: &[Modes]) -> String {
    let mut text = String::new();
    for found in all {
        if let Some(unstable) = unstable(found) {
            let _ = write!(text, "{}: {unstable}", found.name);
        }
    }
    let (first, others) = (&all[0], &all[1..]);
    let _ = write!(text, "{:>12}", format!("{} [Hz]", first.name));
    for other in others {
        let _ = write!(text, " {:>24}", format!("{} [Hz]", other.name));
    }
    text.push('\n');
    let most = all.iter().map(|found| found.modes.len()).max().unwrap_or(0);
    for k in 0..most {
        let own = first.modes.get(k).map(|mode| mode.frequency_hz);
        let shown = own.map_or_else(String::new, |f| significant(f, 5));
        let mut line = format!("{shown:>12}");
        for other in others {
            let found = other.modes.get(k).map(|mode| mode.frequency_hz);
            let shown = found.map_or_else(String::new, |f| significant(f, 5));
            let differs = own.zip(found).map_or_else(String::new, |(own, found)| {
                format!("{:+.3} %", 100.0 * (found / own - 1.0))
            });
            let _ = write!(line, " {shown:>12} {differs:>11}");
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    for found in all {
        let _ = write!(text, "{}: {}", found.name, about(found));
    }
    text
}

fn of_mode(
    program: &Program,
    linear: &Linear,
    mode: &NaturalMode,
    shape: Option<&ModeShape>,
) -> Value {
    let mut found = json!({ "frequency_hz": mode.frequency_hz, "damping": mode.damping });
    if let Some(shape) = shape {
        let states: Map<String, Value> = linear
            .states
            .iter()
            .zip(&shape.states)
            .map(|(&state, x)| (program.unknown_name(state), json!([x.re, x.im])))
            .collect();
        found["shape"] = Value::Object(states);
        found["energy"] = shape
            .shares
            .iter()
            .map(|(component, account, share)| json!({ "component": component, "account": account, "share": share }))
            .collect();
    }
    found
}
