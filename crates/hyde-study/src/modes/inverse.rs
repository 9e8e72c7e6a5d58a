//! Parameters from measured natural frequencies.

use super::point::Prepared;
use crate::{Refused, operating_point, run_failure};
use hyde_experiment::{MeasuredMode, ModeFit, ModeFitError, ModeFitRequest, fit_modes};
use hyde_units::{Kind, significant};

/// What was measured, and what is to be found.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Frequencies in Hz, each with a damping ratio behind a colon if that was measured.
    pub measured: Vec<String>,
    /// The parameters to find.
    pub vary: Vec<String>,
    /// The number of the mode of each frequency, from 1; the nearest in order if empty.
    pub pair: Vec<usize>,
    /// Standard deviations of a frequency and of a damping ratio, in percent.
    pub spread: f64,
    /// See `spread`.
    pub damping_spread: f64,
}

/// What was found.
pub struct Found {
    /// The model.
    pub prepared: Prepared,
    /// The parameters to find.
    pub vary: Vec<String>,
    /// What was measured, in rising order.
    pub measured: Vec<MeasuredMode>,
    /// The parameters, and the modes with them.
    pub fit: ModeFit,
}

impl Measured {
    /// What the texts say, with the numbers of the modes from 0.
    ///
    /// # Errors
    /// A text is no measurement: what to write.
    pub fn read(&self) -> Result<(Vec<MeasuredMode>, Vec<usize>), String> {
        asked(self)
    }
}

/// Finds the parameters.
///
/// # Errors
/// No values have such modes, or a parameter cannot be varied.
pub fn fitted(
    mut prepared: Prepared,
    vary: &[String],
    (measured, numbers): (Vec<MeasuredMode>, Vec<usize>),
) -> Result<Found, Refused> {
    let program = &prepared.compiled.program;
    if let Some(name) = vary.iter().find(|name| {
        let known = program.parameter(name);
        known.is_some_and(|(parameter, _)| parameter.allowed.kind != Kind::Real)
    }) {
        return Err(Refused::Asked(format!(
            "`{name}` has no values between others, so it is not found by small steps: leave it out of `--vary`, and set it, `--set {name}=…`"
        )));
    }
    let request = ModeFitRequest {
        program,
        records: &prepared.tables,
        set: &prepared.project.set(),
        in_modes: &prepared.chosen,
        vary,
        measured: &measured,
        numbers: &numbers,
    };
    match fit_modes(&request) {
        Ok(fit) => Ok(Found {
            prepared,
            vary: vary.to_vec(),
            measured,
            fit,
        }),
        Err(ModeFitError::Parameter(error)) => {
            let (diagnostic, fault) = run_failure::diagnostic(&error, program, None);
            prepared.project.diagnostics.push(diagnostic);
            Err(prepared.project.refused(fault))
        }
        Err(error) => Err(Refused::Asked(reason(&error, &measured))),
    }
}

/// The measurement in rising order, and the numbers of its modes from 0.
fn asked(options: &Measured) -> Result<(Vec<MeasuredMode>, Vec<usize>), String> {
    if options.vary.is_empty() {
        return Err(
            "`--measured` needs the parameters to find: `--vary belt.k,screw.contact.k`".to_owned(),
        );
    }
    let positive = |what: &str, text: &str| {
        let value: Option<f64> = text.parse().ok();
        let fine = value.filter(|value| *value > 0.0 && value.is_finite());
        fine.ok_or_else(|| format!("`{text}` is not a positive {what}"))
    };
    let mut measured = Vec::new();
    for text in &options.measured {
        let (frequency, damping) = match text.split_once(':') {
            Some((frequency, damping)) => (frequency, Some(positive("damping ratio", damping)?)),
            None => (text.as_str(), None),
        };
        measured.push(MeasuredMode {
            frequency_hz: positive("frequency in Hz", frequency)?,
            spread: 0.01 * options.spread,
            damping: damping.map(|ratio| (ratio, 0.01 * options.damping_spread)),
        });
    }
    if options.spread.is_nan()
        || options.spread <= 0.0
        || options.damping_spread.is_nan()
        || options.damping_spread <= 0.0
    {
        return Err("`--spread` and `--damping-spread` must be positive".to_owned());
    }
    let mut numbers = Vec::new();
    for &number in &options.pair {
        let twice = numbers.contains(&(number.wrapping_sub(1)));
        if number == 0 || twice {
            return Err(
                "`--pair` takes the number of a mode for each frequency, from 1, each once"
                    .to_owned(),
            );
        }
        numbers.push(number - 1);
    }
    if !numbers.is_empty() && numbers.len() != measured.len() {
        let (pairs, count) = (numbers.len(), measured.len());
        return Err(format!(
            "`--pair` names {pairs} modes for {count} frequencies"
        ));
    }
    if numbers.is_empty() {
        measured.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    }
    Ok((measured, numbers))
}

fn reason(error: &ModeFitError, measured: &[MeasuredMode]) -> String {
    match error {
        ModeFitError::Parameter(_) => "a parameter cannot be set".to_owned(),
        ModeFitError::Structural(name) => {
            format!(
                "`{name}` changes the structure of the equations, so it cannot be found by small steps"
            )
        }
        ModeFitError::NotPositive(name, value) => {
            format!(
                "`{name}` is {value}: its logarithm is varied, so start it from a positive value with `--set`"
            )
        }
        ModeFitError::TooFewModes(count) => format!("the model has {count} modes that oscillate"),
        ModeFitError::Linearize(error) => {
            format!(
                "the model is not linearised: {}",
                operating_point::why_not(error)
            )
        }
        ModeFitError::Lost(at) => {
            let f = significant(measured[*at].frequency_hz, 4);
            format!(
                "the mode measured at {f} Hz was lost on the way: its shape changes too much; name it with `--pair`, or start nearer with `--set`"
            )
        }
        ModeFitError::NotConverged => {
            "no end of the steps was found: start nearer with `--set`".to_owned()
        }
    }
}
