//! The page of `hyde look`: a section a file, with a picture of every channel.

use super::layout_of;
use super::text::{delayed, limit, of_channel, of_clock, samples};
use crate::thinned::thinned;
use hyde_report::{Axis, Block, Figure, Line, Page, Panel, Section, Table};
use hyde_signal::look::Channel;
use hyde_study::traces::Seen;
use hyde_units::significant;

/// So many points of a channel are drawn: the least and the greatest value of each stretch.
const POINTS: usize = 600;

/// The page.
#[must_use]
pub fn page(all: &[Seen]) -> Page {
    Page {
        title: "Traces".to_owned(),
        facts: Vec::new(),
        sections: all.iter().map(section).collect(),
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    }
}

fn section(seen: &Seen) -> Section {
    let look = &seen.look;
    let mut blocks = vec![Block::Text(format!("Layout: {}.", layout_of(&seen.table)))];
    for clock in &look.clocks {
        let findings = std::iter::once(samples(clock)).chain(of_clock(clock));
        let text: Vec<String> = findings.collect();
        blocks.push(Block::Text(format!("{}.", text.join("; "))));
    }
    let row = |channel: &Channel| {
        let s = &channel.sampled;
        let unit = match (&channel.unit, &channel.guessed) {
            (Some(unit), _) => unit.clone(),
            (None, Some((unit, _))) => format!("{unit}?"),
            (None, None) => "not said".to_owned(),
        };
        vec![
            channel.name.clone(),
            unit,
            channel.shown.to_string(),
            significant(s.range.0, 4),
            significant(s.range.1, 4),
            s.step.map_or_else(String::new, |step| significant(step, 4)),
            significant(s.noise, 2),
            of_channel(channel).join("; "),
        ]
    };
    blocks.push(Block::Table(Table {
        rows: look.channels.iter().map(row).collect(),
        ..Table::with_columns(&[
            "channel",
            "unit",
            "shows",
            ">from",
            ">to",
            ">step",
            ">noise",
            "why, and what is odd",
        ])
    }));
    blocks.extend(
        look.delays
            .iter()
            .map(|delay| Block::Text(format!("{}.", delayed(delay)))),
    );
    let unusable = look.unusable.iter();
    blocks.extend(unusable.map(|u| {
        let message = &u.fault.message;
        Block::Text(format!("`{}` {}: {message}.", u.name, limit(u)))
    }));
    blocks.extend(
        look.notes
            .iter()
            .map(|note| Block::Text(format!("Note: {note}."))),
    );
    blocks.push(Block::Code(seen.line()));
    blocks.extend(
        look.channels
            .iter()
            .filter_map(|channel| thumbnail(seen, channel)),
    );
    Section {
        heading: seen.given.path.display().to_string(),
        blocks,
    }
}

fn thumbnail(seen: &Seen, channel: &Channel) -> Option<Block> {
    let part = seen.table.holding(&channel.name);
    let column = part.column(&channel.name)?;
    let (x, y) = thinned(part.time(), &column.in_unit(), POINTS);
    let unit = channel.unit.clone().unwrap_or_default();
    let panel = Panel::new(
        Axis::new("time", "s"),
        Axis::new(channel.name.clone(), unit),
        vec![Line::new("", x, y)],
    );
    Some(Block::Figure(Figure {
        width: 320.0,
        panel_height: 120.0,
        ..Figure::new(vec![panel])
    }))
}
