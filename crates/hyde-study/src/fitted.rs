//! What a calibration found, as the data that text, JSON and page are made of.
//!
//! ```text
//! calibrated   what the records determine, the fit, errors before and after, profiles   fitted/calibrated.rs
//! model        the calibrated models as text                                            fitted/model.rs
//! ```

mod calibrated;
pub mod model;

pub use calibrated::{Calibrated, calibrated, profiled};

use crate::comparison::RecordErrors;
use crate::{Calibration, JointCalibration, unobservable};
use hyde_calibrate::{Fit, Identifiability, Profile, UNDECLARED_NOISE};
use hyde_program::Program;
use hyde_units::{
    Dimension, NamedUnit, engineering, engineering_as, engineering_difference, significant,
};

/// A delay that moves by more than this part of a step of the observer is to be declared anew.
const MOVED: f64 = 0.1;

/// A calibration with everything that is told of it.
pub struct Fitted<'a> {
    /// What was calibrated.
    pub calibration: &'a JointCalibration,
    /// What the records determine.
    pub before: &'a Identifiability,
    /// The fit.
    pub fit: &'a Fit,
    /// Of each experiment, in the order of its records.
    pub errors: &'a [Vec<RecordErrors>],
    /// The profiles that were asked for.
    pub profiles: &'a [Profile],
}

/// What an experiment adds to the sum of squares.
pub struct Weight {
    /// Mean square of its innovations.
    pub mean_square: f64,
    /// How many there are.
    pub count: usize,
}

impl Fitted<'_> {
    /// The weights of the experiments; nothing of one whose records are all held out.
    pub fn weights(&self) -> Vec<Weight> {
        let each = 0..self.calibration.experiments.len();
        let of = |number: usize| {
            let parts = self.calibration.fitted_parts().zip(&self.fit.parts);
            let own = parts.filter(|(part, _)| self.calibration.parts[*part].experiment == number);
            let (sum, count) = own.fold((0.0, 0), |(sum, count), (_, (mean, own))| {
                (sum + mean * *own as f64, count + own)
            });
            Weight {
                mean_square: sum / (count as f64).max(1.0),
                count,
            }
        };
        each.map(of).collect()
    }

    /// Why the model does not follow the records, if it does not.
    pub fn reasons(&self) -> Vec<String> {
        let each = self.fit.causes.iter();
        let causes = each
            .map(|(part, cause)| unobservable::reason(experiment(self.calibration, *part), cause));
        causes.chain(self.moved_delays()).collect()
    }

    /// The delays of channels that moved so far that the first term of a Taylor series does not describe them.
    fn moved_delays(&self) -> Vec<String> {
        let mut found = Vec::new();
        for own in &self.calibration.experiments {
            let step_s = own.fitted.first().map_or(f64::INFINITY, |own| own.step_s);
            let channels = own.compiled.program.experiment.measured.iter();
            let late = channels.filter_map(|own| Some((&own.name, &own.late.as_ref()?.1)));
            for (channel, parameters) in late {
                let numbers = self.calibration.numbers.iter();
                for (number, value) in numbers.zip(&self.fit.solution.values) {
                    let (name, nominal) = (&number.varied.name, number.varied.nominal);
                    if parameters.contains(name) && (value - nominal).abs() > MOVED * step_s {
                        let value = engineering(*value, Dimension::TIME);
                        found.push(format!(
                            "`{name}` delays `{channel}`, and the observer uses the first term of a Taylor series for its change: calibrate again \
                             with the value that was found, `--set {name}='{value}'`"
                        ));
                    }
                }
            }
        }
        found
    }

    /// Sentences about the weights, where an experiment weighs otherwise than its noise says.
    pub fn doubtful_weights(&self) -> Vec<String> {
        let weights = self.weights();
        let least = weights.iter().filter(|own| own.count > 0);
        let least = least
            .map(|own| own.mean_square)
            .fold(f64::INFINITY, f64::min);
        let mut found = Vec::new();
        if self.calibration.experiments.len() < 2 {
            return found;
        }
        for (own, weight) in self.calibration.experiments.iter().zip(&weights) {
            let name = experiment_name(own);
            let times = weight.mean_square.sqrt();
            if weight.count > 0 && times > 1.5 && weight.mean_square > 2.0 * least {
                found.push(format!(
                    "the innovations of `{name}` are {} times as large as its declared noise explains, so it weighs more than it should: \
                     declare its noise, `measured … ~ 20 [mA];`, or search for the missing effect with `hyde diagnose`",
                    significant(times, 2)
                ));
            }
            if weight.count > 0 && times < 0.5 {
                found.push(format!(
                    "the innovations of `{name}` are {} times as large as its declared noise explains, so it weighs less than it could: declare \
                     a smaller noise",
                    significant(times, 2)
                ));
            }
            let measured = own.compiled.program.experiment.measured.iter();
            for (channel, noise) in measured.zip(&own.observer.noise) {
                if noise.to_bits() == UNDECLARED_NOISE.to_bits() {
                    found.push(format!(
                        "`{}` of `{name}` declares no noise and counts as exact to {UNDECLARED_NOISE:e} (SI), which decides its weight: declare it, `measured … ~ 20 [mA];`",
                        channel.name
                    ));
                }
            }
        }
        found
    }
}

/// The experiment of a fitted part.
pub fn experiment(calibration: &JointCalibration, part: usize) -> &Calibration {
    let part = calibration.fitted_parts().nth(part);
    let number = part.map_or(0, |part| calibration.parts[part].experiment);
    &calibration.experiments[number]
}

/// The name of an experiment.
pub fn experiment_name(calibration: &Calibration) -> &str {
    calibration.project.experiment.as_deref().unwrap_or("")
}

/// The program that has a number's parameter.
fn program_of(calibration: &JointCalibration, number: usize) -> Option<&Program> {
    let part = calibration
        .parts
        .iter()
        .find(|part| part.of.contains(&number))?;
    Some(&calibration.experiments[part.experiment].compiled.program)
}

/// The unit of a number.
pub fn unit(calibration: &JointCalibration, number: usize) -> Option<&NamedUnit> {
    let name = &calibration.numbers[number].varied.name;
    let (parameter, _) = program_of(calibration, number)?.parameter(name)?;
    Some(&parameter.unit)
}

/// The SI unit of a number, as files have it.
pub fn si_unit(calibration: &JointCalibration, number: usize) -> Option<String> {
    let name = &calibration.numbers[number].varied.name;
    let (parameter, _) = program_of(calibration, number)?.parameter(name)?;
    Some(parameter.dimension.usual_unit())
}

/// A value of a number, in its unit.
pub fn shown(calibration: &JointCalibration, number: usize, value: f64) -> String {
    match unit(calibration, number) {
        Some(unit) => engineering_as(value, unit),
        None => significant(value, 5),
    }
}

/// A difference of two values of a number, in its unit.
pub fn shown_difference(calibration: &JointCalibration, number: usize, by: f64) -> String {
    match unit(calibration, number) {
        Some(unit) => engineering_difference(by, unit),
        None => significant(by, 5),
    }
}

/// Names as a sentence has them.
pub fn named(calibration: &JointCalibration, numbers: &[usize]) -> String {
    let each = numbers.iter();
    let each = each.map(|&number| format!("`{}`", calibration.numbers[number].name()));
    each.collect::<Vec<_>>().join(", ")
}
