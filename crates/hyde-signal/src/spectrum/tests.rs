//! Estimates against SciPy 1.17.1 and against responses known in closed form.

use super::*;
use std::f64::consts::PI;

const RATE_HZ: f64 = 1000.0;

/// Reproducible numbers in -0.5..0.5, the same as in the script that made the reference values.
fn noise(samples: usize, seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut draw = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 9_007_199_254_740_992.0 - 0.5
    };
    (0..samples).map(|_| draw()).collect()
}

/// A system `y[k+1] = -a1 y[k] - a2 y[k-1] + b1 u[k] + b2 u[k-1]`.
struct Discrete {
    a: [f64; 2],
    b: [f64; 2],
}

impl Discrete {
    /// The exact equivalent of `1 / (T s + 1)` behind a zero-order hold, `ratio` being `exp(-dt/T)`.
    fn lag(ratio: f64) -> Self {
        Self {
            a: [-ratio, 0.0],
            b: [1.0 - ratio, 0.0],
        }
    }

    /// The exact equivalent of `w^2 / (s^2 + 2 d w s + w^2)` behind a zero-order hold at 1 kHz
    /// (Astrom and Wittenmark, Computer-Controlled Systems, 3rd ed. 1997, table 2.1).
    fn resonance(frequency_hz: f64, damping: f64) -> Self {
        let (w, h) = (2.0 * PI * frequency_hz, 1.0 / RATE_HZ);
        let damped = w * (1.0 - damping * damping).sqrt();
        let (alpha, beta, gamma) = (
            (-damping * w * h).exp(),
            (damped * h).cos(),
            (damped * h).sin(),
        );
        let ratio = damping * w / damped;
        Self {
            a: [-2.0 * alpha * beta, alpha * alpha],
            b: [
                1.0 - alpha * (beta + ratio * gamma),
                alpha * alpha + alpha * (ratio * gamma - beta),
            ],
        }
    }

    fn simulate(&self, input: &[f64]) -> Vec<f64> {
        let mut output = vec![0.0; input.len()];
        for k in 1..input.len() {
            let (before_y, before_u) = if k > 1 {
                (output[k - 2], input[k - 2])
            } else {
                (0.0, 0.0)
            };
            output[k] = -self.a[0] * output[k - 1] - self.a[1] * before_y
                + self.b[0] * input[k - 1]
                + self.b[1] * before_u;
        }
        output
    }

    fn response(&self, frequency_hz: f64) -> Complex<f64> {
        let z = Complex::from_polar(1.0, 2.0 * PI * frequency_hz / RATE_HZ);
        (z * self.b[0] + self.b[1]) / (z * z + z * self.a[0] + self.a[1])
    }
}

fn worst_error(estimate: &FrequencyResponse, truth: impl Fn(f64) -> Complex<f64>) -> f64 {
    let lines = estimate.frequency_hz.iter().zip(&estimate.response);
    lines
        .map(|(&f, h)| (h - truth(f)).norm() / truth(f).norm())
        .fold(0.0, f64::max)
}

/// `csd(u, y) / welch(u)` and `coherence(u, y)` with fs=1000, nperseg=256.
#[test]
fn welch_is_that_of_scipy() {
    let input = noise(4096, 7);
    let output = Discrete::lag(0.9).simulate(&input);
    let estimate = welch_response(&input, &output, RATE_HZ, 256).unwrap();
    assert_eq!(estimate.frequency_hz.len(), 129);
    let expected = [
        (
            1,
            3.90625,
            0.9151142123377375,
            -0.2567859047688795,
            0.9873997012098017,
        ),
        (
            10,
            39.0625,
            0.11023104808074768,
            -0.37682211200072613,
            0.9966075668827015,
        ),
        (
            100,
            390.625,
            -0.052243080518948,
            -0.019830606588759136,
            0.9999435210076262,
        ),
        (128, 500.0, -0.05262195296705592, 0.0, 0.999933149784562),
    ];
    for (line, frequency, re, im, coherence) in expected {
        // Rounding of two transforms of 256 values.
        assert!((estimate.frequency_hz[line] - frequency).abs() < 1e-12);
        assert!(
            (estimate.response[line] - Complex::new(re, im)).norm() < 1e-12,
            "line {line}"
        );
        assert!(
            (estimate.coherence[line] - coherence).abs() < 1e-12,
            "line {line}"
        );
    }
}

/// `welch(u, fs=1000)` with an even and an odd segment.
#[test]
fn the_density_is_that_of_scipy_and_adds_up() {
    let values = noise(4096, 7);
    let (_, density) = power_spectral_density(&values, RATE_HZ, 256).unwrap();
    let (_, odd) = power_spectral_density(&values[..1000], RATE_HZ, 255).unwrap();
    for (value, expected) in [
        (density[1], 0.0001506635775019039),
        (density[100], 0.00018092190030748325),
        (density[128], 8.767920083695145e-05),
        (odd[0], 1.6245731349164556e-05),
        (odd[1], 6.97819748566868e-05),
        (odd[127], 7.887083629321709e-05),
    ] {
        // Rounding, relative to the density.
        assert!(
            (value / expected - 1.0).abs() < 1e-11,
            "{value} is not {expected}"
        );
    }
    // Uniform noise has the variance 1/12; the estimate of 31 half-independent segments scatters by some percent.
    let power: f64 = density.iter().sum::<f64>() * RATE_HZ / 256.0;
    assert!((power * 12.0 - 1.0).abs() < 0.05, "{power}");
}

#[test]
fn welch_finds_a_first_order_lag_in_noise() {
    let lag = Discrete::lag(0.9);
    let input = noise(1 << 17, 11);
    let output = lag.simulate(&input);
    let estimate = welch_response(&input, &output, RATE_HZ, 1024)
        .unwrap()
        .between(2.0, 450.0);
    // Leakage of a segment 100 time constants long: 3e-2 of a line, averaged over 255 segments.
    assert!(worst_error(&estimate, |f| lag.response(f)) < 0.005);
    assert!(
        estimate
            .coherence
            .iter()
            .all(|&coherence| coherence > 0.998)
    );
}

#[test]
fn noise_on_the_output_lowers_the_coherence_but_not_the_gain() {
    let lag = Discrete::lag(0.9);
    let input = noise(1 << 18, 11);
    let disturbance = noise(1 << 18, 12);
    let clean = lag.simulate(&input);
    let output: Vec<_> = clean
        .iter()
        .zip(&disturbance)
        .map(|(y, n)| y + 0.1 * n)
        .collect();
    let estimate = welch_response(&input, &output, RATE_HZ, 512).unwrap();
    for (line, frequency) in [(5, 9.765625), (50, 97.65625)] {
        let truth = lag.response(frequency);
        let coherence = truth.norm_sqr() / (truth.norm_sqr() + 0.01);
        // 1023 segments: a standard deviation of about 1 % of the noise to signal ratio.
        assert!((estimate.coherence[line] - coherence).abs() < 0.02);
        assert!((estimate.response[line] - truth).norm() < 0.02 * truth.norm());
    }
}

#[test]
fn a_sine_fit_is_exact_for_sines_on_a_drift_at_uneven_instants() {
    let jitter = noise(400, 5);
    let time: Vec<f64> = (0..400)
        .zip(&jitter)
        .map(|(k, j)| (f64::from(k) + 0.4 * j) / RATE_HZ)
        .collect();
    let (frequency, damping, resonance) = (27.3, 0.02, 35.0);
    let s = Complex::new(0.0, frequency / resonance);
    let truth = Complex::new(1.0, 0.0) / (s * s + 2.0 * damping * s + 1.0);
    let input: Vec<f64> = time
        .iter()
        .map(|t| 0.3 * (2.0 * PI * frequency * t).sin())
        .collect();
    let output: Vec<f64> = time
        .iter()
        .map(|t| {
            0.3 * truth.norm() * (2.0 * PI * frequency * t + truth.arg()).sin() + 5.0 - 20.0 * t
        })
        .collect();
    let estimate = response_at(&[frequency], &time, &input, &output).unwrap();
    // Rounding: the drift is 25 times the amplitude.
    assert!((estimate.response[0] - truth).norm() < 1e-11 * truth.norm());
    assert!((estimate.coherence[0] - 1.0).abs() < 1e-11);
}

#[test]
fn whole_periods_of_a_multisine_give_every_line() {
    let lag = Discrete::lag(0.8);
    let lines: Vec<f64> = (1..40).map(|k| f64::from(k) * 10.0).collect();
    // Schroeder phases; 4 periods of 100 samples, of which the first lets the transient (0.8^100) die out.
    let tones: Vec<(f64, f64)> = (1..)
        .zip(&lines)
        .map(|(k, &f)| (f, -PI * f64::from(k * k) / 39.0))
        .collect();
    let instants: Vec<f64> = (0..400).map(|k| f64::from(k) / RATE_HZ).collect();
    let tone = |t: f64| {
        tones
            .iter()
            .map(|(f, phase)| (2.0 * PI * f * t + phase).cos())
            .sum()
    };
    let input: Vec<f64> = instants.iter().map(|&t| tone(t)).collect();
    let output = lag.simulate(&input);
    let estimate = response_at(&lines, &instants[100..], &input[100..], &output[100..]).unwrap();
    // The slope that is fitted along is not quite orthogonal to the other sines, even under the window.
    assert!(worst_error(&estimate, |f| lag.response(f)) < 3e-4);
}

/// A sweep from 5 to 200 Hz in 8 s with a rest of 1 s before and after.
fn sweep() -> Vec<f64> {
    let instants = (0..10_000).map(|k| f64::from(k) / RATE_HZ - 1.0);
    let phase = |t: f64| 2.0 * PI * (5.0 * t + 0.5 * (200.0 - 5.0) / 8.0 * t * t);
    instants
        .map(|t| {
            if (0.0..8.0).contains(&t) {
                phase(t).sin()
            } else {
                0.0
            }
        })
        .collect()
}

#[test]
fn a_sweep_shows_a_resonance() {
    let resonance = Discrete::resonance(35.0, 0.02);
    let input = sweep();
    let output = resonance.simulate(&input);
    let estimate = swept_response(&input, &output, 1.0 / RATE_HZ, 0)
        .unwrap()
        .between(8.0, 190.0);
    // From rest to rest a transform is exact; the fade touches only the rest.
    assert!(worst_error(&estimate, |f| resonance.response(f)) < 1e-3);
    // Three neighbours average over 0.7 Hz, half the width of the peak (2 d f = 1.4 Hz).
    let smooth = swept_response(&input, &output, 1.0 / RATE_HZ, 3)
        .unwrap()
        .between(8.0, 190.0);
    assert!(worst_error(&smooth, |f| resonance.response(f)) < 0.1);
    assert!(smooth.coherence.iter().all(|&coherence| coherence > 0.9));
}

#[test]
fn a_sweep_shows_the_frequencies_that_it_begins_with() {
    // From 5 to 200 Hz in 20 s: 5 .. 9 Hz are passed in the first 2 %, and the lag remembers a quarter of that.
    let (from, to, time_s) = (5.0, 200.0, 20.0);
    let at = |k: usize| k as f64 / RATE_HZ;
    let cycles = |t: f64| from * t + 0.5 * (to - from) * t * t / time_s;
    let count = (time_s * RATE_HZ) as usize;
    let input: Vec<f64> = (0..count)
        .map(|k| (2.0 * std::f64::consts::PI * cycles(at(k))).sin())
        .collect();
    let lag = Discrete::lag((-1.0 / (0.1 * RATE_HZ)).exp());
    let output = lag.simulate(&input);
    let estimate = swept_response(&input, &output, 1.0 / RATE_HZ, 10)
        .unwrap()
        .between(from, 150.0);
    assert!(worst_error(&estimate, |f| lag.response(f)) < 0.02);
}

#[test]
fn a_sweep_on_a_slow_feed_shows_it_as_well() {
    let resonance = Discrete::resonance(35.0, 0.1);
    let input = sweep();
    let feed = |k: usize| 0.05 * k as f64 / RATE_HZ;
    let output: Vec<f64> = resonance
        .simulate(&input)
        .iter()
        .enumerate()
        .map(|(k, y)| y + feed(k))
        .collect();
    let estimate = swept_response(&input, &output, 1.0 / RATE_HZ, 2)
        .unwrap()
        .between(8.0, 190.0);
    // The straight line goes out exactly; what is left is the smoothing over 0.5 Hz of a peak 7 Hz wide.
    assert!(worst_error(&estimate, |f| resonance.response(f)) < 0.005);
}

#[test]
fn in_a_closed_loop_the_injected_signal_tells_the_plant() {
    // u = r - 2 y + n, y = lag(u): noise n goes round the loop.
    let lag = Discrete::lag(0.9);
    let (reference, disturbance) = (noise(1 << 19, 21), noise(1 << 19, 22));
    let (mut input, mut output) = (vec![0.0; 1 << 19], vec![0.0; 1 << 19]);
    for k in 0..input.len() {
        output[k] = if k > 0 {
            0.9 * output[k - 1] + 0.1 * input[k - 1]
        } else {
            0.0
        };
        input[k] = reference[k] - 2.0 * (output[k] + 0.5 * disturbance[k]);
    }
    let measured: Vec<f64> = output
        .iter()
        .zip(&disturbance)
        .map(|(y, n)| y + 0.5 * n)
        .collect();
    let to = |signal| {
        welch_response(&reference, signal, RATE_HZ, 512)
            .unwrap()
            .between(10.0, 60.0)
    };
    let joint = to(&measured).over(&to(&input));
    let direct = welch_response(&input, &measured, RATE_HZ, 512)
        .unwrap()
        .between(10.0, 60.0);
    // The noise is twice the gain at 60 Hz and enters input and output: 2.7/sqrt(2047) = 6 %, and thrice that at worst.
    assert!(worst_error(&joint, |f| lag.response(f)) < 0.18);
    // The direct estimate is drawn towards the negative inverse of the controller, here to (G - 0.5)/2.
    assert!(worst_error(&direct, |f| lag.response(f)) > 1.0);
    assert!(worst_error(&direct, |f| (lag.response(f) - 0.5) / 2.0) < 0.18);
}

#[test]
fn what_cannot_be_estimated_is_refused() {
    let values = noise(100, 1);
    let time: Vec<f64> = (0..100).map(|k| f64::from(k) / RATE_HZ).collect();
    let message = |error: SpectrumError| error.to_string();
    assert_eq!(
        message(welch_response(&values, &values[1..], RATE_HZ, 50).unwrap_err()),
        "sequences of 100 and 99 samples do not belong together"
    );
    assert_eq!(
        message(welch_response(&values, &values, RATE_HZ, 101).unwrap_err()),
        "100 samples are too few, 101 are needed"
    );
    assert_eq!(
        message(swept_response(&values, &values, 0.0, 1).unwrap_err()),
        "a sampling rate of inf Hz is not positive"
    );
    let at = |f: f64| response_at(&[f], &time, &values, &values);
    assert!(at(10.0).is_ok());
    assert!(matches!(at(9.0), Err(SpectrumError::Frequency { .. })));
    assert!(matches!(at(500.0), Err(SpectrumError::Frequency { .. })));
    assert!(matches!(at(f64::NAN), Err(SpectrumError::Frequency { .. })));
    assert!(matches!(
        response_at(&[1.0], &[0.0; 9], &[0.0; 9], &[0.0; 9]),
        Err(SpectrumError::Rate { .. })
    ));
    assert!(matches!(
        response_at(&[1.0], &[], &[], &[]),
        Err(SpectrumError::TooShort { .. })
    ));
}
