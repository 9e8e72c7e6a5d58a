//! The page of a batch has every part that there is something for, and stays small.

use super::*;
use crate::{Outcome, to_svg};

fn column(name: &str, unit: &str, values: impl Iterator<Item = f64>) -> CaseColumn {
    CaseColumn {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: values.collect(),
    }
}

/// Cases in which the lag is the gap and a little of something else; every hundredth failed.
fn report(cases: usize) -> BatchReport {
    // 7919 is prime: values that look random, without a generator.
    let random = |k: usize| ((k as f64 * 7919.0).sin() * 43758.5453).fract().abs();
    let failed: Vec<bool> = (0..cases).map(|k| k % 100 == 99).collect();
    let lag = |k: usize| match k % 100 {
        99 => f64::NAN,
        _ => 1e-5 * random(k) + 1e-6 * random(k + 1),
    };
    let quantiles = [0.0, 0.05, 0.5, 1.0].map(|p| (p, 1.1e-5 * p)).to_vec();
    let failure = |k: usize| FailedCase {
        case: k + 1,
        ..FailedCase::default()
    };
    BatchReport {
        title: "spread".to_owned(),
        verdicts: vec![Verdict {
            outcome: Outcome::Passed,
            text: "no runaway".to_owned(),
        }],
        inputs: vec![
            column("gap", "m", (0..cases).map(|k| 1e-5 * random(k))),
            column("m2", "kg", (0..cases).map(|k| 200.0 * random(k + 7))),
        ],
        choices: vec![ChoiceColumn {
            name: "model".to_owned(),
            values: (0..cases)
                .map(|k| ["new", "worn"][k % 2].to_owned())
                .collect(),
        }],
        measures: vec![CaseMeasure {
            column: column("lag", "m", (0..cases).map(lag)),
            quantiles,
            correlations: vec![("m2".to_owned(), -0.03), ("gap".to_owned(), 0.98)],
        }],
        failures: (0..cases).filter(|k| failed[*k]).map(failure).collect(),
        failed,
        ..BatchReport::default()
    }
}

fn section(page: &Page, heading: &str) -> Vec<Block> {
    let mut sections = page.sections.iter();
    let found = sections.find(|section| section.heading == heading);
    found.map_or_else(Vec::new, |section| section.blocks.clone())
}

fn rows(blocks: &[Block]) -> Vec<Vec<String>> {
    match blocks.first() {
        Some(Block::Table(table)) => table.rows.clone(),
        other => panic!("{other:?}"),
    }
}

fn captions(blocks: &[Block]) -> Vec<&str> {
    blocks
        .iter()
        .filter_map(|block| match block {
            Block::Figure(figure) => figure.caption.as_deref(),
            Block::Text(_)
            | Block::Code(_)
            | Block::Verdicts(_)
            | Block::Table(_)
            | Block::Diagram(_) => None,
        })
        .collect()
}

#[test]
fn an_empty_batch_has_an_empty_page() {
    assert!(BatchReport::default().page().sections.is_empty());
}

#[test]
fn quantiles_are_shown_in_a_unit_that_suits() {
    let page = report(200).page();
    let measures = section(&page, "Measures");
    assert_eq!(
        rows(&measures),
        [["lag", "µm", "0", "0.5500", "5.500", "11.00"]]
    );
    assert_eq!(
        captions(&measures),
        ["Distribution of lag", "Distribution of lag by model"]
    );
}

#[test]
fn inputs_stand_in_the_order_of_their_strength() {
    let page = report(200).page();
    let pairs = section(&page, "Inputs against measures");
    assert_eq!(rows(&pairs), [["gap", "+0.98"], ["m2", "−0.03"]]);
    assert_eq!(
        captions(&pairs),
        ["lag over gap: +0.98", "lag over m2: −0.03"]
    );
    let inputs = rows(&section(&page, "Inputs"));
    assert_eq!(inputs[2], ["model", "new, worn", ""]);
}

#[test]
fn failed_cases_are_counted_where_they_are_not_listed() {
    let page = report(20_000).page();
    let Some(Block::Table(table)) = section(&page, "Failed cases").first().cloned() else {
        panic!("no table");
    };
    assert_eq!(table.rows.len(), 100);
    assert_eq!(table.note.as_deref(), Some("100 later ones are not shown."));
}

#[test]
fn the_page_does_not_grow_with_the_cases() {
    let size = |cases| report(cases).to_html().len();
    let (few, many) = (size(2_000), size(20_000));
    // The failures are listed up to a hundred: 80 more rows of about 150 bytes; and as many failed points.
    assert!(many < few + 30_000, "{few} {many}");
}

#[test]
fn an_envelope_is_drawn_between_its_quantiles() {
    let time: Vec<f64> = (0..50).map(|k| f64::from(k) * 0.02).collect();
    let line = |k: f64| time.iter().map(|t| k * t).collect();
    let over = Envelope {
        name: "x".to_owned(),
        unit: "m".to_owned(),
        quantiles: [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0].map(line),
        time: time.clone(),
    };
    let svg = to_svg(&envelope(&over));
    // Two areas: closed paths, filled.
    let areas = svg.lines().filter(|line| line.contains("z\" fill="));
    assert_eq!(areas.count(), 2, "{svg}");
    assert!(svg.contains("x [mm]") && svg.contains("time [s]"), "{svg}");
}

#[test]
fn what_never_settles_has_its_share() {
    let times = [0.1, 0.2, f64::INFINITY, 0.3, f64::NAN];
    let figure = distribution(&column("settled", "s", times.into_iter()), None);
    // A failed case has no value; of the four others one is never at rest.
    let line = &figure.panels[0].lines[0];
    assert_eq!(line.x, [0.1, 0.1, 0.2, 0.3]);
    assert_eq!(line.y, [0.0, 25.0, 50.0, 75.0]);
}
