//! What a diagnosis found as a curve, with what the records say beneath it; and what channels do over frequency.

use crate::{Axis, Between, Direction, Figure, Line, LineStyle, Panel, Reference, Scale};

/// Colours of what the records say, of what was before and of what is after.
const DATA: usize = 7;
const BEFORE: usize = 1;
const AFTER: usize = 0;

/// Something that was found over the variable of which it is a function.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FoundCurve {
    /// What it is.
    pub title: String,
    /// The variable: what it is called, and its SI unit.
    pub over: (String, String),
    /// The force: what it is called, and its SI unit.
    pub force: (String, String),
    /// What the line is called in the legend.
    pub line: String,
    /// Variable and force on the line, SI; empty where there is none.
    pub law: (Vec<f64>, Vec<f64>),
    /// What the records say: variable, force and half its 95 % interval, SI; NaN where that is not known.
    pub data: Vec<(f64, f64, f64)>,
    /// What is drawn.
    pub caption: String,
}

/// A channel over frequency.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Response {
    /// Record and channel.
    pub title: String,
    /// The SI unit of the channel; empty for a bare number.
    pub unit: String,
    /// Frequencies in Hz.
    pub frequency_hz: Vec<f64>,
    /// Amplitude densities of the channel, SI over the root of Hz: measured, by the model before and after.
    pub channel: [Vec<f64>; 3],
    /// Those of the error: before and after.
    pub error: [Vec<f64>; 2],
}

impl FoundCurve {
    /// The figure.
    pub(super) fn figure(&self) -> Figure {
        let (x, y, half) = {
            let each = self.data.iter();
            let x: Vec<f64> = each.clone().map(|own| own.0).collect();
            let y: Vec<f64> = each.clone().map(|own| own.1).collect();
            let half: Vec<f64> = each.map(|own| own.2).collect();
            (x, y, half)
        };
        let mut lines = Vec::new();
        let known = half.iter().all(|half| half.is_finite());
        if !x.is_empty() {
            let style = if known {
                LineStyle::Rings
            } else {
                LineStyle::Points
            };
            lines.push(
                Line::new("records", x.clone(), y.clone())
                    .with_style(style)
                    .with_colour(DATA),
            );
        }
        if !self.law.0.is_empty() {
            let (at, force) = self.law.clone();
            lines.push(Line::new(self.line.as_str(), at, force).with_colour(AFTER));
        }
        let ends = |sign: f64| -> Vec<f64> {
            let each = y.iter().zip(&half);
            each.map(|(y, half)| y + sign * half).collect()
        };
        let reach = self.law.1.iter().copied().chain(y.iter().copied());
        let reach: Vec<f64> = reach.collect();
        let over = self.law.0.iter().copied().chain(x.iter().copied());
        let over: Vec<f64> = over.collect();
        let mut panel = Panel::new(
            Axis::scaled(self.over.0.as_str(), &self.over.1, &over),
            Axis::scaled(self.force.0.as_str(), &self.force.1, &reach),
            lines,
        );
        panel.height = Some(220.0);
        if known && !x.is_empty() {
            panel.between = vec![Between {
                low: ends(-1.0),
                high: ends(1.0),
                x,
                colour: DATA,
                opacity: 0.25,
            }];
        }
        panel.references = vec![Reference {
            direction: Direction::Horizontal,
            at: 0.0,
            label: String::new(),
        }];
        Figure::new(vec![panel])
            .with_title(self.title.as_str())
            .with_caption(self.caption.as_str())
    }
}

impl Response {
    /// The figure: the channel above, its error below.
    pub(super) fn figure(&self) -> Figure {
        let axis = || {
            let axis = Axis::new("frequency", "Hz").with_scale(Scale::Log);
            match self.frequency_hz.as_slice() {
                [first, .., last] => axis.with_range(*first, *last),
                _ => axis,
            }
        };
        let unit = match self.unit.as_str() {
            "" => "1/√Hz".to_owned(),
            unit => format!("{unit}/√Hz"),
        };
        let line = |label: &str, values: &Vec<f64>| {
            Line::new(label, self.frequency_hz.clone(), values.clone())
        };
        let [measured, before, after] = &self.channel;
        let [old, new] = &self.error;
        let mut channel = vec![line("measured", measured).with_colour(DATA)];
        let mut error = Vec::new();
        // Without an effect the model is the same before and after.
        let changed = before != after;
        if changed {
            channel.push(line("before", before).with_colour(BEFORE));
            error.push(line("before", old).with_colour(BEFORE));
        }
        let (model, left) = if changed {
            ("after", "after")
        } else {
            ("simulated", "")
        };
        let dashed = line(model, after).with_style(LineStyle::Dashed);
        channel.push(dashed.with_colour(AFTER));
        error.push(line(left, new).with_colour(AFTER));
        let panel = |label: &str, lines| {
            let y = Axis::new(label, unit.as_str()).with_scale(Scale::Log);
            Panel::new(axis(), y, lines)
        };
        Figure {
            shared_x: true,
            ..Figure::new(vec![panel("channel", channel), panel("error", error)])
        }
        .with_title(self.title.as_str())
        .with_caption(
            "Amplitude density of the channel in the free run, and of measured − simulated, with the model before and after.",
        )
    }
}
