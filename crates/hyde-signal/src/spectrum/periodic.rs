//! The response to a periodic excitation, a multisine, with the noise seen from period to period.

use super::{CrossPower, FrequencyResponse, SpectrumError, check_pair, transform};
use crate::statistics::median;
use realfft::RealFftPlanner;
use realfft::num_complex::Complex;

/// A response at the excited lines, and what the periods tell of its noise. All vectors have one length.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicResponse {
    /// At the excited lines; the coherence is that of the spectra of the periods.
    pub response: FrequencyResponse,
    /// Standard deviation of the response, by the scatter of the periods; NaN of a single period.
    pub deviation: Vec<f64>,
    /// Amplitude of the input at each line.
    pub input: Vec<f64>,
    /// Whole periods averaged.
    pub periods: usize,
}

/// The shortest period of a signal, in samples; `None` if it has none.
///
/// The mean square of `x[k + P] - x[k]` is compared for all P up to half the record: at the period and its multiples
/// only noise is left. The shortest that is a valley with at most three times the least such rest is the period; a rest of
/// more than a quarter of what unrelated values leave is no repetition.
#[must_use]
pub fn period(signal: &[f64]) -> Option<usize> {
    if signal.len() < 4 {
        return None;
    }
    let mean = signal.iter().sum::<f64>() / signal.len() as f64;
    let centred: Vec<f64> = signal.iter().map(|value| value - mean).collect();
    let rest = differences(&centred);
    let variance = centred.iter().map(|value| value * value).sum::<f64>() / signal.len() as f64;
    let least = rest.iter().skip(2).copied().fold(f64::INFINITY, f64::min);
    // Rounding of the transforms leaves this of a signal without noise.
    let bound = 3.0 * least.max(0.0) + 1e-9 * variance;
    let repeats = |lag: usize| {
        let valley =
            rest[lag] <= rest[lag - 1] && rest.get(lag + 1).is_none_or(|next| rest[lag] <= *next);
        valley && rest[lag] <= bound && rest[lag] < 0.5 * variance
    };
    (2..rest.len()).find(|&lag| repeats(lag))
}

/// The mean square of `x[k + lag] - x[k]` for each lag up to half the length, by the transform of the autocorrelation.
fn differences(values: &[f64]) -> Vec<f64> {
    let (n, lags) = (values.len(), values.len() / 2 + 1);
    let mut padded = values.to_vec();
    padded.resize(2 * n, 0.0);
    let mut planner = RealFftPlanner::new();
    let mut power: Vec<Complex<f64>> = transform(&mut planner, padded)
        .into_iter()
        .map(|line| Complex::new(line.norm_sqr(), 0.0))
        .collect();
    let inverse = planner.plan_fft_inverse(2 * n);
    let mut products = inverse.make_output_vec();
    // Lengths are the planner's own, and all lines are real.
    let done = inverse.process(&mut power, &mut products);
    if done.is_err() {
        return Vec::new();
    }
    let mut sums = vec![0.0; n + 1];
    for (k, value) in values.iter().enumerate() {
        sums[k + 1] = sums[k] + value * value;
    }
    (0..lags)
        .map(|lag| {
            let squares = sums[n - lag] + sums[n] - sums[lag];
            (squares - 2.0 * products[lag] / (2 * n) as f64) / (n - lag) as f64
        })
        .collect()
}

/// The response of `output` to a periodic `input`, sampled at `rate_hz`, with `period` samples in each period.
///
/// Whole periods from the first sample on are averaged, so cut transients off. A slow drift, the line through the means
/// of the periods, is taken out first. The response is the mean spectrum of the
/// output over that of the input, which is unbiased with noise on both. Its variance follows from the variances and the
/// covariance of the spectra over the periods (Pintelon and Schoukens, System Identification, 2nd ed. 2012, 2.5). Given are
/// the excited lines: the amplitudes of the input at all lines, sorted, have one widest gap, between what is excited and
/// what is noise or distortion; lines above it are excited, and all that stand 20 dB out of the noise where there is no
/// gap of 12 dB.
///
/// # Errors
/// If the lengths differ, the period has fewer than 4 samples, there is not one whole period, or the rate is not positive.
pub fn periodic_response(
    input: &[f64],
    output: &[f64],
    rate_hz: f64,
    period: usize,
) -> Result<PeriodicResponse, SpectrumError> {
    check_pair(input, output, period.max(4), rate_hz)?;
    if period < 4 {
        return Err(SpectrumError::TooShort {
            samples: period,
            needed: 4,
        });
    }
    let mut planner = RealFftPlanner::new();
    let mut spectra = |values: &[f64]| -> Vec<Vec<Complex<f64>>> {
        without_drift(values, period)
            .chunks_exact(period)
            .map(|chunk| transform(&mut planner, chunk.to_vec()))
            .collect()
    };
    let (inputs, outputs) = (spectra(input), spectra(output));
    let lines: Vec<Line> = (1..period.div_ceil(2))
        .map(|line| {
            let pairs = inputs.iter().zip(&outputs);
            Line::of(&pairs.map(|(u, y)| (u[line], y[line])).collect::<Vec<_>>())
        })
        .collect();
    let excited = excited(&lines);
    let mut found = PeriodicResponse {
        response: FrequencyResponse {
            frequency_hz: vec![],
            response: vec![],
            coherence: vec![],
        },
        deviation: vec![],
        input: vec![],
        periods: inputs.len(),
    };
    for (number, line) in lines.iter().enumerate().filter(|(at, _)| excited[*at]) {
        let frequency_hz = (number + 1) as f64 * rate_hz / period as f64;
        found.response.frequency_hz.push(frequency_hz);
        found.response.response.push(line.output / line.input);
        found.response.coherence.push(line.coherence);
        found.deviation.push(line.deviation);
        found.input.push(2.0 / period as f64 * line.input.norm());
    }
    Ok(found)
}

/// The whole periods of a signal less straight lines from the mean of each, in its middle, to that of the next; before the
/// first middle and behind the last one the lines go on. A ramp of a step in each period would leak into all lines.
fn without_drift(values: &[f64], period: usize) -> Vec<f64> {
    let chunks = values.chunks_exact(period);
    let means: Vec<f64> = chunks
        .map(|chunk| chunk.iter().sum::<f64>() / period as f64)
        .collect();
    let last = means.len().saturating_sub(2);
    let drift = |k: usize| {
        let periods = (k as f64 + 0.5) / period as f64 - 0.5;
        let from = (periods.max(0.0) as usize).min(last);
        let step = means.get(from + 1).map_or(0.0, |next| next - means[from]);
        means[from] + step * (periods - from as f64)
    };
    let whole = &values[..means.len() * period];
    let pairs = whole.iter().enumerate();
    pairs.map(|(k, value)| value - drift(k)).collect()
}

/// A line of the spectrum over all periods.
struct Line {
    input: Complex<f64>,
    output: Complex<f64>,
    coherence: f64,
    /// Of output over input.
    deviation: f64,
    /// Standard deviation of the mean input.
    noise: f64,
}

impl Line {
    fn of(periods: &[(Complex<f64>, Complex<f64>)]) -> Self {
        let count = periods.len() as f64;
        let mut power = CrossPower::default();
        let (mut input, mut output) = (Complex::default(), Complex::default());
        for (u, y) in periods {
            power.add(CrossPower::of(*u, *y));
            input += u / count;
            output += y / count;
        }
        let response = output / input;
        // Residuals of the output, those of the input carried through: their variance is that of the whole expression.
        let squares = periods.iter().map(|(u, y)| {
            let rest = (y - output) - response * (u - input);
            (rest.norm_sqr(), (u - input).norm_sqr())
        });
        let (rest, noise) = squares.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
        let of_mean = |sum: f64| (sum / (count - 1.0) / count).sqrt();
        Self {
            input,
            output,
            coherence: power.coherence(),
            deviation: of_mean(rest) / input.norm(),
            noise: of_mean(noise),
        }
    }
}

/// Which lines are excited.
fn excited(lines: &[Line]) -> Vec<bool> {
    let amplitudes: Vec<f64> = lines.iter().map(|line| line.input.norm()).collect();
    let largest = amplitudes.iter().copied().fold(0.0, f64::max);
    if largest <= 0.0 {
        return vec![false; lines.len()];
    }
    // Amplitudes that are noise part by any ratio: below three times the usual noise they count as that.
    let noises: Vec<f64> = lines.iter().map(|line| line.noise).collect();
    let usual = 3.0 * median(&noises).unwrap_or(0.0);
    // The maximum ignores the NaN of a single period.
    let floor = usual.max(1e-6 * largest);
    let mut sorted: Vec<f64> = amplitudes.iter().map(|a| a.max(floor)).collect();
    sorted.sort_by(|a, b| b.total_cmp(a));
    let gap = sorted.windows(2).map(|pair| (pair[0] / pair[1], pair[0]));
    let (ratio, least) = gap
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .unwrap_or((1.0, largest));
    // Noise of a single period is not known and hides nothing.
    let stands_out = |line: &Line| line.noise.is_nan() || line.input.norm() > 10.0 * line.noise;
    lines
        .iter()
        .zip(amplitudes)
        .map(|(line, amplitude)| {
            if ratio > 4.0 {
                amplitude >= least
            } else {
                stands_out(line)
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    const PERIOD: usize = 250;
    const RATE_HZ: f64 = 500.0;
    const LINES: [usize; 5] = [3, 4, 7, 20, 61];

    /// A multisine of the lines, with phases that leave no line alone.
    fn multisine(periods: usize) -> Vec<f64> {
        let at = |k: usize| {
            let sine = |line: &usize| {
                let turn = TAU * (line * k % PERIOD) as f64 / PERIOD as f64;
                (turn + (line * line) as f64).cos()
            };
            LINES.iter().map(sine).sum()
        };
        (0..periods * PERIOD).map(at).collect()
    }

    /// `y[k] = u[k]/2 + u[k-3]/4`, round the period.
    fn filtered(u: &[f64]) -> Vec<f64> {
        let n = u.len();
        (0..n)
            .map(|k| 0.5 * u[k] + 0.25 * u[(k + n - 3) % n])
            .collect()
    }

    fn truth(line: usize) -> Complex<f64> {
        0.5 + 0.25 * Complex::new(0.0, -TAU * (3 * line) as f64 / PERIOD as f64).exp()
    }

    /// Reproducible numbers with mean 0 and standard deviation 1, nearly normal.
    fn noise(samples: usize, seed: u64) -> Vec<f64> {
        let mut state = seed;
        let mut draw = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5
        };
        (0..samples)
            .map(|_| (0..12).map(|_| draw()).sum())
            .collect()
    }

    fn with(values: Vec<f64>, noise: &[f64], size: f64) -> Vec<f64> {
        let pairs = values.into_iter().zip(noise);
        pairs.map(|(value, noise)| value + size * noise).collect()
    }

    #[test]
    fn a_multisine_shows_its_period_its_lines_and_the_response() {
        let u = multisine(4);
        assert_eq!(period(&u), Some(PERIOD));
        let found = periodic_response(&u, &filtered(&u), RATE_HZ, PERIOD).unwrap();
        assert_eq!(found.periods, 4);
        let lines: Vec<f64> = LINES.iter().map(|line| *line as f64 * 2.0).collect();
        assert_eq!(found.response.frequency_hz, lines);
        for (at, line) in LINES.into_iter().enumerate() {
            // Rounding of a transform of 250 values.
            assert!((found.response.response[at] - truth(line)).norm() < 1e-12);
            assert!((found.input[at] - 1.0).abs() < 1e-12);
            assert!(found.deviation[at] < 1e-12);
            assert!(found.response.coherence[at] > 1.0 - 1e-12);
        }
    }

    /// The deviation given is that of the error: over 200 records their squares agree.
    #[test]
    fn the_scatter_of_the_periods_tells_the_error_with_noise_on_both_sides() {
        let (mut errors, mut told, mut count) = (0.0, 0.0, 0.0);
        for seed in 0..200 {
            let clean = multisine(6);
            let y = with(filtered(&clean), &noise(clean.len(), 2 * seed + 1), 0.3);
            let u = with(clean, &noise(y.len(), 2 * seed + 2), 0.2);
            assert_eq!(period(&u), Some(PERIOD));
            let found = periodic_response(&u, &y, RATE_HZ, PERIOD).unwrap();
            assert_eq!(found.response.frequency_hz.len(), LINES.len());
            for (at, line) in LINES.into_iter().enumerate() {
                errors += (found.response.response[at] - truth(line)).norm_sqr();
                told += found.deviation[at].powi(2);
                count += 1.0;
            }
        }
        // 1000 squares of complex normal values scatter by 1/sqrt(1000) = 3 %, those told by 1/sqrt(5000).
        assert!((errors / told - 1.0).abs() < 0.1, "{}", errors / told);
        // In closed form: output 0.3 and input 0.2 |G| on amplitudes 1, 6 periods of 250 samples.
        let gain = LINES.map(|line| truth(line).norm_sqr()).iter().sum::<f64>() / 5.0;
        let expected = 4.0 * (0.3_f64.powi(2) + 0.2_f64.powi(2) * gain) / (6.0 * 250.0);
        assert!((told / count / expected - 1.0).abs() < 0.05);
    }

    #[test]
    fn a_drift_of_the_output_does_not_leak_into_the_lines() {
        let u = multisine(6);
        let ramp = |(k, y): (usize, f64)| y + 0.01 * k as f64 - 7.0;
        let y: Vec<f64> = filtered(&u).into_iter().enumerate().map(ramp).collect();
        let found = periodic_response(&u, &y, RATE_HZ, PERIOD).unwrap();
        for (at, line) in LINES.into_iter().enumerate() {
            // Rounding of values up to 22.
            assert!((found.response.response[at] - truth(line)).norm() < 1e-11);
        }
    }

    #[test]
    fn lines_of_many_sizes_are_all_excited_and_noise_is_not() {
        let lines: Vec<usize> = (5..=100).collect();
        let at = |k: usize| {
            let sine = |line: &usize| {
                let turn = TAU * (line * k % PERIOD) as f64 / PERIOD as f64;
                5.0 / *line as f64 * (turn + (line * line) as f64 / 9.0).cos()
            };
            lines.iter().map(sine).sum::<f64>()
        };
        let clean: Vec<f64> = (0..8 * PERIOD).map(at).collect();
        let u = with(clean, &noise(8 * PERIOD, 7), 0.01);
        let found = periodic_response(&u, &u, RATE_HZ, PERIOD).unwrap();
        assert_eq!(found.response.frequency_hz.len(), lines.len());
        assert!((found.response.frequency_hz[0] - 10.0).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_repeat_has_no_period() {
        assert_eq!(period(&noise(2000, 3)), None);
        assert_eq!(period(&[]), None);
        assert_eq!(period(&[1.0; 3]), None);
        let ramp: Vec<f64> = (0..100).map(f64::from).collect();
        assert_eq!(period(&ramp), None);
    }

    #[test]
    fn what_cannot_be_estimated_is_refused() {
        let u = multisine(1);
        assert!(periodic_response(&u, &u[1..], RATE_HZ, PERIOD).is_err());
        assert!(periodic_response(&u, &u, RATE_HZ, PERIOD + 1).is_err());
        assert!(periodic_response(&u, &u, 0.0, PERIOD).is_err());
        assert!(periodic_response(&u, &u, RATE_HZ, 3).is_err());
        // A single period has a response and no scatter.
        let one = periodic_response(&u, &u, RATE_HZ, PERIOD).unwrap();
        assert!(one.deviation.iter().all(|deviation| deviation.is_nan()));
        assert_eq!(one.response.frequency_hz.len(), LINES.len());
    }
}
