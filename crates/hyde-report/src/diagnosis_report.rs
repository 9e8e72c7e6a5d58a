//! The report of a diagnosis: what is missing, what that bought, what is left, and what else was tried.

mod figures;
mod found;

pub use self::found::{FoundCurve, Response};

use self::figures::{errors_figure, map_figure, over_time, parameters_figure};
use crate::number::significant;
use crate::page::{Block, Outcome, Page, Section, Table, Verdict};
use crate::{Figure, prefix, to_html};

/// Everything the report of a diagnosis shows. Parts that are empty are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiagnosisReport {
    /// Heading of the page.
    pub title: String,
    /// Pairs of name and value under the heading.
    pub facts: Vec<(String, String)>,
    /// What the model is, in words and as a picture.
    pub about: Vec<Section>,
    /// The verdict in one sentence.
    pub sentence: String,
    /// The same in plain words: what, where, how large, how sure, what else it may be, what to record next.
    pub plain: String,
    /// What was found, as curves.
    pub curves: Vec<FoundCurve>,
    /// Measured beside simulated.
    pub compared: Option<Figure>,
    /// What a channel does over frequency, measured and by both models.
    pub responses: Vec<Response>,
    /// What is doubtful about it.
    pub doubts: Vec<String>,
    /// The effects found: effect, site, quantity with interval, what cannot be told from it.
    pub effects: Vec<[String; 4]>,
    /// Of a force at a site that no effect known explains: variable, what any function of it gains, and by chance.
    pub unknown: Vec<[String; 3]>,
    /// The errors, record by record.
    pub records: Vec<RecordChange>,
    /// The parameters of the model.
    pub parameters: Vec<MovedParameter>,
    /// What was tried and not taken in, the best first.
    pub tried: Vec<TriedEffect>,
    /// What innovations depend on.
    pub maps: Vec<ResidualMap>,
    /// Channel, correlation of successive innovations before and after, what they go with most, and how much.
    pub whiteness: Vec<[String; 5]>,
    /// The text of the new model, its own part.
    pub model: String,
    /// Last line: by what the page was made.
    pub footer: String,
}

/// Errors of a record.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RecordChange {
    /// The record.
    pub name: String,
    /// Nothing was fitted to it.
    pub holdout: bool,
    /// Mean square of whitened innovations, before and after.
    pub chi: (f64, f64),
    /// Channel by channel.
    pub channels: Vec<ChannelChange>,
    /// Where each window of 100 ms begins, in s.
    pub window_s: Vec<f64>,
    /// Why there is no free run; empty if there is one.
    pub no_free_run: String,
}

/// Errors of a channel in a record, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChannelChange {
    /// The channel.
    pub name: String,
    /// Its SI unit; empty for a bare number.
    pub unit: String,
    /// Root mean square of innovations.
    pub innovations: ErrorChange,
    /// Root mean square over open-loop windows; NaN where there are none.
    pub windows: ErrorChange,
    /// Root mean square of the free run, if there is one.
    pub free: Option<ErrorChange>,
    /// Root mean square in each window, before and after.
    pub over_time: (Vec<f64>, Vec<f64>),
}

impl ChannelChange {
    /// The windows, where there are any.
    fn windows_known(&self) -> Option<ErrorChange> {
        Some(self.windows).filter(|windows| windows.after.is_finite())
    }
}

/// An error before and after, and what would be left if the model were the axis; SI.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ErrorChange {
    /// Without effects.
    pub before: f64,
    /// With those found.
    pub after: f64,
    /// Its noise floor.
    pub floor: f64,
}

/// A parameter of the model, SI.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MovedParameter {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty for a bare number.
    pub unit: String,
    /// As declared.
    pub declared: f64,
    /// Half the width of what is declared about it; NaN where nothing is.
    pub spread: f64,
    /// Calibrated without effects, with half the width of its interval.
    pub before: (f64, f64),
    /// Calibrated with them.
    pub after: (f64, f64),
    /// What it is suspected of; empty if of nothing.
    pub suspicion: String,
}

/// An effect at a site that was not taken in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriedEffect {
    /// Effect and site.
    pub name: String,
    /// What it promised to gain of the sum of squares.
    pub score: f64,
    /// What its fit gained; NaN if it was not worth a fit.
    pub gain: f64,
    /// What it gained on what was not fitted; NaN if that was not asked.
    pub unseen: f64,
    /// Why it was not taken in.
    pub reason: String,
    /// The smallest size that would have been seen, with its unit; empty if not known.
    pub visible: String,
}

/// The mean of whitened innovations of a channel over something.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResidualMap {
    /// The channel.
    pub channel: String,
    /// Over what: `position`, `reversal`.
    pub over: String,
    /// Its SI unit; empty for a bare number.
    pub unit: String,
    /// Middles of the bins, SI.
    pub bins: Vec<f64>,
    /// Before, in standard deviations of the channel.
    pub before: Vec<f64>,
    /// After.
    pub after: Vec<f64>,
    /// What 99 of 100 permutations stay below, in each bin.
    pub band: Vec<f64>,
    /// How far beyond the band it goes at most, before and after: above 1 it depends on it.
    pub excess: (f64, f64),
}

impl DiagnosisReport {
    /// The report as one HTML text that needs no other file.
    #[must_use]
    pub fn to_html(&self) -> String {
        to_html(&self.page())
    }

    /// The report as a page.
    #[must_use]
    pub fn page(&self) -> Page {
        let figures = |list: Vec<Figure>| list.into_iter().map(Block::Figure).collect();
        let responses = self.responses.iter().map(Response::figure);
        let blocks: [(&str, Vec<Block>); 10] = [
            ("Verdict", self.verdict_blocks()),
            ("What was found", self.found_blocks()),
            (
                "Measured and simulated",
                figures(self.compared.iter().cloned().collect()),
            ),
            ("Error before and after", self.error_blocks()),
            ("Response over frequency", figures(responses.collect())),
            ("Error over time", self.time_blocks()),
            ("Residual maps", self.map_blocks()),
            ("Parameters", self.parameter_blocks()),
            ("Tried and rejected", self.tried_blocks()),
            ("The new model", self.model_blocks()),
        ];
        Page {
            title: self.title.clone(),
            facts: self.facts.clone(),
            sections: [self.about.clone(), Section::all(blocks)].concat(),
            footer: self.footer.clone(),
        }
    }

    fn found_blocks(&self) -> Vec<Block> {
        let figures = self.curves.iter().map(FoundCurve::figure);
        figures.map(Block::Figure).collect()
    }

    fn verdict_blocks(&self) -> Vec<Block> {
        let mut blocks = vec![Block::Text(format!("{}.", capital(&self.sentence)))];
        if !self.plain.is_empty() {
            blocks.push(Block::Text(self.plain.clone()));
        }
        if !self.effects.is_empty() {
            blocks.push(Block::Table(Table {
                rows: self.effects.iter().map(|row| row.to_vec()).collect(),
                ..Table::with_columns(&[
                    "effect",
                    "site",
                    "quantities",
                    "cannot be distinguished from",
                ])
            }));
        }
        if !self.unknown.is_empty() {
            blocks.push(Block::Table(Table {
                rows: self.unknown.iter().map(|row| row.to_vec()).collect(),
                note: Some(
                    "The residual that no known effect explains, as a force or a sensor error at a site: how much the best \
                     function of each variable reduces the sum of squares, and how much it would by chance."
                        .to_owned(),
                ),
                ..Table::with_columns(&["function of", ">improvement", ">by chance"])
            }));
        }
        let note = |doubt: &String| Verdict {
            outcome: Outcome::Note,
            text: doubt.clone(),
        };
        blocks.push(Block::Verdicts(self.doubts.iter().map(note).collect()));
        blocks
    }

    /// The records that judge: those held out, if there are any.
    fn error_blocks(&self) -> Vec<Block> {
        if self.records.is_empty() {
            return Vec::new();
        }
        let chi = Table {
            rows: self
                .records
                .iter()
                .map(|record| {
                    vec![
                        record.title(),
                        significant(record.chi.0, 4),
                        significant(record.chi.1, 4),
                    ]
                })
                .collect(),
            note: Some(
                "Mean square of the whitened innovations, one sample ahead. A complete model gives about 1."
                    .to_owned(),
            ),
            ..Table::with_columns(&["record", ">before", ">after"])
        };
        let mut blocks = vec![Block::Table(chi)];
        blocks.extend(self.errors_figures());
        let mut rows = Vec::new();
        for record in &self.records {
            for channel in &record.channels {
                let measures = [
                    ("innovations", Some(channel.innovations)),
                    ("100 ms windows", channel.windows_known()),
                    ("free run", channel.free),
                ];
                for (name, change) in measures {
                    let Some(change) = change else { continue };
                    rows.push(row(&record.title(), channel, name, change));
                }
            }
        }
        let heads = [
            "record",
            "channel",
            "rms of",
            "unit",
            ">before",
            ">after",
            ">noise floor",
            ">before / floor",
            ">after / floor",
        ];
        let missing: Vec<&str> = self
            .records
            .iter()
            .map(|record| record.no_free_run.as_str())
            .filter(|why| !why.is_empty())
            .collect();
        let mut note =
            "The last two columns are relative to the noise floor: the error that noise and rounding \
             alone would cause if the model were exact. Each window is a simulation of 100 ms without correction, from a \
             fitted initial state. The free run is a simulation of the whole record with the loop closed, compared below 100 Hz."
                .to_owned();
        if let Some(why) = missing.first() {
            note = format!("{note} Some records have no free run: {why}.");
        }
        blocks.push(Block::Table(Table {
            rows,
            note: Some(note),
            ..Table::with_columns(&heads)
        }));
        blocks
    }

    fn errors_figures(&self) -> Vec<Block> {
        let measure = |name: &str, of: &dyn Fn(&ChannelChange) -> Option<ErrorChange>| {
            errors_figure(name, &self.records, of).map(Block::Figure)
        };
        [
            measure("innovations", &|channel| Some(channel.innovations)),
            measure("windows of 100 ms", &ChannelChange::windows_known),
            measure("free run", &|channel| channel.free),
        ]
        .into_iter()
        .flatten()
        .collect()
    }

    fn time_blocks(&self) -> Vec<Block> {
        let shown = self
            .records
            .iter()
            .filter(|record| record.window_s.len() > 1);
        shown
            .map(|record| Block::Figure(over_time(record)))
            .collect()
    }

    fn map_blocks(&self) -> Vec<Block> {
        let mut blocks = Vec::new();
        if !self.whiteness.is_empty() {
            let heads = [
                "channel",
                ">autocorrelation before",
                ">after",
                "most correlated with",
                ">correlation",
            ];
            blocks.push(Block::Table(Table {
                rows: self.whiteness.iter().map(|row| row.to_vec()).collect(),
                note: Some(
                    "Correlations of the innovations from one sample to the next; white noise has 0.".to_owned(),
                ),
                ..Table::with_columns(&heads)
            }));
        }
        let text = "The mean of the innovations over time and motion, in standard deviations; over frequency, their power \
                    relative to a flat spectrum. Values inside the grey band may be due to chance: the band covers the \
                    same innovations in 99 random draws of the signs of their blocks of 50 ms.";
        if !self.maps.is_empty() {
            blocks.push(Block::Text(text.to_owned()));
        }
        blocks.extend(self.maps.iter().map(|map| Block::Figure(map_figure(map))));
        blocks
    }

    fn parameter_blocks(&self) -> Vec<Block> {
        if self.parameters.is_empty() {
            return Vec::new();
        }
        let row = |parameter: &MovedParameter| {
            let (unit, factor) = prefix::shown_unit(&parameter.unit, parameter.declared.abs());
            let number = |si: f64| significant(si * factor, 4);
            let with = |(value, half): (f64, f64)| {
                format!("{} ± {}", number(value), significant(half * factor, 2))
            };
            vec![
                parameter.name.clone(),
                unit,
                number(parameter.declared),
                with(parameter.before),
                with(parameter.after),
                parameter.suspicion.clone(),
            ]
        };
        let table = Table {
            rows: self.parameters.iter().map(row).collect(),
            note: Some(
                "Intervals are 95 % confidence intervals. A parameter outside its declared range, or at a bound, may \
                 compensate for an effect that the model lacks."
                    .to_owned(),
            ),
            ..Table::with_columns(&["parameter", "unit", ">declared", ">before", ">after", ""])
        };
        let figure = parameters_figure(&self.parameters).map(Block::Figure);
        figure.into_iter().chain([Block::Table(table)]).collect()
    }

    fn tried_blocks(&self) -> Vec<Block> {
        if self.tried.is_empty() {
            return Vec::new();
        }
        let number = |value: f64| {
            if value.is_finite() {
                significant(value, 3)
            } else {
                String::new()
            }
        };
        let row = |tried: &TriedEffect| {
            vec![
                tried.name.clone(),
                number(tried.score),
                number(tried.gain),
                number(tried.unseen),
                tried.reason.clone(),
                tried.visible.clone(),
            ]
        };
        let heads = [
            "effect and site",
            ">predicted",
            ">fitted",
            ">cross-validated",
            "reason",
            "smallest detectable size",
        ];
        vec![Block::Table(Table {
            rows: self.tried.iter().map(row).collect(),
            note: Some(
                "Improvement of the sum of squares. Predicted: a first linear estimate. Fitted: after a fit. \
                 Cross-validated: on samples that were left out of the fit."
                    .to_owned(),
            ),
            ..Table::with_columns(&heads)
        })]
    }

    fn model_blocks(&self) -> Vec<Block> {
        match self.model.is_empty() {
            true => Vec::new(),
            false => vec![Block::Code(self.model.clone())],
        }
    }
}

impl RecordChange {
    fn title(&self) -> String {
        match self.holdout {
            true => format!("{} (held out)", self.name),
            false => self.name.clone(),
        }
    }
}

fn row(record: &str, channel: &ChannelChange, name: &str, change: ErrorChange) -> Vec<String> {
    let largest = change.before.abs().max(change.after.abs());
    let (unit, factor) = prefix::shown_unit(&channel.unit, largest);
    let number = |si: f64| significant(si * factor, 4);
    let times = |si: f64| significant(si / change.floor, 3);
    vec![
        record.to_owned(),
        channel.name.clone(),
        name.to_owned(),
        unit,
        number(change.before),
        number(change.after),
        number(change.floor),
        times(change.before),
        times(change.after),
    ]
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().chain(letters).collect()
    })
}
