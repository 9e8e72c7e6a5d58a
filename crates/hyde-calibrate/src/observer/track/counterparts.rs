//! [`Counterparts`]: the unknowns of a track's program in the vector of another one that has them all.
//!
//! ```text
//! without the effect   screw.b.tau + far.a.tau = 0               one unknown: screw.b.tau
//! with it              screw.b.tau + far.a.tau = effect.a.tau    far.a.tau is the unknown, screw.b.tau has a definition
//! counterpart          far.a.tau = -screw.b.tau where the effect has size 0
//! ```

use super::vectors::Vectors;
use crate::plant::Places;
use hyde_program::{Point, Program};

/// Where each unknown of the track's program is in the vector of another program, and the sign it has there.
#[derive(Clone)]
pub(super) struct Counterparts {
    pub(super) positions: Vec<usize>,
    pub(super) signs: Vec<f64>,
}

impl Counterparts {
    /// Those of a program with the same unknowns.
    pub(super) fn same(count: usize) -> Self {
        Self {
            positions: (0..count).collect(),
            signs: vec![1.0; count],
        }
    }

    /// What they may be. Unknowns of the same name are the same; one that is missing may be any that is new, with either sign:
    /// of two variables that are equal or opposite, a program keeps one as an unknown.
    pub(super) fn possible(own: &Program, other: &Program) -> Vec<Self> {
        let (names, others) = (names(own), names(other));
        let by_name = names.iter().map(|name| {
            let at = others.iter().position(|known| known == name);
            at.map(|at| (at, 1.0))
        });
        let by_name: Vec<Option<(usize, f64)>> = by_name.collect();
        let with = |one: (usize, f64)| -> Self {
            let all = by_name.iter().map(|found| found.unwrap_or(one));
            let (positions, signs) = all.unzip();
            Self { positions, signs }
        };
        let new = (0..others.len()).filter(|&at| !names.contains(&others[at]));
        match by_name.iter().filter(|found| found.is_none()).count() {
            0 => vec![with((0, 1.0))],
            1 => new
                .flat_map(|at| [with((at, -1.0)), with((at, 1.0))])
                .collect(),
            _ => Vec::new(),
        }
    }

    /// Whether those are states that are states there.
    pub(super) fn have_rates_alike(&self, own: &Places, others: &Places) -> bool {
        let mut each = self.positions.iter().zip(&own.differential);
        each.all(|(&position, differential)| others.differential[position] == *differential)
    }

    /// Puts where the track's program is to their positions.
    pub(super) fn put(&self, at: Point<'_>, into: &mut Vectors) {
        let values = at.y.iter().zip(at.yp);
        let places = self.positions.iter().zip(&self.signs);
        for ((&position, sign), (y, yp)) in places.zip(values) {
            (into.y[position], into.yp[position]) = (sign * y, sign * yp);
        }
    }
}

/// The names of the unknowns of a program.
pub(super) fn names(program: &Program) -> Vec<String> {
    let each = 0..program.n_unknowns;
    each.map(|number| program.unknown_name(number)).collect()
}
