//! [`Places`]: the sites of a stage where a law may act, each with its map, and the law that explains most there.

use super::felt::Felt;
use super::fitted::{Fitting, Wanted};
use super::found_law::{FoundLaw, Unknown};
use super::latent;
use super::map::{self, Map};
use super::regression::Selected;
use super::site::Site;
use crate::diagnosis::evidence::{Gates, excess, explained};
use crate::diagnosis::inquiry::Inquiry;
use crate::diagnosis::projection::Projection;
use crate::diagnosis::stage::Stage;
use crate::diagnosis::trial::Trial;
use crate::fit::Solution;
use crate::plant::Unsupported;
use rayon::prelude::*;

/// The sites of a stage.
pub(crate) struct Places<'a> {
    inquiry: &'a Inquiry<'a>,
    stage: &'a Stage,
    projection: Projection,
    /// Each with its map, the best first: one at least.
    sites: Vec<(Felt, Map)>,
}

/// A law with the number of its site.
pub(crate) struct Best {
    site: usize,
    law: FoundLaw,
    trial: Trial,
}

impl<'a> Places<'a> {
    /// Runs a probe on every site; `None` where a force can be put nowhere.
    pub(crate) fn of(
        inquiry: &'a Inquiry<'a>,
        stage: &'a Stage,
    ) -> Result<Option<Self>, Unsupported> {
        let ground = inquiry.ground();
        let tracks = stage.tracks(&ground)?;
        let Some(projection) = Projection::of(stage, &tracks, &ground)? else {
            return Ok(None);
        };
        let felt = |site: &Site| {
            let felt = Felt::new(&ground, stage, site, inquiry.author)?;
            let map = map::map(inquiry.shapes, &felt, &projection);
            Some((felt, map))
        };
        let mut sites: Vec<(Felt, Map)> = inquiry.sites.par_iter().filter_map(felt).collect();
        sites.sort_by(|a, b| b.1.gain().total_cmp(&a.1.gain()));
        Ok((!sites.is_empty()).then_some(Self {
            inquiry,
            stage,
            projection,
            sites,
        }))
    }

    /// The law of one term that explains all, and significantly more than other effects do.
    pub(crate) fn plain_law(&self, other: &Stage, gates: Gates) -> Option<Best> {
        let wanted = Wanted {
            terms: 1,
            least: gates.thresholds.mostly * excess(&self.stage.solution),
            all: true,
        };
        self.best(wanted, gates).filter(|best| {
            let solution = &best.trial.stage.solution;
            explained(solution, &gates.thresholds)
                && solution.gain_over(&other.solution) >= gates.of_one(&other.solution)
        })
    }

    /// The law that explains most, if one promises to gain so much at least.
    pub(crate) fn law(self, least: f64, gates: Gates) -> Answer {
        let wanted = Wanted {
            terms: gates.thresholds.law_terms,
            least,
            all: false,
        };
        let best = self.best(wanted, gates);
        self.answer(best)
    }

    /// Of laws as they are wanted, the one that explains most.
    fn best(&self, wanted: Wanted, gates: Gates) -> Option<Best> {
        let gate = gates.of_one(&self.stage.solution);
        let most = self.sites.first()?.1.gain();
        let near = self.sites.iter().enumerate().take(gates.thresholds.few);
        let near = near.filter(|(_, (_, map))| map.gain() >= gates.thresholds.rival * most);
        let mut fitted: Vec<(usize, Fitting<'_>, Trial, Selected)> = near
            .filter_map(|(site, (felt, map))| {
                let fitting = Fitting {
                    inquiry: self.inquiry,
                    stage: self.stage,
                    projection: &self.projection,
                    felt,
                    most: map.gain(),
                    wanted,
                    gates,
                };
                let (trial, law) = fitting.law()?;
                Some((site, fitting, trial, law))
            })
            .collect();
        fitted.sort_by(|a, b| b.2.gain.total_cmp(&a.2.gain));
        let mut best: Option<Best> = None;
        let mut least = f64::NEG_INFINITY;
        for (site, fitting, trial, law) in fitted {
            // What fits tell from the best one needs no judge.
            if trial.gain < least {
                break;
            }
            let near = trial.gain - gate;
            let Some((trial, law)) = fitting.judged(trial, law) else {
                continue;
            };
            least = least.max(near);
            let known = best.as_ref();
            if known.is_none_or(|known| law.fold_gain > known.law.fold_gain) {
                best = Some(Best { site, law, trial });
            }
        }
        best
    }

    /// A law, or none, with all that is said beside it.
    pub(crate) fn answer(self, best: Option<Best>) -> Answer {
        let mut sites = self.sites;
        let at = best.as_ref().map_or(0, |best| best.site);
        let (place, map) = sites.remove(at);
        Answer {
            place,
            map,
            others: sites.into_iter().map(|(_, map)| map).collect(),
            projection: self.projection,
            found: best.map(|Best { law, trial, .. }| (law, trial)),
        }
    }
}

/// The site of the answer, the maps of the others, and the law that was found there.
pub(crate) struct Answer {
    place: Felt,
    map: Map,
    others: Vec<Map>,
    projection: Projection,
    found: Option<(FoundLaw, Trial)>,
}

impl Answer {
    /// The site of the law, or the one that explains most.
    pub(super) fn site(&self) -> &Site {
        &self.place.site
    }

    /// Where its law leads, with the number of its constants.
    pub(super) fn solution(&self) -> Option<(&Solution, usize)> {
        let (_, trial) = self.found.as_ref()?;
        Some((&trial.stage.solution, trial.freedoms))
    }

    /// With what a report needs beside it: the bands of the map, and the force that the balance would need.
    pub(super) fn told(self) -> (Unknown, Option<Trial>) {
        let Self {
            place,
            mut map,
            others,
            projection,
            found,
        } = self;
        map::add_bands(&mut map, &place, &projection);
        let innovations = projection.innovations.as_slice();
        let latent = place.parts();
        let latent =
            latent.filter_map(|(carrier, own)| latent::smoothed(carrier, &innovations[own]));
        let latent = latent.collect();
        let (found, trial) = found.unzip();
        let unknown = Unknown {
            map,
            others,
            latent,
            found,
        };
        (unknown, trial)
    }
}
