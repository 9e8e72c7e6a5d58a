//! The page of a calibration.

use super::text::{interval, noise};
use super::{Fitted, experiment_name, identified, plots, shown, shown_difference};
use crate::assumptions;
use crate::compared;
use crate::head;
use hyde_report::{Block, Page, Section, Table};
use hyde_study::Project;
use hyde_study::diagnosis::suspicion;
use hyde_units::significant;

/// The page as one HTML text; `made` says when it is made.
pub fn html(told: &Fitted<'_>, made: &str) -> String {
    let calibration = told.calibration;
    let plan = &calibration.plan;
    let fact = |name: &str, value: String| (name.to_owned(), value);
    let projects: Vec<&Project> = calibration
        .experiments
        .iter()
        .map(|own| &own.project)
        .collect();
    let mut facts = vec![fact("Calibration", plan.name.clone())];
    facts.extend(head::facts_of_all(&projects, made));
    let each = calibration.experiments.iter();
    let assumed: Vec<String> = each.flat_map(hyde_study::comparison::assumptions).collect();
    let sections = [
        ("Measured and simulated", measured_and_simulated(told)),
        ("Before the fit", before(told)),
        ("Parameters", parameters(told)),
        ("Correlation", correlation(told)),
        ("Profiles", profiles(told)),
        ("Experiments", experiments(told)),
        ("Records", records(told)),
    ];
    let sections = sections
        .into_iter()
        .filter(|(_, blocks)| !blocks.is_empty());
    let page = Page {
        title: format!("{} of {}", plan.name, plan.models.join(", ")),
        facts,
        sections: head::models(&projects)
            .into_iter()
            .chain(assumptions::section(&assumed))
            .chain(sections.map(|(heading, blocks)| Section {
                heading: heading.to_owned(),
                blocks,
            }))
            .collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    };
    hyde_report::to_html(&page)
}

/// Of each experiment the record that judges.
fn measured_and_simulated(told: &Fitted<'_>) -> Vec<Block> {
    let each = told.calibration.experiments.iter().zip(told.errors);
    let figures = each.filter_map(|(own, errors)| {
        let measured = &own.compiled.program.experiment.measured;
        compared::figure(errors, measured)
    });
    figures.map(Block::Figure).collect()
}

fn before(told: &Fitted<'_>) -> Vec<Block> {
    let mut sentences = identified::sentences(told.calibration, told.before);
    if sentences.is_empty() {
        sentences.push("The records determine every parameter.".to_owned());
    }
    sentences.into_iter().map(Block::Text).collect()
}

fn parameters(told: &Fitted<'_>) -> Vec<Block> {
    let fit = told.fit;
    let mut blocks: Vec<Block> = told.reasons().into_iter().map(Block::Text).collect();
    blocks.extend(told.calibration.notes.iter().cloned().map(Block::Text));
    let heads = ["", "parameter", ">declared", ">calibrated", ">±", "remark"];
    let mut table = Table::with_columns(&heads);
    for (number, parameter) in fit.parameters.iter().enumerate() {
        let value = |value: f64| shown(told.calibration, number, value);
        let half = (parameter.interval.1 - parameter.interval.0) / 2.0;
        table.rows.push(vec![
            (number + 1).to_string(),
            told.calibration.numbers[number].name(),
            value(parameter.nominal),
            value(parameter.value),
            shown_difference(told.calibration, number, half),
            suspicion(parameter).to_owned(),
        ]);
    }
    table.note = Some("± is half the width of the 95 % interval.".to_owned());
    blocks.push(Block::Table(table));
    blocks
}

/// A correlation with two digits; what is rounded to zero has no sign.
pub(super) fn rounded(value: f64) -> String {
    format!("{:.2}", (100.0 * value).round() / 100.0 + 0.0)
}

fn correlation(told: &Fitted<'_>) -> Vec<Block> {
    let all = &told.fit.correlation;
    if all.len() < 2 {
        return Vec::new();
    }
    let heads = (1..=all.len()).map(|number| format!(">{number}"));
    let heads: Vec<String> = ["".to_owned(), "parameter".to_owned()]
        .into_iter()
        .chain(heads)
        .collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    let mut table = Table::with_columns(&heads);
    for (number, row) in all.iter().enumerate() {
        let cells = row.iter().map(|value| rounded(*value));
        let first = [
            (number + 1).to_string(),
            told.calibration.numbers[number].name(),
        ];
        table.rows.push(first.into_iter().chain(cells).collect());
    }
    vec![Block::Figure(plots::correlation(told)), Block::Table(table)]
}

fn profiles(told: &Fitted<'_>) -> Vec<Block> {
    let each = told.profiles.iter();
    each.flat_map(|profile| {
        let name = told.calibration.numbers[profile.parameter].name();
        [
            Block::Figure(plots::profile(told, profile)),
            Block::Text(format!("{name}: {}.", interval(told, profile))),
        ]
    })
    .collect()
}

fn experiments(told: &Fitted<'_>) -> Vec<Block> {
    if told.calibration.experiments.len() < 2 {
        return Vec::new();
    }
    let heads = ["experiment", "model", ">readings", ">mean square", "noise"];
    let mut table = Table::with_columns(&heads);
    for (own, weight) in told.calibration.experiments.iter().zip(told.weights()) {
        table.rows.push(vec![
            experiment_name(own).to_owned(),
            own.project.model.clone(),
            weight.count.to_string(),
            significant(weight.mean_square, 4),
            noise(own),
        ]);
    }
    table.note = Some(
        "Innovations are divided by their expected standard deviations: each experiment weighs by its noise. A mean square of 1 is noise."
            .to_owned(),
    );
    let sentences = told.doubtful_weights().into_iter().map(Block::Text);
    [Block::Table(table)].into_iter().chain(sentences).collect()
}

fn records(told: &Fitted<'_>) -> Vec<Block> {
    let heads = ["experiment", "record", "", ">before", ">after"];
    let mut table = Table::with_columns(&heads);
    for (own, errors) in told.calibration.experiments.iter().zip(told.errors) {
        for record in errors {
            table.rows.push(vec![
                experiment_name(own).to_owned(),
                record.after.record.clone(),
                if record.holdout {
                    "held out".to_owned()
                } else {
                    String::new()
                },
                significant(record.before.chi, 4),
                significant(record.after.chi, 4),
            ]);
        }
    }
    table.note = Some("Mean square of the innovations; 1 is noise.".to_owned());
    vec![Block::Table(table)]
}
