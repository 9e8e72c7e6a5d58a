//! `hyde modes`: natural frequencies and dampings of the linearised model; of several experiments side by side, and over a
//! parameter; and parameters from measured ones.

mod inverse;
mod over;

use crate::args::{ModelArgs, ModesArgs};
use crate::exit::Exit;
use crate::project::{self, Aim, Project, Records, complain, print_output};
use crate::records;
use crate::settings::Setting;
use hyde_compiler::Compiled;
use hyde_experiment::{Linear, ModeShape, NaturalMode, linearize, mode_shape, parameters, poles};
use hyde_program::Program;
use hyde_signal::Table;
use hyde_units::significant;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
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

/// The modes of one experiment.
pub(crate) struct Found {
    /// Its name, else that of the model.
    pub(crate) name: String,
    pub(crate) modes: Vec<NaturalMode>,
    shapes: Vec<Option<ModeShape>>,
    json: Vec<Value>,
    /// The unit of each parameter, in SI.
    pub(crate) units: Vec<(String, String)>,
}

fn table(args: &ModesArgs) -> Result<String, Exit> {
    if !args.measured.is_empty() {
        return inverse::fitted(args);
    }
    let experiments =
        std::iter::once(args.model.clone()).chain(args.with.iter().map(|name| ModelArgs {
            experiment: Some(name.clone()),
            ..args.model.clone()
        }));
    let experiments: Vec<ModelArgs> = experiments.collect();
    if let Some(over) = &args.over {
        return over::table(args, &experiments, over);
    }
    let all: Result<Vec<Found>, Exit> = experiments
        .iter()
        .map(|model| found(args, model, None))
        .collect();
    let all = all?;
    if args.model.json {
        let listed = |found: &Found| json!({ "experiment": found.name, "modes": found.json });
        let (first, others) = (&all[0], &all[1..]);
        let mut value = json!({ "ok": true, "modes": first.json });
        if !others.is_empty() {
            value["with"] = others.iter().map(listed).collect();
        }
        return Ok(format!("{value:#}"));
    }
    Ok(match all.as_slice() {
        [one] => with_energy(one),
        several => side_by_side(several),
    })
}

/// An experiment ready to be linearised.
struct Prepared {
    project: Project,
    compiled: Compiled,
    tables: BTreeMap<String, Table>,
    parameters: Vec<f64>,
    /// Modes of automata.
    chosen: Vec<(usize, usize)>,
}

fn prepared(args: &ModesArgs, model: &ModelArgs, set: Option<&Setting>) -> Result<Prepared, Exit> {
    let mut project = project::load(model, Records::Needed)?;
    project.settings.extend(set.cloned());
    let compiled = project.compile(model, Aim::Linearize)?;
    project.print_warnings(model);
    let program = &compiled.program;
    let wrong = |reason: String| complain(model, Exit::CommandLine, &reason);
    let tables = records::tables(&project.records);
    let parameters = parameters(program, &tables, &project.set())
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
    Ok(Prepared {
        project,
        compiled,
        tables,
        parameters,
        chosen,
    })
}

/// The modes of an experiment, with one more parameter set if so.
pub(crate) fn found(
    args: &ModesArgs,
    model: &ModelArgs,
    set: Option<&Setting>,
) -> Result<Found, Exit> {
    let Prepared {
        project,
        compiled,
        tables,
        parameters: p,
        chosen,
    } = prepared(args, model, set)?;
    let program = &compiled.program;
    let wrong = |reason: String| complain(model, Exit::CommandLine, &reason);
    let linear = linearize(program, &tables, &p, &[], &chosen)
        .map_err(|error| wrong(format!("the model could not be linearised: {error:?}")))?;
    let poles = poles(&linear);
    let mut modes = Vec::new();
    let mut shapes = Vec::new();
    for pole in poles.oscillating() {
        let mode = pole.mode();
        if args.below.is_none_or(|limit| mode.frequency_hz < limit) {
            modes.push(mode);
            shapes.push(mode_shape(program, &p, &linear, (&poles, &pole)));
        }
    }
    let json = modes
        .iter()
        .zip(&shapes)
        .map(|(mode, shape)| json(program, &linear, mode, shape.as_ref()))
        .collect();
    let unit = |parameter: &hyde_program::Parameter| {
        (parameter.name.clone(), parameter.dimension.usual_unit())
    };
    Ok(Found {
        name: project.experiment.clone().unwrap_or(program.name.clone()),
        units: program.parameters.iter().map(unit).collect(),
        modes,
        shapes,
        json,
    })
}

fn with_energy(found: &Found) -> String {
    let mut text = format!("{:>12} {:>10}   energy\n", "f [Hz]", "damping");
    for (mode, shape) in found.modes.iter().zip(&found.shapes) {
        let line = format!(
            "{:>12} {:>10}   {}",
            significant(mode.frequency_hz, 5),
            significant(mode.damping, 3),
            shape.as_ref().map_or_else(String::new, shares)
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// The frequencies of several experiments in Hz, in order, and by how much each differs from that of the first.
fn side_by_side(all: &[Found]) -> String {
    let mut text = String::new();
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
    text
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
