//! Where most of a signal's power is.

use super::{SpectrumError, check_pair, transform};
use crate::statistics::median;
use realfft::RealFftPlanner;

/// Zeros behind the signal make the lines so many times denser, so that a parabola fits the lobe at its top.
const DENSER: usize = 4;

/// The frequency in Hz at which the amplitude spectrum of a signal about its median is highest; at least one period is in
/// the record. NaN of a signal that does not change.
///
/// The median is where a signal rests that dies out, and the middle of one that does not. There is no window: what rings and dies out has its power at the beginning, where a window would take it. So of a free
/// vibration it is the resonance, and of a steady sine with n periods it is right to 1/(10 n) or so, for its image at the
/// negative frequency leaks in. Between the lines a parabola is laid through the logarithms (Gasior and Gonzalez, AIP Conf.
/// Proc. 732 (2004) 276).
///
/// # Errors
/// If there are fewer than 8 samples, or the rate is not positive.
pub fn strongest_frequency(values: &[f64], rate_hz: f64) -> Result<f64, SpectrumError> {
    check_pair(values, values, 8, rate_hz)?;
    let rest = median(values).unwrap_or(0.0);
    let mut padded: Vec<f64> = values.iter().map(|value| value - rest).collect();
    padded.resize((DENSER * values.len()).next_power_of_two(), 0.0);
    let spacing = rate_hz / padded.len() as f64;
    let first = (rate_hz / values.len() as f64 / spacing).ceil() as usize;
    let lines = transform(&mut RealFftPlanner::new(), padded);
    let power: Vec<f64> = lines.iter().map(|line| line.norm_sqr()).collect();
    let inside = first..power.len() - 1;
    let highest = inside.max_by(|a, b| power[*a].total_cmp(&power[*b]));
    let Some(at) = highest.filter(|at| power[*at] > 0.0) else {
        return Ok(f64::NAN);
    };
    let [below, here, above] = [at - 1, at, at + 1].map(|line| power[line].ln());
    let bend = below - 2.0 * here + above;
    let shift = if bend < 0.0 && bend.is_finite() {
        (0.5 * (below - above) / bend).clamp(-0.5, 0.5)
    } else {
        0.0
    };
    Ok((at as f64 + shift) * spacing)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn a_sine_is_found_between_the_lines() {
        let rate = 1000.0;
        for f in [50.0, 61.3, 123.77] {
            let wave = |k: usize| 3.0 + (TAU * f * k as f64 / rate).sin();
            let values: Vec<f64> = (0..1000).map(wave).collect();
            let found = strongest_frequency(&values, rate).unwrap();
            // 50 periods and more: a tenth of a fiftieth of the line spacing of 1 Hz, and the parabola's own error.
            assert!((found - f).abs() < 5e-3, "{found} {f}");
        }
    }

    #[test]
    fn what_is_struck_is_found_at_its_resonance_though_it_dies_out() {
        // The velocity of a second-order system behind a step: its transform is that of the displacement behind a blow,
        // highest at wn sqrt(1 - 2 zeta^2). It is over long before the record is, and has a mean.
        let (wn, zeta, rate) = (100.0, 0.3_f64, 1000.0);
        let damped = wn * (1.0 - zeta * zeta).sqrt();
        let values: Vec<f64> = (0..2000)
            .map(|k| f64::from(k) / rate)
            .map(|t| (-zeta * wn * t).exp() * (damped * t).sin())
            .collect();
        let found = strongest_frequency(&values, rate).unwrap();
        let exact = wn * (1.0 - 2.0 * zeta * zeta).sqrt() / TAU;
        // Samples 63 a period: (w/rate)^2/12 = 1e-3 of a spectrum that is flat at the top.
        assert!((found / exact - 1.0).abs() < 5e-3, "{found} {exact}");
    }

    #[test]
    fn what_rests_has_none_and_a_few_samples_are_refused() {
        assert!(strongest_frequency(&[2.0; 64], 10.0).unwrap().is_nan());
        assert!(strongest_frequency(&[1.0, 2.0], 10.0).is_err());
    }
}
