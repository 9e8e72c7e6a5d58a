//! A design on the console and as JSON.

use hyde_signal::excite::{Bounds, Design, Quantity};
use hyde_study::excitation::Wished;
use hyde_study::excitation::refused::name;
use hyde_units::{NamedUnit, counted, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// In lines of at most 80 columns, under its name among others if it has been compared with them.
pub fn text(
    known_as: Option<&str>,
    wished: &Wished,
    design: &Design,
    out: Option<&Path>,
) -> String {
    let wish = &design.wish;
    let mut text = format!(
        "{}: {} s, {} every {} ms\n",
        known_as.map_or_else(|| wish.shape.to_string(), str::to_owned),
        significant(wish.duration_s, 6),
        counted(design.rows(), "sample"),
        significant(wish.step_s * 1e3, 6)
    );
    if let Some(lines) = design.lines {
        let _ = writeln!(
            text,
            "  {} from {} Hz, {} Hz apart; crest factor {}",
            counted(lines.count, "line"),
            significant(lines.first_hz, 4),
            significant(lines.apart_hz, 4),
            significant(lines.crest, 3)
        );
    }
    if !design.legs.is_empty() {
        let speeds = design.legs.iter().map(|leg| leg.speed);
        let (low, high) = speeds.fold((f64::INFINITY, 0.0_f64), |(low, high), speed| {
            (low.min(speed), high.max(speed))
        });
        let unit = unit_of(&wish.unit, Quantity::Speed);
        let _ = writeln!(
            text,
            "  {} at {} to {}",
            counted(design.legs.len(), "move"),
            shown(low, &unit),
            shown(high, &unit)
        );
    }
    let _ = writeln!(text, "\n  {:<14} {:>14} {:>14}", "", "reached", "limit");
    for peak in &design.peaks {
        let unit = unit_of(&wish.unit, peak.quantity);
        let _ = writeln!(
            text,
            "  {:<14} {:>14} {:>14} {:>6} %",
            name(peak.quantity),
            shown(peak.reached, &unit),
            shown(peak.limit, &unit),
            significant(100.0 * peak.part(), 3)
        );
    }
    text.push('\n');
    if let Bounds::Motion(limits) = wish.bounds {
        let unit = &wish.unit;
        let _ = writeln!(
            text,
            "  the axis begins and ends at {}, in the middle of its travel of {}",
            shown(wish.start, unit),
            shown(limits.travel, unit)
        );
    } else if known_as.is_none() {
        text.push_str("  the travel of the axis is not checked: that takes a model\n");
    }
    if let Some(quantity) = design.slowed_by {
        let _ = writeln!(
            text,
            "  the {} limits the speed: ramps take at most half of each stroke",
            name(quantity)
        );
    }
    if !wished.assumed.is_empty() {
        text.push_str("  assumed, as no option says otherwise:\n");
        for option in &wished.assumed {
            let _ = writeln!(text, "    {option}");
        }
    }
    if let Some(path) = out {
        let _ = writeln!(text, "\n  the signal is in {}", path.display());
    }
    text.trim_end().to_owned()
}

/// Numbers are SI.
pub fn json(wished: &Wished, design: &Design) -> Value {
    let wish = &design.wish;
    let peaks: Vec<Value> = design
        .peaks
        .iter()
        .map(|peak| {
            json!({ "quantity": name(peak.quantity), "reached": peak.reached, "limit": peak.limit })
        })
        .collect();
    let moves: Vec<Value> = design
        .legs
        .iter()
        .map(|leg| {
            json!({
                "begin_s": leg.begin_s, "to": leg.to + wish.start, "speed": leg.speed, "move_s": leg.move_s,
                "dwell_s": leg.dwell_s,
            })
        })
        .collect();
    json!({
        "ok": true,
        "signal": wish.shape.to_string(),
        "column": wished.column,
        "unit": wish.unit.text(),
        "duration_s": wish.duration_s,
        "step_s": wish.step_s,
        "samples": design.rows(),
        "start": wish.start,
        "limits": peaks,
        "lines": design.lines.map(|lines| json!({
            "first_hz": lines.first_hz, "apart_hz": lines.apart_hz, "count": lines.count, "crest_factor": lines.crest,
        })),
        "moves": moves,
        "speed_limited_by": design.slowed_by.map(name),
        "assumed": wished.assumed,
    })
}

/// The unit of a derivative of a column.
fn unit_of(unit: &NamedUnit, quantity: Quantity) -> NamedUnit {
    let per = match quantity {
        Quantity::Travel | Quantity::Effort => return unit.clone(),
        Quantity::Speed => "s",
        Quantity::Acceleration => "s2",
        Quantity::Jerk => "s3",
    };
    NamedUnit::parse(&format!("{unit}/{per}")).unwrap_or_else(|_| unit.clone())
}

fn shown(si: f64, unit: &NamedUnit) -> String {
    let unit_value = unit.unit();
    // Of a scale the difference to its zero point.
    let value = (si - unit_value.to_si(0.0)) / unit_value.difference_to_si(1.0);
    format!("{} {unit}", significant(value, 4))
}
