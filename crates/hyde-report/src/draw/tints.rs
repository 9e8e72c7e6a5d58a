//! Which light colour stands for which mode: one name, one colour, in all bands and rows of a figure.

use super::palette::{Colour, tint};
use crate::{Figure, Panel};

/// The names of a figure that have a tint, in the order met.
pub(crate) struct Tints<'a> {
    names: Vec<&'a str>,
}

impl<'a> Tints<'a> {
    pub(crate) fn new(figure: &'a Figure) -> Self {
        let bands = figure
            .panels
            .iter()
            .flat_map(|panel| &panel.bands)
            .map(|band| band.label.as_str());
        let rows = figure.events.iter().flat_map(|strip| &strip.rows);
        let modes = rows
            .flat_map(|row| &row.spans)
            .map(|span| span.label.as_str());
        Self {
            names: distinct(bands.chain(modes)),
        }
    }

    pub(crate) fn of(&self, name: &str) -> Colour {
        tint(
            self.names
                .iter()
                .position(|other| *other == name)
                .unwrap_or(0),
        )
    }
}

/// The labels of the bands of a panel, each once.
pub(crate) fn band_labels(panel: &Panel) -> Vec<&str> {
    distinct(panel.bands.iter().map(|band| band.label.as_str()))
}

/// Each name once, in the order met.
pub(crate) fn distinct<'a>(names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut once: Vec<&str> = Vec::new();
    for name in names {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}
