//! `hyde bode`: the frequency responses an experiment asks for, of the linearised model and as measured on the full hybrid
//! one by the sweep of its stimulus or by stepped sines; beside them what was measured on the machine, and those of other
//! experiments.

mod draw;
mod margins;
mod measured;
mod open_loop;
mod page;
mod response;
mod seen;
mod stepped;

use self::measured::Compared;
use self::response::{Response, band, frequencies, linearised};
use crate::args::{BodeArgs, ModelArgs, RunArgs};
use crate::clock;
use crate::commands::run;
use crate::exit::Exit;
use crate::project::{self, Aim, Records, Told as _, complain, print_output};
use crate::watch::Watch;
use hyde_diag::{Code, Diagnostic};
use hyde_experiment::{About, LinearizeError, linearize_about, parameters, poles, swept_response};
use hyde_present::assumed;
use hyde_present::assumptions;
use hyde_present::head;
use hyde_present::summary;
use hyde_program::{Bode, Constant, Program};
use hyde_report::Block;
use hyde_sim::Reached;
use hyde_study::operating_point;
use hyde_units::significant;
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::sync::Arc;

/// What one experiment asks for.
struct Asked {
    title: String,
    /// The head of the page.
    facts: Vec<(String, String)>,
    /// One list for each `bode`, one response in it for each output.
    bodes: Vec<Vec<Response>>,
    /// One for each loop that is cut.
    margins: Vec<margins::OfLoop>,
    /// Of each, about what it is linearised, what is assumed there, and the poles.
    json: Vec<Map<String, Value>>,
    /// The same for the page.
    about: Vec<Block>,
    /// What was taken for granted of records and tables.
    notes: Vec<String>,
    text: String,
    /// Every expectation held.
    holds: bool,
}

/// Prints and plots the frequency responses of an experiment, and of those beside it.
pub(crate) fn bode(args: &BodeArgs) -> Exit {
    match responses(args) {
        Ok((text, holds)) => {
            print_output(&text);
            if holds { Exit::Done } else { Exit::Expectation }
        }
        Err(exit) => exit,
    }
}

fn responses(args: &BodeArgs) -> Result<(String, bool), Exit> {
    let mut all = vec![asked(args, &args.model)?];
    for name in &args.with {
        let model = ModelArgs {
            experiment: Some(name.clone()),
            ..args.model.clone()
        };
        all.push(asked(args, &model)?);
    }
    let holds = all.iter().all(|asked| asked.holds);
    let every: Vec<&Response> = all
        .iter()
        .flat_map(|asked| asked.bodes.iter().flatten())
        .collect();
    if args.model.json {
        let found: Vec<Value> = all
            .iter()
            .flat_map(|asked| asked.bodes.iter().zip(&asked.json))
            .map(|(bode, about)| json(bode, about))
            .collect();
        let margins = all.iter().flat_map(|asked| &asked.margins);
        let margins: Vec<Value> = margins.map(margins::json).collect();
        let notes: Vec<&String> = all.iter().flat_map(|asked| &asked.notes).collect();
        let answer = json!({ "ok": true, "responses": found, "margins": margins, "notes": notes });
        return Ok((format!("{answer:#}"), holds));
    }
    let mut text: String = all.iter().map(|asked| asked.text.as_str()).collect();
    let mut drawn: Vec<(&str, &str)> = Vec::new();
    for first in &every {
        let key = (first.input.as_str(), first.output.as_str());
        if drawn.contains(&key) {
            continue;
        }
        drawn.push(key);
        let same: Vec<&Response> = every
            .iter()
            .copied()
            .filter(|other| (other.input.as_str(), other.output.as_str()) == key)
            .collect();
        let mut told: Vec<&str> = vec![&first.experiment];
        for other in &same {
            if !told.contains(&other.experiment.as_str()) {
                told.push(&other.experiment);
                let _ = writeln!(
                    text,
                    "{}: {} is {}",
                    key.1,
                    other.experiment,
                    seen::apart(first, other)
                );
            }
        }
        if let Some(folder) = &args.out {
            let alone = every
                .iter()
                .all(|other| (other.input.as_str(), other.output.as_str()) == key);
            let stem = if alone {
                "bode".to_owned()
            } else {
                format!("bode-{}", file_name(&first.output))
            };
            let title = args.title.as_deref().unwrap_or(&all[0].title);
            draw::leave(folder, &stem, title, &same)
                .map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
            let _ = writeln!(text, "{}", folder.join(format!("{stem}.svg")).display());
        }
    }
    let loops: Vec<&margins::OfLoop> = all.iter().flat_map(|asked| &asked.margins).collect();
    if let Some(folder) = &args.out {
        let title = args.title.as_deref().unwrap_or(&all[0].title);
        let path = page::leave(folder, title, &all)
            .map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
        let _ = writeln!(text, "{path}");
        for one in &loops {
            let suffix = match loops.as_slice() {
                [_] => String::new(),
                _ => format!("-{}-{}", file_name(&one.experiment), file_name(&one.signal)),
            };
            let title = args.title.as_deref().unwrap_or(&all[0].title);
            let left = open_loop::leave(folder, &suffix, title, one)
                .map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
            left.iter().for_each(|name| {
                let _ = writeln!(text, "{name}");
            });
        }
    }
    Ok((text, holds))
}

/// The responses of one experiment.
fn asked(args: &BodeArgs, model: &ModelArgs) -> Result<Asked, Exit> {
    let mut project = project::load(model, Records::Needed)?;
    margins::add_cuts(&mut project, &args.cut);
    if project.diagnostics.has_errors() {
        return Err(project.finish_with_errors(model));
    }
    let margins_alone = args.margins || !args.cut.is_empty();
    let compiled = project.compile_or_report(model, Aim::Linearize)?;
    project.print_warnings(model);
    let program = &compiled.program;
    let wrong = |reason: String| complain(model, Exit::CommandLine, &reason);
    let no_cut = program.experiment.cuts.is_empty();
    if no_cut && margins_alone {
        let reason = "the signal at which to open the loop is missing: write `margins of SIGNAL;` in the experiment, or `--cut SIGNAL` here; for example the output of a controller";
        return Err(wrong(reason.to_owned()));
    }
    let bodes = if margins_alone {
        &[][..]
    } else {
        &program.experiment.bodes[..]
    };
    if no_cut && bodes.is_empty() {
        let reason = "the experiment has no `bode` or `margins`: write `bode from u to y over 1 .. 50 [Hz];` or `margins of SIGNAL;`";
        return Err(wrong(reason.to_owned()));
    }
    let tables = hyde_study::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(model, program, &error))?;
    let recorded = measured::curves(program, &tables, &p).map_err(|diagnostic| {
        project.diagnostics.push(*diagnostic);
        project.finish_with_errors(model)
    })?;
    let by_stimulus = bodes.iter().any(|bode| bode.stepped.is_none());
    let run = if args.linear || !by_stimulus {
        None
    } else {
        Some(run::solved(&RunArgs::of_model(model))?)
    };
    let at = args.about.at.as_deref();
    let asked_modes = args.about.in_modes.iter();
    let asked_modes = asked_modes.map(|text| operating_point::in_mode(program, text));
    let asked_modes: Vec<(usize, usize)> = asked_modes.collect::<Result<_, _>>().map_err(wrong)?;
    let name = project.experiment.clone().unwrap_or_default();
    let mut asked = Asked {
        title: title(&project, &name, &program.name),
        facts: head::facts(&project, &clock::now()),
        bodes: Vec::new(),
        margins: Vec::new(),
        json: Vec::new(),
        about: Vec::new(),
        notes: Vec::new(),
        text: String::new(),
        holds: true,
    };
    if let Some((project, compiled, run, took)) = &run {
        asked.text = summary::text(project, compiled, run, *took);
        asked.holds = run.measures.iter().all(|measure| measure.holds);
    } else if !args.with.is_empty() {
        let _ = writeln!(asked.text, "{name} of {}", program.name);
    }
    for (number, bode) in bodes.iter().enumerate() {
        if program.experiment.differentiated.contains(&bode.input) {
            let diagnostic = response::no_rate(bode);
            project.diagnostics.push(diagnostic);
            return Err(project.finish_with_errors(model));
        }
        let band = band(program, number, &p)
            .or_else(|| measured::band(program, number, &recorded))
            .ok_or_else(|| wrong("the band of frequencies is empty".to_owned()))?;
        let frequency = frequencies(band, args.points);
        let time = program.kernels.constant(Constant::RespondsAt(number), &p);
        let time = operating_point::moment(at, bode.at, time).map_err(wrong)?;
        let about = About {
            time,
            modes: &[&asked_modes[..], &bode.modes].concat(),
            open: false,
        };
        let input = std::slice::from_ref(&bode.input);
        let reached = Arc::default();
        let watch = watch(model, &reached);
        let found = linearize_about(program, &tables, &p, input, about).map(|system| {
            let poles = poles(&system);
            let asked = (bode, frequency.as_slice());
            let responses = linearised(&name, program, asked, (&system, &poles), &reached);
            (system, poles, responses)
        });
        drop(watch);
        let (system, poles, responses) =
            found.map_err(|error| no_system(&mut project, model, (program, bode), error))?;
        let mut responses = responses.map_err(|reason| {
            let diagnostic = Diagnostic::error(Code::NoResponse, reason);
            let diagnostic = diagnostic.label(bode.origin.span, "there is no response from here");
            project.diagnostics.push(diagnostic);
            project.finish_with_errors(model)
        })?;
        let of_run = run.as_ref().map(|(_, own, run, _)| (&own.program, run));
        let compared = measured::compared(program, number, &recorded, &system, &tables, of_run);
        let errors = measured::table(&compared);
        // A run that follows what was measured sweeps nothing.
        let sweeps = !compared.iter().any(Compared::has_run);
        for one in compared {
            let output = one.place.1;
            responses[output].measured.push(one);
        }
        if let (None, Some((_, compiled, run, _))) = (&bode.stepped, &run)
            && sweeps
        {
            let own = &compiled.program.experiment.bodes[number];
            for swept in swept_response(own, &run.results, band) {
                let mut of = responses.iter_mut();
                if let Some(response) = of.find(|response| response.output == swept.output) {
                    response.swept = Some(swept.response);
                }
            }
        }
        let told = asked.bodes.iter().flatten().any(|known| {
            let new = responses.first();
            new.is_some_and(|new| known.input == new.input && known.output == new.output)
        });
        let stepped = bode.stepped.is_some() && !args.linear;
        if let Some(unstable) = assumed::unstable(program, &p, &system, &poles)
            && !asked.text.contains(&unstable)
        {
            asked.text.insert_str(0, &unstable);
        }
        if stepped || !told {
            let _ = writeln!(
                asked.text,
                "from {} over {} .. {} Hz{}",
                bode.input,
                significant(band.0, 3),
                significant(band.1, 3),
                if stepped { ", stepped" } else { "" }
            );
        }
        let first = responses
            .first()
            .map_or(&[][..], |response| &response.resonances);
        for (frequency, damping) in first.iter().filter(|_| !told) {
            let _ = writeln!(
                asked.text,
                "  mode at {:>8} Hz, damping {:<8} {}",
                significant(*frequency, 4),
                significant(*damping, 2),
                seen::where_seen(*frequency, &responses)
            );
        }
        for response in responses.iter().filter(|_| !told) {
            let _ = writeln!(
                asked.text,
                "  {}: {}",
                response.output,
                seen::peaks_told(response)
            );
        }
        let about = assumed::text(program, &system, time);
        if !asked.text.contains(&about) {
            asked.text.push_str(&about);
        }
        asked.about.extend(assumed::blocks(program, &system, time));
        asked
            .json
            .push(assumed::json(program, &system, time, &poles));
        if stepped {
            let (text, holds) = stepped::measured(model, &mut project, number, &mut responses)?;
            asked.text.push_str(&text);
            asked.holds &= holds;
        }
        asked.text.push_str(&errors);
        asked.bodes.push(responses);
    }
    let about = (at, &asked_modes[..]);
    let found = margins::all(&name, program, &tables, &p, about, &mut project.diagnostics);
    asked.margins = found.ok_or_else(|| project.finish_with_errors(model))?;
    asked.notes = hyde_study::assumptions::of_model(&project, program, &p);
    asked
        .about
        .extend(asked.notes.iter().cloned().map(Block::Text));
    for margins in &asked.margins {
        asked.text.push_str(&margins::text(margins));
        if !asked.text.contains(&margins.point) {
            asked.text.push_str(&margins.point);
        }
    }
    // A run has told them before.
    if run.is_none() {
        asked.text.push_str(&assumptions::text(&asked.notes));
    }
    Ok(asked)
}

/// Shows how many frequencies of a response are done.
fn watch(args: &ModelArgs, reached: &Arc<Reached>) -> Watch {
    let reached = Arc::clone(reached);
    Watch::new(args.json || args.quiet, move || match reached.get() {
        (done, all) if all > 0.0 => format!("{done} of {all} frequencies"),
        _ => "linearising".to_owned(),
    })
}

/// What the experiment says of itself, else its name.
fn title(project: &project::Project, name: &str, model: &str) -> String {
    let mut experiments = project.file.experiments();
    let own = experiments.find(|experiment| experiment.name.text == name);
    own.and_then(|experiment| experiment.doc.clone())
        .unwrap_or_else(|| format!("{name} of {model}"))
}

fn json(bode: &[Response], about: &Map<String, Value>) -> Value {
    let outputs: Vec<Value> = bode
        .iter()
        .map(|response| {
            let stepped: Vec<Value> = response
                .stepped
                .iter()
                .map(|(f, amplitude, found)| {
                    json!({
                        "frequency_hz": f, "amplitude": amplitude, "re_im": [found.response.re, found.response.im],
                        "coherence": found.coherence, "distortion": found.distortion,
                    })
                })
                .collect();
            let measured: Vec<Value> = response.measured.iter().map(Compared::json).collect();
            json!({ "name": response.output, "re_im": response.linear, "stepped": stepped, "measured": measured })
        })
        .collect();
    let first = bode.first();
    let mut found = json!({
        "experiment": first.map(|response| &response.experiment),
        "input": first.map(|response| &response.input),
        "frequency_hz": first.map(|response| &response.frequency),
        "modes": first.map(|response| &response.resonances),
        "outputs": outputs,
    });
    for (key, value) in about {
        found[key] = value.clone();
    }
    found
}

/// Reports why there is no linearised system for a response.
fn no_system(
    project: &mut project::Project,
    model: &ModelArgs,
    (program, bode): (&Program, &Bode),
    error: LinearizeError,
) -> Exit {
    if let LinearizeError::Failed(failure) = error {
        return project.report_no_point(model, program, failure);
    }
    let reason = format!(
        "there is no linearised response: {}",
        operating_point::why_not(&error)
    );
    let diagnostic = Diagnostic::error(Code::NoResponse, reason);
    let diagnostic = diagnostic.label(bode.origin.span, "there is no response from here");
    project.diagnostics.push(diagnostic);
    project.finish_with_errors(model)
}

fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '.' {
                c
            } else {
                '_'
            }
        })
        .collect()
}
