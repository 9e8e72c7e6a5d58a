//! What a batch says as a whole, for people and as JSON for programs.

use crate::assumptions;
use hyde_experiment::batch::{QUANTILES, Summary};
use hyde_study::sweep::{Prepared, Took};
use hyde_units::{counted, engineering_as, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// How many measures stand beside each other in the table of correlations.
const BESIDE: usize = 4;
/// How many inputs are told of: those that matter most.
const INPUTS: usize = 12;

/// The summary in a few lines; `rerun` is the command of a case, without its number.
pub fn text(batch: &Prepared, summary: &Summary, took: Took, rerun: &str) -> String {
    let mut out = String::new();
    let (name, experiment, model) = (
        &batch.draft.name,
        &batch.draft.experiment,
        &batch.project.model,
    );
    let _ = write!(
        out,
        "{name} of {experiment} of {model}: {}, {} failed",
        counted(summary.cases, "case"),
        summary.failed
    );
    if took.solved > 0 {
        let seconds = took.wall.as_secs_f64();
        let rate = took.solved as f64 / seconds.max(1e-9);
        let _ = write!(
            out,
            "; {} solved in {} s, {} a second",
            took.solved,
            significant(seconds, 2),
            significant(rate, 2)
        );
    } else {
        out.push_str("; all were already solved");
    }
    out.push('\n');
    if !summary.measures.is_empty() {
        let _ = writeln!(
            out,
            "\n  {:<24} {:>12} {:>12} {:>12} {:>12}",
            "", "least", "median", "95 %", "largest"
        );
    }
    for measure in &summary.measures {
        let known = &batch.dataset.measures[measure.measure];
        let cell = |at: usize| engineering_as(measure.quantiles[at], &known.unit);
        let _ = writeln!(
            out,
            "  {:<24} {:>12} {:>12} {:>12} {:>12}",
            known.name,
            cell(0),
            cell(3),
            cell(5),
            cell(6)
        );
    }
    for (measure, count, first) in &summary.broken {
        let name = &batch.dataset.measures[*measure].name;
        let _ = match first {
            None => writeln!(out, "  expect {name}: holds in all cases"),
            Some(first) => writeln!(
                out,
                "  expect {name}: does not hold in {count}, first in case {first}"
            ),
        };
    }
    for group in summary.measures.chunks(BESIDE) {
        let mut inputs: Vec<(usize, f64)> = Vec::new();
        for (input, value) in group.iter().flat_map(|measure| &measure.correlations) {
            match inputs.iter_mut().find(|(known, _)| known == input) {
                Some((_, most)) => *most = most.max(value.abs()),
                None => inputs.push((*input, value.abs())),
            }
        }
        inputs.sort_by(|a, b| b.1.total_cmp(&a.1));
        if inputs.is_empty() {
            continue;
        }
        let _ = write!(out, "\n  {:<24}", "rank correlation");
        for measure in group {
            let _ = write!(out, " {:>12}", batch.dataset.measures[measure.measure].name);
        }
        out.push('\n');
        for (input, _) in inputs.iter().take(INPUTS) {
            let _ = write!(out, "  {:<24}", batch.plan.inputs[*input].name);
            for measure in group {
                let found = measure
                    .correlations
                    .iter()
                    .find(|(known, _)| known == input);
                let cell = found.map_or_else(String::new, |(_, value)| format!("{value:+.2}"));
                let _ = write!(out, " {cell:>12}");
            }
            out.truncate(out.trim_end().len());
            out.push('\n');
        }
    }
    let same = summary.measures.iter().filter(|measure| measure.same);
    let same: Vec<&str> = same
        .map(|measure| batch.dataset.measures[measure.measure].name.as_str())
        .collect();
    if !same.is_empty() {
        let (names, rtol) = (same.join(", "), batch.dataset.rtol);
        let _ = writeln!(
            out,
            "\n  the same in all cases, within rtol = {rtol:e} of it: {names}"
        );
    }
    if !summary.worst.is_empty() {
        out.push_str("\n  largest magnitudes\n");
    }
    for worst in &summary.worst {
        let known = &batch.dataset.measures[worst.measure];
        let value = engineering_as(worst.value, &known.unit);
        let _ = writeln!(
            out,
            "  {} = {value}: {rerun} --case {}",
            known.name, worst.case
        );
    }
    for (case, reason) in &summary.failures {
        let _ = writeln!(out, "  case {case} failed, {reason}: {rerun} --case {case}");
    }
    let more = summary.failed - summary.failures.len();
    if more > 0 {
        let _ = writeln!(
            out,
            "  and {more} more failed: column `reason` of the data set"
        );
    }
    out.push_str(&assumptions::text(&batch.notes));
    out
}

/// The summary as JSON: nothing in it depends on who solved the cases, or how long that took.
pub fn json(batch: &Prepared, summary: &Summary, rerun: &str) -> Value {
    let command = |case: usize| format!("{rerun} --case {case}");
    let measures: Vec<Value> = summary
        .measures
        .iter()
        .map(|measure| {
            let known = &batch.dataset.measures[measure.measure];
            let unit = known.unit.unit();
            let quantiles: Vec<Value> = QUANTILES
                .iter()
                .zip(measure.quantiles)
                .map(|(p, si)| json!({ "p": p, "value": unit.from_si(si) }))
                .collect();
            let correlations: Vec<Value> = measure
                .correlations
                .iter()
                .map(|(input, value)| json!({ "input": batch.plan.inputs[*input].name, "spearman": value }))
                .collect();
            json!({
                "name": known.name, "unit": known.unit.text(), "count": measure.count,
                "quantiles": quantiles, "same": measure.same, "rank_correlations": correlations,
            })
        })
        .collect();
    let worst: Vec<Value> = summary
        .worst
        .iter()
        .map(|worst| {
            let known = &batch.dataset.measures[worst.measure];
            json!({
                "measure": known.name, "value": known.unit.unit().from_si(worst.value), "unit": known.unit.text(),
                "case": worst.case, "command": command(worst.case),
            })
        })
        .collect();
    let failures: Vec<Value> = summary
        .failures
        .iter()
        .map(|(case, reason)| json!({ "case": case, "reason": reason, "command": command(*case) }))
        .collect();
    let broken: Vec<Value> = summary
        .broken
        .iter()
        .map(|(measure, count, first)| json!({ "text": batch.dataset.measures[*measure].name, "broken": count, "first": first }))
        .collect();
    json!({
        "event": "summary", "ok": true, "hyde": env!("CARGO_PKG_VERSION"), "batch": batch.parts.whole.to_string(),
        "sweep": batch.draft.name, "experiment": batch.draft.experiment, "model": batch.project.model,
        "cases": summary.cases, "failed": summary.failed,
        "measures": measures, "expectations": broken, "worst": worst, "failures": failures, "notes": batch.notes,
    })
}
