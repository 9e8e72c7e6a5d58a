//! The page of natural frequencies: the modes of each experiment, and about what it is linearised.

use super::{blocks, unstable};
use crate::{assumed, head};
use hyde_report::{Block, Figure, Outcome, Page, Section, Table, Verdict};
use hyde_study::Project;
use hyde_study::modes::Modes;
use hyde_units::significant;

/// The page, with the figure of the modes over a parameter if there is one; `made` says when it is made.
#[must_use]
pub fn page(over: Option<Figure>, all: &[Modes], made: &str) -> Page {
    let over = over.map(|figure| Section {
        heading: "Over a parameter".to_owned(),
        blocks: vec![Block::Figure(figure)],
    });
    let projects: Vec<&Project> = all.iter().map(|own| &own.prepared.project).collect();
    let first = all.first();
    Page {
        title: "Natural frequencies".to_owned(),
        facts: first.map_or(Vec::new(), |own| head::facts(&own.prepared.project, made)),
        sections: head::models(&projects)
            .into_iter()
            .chain(over)
            .chain(all.iter().map(section))
            .collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    }
}

fn section(found: &Modes) -> Section {
    let grows = unstable(found).into_iter().map(|text| {
        Block::Verdicts(vec![Verdict {
            outcome: Outcome::Failed,
            text: text.trim_end().to_owned(),
        }])
    });
    let row = |(number, mode): (usize, &hyde_experiment::NaturalMode)| {
        let shape = found.shapes[number].as_ref();
        let energy = shape.map_or("clocked parts alone".to_owned(), assumed::shares);
        let (f, damping) = (mode.frequency_hz, mode.damping);
        vec![significant(f, 5), super::damping(damping), energy]
    };
    let table = Table {
        rows: found.modes.iter().enumerate().map(row).collect(),
        ..Table::with_columns(&[">f [Hz]", ">damping", "energy"])
    };
    let told = blocks(found).into_iter();
    let told = told.filter(|block| *block != Block::Text(String::new()));
    let blocks = grows.chain([Block::Table(table)]).chain(told);
    Section {
        heading: found.name.clone(),
        blocks: blocks.collect(),
    }
}
