//! [`Hypothesis`]: an effect at a site of the model where it fits.

use hyde_program::Program;
use hyde_units::NamedUnit;

/// Numerics: values are on a bound that are so near it, of the range.
const NEAR: f64 = 1e-6;

/// A size or a shape.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// Its name in the effect.
    pub name: String,
    /// Its declared value, SI.
    pub value: f64,
    /// The values it may have, SI.
    pub range: (f64, f64),
    /// Whether it counts something.
    pub integer: bool,
    /// The unit that it is declared in.
    pub unit: NamedUnit,
}

impl Knob {
    /// Whether it is a bare number, as an order is.
    #[must_use]
    pub fn is_number(&self) -> bool {
        self.unit.text() == "1"
    }

    /// Whether a value is on a bound of its range that is neither 0 nor what is declared, which are simpler laws.
    #[must_use]
    pub fn is_at_bound(&self, value: f64) -> bool {
        let near = NEAR * (self.range.1 - self.range.0);
        let simple = value.abs() <= near || (value - self.value).abs() <= near;
        is_on_bound(value, self.range) && !simple
    }

    /// Whether a value lies outside of its range.
    #[must_use]
    pub fn is_beyond(&self, value: f64) -> bool {
        let near = NEAR * (self.range.1 - self.range.0);
        value < self.range.0 - near || value > self.range.1 + near
    }
}

/// Whether a value is on a bound of a range.
pub(crate) fn is_on_bound(value: f64, (low, high): (f64, f64)) -> bool {
    let near = NEAR * (high - low);
    (value - low).abs() <= near || (value - high).abs() <= near
}

/// An effect at a site.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// The effect's name: its id in reports.
    pub effect: String,
    /// Path of the instance it is put on.
    pub site: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
    /// Where all of them are 0 it vanishes.
    pub sizes: Vec<Knob>,
    /// What says how it looks.
    pub shapes: Vec<Knob>,
    /// The shape that is a period in space or an order of an angle, if it has one.
    pub periodic: Option<usize>,
    /// The shape that is the frequency of a resonance, if it has one.
    pub resonant: Option<usize>,
    /// Whether its signature says that it comes again: with a period, an order, or an angle.
    pub recurs: bool,
}

impl Hypothesis {
    /// Whether its two sizes are those of a sine and a cosine: of what comes again, in one unit, `As` and `Ac`.
    #[must_use]
    pub fn is_pair(&self) -> bool {
        let [a, b] = self.sizes.as_slice() else {
            return false;
        };
        let stem = |name: &str, ending: char| name.strip_suffix(ending).map(str::to_owned);
        let alike = a.unit.unit().dimension == b.unit.unit().dimension;
        self.recurs
            && alike
            && stem(&a.name, 's').is_some()
            && stem(&a.name, 's') == stem(&b.name, 'c')
    }

    /// How many of its sizes make it what it is: the first, and those of its unit behind that. A spring with a pull beside its
    /// stiffness is a constant force where it has none.
    pub(crate) fn essential(&self) -> usize {
        let dimension = |size: &Knob| size.unit.unit().dimension;
        let first = self.sizes.first().map(dimension);
        let alike = |size: &&Knob| Some(dimension(size)) == first;
        self.sizes.iter().take_while(alike).count()
    }

    /// Whether it may be there twice: with another period, order or frequency. All else would be one that is larger.
    pub(crate) fn repeats(&self) -> bool {
        self.periodic.is_some() || self.resonant.is_some()
    }

    /// Full names of sizes and shapes for an instance at a path.
    pub(crate) fn names(knobs: &[Knob], path: &str) -> Vec<String> {
        knobs
            .iter()
            .map(|knob| format!("{path}.{}", knob.name))
            .collect()
    }
}

/// A model with effects put on.
pub struct Built {
    /// The program in the observed form, the effects kept though their sizes are 0.
    pub program: Program,
    /// Paths of the effects' instances, in the order asked for.
    pub paths: Vec<String>,
}

/// Whether a program has modes or relations beside those of the program before an effect was put on.
pub(crate) fn brings_modes(program: &Program, before: &Program) -> bool {
    program.automata.len() > before.automata.len()
        || program.relations.len() > before.relations.len()
}

/// Puts hypotheses, by number, on the model; `None` where they cannot be together.
pub(crate) type Build<'a> = dyn Fn(&[usize]) -> Option<Built> + Sync + 'a;

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_units::Dimension;

    #[test]
    fn a_sine_and_a_cosine_come_again_and_have_one_unit() {
        let knob = |name: &str, dimension| Knob {
            name: name.to_owned(),
            value: 0.0,
            range: (-1.0, 1.0),
            integer: false,
            unit: NamedUnit::usual(dimension),
        };
        let hypothesis = |names: [&str; 2], second, recurs| Hypothesis {
            effect: "E".to_owned(),
            site: "guide".to_owned(),
            aliases: Vec::new(),
            sizes: vec![knob(names[0], Dimension::LENGTH), knob(names[1], second)],
            shapes: Vec::new(),
            periodic: None,
            resonant: None,
            recurs,
        };
        let length = Dimension::LENGTH;
        assert!(hypothesis(["as", "ac"], length, true).is_pair());
        assert!(!hypothesis(["as", "ac"], length, false).is_pair());
        assert!(!hypothesis(["as", "ac"], Dimension::TIME, true).is_pair());
        assert!(!hypothesis(["as", "bc"], length, true).is_pair());
        assert!(!hypothesis(["e1", "e2"], length, true).is_pair());
    }
}
