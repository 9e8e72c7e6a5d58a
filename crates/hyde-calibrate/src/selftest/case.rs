//! [`Case`]: what is planted in a set of simulated records, and all random numbers of it.

use super::random::Random;
use crate::diagnosis::{Hypothesis, Knob};
use crate::fit::Varied;

/// Shapes are drawn between their declared value over this and times this.
const SHAPES: f64 = 3.0;
/// Shapes declared 0 are drawn within this part of their range.
const ABOUT_ZERO: f64 = 0.02;
/// A parameter is off by so many times what it is uncertain by.
const OFF: f64 = 2.0;
/// The first of every so many hypotheses is planted and withheld from the search, where no effects are named.
const OPEN_SET: usize = 4;

/// How large a planted effect is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// A part of its range.
    Part(f64),
    /// So many times the size at which it begins to show on this axis.
    Detectable(f64),
}

/// What a sensor does that no effect of a drive does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Three times the declared noise.
    Noise,
    /// One row in 200 is far off.
    Spikes,
    /// Twice, for a tenth of a second, the value stands still.
    Frozen,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Noise, Self::Spikes, Self::Frozen];

    /// As reports call it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Noise => "noise",
            Self::Spikes => "spikes",
            Self::Frozen => "frozen",
        }
    }
}

/// What is planted.
#[derive(Clone, Debug, PartialEq)]
pub enum Planting {
    /// A hypothesis, by number, at a size.
    Planted(usize, Size),
    /// Nothing.
    Empty,
    /// A parameter, by number, that is further off than declared.
    Parameter(usize),
    /// A hypothesis, by number, whose effect the search does not know.
    OpenSet(usize, Size),
    /// A fault of a channel, by number.
    Sensor(usize, Fault),
}

/// A set of simulated records to diagnose.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Its name: says all that it depends on beside axis and seed.
    pub key: String,
    /// What is planted.
    pub kind: Planting,
}

/// Which cases are wanted.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// Effects to plant, or to withhold; all if empty.
    pub effects: Vec<String>,
    /// Sizes of planted effects.
    pub sizes: Vec<Size>,
    /// Sets of random numbers for each planted effect and size.
    pub seeds: usize,
    /// Sets without anything planted.
    pub empties: usize,
    /// Whether to plant effects, wrong parameters, effects withheld from the search, and faults of sensors.
    pub planted: bool,
    /// Wrong parameters.
    pub parameters: bool,
    /// Effects that the search does not know.
    pub open_set: bool,
    /// Faulty sensors.
    pub sensors: bool,
}

/// The cases of an axis, controls first.
#[must_use]
pub fn cases(
    hypotheses: &[Hypothesis],
    varied: &[Varied],
    channels: &[String],
    asked: &Asked,
) -> Vec<Case> {
    let mut all = Vec::new();
    let mut add = |key: String, kind| all.push(Case { key, kind });
    for number in 0..asked.empties {
        add(format!("empty {}", number + 1), Planting::Empty);
    }
    let uncertain = |(number, varied): (usize, &Varied)| varied.prior.map(|_| number);
    if asked.parameters {
        for number in varied.iter().enumerate().filter_map(uncertain) {
            let key = format!("parameter {}", varied[number].name);
            add(key, Planting::Parameter(number));
        }
    }
    if asked.sensors {
        for (number, channel) in channels.iter().enumerate() {
            for fault in Fault::ALL {
                let key = format!("sensor {channel} {}", fault.name());
                add(key, Planting::Sensor(number, fault));
            }
        }
    }
    let is_wanted = |hypothesis: &Hypothesis| {
        asked.effects.is_empty() || asked.effects.contains(&hypothesis.effect)
    };
    let wanted = || {
        let each = hypotheses.iter().enumerate();
        each.filter(|(_, hypothesis)| is_wanted(hypothesis))
    };
    let largest = asked.sizes.iter().copied().reduce(larger);
    if let (true, Some(size)) = (asked.open_set, largest) {
        let all = asked.effects.is_empty();
        let every = if all { OPEN_SET } else { 1 };
        for (number, hypothesis) in wanted().step_by(every) {
            let key = format!("unknown {} {}", named(hypothesis), shown(size));
            add(key, Planting::OpenSet(number, size));
        }
    }
    if asked.planted {
        for (number, hypothesis) in wanted() {
            for &size in &asked.sizes {
                for seed in 0..asked.seeds {
                    let (name, size_name) = (named(hypothesis), shown(size));
                    let key = format!("planted {name} {size_name} {}", seed + 1);
                    add(key, Planting::Planted(number, size));
                }
            }
        }
    }
    all
}

impl Case {
    /// Its random numbers for a purpose.
    pub(super) fn random(&self, seed: u64, purpose: &str) -> Random {
        Random::new(seed, &format!("{} / {purpose}", self.key))
    }

    /// The parameters of the axis: uniform within what is declared.
    pub(super) fn parameters(&self, seed: u64, varied: &[Varied]) -> Vec<(String, f64)> {
        let mut random = self.random(seed, "parameters");
        let each = varied.iter().enumerate().map(|(number, varied)| {
            // The declared range is uniform; `Varied` has the deviation of it.
            let half = varied.prior.unwrap_or(0.0) * 3.0_f64.sqrt();
            let part = random.between(-1.0, 1.0);
            let off = match self.kind {
                Planting::Parameter(wrong) if wrong == number => OFF * part.signum(),
                Planting::Parameter(_) => 0.0,
                Planting::Planted(..)
                | Planting::Empty
                | Planting::OpenSet(..)
                | Planting::Sensor(..) => part,
            };
            let value = varied.nominal + off * half;
            let (low, high) = varied.bounds;
            (varied.name.clone(), value.clamp(low, high))
        });
        each.collect()
    }

    /// Sizes of unit largeness, and shapes, of a hypothesis: sizes are these times a part of the range.
    pub(super) fn direction(&self, seed: u64, hypothesis: &Hypothesis) -> (Vec<f64>, Vec<f64>) {
        let mut random = self.random(seed, "effect");
        let shapes = hypothesis.shapes.iter();
        let shapes = shapes.map(|knob| drawn(knob, &mut random)).collect();
        let sizes = if hypothesis.is_pair() {
            let phase = random.between(0.0, std::f64::consts::TAU);
            let most = largest(&hypothesis.sizes[0]);
            vec![most * phase.cos(), most * phase.sin()]
        } else {
            let mut each = |knob: &Knob| {
                let both = knob.range.0 < 0.0 && knob.range.1 > 0.0;
                let sign = random.sign();
                largest(knob) * if both { sign } else { 1.0 }
            };
            hypothesis.sizes.iter().map(&mut each).collect()
        };
        (sizes, shapes)
    }
}

/// The larger bound of a range, in size.
pub(super) fn largest(knob: &Knob) -> f64 {
    if knob.range.1.abs() >= knob.range.0.abs() {
        knob.range.1
    } else {
        knob.range.0
    }
}

fn drawn(knob: &Knob, random: &mut Random) -> f64 {
    let (low, high) = knob.range;
    let value = if knob.value == 0.0 {
        let half = ABOUT_ZERO * 0.5 * (high - low);
        random.between(-half, half)
    } else {
        knob.value * SHAPES.powf(random.between(-1.0, 1.0))
    };
    let value = if knob.integer { value.round() } else { value };
    value.clamp(low, high)
}

fn larger(a: Size, b: Size) -> Size {
    let rank = |size| match size {
        Size::Part(part) => (1, part),
        Size::Detectable(times) => (0, times),
    };
    let (ra, rb) = (rank(a), rank(b));
    if rb.0 > ra.0 || (rb.0 == ra.0 && rb.1 > ra.1) {
        b
    } else {
        a
    }
}

fn named(hypothesis: &Hypothesis) -> String {
    format!("{}@{}", hypothesis.effect, hypothesis.site)
}

fn shown(size: Size) -> String {
    match size {
        Size::Part(part) => format!("{part}"),
        Size::Detectable(times) => format!("{times}x"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn knob(value: f64, range: (f64, f64), integer: bool) -> Knob {
        let unit = hyde_units::NamedUnit::usual(hyde_units::Dimension::DIMENSIONLESS);
        Knob {
            name: String::new(),
            value,
            range,
            integer,
            unit,
        }
    }

    #[test]
    fn shapes_are_drawn_about_their_declared_values_and_inside_their_ranges() {
        let mut random = Random::new(1, "test");
        for _ in 0..200 {
            let speed = drawn(&knob(5.0, (0.1, 10.0), false), &mut random);
            assert!((5.0 / 3.0..=10.0).contains(&speed), "{speed}");
            let place = drawn(&knob(0.0, (-1.0, 1.0), false), &mut random);
            assert!(place.abs() <= 0.02, "{place}");
            let order = drawn(&knob(12.0, (1.0, 200.0), true), &mut random);
            assert!(
                order.fract() == 0.0 && (4.0..=36.0).contains(&order),
                "{order}"
            );
        }
    }

    #[test]
    fn controls_come_first_and_keys_are_all_different() {
        let hypothesis = |effect: &str| Hypothesis {
            effect: effect.to_owned(),
            site: "guide".to_owned(),
            aliases: Vec::new(),
            sizes: vec![knob(0.0, (0.0, 1.0), false)],
            shapes: Vec::new(),
            periodic: None,
            resonant: None,
            recurs: false,
        };
        let hypotheses = [hypothesis("A"), hypothesis("B")];
        let asked = Asked {
            effects: Vec::new(),
            sizes: vec![Size::Part(0.1), Size::Detectable(0.5)],
            seeds: 3,
            empties: 2,
            planted: true,
            parameters: true,
            open_set: true,
            sensors: true,
        };
        let all = cases(&hypotheses, &[], &["x".to_owned()], &asked);
        // Two empty, three faults, one effect withheld, 2 x 2 x 3 planted.
        assert_eq!(all.len(), 2 + 3 + 1 + 12);
        assert_eq!(all[0].kind, Planting::Empty);
        assert_eq!(all[5].kind, Planting::OpenSet(0, Size::Part(0.1)));
        let mut keys: Vec<&str> = all.iter().map(|case| case.key.as_str()).collect();
        keys.sort_unstable();
        keys.dedup();
        assert_eq!(keys.len(), all.len());

        let named = Asked {
            effects: vec!["B".to_owned()],
            ..asked
        };
        let all = cases(&hypotheses, &[], &["x".to_owned()], &named);
        assert_eq!(all.len(), 2 + 3 + 1 + 6);
        assert_eq!(all[5].kind, Planting::OpenSet(1, Size::Part(0.1)));
    }
}
