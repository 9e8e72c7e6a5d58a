//! The comparison of signals on the console and as JSON.

use super::text;
use crate::lines::wrapped;
use hyde_calibrate::UNKNOWN;
use hyde_study::excitation::{Compared, Comparison, Criterion};
use hyde_units::{counted, engineering_as, engineering_difference, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// In lines of at most 80 columns.
pub fn text(found: &Comparison, criterion: Criterion, path: Option<&Path>) -> String {
    let Comparison {
        bench,
        wished,
        all,
        best,
        unmade,
    } = found;
    let best = &all[*best];
    let by = match (&best.apart, criterion) {
        (Some(_), _) => "by what distinguishes the effects",
        (None, Criterion::D) => "by volume",
        (None, Criterion::A) => "by spread",
    };
    let mut out = format!(
        "{} of {}: {} of `{}`, {} compared {by}\n\n  {:<36} {:>9} {:>9}",
        bench.plan.name,
        bench.plan.model,
        significant(wished.wish.duration_s, 6) + " s",
        bench.column.1,
        counted(all.len(), "signal"),
        "signal",
        "volume",
        "spread"
    );
    out.push_str(if best.apart.is_some() {
        "     apart\n"
    } else {
        "\n"
    });
    for own in all {
        let mark = if own.name == best.name { '*' } else { ' ' };
        let _ = write!(
            out,
            "{mark} {:<36} {:>9} {:>9}",
            own.name,
            significant(own.information.volume, 3),
            significant(own.information.spread, 3)
        );
        if let Some(apart) = &own.apart {
            let _ = write!(out, " {:>9}", significant(apart.least, 3));
        }
        out.push('\n');
    }
    for (name, reason) in unmade {
        let reason = reason.lines().next().unwrap_or_default();
        for (number, line) in wrapped(&format!("{name}: {reason}"), 74).iter().enumerate() {
            let head = if number == 0 { "  - " } else { "    " };
            let _ = writeln!(out, "{head}{line}");
        }
    }
    out.push_str(
        "\n  volume and spread: geometric and quadratic mean of the expected standard\n  \
         deviations, relative to those before the record\n",
    );
    if let Some(apart) = &best.apart {
        out.push_str(
            "  apart: smallest gain of an effect over another one, relative to its threshold;\n  \
             above 1 the record distinguishes them\n",
        );
        out.push('\n');
        for (number, name) in apart.names.iter().enumerate() {
            let over = apart.separation.over[number].iter().enumerate();
            let over = over.filter(|(other, _)| *other != number);
            let least = over
                .filter_map(|(_, gain)| *gain)
                .fold(f64::INFINITY, f64::min);
            let alone = apart.separation.alone[number].unwrap_or(f64::NAN);
            let _ = writeln!(
                out,
                "  {name}: gain {}, over the others {}, threshold {}",
                significant(alone, 3),
                significant(least, 3),
                significant(apart.separation.thresholds[number], 3)
            );
        }
    }
    let program = &bench.compiled.program;
    let _ = writeln!(
        out,
        "\n  {:<24} {:>14} {:>12} {:>12}",
        "standard deviation of", "declared", "before", "expected"
    );
    for (number, varied) in bench.varied.iter().enumerate() {
        let unit = program.parameter(&varied.name).map(|(p, _)| &p.unit);
        let shown =
            |value: f64| unit.map_or_else(|| significant(value, 4), |u| engineering_as(value, u));
        let width = |value: f64| {
            unit.map_or_else(
                || significant(value, 3),
                |u| engineering_difference(value, u),
            )
        };
        let part = best.information.parts[number];
        let expected = match part < 1e-3 * UNKNOWN {
            true => width(best.information.deviations[number]),
            false => "unknown".to_owned(),
        };
        let note = match varied.prior {
            Some(_) if part > 0.9 => "  prior only",
            Some(_) | None => "",
        };
        let _ = writeln!(
            out,
            "  {:<24} {:>14} {:>12} {:>12}{note}",
            varied.name,
            shown(varied.nominal),
            varied.prior.map_or_else(|| "-".to_owned(), width),
            expected
        );
    }
    if best.part < 1.0 {
        let _ = writeln!(
            out,
            "\n  the travel or the speed of the model limits the signal to {} of its size",
            significant(best.part, 3)
        );
    }
    let _ = write!(
        out,
        "\n{}",
        text::text(Some(&best.name), wished, &best.design, path)
    );
    out
}

/// Numbers are SI.
pub fn json(found: &Comparison) -> Value {
    let best = &found.all[found.best];
    let signals: Vec<Value> = found.all.iter().map(of_signal).collect();
    let unmade: Vec<Value> = found
        .unmade
        .iter()
        .map(|(name, reason)| json!({ "signal": name, "reason": reason }))
        .collect();
    let parameters: Vec<Value> = found
        .bench
        .varied
        .iter()
        .enumerate()
        .map(|(number, varied)| {
            json!({
                "name": varied.name, "declared": varied.nominal, "prior_deviation": varied.prior,
                "deviation": best.information.deviations[number],
            })
        })
        .collect();
    let mut all = text::json(&found.wished, &best.design);
    all["signal"] = json!(best.name);
    all["calibration"] = json!(found.bench.plan.name);
    all["model"] = json!(found.bench.plan.model);
    all["column"] = json!(found.bench.column.1);
    all["chosen"] = json!(best.name);
    all["signals"] = json!(signals);
    all["not_possible"] = json!(unmade);
    all["parameters"] = json!(parameters);
    all["part"] = json!(best.part);
    all
}

fn of_signal(own: &Compared) -> Value {
    let apart = own.apart.as_ref().map(|apart| {
        json!({
            "effects": apart.names, "least": apart.least, "alone": apart.separation.alone,
            "over": apart.separation.over, "thresholds": apart.separation.thresholds,
        })
    });
    json!({
        "signal": own.name, "volume": own.information.volume, "spread": own.information.spread,
        "deviations": own.information.deviations, "part": own.part, "apart": apart,
    })
}
