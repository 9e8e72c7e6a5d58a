//! Which residuals are affine, and that the one-step method solves them by one iteration: as exactly as the other method, with
//! coefficients that change at events and at ticks too.

use hyde_tests::Example;

/// A mass with these declarations and equations.
fn mass(more: &str, equations: &str) -> Example {
    let text = format!(
        "package mass;
import SI.*;
model Mass
  parameter Mass m = 2 [kg];
  parameter Stiffness k = 800 [N/m];
  parameter Damping d = 4 [N.s/m];
  Length x(start = 10 [mm], fixed = true);
  Velocity v(start = 0, fixed = true) = der(x);
  {more}
equation
  {equations}
end Mass;
experiment free of Mass
  measure Length stop = last(x);
  measure Length most = max(x);
  solve METHOD stop 2 [s] every 10 [ms];
end free;
"
    );
    let example = Example::load("examples/first/first.hyde", None).unwrap();
    example.replaced(&text, "free")
}

fn is_affine(more: &str, equations: &str) -> bool {
    let example = mass(more, equations).rewritten("METHOD", "auto");
    example.analyze().unwrap().affine_in().is_some()
}

#[test]
fn coefficients_read_truths_and_modes_alone_unless_a_held_value_is_a_factor() {
    let read = |more: &str, equations: &str| {
        let example = mass(more, equations).rewritten("METHOD", "auto");
        let dae = example.analyze().unwrap();
        (dae.affine_in(), dae.relations.len(), dae.n_memory)
    };
    let spring = "clocked c(50 [ms]) Stiffness k = 800 [N/m] + sample(x)*1 [N/m2]; Force f = -k*sample(x); end c;";
    let (affine, truths, all) = read(
        spring,
        "m*der(v) = hold(c.f) - (if x > 0 then d else 2*d)*v;",
    );
    assert!(truths < all);
    assert_eq!(affine, Some(truths));
    let (affine, _, all) = read(spring, "m*der(v) = -hold(c.k)*x;");
    assert_eq!(affine, Some(all));
    let (affine, ..) = read(spring, "m*der(v) = hold(c.f) - d*v*abs(v)/(1 [m/s]);");
    assert_eq!(affine, None);
}

#[test]
fn sums_of_unknowns_with_fixed_factors_are_affine() {
    for (more, equations) in [
        ("", "m*der(v) = -k*x - d*v;"),
        ("", "m*der(v) = -k*x - d*v + 3 [N]*sin(20 [rad/s]*time);"),
        ("", "m*der(v) = if x > 0 then -k*x else -2*k*x;"),
        ("Force f = -k*x; Force g = f - d*v;", "m*der(v) = 2*g/3;"),
        (
            "clocked gain(50 [ms]) Stiffness k = if sample(x) > 0 then 900 [N/m] else 700 [N/m]; end gain;",
            "m*der(v) = -hold(gain.k)*x;",
        ),
    ] {
        assert!(is_affine(more, equations), "{more} {equations}");
    }
}

#[test]
fn products_of_unknowns_and_factors_of_the_time_are_not_affine() {
    for (more, equations) in [
        ("", "m*der(v) = -k*x - d*v*abs(v)/(1 [m/s]);"),
        ("", "m*der(v) = -k*x - d*v*tanh(v/(1 [m/s]));"),
        ("", "m*der(v) = -k*x*(1 + 0.1*sin(20 [rad/s]*time));"),
        (
            "",
            "m*der(v) = if sin(20 [rad/s]*time) > 0 then -k*x else -d*v - k*x*x/(1 [mm]);",
        ),
        ("", "m*der(v) = noEvent(if x > 0 then -k*x else -2*k*x);"),
        ("Force f = -k*x;", "m*der(v) = f*f/(1 [N]);"),
        ("", "m*der(v) = -k*x/(1 + x/(1 [m]));"),
    ] {
        assert!(!is_affine(more, equations), "{more} {equations}");
    }
}

#[test]
fn one_iteration_is_as_exact_as_the_other_method() {
    for (more, equations) in [
        ("", "m*der(v) = -k*x - d*v + 3 [N]*sin(20 [rad/s]*time);"),
        ("", "m*der(v) = if x > 0 then -k*x else -2*k*x;"),
        (
            "clocked gain(50 [ms]) Stiffness k = if sample(x) > 0 then 900 [N/m] else 400 [N/m]; end gain;",
            "m*der(v) = -hold(gain.k)*x - d*v;",
        ),
    ] {
        let measures = |method: &str| {
            let example = mass(more, equations).rewritten("METHOD", method);
            let (_, run) = example.run().unwrap();
            let values = run.measures.iter().map(|measure| measure.value);
            values.collect::<Vec<_>>()
        };
        let (tight, own) = (
            measures("ida(rtol = 1e-10)"),
            measures("esdirk(rtol = 1e-8)"),
        );
        for (tight, own) in tight.iter().zip(&own) {
            assert!(
                (tight - own).abs() < 1e-8,
                "{tight} m, {own} m: {equations}"
            );
        }
    }
}
