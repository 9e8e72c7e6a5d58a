//! Diagnostics of studies that cannot be: records and models without an observer, and calibrations that learn nothing.

use crate::calibration::Calibration;
use crate::refusals::calibrations as refused;
use crate::run_failure;
use hyde_calibrate::{CalibrationPlan, Cause, RecordError, Unsupported};
use hyde_diag::{Diagnostic, Span};
use hyde_units::{Dimension, engineering, engineering_difference, significant};

/// Why a record cannot be observed.
pub fn unreadable(name: &str, error: &RecordError, span: Span) -> Diagnostic {
    let time = |seconds: f64| engineering(seconds, Dimension::TIME);
    let (cause, help) = match error {
        RecordError::NoChannel => (
            "its experiment has no measured channel".to_owned(),
            "declare which variable a column measures: `measured log.w = rotor.w ~ 0.5 [rad/s];`",
        ),
        RecordError::NoColumn(record, column) => (
            format!("the record `{record}` has no column `{column}`"),
            "write the name as in the header of the record",
        ),
        RecordError::Gap {
            record,
            from_s,
            to_s,
            usual_s,
        } => (
            format!(
                "the record `{record}` has a gap: no sample from {} to {}, while its samples are usually {} apart",
                time(*from_s),
                time(*to_s),
                time(*usual_s)
            ),
            "an observer does not interpolate across a gap: save the parts before and after the gap as two files and name both, `fit down(\"part-*.csv\");`, or resample the record",
        ),
        RecordError::Row(fault) => (fault.to_string(), run_failure::ROW_HELP),
        RecordError::BeginsAgain(channel, times, by) => (
            format!(
                "`{channel}` jumps back by {} {times} times, like an encoder that wraps once per revolution, but the variable of the model does not wrap",
                significant(*by, 4)
            ),
            "wrap the variable of the model too, so that both are compared modulo one revolution: `measured log.phi = mod(rotor.phi, 2*pi*1 [rad]);`, or unwrap the record first",
        ),
        RecordError::Short(_, rows) => (
            format!(
                "it has {rows} samples; an observer needs at least 300, because the first 150 are for settling"
            ),
            "record for longer, or at a higher rate",
        ),
        RecordError::Preparation(channel, cause) => (
            format!("the channel `{channel}`: {cause}"),
            "change the preparation of the column in the `measured` declaration",
        ),
    };
    refused::record_not_observed(name, (&cause, help), span)
}

/// Why a program has no fixed-step form.
pub fn unsupported(error: &Unsupported, span: Span) -> Diagnostic {
    let (cause, help) = match error {
        Unsupported::Clock(part) => (
            format!("the clocked part `{part}` closes the loop"),
            "replace its output by the recorded one: `replay motor.i_ref = file.i_ref;` in the experiment",
        ),
        Unsupported::Delay => (
            "a `delay` depends on states".to_owned(),
            "an observer can delay only recorded inputs and what is measured: replace the delayed variable by its record, `replay x = file.x;`, \
             or delay the whole value of a channel, `measured file.y = delay(a + b, T);`",
        ),
        Unsupported::ChosenStates => (
            "its states are chosen during the run".to_owned(),
            "this version cannot observe a model whose bodies are joined by changing constraints",
        ),
        Unsupported::Start(cause) => (
            format!("its initial state cannot be computed: {cause}"),
            "run its experiment first: `hyde run FILE`",
        ),
    };
    refused::model_not_observed((&cause, help), span)
}

/// Why a calibration learned nothing of what it varied, by name; each cause with the experiment that it is of.
pub fn unlearned(
    plan: &CalibrationPlan,
    names: &[String],
    causes: &[(&Calibration, &Cause)],
) -> Diagnostic {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let still = causes
        .iter()
        .any(|(_, cause)| matches!(cause, Cause::Held { .. }));
    let causes: Vec<String> = causes
        .iter()
        .map(|(own, cause)| reason(own, cause))
        .collect();
    refused::nothing_learned(&plan.name, plan.span, &names, &causes, still)
}

/// A cause in a sentence.
pub fn reason(calibration: &Calibration, cause: &Cause) -> String {
    match cause {
        Cause::Held {
            mode: (automaton, mode),
            state,
            record,
        } => format!(
            "the observer does not move: `{automaton}` is in mode `{mode}` in all samples of {record}, and this mode fixes `{state}`"
        ),
        Cause::Astray {
            channel,
            rms,
            record,
        } => {
            let channel = &calibration.compiled.program.experiment.measured[*channel];
            let shown = |value| engineering_difference(value, &channel.unit);
            format!(
                "the observer does not follow {record}: the rms of the innovations of `{}` is {}, and the signal itself varies by only {}",
                channel.name,
                shown(rms.0),
                shown(rms.1)
            )
        }
    }
}
