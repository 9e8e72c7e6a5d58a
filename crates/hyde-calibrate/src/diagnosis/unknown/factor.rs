//! [`Factor`]: the shapes that a law is a product of: of speed, of place, of time. Each can be evaluated along a record, and
//! be written down.

use super::latent::Course;
use super::seen::{Scales, Seen};
use super::site::Kind;
use hyde_units::{Dimension, NamedUnit};

/// A shape, with its constants, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// In proportion to speed.
    Speed,
    /// In proportion to its magnitude.
    Magnitude,
    /// Its square, with the sign of the motion.
    SignedSquare,
    /// Its square.
    Square,
    /// Its third power.
    Cube,
    /// Towards a constant from a speed on: `v/(|v| + vs)`.
    Switching(f64),
    /// To a constant at a speed, and no more beyond it: `tanh(v/vs)`.
    Turning(f64),
    /// As [`Self::Switching`] where it moves forwards, nothing backwards.
    Forwards(f64),
    /// The same where it moves backwards, nothing forwards.
    Backwards(f64),
    /// Falls from a speed on, exponentially.
    Falling(f64),
    /// Falls from a speed on, as a bell.
    Bell(f64),
    /// More about a speed, either way: centre and width.
    SpeedBump(f64, f64),
    /// Speed, late by a filter of the first order: its time constant.
    Lagged(f64),
    /// The speed's magnitude, late by such a filter: how much it has been moved lately. Its time constant.
    Worked(f64),
    /// In proportion to place.
    Place,
    /// The magnitude of place.
    PlaceMagnitude,
    /// The square of place.
    PlaceSquare,
    /// The same with its sign.
    PlaceSignedSquare,
    /// The third power of place.
    PlaceCube,
    /// Towards a constant from a place on, either way: `x/(|x| + x0)`.
    Yielding(f64),
    /// A sine and a cosine over place: period. Of an angle the number of times a turn.
    Wave(f64),
    /// More about a place: centre and width.
    Bump(f64, f64),
    /// From one place on: middle and width of the step.
    Step(f64, f64),
    /// In proportion to time.
    Time,
    /// Fades with time: time constant.
    Fading(f64),
}

/// A constant of a shape as it is written.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Constant {
    pub(crate) stem: &'static str,
    pub(crate) value: f64,
    pub(crate) range: (f64, f64),
    pub(crate) unit: NamedUnit,
}

impl Factor {
    /// What it is at a kind of site, in words; numbers are SI.
    #[must_use]
    pub fn words(self, kind: &Kind) -> String {
        let n = |value: f64| hyde_units::significant(value, 3);
        let [place, speed] = kind.variables();
        match self {
            Self::Speed => format!("the {speed}"),
            Self::Magnitude => format!("the magnitude of the {speed}"),
            Self::SignedSquare => format!("the signed square of the {speed}"),
            Self::Square => format!("the square of the {speed}"),
            Self::Cube => format!("the cube of the {speed}"),
            Self::Switching(a) => format!("the direction, gradually above {}", n(a)),
            Self::Turning(a) => format!("the direction, smoothed over {}", n(a)),
            Self::Forwards(a) => format!("the forward direction only, gradually above {}", n(a)),
            Self::Backwards(a) => format!("the backward direction only, gradually above {}", n(a)),
            Self::Falling(a) => format!("an exponential decrease with {speed} over {}", n(a)),
            Self::Bell(a) => format!("a Gaussian of the {speed} with width {}", n(a)),
            Self::SpeedBump(a, b) => format!("a peak at the {speed} {} ± {}", n(a), n(b)),
            Self::Lagged(a) => format!("the {speed} with a lag of {} s", n(a)),
            Self::Worked(a) => format!("the magnitude of the {speed} with a lag of {} s", n(a)),
            Self::Place => format!("the {place}"),
            Self::PlaceMagnitude => format!("the magnitude of the {place}"),
            Self::PlaceSquare => format!("the square of the {place}"),
            Self::PlaceSignedSquare => format!("the signed square of the {place}"),
            Self::PlaceCube => format!("the cube of the {place}"),
            Self::Yielding(a) => format!("the {place}, saturating beyond {}", n(a)),
            Self::Wave(a) => format!("a wave over {place} of {}", n(a)),
            Self::Bump(a, b) => format!("a peak at {} ± {}", n(a), n(b)),
            Self::Step(a, b) => format!("a step at {} ± {}", n(a), n(b)),
            Self::Time => "time".to_owned(),
            Self::Fading(a) => format!("a decay over {} s", n(a)),
        }
    }

    /// Its constants.
    pub(crate) fn constants(self) -> Vec<f64> {
        match self {
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube
            | Self::Time => Vec::new(),
            Self::Switching(a)
            | Self::Turning(a)
            | Self::Forwards(a)
            | Self::Backwards(a)
            | Self::Falling(a)
            | Self::Bell(a)
            | Self::Yielding(a)
            | Self::Lagged(a)
            | Self::Worked(a)
            | Self::Wave(a)
            | Self::Fading(a) => vec![a],
            Self::SpeedBump(a, b) | Self::Bump(a, b) | Self::Step(a, b) => vec![a, b],
        }
    }

    /// The same shape with other constants.
    pub(crate) fn with(self, c: &[f64]) -> Self {
        let at = |index: usize| c.get(index).copied().unwrap_or(f64::NAN);
        match self {
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube
            | Self::Time => self,
            Self::Yielding(_) => Self::Yielding(at(0)),
            Self::Switching(_) => Self::Switching(at(0)),
            Self::Turning(_) => Self::Turning(at(0)),
            Self::Forwards(_) => Self::Forwards(at(0)),
            Self::Backwards(_) => Self::Backwards(at(0)),
            Self::Falling(_) => Self::Falling(at(0)),
            Self::Bell(_) => Self::Bell(at(0)),
            Self::Lagged(_) => Self::Lagged(at(0)),
            Self::Worked(_) => Self::Worked(at(0)),
            Self::Wave(_) => Self::Wave(at(0)),
            Self::Fading(_) => Self::Fading(at(0)),
            Self::SpeedBump(..) => Self::SpeedBump(at(0), at(1)),
            Self::Bump(..) => Self::Bump(at(0), at(1)),
            Self::Step(..) => Self::Step(at(0), at(1)),
        }
    }

    /// Whether what the records show is enough of the shape to tell its constants.
    pub(crate) fn is_told(self, seen: &Seen, turns: bool) -> bool {
        let travel = seen.travel();
        let duration = seen.time.1 - seen.time.0;
        let inside = |x: f64, (low, high): (f64, f64)| (low..=high).contains(&x);
        match self {
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube
            | Self::Time => true,
            Self::Yielding(x0) => x0 <= 2.0 * travel,
            Self::Switching(vs)
            | Self::Turning(vs)
            | Self::Forwards(vs)
            | Self::Backwards(vs)
            | Self::Falling(vs)
            | Self::Bell(vs) => vs <= 2.0 * seen.speed,
            Self::SpeedBump(centre, width) => {
                inside(centre, (0.0, seen.speed)) && width <= seen.speed
            }
            Self::Lagged(tau) | Self::Worked(tau) => tau <= 0.3 * duration,
            Self::Fading(tau) => tau <= 3.0 * duration,
            Self::Wave(p) => wave_number(p, turns) * travel >= std::f64::consts::PI,
            Self::Bump(centre, width) | Self::Step(centre, width) => {
                inside(centre, seen.place) && width <= 0.5 * travel
            }
        }
    }

    /// Whether it has a sine and a cosine.
    pub(crate) fn is_pair(self) -> bool {
        matches!(self, Self::Wave(_))
    }

    /// Its values along a record: one list, of a wave two.
    pub(crate) fn along(self, course: &Course, turns: bool, scales: &Scales) -> Vec<Vec<f64>> {
        let of = |list: &[f64], f: &dyn Fn(f64) -> f64| list.iter().map(|&x| f(x)).collect();
        let speed = |f: &dyn Fn(f64) -> f64| vec![of(&course.speed, f)];
        let place = |f: &dyn Fn(f64) -> f64| vec![of(&course.place, f)];
        let time = |f: &dyn Fn(f64) -> f64| vec![of(&course.time, f)];
        let (v1, x1, t1) = (scales.speed, scales.place, scales.time);
        match self {
            Self::Speed => speed(&|v| v / v1),
            Self::Magnitude => speed(&|v| v.abs() / v1),
            Self::SignedSquare => speed(&|v| v * v.abs() / (v1 * v1)),
            Self::Square => speed(&|v| v * v / (v1 * v1)),
            Self::Cube => speed(&|v| (v / v1).powi(3)),
            Self::Switching(vs) => speed(&|v| v / (v.abs() + vs)),
            Self::Turning(vs) => speed(&|v| (v / vs).tanh()),
            Self::Forwards(vs) => speed(&|v| 0.5 + 0.5 * v / (v.abs() + vs)),
            Self::Backwards(vs) => speed(&|v| 0.5 - 0.5 * v / (v.abs() + vs)),
            Self::Falling(vs) => speed(&|v| (-v.abs() / vs).exp()),
            Self::Bell(vs) => speed(&|v| (-(v / vs) * (v / vs)).exp()),
            Self::SpeedBump(v0, width) => speed(&|v| (-((v.abs() - v0) / width).powi(2)).exp()),
            Self::Lagged(tau) => vec![late(course, tau, &|v| v / v1)],
            Self::Worked(tau) => vec![late(course, tau, &|v| v.abs() / v1)],
            Self::Place => place(&|x| x / x1),
            Self::PlaceMagnitude => place(&|x| x.abs() / x1),
            Self::PlaceSquare => place(&|x| (x / x1) * (x / x1)),
            Self::PlaceSignedSquare => place(&|x| x * x.abs() / (x1 * x1)),
            Self::PlaceCube => place(&|x| (x / x1).powi(3)),
            Self::Yielding(x0) => place(&|x| x / (x.abs() + x0)),
            Self::Wave(p) => {
                let k = wave_number(p, turns);
                vec![
                    of(&course.place, &|x| (k * x).sin()),
                    of(&course.place, &|x| (k * x).cos()),
                ]
            }
            Self::Bump(x0, width) => place(&|x| (-((x - x0) / width).powi(2)).exp()),
            Self::Step(x0, width) => place(&|x| 0.5 + 0.5 * ((x - x0) / width).tanh()),
            Self::Time => time(&|t| t / t1),
            Self::Fading(tau) => time(&|t| (-t / tau).exp()),
        }
    }

    /// How it is written, the names of its constants given: one expression, of a wave two.
    pub(crate) fn expressions(self, kind: &Kind, names: &[String]) -> Vec<String> {
        let (x, v) = (&kind.place.text, &kind.speed.text);
        let (x1, v1, t1) = (&kind.place.round, &kind.speed.round, &kind.round_time);
        let name = |index: usize| names.get(index).map_or("", String::as_str);
        let (a, b) = (name(0), name(1));
        let abs = format!("noEvent(abs({v}))");
        let one = match self {
            Self::Speed => format!("{v}/{v1}"),
            Self::Magnitude => format!("{abs}/{v1}"),
            Self::SignedSquare => format!("{v}*{abs}/{v1}^2"),
            Self::Square => format!("({v}/{v1})^2"),
            Self::Cube => format!("({v}/{v1})^3"),
            Self::Switching(_) => format!("{v}/({abs} + {a})"),
            Self::Turning(_) => format!("tanh({v}/{a})"),
            Self::Forwards(_) => format!("(1 + {v}/({abs} + {a}))/2"),
            Self::Backwards(_) => format!("(1 - {v}/({abs} + {a}))/2"),
            Self::Falling(_) => format!("exp(-{abs}/{a})"),
            Self::Bell(_) => format!("exp(-({v}/{a})^2)"),
            Self::SpeedBump(..) => format!("exp(-(({abs} - {a})/{b})^2)"),
            Self::Lagged(_) => format!("late_{a}/{v1}"),
            Self::Worked(_) => format!("worked_{a}/{v1}"),
            Self::Place => format!("{x}/{x1}"),
            Self::PlaceMagnitude => format!("noEvent(abs({x}))/{x1}"),
            Self::PlaceSquare => format!("({x}/{x1})^2"),
            Self::PlaceSignedSquare => format!("{x}*noEvent(abs({x}))/{x1}^2"),
            Self::PlaceCube => format!("({x}/{x1})^3"),
            Self::Yielding(_) => format!("{x}/(noEvent(abs({x})) + {a})"),
            Self::Wave(_) if kind.turns() => {
                return vec![format!("sin({a}*{x})"), format!("cos({a}*{x})")];
            }
            Self::Wave(_) => {
                return vec![format!("sin(2*pi*{x}/{a})"), format!("cos(2*pi*{x}/{a})")];
            }
            Self::Bump(..) => format!("exp(-(({x} - {a})/{b})^2)"),
            Self::Step(..) => format!("(1 + tanh(({x} - {a})/{b}))/2"),
            Self::Time => format!("time/{t1}"),
            Self::Fading(_) => format!("exp(-time/{a})"),
        };
        vec![one]
    }

    /// What else has to be written for it: a filter.
    pub(crate) fn equations(self, kind: &Kind, names: &[String]) -> (String, String) {
        let (v, unit) = (&kind.speed.text, &kind.speed.unit);
        let (name, input, what) = match self {
            Self::Lagged(_) => ("late", v.clone(), "the speed with a lag"),
            Self::Worked(_) => {
                let what = "recent motion, filtered";
                ("worked", format!("noEvent(abs({v}))"), what)
            }
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Switching(_)
            | Self::Turning(_)
            | Self::Forwards(_)
            | Self::Backwards(_)
            | Self::Falling(_)
            | Self::Bell(_)
            | Self::SpeedBump(..)
            | Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube
            | Self::Yielding(_)
            | Self::Wave(_)
            | Self::Bump(..)
            | Self::Step(..)
            | Self::Time
            | Self::Fading(_) => return (String::new(), String::new()),
        };
        let tau = names.first().map_or("", String::as_str);
        (
            format!("  Real {name}_{tau}(start = 0 [{unit}], fixed = true) \"{what}\";\n"),
            format!("  {tau}*der({name}_{tau}) = {input} - {name}_{tau};\n"),
        )
    }

    /// Its constants as they are written, with the ranges that a fit may search.
    pub(crate) fn written(self, kind: &Kind, seen: &Seen) -> Vec<Constant> {
        let (place, speed) = (&kind.place.unit, &kind.speed.unit);
        let positive = |stem, value: f64, unit: &NamedUnit| Constant {
            stem,
            value,
            range: (0.2 * value, 5.0 * value),
            unit: unit.clone(),
        };
        match self {
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube
            | Self::Time => Vec::new(),
            Self::Switching(a)
            | Self::Turning(a)
            | Self::Forwards(a)
            | Self::Backwards(a)
            | Self::Falling(a)
            | Self::Bell(a) => {
                vec![positive("vs", a, speed)]
            }
            Self::Yielding(a) => vec![positive("x0", a, place)],
            Self::SpeedBump(centre, width) => vec![
                Constant {
                    range: (0.0, seen.speed),
                    ..positive("v0", centre, speed)
                },
                positive("dv", width, speed),
            ],
            Self::Lagged(tau) | Self::Worked(tau) | Self::Fading(tau) => {
                vec![positive("tau", tau, &NamedUnit::usual(Dimension::TIME))]
            }
            Self::Wave(p) => {
                let wave = match kind.turns() {
                    true => positive("N", p, &NamedUnit::usual(Dimension::DIMENSIONLESS)),
                    false => positive("period", p, place),
                };
                vec![Constant {
                    range: (0.7 * p, 1.4 * p),
                    ..wave
                }]
            }
            Self::Bump(centre, width) | Self::Step(centre, width) => vec![
                Constant {
                    range: (seen.place.0, seen.place.1),
                    ..positive("x0", centre, place)
                },
                positive("width", width, place),
            ],
        }
    }

    /// Which of the round numbers it is written with: speed, place, time.
    pub(crate) fn scales(self) -> [bool; 3] {
        match self {
            Self::Speed
            | Self::Magnitude
            | Self::SignedSquare
            | Self::Square
            | Self::Cube
            | Self::Lagged(_)
            | Self::Worked(_) => [true, false, false],
            Self::Place
            | Self::PlaceMagnitude
            | Self::PlaceSquare
            | Self::PlaceSignedSquare
            | Self::PlaceCube => [false, true, false],
            Self::Time => [false, false, true],
            Self::Switching(_)
            | Self::Turning(_)
            | Self::Forwards(_)
            | Self::Backwards(_)
            | Self::Falling(_)
            | Self::Bell(_)
            | Self::SpeedBump(..)
            | Self::Yielding(_)
            | Self::Wave(_)
            | Self::Bump(..)
            | Self::Step(..)
            | Self::Fading(_) => [false; 3],
        }
    }
}

/// What a filter of the first order makes of a function of speed.
fn late(course: &Course, tau: f64, of: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let mut state = 0.0;
    let mut last = course.time.first().copied().unwrap_or(0.0);
    let rows = course.speed.iter().zip(&course.time);
    rows.map(|(&v, &t)| {
        state += (1.0 - (-(t - last) / tau).exp()) * (of(v) - state);
        last = t;
        state
    })
    .collect()
}

fn wave_number(p: f64, turns: bool) -> f64 {
    if turns { p } else { std::f64::consts::TAU / p }
}
