//! The figures of a run: those asked for, then measured over simulated, or a choice of states, with the modes below.

use crate::asked_figures;
use hyde_experiment::{Channel, Run};
use hyde_program::Program;
use hyde_report::{
    EventRow, EventStrip, Figure, Line, LineStyle, Panel, Span, time_panel, time_plot,
};
use hyde_sim::{EventKind, Results};
use hyde_units::{NamedUnit, Unit};

/// Panels in one figure.
const MAX_PANELS: usize = 4;

/// The figures of a run, the most telling first.
pub(crate) fn of_run(title: &str, program: &Program, run: &Run) -> Vec<Figure> {
    let asked = asked_figures::of_run(program, run);
    let mut figures: Vec<Figure> = asked.into_iter().map(|(_, figure)| figure).collect();
    let strip = strip(program, &run.results, run.stop_s);
    if run.channels.is_empty() {
        figures.push(time_plot(title, states(program, &run.results), strip));
        return figures;
    }
    let both: Vec<Panel> = run
        .channels
        .iter()
        .take(MAX_PANELS)
        .map(measured_and_simulated)
        .collect();
    let errors: Vec<Panel> = run.channels.iter().take(MAX_PANELS).map(error).collect();
    let figure = time_plot(title, both, strip.clone())
        .with_caption("Measured and simulated; the modes of the frictions below.");
    let rest = time_plot(format!("{title}: measured minus simulated"), errors, strip);
    figures.extend([figure, rest]);
    figures
}

/// The modes of every automaton over time.
pub(crate) fn strip(program: &Program, results: &Results, stop_s: f64) -> Option<EventStrip> {
    if program.automata.is_empty() {
        return None;
    }
    let end = results.time.last().copied().unwrap_or(stop_s);
    let rows = program
        .automata
        .iter()
        .enumerate()
        .map(|(number, automaton)| {
            let mut row = EventRow {
                label: automaton.name.clone(),
                ..EventRow::default()
            };
            let label = |mode: Option<usize>| {
                mode.map_or_else(
                    || "sliding".to_owned(),
                    |mode| automaton.modes[mode].clone(),
                )
            };
            let mut from = results.time.first().copied().unwrap_or(0.0);
            let mut mode: Option<String> = None;
            for event in &results.events {
                let (of, before, after) = match event.kind {
                    EventKind::Transition {
                        automaton,
                        from,
                        to,
                    } => (automaton, Some(from), Some(to)),
                    EventKind::Slide {
                        automaton: Some(automaton),
                        before,
                        after,
                    } => (automaton, before, after),
                    EventKind::Slide { .. } | EventKind::When | EventKind::Relation(_) => continue,
                };
                if of == number {
                    row.spans.push(Span {
                        from,
                        to: event.t,
                        label: mode.take().unwrap_or_else(|| label(before)),
                    });
                    (from, mode) = (event.t, Some(label(after)));
                }
            }
            // Without an event it stayed where it spent its time.
            let last = mode.or_else(|| {
                let times = results.mode_times.get(number)?;
                let only = times.iter().position(|time| *time > 0.0)?;
                Some(label(Some(only)))
            });
            if let Some(last) = last {
                row.spans.push(Span {
                    from,
                    to: end,
                    label: last,
                });
            }
            row
        })
        .collect();
    Some(EventStrip { rows })
}

fn measured_and_simulated(channel: &Channel) -> Panel {
    let (unit, of) = drawn_in(&channel.unit);
    let values = |si: &[f64]| si.iter().map(|&si| of.from_si(si)).collect();
    let lines = vec![
        Line::new("measured", channel.time.clone(), values(&channel.measured)),
        Line::new(
            "simulated",
            channel.time.clone(),
            values(&channel.simulated),
        )
        .with_style(LineStyle::Dashed),
    ];
    time_panel(channel.name.clone(), shown(&unit), lines)
}

/// The unit that values are drawn in: that of SI, with the prefix that fits, for all that is declared in a multiple of it;
/// any other as it is declared.
pub(crate) fn drawn_in(unit: &NamedUnit) -> (String, Unit) {
    // J and N.m, Hz and 1/s are not told from each other by their dimensions.
    let symbol = unit.unit().is_si() && unit.text().chars().all(char::is_alphabetic);
    let usual = NamedUnit::usual(unit.unit().dimension);
    let drawn = match unit.is_multiple_of_si() && !symbol {
        true => &usual,
        false => unit,
    };
    (drawn.text().to_owned(), drawn.unit())
}

/// The unit that differences of values are drawn in: of temperatures in degC it is K.
pub(crate) fn difference_in(unit: &NamedUnit) -> (String, Unit) {
    match unit.unit().is_absolute() {
        true => drawn_in(&NamedUnit::usual(unit.unit().dimension)),
        false => drawn_in(unit),
    }
}

fn error(channel: &Channel) -> Panel {
    let (unit, of) = difference_in(&channel.unit);
    let difference = channel
        .measured
        .iter()
        .zip(&channel.simulated)
        .map(|(a, b)| of.from_si(a - b))
        .collect();
    time_panel(
        channel.name.clone(),
        shown(&unit),
        vec![Line::new("", channel.time.clone(), difference)],
    )
}

/// The states of the model, those of one unit in one panel.
fn states(program: &Program, results: &Results) -> Vec<Panel> {
    let mut groups: Vec<(String, Vec<usize>)> = Vec::new();
    let is_state = |name: &str| {
        program
            .unknowns
            .iter()
            .any(|block| block.differential && block.first.is_none() && block.name == name)
    };
    for (number, output) in program.outputs.iter().enumerate() {
        if output.auxiliary || !is_state(&output.name) {
            continue;
        }
        let (unit, _) = drawn_in(&output.unit);
        match groups.iter_mut().find(|(known, _)| *known == unit) {
            Some((_, list)) => list.push(number),
            None => groups.push((unit, vec![number])),
        }
    }
    let line = |number: &usize| {
        let (_, unit) = drawn_in(&program.outputs[*number].unit);
        let values = results.column(*number).unwrap_or_default();
        let values = values.iter().map(|&si| unit.from_si(si)).collect();
        Line::new(
            program.outputs[*number].name.clone(),
            results.time.clone(),
            values,
        )
    };
    groups
        .iter()
        .take(MAX_PANELS)
        .map(|(unit, list)| time_panel("", shown(unit), list.iter().take(6).map(line).collect()))
        .collect()
}

/// A pure number has no unit on its axis.
pub(crate) fn shown(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}
