//! Exact tick lists for ranges met in practice, and for the ones that break naive code.

use super::*;

fn major(scale: Scale, lo: f64, hi: f64, at_most: usize) -> Vec<f64> {
    ticks(scale, lo, hi, at_most).major
}

fn labels(scale: Scale, lo: f64, hi: f64, at_most: usize) -> String {
    ticks(scale, lo, hi, at_most).labels.join(" ")
}

#[test]
fn linear_steps_are_1_2_5() {
    assert_eq!(
        major(Scale::Linear, 0.0, 1.0, 5),
        [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]
    );
    assert_eq!(
        major(Scale::Linear, 0.0, 1.0, 10),
        [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]
    );
    assert_eq!(major(Scale::Linear, 0.0, 0.7, 5), [0.0, 0.2, 0.4, 0.6]);
    assert_eq!(
        major(Scale::Linear, -1.1, 1.1, 5),
        [-1.0, -0.5, 0.0, 0.5, 1.0]
    );
    assert_eq!(major(Scale::Linear, 3.0, 97.0, 6), [20.0, 40.0, 60.0, 80.0]);
    assert_eq!(
        major(Scale::Linear, 10.0, 10.02, 4),
        [10.0, 10.005, 10.01, 10.015, 10.02]
    );
    assert_eq!(major(Scale::Linear, -0.3, -0.1, 3), [-0.3, -0.2, -0.1]);
}

#[test]
fn linear_labels_have_the_decimals_of_the_step() {
    assert_eq!(labels(Scale::Linear, -1.1, 1.1, 5), "−1.0 −0.5 0.0 0.5 1.0");
    assert_eq!(
        labels(Scale::Linear, 10.0, 10.02, 4),
        "10.000 10.005 10.010 10.015 10.020"
    );
    assert_eq!(labels(Scale::Linear, 0.0, 250_000.0, 3), "0 100000 200000");
}

#[test]
fn large_and_small_values_share_a_power_of_ten() {
    let large = ticks(Scale::Linear, 0.0, 3.0e7, 4);
    assert_eq!(
        (large.labels.join(" "), large.exponent),
        ("0 10 20 30".to_owned(), 6)
    );
    let small = ticks(Scale::Linear, -3.0e-5, 3.0e-5, 4);
    assert_eq!(
        (small.labels.join(" "), small.exponent),
        ("−20 0 20".to_owned(), -6)
    );
    let huge = ticks(Scale::Linear, -1e300, 1e300, 4);
    assert_eq!(
        (huge.labels.join(" "), huge.exponent),
        ("−1.0 −0.5 0.0 0.5 1.0".to_owned(), 300)
    );
    let tiny = ticks(Scale::Linear, 0.0, 1e-298, 2);
    assert_eq!(
        (tiny.labels.join(" "), tiny.exponent),
        ("0 50 100".to_owned(), -300)
    );
}

#[test]
fn a_far_offset_keeps_its_digits() {
    assert_eq!(
        labels(Scale::Linear, 1000.0001, 1000.0003, 2),
        "1000.0001 1000.0002 1000.0003"
    );
}

#[test]
fn decibels_step_by_multiples_of_20() {
    assert_eq!(
        major(Scale::Decibel, -95.0, 25.0, 7),
        [-80.0, -60.0, -40.0, -20.0, 0.0, 20.0]
    );
    assert_eq!(major(Scale::Decibel, -95.0, 25.0, 4), [-80.0, -40.0, 0.0]);
    assert_eq!(
        major(Scale::Decibel, -200.0, 20.0, 4),
        [-180.0, -120.0, -60.0, 0.0]
    );
    assert_eq!(
        major(Scale::Decibel, -3.0, 3.0, 6),
        [-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0]
    );
    assert_eq!(
        major(Scale::Decibel, 0.0, 1000.0, 5),
        [0.0, 200.0, 400.0, 600.0, 800.0, 1000.0]
    );
}

#[test]
fn degrees_step_by_multiples_of_45_or_90() {
    assert_eq!(
        major(Scale::Degrees, -189.0, 9.0, 5),
        [-180.0, -135.0, -90.0, -45.0, 0.0]
    );
    assert_eq!(
        major(Scale::Degrees, -370.0, 10.0, 5),
        [-360.0, -270.0, -180.0, -90.0, 0.0]
    );
    assert_eq!(
        major(Scale::Degrees, -900.0, 0.0, 5),
        [-900.0, -720.0, -540.0, -360.0, -180.0, 0.0]
    );
    assert_eq!(
        major(Scale::Degrees, -40.0, 20.0, 5),
        [-30.0, -15.0, 0.0, 15.0]
    );
    assert_eq!(
        major(Scale::Degrees, -4.0, 6.0, 5),
        [-4.0, -2.0, 0.0, 2.0, 4.0, 6.0]
    );
}

#[test]
fn log_axes_have_decades_with_minor_ticks() {
    let bode = ticks(Scale::Log, 1.0, 1000.0, 5);
    assert_eq!(bode.major, [1.0, 10.0, 100.0, 1000.0]);
    assert_eq!(bode.labels.join(" "), "1 10 100 1000");
    assert_eq!(bode.minor.len(), 24); // 2..9 in three decades
    assert_eq!(bode.minor[..8], [2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0]);
}

#[test]
fn wide_log_axes_are_labelled_at_1_2_5() {
    let wide = ticks(Scale::Log, 5.0, 500.0, 8);
    assert_eq!(wide.major, [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0]);
    assert!(wide.minor.contains(&30.0) && !wide.minor.contains(&20.0));
}

#[test]
fn many_decades_are_thinned_and_written_as_powers() {
    let many = ticks(Scale::Log, 1e-9, 1e9, 7);
    assert_eq!(many.labels.join(" "), "10⁻⁹ 10⁻⁶ 10⁻³ 10⁰ 10³ 10⁶ 10⁹");
    assert_eq!(many.minor.len(), 12);
    assert_eq!(labels(Scale::Log, 1e5, 1e6, 4), "10⁵ 2·10⁵ 5·10⁵ 10⁶");
}

#[test]
fn a_log_axis_of_less_than_a_decade_is_divided_evenly() {
    assert_eq!(major(Scale::Log, 60.0, 95.0, 4), [60.0, 70.0, 80.0, 90.0]);
    assert_eq!(major(Scale::Log, 3.0, 40.0, 3), [5.0, 10.0, 20.0]);
}
