//! A run that could not go on, as a diagnostic: component, equation, source line, time.

use crate::fmus;
use crate::near::did_you_mean;
use crate::refused::Fault;
use hyde_diag::{Code, Diagnostic};
use hyde_experiment::RunError;
use hyde_program::{Output, Program};
use hyde_sim::{Failure, FailureKind, Reading};
use hyde_syntax::ast::Experiment;
use hyde_units::{Dimension, NamedUnit};

/// What to do about a row whose value is not allowed.
pub const ROW_HELP: &str = "correct the file, or convert its numbers: `stimulus on = file.on > 2.5 [V];`, or declare the input as `Real`";

/// The diagnostic of a run that did not start or did not end, and what is at fault.
pub fn diagnostic(
    error: &RunError,
    program: &Program,
    experiment: Option<&Experiment>,
) -> (Diagnostic, Fault) {
    match error {
        RunError::NoParameter(name) => (
            Diagnostic::error(Code::BadSet, no_parameter(program, name)),
            Fault::Asked,
        ),
        RunError::CannotSet(name, why) => {
            let message = format!("`{name}` cannot be set: {why}");
            (cannot_set(program, name, message), Fault::Asked)
        }
        RunError::NotAllowed(name, why) => {
            let message = format!("the value of `{name}` is not allowed: {why}");
            (cannot_set(program, name, message), Fault::Asked)
        }
        RunError::Row(fault) => {
            let diagnostic = Diagnostic::error(Code::NotAllowed, fault.to_string())
                .label(fault.drives.2, "driven here");
            (diagnostic.help(ROW_HELP), Fault::Model)
        }
        RunError::NoGradientBy(name, why) => {
            let message = format!("there is no gradient by `{name}`: {why}");
            let diagnostic = Diagnostic::error(Code::NoGradient, message);
            let diagnostic = match program.parameter(name) {
                Some((parameter, _)) => {
                    diagnostic.label(parameter.origin.span, "its value is given here")
                }
                None => diagnostic,
            };
            let help = "vary it with `--set` in separate runs";
            (diagnostic.help(help), Fault::Asked)
        }
        RunError::NoStop => no_stop(experiment),
        RunError::EndsBeforeStart {
            start_s,
            stop_s,
            record,
        } => (
            ends_before_start(*start_s, *stop_s, record.as_deref(), experiment),
            Fault::Model,
        ),
        RunError::NotPositive(what, value) => {
            let message = format!("`{what}` must be positive and finite, not {value}");
            let diagnostic = Diagnostic::error(Code::BadSolve, message);
            let diagnostic = match experiment {
                Some(experiment) => diagnostic.label(experiment.name.span, "in this experiment"),
                None => diagnostic,
            };
            let help = format!("give `{what}` such a value, or leave it out");
            (diagnostic.help(help), Fault::Model)
        }
        RunError::TooManyRows {
            rows,
            columns,
            least_s,
        } => (
            too_many_rows((*rows, *columns), *least_s, experiment),
            Fault::Model,
        ),
        RunError::Compare(error) => {
            let message = format!(
                "the channel `{}` cannot be compared: {}",
                error.channel, error.cause
            );
            let diagnostic = Diagnostic::error(Code::BadRecord, message);
            let channels = &program.experiment.measured;
            let channel = channels.iter().find(|known| known.name == error.channel);
            let diagnostic = match channel {
                Some(channel) => diagnostic.label(channel.origin.span, "measured here"),
                None => diagnostic,
            };
            (diagnostic, Fault::Model)
        }
        RunError::NotANumber {
            measure,
            variable,
            t,
        } => {
            let t = hyde_units::significant(*t, 7);
            let message =
                format!("`{measure}` has no value: `{variable}` is not a number at {t} s");
            let measures = &program.experiment.measures;
            let known = measures.iter().find(|known| known.name == *measure);
            let diagnostic = Diagnostic::error(Code::NotFinite, message);
            let diagnostic = match known {
                Some(known) => diagnostic.label(known.origin.span, "read here"),
                None => diagnostic,
            };
            (diagnostic, Fault::Expectation)
        }
        RunError::Failed(failure) => {
            let fault = if failure.kind == FailureKind::Interrupted {
                Fault::Interrupted
            } else {
                Fault::Solver
            };
            (failed(failure, program), fault)
        }
    }
}

/// There is no such parameter, with those that are meant instead.
pub(crate) fn no_parameter(program: &Program, name: &str) -> String {
    let known = program.parameters.iter().map(|own| own.name.as_str());
    let near = did_you_mean(name, known);
    format!("the model has no parameter `{name}`{near}")
}

/// A value that cannot be set, at the parameter it was meant for.
pub fn cannot_set(program: &Program, name: &str, message: String) -> Diagnostic {
    let diagnostic = Diagnostic::error(Code::BadSet, message);
    match program.parameter(name) {
        Some((parameter, _)) => diagnostic.label(parameter.origin.span, "its value is given here"),
        None => diagnostic,
    }
}

/// Results that fit nowhere, and how far apart rows may be.
fn too_many_rows(
    (rows, columns): (f64, usize),
    least_s: f64,
    experiment: Option<&Experiment>,
) -> Diagnostic {
    let significant = hyde_units::significant;
    let gigabytes = significant(rows * columns as f64 * 8e-9, 2);
    let rows = significant(rows, 3);
    let message =
        format!("the results would have {rows} rows of {columns} columns, {gigabytes} GB");
    let diagnostic = Diagnostic::error(Code::BadSolve, message);
    let diagnostic = match experiment {
        Some(experiment) => diagnostic.label(experiment.name.span, "this experiment asks for them"),
        None => diagnostic,
    };
    let written = significant(10.0_f64.powf(least_s.log10().ceil()), 1);
    diagnostic.help(format!(
        "write `every {written} [s]` or more, or leave `every` out: events are always recorded, and measures do \
         not depend on the sampling of the results"
    ))
}

fn no_stop(experiment: Option<&Experiment>) -> (Diagnostic, Fault) {
    let diagnostic = Diagnostic::error(Code::NoStop, "the end of the run is not defined");
    match experiment {
        Some(experiment) => (
            diagnostic
                .label(experiment.name.span, "this experiment has no `stop`")
                .help("write `solve auto(rtol = 1e-6) stop 1 [s];`, or `stop file.end` for the end of a record"),
            Fault::Model,
        ),
        None => (
            diagnostic.help("a model without an experiment is run with `--stop 1`"),
            Fault::Asked,
        ),
    }
}

fn ends_before_start(
    start_s: f64,
    stop_s: f64,
    record: Option<&str>,
    experiment: Option<&Experiment>,
) -> Diagnostic {
    let (start, stop) = (instant(start_s), instant(stop_s));
    let diagnostic = match record {
        Some(record) => Diagnostic::error(
            Code::BadSolve,
            format!("the run would end at {stop}, but its record `{record}` begins at {start}"),
        )
        .note("a run begins at the first sample of its record and uses the time of the record")
        .help(format!(
            "write `stop {record}.begin + 1 [s]` for a run of 1 s, or `stop {record}.end` for the whole record"
        )),
        None => Diagnostic::error(
            Code::BadSolve,
            format!("the run would end at {stop}, but it starts at {start}"),
        )
        .help("write a `stop` that is later than the start: `stop 1 [s]`"),
    };
    match experiment {
        Some(experiment) => diagnostic.label(experiment.name.span, "of this experiment"),
        None => diagnostic,
    }
}

/// A time in s with all digits that tell it from others.
pub fn instant(time_s: f64) -> String {
    format!("{} s", hyde_units::significant(time_s, 10))
}

/// What an equation reads where it failed: `der(v)` is 9.81 m/s2 there, a term of 24.5 in this equation.
fn term_told(term: &Reading, program: &Program) -> String {
    let output = program.output(&term.name);
    let output = output.map(|number| &program.outputs[number]);
    let rate = |own: &Output| NamedUnit::usual(own.dimension.divide(Dimension::TIME));
    let value = match (output, term.is_rate) {
        (Some(own), false) => hyde_units::engineering_as(term.value, &own.unit),
        (Some(own), true) => hyde_units::engineering_as(term.value, &rate(own)),
        (None, _) => hyde_units::significant(term.value, 6),
    };
    let (name, value) = (&term.name, value.trim_end());
    let name = match term.is_rate {
        true => format!("`der({name})`"),
        false => format!("`{name}`"),
    };
    match term.part.is_finite() {
        true => {
            let part = hyde_units::significant(term.part, 3);
            format!("{name} is {value} there, a term of {part} in this equation (SI units)")
        }
        false => format!("{name} is {value} there"),
    }
}

fn failed(failure: &Failure, program: &Program) -> Diagnostic {
    let at = format!("at {} s", hyde_units::significant(failure.t, 7));
    if let Some(diagnostic) = fmus::failed(failure, &at) {
        return diagnostic;
    }
    let (code, message, help) = match &failure.kind {
        FailureKind::Inconsistent { singular, at_start } => {
            let what = if *at_start {
                "no consistent initial conditions"
            } else {
                "no consistent values after an event"
            };
            let list: Vec<String> = singular
                .iter()
                .take(4)
                .map(|name| format!("`{name}`"))
                .collect();
            let more = if singular.len() > 4 { ", …" } else { "" };
            if singular.is_empty() {
                (
                    Code::InitialFailed,
                    format!("{what} {at}"),
                    "check the start values, and whether these equations have a solution there",
                )
            } else {
                (
                    Code::InitialFailed,
                    format!(
                        "{what} {at}: no equation determines {}{more} here",
                        list.join(", ")
                    ),
                    "these equations depend on each other there: look for a factor that is 0, a massless part that only \
                     friction holds, or parts that fix each other",
                )
            }
        }
        FailureKind::Solver(reason) => (
            Code::SolverFailed,
            format!("the solver failed {at}: {reason}"),
            "look for a jump without an event, such as an `if` in an array equation or inside `noEvent`, or for a stiffness far larger than the others",
        ),
        FailureKind::NotFinite => (
            Code::NotFinite,
            format!("an equation has no finite value {at}"),
            "look for a division by zero or the square root of a negative number",
        ),
        FailureKind::Chattering(causes) => {
            let list: Vec<String> = causes.iter().map(|cause| format!("`{cause}`")).collect();
            (
                Code::Chattering,
                format!("endless sequence of events {at}: {}", list.join(", ")),
                if causes.len() > 1 {
                    "each of these conditions makes the other true: leave a gap between their thresholds"
                } else {
                    "the condition remains true after the event: add a mode for rest, such as `mode lying { v = 0; exit … }`"
                },
            )
        }
        FailureKind::CannotSlide(causes, why) => {
            let list: Vec<String> = causes.iter().map(|cause| format!("`{cause}`")).collect();
            (
                Code::Chattering,
                format!(
                    "both sides of {} lead back to it {at}, and {why}",
                    list.join(" and ")
                ),
                "give the switch a hysteresis (two thresholds with a gap between them), or add a mode in which the state stays there",
            )
        }
        FailureKind::Zeno { cause, sum_s } => (
            Code::TooManyEvents,
            format!(
                "`{cause}` changes faster and faster {at} and would change infinitely often before about {} s",
                hyde_units::significant(*sum_s, 7)
            ),
            "add a mode for rest that is entered below a small speed, such as `mode lying { v = 0; exit … }`",
        ),
        FailureKind::TooManyEvents { count, span_s } => (
            Code::TooManyEvents,
            format!(
                "events come {count} times within {} s {at}",
                hyde_units::significant(*span_s, 2)
            ),
            "add a mode in which the state rests where these conditions meet, such as `mode stuck { v = 0; exit … }`",
        ),
        FailureKind::Impact(name, from, to) => (
            Code::ImpactOnPin,
            format!(
                "`{name}` jumps from {} to {} {at} as a mode fixes it",
                hyde_units::significant(*from, 4),
                hyde_units::significant(*to, 4)
            ),
            "if an impact is intended, write `impact` after the exit; otherwise leave the mode at rest",
        ),
        FailureKind::Overdetermined(fixed) => {
            let list: Vec<String> = fixed
                .iter()
                .take(4)
                .map(|name| format!("`{name}`"))
                .collect();
            (
                Code::TooManyConditions,
                match list.is_empty() {
                    true => {
                        "no start value that may change can satisfy an initial equation".to_owned()
                    }
                    false => format!(
                        "an initial equation and the fixed start of {} determine the same",
                        list.join(", ")
                    ),
                },
                "remove the initial equation, or set `fixed = false` for a state that it is to determine",
            )
        }
        FailureKind::Start(name, wanted, found) => (
            Code::StartContradicted,
            format!(
                "`{name}` has the start value {}, but the other conditions require {}",
                hyde_units::significant(*wanted, 6),
                hyde_units::significant(*found, 6)
            ),
            "give consistent start values, or remove the one that follows from the others",
        ),
        FailureKind::Assert(message) => (
            Code::AssertFailed,
            format!("{message} ({at})"),
            "change the motion or the limit",
        ),
        FailureKind::NoGradient(what) => (
            Code::NoGradient,
            format!("the gradient cannot be computed through {what}"),
            "use differences of runs with `--set`, or remove it from the model",
        ),
        FailureKind::NotSteady(name, rate) => (
            Code::SolverFailed,
            format!(
                "no steady state is reached {at}: `{name}` still changes by {} SI units per second",
                hyde_units::significant(*rate, 3)
            ),
            "use a time of the run as the operating point: `--at '0.3 [s]'`",
        ),
        // Reported above.
        FailureKind::Foreign { what, .. } => (Code::FmuFailed, what.clone(), ""),
        FailureKind::Interrupted => (
            Code::SolverFailed,
            format!("the run was interrupted {at}"),
            "the finished part is kept",
        ),
        FailureKind::Input(message) => (
            Code::NoColumn,
            message.clone(),
            "give the record that contains it",
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
        let what = match failure.kind {
            FailureKind::Chattering(_)
            | FailureKind::CannotSlide(..)
            | FailureKind::Zeno { .. }
            | FailureKind::TooManyEvents { .. } => "this condition",
            FailureKind::Assert(_) => "does not hold",
            FailureKind::Start(..) | FailureKind::Overdetermined(_) => "a condition of the start",
            FailureKind::NoGradient(_) => "here",
            FailureKind::Inconsistent { .. }
            | FailureKind::Solver(_)
            | FailureKind::NotFinite
            | FailureKind::Impact(..)
            | FailureKind::Interrupted
            | FailureKind::NotSteady(..)
            | FailureKind::Foreign { .. }
            | FailureKind::Input(_) => "this equation",
        };
        let text = if instance.is_empty() {
            what.to_owned()
        } else {
            format!("{what}, in `{instance}`")
        };
        diagnostic = diagnostic.label(origin.span, text);
    }
    let is_term = |name: &str| {
        let mut terms = failure.terms.iter();
        terms.any(|term| term.name == name && !term.is_rate)
    };
    let others = failure.unknowns.iter();
    for (name, value) in others.filter(|(name, _)| !is_term(name)) {
        let output = program.output(name).map(|number| &program.outputs[number]);
        let value = match output {
            Some(output) => hyde_units::engineering_as(*value, &output.unit),
            None => hyde_units::significant(*value, 6),
        };
        diagnostic = diagnostic.note(format!("`{name}` is {} there", value.trim_end()));
    }
    for term in &failure.terms {
        diagnostic = diagnostic.note(term_told(term, program));
    }
    if failure.null_space.len() > 1 {
        let changes = failure.null_space.iter().take(6);
        let changes = changes
            .map(|(name, change)| format!("`{name}` by {}", hyde_units::significant(*change, 3)));
        diagnostic = diagnostic.note(format!(
            "a change of {} leaves these equations as they are (null space of the Jacobian, SI units)",
            changes.collect::<Vec<_>>().join(", ")
        ));
    }
    if let Some(residual) = failure.residual.filter(|own| own.is_finite()) {
        let residual = hyde_units::significant(residual.abs(), 3);
        diagnostic = diagnostic.note(format!(
            "the two sides of this equation differ by {residual} there (SI units)"
        ));
    }
    if let FailureKind::Zeno { cause, .. } = &failure.kind {
        let recent = failure.results.events.iter().rev().take(4);
        let mut others: Vec<String> = recent
            .filter(|event| event.cause != *cause)
            .map(|event| format!("`{}`", event.cause))
            .collect();
        others.sort();
        others.dedup();
        if !others.is_empty() {
            diagnostic = diagnostic.note(format!("in turn with {}", others.join(", ")));
        }
    }
    if let FailureKind::Inconsistent { singular, .. } = &failure.kind
        && !singular.is_empty()
    {
        let near = |name: &str| {
            let part = name.split('.').next();
            singular.iter().any(|s| s.split('.').next() == part)
        };
        let modes = failure.modes.iter().filter(|(name, _)| near(name));
        for (name, mode) in modes.take(3) {
            diagnostic = diagnostic.note(format!("`{name}` is in the mode `{mode}`"));
        }
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
