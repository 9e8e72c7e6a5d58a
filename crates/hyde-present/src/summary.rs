//! What a run was, in a few lines for people and as JSON for programs.

use crate::{assumptions, ledger, start};
use hyde_compiler::Compiled;
use hyde_experiment::{MeasureValue, Run};
use hyde_program::Method;
use hyde_sim::{Event, EventKind, GradientEnd, GradientEndKind};
use hyde_study::Project;
use hyde_units::{counted, engineering_as, engineering_difference, significant};
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::time::Duration;

/// The run in a few lines of at most 80 columns.
pub fn text(project: &Project, compiled: &Compiled, run: &Run, took: Duration) -> String {
    let program = &compiled.program;
    let mut out = String::new();
    let name = project.experiment.as_ref().map_or_else(
        || program.name.clone(),
        |e| format!("{e} of {}", program.name),
    );
    let statistics = &run.results.statistics;
    let span_s = run.stop_s - run.start.0;
    let factor = span_s / took.as_secs_f64().max(1e-9);
    let _ = writeln!(
        out,
        "{name}: {} s in {} s, {} times real time",
        significant(span_s, 4),
        significant(took.as_secs_f64(), 2),
        significant(factor, 2)
    );
    let _ = writeln!(
        out,
        "  {}, {}{}, {}, {}, {}",
        counted(program.n_unknowns, "unknown"),
        counted(statistics.steps, "step"),
        match statistics.method {
            Method::Ida | Method::Auto => "",
            Method::Esdirk => " by esdirk",
        },
        counted(statistics.events, "event"),
        counted(statistics.ticks, "tick"),
        counted(statistics.restarts, "restart")
    );
    if let Some(left) = statistics.left_ida {
        let at = significant(left.at_s, 4);
        let _ = writeln!(out, "  esdirk from {at} s on: {}", left.why);
    }
    let found = run.results.yielded.iter().map(|y| y.name.as_str());
    let found: BTreeSet<&str> = found.collect();
    let filled = compiled.states.filled.iter();
    let filled = filled.filter(|name| !found.contains(name.as_str()));
    let filled: Vec<&str> = filled.map(String::as_str).collect();
    if !filled.is_empty() {
        let list = filled.join(", ");
        let _ = writeln!(out, "  initial value from `start` alone: {list}");
    }
    for line in start::lines(program, &run.results.yielded) {
        let _ = writeln!(out, "  {line}");
    }
    // What has one mode alone is in it all the time.
    let automata = program.automata.iter().zip(&run.results.mode_times);
    for (automaton, times) in automata.filter(|(automaton, _)| automaton.modes.len() > 1) {
        let parts: Vec<String> = automaton
            .modes
            .iter()
            .zip(times)
            .map(|(mode, time)| format!("{mode} {} s", significant(*time, 3)))
            .collect();
        let _ = writeln!(out, "  {:<24} {}", automaton.name, parts.join(", "));
    }
    for (cause, time) in &run.results.sliding {
        let _ = writeln!(out, "  {:<24} sliding {} s", cause, significant(*time, 3));
    }
    out.push_str(&assumptions::text(&hyde_study::assumptions::of_run(
        project, program, run,
    )));
    let end = run.results.gradient.as_ref().and_then(|g| g.end.as_ref());
    if let Some(end) = end {
        let _ = writeln!(out, "  {}", end_of_gradient(end));
    }
    if !run.channels.is_empty() {
        let _ = writeln!(
            out,
            "\n  {:<28} {:>12} {:>11} {:>12}",
            "measured - simulated", "rms", "relative", "noise"
        );
        for channel in &run.channels {
            let difference = |value| engineering_difference(value, &channel.unit);
            let noise = channel.noise.map_or(String::new(), difference);
            // Nothing measured has no relative error.
            let relative = if channel.relative_percent.is_finite() {
                format!("{} %", significant(channel.relative_percent, 3))
            } else {
                String::new()
            };
            let line = format!(
                "  {:<28} {:>12} {relative:>11} {noise:>12}",
                channel.name,
                difference(channel.rms),
            );
            let _ = writeln!(out, "{}", line.trim_end());
        }
    }
    if !run.measures.is_empty() {
        out.push('\n');
    }
    for (measure, known) in run.measures.iter().zip(&program.experiment.measures) {
        if measure.expectation {
            let verdict = if measure.holds {
                "holds"
            } else {
                "DOES NOT HOLD"
            };
            let why = why_missing(measure);
            let _ = writeln!(out, "  expect {}: {verdict}{why}", measure.name);
        } else if measure.missing.is_some() {
            let why = why_missing(measure);
            let _ = writeln!(out, "  {}: no value{why}", measure.name);
        } else {
            let value = engineering_as(measure.value, &known.unit);
            let _ = writeln!(out, "  {} = {value}", measure.name);
        }
    }
    if let Some(ledger) = ledger::of(compiled, run) {
        out.push_str(&ledger::text(&ledger));
    }
    out
}

/// Why a measure or an expectation has no value, behind a colon; empty of one that has.
pub fn why_missing(measure: &MeasureValue) -> String {
    let missing = measure.missing.as_ref();
    missing.map_or(String::new(), |missing| format!(": {}", missing.text()))
}

/// From when on a run has no gradient, and why.
fn end_of_gradient(end: &GradientEnd) -> String {
    let why = match end.kind {
        GradientEndKind::Grazing => format!("`{}` hardly crosses zero there", end.cause),
        GradientEndKind::Sliding => format!("it slides on `{}`", end.cause),
        GradientEndKind::Singular => "the linearised equations are singular".to_owned(),
    };
    format!("no gradient from {} s on: {why}", significant(end.t, 7))
}

/// The run as JSON: versions, inputs by hash, parameters, statistics, errors, measures.
pub fn json(project: &Project, compiled: &Compiled, run: &Run) -> Value {
    let program = &compiled.program;
    let statistics = &run.results.statistics;
    let parameters: Map<String, Value> = program
        .parameters
        .iter()
        .map(|parameter| {
            let values = &run.parameters[parameter.place..parameter.place + parameter.len];
            let value = if parameter.len == 1 { json!(values[0]) } else { json!(values) };
            let shown: Vec<f64> = values.iter().map(|&si| parameter.unit.unit().from_si(si)).collect();
            let shown = if parameter.len == 1 { json!(shown[0]) } else { json!(shown) };
            let entry = json!({
                "value": value, "unit": parameter.dimension.usual_unit(), "source": parameter.source,
                "display": shown, "display_unit": parameter.unit.text(),
            });
            (parameter.name.clone(), entry)
        })
        .collect();
    let records: Map<String, Value> = project
        .records
        .iter()
        .map(|(name, record)| {
            let assumptions = hyde_study::assumptions::of_record(program, name, &record.table);
            let entry = json!({
                "path": record.path.to_string_lossy(), "sha256": record.hash, "rows": record.table.rows(),
                "assumptions": assumptions,
            });
            (name.clone(), entry)
        })
        .collect();
    let tables: Vec<Value> = project
        .tables
        .iter()
        .map(|table| json!({ "path": table.path.to_string_lossy(), "sha256": table.hash, "rows": table.rows, "assumptions": table.notes }))
        .collect();
    let fmus = project.fmus.iter();
    let fmus: Vec<Value> = fmus
        .map(|fmu| json!({ "path": fmu.path.to_string_lossy(), "sha256": fmu.hash, "sandbox": fmu.in_own_process }))
        .collect();
    let channels: Vec<Value> = run
        .channels
        .iter()
        .map(|channel| {
            json!({
                "name": channel.name, "unit": channel.unit.unit().dimension.usual_unit(), "rows": channel.time.len(),
                "rms": channel.rms, "relative_percent": channel.relative_percent, "noise": channel.noise,
            })
        })
        .collect();
    let measures: Vec<Value> = run
        .measures
        .iter()
        .filter(|measure| !measure.expectation)
        .zip(
            program
                .experiment
                .measures
                .iter()
                .filter(|measure| !measure.expectation),
        )
        .map(|(measure, known)| {
            let unit = known.unit.unit();
            let value = json!({
                "name": measure.name, "value": measure.value, "unit": unit.dimension.usual_unit(),
                "display": unit.from_si(measure.value), "display_unit": known.unit.text(),
            });
            (value, measure)
        })
        .map(with_missing)
        .collect();
    let expectations: Vec<Value> = run
        .measures
        .iter()
        .filter(|measure| measure.expectation)
        .map(|measure| {
            (
                json!({ "text": measure.name, "holds": measure.holds }),
                measure,
            )
        })
        .map(with_missing)
        .collect();
    let modes: Map<String, Value> = program
        .automata
        .iter()
        .zip(&run.results.mode_times)
        .map(|(automaton, times)| {
            let times: Map<String, Value> = automaton
                .modes
                .iter()
                .cloned()
                .zip(times.iter().map(|time| json!(time)))
                .collect();
            (automaton.name.clone(), Value::Object(times))
        })
        .collect();
    let sliding: Map<String, Value> = run
        .results
        .sliding
        .iter()
        .map(|(cause, time)| (cause.clone(), json!(time)))
        .collect();
    let mut notes = program.notes.clone();
    notes.extend(hyde_study::assumptions::of_run(project, program, run));
    let mut summary = json!({
        "ok": true,
        "hyde": env!("CARGO_PKG_VERSION"),
        "sundials": hyde_ida::sundials_version(),
        "model": program.name,
        "experiment": project.experiment,
        "source_sha256": project.hash,
        "records": records,
        "tables": tables,
        "fmus": fmus,
        "start_s": run.start.0,
        "stop_s": run.stop_s,
        "rtol": run.tolerances.0,
        "atol": run.tolerances.1,
        "unknowns": program.n_unknowns,
        "method": match statistics.method {
            Method::Ida | Method::Auto => "ida",
            Method::Esdirk => "esdirk",
        },
        "statistics": {
            "steps": statistics.steps,
            "esdirk_from_s": statistics.left_ida.map(|left| left.at_s),
            "residual_evaluations": statistics.residual_evaluations,
            "jacobian_evaluations": statistics.jacobian_evaluations,
            "nonlinear_iterations": statistics.nonlinear_iterations,
            "error_test_failures": statistics.error_test_failures,
            "nonlinear_failures": statistics.nonlinear_failures,
            "restarts": statistics.restarts,
            "events": statistics.events,
            "ticks": statistics.ticks,
        },
        "mode_seconds": modes,
        "sliding_seconds": sliding,
        "start": start::json(program, &run.results.yielded),
        "channels": channels,
        "measures": measures,
        "expectations": expectations,
        "parameters": parameters,
        "notes": notes,
        "diagnostics": hyde_study::render::to_json(&project.diagnostics, &project.sources),
    });
    if let Some(incomplete) = &run.incomplete {
        summary["ok"] = json!(false);
        summary["incomplete"] =
            json!({ "reached_s": incomplete.reached_s, "reason": incomplete.reason });
    }
    if let Some(ledger) = ledger::of(compiled, run) {
        summary["ledger"] = ledger::json(&ledger);
    }
    summary
}

/// Adds why there is no value.
fn with_missing((mut entry, measure): (Value, &MeasureValue)) -> Value {
    if let Some(missing) = &measure.missing {
        entry["missing"] = json!(missing.text());
    }
    entry
}

/// The event log as CSV.
pub fn events_csv(project: &Project, compiled: &Compiled, events: &[Event]) -> String {
    let mut out = String::from("t [s],what,before,after,cause,source\n");
    for event in events {
        let (what, before, after) = described(compiled, event);
        let cause = event.cause.replace('"', "\"\"");
        let place = project.sources.place(event.origin.span);
        let _ = writeln!(
            out,
            "{},{what},{before},{after},\"{cause}\",{place}",
            event.t
        );
    }
    out
}

/// Of an event: whose, and the modes before and after.
pub fn described(compiled: &Compiled, event: &Event) -> (String, String, String) {
    match event.kind {
        EventKind::Transition {
            automaton,
            from,
            to,
        } => {
            let automaton = &compiled.program.automata[automaton];
            (
                automaton.name.clone(),
                automaton.modes[from].clone(),
                automaton.modes[to].clone(),
            )
        }
        EventKind::When => ("when".to_owned(), String::new(), String::new()),
        EventKind::Relation(truth) => ("if".to_owned(), (!truth).to_string(), truth.to_string()),
        EventKind::Slide {
            automaton,
            before,
            after,
        } => {
            let automaton = automaton.map(|number| &compiled.program.automata[number]);
            let side = |side: Option<usize>| match (side, automaton) {
                (None, _) => "sliding".to_owned(),
                (Some(mode), Some(automaton)) => automaton.modes[mode].clone(),
                (Some(truth), None) => (truth != 0).to_string(),
            };
            let whose = automaton.map_or("if", |automaton| automaton.name.as_str());
            (whose.to_owned(), side(before), side(after))
        }
    }
}
