//! Ranges of parameters: bounds below zero, and a unit behind the upper one alone.

use hyde_compiler::Backend;
use hyde_tests::Example;

#[test]
fn the_unit_behind_a_bound_below_zero_is_that_of_both() {
    let axis = "examples/first/first.hyde";
    let example = Example::load(axis, None).unwrap().replaced(
        r#"package cold;
import SI.*;

model Store
  parameter Temperature outside = -5 [degC] in -40 .. -3 [degC];
  parameter Length gap = -2 [mm] in -3 .. -1 [mm];
  Temperature T(start = -15 [degC], fixed = true);
equation
  (1 [s/m]*gap + 10 [s])*der(T) = outside - T;
end Store;

experiment night of Store
  solve ida(rtol = 1e-9) stop 1 [s];
end night;
"#,
        "night",
    );
    let compiled = example.compile(Backend::Interpreter).unwrap();
    let range = |name: &str| {
        let (parameter, _) = compiled.program.parameter(name).unwrap();
        parameter.range.unwrap()
    };
    let near = |(from, to): (f64, f64), bounds: [f64; 2]| {
        let off = (from - bounds[0]).abs().max((to - bounds[1]).abs());
        assert!(off < 1e-12, "{from} to {to}");
    };
    near(range("outside"), [233.15, 270.15]);
    near(range("gap"), [-3e-3, -1e-3]);
}
