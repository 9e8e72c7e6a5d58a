//! The figures of a batch: a measure over an input, how it is distributed, and trajectories of all cases.

use super::{CaseColumn, ChoiceColumn, Envelope, signed};
use crate::{
    Axis, Between, Direction, Figure, Line, LineStyle, Panel, Reference, time_panel, time_plot,
};

/// Width and height of the panels that stand many beside each other, in px.
const SMALL: (f64, f64) = (330.0, 190.0);
/// No scatter has more points, no distribution more steps: the page stays small, and a reader sees no more.
const POINTS: usize = 600;
/// No more choices than these get a curve of their own; the colour behind theirs is that of failed cases.
const OPTIONS: usize = 6;

/// A measure over an input, a point a case, in the colour of what was chosen; failed cases stand at the lower edge.
pub(super) fn scatter(
    input: &CaseColumn,
    measure: &CaseColumn,
    failed: &[bool],
    correlation: f64,
    choice: Option<&ChoiceColumn>,
) -> Figure {
    let x = Axis::scaled(input.name.as_str(), &input.unit, &input.values);
    let y = Axis::scaled(measure.name.as_str(), &measure.unit, &measure.values);
    let cases = input.values.iter().zip(&measure.values).enumerate();
    let solved: Vec<(usize, (f64, f64))> = cases
        .map(|(case, (x, y))| (case, (*x, *y)))
        .filter(|(_, (x, y))| (x + y).is_finite())
        .collect();
    let extremes = extremes(&solved);
    let step = solved.len().div_ceil(POINTS).max(1);
    let kept = |at: &usize| at.is_multiple_of(step) || extremes.contains(at);
    let shown: Vec<(usize, (f64, f64))> = (0..solved.len())
        .filter(kept)
        .map(|at| solved[at])
        .collect();
    let points = |label: &str, chosen: &dyn Fn(usize) -> bool| {
        let own = shown.iter().filter(|(case, _)| chosen(*case));
        let (xs, ys) = own.map(|(_, point)| *point).unzip();
        Line::new(label, xs, ys).with_style(LineStyle::Points)
    };
    let (some_failed, some_chosen) = (failed.contains(&true), choice.is_some());
    let mut lines: Vec<Line> = match choice {
        None => vec![points(if some_failed { "solved" } else { "" }, &|_| true)],
        Some(choice) => {
            let options = choice.options().into_iter().take(OPTIONS);
            let of = |option: &str| {
                points(option, &|case| {
                    choice.values.get(case).is_some_and(|value| value == option)
                })
            };
            options.map(of).collect()
        }
    };
    if some_failed {
        let floor = measure.ends().0;
        let places: Vec<f64> = input
            .values
            .iter()
            .zip(failed)
            .filter(|(x, failed)| **failed && x.is_finite())
            .map(|(x, _)| *x)
            .take(POINTS)
            .collect();
        let floor = vec![if floor.is_finite() { floor } else { 0.0 }; places.len()];
        lines.push(
            Line::new("failed", places, floor)
                .with_style(LineStyle::Points)
                .with_colour(if some_chosen { OPTIONS } else { 1 }),
        );
    }
    let caption = format!(
        "{} over {}: {}",
        measure.name,
        input.name,
        signed(correlation)
    );
    Figure {
        width: SMALL.0,
        panel_height: SMALL.1,
        ..Figure::new(vec![Panel::new(x, y, lines)]).with_caption(caption)
    }
}

/// Where the least and the largest ordinate are.
fn extremes(points: &[(usize, (f64, f64))]) -> [usize; 2] {
    let by_y = |a: &usize, b: &usize| points[*a].1.1.total_cmp(&points[*b].1.1);
    let least = (0..points.len()).min_by(by_y).unwrap_or(0);
    [least, (0..points.len()).max_by(by_y).unwrap_or(0)]
}

/// The share of cases in which a measure is at most so large, of all or by what was chosen.
pub(super) fn distribution(measure: &CaseColumn, choice: Option<&ChoiceColumn>) -> Figure {
    let x = Axis::scaled(measure.name.as_str(), &measure.unit, &measure.values);
    let y = Axis::new("share of cases", "%").with_range(0.0, 100.0);
    let lines = match choice {
        None => vec![steps("", measure.values.iter().copied())],
        Some(choice) => {
            let of = |option: &str| {
                let cases = measure.values.iter().zip(&choice.values);
                let own = cases.filter(|(_, value)| value.as_str() == option);
                let own: Vec<f64> = own.map(|(value, _)| *value).collect();
                steps(option, own.into_iter())
            };
            choice.options().into_iter().take(OPTIONS).map(of).collect()
        }
    };
    let caption = match choice {
        None => format!("Distribution of {}", measure.name),
        Some(choice) => format!("Distribution of {} by {}", measure.name, choice.name),
    };
    let middle = Reference {
        direction: Direction::Horizontal,
        at: 50.0,
        label: String::new(),
    };
    let mut panel = Panel::new(x, y, lines);
    panel.references = vec![middle];
    Figure {
        width: SMALL.0,
        panel_height: SMALL.1,
        ..Figure::new(vec![panel]).with_caption(caption)
    }
}

/// The empirical distribution of values, in percent.
fn steps(label: &str, values: impl Iterator<Item = f64>) -> Line {
    let mut sorted: Vec<f64> = values.filter(|value| !value.is_nan()).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    // What is infinite, as the time of what never settles, has its share, and no place.
    let count = sorted.len();
    sorted.retain(|value| value.is_finite());
    let share = |at: usize| 100.0 * (at + 1) as f64 / count as f64;
    let step = count.div_ceil(POINTS).max(1);
    let drawn = sorted.len();
    let kept = (0..drawn).filter(|at| at.is_multiple_of(step) || at + 1 == drawn);
    let (mut x, mut y): (Vec<f64>, Vec<f64>) = kept.map(|at| (sorted[at], share(at))).unzip();
    // It rises from nothing at the least value.
    if let Some(least) = x.first().copied() {
        x.insert(0, least);
        y.insert(0, 0.0);
    }
    Line::new(label, x, y).with_style(LineStyle::Steps)
}

/// A variable over time in all cases.
pub(super) fn envelope(over: &Envelope) -> Figure {
    let caption = format!(
        "{}: median, half of the cases (dark), nine in ten (light), least and largest (dashed)",
        over.name
    );
    Figure {
        title: None,
        ..time_plot("", vec![envelope_panel(over)], None)
    }
    .with_caption(caption)
}

/// A variable over time in all cases: the median, half of the cases in a dark band, nine in ten in a light one, the least
/// and the largest dashed.
#[must_use]
pub fn envelope_panel(over: &Envelope) -> Panel {
    let [least, q05, q25, median, q75, q95, largest] = &over.quantiles;
    let line = |values: &Vec<f64>| Line::new("", over.time.clone(), values.clone()).with_colour(0);
    let lines = vec![
        line(least).with_style(LineStyle::Dashed),
        line(largest).with_style(LineStyle::Dashed),
        line(median),
    ];
    let between = |low: &Vec<f64>, high: &Vec<f64>, opacity| Between {
        x: over.time.clone(),
        low: low.clone(),
        high: high.clone(),
        colour: 0,
        opacity,
    };
    let mut panel = time_panel(over.name.as_str(), &over.unit, lines);
    panel.between = vec![between(q05, q95, 0.15), between(q25, q75, 0.25)];
    panel
}
