//! What is in traces: a screen a file, as JSON, and as a page.

mod page;
mod text;

pub use page::page;
pub use text::screen;

use hyde_signal::Table;
use hyde_study::traces::{Seen, Unread};
use serde_json::{Value, json};

/// All files as one JSON object.
#[must_use]
pub fn json(seen: &[Seen], failed: &[Unread]) -> Value {
    let files: Vec<Value> = seen.iter().map(json_of).collect();
    let errors: Vec<Value> = failed
        .iter()
        .map(|f| json!({ "file": f.file, "error": f.message, "help": f.help }))
        .collect();
    json!({ "ok": failed.is_empty(), "files": files, "errors": errors })
}

fn json_of(seen: &Seen) -> Value {
    let Seen {
        given, table, look, ..
    } = seen;
    let clocks: Vec<Value> = look
        .clocks
        .iter()
        .map(|clock| {
            json!({
                "samples": clock.rows, "start_s": clock.start_s, "length_s": clock.length_s, "step_s": clock.step_s,
                "jitter_s": clock.jitter_s, "drift_ppm": clock.drift_ppm,
                "gaps": clock.gaps.iter().map(|(from, long)| json!({ "from_s": from, "length_s": long })).collect::<Vec<_>>(),
                "doubles_s": clock.doubles,
            })
        })
        .collect();
    let channels: Vec<Value> = look
        .channels
        .iter()
        .map(|channel| {
            let s = &channel.sampled;
            json!({
                "name": channel.name, "meaning": channel.meaning, "unit": channel.unit, "clock": channel.clock,
                "guessed_unit": channel.guessed.as_ref().map(|(unit, why)| json!({ "unit": unit, "why": why })),
                "role": channel.shown.role.to_string(), "reference": channel.shown.reference, "why": channel.shown.why,
                "min": s.range.0, "max": s.range.1, "step": s.step, "noise": s.noise,
                "stuck": s.stuck.map(|held| json!({ "from_s": held.from_s, "to_s": held.to_s, "value": held.value })),
                "saturated_below": s.saturated_below.map(|limit| json!({ "value": limit.value, "samples": limit.samples })),
                "saturated": s.saturated.map(|limit| json!({ "value": limit.value, "samples": limit.samples })),
                "wraps": s.wraps.map(|wrap| json!({ "period": wrap.period, "times": wrap.times })),
                "spikes_s": s.spikes,
            })
        })
        .collect();
    let delays: Vec<Value> = look
        .delays
        .iter()
        .map(|d| json!({ "leads": d.leads, "follows": d.follows, "by_s": d.by_s, "correlation": d.correlation }))
        .collect();
    json!({
        "file": given.path.to_string_lossy(),
        "layout": layout_of(table),
        "assumptions": look.notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "clocks": clocks, "channels": channels, "delays": delays,
        "unusable": look.unusable.iter().map(|u| json!({ "name": u.name, "why": u.fault.message, "help": u.fault.repair })).collect::<Vec<_>>(),
        "line": seen.line(),
        "without_unit": seen.without_units(),
    })
}

/// The layout in words.
fn layout_of(table: &Table) -> String {
    table
        .layout()
        .map_or_else(|| "Parquet".to_owned(), |kind| kind.to_string())
}
