//! [`Varied`]: a parameter that calibration may change, with what is known of it beforehand.

use hyde_program::{Parameter, Prior, Program};
use hyde_units::Kind;

/// A parameter of which no range is declared may be so many times further off than it is said to be known. Further away a
/// model that lacks something drives its parameters where no part can be: a soft nut for backlash.
const FURTHER: f64 = 3.0;
/// A parameter known to some per cent keeps its sign, and so much of its value.
const LEAST: f64 = 0.01;

/// A parameter that calibration may change.
#[derive(Clone, Debug, PartialEq)]
pub struct Varied {
    /// Its full name.
    pub name: String,
    /// Position in the parameter vector.
    pub place: usize,
    /// Declared value, SI.
    pub nominal: f64,
    /// Standard deviation of what is known beforehand, SI; `None` if nothing is.
    pub prior: Option<f64>,
    /// How far it may go, SI.
    pub bounds: (f64, f64),
    /// A change of it that can be seen, SI, where that is known.
    pub visible: Option<f64>,
}

impl Varied {
    /// Every uncertain parameter of a program that a fit can move by small steps. `p` are the declared values.
    #[must_use]
    pub fn uncertain(program: &Program, p: &[f64]) -> Vec<Self> {
        let known = program
            .parameters
            .iter()
            .filter(|q| q.prior.is_some() && Self::moves(q));
        known
            .flat_map(|parameter| Self::of(program, &parameter.name, p))
            .collect()
    }

    /// The elements of a parameter; none if there is no such, or it cannot be varied.
    #[must_use]
    pub fn of(program: &Program, name: &str, p: &[f64]) -> Vec<Self> {
        let Some((parameter, element)) = program.parameter(name) else {
            return Vec::new();
        };
        if !Self::moves(parameter) {
            return Vec::new();
        }
        let whole = parameter.name == name;
        let elements = if whole {
            0..parameter.len
        } else {
            element..element + 1
        };
        elements
            .map(|element| {
                let nominal = p[parameter.place + element];
                // `~ ±a%` is uniform; a normal distribution of the same variance takes its place.
                let prior = parameter.prior.map(|prior| match prior {
                    Prior::Relative(part) => (part * nominal).abs() / 3.0_f64.sqrt(),
                    Prior::Absolute(width) => width.abs() / 3.0_f64.sqrt(),
                });
                Self {
                    name: parameter.element_name(element),
                    place: parameter.place + element,
                    nominal,
                    prior: prior.filter(|sd| *sd > 0.0),
                    bounds: parameter
                        .range
                        .unwrap_or_else(|| bounds(parameter.prior, nominal)),
                    visible: None,
                }
            })
            .collect()
    }

    /// Whether small steps can move a parameter: not one that changes the equations, nor an Integer or a Boolean.
    fn moves(parameter: &Parameter) -> bool {
        !parameter.structural && parameter.allowed.kind == Kind::Real
    }

    /// What the parameter is measured in: a visible change, its prior, a tenth of its value or of its range.
    #[must_use]
    pub fn scale(&self) -> f64 {
        let range = self.bounds.1 - self.bounds.0;
        match self.visible.or(self.prior) {
            Some(scale) => scale,
            None if self.nominal != 0.0 => 0.1 * self.nominal.abs(),
            None if range.is_finite() => 0.1 * range,
            None => 1.0,
        }
    }
}

/// How far a parameter may go of which no range is declared.
fn bounds(prior: Option<Prior>, nominal: f64) -> (f64, f64) {
    let (width, relative) = match prior {
        Some(Prior::Relative(part)) => (part.abs() * nominal.abs(), part.abs() < 1.0),
        Some(Prior::Absolute(width)) => (width.abs(), false),
        None => return (f64::NEG_INFINITY, f64::INFINITY),
    };
    let (mut low, mut high) = (nominal - FURTHER * width, nominal + FURTHER * width);
    if relative && nominal > 0.0 {
        low = low.max(LEAST * nominal);
    }
    if relative && nominal < 0.0 {
        high = high.min(LEAST * nominal);
    }
    (low, high)
}
