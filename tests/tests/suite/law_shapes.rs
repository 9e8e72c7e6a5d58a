//! The shapes that laws are made of: each function of the package `Laws` has the values of its closed form, the text that a
//! law gets, and the values that a search begins with; what is declared wrongly is told.

use hyde_ir::{ExprId, LawAxis, LawInput, LawPiece, LawRole, LawShape, LawText};
use hyde_tests::Example;
use std::collections::BTreeSet;

/// A slide, as good as any model: shapes see nothing of it.
const SLED: &str = "
package sled;
import SI.*;
import Translational.*;
model Sled
  Mass body(M = 40 [kg]);
  Guide guide(F = 20 [N]);
equation
  connect(body.a, guide.a);
end Sled;
";

fn shapes(more: &str) -> Result<Vec<LawShape>, String> {
    let example = Example::load("tests/models/small_axis.hyde", Some("small"))?;
    let experiment = "experiment rest of Sled stop 1 [s]; end rest;";
    let example = example.replaced(&format!("{SLED}{more}{experiment}"), "rest");
    Ok(example.parse()?.laws(&example)?.shapes)
}

/// The text of an expression with the names that the function has for its inputs.
fn text(shape: &LawShape, of: &LawText) -> String {
    let name = |number: usize| match shape.inputs[number] {
        LawInput::Variable(axis) => axis_of(axis).to_owned(),
        LawInput::Round(axis) => format!("{}1", axis_of(axis)),
        LawInput::Constant(number) => shape.constants[number].name.clone(),
        LawInput::State(number) => shape.states[number].name.clone(),
        other @ (LawInput::Least(_) | LawInput::Greatest(_)) => panic!("{other:?}"),
    };
    let pieces = of.pieces.iter().map(|piece| match piece {
        LawPiece::Letters(letters) => letters.clone(),
        LawPiece::Input(number) => name(*number),
    });
    pieces.collect()
}

fn axis_of(axis: LawAxis) -> &'static str {
    match axis {
        LawAxis::Speed => "v",
        LawAxis::Place => "x",
        LawAxis::Acceleration => "a",
        LawAxis::Signal => "u",
        LawAxis::Time => "t",
    }
}

/// Where shapes are evaluated: v, x, t, a, with what records show of them, and the constants.
#[derive(Clone, Copy)]
struct Point {
    v: f64,
    x: f64,
    t: f64,
    a: f64,
    constants: [f64; 2],
}

/// Round values of v, x, t, a, and the greatest ones; x and t begin at 0.1.
const ROUND: [f64; 4] = [0.2, 0.05, 2.0, 5.0];
const GREATEST: [f64; 4] = [0.24, 0.07, 3.1, 6.2];
const LEAST: f64 = 0.1;

fn value(shape: &LawShape, of: &LawText, at: Point) -> f64 {
    let values = |axis: LawAxis, all: [f64; 4]| match axis {
        LawAxis::Speed => all[0],
        LawAxis::Place => all[1],
        LawAxis::Time => all[2],
        // A signal is in the place of an acceleration: no shape has both.
        LawAxis::Acceleration | LawAxis::Signal => all[3],
    };
    let leaf = |leaf| match shape.input(leaf) {
        Some(LawInput::Variable(axis)) => Ok(values(axis, [at.v, at.x, at.t, at.a])),
        Some(LawInput::Round(axis)) => Ok(values(axis, ROUND)),
        Some(LawInput::Least(_)) => Ok(LEAST),
        Some(LawInput::Greatest(axis)) => Ok(values(axis, GREATEST)),
        Some(LawInput::Constant(number)) => Ok(at.constants[number]),
        // What is filtered stands for itself where it does not change.
        Some(LawInput::State(_)) => Ok(0.7),
        None => Err(()),
    };
    shape.exprs.evaluate(of.value, leaf).unwrap()
}

/// Of each shape its text and its closed form, of v, x, t, two constants and a.
type Form = fn(f64, f64, f64, f64, f64, f64) -> f64;
const FORMS: [(&str, &str, Form); 40] = [
    ("speed", "v/v1", |v, _, _, _, _, _| v / 0.2),
    ("magnitude", "noEvent(abs(v))/v1", |v, _, _, _, _, _| {
        v.abs() / 0.2
    }),
    (
        "signed_square",
        "v*noEvent(abs(v))/v1^2",
        |v, _, _, _, _, _| v * v.abs() / 0.04,
    ),
    ("square", "(v/v1)^2", |v, _, _, _, _, _| v * v / 0.04),
    ("cube", "(v/v1)^3", |v, _, _, _, _, _| v * v * v / 0.008),
    (
        "switching",
        "v/(noEvent(abs(v)) + vs)",
        |v, _, _, a, _, _| v / (v.abs() + a),
    ),
    ("turning", "tanh(v/vs)", |v, _, _, a, _, _| (v / a).tanh()),
    (
        "forwards",
        "(1 + v/(noEvent(abs(v)) + vs))/2",
        |v, _, _, a, _, _| 0.5 + 0.5 * v / (v.abs() + a),
    ),
    (
        "backwards",
        "(1 - v/(noEvent(abs(v)) + vs))/2",
        |v, _, _, a, _, _| 0.5 - 0.5 * v / (v.abs() + a),
    ),
    ("lagged", "late/v1", |_, _, _, _, _, _| 0.7 / 0.2),
    ("falling", "exp(-noEvent(abs(v))/vs)", |v, _, _, a, _, _| {
        (-v.abs() / a).exp()
    }),
    ("bell", "exp(-(v/vs)^2)", |v, _, _, a, _, _| {
        (-(v / a).powi(2)).exp()
    }),
    (
        "power",
        "noEvent(abs(v))/v1*(noEvent(abs(v))/v1 + 1e-6)^(p - 1)",
        |v, _, _, a, _, _| v.abs() / 0.2 * (v.abs() / 0.2 + 1e-6).powf(a - 1.0),
    ),
    (
        "peak_at_speed",
        "exp(-((noEvent(abs(v)) - v0)/dv)^2)",
        |v, _, _, a, b, _| (-((v.abs() - a) / b).powi(2)).exp(),
    ),
    ("place", "x/x1", |_, x, _, _, _, _| x / 0.05),
    ("place_from", "x/x1", |_, x, _, _, _, _| x / 0.05),
    ("place_from", "1", |_, _, _, _, _, _| 1.0),
    ("square_of_place", "(x/x1)^2", |_, x, _, _, _, _| {
        x * x / 0.0025
    }),
    (
        "magnitude_of_place",
        "noEvent(abs(x))/x1",
        |_, x, _, _, _, _| x.abs() / 0.05,
    ),
    ("hardening", "x*noEvent(abs(x))/x1^2", |_, x, _, _, _, _| {
        x * x.abs() / 0.0025
    }),
    ("cube_of_place", "(x/x1)^3", |_, x, _, _, _, _| {
        x * x * x / 1.25e-4
    }),
    (
        "yielding",
        "x/(noEvent(abs(x)) + x0)",
        |_, x, _, a, _, _| x / (x.abs() + a),
    ),
    ("peak", "exp(-((x - x0)/width)^2)", |_, x, _, a, b, _| {
        (-((x - a) / b).powi(2)).exp()
    }),
    (
        "step",
        "(1 + tanh((x - x0)/width))/2",
        |_, x, _, a, b, _| 0.5 + 0.5 * ((x - a) / b).tanh(),
    ),
    ("wave", "sin(2*pi*x/period)", |_, x, _, a, _, _| {
        (std::f64::consts::TAU * x / a).sin()
    }),
    ("wave", "cos(2*pi*x/period)", |_, x, _, a, _, _| {
        (std::f64::consts::TAU * x / a).cos()
    }),
    ("order", "sin(N*x)", |_, x, _, a, _, _| (a * x).sin()),
    ("order", "cos(N*x)", |_, x, _, a, _, _| (a * x).cos()),
    ("acceleration", "a/a1", |_, _, _, _, _, a| a / 5.0),
    (
        "magnitude_of_acceleration",
        "noEvent(abs(a))/a1",
        |_, _, _, _, _, a| a.abs() / 5.0,
    ),
    ("pushing", "tanh(a/a0)", |_, _, _, a0, _, a| (a / a0).tanh()),
    ("signal", "u/u1", |_, _, _, _, _, u| u / 5.0),
    (
        "magnitude_of_signal",
        "noEvent(abs(u))/u1",
        |_, _, _, _, _, u| u.abs() / 5.0,
    ),
    ("following", "followed", |_, _, _, _, _, _| 0.7),
    ("losing", "lost", |_, _, _, _, _, _| 0.7),
    ("warmed", "warmth", |_, _, _, _, _, _| 0.7),
    ("heated", "x/x1*heat", |_, x, _, _, _, _| x / 0.05 * 0.7),
    ("elapsed", "t/t1", |_, _, t, _, _, _| t / 2.0),
    ("fading", "exp(-t/tau)", |_, _, t, a, _, _| (-t / a).exp()),
    ("coming", "1 - exp(-t/tau)", |_, _, t, a, _, _| {
        1.0 - (-t / a).exp()
    }),
];

#[test]
fn every_shape_of_the_library_has_its_closed_form_and_its_text() {
    let shapes = shapes("").unwrap();
    let mut seen = BTreeSet::new();
    for shape in &shapes {
        for (_, output) in &shape.outputs {
            let (name, text) = (shape.name.trim_start_matches("Laws."), text(shape, output));
            if name == "worked" {
                assert_eq!(text, "worked/v1");
                continue;
            }
            let form = FORMS.iter().find(|form| form.0 == name && form.1 == text);
            let form = form.unwrap_or_else(|| panic!("{name}: {text}"));
            seen.insert((form.0, form.1));
            assert_eq!(output.is_sum, name == "coming", "{text}");
            let points = [[0.13, 0.04, 0.3, 4.1], [-0.07, -0.02, 1.9, -0.04], [0.0; 4]];
            for [v, x, t, a] in points {
                let constants = [0.03, 0.011];
                let at = Point {
                    v,
                    x,
                    t,
                    a,
                    constants,
                };
                let own = value(shape, output, at);
                let closed = (form.2)(v, x, t, constants[0], constants[1], a);
                assert!(
                    (own - closed).abs() <= 1e-14 * closed.abs().max(1.0),
                    "{name}: {own} {closed}"
                );
            }
        }
    }
    assert_eq!(seen.len(), FORMS.len());
}

#[test]
fn filters_are_read_with_their_time_constant_and_their_input() {
    let shapes = shapes("").unwrap();
    let filters = shapes.iter().flat_map(|shape| {
        let states = shape.states.iter();
        states.map(|state| {
            let [tau, input] = [&state.time_constant, &state.input].map(|own| text(shape, own));
            format!("{tau}*der({0}) = {input} - {0}", state.name)
        })
    });
    let filters: Vec<String> = filters.collect();
    assert_eq!(
        filters,
        [
            "tau*der(late) = v - late",
            "tau*der(followed) = u/u1 - followed",
            "tau*der(lost) = u/u1*v/v1 - lost",
            "tau*der(worked) = noEvent(abs(v)) - worked",
            "tau*der(warmth) = (v/v1)^2 - warmth",
            "tau*der(heat) = (x/x1)^2 - heat"
        ]
    );
}

/// The first values, the ranges and the limits of constants, where v goes to 0.24, x from 0.1 to 0.07 and t from 0.1 to 3.1.
#[test]
fn constants_begin_and_end_where_the_records_say() {
    let shapes = shapes("").unwrap();
    let of = |name: &str| {
        shapes
            .iter()
            .find(|shape| shape.name == format!("Laws.{name}"))
            .unwrap()
    };
    let number = |shape: &LawShape, value| {
        let text = LawText {
            value,
            pieces: Vec::new(),
            is_sum: false,
        };
        let at = Point {
            v: f64::NAN,
            x: f64::NAN,
            t: f64::NAN,
            a: f64::NAN,
            constants: [0.02, 0.3],
        };
        self::value(shape, &text, at)
    };
    let switching = of("switching");
    assert_eq!(switching.roles, [LawRole::Speed, LawRole::Rate]);
    assert_eq!((switching.cost, switching.few), (1, Some(3)));
    let own = &switching.constants[0];
    let first: Vec<f64> = own.values.iter().map(|&id| number(switching, id)).collect();
    for (value, part) in first.iter().zip([1.0, 0.5, 0.0, 0.75, 0.25]) {
        assert!(
            (value / (0.24 * 0.005_f64.powf(part)) - 1.0).abs() < 1e-12,
            "{value}"
        );
    }
    assert_eq!(first.len(), 5);
    let near = |shape: &LawShape, found: [ExprId; 2], expected: [f64; 2]| {
        let found = found.map(|id| number(shape, id));
        let apart = found.iter().zip(expected).map(|(a, b)| (a - b).abs());
        assert!(apart.fold(0.0, f64::max) < 1e-15, "{found:?}");
    };
    near(switching, own.range, [0.0, 0.48]);
    near(switching, own.limits, [0.2 * 0.02, 5.0 * 0.02]);
    let counts: Vec<usize> = ["peak", "step", "wave", "order", "fading", "falling"]
        .map(|name| of(name).count())
        .to_vec();
    assert_eq!(counts, [36, 7, 240, 240, 3, 8]);
    let peak = of("peak");
    near(peak, peak.constants[0].limits, [0.1, 0.07]);
    assert_eq!(peak.mark, ("position".to_owned(), Some(0)));
}

#[test]
fn a_shape_that_is_declared_wrongly_is_told() {
    let told =
        |inside: &str| shapes(&format!("function odd \"odd\"\n{inside}\nend odd;\n")).unwrap_err();
    let no_range =
        "input Velocity v, vs = 1 [mm/s]; output Real f = v/vs over (speed); signature velocity;";
    assert!(
        told(no_range).contains("the constant `vs` of a shape has no range"),
        "{}",
        told(no_range)
    );
    let no_role = "input Velocity v, v1; output Real f = v/v1; signature velocity;";
    assert!(told(no_role).contains("has no role"), "{}", told(no_role));
    let role = "input Velocity v, v1; output Real f = v/v1 over (sped); signature velocity;";
    assert!(
        told(role).contains("not a role of a shape"),
        "{}",
        told(role)
    );
    let unit = "input Velocity v; output Real f = exp(v) over (speed); signature velocity;";
    assert!(told(unit).contains("pure number"), "{}", told(unit));
    let shown =
        "input Velocity v, v_max; output Real f = v/v_max over (speed); signature velocity;";
    assert!(
        told(shown).contains("depends on what records show"),
        "{}",
        told(shown)
    );
    let filter = "input Velocity v, v1; Velocity late; output Real f = late/v1 over (speed); signature velocity;";
    assert!(told(filter).contains("has no value"), "{}", told(filter));
    let mark = "input Velocity v, v1; output Real f = v/v1 over (speed); signature speeds;";
    assert!(
        told(mark).contains("`speeds` is not a signature"),
        "{}",
        told(mark)
    );
}
