//! The page of `hyde bode`: responses, margins, and about what they are linearised.

use super::{draw, margins, open_loop};
use crate::{assumed, head};
use hyde_report::{Block, Figure, Page, Section};
use hyde_study::Project;
use hyde_study::responses::{Response, Responses};

/// A figure with a caption for its title, which would stand in the table of contents.
fn plain(figure: Figure, caption: &str) -> Block {
    let figure = Figure {
        title: None,
        ..figure
    };
    Block::Figure(figure.with_caption(caption))
}

/// The page; `made` says when it is made.
pub(super) fn page(title: &str, all: &[Responses], made: &str) -> Page {
    let every: Vec<&Response> = all
        .iter()
        .flat_map(|asked| asked.bodes.iter().flat_map(|bode| &bode.responses))
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
        let figures = figures.zip(["Open loop", "Nyquist plot", "Nichols plot"]);
        blocks.extend(figures.map(|((_, figure), caption)| plain(figure, caption)));
        sections.push((format!("Margins at {}", one.signal), blocks));
    }
    let mut about: Vec<Block> = Vec::new();
    for block in all
        .iter()
        .flat_map(of_models)
        .chain(all.iter().flat_map(of_loops))
    {
        if !about.contains(&block) {
            about.push(block);
        }
    }
    sections.push(("Linear model".to_owned(), about));
    let sections = sections
        .into_iter()
        .filter(|(_, blocks)| !blocks.is_empty());
    let sections = sections.map(|(heading, blocks)| Section { heading, blocks });
    let projects: Vec<&Project> = all.iter().map(|asked| &asked.project).collect();
    let models = head::models(&projects);
    Page {
        title: title.to_owned(),
        facts: all
            .first()
            .map_or(Vec::new(), |asked| head::facts(&asked.project, made)),
        sections: models.into_iter().chain(sections).collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    }
}

/// About what the responses of an experiment are linearised, and what was assumed.
fn of_models(asked: &Responses) -> Vec<Block> {
    let program = &asked.compiled.program;
    let bodes = asked.bodes.iter();
    let about = bodes.flat_map(|bode| assumed::blocks(program, &bode.linear, bode.time));
    let notes = asked.notes.iter().cloned().map(Block::Text);
    about.chain(notes).collect()
}

/// The same of its loops.
fn of_loops(asked: &Responses) -> Vec<Block> {
    let program = &asked.compiled.program;
    let margins = asked.margins.iter();
    margins
        .flat_map(|one| assumed::blocks(program, &one.linear, one.time))
        .collect()
}
