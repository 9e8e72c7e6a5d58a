//! Bode plots: magnitude in decibels and phase in degrees over the frequency, several responses in one figure.

use crate::{Axis, Direction, Figure, Line, LineStyle, Panel, Reference, Scale};
use std::f64::consts::TAU;

/// One frequency response.
#[derive(Clone, Debug, PartialEq)]
pub struct BodeCurve {
    /// Named so in the legend.
    pub label: String,
    /// In Hz, rising; values that are not positive are left out.
    pub frequency: Vec<f64>,
    /// Real and imaginary part at each frequency, in SI.
    pub response: Vec<(f64, f64)>,
    /// Solid for a linearised model, points for a measured or swept one, rings for single frequencies.
    pub style: LineStyle,
    /// Coherence at each frequency, 0 to 1: points fade with it.
    pub coherence: Option<Vec<f64>>,
    /// Index into the palette; `None`: the curve's place in the plot.
    pub colour: Option<usize>,
    /// Standard deviation of the response at each frequency: a dashed line below the magnitude.
    pub deviation: Option<Vec<f64>>,
}

/// Magnitude above phase, over a logarithmic frequency axis in Hz; below them the coherence, if a curve has one.
///
/// `response` is what is shown and its unit: `("x/i", "m/A")`; an empty unit is left out. `resonances` are frequencies
/// in Hz with the text printed above them.
///
/// Phases are unwrapped along the frequency. The first value of the first joined curve is brought between −270° and
/// 90°, so that a double integrator begins at −180°; points are brought within 180° of that curve, or of the joined
/// curve of their colour, other joined curves near it as a whole.
#[must_use]
pub fn bode_plot(
    title: impl Into<String>,
    response: (&str, &str),
    curves: &[BodeCurve],
    resonances: &[(f64, String)],
) -> Figure {
    let colour = |index: usize| curves[index].colour.unwrap_or(index);
    let first = curves.iter().find(|curve| joined(curve));
    let first: Option<Guide> = first.map(|curve| Guide::of(curve, None));
    let guides: Vec<(usize, Guide)> = (0..curves.len())
        .filter(|&index| joined(&curves[index]))
        .map(|index| (colour(index), Guide::of(&curves[index], first.as_ref())))
        .collect();
    let line = |index: usize, curve: &BodeCurve, y: Vec<f64>| Line {
        label: curve.label.clone(),
        x: curve.frequency.clone(),
        y,
        style: curve.style,
        colour: Some(colour(index)),
        weight: curve.coherence.clone(),
    };
    let noise = |index: usize, curve: &BodeCurve| {
        let deviation = curve.deviation.as_ref()?;
        let response: Vec<_> = deviation.iter().map(|size| (*size, 0.0)).collect();
        Some(Line {
            label: format!("noise of {}", curve.label),
            style: LineStyle::Dashed,
            weight: None,
            ..line(index, curve, decibels(&response))
        })
    };
    let gains = curves.iter().enumerate().flat_map(|(index, curve)| {
        let own = line(index, curve, decibels(&curve.response));
        [Some(own), noise(index, curve)].into_iter().flatten()
    });
    let gains = gains.collect();
    let phases = curves.iter().enumerate().map(|(index, curve)| {
        let mut guides = guides.iter();
        let own = guides.find(|(of, _)| *of == colour(index));
        let own = own.map(|(_, guide)| guide).filter(|_| !joined(curve));
        let phase = phase(curve, own.or(first.as_ref()));
        Line {
            label: String::new(),
            ..line(index, curve, phase)
        }
    });
    let frequency = Axis::new("frequency", "Hz").with_scale(Scale::Log);
    let reference = if response.1.is_empty() {
        "dB".to_owned()
    } else {
        format!("dB re 1 {}", response.1)
    };
    let gain_axis = Axis::new(format!("|{}|", response.0), reference).with_scale(Scale::Decibel);
    let phase_axis = Axis::new("phase", "°").with_scale(Scale::Degrees);
    let marks = |labelled: bool| {
        let label = move |text: &String| {
            if labelled {
                text.clone()
            } else {
                String::new()
            }
        };
        let mark = |(at, text): &(f64, String)| Reference {
            direction: Direction::Vertical,
            at: *at,
            label: label(text),
        };
        resonances.iter().map(mark).collect()
    };
    let mut gain = Panel::new(frequency.clone(), gain_axis, gains);
    let mut phase = Panel::new(frequency.clone(), phase_axis, phases.collect());
    (gain.height, phase.height) = (Some(190.0), Some(130.0));
    (gain.references, phase.references) = (marks(true), marks(false));
    let mut panels = vec![gain, phase];
    let coherences: Vec<Line> = curves
        .iter()
        .enumerate()
        .filter_map(|(index, curve)| {
            let coherence = curve.coherence.clone()?;
            Some(Line {
                label: String::new(),
                weight: None,
                ..line(index, curve, coherence)
            })
        })
        .collect();
    if !coherences.is_empty() {
        let axis = Axis::new("coherence", "").with_range(0.0, 1.05);
        let mut coherence = Panel::new(frequency, axis, coherences);
        (coherence.height, coherence.references) = (Some(70.0), marks(false));
        panels.push(coherence);
    }
    Figure {
        shared_x: true,
        ..Figure::new(panels).with_title(title)
    }
}

/// Whether its values are joined, so that its phase has no gaps.
fn joined(curve: &BodeCurve) -> bool {
    match curve.style {
        LineStyle::Solid | LineStyle::Dashed | LineStyle::Steps => true,
        LineStyle::Points | LineStyle::Rings | LineStyle::Discs => false,
    }
}

/// Magnitude in dB re 1; a zero response has none.
fn decibels(response: &[(f64, f64)]) -> Vec<f64> {
    response
        .iter()
        .map(|(re, im)| 20.0 * re.hypot(*im).log10())
        .collect()
}

/// Phase in degrees.
fn phase(curve: &BodeCurve, guide: Option<&Guide>) -> Vec<f64> {
    let radians = match (curve.style, guide) {
        (LineStyle::Points | LineStyle::Rings | LineStyle::Discs, Some(guide)) => {
            let near = |(frequency, (re, im)): (&f64, &(f64, f64))| {
                near(im.atan2(*re), guide.at(*frequency))
            };
            curve
                .frequency
                .iter()
                .zip(&curve.response)
                .map(near)
                .collect()
        }
        (LineStyle::Points | LineStyle::Rings | LineStyle::Discs, None) => {
            unwrapped(&curve.response, None)
        }
        (LineStyle::Solid | LineStyle::Dashed | LineStyle::Steps, _) => {
            unwrapped(&curve.response, start(curve, guide))
        }
    };
    radians.into_iter().map(f64::to_degrees).collect()
}

/// Where a joined curve is to begin: near the guide.
fn start(curve: &BodeCurve, guide: Option<&Guide>) -> Option<f64> {
    let first = curve.frequency.first()?;
    guide.map(|guide| guide.at(*first))
}

/// Phase in rad without jumps of more than half a turn; the first value within half a turn of `start`, or of −90°.
fn unwrapped(response: &[(f64, f64)], start: Option<f64>) -> Vec<f64> {
    let mut last = start
        .filter(|phase| phase.is_finite())
        .unwrap_or(-0.25 * TAU);
    let mut next = |(re, im): &(f64, f64)| {
        let here = near(im.atan2(*re), last);
        last = if here.is_finite() { here } else { last };
        here
    };
    response.iter().map(&mut next).collect()
}

/// `phase` plus as many turns as bring it within half a turn of `other`.
fn near(phase: f64, other: f64) -> f64 {
    let turns = ((other - phase) / TAU).round();
    if turns.is_finite() {
        phase + turns * TAU
    } else {
        phase
    }
}

/// The phase of a joined curve, looked up by frequency.
struct Guide {
    /// Logarithm of the frequency, and phase in rad.
    points: Vec<(f64, f64)>,
}

impl Guide {
    /// The phase of a joined curve that begins near another.
    fn of(curve: &BodeCurve, near: Option<&Self>) -> Self {
        let phase = unwrapped(&curve.response, start(curve, near));
        let points = curve
            .frequency
            .iter()
            .zip(phase)
            .filter(|(frequency, phase)| **frequency > 0.0 && phase.is_finite());
        Self {
            points: points
                .map(|(frequency, phase)| (frequency.ln(), phase))
                .collect(),
        }
    }

    /// Between two points along the logarithm of the frequency; past the ends, the end. NaN without points.
    fn at(&self, frequency: f64) -> f64 {
        let at = frequency.ln();
        let after = self.points.partition_point(|(place, _)| *place < at);
        match (
            after
                .checked_sub(1)
                .and_then(|before| self.points.get(before)),
            self.points.get(after),
        ) {
            (Some((left, from)), Some((right, to))) => {
                from + (to - from) * (at - left) / (right - left)
            }
            (Some((_, end)), None) | (None, Some((_, end))) => *end,
            (None, None) => f64::NAN,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1/s², in series with a lag of two poles at 10 Hz: from −180° to −360°.
    fn double_integrator_with_lag(frequency: &[f64]) -> Vec<(f64, f64)> {
        let at = |frequency: &f64| {
            let gain = 1.0 / (TAU * frequency).powi(2) / (1.0 + (frequency / 10.0).powi(2));
            let phase = -0.5 * TAU - 2.0 * (frequency / 10.0).atan();
            (gain * phase.cos(), gain * phase.sin())
        };
        frequency.iter().map(at).collect()
    }

    fn curve(
        label: &str,
        frequency: &[f64],
        response: Vec<(f64, f64)>,
        style: LineStyle,
    ) -> BodeCurve {
        BodeCurve {
            label: label.to_owned(),
            frequency: frequency.to_vec(),
            response,
            style,
            coherence: None,
            colour: None,
            deviation: None,
        }
    }

    #[test]
    fn phases_are_unwrapped_from_minus_180_to_minus_360() {
        let frequency: Vec<f64> = (0..200)
            .map(|k| 0.1 * 10f64.powf(f64::from(k) / 50.0))
            .collect();
        let response = double_integrator_with_lag(&frequency);
        // Points in disorder cannot be unwrapped along the frequency, only by the line.
        let points: Vec<f64> = frequency.iter().rev().step_by(7).copied().collect();
        let measured = double_integrator_with_lag(&points);
        let curves = [
            curve("measured", &points, measured, LineStyle::Points),
            curve("linearised", &frequency, response, LineStyle::Solid),
        ];
        let figure = bode_plot("plant", ("x/F", "m/N"), &curves, &[]);
        for line in &figure.panels[1].lines {
            for (frequency, phase) in line.points() {
                let expected = -180.0 - 2.0 * (frequency / 10.0).atan().to_degrees();
                assert!((phase - expected).abs() < 1e-9, "{frequency} {phase}"); // rounding through sin, cos, atan2
            }
        }
    }

    #[test]
    fn magnitude_is_in_decibels_and_zero_has_none() {
        let response = vec![(10.0, 0.0), (0.0, -0.1), (0.0, 0.0)];
        let figure = bode_plot(
            "",
            ("y/u", ""),
            &[curve("", &[1.0, 2.0, 3.0], response, LineStyle::Solid)],
            &[],
        );
        let gains = &figure.panels[0].lines[0].y;
        assert!((gains[0] - 20.0).abs() < 1e-12 && (gains[1] + 20.0).abs() < 1e-12); // rounding of log10
        assert!(gains[2].is_infinite());
        assert_eq!(figure.panels[0].y.unit, "dB");
    }

    #[test]
    fn values_that_are_not_finite_do_not_disturb_the_unwrapping() {
        let response = vec![
            (f64::NAN, 0.0),
            (-1.0, 1e-9),
            (f64::NAN, f64::NAN),
            (-1.0, -1e-9),
        ];
        let phases = unwrapped(&response, None);
        assert!((phases[1] + 0.5 * TAU).abs() < 1e-8 && (phases[3] + 0.5 * TAU).abs() < 1e-8); // 1e-9 from the axis
    }
}
