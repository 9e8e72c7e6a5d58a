//! [`Seen`]: what records show of a site, and the round numbers by which a law measures it.

use super::latent::Course;

/// Round numbers by which speed, place and time are measured in a law: sizes are forces then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// A speed of the record, SI.
    pub speed: f64,
    /// A way of the record, SI.
    pub place: f64,
    /// An acceleration of the record, SI.
    pub acceleration: f64,
    /// A value of what the site has beside them, SI.
    pub signal: f64,
    /// A time of the record, s.
    pub time: f64,
}

/// What the records show of a site, SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seen {
    /// The highest speed, either way.
    pub speed: f64,
    /// The greatest acceleration, either way; 0 where the site has none.
    pub acceleration: f64,
    /// The greatest magnitude of what it has beside them; 0 where that is nothing.
    pub signal: f64,
    /// From where to where it was.
    pub place: (f64, f64),
    /// From when to when.
    pub time: (f64, f64),
}

impl Seen {
    /// What some courses show.
    pub(crate) fn of<'a>(courses: impl Iterator<Item = &'a Course> + Clone) -> Self {
        let range = |of: &dyn Fn(&'a Course) -> &'a [f64]| {
            let values = courses.clone().flat_map(of);
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| {
                (low.min(x), high.max(x))
            })
        };
        let most = |of: &dyn Fn(&'a Course) -> &'a [f64]| {
            let (low, high) = range(of);
            low.abs().max(high.abs())
        };
        Self {
            speed: most(&|course| &course.speed),
            acceleration: most(&|course| &course.acceleration),
            signal: most(&|course| &course.signal),
            place: range(&|course| &course.place),
            time: range(&|course| &course.time),
        }
    }

    /// The length of the way.
    pub(crate) fn travel(&self) -> f64 {
        self.place.1 - self.place.0
    }

    /// Round numbers of what was seen.
    pub(crate) fn scales(&self) -> Scales {
        let most = self.place.0.abs().max(self.place.1.abs());
        Scales {
            speed: round(self.speed),
            place: round(most),
            acceleration: round(self.acceleration),
            signal: round(self.signal),
            time: round(self.time.1.max(1e-3)),
        }
    }
}

/// The nearest of 1, 2, 5 times a power of ten, below.
fn round(value: f64) -> f64 {
    let power = 10.0_f64.powf(value.max(1e-12).log10().floor());
    let leading = value / power;
    power
        * if leading >= 5.0 {
            5.0
        } else if leading >= 2.0 {
            2.0
        } else {
            1.0
        }
}
