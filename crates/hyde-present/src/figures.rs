//! The figures of a run: those asked for; where something was measured, it beside the simulated, each with the residual below;
//! then what the run is about. The modes stand below.

use crate::thinned::thinned;
use crate::{asked_figures, panels};
use hyde_experiment::{Channel, Run};
use hyde_program::Program;
use hyde_report::{
    EventRow, EventStrip, Figure, Line, LineStyle, Panel, Span, time_panel, time_plot,
};
use hyde_sim::{EventKind, Results};
use hyde_units::{difference_in, drawn_in, shown};

/// Measured channels in one figure.
const MAX_CHANNELS: usize = 4;

/// Stretches of a long curve of which the extremes are drawn: many for each pixel of the widest figure.
const STRETCHES: usize = 20_000;

/// The figures of a run, the most telling first.
pub fn of_run(title: &str, program: &Program, run: &Run) -> Vec<Figure> {
    let asked = asked_figures::of_run(program, run);
    let mut figures: Vec<Figure> = asked.into_iter().map(|(_, figure)| figure).collect();
    let strip = strip(program, &run.results, run.stop_s);
    if run.channels.is_empty() {
        figures.push(time_plot(title, panels::of_run(program, run), strip));
        return figures;
    }
    let both = run.channels.iter().take(MAX_CHANNELS);
    let both = both.flat_map(|channel| [measured_and_simulated(channel), residual(channel)]);
    let more = run.channels.len().saturating_sub(MAX_CHANNELS);
    let mut caption =
        "Measured and simulated, below each the residual, measured − simulated.".to_owned();
    if more > 0 {
        caption += &format!(" {more} more in the table.");
    }
    let compared = time_plot(title, both.collect(), strip.clone()).with_caption(caption);
    let rest = time_plot(
        format!("{title}: variables"),
        panels::of_run(program, run),
        strip,
    );
    figures.extend([compared, rest]);
    figures
}

/// The modes of every automaton over time.
pub fn strip(program: &Program, results: &Results, stop_s: f64) -> Option<EventStrip> {
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

/// Measured − simulated.
fn residual(channel: &Channel) -> Panel {
    let (unit, of) = difference_in(&channel.unit);
    let difference = channel
        .measured
        .iter()
        .zip(&channel.simulated)
        .map(|(a, b)| of.from_si(a - b))
        .collect();
    time_panel(
        "residual",
        shown(&unit),
        vec![Line::new("", channel.time.clone(), difference)],
    )
}

/// An output over time, in the unit that it is drawn in.
pub fn curve(name: &str, output: usize, program: &Program, run: &Run) -> Line {
    let (_, unit) = drawn_in(&program.outputs[output].unit);
    let values = run.results.column(output).unwrap_or_default();
    let (time, values) = thinned(&run.results.time, &values, STRETCHES);
    let values = values.into_iter().map(|si| unit.from_si(si)).collect();
    Line::new(name, time, values)
}
