//! Nyquist and Nichols plots of an open loop: how near it comes to -1.

use crate::{Axis, Direction, Figure, Line, LineStyle, Marker, Panel, Reference, Scale};
use std::f64::consts::TAU;

/// The grey of the palette.
const GREY: usize = 7;
/// Points of a drawn circle.
const POINTS: u32 = 360;
/// Loop gains above this are not drawn from the origin; a loop that stays below gets the room that it needs.
const MOST_GAIN: f64 = 3.0;
/// Loop gains of a Nichols plot in dB.
const DECIBELS: (f64, f64) = (-40.0, 40.0);

/// An open loop, and how far it stays from -1.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenLoop {
    /// Real and imaginary part over rising frequency.
    pub response: Vec<(f64, f64)>,
    /// The distance of the nearest point from -1: 1/Ms.
    pub distance: f64,
    /// Points of it with a text, as crossovers with their frequencies.
    pub marks: Vec<((f64, f64), String)>,
}

/// The open loop in the complex plane, dashed for negative frequencies, with the unit circle and the circle about -1 that
/// it touches.
#[must_use]
pub fn nyquist_plot(title: impl Into<String>, open_loop: &OpenLoop) -> Figure {
    let largest = open_loop.response.iter().map(|(re, im)| re.hypot(*im));
    let largest = largest.filter(|gain| gain.is_finite()).fold(0.0, f64::max);
    let span = 1.15 * largest.clamp(1.2, MOST_GAIN);
    let (re, im): (Vec<f64>, Vec<f64>) = open_loop.response.iter().copied().unzip();
    let mirrored = im.iter().map(|im| -im).collect();
    let lines = vec![
        circle((0.0, 0.0), 1.0, "|L| = 1"),
        circle((-1.0, 0.0), open_loop.distance, "distance 1/Ms from −1"),
        Line::new("", re.clone(), mirrored)
            .with_style(LineStyle::Dashed)
            .with_colour(0),
        Line::new("L", re, im).with_colour(0),
    ];
    let axis = |label: &str| Axis::new(label, "").with_range(-span, span);
    let centre = |direction| Reference {
        direction,
        at: 0.0,
        label: String::new(),
    };
    let shown = open_loop.marks.iter();
    let shown = shown.filter(|((re, im), _)| re.abs().max(im.abs()) < span);
    let mut markers = vec![marker(-1.0, 0.0, "−1")];
    markers.extend(shown.map(|((re, im), text)| marker(*re, *im, text)));
    let panel = Panel {
        references: vec![centre(Direction::Vertical), centre(Direction::Horizontal)],
        markers,
        height: Some(390.0),
        equal_scales: true,
        ..Panel::new(axis("Re L"), axis("Im L"), lines)
    };
    Figure {
        width: 460.0,
        ..Figure::new(vec![panel]).with_title(title)
    }
}

/// The open loop as gain in decibels over phase in degrees, with the critical points and the curve about them that it
/// touches.
#[must_use]
pub fn nichols_plot(title: impl Into<String>, open_loop: &OpenLoop) -> Figure {
    let phases = unwrapped(&open_loop.response);
    let gains: Vec<f64> = open_loop.response.iter().map(|l| decibels(*l)).collect();
    let seen = phases.iter().zip(&gains);
    let seen = seen.filter(|(_, gain)| (DECIBELS.0..DECIBELS.1).contains(*gain));
    let (low, high) = seen.fold((-180.0_f64, -180.0_f64), |(low, high), (phase, _)| {
        (low.min(*phase), high.max(*phase))
    });
    let low = 90.0 * ((low - 20.0) / 90.0).floor();
    let high = 90.0 * ((high + 20.0) / 90.0).ceil();
    let mut lines = Vec::new();
    let mut markers = Vec::new();
    let mut critical = -180.0 + 360.0 * ((low + 180.0) / 360.0).ceil();
    while critical <= high {
        markers.push(marker(critical, 0.0, "−1"));
        let label = if lines.is_empty() {
            "distance 1/Ms from −1"
        } else {
            ""
        };
        lines.push(around(critical, open_loop.distance, label));
        critical += 360.0;
    }
    for (at, text) in &open_loop.marks {
        let known = open_loop.response.iter().zip(&phases);
        let apart = |l: &(f64, f64)| (l.0 - at.0).hypot(l.1 - at.1);
        let nearest = known.min_by(|a, b| apart(a.0).total_cmp(&apart(b.0)));
        let gain = decibels(*at);
        if let Some((_, phase)) = nearest.filter(|_| (DECIBELS.0..DECIBELS.1).contains(&gain)) {
            let own = at.1.atan2(at.0).to_degrees();
            let phase = own + 360.0 * ((phase - own) / 360.0).round();
            markers.push(marker(phase, gain, text));
        }
    }
    lines.push(Line::new("L", phases, gains).with_colour(0));
    let gain = Axis::new("|L|", "dB").with_scale(Scale::Decibel);
    let phase = Axis::new("phase", "°").with_scale(Scale::Degrees);
    let panel = Panel {
        references: vec![Reference {
            direction: Direction::Horizontal,
            at: 0.0,
            label: String::new(),
        }],
        markers,
        height: Some(330.0),
        ..Panel::new(
            phase.with_range(low, high),
            gain.with_range(DECIBELS.0, DECIBELS.1),
            lines,
        )
    };
    Figure {
        width: 520.0,
        ..Figure::new(vec![panel]).with_title(title)
    }
}

fn marker(x: f64, y: f64, label: &str) -> Marker {
    Marker {
        x,
        y,
        label: label.to_owned(),
    }
}

fn on_circle((x, y): (f64, f64), radius: f64) -> impl Iterator<Item = (f64, f64)> {
    (0..=POINTS).map(move |k| {
        let angle = TAU * f64::from(k) / f64::from(POINTS);
        (x + radius * angle.cos(), y + radius * angle.sin())
    })
}

fn circle(centre: (f64, f64), radius: f64, label: &str) -> Line {
    let (x, y) = on_circle(centre, radius).unzip();
    Line::new(label, x, y)
        .with_style(LineStyle::Dashed)
        .with_colour(GREY)
}

/// The circle about -1 in the plane of phase and gain, at the critical phase in degrees.
fn around(critical: f64, radius: f64, label: &str) -> Line {
    let place = |l: (f64, f64)| {
        let turned = (-l.1).atan2(-l.0).to_degrees();
        (critical + turned, decibels(l))
    };
    let (x, y) = on_circle((-1.0, 0.0), radius).map(place).unzip();
    Line::new(label, x, y)
        .with_style(LineStyle::Dashed)
        .with_colour(GREY)
}

fn decibels((re, im): (f64, f64)) -> f64 {
    20.0 * re.hypot(im).log10()
}

/// Phases in degrees without jumps of more than half a turn, beginning between -270 and 90.
fn unwrapped(response: &[(f64, f64)]) -> Vec<f64> {
    let mut last = -90.0;
    let mut next = |(re, im): &(f64, f64)| {
        let phase = im.atan2(*re).to_degrees();
        let here = phase + 360.0 * ((last - phase) / 360.0_f64).round();
        last = if here.is_finite() { here } else { last };
        here
    };
    response.iter().map(&mut next).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/(s (s + 1) (s + 2)): the phase is -180 degrees at w = sqrt(2), where the gain is 1/6.
    fn third_order() -> OpenLoop {
        let at = |k: u32| {
            let w = 0.01 * 10f64.powf(f64::from(k) / 100.0);
            let gain = 1.0 / (w * w.hypot(1.0) * w.hypot(2.0));
            let phase = -0.25 * TAU - w.atan() - (0.5 * w).atan();
            (gain * phase.cos(), gain * phase.sin())
        };
        OpenLoop {
            response: (0..500).map(at).collect(),
            distance: 0.8,
            marks: vec![((-1.0 / 6.0, 0.0), "0.225 Hz".to_owned())],
        }
    }

    #[test]
    fn a_mark_of_a_nichols_plot_lies_on_the_curve() {
        let figure = nichols_plot("", &third_order());
        let mark = figure.panels[0].markers.last().unwrap();
        assert!((mark.x + 180.0).abs() < 1e-9 && (mark.y + 20.0 * 6f64.log10()).abs() < 1e-9); // rounding of log10 and atan2
    }

    #[test]
    fn a_nichols_plot_shows_whole_quarters_of_a_turn() {
        let figure = nichols_plot("", &third_order());
        let (low, high) = figure.panels[0].x.range.unwrap();
        assert_eq!((low, high), (-270.0, -0.0));
    }

    #[test]
    fn an_integrator_does_not_hide_what_is_near_minus_one() {
        let figure = nyquist_plot("", &third_order());
        let (low, high) = figure.panels[0].x.range.unwrap();
        assert_eq!((low, high), (-1.15 * MOST_GAIN, 1.15 * MOST_GAIN));
        assert_eq!(figure.panels[0].markers.len(), 2);
    }
}
