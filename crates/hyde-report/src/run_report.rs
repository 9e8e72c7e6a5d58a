//! The report of one run: what was asked, what came out, what happened on the way.

use crate::number::{fixed, significant};
use crate::page::{Block, Page, Section, Table, Verdict};
use crate::{Figure, prefix, to_html};

/// No more events than this are printed; the rest is counted.
const EVENTS_SHOWN: usize = 100;

/// Everything the report of a run shows. Parts that are empty are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RunReport {
    /// Heading of the page.
    pub title: String,
    /// Pairs of name and value under the heading: model, experiment, file.
    pub facts: Vec<(String, String)>,
    /// What was to hold, and whether it did.
    pub verdicts: Vec<Verdict>,
    /// The numbers to look at first.
    pub key_figures: Vec<KeyFigure>,
    /// Measured against simulated, one row for each channel.
    pub channels: Vec<ChannelError>,
    /// Trajectories, Bode plots.
    pub figures: Vec<Figure>,
    /// What happened during the run.
    pub events: EventTable,
    /// Pairs of name and value: method, steps, evaluations.
    pub solver: Vec<(String, String)>,
    /// The parameters of the run.
    pub parameters: Vec<Parameter>,
    /// Last line: by what the page was made, in which version.
    pub footer: String,
}

/// A number with a name.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct KeyFigure {
    /// What it is.
    pub name: String,
    /// As printed.
    pub value: String,
    /// The unit of `value`.
    pub unit: String,
    /// How it was taken; may be empty.
    pub note: String,
}

/// How far a simulated channel is from the measured one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChannelError {
    /// Name of the channel.
    pub channel: String,
    /// SI unit of `rms` and `noise`; both are shown with one suitable prefix.
    pub unit: String,
    /// Root mean square of measured − simulated, in SI.
    pub rms: f64,
    /// The same as a part of the root mean square of the measured channel: 0.05 is 5 %.
    pub relative: f64,
    /// Root mean square of the noise of the channel in SI, if known.
    pub noise: Option<f64>,
}

/// Events in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventTable {
    /// The first ones; the first 100 are printed.
    pub rows: Vec<Event>,
    /// How many there were in the run, if more than `rows`.
    pub total: usize,
}

/// Something that happened at an instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Event {
    /// When, in s.
    pub time: f64,
    /// The cause: the guard, the clock.
    pub what: String,
    /// The mode before.
    pub before: String,
    /// The mode after.
    pub after: String,
    /// File and line.
    pub source: String,
}

/// A parameter of the run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameter {
    /// Its path: `saddle.m`.
    pub name: String,
    /// As printed.
    pub value: String,
    /// The unit of `value`.
    pub unit: String,
    /// Where the value comes from: a data sheet, a fit, the command line.
    pub source: String,
}

impl RunReport {
    /// The report as one HTML text that needs no other file.
    #[must_use]
    pub fn to_html(&self) -> String {
        to_html(&self.page())
    }

    /// The report as a page, to add sections to.
    #[must_use]
    pub fn page(&self) -> Page {
        let blocks = [
            ("Verdict", self.verdict_block()),
            ("Key figures", table_block(self.key_figure_table())),
            (
                "Measured against simulated",
                table_block(self.channel_table()),
            ),
            (
                "Figures",
                self.figures.iter().cloned().map(Block::Figure).collect(),
            ),
            ("Events", table_block(self.event_table())),
            ("Solver", table_block(self.solver_table())),
            ("Parameters", table_block(self.parameter_table())),
        ];
        Page {
            title: self.title.clone(),
            facts: self.facts.clone(),
            sections: Section::all(blocks),
            footer: self.footer.clone(),
        }
    }

    fn verdict_block(&self) -> Vec<Block> {
        if self.verdicts.is_empty() {
            Vec::new()
        } else {
            vec![Block::Verdicts(self.verdicts.clone())]
        }
    }

    fn key_figure_table(&self) -> Table {
        let row = |figure: &KeyFigure| {
            vec![
                figure.name.clone(),
                minus(&figure.value),
                figure.unit.clone(),
                figure.note.clone(),
            ]
        };
        filled(
            &["quantity", ">value", "unit", "note"],
            self.key_figures.iter().map(row),
        )
    }

    fn channel_table(&self) -> Table {
        let row = |channel: &ChannelError| {
            let largest = channel.rms.abs().max(channel.noise.unwrap_or(0.0).abs());
            let (unit, factor) = prefix::shown_unit(&channel.unit, largest);
            let noise = channel
                .noise
                .map_or_else(String::new, |noise| significant(noise * factor, 3));
            let ratio = channel
                .noise
                .filter(|noise| *noise > 0.0)
                .map(|noise| significant(channel.rms / noise, 3));
            let relative = format!("{} %", significant(100.0 * channel.relative, 3));
            let rms = significant(channel.rms * factor, 3);
            vec![
                channel.channel.clone(),
                unit,
                rms,
                relative,
                noise,
                ratio.unwrap_or_default(),
            ]
        };
        let heads = [
            "channel",
            "unit",
            ">rms error",
            ">relative",
            ">noise",
            ">error / noise",
        ];
        filled(&heads, self.channels.iter().map(row))
    }

    fn event_table(&self) -> Table {
        let row = |event: &Event| {
            let change = match (event.before.is_empty(), event.after.is_empty()) {
                (true, true) => String::new(),
                _ => format!("{} → {}", event.before, event.after),
            };
            vec![
                fixed(event.time, 6),
                event.what.clone(),
                change,
                event.source.clone(),
            ]
        };
        let shown = self.events.rows.len().min(EVENTS_SHOWN);
        let more = self.events.total.max(self.events.rows.len()) - shown;
        let note = (more > 0).then(|| format!("{more} later events are not shown."));
        let rows = self.events.rows.iter().take(EVENTS_SHOWN).map(row);
        Table {
            note,
            ..filled(&[">time [s]", "event", "mode", "source"], rows)
        }
    }

    fn solver_table(&self) -> Table {
        filled(
            &["", ">"],
            self.solver
                .iter()
                .map(|(name, value)| vec![name.clone(), minus(value)]),
        )
    }

    fn parameter_table(&self) -> Table {
        let row = |parameter: &Parameter| {
            let (name, source) = (parameter.name.clone(), parameter.source.clone());
            vec![
                name,
                minus(&parameter.value),
                parameter.unit.clone(),
                source,
            ]
        };
        filled(
            &["parameter", ">value", "unit", "source"],
            self.parameters.iter().map(row),
        )
    }
}

fn filled(heads: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Table {
    Table {
        rows: rows.collect(),
        ..Table::with_columns(heads)
    }
}

fn table_block(table: Table) -> Vec<Block> {
    if table.rows.is_empty() {
        Vec::new()
    } else {
        vec![Block::Table(table)]
    }
}

/// A number printed by somebody else, with a true minus sign.
fn minus(value: &str) -> String {
    if value.parse::<f64>().is_ok() {
        value.replace('-', "−")
    } else {
        value.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(report: &RunReport, heading: &str) -> Table {
        let section = report
            .page()
            .sections
            .into_iter()
            .find(|section| section.heading == heading)
            .unwrap();
        match section.blocks.into_iter().next() {
            Some(Block::Table(table)) => table,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn empty_parts_are_left_out() {
        assert!(RunReport::default().page().sections.is_empty());
    }

    #[test]
    fn channel_errors_get_one_prefix_and_a_ratio_to_the_noise() {
        let error = |unit: &str, rms, noise| ChannelError {
            channel: "x".to_owned(),
            unit: unit.to_owned(),
            rms,
            relative: 0.0123,
            noise,
        };
        let channels = vec![error("m", 3.2e-6, Some(4e-7)), error("A", 0.75, None)];
        let rows = table(
            &RunReport {
                channels,
                ..RunReport::default()
            },
            "Measured against simulated",
        )
        .rows;
        assert_eq!(rows[0], ["x", "µm", "3.20", "1.23 %", "0.400", "8.00"]);
        assert_eq!(rows[1], ["x", "A", "0.750", "1.23 %", "", ""]);
    }

    #[test]
    fn events_are_limited_and_the_rest_is_counted() {
        let event = |k: usize| Event {
            time: k as f64,
            before: "stuck".into(),
            after: "slip".into(),
            ..Event::default()
        };
        let rows: Vec<_> = (0..250).map(event).collect();
        let events = table(
            &RunReport {
                events: EventTable { rows, total: 1000 },
                ..RunReport::default()
            },
            "Events",
        );
        assert_eq!(events.rows.len(), 100);
        assert_eq!(events.rows[1], ["1.000000", "", "stuck → slip", ""]);
        assert_eq!(
            events.note.as_deref(),
            Some("900 later events are not shown.")
        );
    }
}
