//! A run that could not go on, as a diagnostic: component, equation, source line, time.

use crate::fmus;
use crate::near::did_you_mean;
use crate::refusals::runs as refused;
use crate::refused::Fault;
use hyde_diag::{Diagnostic, Span};
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
    let of_experiment = experiment.map(|experiment| experiment.name.span);
    match error {
        RunError::NoParameter(name) => (
            refused::no_parameter(&no_parameter(program, name)),
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
            let (why, driven) = (fault.to_string(), fault.drives.2);
            (
                refused::row_not_allowed(&why, driven, ROW_HELP),
                Fault::Model,
            )
        }
        RunError::NoGradientBy(name, why) => {
            let parameter = declared(program, name);
            (refused::no_gradient_by(name, why, parameter), Fault::Asked)
        }
        RunError::NoStop => match of_experiment {
            Some(experiment) => (refused::no_stop(experiment), Fault::Model),
            None => (refused::no_stop_asked(), Fault::Asked),
        },
        RunError::EndsBeforeStart {
            start_s,
            stop_s,
            record,
        } => (
            ends_before_start(*start_s, *stop_s, record.as_deref(), of_experiment),
            Fault::Model,
        ),
        RunError::Lasts(span_s) => {
            let span = instant(*span_s);
            (refused::lasts(&span, of_experiment), Fault::Model)
        }
        RunError::NotPositive(what, value) => (
            refused::not_positive(what, *value, of_experiment),
            Fault::Model,
        ),
        RunError::TooManyRows {
            rows,
            columns,
            least_s,
        } => (
            too_many_rows((*rows, *columns), *least_s, of_experiment),
            Fault::Model,
        ),
        RunError::Compare(error) => {
            let channels = &program.experiment.measured;
            let channel = channels.iter().find(|known| known.name == error.channel);
            let (why, measured) = (error.cause.to_string(), channel.map(|own| own.origin.span));
            (
                refused::cannot_compare(&error.channel, &why, measured),
                Fault::Model,
            )
        }
        RunError::NotANumber {
            measure,
            variable,
            t,
        } => {
            let t = hyde_units::significant(*t, 7);
            let measures = &program.experiment.measures;
            let known = measures.iter().find(|known| known.name == *measure);
            let here = known.map(|known| known.origin.span);
            let diagnostic = refused::measure_without_value(measure, (variable, &t), here);
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
    refused::cannot_set(&message, declared(program, name))
}

/// Where the value of a parameter is given.
fn declared(program: &Program, name: &str) -> Option<Span> {
    let (parameter, _) = program.parameter(name)?;
    Some(parameter.origin.span)
}

/// Results that fit nowhere, and how far apart rows may be.
fn too_many_rows(
    (rows, columns): (f64, usize),
    least_s: f64,
    experiment: Option<Span>,
) -> Diagnostic {
    let significant = hyde_units::significant;
    let gigabytes = significant(rows * columns as f64 * 8e-9, 2);
    let rows = significant(rows, 3);
    let written = significant(10.0_f64.powf(least_s.log10().ceil()), 1);
    refused::too_many_rows((&rows, columns, &gigabytes), &written, experiment)
}

fn ends_before_start(
    start_s: f64,
    stop_s: f64,
    record: Option<&str>,
    experiment: Option<Span>,
) -> Diagnostic {
    let (start, stop) = (instant(start_s), instant(stop_s));
    match record {
        Some(record) => refused::ends_before_record((&start, &stop), record, experiment),
        None => refused::ends_before_start((&start, &stop), experiment),
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
    let mut diagnostic = of_kind(&failure.kind, &at);
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
    diagnostic
}

/// What went wrong, without the values there.
fn of_kind(kind: &FailureKind, at: &str) -> Diagnostic {
    let significant = hyde_units::significant;
    match kind {
        FailureKind::Inconsistent { singular, at_start } => {
            let what = match at_start {
                true => "no consistent initial conditions",
                false => "no consistent values after an event",
            };
            match singular.as_slice() {
                [] => refused::inconsistent(what, at),
                singular => refused::singular(what, at, singular),
            }
        }
        FailureKind::Solver(reason) => refused::solver_failed(at, reason),
        FailureKind::NotFinite => refused::not_finite(at),
        FailureKind::Chattering(causes) => refused::chattering(at, causes),
        FailureKind::CannotSlide(causes, why) => refused::cannot_slide(at, causes, why),
        FailureKind::Zeno { cause, sum_s } => {
            refused::faster_and_faster(cause, at, &significant(*sum_s, 7))
        }
        FailureKind::TooManyEvents { count, span_s } => {
            refused::too_many_events(*count, &significant(*span_s, 2), at)
        }
        FailureKind::Impact(name, from, to) => {
            refused::impact(name, (&significant(*from, 4), &significant(*to, 4)), at)
        }
        FailureKind::Overdetermined(fixed) => refused::overdetermined(fixed),
        FailureKind::Start(name, wanted, found) => {
            refused::start_contradicted(name, &significant(*wanted, 6), &significant(*found, 6))
        }
        FailureKind::Assert(message) => refused::assert_failed(message, at),
        FailureKind::NoGradient(what) => refused::no_gradient_through(what),
        FailureKind::NotSteady(name, rate) => refused::not_steady(name, &significant(*rate, 3), at),
        // Reported before.
        FailureKind::Foreign { what, .. } => refused::fmu(what),
        FailureKind::Interrupted => refused::interrupted(at),
        FailureKind::Input(message) => refused::no_input(message),
    }
}
