//! A run that could not go on, as a diagnostic: component, equation, source line, time.

use hyde_diag::{Code, Diagnostic};
use hyde_experiment::RunError;
use hyde_sim::{Failure, FailureKind};

/// The diagnostic of a run that did not start or did not end; `None` where only words can be given.
pub(crate) fn diagnostic(error: &RunError) -> Result<Diagnostic, String> {
    match error {
        RunError::NoParameter(name) => Err(format!("the model has no parameter `{name}`")),
        RunError::CannotSet(name, why) => Err(format!("`{name}` cannot be set: {why}")),
        RunError::NoStop => Err("it is not said when the run ends: write `stop 1 [s];` in the experiment, or `--stop 1`".to_owned()),
        RunError::NotPositive(what, value) => Err(format!("{what} must be positive, not {value}")),
        RunError::Compare(error) => Err(format!("the channel `{}` cannot be compared: {}", error.channel, error.cause)),
        RunError::Failed(failure) => Ok(failed(failure)),
    }
}

fn failed(failure: &Failure) -> Diagnostic {
    let at = format!("at {} s", hyde_units::significant(failure.t, 7));
    let (code, message, help) = match &failure.kind {
        FailureKind::Inconsistent { singular, at_start } => {
            let what = if *at_start {
                "no consistent initial conditions"
            } else {
                "no consistent values after an event"
            };
            let message = match singular {
                Some(name) => format!("{what} {at}: nothing determines `{name}` here"),
                None => format!("{what} {at}"),
            };
            (
                Code::InitialFailed,
                message,
                "check the start values, and that every mode determines its forces",
            )
        }
        FailureKind::Solver(reason) => (
            Code::SolverFailed,
            format!("the solver could not go on {at}: {reason}"),
            "look for a jump that is no event, or a stiffness beyond the others",
        ),
        FailureKind::NotFinite => (
            Code::NotFinite,
            format!("an equation has no finite value {at}"),
            "look for a division by zero or a root of a negative number",
        ),
        FailureKind::Chattering(causes) => {
            let list: Vec<String> = causes.iter().map(|cause| format!("`{cause}`")).collect();
            (
                Code::Chattering,
                format!(
                    "events follow each other without end {at}: {}",
                    list.join(", ")
                ),
                "each of these conditions makes the other true: leave a gap between them",
            )
        }
        FailureKind::TooManyEvents => (
            Code::TooManyEvents,
            format!("events come faster and faster, more than 2000 {at}"),
            "end the motion by a mode that rests, or add a damping",
        ),
        FailureKind::Impact(name, from, to) => (
            Code::ImpactOnPin,
            format!(
                "`{name}` jumps from {} to {} {at} as a mode fixes it",
                hyde_units::significant(*from, 4),
                hyde_units::significant(*to, 4)
            ),
            "if the impact is meant, write `impact` behind the exit; else leave the mode at rest",
        ),
        FailureKind::Assert(message) => (
            Code::AssertFailed,
            format!("{message} ({at})"),
            "change the motion or the limit",
        ),
        FailureKind::Input(message) => (
            Code::NoColumn,
            message.clone(),
            "give the record that has it",
        ),
    };
    let mut diagnostic = Diagnostic::error(code, message);
    let mut seen = Vec::new();
    for origin in &failure.origins {
        if seen.contains(&origin.span) {
            continue;
        }
        seen.push(origin.span);
        let instance = origin.instance.as_str();
        let text = if instance.is_empty() {
            "this equation".to_owned()
        } else {
            format!("this equation, in `{instance}`")
        };
        diagnostic = diagnostic.label(origin.span, text);
    }
    for (name, value) in &failure.unknowns {
        diagnostic = diagnostic.note(format!(
            "`{name}` is {} there",
            hyde_units::significant(*value, 6)
        ));
    }
    if let Some(event) = failure.results.events.last() {
        diagnostic = diagnostic.note(format!(
            "the last event before was `{}` at {} s",
            event.cause,
            hyde_units::significant(event.t, 7)
        ));
    }
    diagnostic.help(help)
}
