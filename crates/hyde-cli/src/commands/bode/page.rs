//! The page of `hyde bode`: responses, margins, and about what they are linearised.

use super::{Asked, Response, draw, margins, open_loop};
use crate::files;
use hyde_report::{Block, Figure, Page, Section, to_html};
use std::path::Path;

/// Leaves `bode.html`; gives back its name.
pub(super) fn leave(folder: &Path, title: &str, all: &[Asked]) -> Result<String, String> {
    files::make_folder(folder)?;
    let path = folder.join("bode.html");
    files::write(&path, to_html(&page(title, all)).as_bytes())?;
    Ok(path.display().to_string())
}

/// A figure with a caption for its title, which would stand in the table of contents.
fn plain(figure: Figure, caption: &str) -> Block {
    let figure = Figure {
        title: None,
        ..figure
    };
    Block::Figure(figure.with_caption(caption))
}

fn page(title: &str, all: &[Asked]) -> Page {
    let every: Vec<&Response> = all
        .iter()
        .flat_map(|asked| asked.bodes.iter().flatten())
        .collect();
    let mut sections = Vec::new();
    let mut drawn: Vec<(&str, &str)> = Vec::new();
    let mut figures = Vec::new();
    for first in &every {
        let key = (first.input.as_str(), first.output.as_str());
        if drawn.contains(&key) {
            continue;
        }
        drawn.push(key);
        let own = every.iter().copied();
        let own = own.filter(|other| (other.input.as_str(), other.output.as_str()) == key);
        let own: Vec<&Response> = own.collect();
        figures.push(plain(
            draw::drawn("", &own),
            &format!("{} to {}", key.0, key.1),
        ));
    }
    sections.push(("Frequency responses".to_owned(), figures));
    for one in all.iter().flat_map(|asked| &asked.margins) {
        let mut blocks = vec![Block::Code(margins::text(one))];
        let figures = open_loop::figures("", one).into_iter();
        blocks.extend(figures.map(|(name, figure)| plain(figure, name)));
        sections.push((format!("Margins at {}", one.signal), blocks));
    }
    let mut about: Vec<Block> = Vec::new();
    let of_loops = all.iter().flat_map(|asked| &asked.margins);
    let of_loops = of_loops.flat_map(|one| &one.about);
    for block in all.iter().flat_map(|asked| &asked.about).chain(of_loops) {
        if !about.contains(block) {
            about.push(block.clone());
        }
    }
    sections.push(("Linear model".to_owned(), about));
    let sections = sections
        .into_iter()
        .filter(|(_, blocks)| !blocks.is_empty());
    Page {
        title: title.to_owned(),
        facts: all.first().map_or(Vec::new(), |asked| asked.facts.clone()),
        sections: sections
            .map(|(heading, blocks)| Section { heading, blocks })
            .collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    }
}
