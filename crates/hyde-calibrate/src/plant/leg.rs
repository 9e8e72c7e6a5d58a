//! [`Leg`]: a step that was taken, and the event at its end: what tangents follow within a row.

use super::lengths::size_of;
use hyde_program::Point;

/// A step that was taken.
pub(crate) struct Leg {
    /// Its level: a row's time over 2^level.
    pub(crate) level: usize,
    /// What ended it, if it is an event.
    pub(crate) event: Option<Event>,
}

/// What happened at the end of a step.
pub(crate) struct Event {
    /// Numbers of the states that modes fix from there on, or did before or in passing.
    pub(crate) fixed: Vec<usize>,
    /// The combination of modes from there on.
    pub(crate) configuration: usize,
    /// Where the plant was before it.
    pub(crate) before: Instant,
    /// Where it was after it.
    pub(crate) after: Instant,
}

/// Everything a model is evaluated at but its parameters.
pub(crate) struct Instant {
    pub(crate) t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    z: Vec<f64>,
    u: Vec<f64>,
}

impl Instant {
    pub(crate) fn of(at: Point<'_>) -> Self {
        Self {
            t: at.t,
            y: at.y.to_vec(),
            yp: at.yp.to_vec(),
            z: at.z.to_vec(),
            u: at.u.to_vec(),
        }
    }

    /// The point, with some parameters.
    pub(crate) fn point<'a>(&'a self, p: &'a [f64]) -> Point<'a> {
        Point {
            t: self.t,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p,
        }
    }
}

/// Shortest steps in some legs.
pub(crate) fn length(legs: &[Leg]) -> usize {
    legs.iter().map(|leg| size_of(leg.level)).sum()
}
