//! `hyde modes`: natural frequencies and dampings of the linearised model.

use crate::args::ModesArgs;
use crate::exit::Exit;
use crate::project::{self, Records, complain, print_output};
use crate::records;
use hyde_experiment::{linearize, modes as natural_modes, parameters};
use hyde_program::Program;
use hyde_units::significant;
use serde_json::json;
use std::fmt::Write as _;

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
    let compiled = project.compile(&args.model, true)?;
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
    if args.model.json {
        let list: Vec<_> = found
            .iter()
            .map(|mode| json!({ "frequency_hz": mode.frequency_hz, "damping": mode.damping }))
            .collect();
        return Ok(format!("{:#}", json!({ "ok": true, "modes": list })));
    }
    let mut text = format!("{:>12} {:>10}\n", "f [Hz]", "damping");
    for mode in found {
        let _ = writeln!(
            text,
            "{:>12} {:>10}",
            significant(mode.frequency_hz, 5),
            significant(mode.damping, 3)
        );
    }
    Ok(text)
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
