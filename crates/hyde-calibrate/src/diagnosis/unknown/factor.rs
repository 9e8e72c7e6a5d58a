//! [`Factor`]: a shape of the library or of the user's packages with its constants, as a law multiplies it. It is evaluated
//! along a record by the evaluator of the IR, and written from the same expressions.

use super::latent::Course;
use super::seen::Seen;
use super::site::Kind;
use hyde_ir::{
    Along, Expr, ExprId, LawAxis, LawInput, LawPiece, LawRole, LawShape, LawStep, LawText, LawUnit,
};
use hyde_units::{Dimension, NamedUnit};
use std::convert::Infallible;
use std::sync::Arc;

/// A shape with its constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Factor {
    shape: Arc<LawShape>,
    /// SI.
    constants: Vec<f64>,
}

/// A constant of a shape as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    pub(crate) stem: String,
    pub(crate) value: f64,
    pub(crate) range: (f64, f64),
    pub(crate) unit: NamedUnit,
}

/// How a search changes a constant at first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Step {
    /// By so much, SI.
    Added(f64),
    /// By so much of its logarithm.
    Ratio(f64),
}

/// The axes of a site.
const AXES: [LawAxis; 5] = [
    LawAxis::Speed,
    LawAxis::Place,
    LawAxis::Acceleration,
    LawAxis::Signal,
    LawAxis::Time,
];

/// Whether a shape is tried at a kind of site: of each variable that it is a function of, a role fits, and the records show it.
pub(crate) fn is_tried(shape: &LawShape, kind: &Kind, seen: &Seen) -> bool {
    AXES.iter().all(|&axis| {
        let mut roles = shape.roles.iter().filter(|role| role.axis() == axis);
        let named = roles.clone().next().is_some();
        let shown = match axis {
            LawAxis::Acceleration => seen.acceleration > 0.0,
            LawAxis::Signal => seen.signal > 0.0,
            LawAxis::Speed | LawAxis::Place | LawAxis::Time => true,
        };
        !named || shown && roles.any(|&role| kind.has(role))
    })
}

/// Whether a shape is one of the speed, which those of other variables multiply.
pub(crate) fn is_of_speed(shape: &LawShape) -> bool {
    let mut roles = shape.roles.iter();
    roles.all(|role| matches!(role, LawRole::Speed | LawRole::Slip | LawRole::Rate))
}

impl Factor {
    /// A shape with each of the values of its constants that a search begins with.
    pub(crate) fn tried<'a>(
        shape: &'a Arc<LawShape>,
        seen: &'a Seen,
    ) -> impl Iterator<Item = Self> + use<'a> {
        (0..shape.count()).map(move |number| {
            let mut factor = Self {
                shape: Arc::clone(shape),
                constants: Vec::new(),
            };
            for constant in &shape.constants {
                let values = &constant.values;
                let value = values.get(number).or(values.last());
                let value = value.map_or(f64::NAN, |value| factor.number(*value, seen));
                factor.constants.push(value);
            }
            factor
        })
    }

    /// What it is at a kind of site, in words; numbers are SI.
    #[must_use]
    pub fn words(&self, kind: &Kind) -> String {
        let [place, speed] = kind.variables();
        let constants = self.shape.constants.iter().zip(&self.constants);
        let numbers = constants.map(|(constant, value)| {
            let number = hyde_units::significant(*value, 3);
            (constant.name.as_str(), number)
        });
        let variables = [
            ("x", place),
            ("v", speed),
            ("a", "acceleration".to_owned()),
            ("u", kind.signal()),
        ];
        let words = variables.into_iter().chain(numbers);
        words.fold(self.shape.words.clone(), |text, (name, word)| {
            text.replace(&format!("{{{name}}}"), &word)
        })
    }

    /// Its constants.
    pub(crate) fn constants(&self) -> &[f64] {
        &self.constants
    }

    /// The same shape with other constants.
    pub(crate) fn with(&self, constants: &[f64]) -> Self {
        Self {
            shape: Arc::clone(&self.shape),
            constants: constants.to_vec(),
        }
    }

    /// Whether another one is the same shape, whatever its constants.
    pub(crate) fn has_shape_of(&self, other: &Self) -> bool {
        self.shape == other.shape
    }

    /// Whether what the records show is enough of the shape to tell its constants.
    pub(crate) fn is_told(&self, seen: &Seen) -> bool {
        let constants = self.shape.constants.iter().zip(&self.constants);
        constants.into_iter().all(|(constant, value)| {
            let [from, to] = constant.range.map(|bound| self.number(bound, seen));
            (from..=to).contains(value)
        })
    }

    /// The steps that a search for its constants begins with.
    pub(crate) fn steps(&self, seen: &Seen) -> impl Iterator<Item = Step> {
        let constants = self.shape.constants.iter();
        constants.map(|constant| match constant.step {
            LawStep::Added(step) => Step::Added(self.number(step, seen)),
            LawStep::Ratio(step) => Step::Ratio(self.number(step, seen)),
        })
    }

    /// The names of its values where there are several, as of a sine and a cosine; one without a name otherwise.
    pub(crate) fn values(&self) -> Vec<&str> {
        match self.shape.outputs.as_slice() {
            [_] => vec![""],
            several => several.iter().map(|(name, _)| name.as_str()).collect(),
        }
    }

    /// Its values along a record: a list for each.
    pub(crate) fn along(&self, course: &Course, seen: &Seen) -> Vec<Vec<f64>> {
        let mut filtered: Vec<Vec<f64>> = Vec::new();
        for state in &self.shape.states {
            let time_constant = self.number(state.time_constant.value, seen);
            let input = self.column(&state.input, course, seen, &filtered);
            filtered.push(late(&course.time, time_constant, &input));
        }
        let outputs = self.shape.outputs.iter();
        outputs
            .map(|(_, text)| self.column(text, course, seen, &filtered))
            .collect()
    }

    fn column(
        &self,
        text: &LawText,
        course: &Course,
        seen: &Seen,
        filtered: &[Vec<f64>],
    ) -> Vec<f64> {
        let leaf = |leaf: Expr| -> Result<Along<'_>, Infallible> {
            Ok(match self.shape.input(leaf) {
                Some(LawInput::Variable(LawAxis::Speed)) => Along::Rows(&course.speed),
                Some(LawInput::Variable(LawAxis::Place)) => Along::Rows(&course.place),
                Some(LawInput::Variable(LawAxis::Acceleration)) => {
                    Along::Rows(&course.acceleration)
                }
                Some(LawInput::Variable(LawAxis::Signal)) => Along::Rows(&course.signal),
                Some(LawInput::Variable(LawAxis::Time)) => Along::Rows(&course.time),
                Some(LawInput::State(number)) => match filtered.get(number) {
                    Some(values) => Along::Rows(values),
                    None => Along::Same(f64::NAN),
                },
                Some(
                    LawInput::Round(_)
                    | LawInput::Least(_)
                    | LawInput::Greatest(_)
                    | LawInput::Constant(_),
                )
                | None => Along::Same(self.of_leaf(leaf, seen)),
            })
        };
        let Ok(values) = self.shape.exprs.column(text.value, course.time.len(), leaf);
        values
    }

    /// The value of an expression of its constants and of what records show.
    fn number(&self, expression: ExprId, seen: &Seen) -> f64 {
        let leaf = |leaf: Expr| -> Result<f64, Infallible> { Ok(self.of_leaf(leaf, seen)) };
        let Ok(value) = self.shape.exprs.evaluate(expression, leaf);
        value
    }

    /// The value of an input that is the same in every row.
    fn of_leaf(&self, leaf: Expr, seen: &Seen) -> f64 {
        let scales = seen.scales();
        match self.shape.input(leaf) {
            Some(LawInput::Constant(number)) => {
                self.constants.get(number).copied().unwrap_or(f64::NAN)
            }
            Some(LawInput::Round(LawAxis::Speed)) => scales.speed,
            Some(LawInput::Round(LawAxis::Place)) => scales.place,
            Some(LawInput::Round(LawAxis::Acceleration)) => scales.acceleration,
            Some(LawInput::Round(LawAxis::Signal)) => scales.signal,
            Some(LawInput::Round(LawAxis::Time)) => scales.time,
            Some(LawInput::Least(LawAxis::Speed)) => -seen.speed,
            Some(LawInput::Least(LawAxis::Acceleration)) => -seen.acceleration,
            Some(LawInput::Least(LawAxis::Signal)) => -seen.signal,
            Some(LawInput::Least(LawAxis::Place)) => seen.place.0,
            Some(LawInput::Least(LawAxis::Time)) => seen.time.0,
            Some(LawInput::Greatest(LawAxis::Speed)) => seen.speed,
            Some(LawInput::Greatest(LawAxis::Acceleration)) => seen.acceleration,
            Some(LawInput::Greatest(LawAxis::Signal)) => seen.signal,
            Some(LawInput::Greatest(LawAxis::Place)) => seen.place.1,
            Some(LawInput::Greatest(LawAxis::Time)) => seen.time.1,
            Some(LawInput::Variable(_) | LawInput::State(_)) | None => f64::NAN,
        }
    }

    /// How its values are written, the names of its constants given.
    pub(crate) fn expressions(&self, kind: &Kind, names: &[String]) -> Vec<String> {
        let outputs = self.shape.outputs.iter();
        let texts = outputs.map(|(_, text)| match text.is_sum {
            true => format!("({})", self.text(text, kind, names)),
            false => self.text(text, kind, names),
        });
        texts.collect()
    }

    /// What else has to be written for it: the filters, declared and determined.
    pub(crate) fn equations(&self, kind: &Kind, names: &[String]) -> (String, String) {
        let (mut declared, mut equations) = (String::new(), String::new());
        for (number, state) in self.shape.states.iter().enumerate() {
            let name = self.state(number, names);
            let (unit, doc) = (unit(&state.unit, kind), &state.doc);
            let [time_constant, input] =
                [&state.time_constant, &state.input].map(|text| self.text(text, kind, names));
            declared.push_str(&format!(
                "  Real {name}(start = 0 [{unit}], fixed = true) \"{doc}\";\n"
            ));
            equations.push_str(&format!(
                "  {time_constant}*der({name}) = {input} - {name};\n"
            ));
        }
        (declared, equations)
    }

    fn text(&self, text: &LawText, kind: &Kind, names: &[String]) -> String {
        let named = |number: &usize| match self.shape.inputs.get(*number)? {
            LawInput::Variable(LawAxis::Time) => Some("time".to_owned()),
            LawInput::Variable(axis) => kind.named(*axis).map(|own| own.text.clone()),
            LawInput::Round(LawAxis::Time) => Some(kind.round_time.clone()),
            LawInput::Round(axis) => kind.named(*axis).map(|own| own.round.clone()),
            LawInput::Constant(number) => names.get(*number).cloned(),
            LawInput::State(number) => Some(self.state(*number, names)),
            // No text of a shape has them.
            LawInput::Least(_) | LawInput::Greatest(_) => None,
        };
        let pieces = text.pieces.iter().map(|piece| match piece {
            LawPiece::Letters(letters) => letters.clone(),
            LawPiece::Input(number) => named(number).unwrap_or_default(),
        });
        pieces.collect()
    }

    /// What a filtered value is called: by its first constant there is one of that name.
    fn state(&self, number: usize, names: &[String]) -> String {
        let own = self.shape.states.get(number);
        let own = own.map_or("", |state| &state.name);
        match names.first() {
            Some(first) => format!("{own}_{first}"),
            None => own.to_owned(),
        }
    }

    /// Its constants as they are written, with the ranges that a fit may search.
    pub(crate) fn written(&self, kind: &Kind, seen: &Seen) -> Vec<Constant> {
        let constants = self.shape.constants.iter().zip(&self.constants);
        let written = constants.map(|(constant, value)| {
            let [from, to] = constant.limits.map(|bound| self.number(bound, seen));
            Constant {
                stem: constant.name.clone(),
                value: *value,
                range: (from, to),
                unit: unit(&constant.unit, kind),
            }
        });
        written.collect()
    }

    /// The mark that it leaves.
    pub(crate) fn mark(&self, kind: &Kind, names: &[String]) -> String {
        let (mark, of) = &self.shape.mark;
        let of = of.and_then(|number| names.get(number));
        match (mark.as_str(), of) {
            (mark, Some(name)) => format!("{mark}({name})"),
            ("position", None) => kind.mark_of_place().to_owned(),
            ("current", None) => kind.mark_of_signal().to_owned(),
            (mark, None) => mark.to_owned(),
        }
    }

    /// Which of the round numbers it is written with: speed, place, acceleration, signal, time.
    pub(crate) fn scales(&self) -> [bool; 5] {
        AXES.map(|axis| self.shape.reads(LawInput::Round(axis)))
    }

    /// Whether it is a function of a variable of its site.
    pub(crate) fn reads(&self, axis: LawAxis) -> bool {
        self.shape.reads(LawInput::Variable(axis))
    }
}

/// The unit of a quantity at a kind of site.
fn unit(of: &LawUnit, kind: &Kind) -> NamedUnit {
    match of {
        LawUnit::Of(axis) => match kind.named(*axis) {
            Some(own) => own.unit.clone(),
            None => NamedUnit::usual(Dimension::TIME),
        },
        LawUnit::Own(unit) => unit.clone(),
    }
}

/// What a filter of the first order makes of a course.
fn late(time: &[f64], time_constant: f64, input: &[f64]) -> Vec<f64> {
    let mut state = 0.0;
    let mut last = time.first().copied().unwrap_or(0.0);
    let rows = input.iter().zip(time);
    rows.map(|(value, &t)| {
        state += (1.0 - (-(t - last) / time_constant).exp()) * (value - state);
        last = t;
        state
    })
    .collect()
}
