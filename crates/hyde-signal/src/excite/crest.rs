//! [`low_crest`]: phases for which a multisine uses its limits as evenly as it can.
//!
//! It begins with the phases of Schroeder (IEEE Trans. Inf. Theory 16, 1970, 85) and goes on by clipping: the signal is cut
//! at a part of its peak, the phases of what is cut are taken, sizes stay (Van der Ouderaa, Schoukens and Renneboog, IEEE
//! Trans. Instrum. Meas. 37, 1988, 145; compared with others by Guillaume et al., ibid. 40, 1991, 982). Of a motion the
//! derivative that is nearest to its limit is cut.

use super::limits::{Bounds, Limits};
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Rounds of cutting.
const ROUNDS: usize = 100;
/// The part of the peak that is left in the first round and in the last.
const CUT: (f64, f64) = (0.75, 0.97);

/// Lines of a multisine.
pub(super) struct Spectrum {
    /// The number of the first line; they follow each other.
    pub(super) first: usize,
    /// Their sizes, SI.
    pub(super) sizes: Vec<f64>,
    /// Samples of a period, and the time between them, s.
    pub(super) period: usize,
    pub(super) step_s: f64,
}

/// A period of the signal, and its crest factor: the largest peak over the largest root mean square, each in units of its
/// limit.
pub(super) fn low_crest(spectrum: &Spectrum, bounds: &Bounds) -> (Vec<f64>, f64) {
    let limits: Vec<f64> = match bounds {
        Bounds::Motion(Limits {
            travel,
            speed,
            acceleration,
            jerk,
        }) => vec![0.5 * travel, *speed, *acceleration, *jerk],
        Bounds::Effort(peak) => vec![*peak],
    };
    let mut planner = RealFftPlanner::new();
    let mut phases = spectrum.begin(&mut planner, &limits);
    let mut best: Option<(f64, Vec<f64>)> = None;
    // Phases leave root mean squares as they are.
    let effective = limits.iter().enumerate().map(|(order, limit)| {
        let values = spectrum.signal(&mut planner, &phases, order);
        (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt() / limit
    });
    let effective = effective.fold(0.0, f64::max);
    for round in 0..ROUNDS {
        let Some((order, mut values, load)) = spectrum.nearest(&mut planner, &phases, &limits)
        else {
            break;
        };
        if best.as_ref().is_none_or(|(least, _)| load < *least) {
            best = Some((load, phases.clone()));
        }
        let along = round as f64 / (ROUNDS - 1) as f64;
        let level = (CUT.0 + (CUT.1 - CUT.0) * along) * load * limits[order];
        values.iter_mut().for_each(|v| *v = v.clamp(-level, level));
        let plan = planner.plan_fft_forward(values.len());
        let mut lines = plan.make_output_vec();
        if plan.process(&mut values, &mut lines).is_err() {
            break;
        }
        for (number, phase) in phases.iter_mut().enumerate() {
            *phase = lines[spectrum.first + number].arg() - order as f64 * FRAC_PI_2;
        }
    }
    let (load, phases) = best.unwrap_or((f64::NAN, phases));
    let values = spectrum.signal(&mut planner, &phases, 0);
    (values, load / effective)
}

/// Phases by the power of the lines below each.
fn schroeder(sizes: impl Iterator<Item = f64> + Clone) -> Vec<f64> {
    let whole: f64 = sizes.clone().map(|size| size * size).sum();
    let (mut below, mut slope, mut phase) = (0.0, 0.0, 0.0);
    let each = sizes.map(|size| {
        phase -= TAU * slope;
        below += size * size / whole;
        slope = below;
        (phase % TAU) - PI
    });
    each.collect()
}

impl Spectrum {
    /// The phases of Schroeder for the power of that derivative for which they come off best.
    fn begin(&self, planner: &mut RealFftPlanner<f64>, limits: &[f64]) -> Vec<f64> {
        let each = (0..limits.len()).map(|order| {
            let order = i32::try_from(order).unwrap_or(0);
            let sizes = self.sizes.iter().enumerate();
            let sizes = sizes.map(|(number, size)| size * self.omega(number).powi(order));
            schroeder(sizes)
        });
        let loads = each.map(|phases| {
            let load = self.nearest(planner, &phases, limits);
            (phases, load.map_or(f64::INFINITY, |(.., load)| load))
        });
        let best = loads.min_by(|a, b| a.1.total_cmp(&b.1));
        best.map_or_else(Vec::new, |(phases, _)| phases)
    }

    /// The derivative that is nearest to its limit: its number, its values, and how near.
    fn nearest(
        &self,
        planner: &mut RealFftPlanner<f64>,
        phases: &[f64],
        limits: &[f64],
    ) -> Option<(usize, Vec<f64>, f64)> {
        let each = limits.iter().enumerate().map(|(order, limit)| {
            let values = self.signal(planner, phases, order);
            let peak = values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
            (order, values, peak / limit)
        });
        each.max_by(|a, b| a.2.total_cmp(&b.2))
    }

    fn omega(&self, number: usize) -> f64 {
        TAU * (self.first + number) as f64 / (self.period as f64 * self.step_s)
    }

    /// A period of a derivative of the signal.
    fn signal(&self, planner: &mut RealFftPlanner<f64>, phases: &[f64], order: usize) -> Vec<f64> {
        let plan = planner.plan_fft_inverse(self.period);
        let mut lines = plan.make_input_vec();
        for (number, (size, phase)) in self.sizes.iter().zip(phases).enumerate() {
            let line = self.first + number;
            let own = 0.5 * size * self.omega(number).powi(i32::try_from(order).unwrap_or(0));
            lines[line] = Complex::from_polar(own, phase + order as f64 * FRAC_PI_2);
        }
        let mut values = plan.make_output_vec();
        // Lengths are the plan's own; the first line and the middle one are empty.
        let done = plan.process(&mut lines, &mut values);
        debug_assert!(done.is_ok(), "the transform has the lengths of its plan");
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn flat(lines: usize) -> Spectrum {
        Spectrum {
            first: 1,
            sizes: vec![1.0; lines],
            period: 16 * lines,
            step_s: 1e-3,
        }
    }

    #[test]
    fn cutting_lowers_the_crest_of_schroeder() {
        // Schroeder's phases leave about 1.7 (3.6 dB above a square wave), cutting about 1.4 (Van der Ouderaa et al.).
        let spectrum = flat(31);
        let mut planner = RealFftPlanner::new();
        let first = spectrum.signal(&mut planner, &schroeder(spectrum.sizes.iter().copied()), 0);
        let peak = first.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let schroeder = peak / (31.0_f64 / 2.0).sqrt();
        let (values, crest) = low_crest(&spectrum, &Bounds::Effort(1.0));
        assert!((1.55..1.9).contains(&schroeder), "{schroeder}");
        assert!(crest < 1.52, "{crest}");
        let power = values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64;
        assert!((power - 15.5).abs() < 1e-9, "sizes stay: {power}");
    }

    #[test]
    fn the_binding_derivative_is_the_one_that_is_cut() {
        let limits = Limits {
            travel: 1e3,
            speed: 1e3,
            acceleration: 1.0,
            jerk: 1e9,
        };
        let spectrum = flat(20);
        let (values, crest) = low_crest(&spectrum, &Bounds::Motion(limits));
        let second: Vec<f64> = (0..values.len())
            .map(|k| {
                let n = values.len();
                values[(k + 1) % n] - 2.0 * values[k] + values[(k + n - 1) % n]
            })
            .collect();
        let peak = second.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        let mean = second.iter().map(|v| v * v).sum::<f64>() / second.len() as f64;
        assert!((peak / mean.sqrt() - crest).abs() < 0.05, "{crest}");
        assert!(crest < 1.7, "{crest}");
    }
}
