//! What a measure makes of a signal over a run.

use crate::models::solve;

/// The value of a measure.
fn measured(experiment: &str, name: &str) -> f64 {
    let solved = solve("numbers_of_a_run", experiment);
    let found = solved
        .run
        .measures
        .iter()
        .find(|measure| measure.name == name);
    found.unwrap().value
}

fn close(name: &str, expected: f64, tolerance: f64) {
    let found = measured("step", name);
    assert!(
        (found - expected).abs() <= tolerance,
        "{name}: {found}, not {expected}"
    );
}

#[test]
fn a_lag_settles_as_its_exponential_does() {
    const T: f64 = 0.02;
    // x = 1 - exp(-t/T). Between rows it is read on a straight line, which errs by x'' h^2/8 = 1.6e-6 at most here, over
    // its slope of 1 a second there: 1.6 us.
    close("settled", T * 50.0_f64.ln(), 2e-6);
    // The first row behind T ln 2 = 13.86 ms.
    close("half", 0.014, 1e-12);
    close("early", 1.0 - (-0.0295 / T).exp(), 1e-7); // The last row before 30 ms; rtol 1e-8.
    // The trapezoidal rule errs by h^2/12 of the change of slope: (0.5 ms)^2/12*50/s = 1e-6 s.
    close("short", T * (1.0 - (-0.2 / T).exp()), 1.2e-6);
    close("over", 0.0, 1e-12); // It rises to the end.
    assert!(measured("step", "never").is_nan());
    let holds = |name| measured("step", name);
    assert!(holds("it settles") > 0.5);
    assert!(holds("it does not settle so closely") < 0.5);
}

#[test]
fn what_is_struck_tells_its_frequency_and_loses_its_energy() {
    // The spectrum of a free vibration is highest at the resonance, wr^2 = k/m - d^2/(2 m^2).
    let resonance = (8e4_f64 / 2.0 - 16.0_f64.powi(2) / 8.0).sqrt() / std::f64::consts::TAU;
    let rings = measured("ringing", "rings");
    // exp(-8) of it is cut off: 3e-4 of the width of the peak, d/m/(2 pi) = 1.3 Hz, and the lines are 0.1 Hz apart.
    assert!((rings - resonance).abs() < 2e-3, "{rings} {resonance}");
    // All of m v^2/2 = 10 mJ but exp(-2*4*2) of it; rows of 1 ms are 31 a period, where the trapezoidal rule is exact for a
    // sine, and errs by h^2/12 of the slope of d v^2 at the start, 2 d v v' = 1.3 W/s: 1e-7 J.
    let lost = measured("ringing", "lost");
    assert!((lost - 0.01).abs() < 4e-7, "{lost}");
}
