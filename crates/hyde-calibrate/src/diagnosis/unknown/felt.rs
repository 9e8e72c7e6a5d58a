//! [`Felt`]: a site with a probe run along every record.

use super::latent::Carrier;
use super::law::Summand;
use super::probe::{probe, probes};
use super::seen::{Scales, Seen};
use super::site::Site;
use crate::diagnosis::inquiry::Author;
use crate::diagnosis::projection::dot;
use crate::diagnosis::stage::{Ground, Stage};
use crate::linear::SIDE_BY_SIDE;
use hyde_ir::LawAxis;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::ops::Range;

/// A site as the records show it.
pub(crate) struct Felt {
    pub(crate) site: Site,
    pub(crate) carriers: Vec<Carrier>,
    pub(crate) seen: Seen,
    pub(crate) scales: Scales,
}

impl Felt {
    /// Runs the probe; `None` where it cannot be put on, or the site never moves.
    pub(crate) fn new(
        ground: &Ground<'_>,
        stage: &Stage,
        site: &Site,
        author: &Author<'_>,
    ) -> Option<Self> {
        let carriers = |more: &Vec<LawAxis>| -> Option<Vec<Carrier>> {
            let built = author(&stage.numbers(), &[probe(site, more)])?;
            let path = built.paths.last()?;
            let set = ground.set_in(&built.program, &stage.values());
            let each = ground.recordings.iter();
            each.map(|recording| {
                Carrier::new(&built.program, recording, ground.observer, &set, path)
            })
            .collect()
        };
        let carriers = probes(&site.kind).iter().find_map(carriers)?;
        let seen = Seen::of(carriers.iter().map(|carrier| &carrier.course));
        let fine = seen.speed > 0.0 && seen.travel() > 0.0 && seen.speed.is_finite();
        fine.then(|| Self {
            site: site.clone(),
            scales: seen.scales(),
            seen,
            carriers,
        })
    }

    /// The changes of innovations a unit of each size of a term.
    pub(crate) fn columns(&self, term: &Summand) -> Vec<Vec<f64>> {
        self.columns_of(std::slice::from_ref(term)).concat()
    }

    /// The same of several terms, which are run side by side.
    pub(crate) fn columns_of(&self, terms: &[Summand]) -> Vec<Vec<Vec<f64>>> {
        let along = |carrier: &Carrier| {
            let along = |term: &Summand| term.along(carrier, &self.seen);
            terms.iter().flat_map(along).collect()
        };
        let mut lists = self.changes_along(&along).into_iter();
        let own = |term: &Summand| lists.by_ref().take(term.sizes.len()).collect();
        terms.iter().map(own).collect()
    }

    /// The changes of innovations by forces given for each record.
    pub(crate) fn changes_along(
        &self,
        forces: &dyn Fn(&Carrier) -> Vec<Vec<f64>>,
    ) -> Vec<Vec<f64>> {
        let carriers = self.carriers.iter();
        joined(carriers.map(|carrier| carrier.changes(&forces(carrier))))
    }

    /// What a term's columns have in common with given changes: a row a size of the term. `forces` are those changes as
    /// [`Self::common`] gives them.
    pub(crate) fn common_with(&self, term: &Summand, forces: &[Vec<Vec<f64>>]) -> DMatrix<f64> {
        let count = forces.first().map_or(0, Vec::len);
        let mut common = DMatrix::zeros(term.sizes.len(), count);
        if count == 0 {
            return common;
        }
        for (carrier, forces) in self.carriers.iter().zip(forces) {
            let courses = term.along(carrier, &self.seen);
            for (i, course) in courses.iter().enumerate() {
                for (j, force) in forces.iter().enumerate() {
                    common[(i, j)] += dot(course, force);
                }
            }
        }
        common
    }

    /// What unit forces in each row of each record have in common with some changes of innovations.
    pub(crate) fn common(&self, changes: &[Vec<f64>]) -> Vec<Vec<Vec<f64>>> {
        let each = self.parts().map(|(carrier, own)| {
            let of = |change: &Vec<f64>| carrier.common(&change[own.clone()]);
            changes.iter().map(of).collect()
        });
        each.collect()
    }

    /// Each record with the place of its innovations among those of all.
    pub(crate) fn parts(&self) -> impl Iterator<Item = (&Carrier, Range<usize>)> {
        let mut end = 0;
        self.carriers.iter().map(move |carrier| {
            let start = end;
            end += carrier.lengths().iter().sum::<usize>();
            (carrier, start..end)
        })
    }

    /// The changes of innovations by forces given along every record: a function of the record's number.
    pub(crate) fn changes(&self, forces: &[Vec<Vec<f64>>]) -> Vec<Vec<f64>> {
        let count = forces.first().map_or(0, Vec::len);
        let firsts = (0..count).into_par_iter().step_by(SIDE_BY_SIDE);
        let few = |first: usize| {
            let own = first..count.min(first + SIDE_BY_SIDE);
            let each = self.carriers.iter().zip(forces);
            joined(each.map(|(carrier, forces)| carrier.changes(&forces[own.clone()])))
        };
        firsts.flat_map_iter(few).collect()
    }
}

/// Changes of innovations record by record, those of a record behind those of the one before.
fn joined(records: impl Iterator<Item = Vec<Vec<f64>>>) -> Vec<Vec<f64>> {
    let all = records.reduce(|mut lists, more| {
        lists.iter_mut().zip(more).for_each(|(a, b)| a.extend(b));
        lists
    });
    all.unwrap_or_default()
}
