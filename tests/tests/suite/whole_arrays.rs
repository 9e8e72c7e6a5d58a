//! Constraints between whole arrays: differentiated as a whole, with closed forms, and without growth.

use crate::models::{close, model, solve};
use hyde_compiler::Stage;

#[test]
fn masses_at_levers_swing_as_one_each() {
    // (m + 4 M)*x'' = -k*x: 9 kg at 900 N/m, 10 rad/s.
    let masses = solve("tied", "masses");
    let last = masses.time().len() - 1;
    for element in [1, 10] {
        // rtol 1e-9 over ten radians.
        close(
            masses.column(&format!("x[{element}]"))[last],
            0.1 * 10.0_f64.cos(),
            1e-7,
        );
        close(
            masses.column(&format!("y[{element}]"))[last],
            0.2 * 10.0_f64.cos() + 0.5,
            1e-7,
        );
        close(
            masses.column(&format!("u[{element}]"))[last],
            -2.0 * 10.0_f64.sin(),
            1e-6,
        );
        // M*y'' of the second mass.
        close(
            masses.column(&format!("F[{element}]"))[last],
            -40.0 * 10.0_f64.cos(),
            1e-5,
        );
    }
}

#[test]
fn a_start_may_be_given_to_either_array() {
    let given = solve("tied", "given");
    let last = given.time().len() - 1;
    close(given.column("x[3]")[0], 0.1, 1e-12);
    close(given.column("x[3]")[last], 0.1 * 10.0_f64.cos(), 1e-7);
}

#[test]
fn two_bars_joined_over_their_length_are_one_of_both_stiffnesses_and_masses() {
    let bars = solve("tied", "bars");
    // The first free mode: c*pi/len with c^2 = (EA + 2 EA)/(r + 3 r). Its error over 20 cells is below
    // (pi/20)^4/240 = 2.5e-6 of the angle, 19 rad.
    let omega = (3e6_f64 / 8.0).sqrt() * std::f64::consts::PI;
    let last = bars.time().len() - 1;
    let t = bars.time()[last];
    for (place, shape) in [(0, 1.0), (20, -1.0)] {
        close(
            bars.column(&format!("v[{place}]"))[last],
            shape * (omega * t).cos(),
            1e-4,
        );
        close(
            bars.column(&format!("w[{place}]"))[last],
            shape * (omega * t).cos(),
            1e-4,
        );
    }
}

#[test]
fn no_array_is_unrolled_whatever_its_length() {
    for name in ["Masses", "Given", "Bars"] {
        let lines = |n: f64| {
            let text = model("tied", None)
                .model(name)
                .set("n", n)
                .emit(Stage::Dae)
                .unwrap();
            // Up to 32 elements an array is among the outputs.
            let end = text.find("\noutputs").unwrap();
            let derivatives = text.find("derivatives of outputs").unwrap_or(end);
            let starts = text.find("\nstarts").unwrap();
            text[..derivatives].lines().count() + text[starts..end].lines().count()
        };
        assert_eq!(lines(40.0), lines(10_000.0), "{name}");
    }
}
