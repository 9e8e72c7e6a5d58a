//! About which point a model is to be linearised: a moment of its run, and modes; why it cannot be.

use crate::settings;
use hyde_experiment::LinearizeError;
use hyde_program::{Moment, Program};
use hyde_sim::PointTime;
use hyde_units::{Dimension, significant};

/// `0.3 [s]`, `start` or `steady`.
pub fn point_time(text: Option<&str>) -> Result<PointTime, String> {
    match text.map(str::trim) {
        None | Some("start") => Ok(PointTime::Start),
        Some("steady") => Ok(PointTime::Steady),
        Some(text) => {
            let help =
                || format!("`--at {text}`: write `--at '0.3 [s]'`, `--at start` or `--at steady`");
            let time = settings::quantity(text, Dimension::TIME);
            let time = time.filter(|time| time.is_finite());
            time.map(PointTime::At).ok_or_else(help)
        }
    }
}

/// Where the experiment says, unless the command line says otherwise; `time` is its time, where that is one.
pub fn moment(asked: Option<&str>, at: Moment, time: Option<f64>) -> Result<PointTime, String> {
    match (asked, at) {
        (Some(_), _) => point_time(asked),
        (None, Moment::Start) => Ok(PointTime::Start),
        (None, Moment::Steady) => Ok(PointTime::Steady),
        (None, Moment::At) => match time {
            Some(time) if time.is_finite() => Ok(PointTime::At(time)),
            Some(_) | None => {
                Err("`at`: the time of the operating point is not a number".to_owned())
            }
        },
    }
}

/// `guide=slip`
pub fn in_mode(program: &Program, text: &str) -> Result<(usize, usize), String> {
    let (name, mode) = text
        .split_once('=')
        .ok_or_else(|| format!("`--in {text}`: write `NAME=MODE`"))?;
    let number = program
        .automata
        .iter()
        .position(|automaton| automaton.name == name)
        .ok_or_else(|| {
            let known: Vec<&str> = program
                .automata
                .iter()
                .map(|automaton| automaton.name.as_str())
                .collect();
            format!(
                "`{name}` has no modes; modes are in `{}`",
                known.join("`, `")
            )
        })?;
    let modes = &program.automata[number].modes;
    let found = modes.iter().position(|known| known == mode);
    let found = found.ok_or_else(|| {
        format!(
            "`{name}` has no mode `{mode}`; it has `{}`",
            modes.join("`, `")
        )
    })?;
    Ok((number, found))
}

/// Why a model could not be linearised.
pub fn why_not(error: &LinearizeError) -> String {
    match error {
        LinearizeError::NoInput(name) => format!("`{name}` is not a free input"),
        LinearizeError::TooLarge(n) => {
            format!("{n} unknowns are too many for a dense linearised system")
        }
        LinearizeError::NoCommonPeriod => {
            "the clocks never tick together again, so the loop has no common period".to_owned()
        }
        LinearizeError::LongDelay => {
            "the held values of a clock change more than a period after their tick".to_owned()
        }
        LinearizeError::DelayAndClock => "it has both a `delay` and a clocked part".to_owned(),
        LinearizeError::Singular => {
            "the algebraic variables are not determined in these modes".to_owned()
        }
        LinearizeError::BeforeStart(t, start_s) => format!(
            "the run begins at {} s, behind the operating point at {} s",
            significant(*start_s, 6),
            significant(*t, 6)
        ),
        LinearizeError::Failed(failure) => {
            format!("no operating point was found: {:?}", failure.kind)
        }
    }
}
