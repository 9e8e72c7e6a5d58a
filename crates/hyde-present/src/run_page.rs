//! The report of a run as one HTML page.

use crate::{assumptions, figures, forces, head, start, summary};
use hyde_compiler::Compiled;
use hyde_experiment::Run;
use hyde_program::Method;
use hyde_report::{
    Block, ChannelError, Event, EventTable, Outcome, Page, Parameter, RunReport, Section, Verdict,
};
use hyde_study::Project;
use hyde_units::{engineering_as, format_value, significant};

const ESDIRK: &str = "ESDIRK5(4)7L[2]SA2, a Runge-Kutta method";

/// The page of a run; `made` says when it is made.
pub fn page(project: &Project, compiled: &Compiled, run: &Run, made: &str) -> Page {
    let program = &compiled.program;
    let title = project.experiment.as_ref().map_or_else(
        || program.name.clone(),
        |e| format!("{e} of {}", program.name),
    );
    let (title, end_s) = match &run.incomplete {
        None => (title, run.stop_s),
        Some(incomplete) => (format!("{title}, incomplete"), incomplete.reached_s),
    };
    let statistics = &run.results.statistics;
    let verdicts = run
        .measures
        .iter()
        .filter(|measure| measure.expectation)
        .map(|measure| Verdict {
            outcome: if measure.holds {
                Outcome::Passed
            } else {
                Outcome::Failed
            },
            text: format!("{}{}", measure.name, summary::why_missing(measure)),
        })
        .collect();
    let key_figures = run
        .measures
        .iter()
        .zip(&program.experiment.measures)
        .filter(|(measure, _)| !measure.expectation)
        .map(|(measure, known)| {
            // As on the console, with the prefix that fits.
            let text = engineering_as(measure.value, &known.unit);
            let (value, unit) = text.split_once(' ').unwrap_or((&text, ""));
            let (value, unit) = match measure.missing {
                None => (value, unit),
                Some(_) => ("no value", ""),
            };
            hyde_report::KeyFigure {
                name: measure.name.clone(),
                value: value.to_owned(),
                unit: unit.to_owned(),
                note: measure
                    .missing
                    .as_ref()
                    .map_or(String::new(), hyde_experiment::Missing::text),
            }
        })
        .collect();
    let channels = run
        .channels
        .iter()
        .map(|channel| {
            let (unit, of) = hyde_units::error_in(&channel.unit, channel.rms);
            ChannelError {
                channel: channel.name.clone(),
                unit: hyde_units::shown(&unit).to_owned(),
                rms: of.from_si(channel.rms),
                relative: channel.relative_percent / 100.0,
                noise: channel.noise.map(|noise| of.from_si(noise)),
            }
        })
        .collect();
    let rows = run
        .results
        .events
        .iter()
        .take(100)
        .map(|event| {
            let (what, before, after) = summary::described(compiled, event);
            Event {
                time: event.t,
                what: format!("{what}: {}", event.cause),
                before,
                after,
                source: project.sources.place(event.origin.span),
            }
        })
        .collect();
    let parameters = program
        .parameters
        .iter()
        .map(|parameter| {
            let values = &run.parameters[parameter.place..parameter.place + parameter.len];
            let set = project
                .settings
                .iter()
                .any(|setting| setting.path == parameter.name);
            let value: Vec<String> = values
                .iter()
                .map(|value| significant(parameter.unit.unit().from_si(*value), 6))
                .collect();
            Parameter {
                name: parameter.name.clone(),
                value: value.join(", "),
                unit: hyde_units::shown(parameter.unit.text()).to_owned(),
                source: if set {
                    "command line".to_owned()
                } else {
                    parameter.source.clone().unwrap_or_default()
                },
            }
        })
        .collect();
    let counted = |name: &str, value: u64| (name.to_owned(), value.to_string());
    let ida = format!("IDA, SUNDIALS {}", hyde_ida::sundials_version());
    let solver = vec![
        (
            "method".to_owned(),
            match (statistics.method, statistics.left_ida) {
                (Method::Ida | Method::Auto, None) => ida,
                (Method::Ida | Method::Auto, Some(left)) => {
                    let at = significant(left.at_s, 4);
                    format!("{ida}; from {at} s on {ESDIRK}: {}", left.why)
                }
                (Method::Esdirk, _) => ESDIRK.to_owned(),
            },
        ),
        (
            "relative tolerance".to_owned(),
            format!("{:e}", run.tolerances.0),
        ),
        (
            "absolute tolerance".to_owned(),
            format!("{:e}", run.tolerances.1),
        ),
        ("unknowns".to_owned(), program.n_unknowns.to_string()),
        counted("steps", statistics.steps),
        counted("residual evaluations", statistics.residual_evaluations),
        counted("Jacobian evaluations", statistics.jacobian_evaluations),
        counted("error test failures", statistics.error_test_failures),
        counted("restarts", statistics.restarts),
        counted("events", statistics.events),
        counted("ticks", statistics.ticks),
    ];
    let stop = hyde_units::NamedUnit::usual(hyde_units::Dimension::TIME);
    let mut page = RunReport {
        title: title.clone(),
        facts: head::facts(project, made),
        verdicts,
        key_figures,
        channels,
        figures: figures::of_run(&title, program, run),
        events: EventTable {
            rows,
            total: run.results.events.len(),
        },
        solver,
        parameters,
        footer: format!(
            "Hyde {}, {} of {}",
            env!("CARGO_PKG_VERSION"),
            format_value(end_s - run.start.0, &stop),
            project
                .sources
                .iter()
                .next()
                .map_or("", |(_, source)| source.name.as_str())
        ),
    }
    .page();
    if let Some(section) =
        assumptions::section(&hyde_study::assumptions::of_run(project, program, run))
    {
        page.sections.insert(0, section);
    }
    page.sections.splice(0..0, head::model(project));
    if let Some(incomplete) = &run.incomplete {
        let text = format!(
            "This run did not reach its end at {} s: {}. Results, events and figures end at {} s. Measures, \
             expectations and errors are not available.",
            significant(run.stop_s, 7),
            incomplete.reason,
            significant(incomplete.reached_s, 7)
        );
        let heading = "Incomplete".to_owned();
        let blocks = vec![Block::Text(text)];
        page.sections.insert(0, Section { heading, blocks });
    }
    // Behind the figures, before the long list of events.
    let events = page
        .sections
        .iter()
        .position(|section| section.heading == "Events");
    let place = events.unwrap_or(page.sections.len());
    if let Some(section) = forces::section(compiled, run) {
        page.sections.insert(place, section);
    }
    let told = start::lines(program, &run.results.yielded);
    if !told.is_empty() {
        let blocks = told.into_iter().map(Block::Text).collect();
        let heading = "Start".to_owned();
        page.sections.insert(place, Section { heading, blocks });
    }
    page
}
