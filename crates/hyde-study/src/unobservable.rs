//! Diagnostics of studies that cannot be: records and models without an observer, and calibrations that learn nothing.

use crate::calibration::Calibration;
use crate::run_failure;
use hyde_calibrate::{Cause, RecordError, Unsupported};
use hyde_diag::{Code, Diagnostic, Span};
use hyde_units::{Dimension, engineering, engineering_difference, significant};

/// Why a record cannot be observed.
pub fn unreadable(name: &str, error: &RecordError, span: Span) -> Diagnostic {
    let time = |seconds: f64| engineering(seconds, Dimension::TIME);
    let (cause, help) = match error {
        RecordError::NoChannel => (
            "its experiment measures nothing".to_owned(),
            "write what the record has of the model: `measured log.w = rotor.w ~ 0.5 [rad/s];`",
        ),
        RecordError::NoColumn(record, column) => (
            format!("the record `{record}` has no column `{column}`"),
            "write the name as it stands in the header of the record",
        ),
        RecordError::Gap {
            record,
            from_s,
            to_s,
            usual_s,
        } => (
            format!(
                "the record `{record}` has no rows from {} to {}, and its rows are usually {} apart",
                time(*from_s),
                time(*to_s),
                time(*usual_s)
            ),
            "an observer does not guess what was in between: save what is before the gap and what is behind it as two files, and name both, `fit down(\"part-*.csv\");`, or resample the record",
        ),
        RecordError::Row(fault) => (fault.to_string(), run_failure::ROW_HELP),
        RecordError::BeginsAgain(channel, times, by) => (
            format!(
                "`{channel}` jumps back by {} {times} times and goes on in between, as an encoder that begins again each turn does; the model's goes on",
                significant(*by, 4)
            ),
            "let the model begin again too, and they are compared modulo that: `measured log.phi = mod(rotor.phi, 2*pi*1 [rad]);`, or unwrap the record first",
        ),
        RecordError::Short(_, rows) => (
            format!("it has {rows} rows, and an observer settles in 150: it needs 300"),
            "record longer, or more often",
        ),
        RecordError::Preparation(channel, cause) => (
            format!("the channel `{channel}`: {cause}"),
            "change how `measured` prepares the column",
        ),
    };
    Diagnostic::error(
        Code::CannotObserve,
        format!("`{name}` cannot be observed: {cause}"),
    )
    .label(span, "asked for by this study")
    .help(help)
}

/// Why a program has no fixed-step form.
pub fn unsupported(error: &Unsupported, span: Span) -> Diagnostic {
    let (cause, help) = match error {
        Unsupported::Clock(part) => (
            format!("the clocked part `{part}` closes the loop"),
            "replay what it puts out: `replay motor.i_ref = file.i_ref;` in the experiment",
        ),
        Unsupported::Delay => (
            "it delays what depends on states".to_owned(),
            "an observer delays only what the record drives the model with: replay what is delayed, `replay x = file.x;`",
        ),
        Unsupported::ChosenStates => (
            "its states are chosen while running".to_owned(),
            "this version observes no model whose bodies are tied by changing constraints",
        ),
        Unsupported::Start(cause) => (
            format!("it has no start: {cause}"),
            "run its experiment first: `hyde run FILE`",
        ),
    };
    Diagnostic::error(
        Code::CannotObserve,
        format!("the model cannot be observed: {cause}"),
    )
    .label(span, "asked for by this study")
    .help(help)
}

/// Why a calibration learned nothing.
pub fn unlearned(calibration: &Calibration, causes: &[Cause]) -> Diagnostic {
    let names: Vec<String> = calibration
        .varied
        .iter()
        .map(|varied| format!("`{}`", varied.name))
        .collect();
    let mut diagnostic = Diagnostic::error(
        Code::NothingLearned,
        format!(
            "the calibration `{}` learns nothing: no innovation depends on {}",
            calibration.plan.name,
            names.join(", ")
        ),
    )
    .label(calibration.plan.span, "asked for here");
    for cause in causes {
        diagnostic = diagnostic.note(reason(calibration, cause));
    }
    let held = causes
        .iter()
        .any(|cause| matches!(cause, Cause::Held { .. }));
    diagnostic.help(match held {
        true => "drive the model with what moved the axis, `stimulus F = file.force;`, and measure what moves",
        false => "record a motion in which these parameters matter, or `vary` others",
    })
}

/// A cause in a sentence.
pub fn reason(calibration: &Calibration, cause: &Cause) -> String {
    match cause {
        Cause::Held {
            mode: (automaton, mode),
            state,
            record,
        } => format!(
            "the observer stands still: `{automaton}` is in mode `{mode}` in all samples of {record}, which holds `{state}`"
        ),
        Cause::Astray {
            channel,
            rms,
            record,
        } => {
            let channel = &calibration.compiled.program.experiment.measured[*channel];
            let shown = |value| engineering_difference(value, &channel.unit);
            format!(
                "the observer does not follow {record}: the innovations of `{}` are {}, and the signal itself varies by {}",
                channel.name,
                shown(rms.0),
                shown(rms.1)
            )
        }
    }
}
