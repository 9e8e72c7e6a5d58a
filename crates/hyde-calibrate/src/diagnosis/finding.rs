//! [`Finding`]: an effect that was taken in, its sizes and shapes with what the records tell of each.

use super::apart::{Alternative, Relation};
use super::hypothesis::{Hypothesis, Knob};
use super::stage::Stage;
use crate::fit::{covariance, inflation};
use hyde_signal::statistics::distributions::TWO_SIDED;
use hyde_units::{Dimension, NamedUnit};

/// A quantity that was found, SI.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name in the effect.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its 95 % interval.
    pub interval: (f64, f64),
    /// The unit that it is declared in.
    pub unit: NamedUnit,
}

impl Quantity {
    /// Whether the interval leaves out 0, the neutral value of a size.
    #[must_use]
    pub fn is_told(&self) -> bool {
        self.interval.0 > 0.0 || self.interval.1 < 0.0
    }
}

/// An effect that was taken in.
#[derive(Clone, Debug)]
pub struct Finding {
    /// Number of the hypothesis.
    pub hypothesis: usize,
    /// Its size: of a sine and a cosine their amplitude, of several sizes the first whose interval leaves out 0.
    pub size: Quantity,
    /// All its sizes.
    pub sizes: Vec<Quantity>,
    /// Its shapes; the phase of a pair behind them.
    pub shapes: Vec<Quantity>,
    /// The number of the round that took it in.
    pub round: usize,
    /// Other hypotheses that the records cannot tell from it.
    pub alternatives: Vec<Alternative>,
}

/// What is known of an effect that was taken in beside its quantities.
pub(crate) struct Taken {
    /// The number of the round.
    pub(crate) round: usize,
    /// What the records cannot tell from it.
    pub(crate) alternatives: Vec<Alternative>,
}

impl Finding {
    /// What is known of it beside its quantities.
    pub(super) fn taken(&self) -> Taken {
        Taken {
            round: self.round,
            alternatives: self.alternatives.clone(),
        }
    }

    /// What it is as large as: the amplitude of a sine and a cosine, else all its sizes.
    #[must_use]
    pub fn told_sizes(&self) -> &[Quantity] {
        match self.sizes.iter().any(|own| own.name == self.size.name) {
            true => &self.sizes,
            false => std::slice::from_ref(&self.size),
        }
    }

    /// The hypotheses that records cannot tell from it and that are in a relation to it.
    pub fn related(&self, relation: Relation) -> impl Iterator<Item = &Alternative> {
        let all = self.alternatives.iter();
        all.filter(move |other| other.relation == relation)
    }
}

/// The effects with their quantities and intervals.
pub(super) fn findings(
    stage: &Stage,
    hypotheses: &[Hypothesis],
    taken: Vec<Taken>,
) -> Vec<Finding> {
    let covariance = covariance(&stage.solution, inflation(&stage.solution.innovations));
    let values = stage.values();
    let number_of = |name: &str| stage.varied.iter().position(|varied| varied.name == name);
    let quantity = |knob: &Knob, name: &str| {
        let value = values
            .iter()
            .rev()
            .find(|(known, _)| known == name)
            .map_or(knob.value, |(_, v)| *v);
        let interval = match number_of(name) {
            Some(number) => {
                let deviation = covariance[(number, number)].max(0.0).sqrt();
                let half = TWO_SIDED * deviation * stage.varied[number].scale();
                (value - half, value + half)
            }
            // As declared, for the records do not determine it ([`super::undetermined`]).
            None if !knob.integer && value.to_bits() == knob.value.to_bits() => knob.range,
            None => (value, value),
        };
        Quantity {
            name: knob.name.clone(),
            value,
            interval,
            unit: knob.unit.clone(),
        }
    };
    let each = stage.effects.iter().zip(taken);
    each.map(|((number, path), taken)| {
        let hypothesis = &hypotheses[*number];
        let of = |knobs: &[Knob]| -> Vec<Quantity> {
            let names = Hypothesis::names(knobs, path);
            knobs
                .iter()
                .zip(names)
                .map(|(knob, name)| quantity(knob, &name))
                .collect()
        };
        let (sizes, mut shapes) = (of(&hypothesis.sizes), of(&hypothesis.shapes));
        // Of several that make the effect what it is, one that is told.
        let essential = sizes.iter().take(hypothesis.essential());
        let told = essential.clone().find(|size| size.is_told());
        let mut size = told.or(sizes.first()).cloned().unwrap_or(Quantity {
            name: String::new(),
            value: f64::NAN,
            interval: (f64::NAN, f64::NAN),
            unit: NamedUnit::usual(Dimension::DIMENSIONLESS),
        });
        if hypothesis.is_pair() {
            let (s, c) = (sizes[0].value, sizes[1].value);
            let amplitude = s.hypot(c);
            let half = |quantity: &Quantity| (quantity.interval.1 - quantity.interval.0) / 2.0;
            let (a, b) = (half(&sizes[0]), half(&sizes[1]));
            let width = (s * a).hypot(c * b) / amplitude;
            let turn = (c * a).hypot(s * b) / (amplitude * amplitude);
            size = Quantity {
                name: "amplitude".to_owned(),
                value: amplitude,
                interval: (amplitude - width, amplitude + width),
                unit: sizes[0].unit.clone(),
            };
            let phase = c.atan2(s);
            shapes.push(Quantity {
                name: "phase".to_owned(),
                value: phase,
                interval: (phase - turn, phase + turn),
                unit: NamedUnit::usual(Dimension::ANGLE),
            });
        }
        Finding {
            hypothesis: *number,
            size,
            sizes,
            shapes,
            round: taken.round,
            alternatives: taken.alternatives,
        }
    })
    .collect()
}
