//! [`Vectors`]: unknowns and their rates, for points of a track in the vector of another program.

use hyde_program::Point;

/// Unknowns and their rates.
#[derive(Clone, Default)]
pub(crate) struct Vectors {
    pub(super) y: Vec<f64>,
    pub(super) yp: Vec<f64>,
}

impl Vectors {
    /// Makes them as long as needed.
    pub(super) fn reach(&mut self, count: usize) {
        self.y.resize(count, 0.0);
        self.yp.resize(count, 0.0);
    }

    /// Puts some to their positions.
    pub(super) fn put(&mut self, positions: &[usize], y: &[f64], yp: &[f64]) {
        for (&position, (y, yp)) in positions.iter().zip(y.iter().zip(yp)) {
            (self.y[position], self.yp[position]) = (*y, *yp);
        }
    }

    /// The point, its vectors being these.
    pub(super) fn in_place<'a>(&'a self, at: Point<'a>) -> Point<'a> {
        Point {
            y: &self.y,
            yp: &self.yp,
            ..at
        }
    }
}
