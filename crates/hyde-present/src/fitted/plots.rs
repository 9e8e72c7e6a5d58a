//! The plots of a calibration: profiles over a parameter, and correlations as a field of discs.

use super::{Fitted, unit};
use hyde_calibrate::{LIMIT, Profile};
use hyde_report::{Axis, Direction, Figure, Line, LineStyle, Panel, Reference};
use hyde_units::{drawn_in, shown};

/// A change of the sum of squares above this is not drawn.
const HIGHEST: f64 = 8.0;

/// The profile of a parameter, beside the parabola of its curvature.
pub fn profile(told: &Fitted<'_>, profile: &Profile) -> Figure {
    let number = profile.parameter;
    let parameter = &told.fit.parameters[number];
    let (text, of) = match unit(told.calibration, number) {
        Some(unit) => drawn_in(unit),
        None => (String::new(), hyde_units::Unit::ONE),
    };
    let name = told.calibration.numbers[number].name();
    let points = profile.points.iter();
    let x: Vec<f64> = points.clone().map(|point| of.from_si(point.0)).collect();
    let y: Vec<f64> = points.map(|point| point.1).collect();
    let ends = (profile.points.first(), profile.points.last());
    let (from, to) = match ends {
        (Some(first), Some(last)) => (first.0, last.0),
        _ => (parameter.value, parameter.value),
    };
    let grid = (0..=100).map(|i| from + (to - from) * f64::from(i) / 100.0);
    let grid: Vec<f64> = grid.collect();
    let parabola = grid.iter().map(|value| {
        let change = ((value - parameter.value) / parameter.deviation).powi(2);
        if change <= HIGHEST { change } else { f64::NAN }
    });
    let lines = vec![
        Line::new("others fitted again", x, y),
        Line::new(
            "from the curvature",
            grid.iter().map(|si| of.from_si(*si)).collect(),
            parabola.collect(),
        )
        .with_style(LineStyle::Dashed),
    ];
    let mut panel = Panel::new(
        Axis::new(name.clone(), shown(&text)),
        Axis::new("change of the sum of squares", "").with_range(0.0, HIGHEST),
        lines,
    );
    panel.references.push(Reference {
        direction: Direction::Horizontal,
        at: LIMIT,
        label: "95 %".to_owned(),
    });
    for end in [profile.interval.0, profile.interval.1]
        .into_iter()
        .flatten()
    {
        panel.references.push(Reference {
            direction: Direction::Vertical,
            at: of.from_si(end),
            label: String::new(),
        });
    }
    Figure::new(vec![panel])
        .with_title(format!("Profile likelihood of {name}"))
        .with_caption(
            "Values whose curve is below the line belong to the 95 % interval. In units of what innovations vary by.",
        )
}

/// The correlations: strong ones are large.
pub fn correlation(told: &Fitted<'_>) -> Figure {
    let all = &told.fit.correlation;
    let of_sign = |label: &str, sign: f64| {
        let (mut x, mut y, mut weight) = (Vec::new(), Vec::new(), Vec::new());
        for (i, row) in all.iter().enumerate() {
            for (j, value) in row.iter().enumerate() {
                if i != j && value * sign > 0.0 {
                    x.push((j + 1) as f64);
                    y.push((i + 1) as f64);
                    weight.push(value.abs());
                }
            }
        }
        Line {
            weight: Some(weight),
            ..Line::new(label, x, y).with_style(LineStyle::Discs)
        }
    };
    let axis = |label: &str| Axis::new(label, "").with_range(0.5, all.len() as f64 + 0.5);
    let panel = Panel {
        equal_scales: true,
        height: Some(320.0),
        ..Panel::new(
            axis("number of the parameter"),
            axis("number of the parameter"),
            vec![of_sign("positive", 1.0), of_sign("negative", -1.0)],
        )
    };
    Figure::new(vec![panel])
        .with_title("Correlation of the parameters")
        .with_caption("The larger a disc, the stronger the errors of the two parameters go together. The numbers are those of the table.")
}
