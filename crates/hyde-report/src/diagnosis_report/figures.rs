//! The figures of a diagnosis: errors in multiples of their floor, errors over time, residual maps, what parameters did.

use super::{ChannelChange, ErrorChange, MovedParameter, RecordChange, ResidualMap};
use crate::{
    Axis, Between, Direction, Figure, Line, LineStyle, Panel, Reference, Scale, time_panel,
    time_plot,
};

/// Width and height of the panels that stand many beside each other, in px.
const SMALL: (f64, f64) = (330.0, 190.0);
/// Colours of what was before and of what is after.
const BEFORE: usize = 1;
const AFTER: usize = 0;

/// A measure of all channels and records in multiples of its floor: rings before, dots after. `None` where there is none.
pub(super) fn errors_figure(
    name: &str,
    records: &[RecordChange],
    of: &dyn Fn(&ChannelChange) -> Option<ErrorChange>,
) -> Option<Figure> {
    let channels = records.first()?.channels.len();
    let (mut x, mut before, mut after) = (Vec::new(), Vec::new(), Vec::new());
    for (number, record) in records.iter().enumerate() {
        for (place, channel) in record.channels.iter().enumerate() {
            let Some(change) = of(channel) else { continue };
            // The channels of a record stand beside each other.
            x.push((number + 1) as f64 + 0.6 * (place as f64 + 0.5) / channels as f64 - 0.3);
            before.push(change.before / change.floor);
            after.push(change.after / change.floor);
        }
    }
    if x.is_empty() {
        return None;
    }
    let lines = vec![
        Line::new("before", x.clone(), before)
            .with_style(LineStyle::Rings)
            .with_colour(BEFORE),
        Line::new("after", x, after)
            .with_style(LineStyle::Rings)
            .with_colour(AFTER),
    ];
    let records_axis =
        Axis::new("number of the record", "").with_range(0.5, records.len() as f64 + 0.5);
    let y = Axis::new("rms / noise floor", "").with_scale(Scale::Log);
    let mut panel = Panel::new(records_axis, y, lines);
    panel.references = vec![Reference {
        direction: Direction::Horizontal,
        at: 1.0,
        label: "noise floor".to_owned(),
    }];
    let list: Vec<&str> = records
        .first()?
        .channels
        .iter()
        .map(|channel| channel.name.as_str())
        .collect();
    let caption = format!(
        "{name}: records in the order of the table; the channels of each record from left to right: {}",
        list.join(", ")
    );
    Some(Figure {
        width: SMALL.0,
        panel_height: SMALL.1,
        ..Figure::new(vec![panel]).with_caption(caption)
    })
}

/// The rms of each window of a record over time, a panel a channel.
pub(super) fn over_time(record: &RecordChange) -> Figure {
    let panel = |channel: &ChannelChange| {
        let line = |label: &str, values: &Vec<f64>, colour| {
            Line::new(label, record.window_s.clone(), values.clone())
                .with_style(LineStyle::Steps)
                .with_colour(colour)
        };
        let (before, after) = &channel.over_time;
        let lines = vec![line("before", before, BEFORE), line("after", after, AFTER)];
        let mut panel = time_panel(channel.name.as_str(), &channel.unit, lines);
        panel.references = vec![Reference {
            direction: Direction::Horizontal,
            at: channel.windows.floor,
            label: String::new(),
        }];
        panel
    };
    let panels = record.channels.iter().map(panel).collect();
    let mut figure = time_plot(record.title(), panels, None);
    figure.panel_height = 90.0;
    figure.with_caption("rms of each open-loop window of 100 ms; dashed: noise and rounding")
}

/// Innovations over something, with the band of permutations.
pub(super) fn map_figure(map: &ResidualMap) -> Figure {
    let x = Axis::scaled(map.over.as_str(), &map.unit, &map.bins);
    // Over frequency it is a power, and bins are even in its logarithm.
    let (x, what) = match map.unit.as_str() {
        "Hz" => (x.with_scale(Scale::Log), "power"),
        _ => (x, "mean"),
    };
    let y = Axis::new(format!("{what}, {}", map.channel), "");
    let line = |label: &str, values: &Vec<f64>, colour| {
        Line::new(label, map.bins.clone(), values.clone()).with_colour(colour)
    };
    let lines = vec![
        line("before", &map.before, BEFORE),
        line("after", &map.after, AFTER),
    ];
    let mut panel = Panel::new(x, y, lines);
    panel.between = vec![Between {
        x: map.bins.clone(),
        low: map.band.iter().map(|b| -b).collect(),
        high: map.band.clone(),
        colour: 7,
        opacity: 0.25,
    }];
    let says = |excess: f64| match excess > 1.0 {
        true => format!("{} times the band", crate::number::significant(excess, 2)),
        false => "inside the band".to_owned(),
    };
    let caption = format!(
        "{} over {}: before {}, after {}",
        map.channel,
        map.over,
        says(map.excess.0),
        says(map.excess.1)
    );
    Figure {
        width: SMALL.0,
        panel_height: 150.0,
        ..Figure::new(vec![panel]).with_caption(caption)
    }
}

/// Where parameters went, in what was declared about them; `None` where nothing was.
pub(super) fn parameters_figure(parameters: &[MovedParameter]) -> Option<Figure> {
    let known: Vec<&MovedParameter> = parameters
        .iter()
        .filter(|parameter| parameter.spread.is_finite() && parameter.spread > 0.0)
        .collect();
    if known.is_empty() {
        return None;
    }
    let mut lines = Vec::new();
    let mut add =
        |label: &str, colour: usize, shift: f64, of: &dyn Fn(&MovedParameter) -> (f64, f64)| {
            let (mut x, mut y) = (Vec::new(), Vec::new());
            let (mut bar_x, mut bar_y) = (Vec::new(), Vec::new());
            for (number, parameter) in known.iter().enumerate() {
                let (value, half) = of(parameter);
                let at = (number + 1) as f64 + shift;
                let part = |value: f64| (value - parameter.declared) / parameter.spread;
                x.push(at);
                y.push(part(value));
                // A gap keeps the bars apart.
                bar_x.extend([at, at, at]);
                bar_y.extend([part(value - half), part(value + half), f64::NAN]);
            }
            lines.push(Line::new("", bar_x, bar_y).with_colour(colour));
            lines.push(
                Line::new(label, x, y)
                    .with_style(LineStyle::Rings)
                    .with_colour(colour),
            );
        };
    add("before", BEFORE, -0.12, &|parameter| parameter.before);
    add("after", AFTER, 0.12, &|parameter| parameter.after);
    let x = Axis::new("number of the parameter", "").with_range(0.5, known.len() as f64 + 0.5);
    let mut panel = Panel::new(x, Axis::new("away from declared", "spreads"), lines);
    let reference = |at: f64, label: &str| Reference {
        direction: Direction::Horizontal,
        at,
        label: label.to_owned(),
    };
    panel.references = vec![
        reference(1.0, "declared"),
        reference(-1.0, ""),
        reference(0.0, ""),
    ];
    let names: Vec<String> = known
        .iter()
        .enumerate()
        .map(|(number, parameter)| format!("{} {}", number + 1, parameter.name))
        .collect();
    Some(Figure::new(vec![panel]).with_caption(format!(
        "Calibrated values with their intervals; the dashed lines are the limits of the declared range: {}",
        names.join(", ")
    )))
}
