//! `hyde modes`: natural frequencies and dampings of the linearised model.

use crate::args::ModesArgs;
use crate::exit::Exit;
use crate::project::{self, Aim, Records, complain, print_output};
use crate::records;
use hyde_experiment::{
    Linear, ModeShape, NaturalMode, linearize, mode_shape, modes as natural_modes, parameters,
};
use hyde_program::Program;
use hyde_units::significant;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;

/// Shares of the energy are printed down to this, as long as there is room for them in a line.
const LEAST_SHARE: f64 = 0.05;
const WIDTH: usize = 54;

/// Prints the modes of vibration.
pub(crate) fn modes(args: &ModesArgs) -> Exit {
    match table(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn table(args: &ModesArgs) -> Result<String, Exit> {
    let mut project = project::load(&args.model, Records::Needed)?;
    let compiled = project.compile(&args.model, Aim::Linearize)?;
    project.print_warnings(&args.model);
    let program = &compiled.program;
    let wrong = |reason: String| complain(&args.model, Exit::CommandLine, &reason);
    let tables = records::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|_| wrong("a parameter cannot be set".to_owned()))?;
    let mut chosen = program
        .experiment
        .bodes
        .first()
        .map(|bode| bode.modes.clone())
        .unwrap_or_default();
    for text in &args.in_modes {
        chosen.insert(0, in_mode(program, text).map_err(wrong)?);
    }
    let linear = linearize(program, &tables, &p, &[], &chosen)
        .map_err(|error| wrong(format!("the model could not be linearised: {error:?}")))?;
    let found: Vec<_> = natural_modes(&linear)
        .into_iter()
        .filter(|mode| args.below.is_none_or(|limit| mode.frequency_hz < limit))
        .collect();
    let shapes: Vec<_> = found
        .iter()
        .map(|mode| mode_shape(program, &p, &linear, mode))
        .collect();
    if args.model.json {
        let list: Vec<_> = found
            .iter()
            .zip(&shapes)
            .map(|(mode, shape)| json(program, &linear, mode, shape.as_ref()))
            .collect();
        return Ok(format!("{:#}", json!({ "ok": true, "modes": list })));
    }
    let mut text = format!("{:>12} {:>10}   energy\n", "f [Hz]", "damping");
    for (mode, shape) in found.iter().zip(&shapes) {
        let line = format!(
            "{:>12} {:>10}   {}",
            significant(mode.frequency_hz, 5),
            significant(mode.damping, 3),
            shape.as_ref().map_or_else(String::new, shares)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    Ok(text)
}

/// Where the energy is, the largest shares first: `97 % table.rocking`.
fn shares(shape: &ModeShape) -> String {
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

fn json(
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

/// `guide=slip`
fn in_mode(program: &Program, text: &str) -> Result<(usize, usize), String> {
    let (name, mode) = text
        .split_once('=')
        .ok_or_else(|| format!("`--in {text}`: write `NAME=MODE`"))?;
    let number = program
        .automata
        .iter()
        .position(|automaton| automaton.name == name)
        .ok_or_else(|| {
            let known: Vec<&str> = program
                .automata
                .iter()
                .map(|automaton| automaton.name.as_str())
                .collect();
            format!(
                "`{name}` has no modes; modes are in `{}`",
                known.join("`, `")
            )
        })?;
    let modes = &program.automata[number].modes;
    let found = modes.iter().position(|known| known == mode);
    let found = found.ok_or_else(|| {
        format!(
            "`{name}` has no mode `{mode}`; it has `{}`",
            modes.join("`, `")
        )
    })?;
    Ok((number, found))
}
