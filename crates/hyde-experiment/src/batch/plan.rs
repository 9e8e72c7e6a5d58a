//! [`Plan`]: the cases of a sweep. Case k is a pure function of the plan: nothing is stored for each of them.
//!
//! A plan is a product of factors, the last one the fastest: each list and each choice is a factor, so is the table of cases,
//! so are all sampled ranges together. A grid makes a list of each range.

use super::draft::Draft;
use super::layout::Layout;
use super::sample::Points;
use crate::refusals::sweeps as refused;
use hyde_diag::Diagnostic;
use hyde_program::Program;
use hyde_signal::Table;
use hyde_units::NamedUnit;

/// What differs from case to case: a column of the data set.
#[derive(Clone, Debug)]
pub struct Input {
    /// A parameter's name, a start value's as `x.start`, or that of a choice of variants.
    pub name: String,
    /// The unit that a number is printed in; `None` of a choice.
    pub unit: Option<NamedUnit>,
    /// Whether another value compiles anew: choices and structural parameters.
    pub structural: bool,
    /// The texts of a choice.
    pub options: Vec<String>,
}

/// The value of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    /// Of a parameter, SI.
    Number(f64),
    /// The number of a choice's option.
    Option(usize),
}

/// One case.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its number, from 1.
    pub number: usize,
    /// A value for each input of the plan.
    pub values: Vec<Value>,
}

/// What cases that share a program have in common: the values of structural inputs, by the input's number.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Variant(Vec<(usize, u64)>);

/// The cases of a sweep.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What differs.
    pub inputs: Vec<Input>,
    factors: Vec<Factor>,
    count: usize,
}

#[derive(Clone, Debug)]
pub(super) struct Factor {
    /// The inputs that it gives values.
    pub(super) inputs: Vec<usize>,
    pub(super) values: Values,
    pub(super) count: usize,
}

#[derive(Clone, Debug)]
pub(super) enum Values {
    /// The option of that number.
    Options,
    /// One list for each input.
    Lists(Vec<Vec<f64>>),
    /// Points of a range for each input.
    Ranges(Vec<(f64, f64, Points)>),
}

/// What a plan is made for.
pub struct Model<'a> {
    /// The program of the first variant.
    pub program: &'a Program,
    /// Its parameter vector.
    pub parameters: &'a [f64],
    /// The table of cases, if the draft names one.
    pub cases: Option<&'a Table>,
    /// The seed, if it is not the draft's.
    pub seed: Option<u64>,
}

impl Plan {
    /// Makes the plan of a draft for a model.
    ///
    /// # Errors
    /// A diagnostic at what does not fit the model.
    pub fn new(draft: &Draft, model: &Model<'_>) -> Result<Self, Diagnostic> {
        let Layout {
            inputs, factors, ..
        } = Layout::of(draft, model)?;
        let counts = factors.iter().map(|factor| factor.count);
        let count = counts.into_iter().try_fold(1_usize, usize::checked_mul);
        let count = count
            .filter(|&count| count <= 1_000_000_000)
            .ok_or_else(|| refused::too_many_cases(draft.span))?;
        Ok(Self {
            inputs,
            factors,
            count,
        })
    }

    /// How many cases there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.count
    }

    /// Case `number`, from 1 to the count.
    #[must_use]
    pub fn case(&self, number: usize) -> Case {
        let mut values = vec![Value::Option(0); self.inputs.len()];
        let mut rest = number.saturating_sub(1);
        for factor in self.factors.iter().rev() {
            let k = rest % factor.count;
            rest /= factor.count;
            for (place, &input) in factor.inputs.iter().enumerate() {
                values[input] = match &factor.values {
                    Values::Options => Value::Option(k),
                    Values::Lists(lists) => Value::Number(lists[place][k]),
                    Values::Ranges(ranges) => {
                        let (from, to, points) = &ranges[place];
                        Value::Number(from + (to - from) * points.at(k))
                    }
                };
            }
        }
        Case { number, values }
    }

    /// The numbers of a case by the names of their parameters, SI.
    #[must_use]
    pub fn settings(&self, case: &Case) -> Vec<(String, f64)> {
        let pairs = self.inputs.iter().zip(&case.values);
        let numbers = pairs.filter_map(|(input, value)| match value {
            Value::Number(number) => Some((input.name.clone(), *number)),
            Value::Option(_) => None,
        });
        numbers.collect()
    }

    /// The same of what compiles anew: all cases of a variant have these.
    #[must_use]
    pub fn structural_settings(&self, case: &Case) -> Vec<(String, f64)> {
        let structural = |name: &String| {
            let mut own = self.inputs.iter().filter(|input| input.name == *name);
            own.any(|input| input.structural)
        };
        let mut settings = self.settings(case);
        settings.retain(|(name, _)| structural(name));
        settings
    }

    /// Which program a case needs.
    #[must_use]
    pub fn variant(&self, case: &Case) -> Variant {
        let values = self.inputs.iter().zip(&case.values).enumerate();
        let structural = values.filter(|(_, (input, _))| input.structural);
        Variant(
            structural
                .map(|(at, (_, value))| match value {
                    Value::Number(number) => (at, number.to_bits()),
                    Value::Option(option) => (at, *option as u64),
                })
                .collect(),
        )
    }

    /// The option of each choice of a case, in the order of the draft's choices.
    #[must_use]
    pub fn options(&self, case: &Case) -> Vec<usize> {
        let options = case.values.iter().filter_map(|value| match value {
            Value::Option(option) => Some(*option),
            Value::Number(_) => None,
        });
        options.collect()
    }
}
