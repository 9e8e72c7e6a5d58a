//! What a diagnosis tells of the time of a command: that the model puts it out too late or too early, and what to write instead.

use super::Diagnosed;
use hyde_calibrate::{CommandTiming, Uncompared, Why};
use hyde_units::significant;

/// A text of the user's file that is to be another one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edit {
    /// The file, as messages call it.
    pub file: String,
    /// Its line, from 1.
    pub line: usize,
    /// What stands there.
    pub from: String,
    /// What is to stand there.
    pub to: String,
}

/// The commands that the model puts out at another time than the record.
pub fn wrong<'t>(told: &'t Diagnosed<'_>) -> impl Iterator<Item = &'t CommandTiming> {
    told.commands.timings.iter().filter(|own| own.late_s != 0.0)
}

/// `the model puts out nu 1 ms too late`
pub fn short(told: &Diagnosed<'_>, own: &CommandTiming) -> String {
    let late = if own.late_s > 0.0 { "late" } else { "early" };
    let command = command(told, own);
    match own.of_column {
        false => format!("the model puts out {command} {} too {late}", ms(own.late_s)),
        true => {
            let recorded = if own.late_s > 0.0 { "early" } else { "late" };
            format!(
                "the column of {command} was recorded {} too {recorded}",
                ms(own.late_s)
            )
        }
    }
}

/// What it stands on, and what to write: sentences without the stop at their ends.
pub fn about(told: &Diagnosed<'_>, own: &CommandTiming) -> Vec<String> {
    let percent = |part: f64| significant(100.0 * part, 2);
    let clock = clock(told, own.clock);
    let found = format!(
        "{}: along the measured motion, what {clock} puts out differs from the record by {} % of its rms, and by {} % if it is \
         moved by {}",
        short(told, own),
        percent(own.error),
        percent(own.error_moved),
        ms(own.late_s)
    );
    let axis = match own.of_column {
        false => {
            "the axis follows the recorded command at its own times, so the time is an error of the model"
        }
        true => "the axis follows the moved command better, so the time is an error of the record",
    };
    vec![found, format!("{axis}: {}", repair(told, own))]
}

fn repair(told: &Diagnosed<'_>, own: &CommandTiming) -> String {
    let clock = clock(told, own.clock);
    if own.of_column {
        let (late, by) = (own.late_s < 0.0, ms(own.late_s));
        let sign = if late { "subtract" } else { "add" };
        return format!(
            "the diagnosis has moved this column in all records; {sign} {by} in its times"
        );
    }
    if let Some(Edit {
        file,
        line,
        from,
        to,
    }) = edit(told, own)
    {
        return format!("write `{to}` instead of `{from}` ({file}:{line})");
    }
    let delay_s = own.delay_s - own.late_s;
    if delay_s >= 0.0 && delay_s <= own.period_s {
        return format!("the `delay` of the clock {clock} is to be {}", ms(delay_s));
    }
    format!(
        "{clock} has a delay, or a variable of the tick before, that the true controller does not have"
    )
}

/// The equation `u = pre(w)` that is the whole delay, without it.
pub fn edit(told: &Diagnosed<'_>, own: &CommandTiming) -> Option<Edit> {
    let replayed = &told.found.program.experiment.replayed[own.replayed];
    let span = replayed.register.as_ref()?.span;
    let whole = (own.late_s - own.period_s).abs() <= 0.01 * own.period_s;
    if own.of_column || !whole {
        return None;
    }
    let sources = &told.calibration.project.sources;
    let from = sources.text(span);
    let (before, rest) = from.split_once("pre(")?;
    let (name, behind) = rest.split_once(')')?;
    let source = sources.get(span.file);
    Some(Edit {
        file: source.name.clone(),
        line: source.line_column(span.start).0,
        from: from.to_owned(),
        to: format!("{before}{name}{behind}"),
    })
}

/// The name of a command.
pub fn command<'t>(told: &'t Diagnosed<'_>, own: &CommandTiming) -> &'t str {
    &told.found.program.experiment.replayed[own.replayed].name
}

fn clock<'t>(told: &'t Diagnosed<'_>, number: usize) -> &'t str {
    &told.found.program.clocks[number].name
}

/// Commands that are not compared with their records in time, each with the reason.
pub fn uncompared<'t>(told: &'t Diagnosed<'_>) -> impl Iterator<Item = (&'t str, String)> {
    told.commands.uncompared.iter().map(|own| {
        let replayed = &told.found.program.experiment.replayed[own.replayed];
        (replayed.name.as_str(), reason(told, own))
    })
}

/// `its clock cnc ticks every 0.25 ms, and the record has a sample every 1 ms`
fn reason(told: &Diagnosed<'_>, own: &Uncompared) -> String {
    let clock = clock(told, own.clock);
    match own.why {
        Why::Parts => {
            "the model contains an FMU, which runs only in time with the model".to_owned()
        }
        Why::Columns => "its replay does not read exactly one column".to_owned(),
        Why::Clock { period_s, step_s } => format!(
            "its clock {clock} ticks every {}, and the record has a sample every {}",
            ms(period_s),
            ms(step_s)
        ),
        Why::Differs(part) => format!(
            "along the measured motion, what {clock} puts out differs from the record by {} % of its rms, however it is \
             moved",
            significant(100.0 * part, 2)
        ),
    }
}

/// A time without its sign.
fn ms(time_s: f64) -> String {
    format!("{} ms", significant(1e3 * time_s.abs(), 3))
}
