//! Errors before and after a calibration or a diagnosis, as text and as JSON.

use crate::diagnosed::wrapped;
use hyde_calibrate::Recording;
use hyde_study::Calibration;
use hyde_study::comparison::{Change, RecordErrors, assumptions, over, recordings, told};
use hyde_units::{NamedUnit, engineering_difference, significant};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The errors as JSON; numbers are SI.
pub fn json(records: &[RecordErrors], calibration: &Calibration) -> Value {
    let measured = &calibration.compiled.program.experiment.measured;
    let deviations = &calibration.observer.deviations;
    let change = |change: Change| {
        json!({
            "before": change.before,
            "after": change.after,
            "floor": change.floor,
            "before_over_floor": change.before / change.floor,
            "after_over_floor": change.after / change.floor,
        })
    };
    let of_record = |(record, recording): (&RecordErrors, &Recording)| {
        let channels: Vec<Value> = measured
            .iter()
            .enumerate()
            .map(|(number, measured)| {
                let (before, after) = (
                    &record.before.innovations[number],
                    &record.after.innovations[number],
                );
                json!({
                    "channel": measured.name,
                    "unit": measured.unit.unit().dimension.usual_unit(),
                    "noise": record.after.noise[number],
                    "chi": { "before": before.chi, "after": after.chi },
                    "correlation": { "before": before.correlation, "after": after.correlation },
                    "innovations": change(record.innovations(number, deviations)),
                    "windows": change(record.windows(number)),
                    "free_run": record.free(number).map(change),
                })
            })
            .collect();
        json!({
            "record": record.after.record,
            "holdout": record.holdout,
            "chi": { "before": record.before.chi, "after": record.after.chi },
            "no_free_run": record.no_free_run(),
            "assumptions": told(calibration, recording),
            "begins": recording.beginning.iter().cloned().collect::<BTreeMap<String, f64>>(),
            "resampled": recording.uneven.as_ref().map(|own| json!({
                "record": own.record,
                "closest_s": own.spacing_s.0,
                "widest_s": own.spacing_s.1,
                "from_s": own.from_s,
                "every_s": own.step_s,
            })),
            "channels": channels,
        })
    };
    let pairs = records.iter().zip(recordings(calibration));
    Value::Array(pairs.map(of_record).collect())
}

/// The errors in lines of at most 80 columns.
pub fn text(records: &[RecordErrors], calibration: &Calibration) -> String {
    let measured = &calibration.compiled.program.experiment.measured;
    let deviations = &calibration.observer.deviations;
    let mut out = String::new();
    let _ = writeln!(
        out,
        "  {:<32} {:>9} {:>9}   1 is noise",
        "mean square of innovations", "before", "after"
    );
    for record in records {
        let name = match record.holdout {
            true => format!("{} (held out)", record.after.record),
            false => record.after.record.clone(),
        };
        let _ = writeln!(
            out,
            "  {:<32} {:>9} {:>9}",
            shortened(&name, 32),
            significant(record.before.chi, 4),
            significant(record.after.chi, 4)
        );
    }
    for sentence in assumptions(calibration) {
        wrapped(&mut out, "  -", &sentence);
    }
    let held_out = records.iter().any(|record| record.holdout);
    let shown = || {
        records
            .iter()
            .filter(move |record| record.holdout == held_out)
    };
    let where_ = if held_out { ", held out" } else { "" };
    let table = |out: &mut String, title: &str, of: &dyn Fn(usize) -> Option<Change>| {
        let _ = writeln!(
            out,
            "\n  {:<32} {:>11} {:>11}   rel. to noise floor",
            format!("{title}{where_}"),
            "before",
            "after"
        );
        for (number, channel) in measured.iter().enumerate() {
            let Some(change) = of(number) else {
                continue;
            };
            let _ = writeln!(out, "{}", line(&channel.name, change, &channel.unit));
        }
    };
    table(&mut out, "rms of innovations", &|number| {
        over(shown(), |record| {
            Some(record.innovations(number, deviations))
        })
    });
    // A record may be too short for a window behind its `skip`, a channel may have no reading in one.
    let windows = |number: usize| {
        let known = shown().filter(|record| record.windows(number).after.is_finite());
        over(known, |record| Some(record.windows(number)))
    };
    match (0..measured.len()).any(|number| windows(number).is_some()) {
        true => table(&mut out, "rms of 100 ms windows", &windows),
        false => out.push_str("\n  no compared record has a window of 100 ms\n"),
    }
    match shown().find_map(RecordErrors::no_free_run) {
        None => table(&mut out, "rms of the free run", &|number| {
            over(shown(), |record| record.free(number))
        }),
        Some(reason) => {
            let _ = writeln!(out, "\n  there is no free run: {reason}");
        }
    }
    out
}

/// Half an interval as a part of the value, or as it is where it is wider than the value.
pub fn spread(half: f64, value: f64, number: impl Fn(f64) -> String) -> String {
    if half < value.abs() {
        format!("{} %", significant(100.0 * half / value.abs(), 2))
    } else {
        number(half)
    }
}

/// A name with its middle left out where it is too long.
pub fn shortened(name: &str, width: usize) -> String {
    let letters: Vec<char> = name.chars().collect();
    if letters.len() <= width {
        return name.to_owned();
    }
    let head = (width - 1) / 2;
    let tail = letters.len() - (width - 1 - head);
    let part = |list: &[char]| list.iter().collect::<String>();
    format!("{}…{}", part(&letters[..head]), part(&letters[tail..]))
}

fn line(name: &str, change: Change, unit: &NamedUnit) -> String {
    let times = |value: f64| significant(value / change.floor, 3);
    format!(
        "  {:<32} {:>11} {:>11}   {} -> {}",
        shortened(name, 32),
        engineering_difference(change.before, unit),
        engineering_difference(change.after, unit),
        times(change.before),
        times(change.after)
    )
}
