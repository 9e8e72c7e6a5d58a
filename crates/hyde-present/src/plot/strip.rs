//! The strip under a plot over time, from the files that a run left beside its results.

use hyde_report::{EventRow, EventStrip, Span};
use hyde_study::world::{World, read_text};
use serde_json::Value;
use std::path::Path;

/// No more automata than these are shown; those that change most often come first.
const ROWS: usize = 12;

/// The modes over time, from the event log and the summary beside the results, and ticks where a `when` or an `if` took
/// place. None without a log. With names, the modes of these only.
pub(super) fn beside(
    world: &dyn World,
    results: &Path,
    (first, last): (f64, f64),
    names: &[String],
) -> Result<Option<EventStrip>, String> {
    let log = world.read(&results.with_file_name("events.csv")).ok();
    let Some(log) = log.and_then(|log| hyde_signal::read_frame(&log).ok()) else {
        return Ok(None);
    };
    let mut automata: Vec<Automaton> = Vec::new();
    let mut ticks: [(&str, Vec<f64>); 2] = [("when", Vec::new()), ("if", Vec::new())];
    if let (Some(times), Some(what), Some(before), Some(after)) = (
        log.numbers("t"),
        log.texts("what"),
        log.texts("before"),
        log.texts("after"),
    ) {
        for (row, t) in times.iter().enumerate() {
            if let Some((_, ticks)) = ticks.iter_mut().find(|(kind, _)| *kind == what[row]) {
                ticks.push(*t);
                continue;
            }
            let known = automata.iter().position(|known| known.name == what[row]);
            let known = known.unwrap_or_else(|| {
                automata.push(Automaton::new(&what[row], &before[row]));
                automata.len() - 1
            });
            automata[known].changes.push((*t, after[row].clone()));
        }
    }
    for (name, mode) in unchanged(world, &results.with_file_name("summary.json")) {
        if automata.iter().all(|known| known.name != name) {
            automata.push(Automaton::new(&name, &mode));
        }
    }
    if names.is_empty() {
        // Stable: those that change equally often stay in the order of their first change.
        automata.sort_by_key(|automaton| std::cmp::Reverse(automaton.changes.len()));
        automata.truncate(ROWS);
    } else {
        automata = asked(automata, names)?;
        ticks = ticks.map(|(kind, _)| (kind, Vec::new()));
    }
    let mut rows: Vec<EventRow> = automata
        .iter()
        .map(|automaton| automaton.row(first, last))
        .collect();
    for (kind, ticks) in ticks {
        if ticks.iter().any(|t| (first..=last).contains(t)) {
            rows.push(EventRow {
                label: kind.to_owned(),
                ticks,
                ..EventRow::default()
            });
        }
    }
    Ok((!rows.is_empty()).then_some(EventStrip { rows }))
}

/// The automata of these names, in their order.
fn asked(automata: Vec<Automaton>, names: &[String]) -> Result<Vec<Automaton>, String> {
    let mut found = Vec::new();
    for name in names {
        let known = automata.iter().find(|known| known.name == *name);
        found.push(known.cloned().ok_or_else(|| {
            let list: Vec<&str> = automata.iter().map(|known| known.name.as_str()).collect();
            format!("`{name}` has no modes; there are `{}`", list.join("`, `"))
        })?);
    }
    Ok(found)
}

/// The modes of an automaton: the first one, then each with its instant.
#[derive(Clone)]
struct Automaton {
    name: String,
    begins: String,
    changes: Vec<(f64, String)>,
}

impl Automaton {
    fn new(name: &str, begins: &str) -> Self {
        Self {
            name: name.to_owned(),
            begins: begins.to_owned(),
            changes: Vec::new(),
        }
    }

    /// The modes between two instants.
    fn row(&self, first: f64, last: f64) -> EventRow {
        let begin = std::iter::once((f64::NEG_INFINITY, &self.begins));
        let changes = self.changes.iter().map(|(t, mode)| (*t, mode));
        let ends = changes.clone().map(|(t, _)| t).chain([f64::INFINITY]);
        let spans = begin
            .chain(changes)
            .zip(ends)
            .map(|((from, mode), to)| Span {
                from: from.max(first),
                to: to.min(last),
                label: mode.clone(),
            });
        EventRow {
            label: self.name.clone(),
            spans: spans.filter(|span| span.to > span.from).collect(),
            ..EventRow::default()
        }
    }
}

/// The automata that were in one of their modes all the time, which the log does not have.
fn unchanged(world: &dyn World, summary: &Path) -> Vec<(String, String)> {
    let text = read_text(world, summary).unwrap_or_default();
    let summary: Value = serde_json::from_str(&text).unwrap_or_default();
    let mut found = Vec::new();
    for (name, modes) in summary["mode_seconds"].as_object().into_iter().flatten() {
        if modes.as_object().is_none_or(|modes| modes.len() < 2) {
            continue;
        }
        let spent = |seconds: &Value| seconds.as_f64().is_some_and(|seconds| seconds > 0.0);
        let mut in_use = modes
            .as_object()
            .into_iter()
            .flatten()
            .filter(|(_, seconds)| spent(seconds));
        if let (Some((mode, _)), None) = (in_use.next(), in_use.next()) {
            found.push((name.clone(), mode.clone()));
        }
    }
    found
}
