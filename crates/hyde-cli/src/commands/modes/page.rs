//! The page of `hyde modes`: the modes of each experiment, and about what it is linearised.

use super::Found;
use crate::files;
use hyde_present::assumed;
use hyde_report::{Block, Figure, Outcome, Page, Section, Table, Verdict, to_html};
use hyde_units::significant;
use std::path::Path;

/// Leaves `modes.html`, with the figure of the modes over a parameter if there is one; gives back its name.
pub(super) fn leave(folder: &Path, over: Option<Figure>, all: &[Found]) -> Result<String, String> {
    files::make_folder(folder)?;
    let path = folder.join("modes.html");
    let over = over.map(|figure| Section {
        heading: "Over a parameter".to_owned(),
        blocks: vec![Block::Figure(figure)],
    });
    let page = Page {
        title: "Natural frequencies".to_owned(),
        facts: all.first().map_or(Vec::new(), |found| found.facts.clone()),
        sections: over.into_iter().chain(all.iter().map(section)).collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    };
    files::write(&path, to_html(&page).as_bytes())?;
    Ok(path.display().to_string())
}

fn section(found: &Found) -> Section {
    let grows = found.unstable.iter().map(|text| {
        Block::Verdicts(vec![Verdict {
            outcome: Outcome::Failed,
            text: text.trim_end().to_owned(),
        }])
    });
    let row = |(number, mode): (usize, &hyde_experiment::NaturalMode)| {
        let shape = found.shapes[number].as_ref();
        let energy = shape.map_or("clocked parts alone".to_owned(), assumed::shares);
        let (f, damping) = (mode.frequency_hz, mode.damping);
        vec![significant(f, 5), significant(damping, 3), energy]
    };
    let table = Table {
        rows: found.modes.iter().enumerate().map(row).collect(),
        ..Table::with_columns(&[">f [Hz]", ">damping", "energy"])
    };
    let told = found
        .blocks
        .iter()
        .filter(|block| **block != Block::Text(String::new()));
    let blocks = grows.chain([Block::Table(table)]).chain(told.cloned());
    Section {
        heading: found.name.clone(),
        blocks: blocks.collect(),
    }
}
