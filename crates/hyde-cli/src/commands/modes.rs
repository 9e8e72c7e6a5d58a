//! `hyde modes`: natural frequencies and dampings of the linearised model; of several experiments side by side, and over a
//! parameter; and parameters from measured ones.

mod inverse;
mod over;
mod page;
mod point;

pub(crate) use self::point::{Prepared, asked_point, prepared};

use crate::args::{ModelArgs, ModesArgs};
use crate::clock;
use crate::exit::Exit;
use crate::project::{Told as _, complain, print_output};
use hyde_experiment::{
    About, Linear, LinearizeError, ModeShape, NaturalMode, Pole, Poles, linearize_about,
    mode_shape, poles,
};
use hyde_present::assumed;
use hyde_present::assumptions;
use hyde_present::head;
use hyde_program::Program;
use hyde_report::Block;
use hyde_study::operating_point;
use hyde_study::settings::Setting;
use hyde_units::significant;
use serde_json::{Map, Value, json};
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

/// The modes of one experiment.
pub(crate) struct Found {
    /// Its name, else that of the model.
    pub(crate) name: String,
    /// The head of the page.
    facts: Vec<(String, String)>,
    pub(crate) modes: Vec<NaturalMode>,
    shapes: Vec<Option<ModeShape>>,
    real: Vec<Pole>,
    json: Map<String, Value>,
    /// The line that says what grows.
    pub(crate) unstable: Option<String>,
    /// About what it is linearised, with what is assumed.
    pub(crate) about: String,
    /// The same for a page.
    pub(crate) blocks: Vec<Block>,
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
        let listed = |found: &Found| {
            let mut listed = found.json.clone();
            listed.insert("experiment".to_owned(), json!(found.name));
            Value::Object(listed)
        };
        let (first, others) = (&all[0], &all[1..]);
        let mut value = json!({ "ok": true });
        for (key, part) in &first.json {
            value[key] = part.clone();
        }
        if !others.is_empty() {
            value["with"] = others.iter().map(listed).collect();
        }
        return Ok(format!("{value:#}"));
    }
    let mut text = match all.as_slice() {
        [one] => with_energy(one, args.real),
        several => side_by_side(several),
    };
    if let Some(folder) = &args.out {
        let path = page::leave(folder, None, &all)
            .map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
        let _ = writeln!(text, "{path}");
    }
    Ok(text)
}

/// The modes of an experiment, with one more parameter set if so.
pub(crate) fn found(
    args: &ModesArgs,
    model: &ModelArgs,
    set: Option<&Setting>,
) -> Result<Found, Exit> {
    let Prepared {
        mut project,
        compiled,
        tables,
        parameters: p,
        chosen,
        time,
    } = prepared(&args.about, model, set)?;
    let program = &compiled.program;
    let about = About {
        time,
        modes: &chosen,
        open: args.open,
    };
    let linear = linearize_about(program, &tables, &p, &[], about);
    let linear = linear.map_err(|error| {
        if let LinearizeError::Failed(failure) = error {
            return project.report_no_point(model, program, failure);
        }
        let reason = format!(
            "the model is not linearised: {}",
            operating_point::why_not(&error)
        );
        complain(model, Exit::CommandLine, &reason)
    })?;
    let poles = poles(&linear);
    let (mut modes, mut shapes) = (Vec::new(), Vec::new());
    for pole in poles.oscillating() {
        let mode = pole.mode();
        if args.below.is_none_or(|limit| mode.frequency_hz < limit) {
            modes.push(mode);
            shapes.push(mode_shape(program, &p, &linear, (&poles, &pole)));
        }
    }
    let listed = modes.iter().zip(&shapes);
    let listed: Vec<Value> = listed
        .map(|(mode, shape)| json(program, &linear, mode, shape.as_ref()))
        .collect();
    let notes = hyde_study::assumptions::of_model(&project, program, &p);
    let mut json = assumed::json(program, &linear, time, &poles);
    json.insert("notes".to_owned(), notes.clone().into());
    json.insert("modes".to_owned(), listed.into());
    let unit = |parameter: &hyde_program::Parameter| {
        (parameter.name.clone(), parameter.dimension.usual_unit())
    };
    Ok(Found {
        name: project.experiment.clone().unwrap_or(program.name.clone()),
        facts: head::facts(&project, &clock::now()),
        units: program.parameters.iter().map(unit).collect(),
        modes,
        shapes,
        json,
        unstable: assumed::unstable(program, &p, &linear, &poles),
        about: loop_told(program, &linear, &poles)
            + &assumed::text(program, &linear, time)
            + &assumptions::text(&notes),
        blocks: [
            vec![Block::Text(loop_told(program, &linear, &poles))],
            assumed::blocks(program, &linear, time),
            notes.into_iter().map(Block::Text).collect(),
        ]
        .concat(),
        real: poles.real(),
    })
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

fn with_energy(found: &Found, real: bool) -> String {
    let mut text = found.unstable.clone().unwrap_or_default();
    let _ = writeln!(text, "{:>12} {:>10}   energy", "f [Hz]", "damping");
    for (mode, shape) in found.modes.iter().zip(&found.shapes) {
        let energy = shape.as_ref().map(assumed::shares);
        let line = format!(
            "{:>12} {:>10}   {}",
            significant(mode.frequency_hz, 5),
            significant(mode.damping, 3),
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
    text.push_str(&found.about);
    text
}

/// The frequencies of several experiments in Hz, in order, and by how much each differs from that of the first.
fn side_by_side(all: &[Found]) -> String {
    let mut text = String::new();
    for found in all {
        if let Some(unstable) = &found.unstable {
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
        let _ = write!(text, "{}: {}", found.name, found.about);
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
