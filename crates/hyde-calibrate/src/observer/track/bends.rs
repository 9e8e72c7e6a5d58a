//! [`Bends`]: what bends along a route, made where a tangent asks for it first and kept for all that come after: it is the same
//! whichever effect of size 0 is evaluated there.

use super::Route;
use super::splitting::{Bend, Splitting};
use crate::observer::over_record::When;
use crate::plant::partials;
use hyde_program::{Point, Workspace};
use nalgebra::DMatrix;
use std::sync::OnceLock;

/// Rows in which derivatives are looked at for those that are usual.
const LOOKS: usize = 15;

/// Linear parts by combination of modes, and what bends by place.
pub(super) struct Bends {
    splittings: Vec<OnceLock<Option<Box<Splitting>>>>,
    /// Of each row, before its correction and after it.
    rows: Vec<[OnceLock<Box<Bend>>; 2]>,
    /// Of each leg, before its event and after it.
    legs: Vec<[OnceLock<Box<Bend>>; 2]>,
    /// Of each row that is one step, what bends at its end ([`Splitting::at_end`]), corrected.
    ends: Vec<OnceLock<Box<[DMatrix<f64>; 2]>>>,
}

/// A place on a route.
#[derive(Clone, Copy)]
pub(crate) enum Passing {
    /// At the end of a row.
    Row(usize, When),
    /// At the event of a leg, by its number on the route.
    Leg(usize, When),
}

impl Bends {
    /// Nothing yet of so many combinations of modes, rows and legs.
    pub(super) fn new(configurations: usize, rows: usize, legs: usize) -> Self {
        let empty = |count: usize| (0..count).map(|_| Default::default());
        Self {
            splittings: (0..configurations).map(|_| OnceLock::new()).collect(),
            rows: empty(rows).collect(),
            legs: empty(legs).collect(),
            ends: (0..rows).map(|_| OnceLock::new()).collect(),
        }
    }
}

impl Route<'_> {
    /// How errors go where equations bend in a combination of modes; `None` where none does.
    pub(crate) fn splitting(&self, configuration: usize) -> Option<&Splitting> {
        let configuration = self.same_modes[configuration];
        let own = &self.configurations[configuration];
        if own.affine {
            return None;
        }
        let made = self.bends.splittings[configuration].get_or_init(|| {
            let rows = self.rows.iter().enumerate();
            let own = rows.filter(|(_, row)| self.same_modes[row.modes[1]] == configuration);
            let own: Vec<usize> = own.map(|(row, _)| row).collect();
            let every = own.len().div_ceil(LOOKS).max(1);
            let looks = own.iter().step_by(every);
            let looks = looks.map(|&row| self.point(row, When::After, &self.p));
            let looks: Vec<Point<'_>> = looks.collect();
            let mut workspace = Workspace::new(self.program.n_work);
            Splitting::new(self, configuration, &looks, &mut workspace).map(Box::new)
        });
        made.as_deref()
    }

    /// What bends at a place, the route being in a combination of modes there.
    pub(crate) fn bend(&self, configuration: usize, place: Passing) -> Option<&Bend> {
        let own = self.splitting(configuration)?;
        let side = |when: When| usize::from(matches!(when, When::After));
        let known = match place {
            Passing::Row(row, when) => &self.bends.rows[row][side(when)],
            Passing::Leg(leg, when) => &self.bends.legs[leg][side(when)],
        };
        let made = known.get_or_init(|| {
            let at = match place {
                Passing::Row(row, when) => Some(self.point(row, when, &self.p)),
                Passing::Leg(leg, when) => self.legs[leg].event.as_ref().map(|event| match when {
                    When::Before => event.before.point(&self.p),
                    When::After => event.after.point(&self.p),
                }),
            };
            let workspace = &mut Workspace::new(self.program.n_work);
            let there = at.map(|at| partials(self.program, at, workspace));
            Box::new(own.bend(&there.unwrap_or_default()))
        });
        Some(made)
    }

    /// What bends at the end of a row that is one step, the correction behind it; made but once.
    pub(crate) fn end(
        &self,
        row: usize,
        make: impl FnOnce() -> [DMatrix<f64>; 2],
    ) -> &[DMatrix<f64>; 2] {
        self.bends.ends[row].get_or_init(|| Box::new(make()))
    }
}
