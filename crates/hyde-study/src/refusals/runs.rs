//! What is said of runs that did not start or did not end, and of sweeps of them.

use hyde_diag::{Span, diagnostics};

/// Names in backquotes, the first four of them.
fn first_four(names: &[String]) -> String {
    let names: Vec<String> = names
        .iter()
        .take(4)
        .map(|name| format!("`{name}`"))
        .collect();
    names.join(", ")
}

fn quoted(names: &[String]) -> Vec<String> {
    names.iter().map(|name| format!("`{name}`")).collect()
}

diagnostics! {
    fn no_parameter(message: &str) = error BadSet {
        "{message}";
    }
    fn cannot_set(message: &str, parameter: Option<Span>) = error BadSet {
        "{message}";
        if let Some(parameter) = parameter { at parameter, "its value is given here"; }
    }
    fn row_not_allowed(why: &str, driven: Span, repair: &str) = error NotAllowed {
        "{why}"; at driven, "driven here";
        help "{repair}";
    }
    fn no_gradient_by(name: &str, why: &str, parameter: Option<Span>) = error NoGradient {
        "there is no gradient by `{name}`: {why}";
        if let Some(parameter) = parameter { at parameter, "its value is given here"; }
        help "vary it with `--set` in separate runs";
    }
    fn not_positive(what: &str, value: f64, experiment: Option<Span>) = error BadSolve {
        "`{what}` must be positive and finite, not {value}";
        if let Some(experiment) = experiment { at experiment, "in this experiment"; }
        help "give `{what}` such a value, or leave it out";
    }
    fn cannot_compare(channel: &str, why: &str, measured: Option<Span>) = error BadRecord {
        "the channel `{channel}` cannot be compared: {why}";
        if let Some(measured) = measured { at measured, "measured here"; }
    }
    fn measure_without_value(measure: &str, (variable, seconds): (&str, &str), here: Option<Span>) = error NotFinite {
        "`{measure}` has no value: `{variable}` is not a number at {seconds} s";
        if let Some(here) = here { at here, "read here"; }
    }
    fn too_many_rows(
        (rows, columns, gigabytes): (&str, usize, &str), period: &str, experiment: Option<Span>,
    ) = error BadSolve {
        "the results would have {rows} rows of {columns} columns, {gigabytes} GB";
        if let Some(experiment) = experiment { at experiment, "this experiment asks for them"; }
        help "write `every {period} [s]` or more, or leave `every` out: events are always recorded, and measures do \
              not depend on the sampling of the results";
    }
    fn no_stop(experiment: Span) = error NoStop {
        "the end of the run is not defined"; at experiment, "this experiment has no `stop`";
        help "write `solve auto(rtol = 1e-6) stop 1 [s];`, or `stop file.end` for the end of a record";
    }
    fn no_stop_asked() = error NoStop {
        "the end of the run is not defined";
        help "a model without an experiment is run with `--stop 1`";
    }
    fn ends_before_record((start, stop): (&str, &str), record: &str, experiment: Option<Span>) = error BadSolve {
        "the run would end at {stop}, but its record `{record}` begins at {start}";
        if let Some(experiment) = experiment { at experiment, "of this experiment"; }
        note "a run begins at the first sample of its record and uses the time of the record";
        help "write `stop {record}.begin + 1 [s]` for a run of 1 s, or `stop {record}.end` for the whole record";
    }
    fn ends_before_start((start, stop): (&str, &str), experiment: Option<Span>) = error BadSolve {
        "the run would end at {stop}, but it starts at {start}";
        if let Some(experiment) = experiment { at experiment, "of this experiment"; }
        help "write a `stop` that is later than the start: `stop 1 [s]`";
    }
    fn lasts(span: &str, experiment: Option<Span>) = error BadSolve {
        "the run would last {span}: runs last from 1e-6 s to 1e12 s";
        if let Some(experiment) = experiment { at experiment, "of this experiment"; }
        note "instants are located to 1e-12 s, and to 1e-12 of the time: events would be lost without a word";
        help "correct `stop`, or let a ms of the run stand for a ns: divide the rates `der(...)` by 1e6";
    }
    fn keeps_nothing(name: &str, sweep: Span) = error BadSweep {
        "`keep {name}`: there is no such variable"; at sweep, "in this sweep";
        help "the results of `hyde run --out DIR` list all variables; `keep guide.*;` keeps those of a component";
    }
    fn measures_nothing(experiment: Span) = warning BadSweep {
        "the experiment has no `measure`, and the sweep keeps no variable";
        at experiment, "write `measure Length peak = max(abs(e));` there";
    }
}

// Runs that failed; their places and values are added to them. `when` is a time.
diagnostics! {
    fn inconsistent(what: &str, when: &str) = error InitialFailed {
        "{what} {when}";
        help "check the start values, and whether these equations have a solution there";
    }
    fn singular(what: &str, when: &str, unknowns: &[String]) = error InitialFailed {
        "{what} {when}: no equation determines {}{} here", first_four(unknowns),
            match unknowns.len() > 4 { true => ", …", false => "" };
        help "these equations depend on each other there: look for a factor that is 0, a massless part that only \
              friction holds, or parts that fix each other";
    }
    fn solver_failed(when: &str, why: &str) = error SolverFailed {
        "the solver failed {when}: {why}";
        help "look for a jump without an event, such as an `if` in an array equation or inside `noEvent`, or for a stiffness far larger than the others";
    }
    fn not_finite(when: &str) = error NotFinite {
        "an equation has no finite value {when}";
        help "look for a division by zero or the square root of a negative number";
    }
    fn chattering(when: &str, causes: &[String]) = error Chattering {
        "endless sequence of events {when}: {}", quoted(causes).join(", ");
        match causes {
            [] | [_] => {
                help "the condition remains true after the event: add a mode for rest, such as `mode lying {{ v = 0; exit … }}`";
            }
            _ => { help "each of these conditions makes the other true: leave a gap between their thresholds"; }
        }
    }
    fn cannot_slide(when: &str, causes: &[String], why: &str) = error Chattering {
        "both sides of {} lead back to it {when}, and {why}", quoted(causes).join(" and ");
        help "give the switch a hysteresis (two thresholds with a gap between them), or add a mode in which the state stays there";
    }
    fn faster_and_faster(cause: &str, when: &str, end: &str) = error TooManyEvents {
        "`{cause}` changes faster and faster {when} and would change infinitely often before about {end} s";
        help "add a mode for rest that is entered below a small speed, such as `mode lying {{ v = 0; exit … }}`";
    }
    fn too_many_events(count: u64, span: &str, when: &str) = error TooManyEvents {
        "events come {count} times within {span} s {when}";
        help "add a mode in which the state rests where these conditions meet, such as `mode stuck {{ v = 0; exit … }}`";
    }
    fn impact(state: &str, (from, to): (&str, &str), when: &str) = error ImpactOnPin {
        "`{state}` jumps from {from} to {to} {when} as a mode fixes it";
        help "if an impact is intended, write `impact` after the exit; otherwise leave the mode at rest";
    }
    fn overdetermined(fixed: &[String]) = error TooManyConditions {
        "{}", match fixed {
            [] => "no start value that may change can satisfy an initial equation".to_owned(),
            fixed => format!("an initial equation and the fixed start of {} determine the same", first_four(fixed)),
        };
        match fixed {
            [] => {
                help "give a state another start value, from which the equation can be satisfied, remove the equation, or \
                      set `fixed = false` for a state that it is to determine";
            }
            _ => { help "remove the initial equation, or set `fixed = false` for a state that it is to determine"; }
        }
    }
    fn start_contradicted(state: &str, wanted: &str, found: &str) = error StartContradicted {
        "`{state}` has the start value {wanted}, but the other conditions require {found}";
        help "give consistent start values, or remove the one that follows from the others";
    }
    fn assert_failed(message: &str, when: &str) = error AssertFailed {
        "{message} ({when})";
        help "change the motion or the limit";
    }
    fn no_gradient_through(what: &str) = error NoGradient {
        "the gradient cannot be computed through {what}";
        help "use differences of runs with `--set`, or remove it from the model";
    }
    fn not_steady(state: &str, rate: &str, when: &str) = error SolverFailed {
        "no steady state is reached {when}: `{state}` still changes by {rate} SI units per second";
        help "use a time of the run as the operating point: `--at '0.3 [s]'`";
    }
    fn fmu(what: &str) = error FmuFailed {
        "{what}";
        help "";
    }
    fn interrupted(when: &str) = error SolverFailed {
        "the run was interrupted {when}";
        help "the finished part is kept";
    }
    fn no_input(why: &str) = error NoColumn {
        "{why}";
        help "give the record that contains it";
    }
}
