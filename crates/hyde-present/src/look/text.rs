//! What `hyde look` prints: a screen a file, 80 columns wide.

use super::layout_of;
use crate::lines::wrapped;
use hyde_signal::Unusable;
use hyde_signal::look::{Channel, Clock};
use hyde_study::traces::Seen;
use hyde_units::{counted, significant};
use std::fmt::Write as _;

/// What a column with a fault cannot do.
pub(super) fn limit(column: &Unusable) -> &'static str {
    match column.readings {
        Some(_) => "can be compared with a model, but not drive it",
        None => "cannot be used",
    }
}

/// One file.
pub fn screen(seen: &Seen) -> String {
    let look = &seen.look;
    let mut out = String::new();
    let name = seen.given.path.display();
    let _ = writeln!(out, "{name}: {}", layout_of(&seen.table));
    for (number, clock) in look.clocks.iter().enumerate() {
        let own: Vec<&str> = look
            .channels
            .iter()
            .filter(|channel| channel.clock == number && number > 0)
            .map(|channel| channel.name.as_str())
            .collect();
        let own = if own.is_empty() {
            String::new()
        } else {
            format!(": {}", own.join(", "))
        };
        paragraph(&mut out, &format!("{}{own}", samples(clock)));
        for finding in of_clock(clock) {
            paragraph(&mut out, &finding);
        }
    }
    out.push('\n');
    let name = |channel: &Channel| fitted(&channel.name, 24);
    let widest = look
        .channels
        .iter()
        .map(|c| name(c).chars().count())
        .max()
        .unwrap_or(0)
        .max(7);
    let _ = writeln!(
        out,
        "  {:widest$} {:8} {:18} {:>21}",
        "channel", "unit", "shows", "range"
    );
    for channel in &look.channels {
        let unit = match (&channel.unit, &channel.guessed) {
            (Some(unit), _) => unit.clone(),
            (None, Some((unit, _))) => format!("{unit}?"),
            (None, None) => "-".to_owned(),
        };
        let (low, high) = channel.sampled.range;
        let range = format!("{} .. {}", significant(low, 4), significant(high, 4));
        let line = format!(
            "  {:widest$} {unit:8} {:18} {range:>21}",
            name(channel),
            channel.shown.to_string()
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out.push('\n');
    for channel in &look.channels {
        let findings = of_channel(channel);
        if !findings.is_empty() {
            paragraph(
                &mut out,
                &format!("{}: {}", channel.name, findings.join("; ")),
            );
        }
    }
    for delay in &look.delays {
        paragraph(&mut out, &delayed(delay));
    }
    for unusable in &look.unusable {
        paragraph(
            &mut out,
            &format!("{}: {}", limit(unusable), unusable.fault.message),
        );
    }
    if let Some(first) = look.unusable.first() {
        paragraph(&mut out, &format!("help: {}", first.fault.repair));
    }
    for note in &look.notes {
        paragraph(&mut out, &format!("note: {note}"));
    }
    let _ = writeln!(out, "\nIn an experiment:\n  {}", seen.line());
    let bare = seen.without_units();
    if let Some(first) = bare.first() {
        let list = bare.join(", ");
        paragraph(
            &mut out,
            &format!(
                "The file does not say the unit of {list}. Say each in parentheses behind the file: `column = {first:?} in [UNIT]`"
            ),
        );
    }
    out
}

fn paragraph(out: &mut String, text: &str) {
    for (number, line) in wrapped(text, 74).iter().enumerate() {
        let _ = writeln!(out, "{}{line}", if number == 0 { "  " } else { "    " });
    }
}

fn fitted(text: &str, width: usize) -> String {
    match text.chars().count() > width {
        true => text.chars().take(width - 1).chain(['…']).collect(),
        false => text.to_owned(),
    }
}

pub(super) fn samples(clock: &Clock) -> String {
    let step = significant(clock.step_s * 1e3, 6);
    format!(
        "{}, {step} ms apart, from {} s for {} s",
        counted(clock.rows, "sample"),
        significant(clock.start_s, 6),
        significant(clock.length_s, 6)
    )
}

/// What is odd about a clock.
pub(super) fn of_clock(clock: &Clock) -> Vec<String> {
    let mut found = Vec::new();
    if let Some((from, long)) = clock.gaps.first() {
        found.push(format!(
            "{}, the first at {} s, {} s long",
            counted(clock.gaps.len(), "gap"),
            significant(*from, 6),
            significant(*long, 3)
        ));
    }
    if let Some(first) = clock.doubles.first() {
        found.push(format!(
            "{} with the time of the one before, the first at {} s",
            counted(clock.doubles.len(), "sample"),
            significant(*first, 6)
        ));
    }
    if clock.jitter_s > 0.01 * clock.step_s {
        found.push(format!(
            "jitter of {} ms (standard deviation)",
            significant(1e3 * clock.jitter_s, 3)
        ));
    }
    if clock.drift_ppm.abs() > 50.0 {
        found.push(format!(
            "the clock drifts: its steps are {} ppm longer than the usual one on average",
            significant(clock.drift_ppm, 3)
        ));
    }
    found
}

/// What is odd about a channel, and why it shows what it shows.
pub(super) fn of_channel(channel: &Channel) -> Vec<String> {
    let sampled = &channel.sampled;
    let unit = channel
        .unit
        .as_ref()
        .map_or_else(String::new, |unit| format!(" {unit}"));
    let mut found = channel.shown.why.clone();
    if let Some(meaning) = &channel.meaning {
        found.insert(0, format!("shows `{meaning}`"));
    }
    if let Some((unit, why)) = &channel.guessed {
        found.push(format!("its unit may be {unit}: {why}"));
    }
    if let Some(step) = sampled.step {
        found.push(format!("step {}{unit}", significant(step, 4)));
    }
    let span = sampled.range.1 - sampled.range.0;
    if sampled.noise > 1e-6 * span {
        found.push(format!("noise {}{unit}", significant(sampled.noise, 2)));
    }
    if let Some(held) = sampled.stuck {
        found.push(format!(
            "stuck at {}{unit} from {} s to {} s",
            significant(held.value, 4),
            significant(held.from_s, 6),
            significant(held.to_s, 6)
        ));
    }
    for limit in sampled.saturated.iter().chain(&sampled.saturated_below) {
        found.push(format!(
            "saturated at {}{unit} in {}",
            significant(limit.value, 4),
            counted(limit.samples, "sample")
        ));
    }
    if let Some(wrap) = sampled.wraps {
        found.push(format!(
            "overflows after {}, {}: `wraps {}`",
            significant(wrap.period, 6),
            counted(wrap.times, "time"),
            significant(wrap.period, 10)
        ));
    }
    if let Some(first) = sampled.spikes.first() {
        let spikes = counted(sampled.spikes.len(), "spike");
        found.push(format!(
            "{spikes}, the first at {} s",
            significant(*first, 6)
        ));
    }
    found
}

pub(super) fn delayed(delay: &hyde_signal::look::Delay) -> String {
    format!(
        "{} follows {} {} ms later (correlation {})",
        delay.follows,
        delay.leads,
        significant(1e3 * delay.by_s, 3),
        significant(delay.correlation, 3)
    )
}
