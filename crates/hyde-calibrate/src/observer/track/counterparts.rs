//! [`Counterparts`]: the unknowns of a track's program in the vector of another one that has them all.
//!
//! ```text
//! without the effect   screw.b.tau + far.a.tau = 0               one unknown: screw.b.tau
//! with it              screw.b.tau + far.a.tau = effect.a.tau    far.a.tau is the unknown, screw.b.tau has a definition
//! counterpart          far.a.tau = -screw.b.tau where the effect has size 0
//! ```

use super::{Route, Track, Vectors};
use crate::plant::Places;
use hyde_program::{Function, Point, Program, Workspace};

/// Where each unknown of the track's program is in the vector of another program, and the sign it has there.
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

    /// By their names, and where a program has no unknown of a name, by another variable that the track's program has made one
    /// with it up to its sign.
    pub(super) fn of(track: &Track<'_>, other: &Program) -> Option<Self> {
        let own = track.route.program;
        let (names, others) = (names(own), names(other));
        let by_name = names.iter().map(|name| {
            let at = others.iter().position(|known| known == name);
            at.map(|at| (at, 1.0))
        });
        let mut found: Vec<Option<(usize, f64)>> = by_name.collect();
        for (position, name) in others.iter().enumerate() {
            if !names.contains(name)
                && let Some(output) = own.output(name)
                && let Some((number, sign)) = signed_unknown(track, output)
                && found[number].is_none()
            {
                found[number] = Some((position, sign));
            }
        }
        let found: Option<Vec<(usize, f64)>> = found.into_iter().collect();
        let (positions, signs) = found?.into_iter().unzip();
        Some(Self { positions, signs })
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

/// The unknown that an output of the track's program is, and its sign: it is that whatever numbers unknowns have.
fn signed_unknown(track: &Track<'_>, output: usize) -> Option<(usize, f64)> {
    let Route {
        program,
        configurations,
        p,
        ..
    } = &*track.route;
    let at = configurations.first()?.made.point(p);
    // Any numbers without relation to each other.
    let y: Vec<f64> = (0..program.n_unknowns)
        .map(|number| (12.9898 * number as f64 + 1.0).sin())
        .collect();
    let mut value = [0.0];
    let rows = program.kernels.some_rows(Function::Outputs, &[output]);
    let mut workspace = Workspace::new(program.n_work);
    rows.evaluate(Point { y: &y, ..at }, &mut workspace, &mut value);
    let number = y.iter().position(|y| y.abs() == value[0].abs())?;
    Some((number, value[0] / y[number]))
}

/// The names of the unknowns of a program.
pub(super) fn names(program: &Program) -> Vec<String> {
    let each = 0..program.n_unknowns;
    each.map(|number| program.unknown_name(number)).collect()
}
