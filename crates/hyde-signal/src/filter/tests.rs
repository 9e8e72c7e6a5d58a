//! Filters against SciPy 1.17.1 and against what a Butterworth filter is by definition.

use super::*;

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

/// Noise on a ramp from 0 to 3.
fn ramp() -> Vec<f64> {
    noise(60, 1)
        .iter()
        .enumerate()
        .map(|(k, value)| value + k as f64 * (3.0 / 59.0))
        .collect()
}

fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!(
        (value - expected).abs() <= tolerance,
        "{value} is not {expected}"
    );
}

/// `filtfilt(*butter(order, corner, fs=1000), x)` at rows 0, 1, 17, 30, 58, 59.
#[test]
fn zero_phase_is_that_of_scipy() {
    let cases = [
        (
            4,
            100.0,
            [
                -0.07559439870395862,
                0.030937743414822753,
                0.8989558892329069,
                1.6040754106008874,
                2.7834536943363166,
                2.5712830514979776,
            ],
        ),
        (
            3,
            40.0,
            [
                -0.0764590468112112,
                -0.007664136230680043,
                0.93906608762141,
                1.553026277154148,
                2.6145717527959222,
                2.601516865566229,
            ],
        ),
        (
            1,
            200.0,
            [
                -0.07679228970029528,
                0.06128669407585427,
                0.9054655960728757,
                1.571657702798954,
                3.03580944827332,
                2.573170315797287,
            ],
        ),
    ];
    for (order, corner, expected) in cases {
        let filter = LowPass::butterworth(order, corner, 1000.0).unwrap();
        let filtered = filter.zero_phase(&ramp()).unwrap();
        assert_eq!(filtered.len(), 60);
        for (row, expected) in [0, 1, 17, 30, 58, 59].into_iter().zip(expected) {
            // SciPy's own filtfilt and sosfiltfilt differ by up to 1.2e-13 on these values.
            assert_near(filtered[row], expected, 1e-12);
        }
    }
}

/// `b, a = butter(4, 100, fs=1000); lfilter(b, a, x, zi=lfilter_zi(b, a) * x[0])`.
#[test]
fn causal_starts_in_the_steady_state_like_scipy() {
    let filtered = LowPass::butterworth(4, 100.0, 1000.0)
        .unwrap()
        .causal(&ramp());
    let expected = [
        (0, -0.07679082912728642),
        (1, -0.07612967347180334),
        (17, 0.691382832936335),
        (59, 2.9070250381551013),
    ];
    for (row, expected) in expected {
        // Rounding of two arrangements of one filter.
        assert_near(filtered[row], expected, 1e-12);
    }
}

/// `sosfiltfilt` at row 1500; SciPy's `filtfilt` is off by up to 0.3 here.
#[test]
fn a_very_low_corner_stays_accurate() {
    let mut sum = 0.0;
    let walk = noise(3000, 3).into_iter().map(|step| {
        sum += step;
        sum
    });
    let filter = LowPass::butterworth(4, 0.05, 1000.0).unwrap();
    let filtered = filter.zero_phase(&walk.collect::<Vec<_>>()).unwrap();
    // The sections of SciPy and ours round differently; a condition of 1e7 at this corner leaves 9 digits.
    assert_near(filtered[1500], -2.0354849813033686, 1e-8);
}

#[test]
fn the_gain_at_the_corner_is_a_half_both_ways_for_every_order() {
    let corner = 50.0;
    let sine: Vec<f64> = (0..4000)
        .map(|k| (2.0 * PI * corner * f64::from(k) / 1000.0).sin())
        .collect();
    for order in 1..=20 {
        let filter = LowPass::butterworth(order, corner, 1000.0).unwrap();
        let filtered = filter.zero_phase(&sine).unwrap();
        for row in 1500..2500 {
            // The transients of both ends have died out to rounding in 1.5 s.
            assert_near(filtered[row], 0.5 * sine[row], 1e-9);
        }
    }
}

#[test]
fn straight_lines_pass_unchanged() {
    let line: Vec<f64> = (0..100).map(|k| 3.0 - 0.25 * f64::from(k)).collect();
    let filter = LowPass::butterworth(4, 20.0, 1000.0).unwrap();
    let filtered = filter.zero_phase(&line[..]).unwrap();
    let constant = filter.zero_phase(&[7.0; 16]).unwrap();
    for row in 40..60 {
        // The odd extension continues the line for 15 samples only; inside, what that cuts off has mostly decayed.
        assert_near(filtered[row], line[row], 0.25);
    }
    for value in constant {
        // Steady states and unit gain, to rounding.
        assert_near(value, 7.0, 1e-12);
    }
}

#[test]
fn what_cannot_be_filtered_is_refused() {
    let message = |order, corner, rate| {
        LowPass::butterworth(order, corner, rate)
            .unwrap_err()
            .to_string()
    };
    assert_eq!(
        message(0, 1.0, 10.0),
        "a filter of order 0 is not from 1 to 20"
    );
    assert_eq!(
        message(4, 500.0, 1000.0),
        "a corner of 500 Hz is not between 0 and 500 Hz, half the sampling rate"
    );
    assert!(LowPass::butterworth(4, f64::NAN, 1000.0).is_err());
    assert!(LowPass::butterworth(4, -1.0, 1000.0).is_err());
    let filter = LowPass::butterworth(4, 100.0, 1000.0).unwrap();
    let error = filter.zero_phase(&[1.0; 15]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "15 samples are too few to filter, 16 are needed"
    );
    assert!(filter.causal(&[]).is_empty());
}

#[test]
fn differences_are_exact_for_parabolas_inside_and_lines_at_the_ends() {
    let dt = 0.5;
    let parabola: Vec<f64> = (0..6).map(|k| (f64::from(k) * dt).powi(2)).collect();
    // Derivative 2t at t = 0.5, 1, 1.5, 2; at the ends the slope of the first and last interval.
    assert_eq!(
        central_difference(&parabola, dt),
        [0.5, 1.0, 2.0, 3.0, 4.0, 4.5]
    );
    assert_eq!(central_difference(&[1.0], dt), [0.0]);
    assert!(central_difference(&[], dt).is_empty());
}
