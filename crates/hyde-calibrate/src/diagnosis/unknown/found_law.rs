//! [`Unknown`]: what is missing where no effect known is it, and [`FoundLaw`], the law that was made of it.

use super::latent::LatentForce;
use super::law::{Law, Summand};
use super::map::Map;
use super::site::Written;
use crate::diagnosis::finding::Finding;
use crate::diagnosis::hypothesis::Hypothesis;

/// What is missing where no effect known is it.
pub struct Unknown {
    /// The map of the site that explains most, with bands: the signature.
    pub map: Map,
    /// Maps of the other sites, without bands, the best first.
    pub others: Vec<Map>,
    /// The force that the balance at the site would need, record by record.
    pub latent: Vec<LatentForce>,
    /// The law that was found; `None` where no formula is worth its constants.
    pub found: Option<FoundLaw>,
}

/// A law that was found.
pub struct FoundLaw {
    /// The law as it was selected, with what the records show of its site.
    pub law: Law,
    /// The effect written: its text has the values found.
    pub written: Written,
    /// What a report needs of it: it is the hypothesis behind the last one of the diagnosis.
    pub hypothesis: Hypothesis,
    /// What it gained after each term, before it was fitted.
    pub gains: Vec<f64>,
    /// What it gained fitted, and on halves of the records that fits had not seen.
    pub gain: f64,
    /// See [`FoundLaw::gain`].
    pub fold_gain: f64,
    /// What it gains of what the best panel or wave of the map does.
    pub share: f64,
    /// Other forms of the first term with the part of its gain that they have.
    pub equivalents: Vec<(Summand, f64)>,
}

impl FoundLaw {
    /// Its text with other values found.
    pub(in crate::diagnosis) fn rewrite(&mut self, finding: &Finding) {
        let quantities = finding.sizes.iter().chain(&finding.shapes);
        let values: Vec<f64> = quantities.map(|quantity| quantity.value).collect();
        self.written = self.law.with(&values).written(&self.written.name, true).0;
    }
}
