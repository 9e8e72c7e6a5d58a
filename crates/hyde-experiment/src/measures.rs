//! Measures and expectations: numbers of a run, and what must hold of them.

use hyde_program::{Program, ReductionKind};
use hyde_sim::{Reduced, Results};
use hyde_units::significant;

/// A measure or an expectation.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureValue {
    /// Its name, or the expectation as written.
    pub name: String,
    /// Its value, SI; of an expectation 1 where it holds, else 0. NaN where there is none.
    pub value: f64,
    /// Whether it must hold.
    pub expectation: bool,
    /// Whether it does; of a mere measure false where a signal is not a number.
    pub holds: bool,
    /// Why there is no finite value, or why an expectation does not hold.
    pub missing: Option<Missing>,
}

/// Why a measure has no finite value.
#[derive(Clone, Debug, PartialEq)]
pub enum Missing {
    /// A variable that it reads is not a number.
    NotANumber {
        /// The variable.
        variable: String,
        /// When first, in s.
        t: f64,
    },
    /// What it reads has no value, as written: a condition that never holds, a signal without a resonance.
    Nothing(String),
    /// What it reads is infinite, as written.
    Infinite(String),
    /// What it reads is infinite because the signal does not settle before the end of the run, as written.
    Unsettled(String),
    /// Its own arithmetic: 0/0, 1/0.
    Undefined,
}

impl Missing {
    /// The reason in words.
    #[must_use]
    pub fn text(&self) -> String {
        match self {
            Self::NotANumber { variable, t } => {
                let t = significant(*t, 7);
                format!("`{variable}` is not a number, first at {t} s")
            }
            Self::Nothing(text) => format!("`{text}` has no value in this run"),
            Self::Infinite(text) => format!("`{text}` is infinite"),
            Self::Unsettled(text) => {
                format!("`{text}` is infinite: the signal is not in its band at the end of the run")
            }
            Self::Undefined => "its arithmetic gives no finite number, like 0/0 or 1/0".to_owned(),
        }
    }
}

/// The measures and expectations of a solution. What is not a number makes none hold.
pub(crate) fn measures(
    program: &Program,
    parameters: &[f64],
    results: &Results,
) -> Vec<MeasureValue> {
    let experiment = &program.experiment;
    let reduced = &results.reductions;
    let number = |reduced: &Reduced| match reduced {
        Reduced::Value(value) => *value,
        Reduced::Nothing | Reduced::NotANumber { .. } => f64::NAN,
    };
    let reductions: Vec<f64> = reduced.iter().map(number).collect();
    let mut values = vec![0.0; experiment.measures.len()];
    let kernels = &program.kernels;
    kernels.measures(parameters, &reductions, &mut values);
    let missing = |measure: &hyde_program::Measure, value: f64| {
        let reads = || {
            measure
                .reductions
                .iter()
                .filter_map(|&n| Some((n, reduced.get(n)?)))
        };
        let bad = reads().find_map(|(_, reduced)| match reduced {
            Reduced::NotANumber { t, variable } => Some(Missing::NotANumber {
                variable: variable.clone(),
                t: *t,
            }),
            Reduced::Value(_) | Reduced::Nothing => None,
        });
        let in_doubt = !value.is_finite() || (measure.expectation && value <= 0.5);
        if bad.is_some() || !in_doubt {
            return bad;
        }
        let infinite = reads()
            .find(|(_, reduced)| matches!(reduced, Reduced::Value(value) if value.is_infinite()));
        if let Some((number, _)) = infinite {
            let reduction = &experiment.reductions[number];
            let text = reduction.text.clone();
            let settles = matches!(reduction.kind, ReductionKind::Settling);
            return Some(match settles {
                true => Missing::Unsettled(text),
                false => Missing::Infinite(text),
            });
        }
        if value.is_finite() {
            return None;
        }
        let nothing = reads().find(|(_, reduced)| **reduced == Reduced::Nothing);
        let text = nothing.map(|(number, _)| experiment.reductions[number].text.clone());
        Some(text.map_or(Missing::Undefined, Missing::Nothing))
    };
    let pairs = experiment.measures.iter().zip(values);
    pairs
        .map(|(measure, value)| {
            let missing = missing(measure, value);
            let is_number = !matches!(missing, Some(Missing::NotANumber { .. }));
            MeasureValue {
                name: measure.name.clone(),
                value: if is_number { value } else { f64::NAN },
                expectation: measure.expectation,
                // A truth is 0 or 1; one without a value does not hold.
                holds: is_number && (!measure.expectation || value > 0.5),
                missing,
            }
        })
        .collect()
}
