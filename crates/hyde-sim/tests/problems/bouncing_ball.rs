//! A ball that falls and bounces: a relation, a `when` that sets the velocity, and events without end.

use crate::by_hand::{Equations, Partial, column, origin, program, run, state};
use crate::differences::assert_partials;
use hyde_program::{
    Assignment, Function, Point, Program, Reaction, ReactionKind, Relation, RelationUse, Target,
    Wrt,
};
use hyde_sim::{EventKind, FailureKind, Setup};

/// Places of the parameters: gravity, the part of the velocity that a bounce leaves, the height at the start.
const G: usize = 0;
const LEFT: usize = 1;
const HEIGHT: usize = 2;

struct Ball;

impl Equations for Ball {
    fn declared(&self) -> Vec<f64> {
        vec![9.81, 0.8, 1.0]
    }

    fn start(&self, p: &[f64], y: &mut [f64], _z: &mut [f64]) {
        y[0] = p[HEIGHT];
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        let (h, v) = (at.y[0], at.y[1]);
        match function {
            Function::Residual => vec![at.yp[0] - v, at.yp[1] + at.p[G]],
            Function::Roots => vec![-h],
            Function::Assignments => vec![-at.p[LEFT] * v],
            Function::Outputs => vec![h, v],
            Function::Initial | Function::Delayed | Function::Angles => vec![],
        }
    }

    fn partials(&self, function: Function, at: Point<'_>) -> Vec<Partial> {
        match function {
            Function::Residual => vec![
                (0, Wrt::Derivative(0), 1.0),
                (0, Wrt::Unknown(1), -1.0),
                (1, Wrt::Derivative(1), 1.0),
            ],
            Function::Roots => vec![(0, Wrt::Unknown(0), -1.0)],
            Function::Assignments => vec![(0, Wrt::Unknown(1), -at.p[LEFT])],
            Function::Outputs => vec![(0, Wrt::Unknown(0), 1.0), (1, Wrt::Unknown(1), 1.0)],
            Function::Initial | Function::Delayed | Function::Angles => vec![],
        }
    }

    fn conditions(&self, z: &[f64]) -> Vec<f64> {
        vec![z[0]]
    }
}

fn ball() -> Program {
    let unknowns = vec![state("h", 0, "flight"), state("v", 1, "weight")];
    let origin = origin("floor");
    Program {
        relations: vec![Relation {
            inclusive: false,
            scheduled: false,
            arithmetic: true,
            used: RelationUse::When,
            text: "h < 0".to_owned(),
            origin: origin.clone(),
        }],
        reactions: vec![Reaction {
            kind: ReactionKind::When { clause: 0 },
            assignments: 0..1,
            text: "h < 0".to_owned(),
            origin: origin.clone(),
        }],
        assignments: vec![Assignment {
            target: Target::State(1),
            counts: false,
            origin,
        }],
        ..program(Ball, unknowns, 1, &["h", "v"])
    }
}

/// The time of a bounce: the fall, then a flight of 2 v/g after each bounce.
fn bounce_s(number: i32, left: f64) -> f64 {
    let fall = (2.0_f64 / 9.81).sqrt();
    let flights: f64 = (1..=number).map(|k| 2.0 * fall * left.powi(k)).sum();
    fall + flights
}

#[test]
fn bounces_come_at_their_times() {
    let program = ball();
    let stop = 0.5 * (bounce_s(7, 0.8) + bounce_s(8, 0.8));
    let results = run(&program, &[], Setup::rows_every(0.0, stop, 0.01)).unwrap();
    assert_eq!(results.events.len(), 8);
    for (number, event) in (0..).zip(&results.events) {
        assert_eq!(event.kind, EventKind::When);
        assert_eq!(event.origin, origin("floor"));
        let expected = bounce_s(number, 0.8);
        // A flight is a parabola, which the solver has exactly but for its first steps: rtol times a few of them.
        assert!(
            (event.t - expected).abs() <= 1e-7,
            "{} not {expected}",
            event.t
        );
    }
}

#[test]
fn a_bounce_has_a_row_on_either_side_with_the_velocity_turned() {
    let program = ball();
    let results = run(&program, &[], vec![0.0, 0.7]).unwrap();
    let (left, right) = results.rows_at(results.events[0].t).unwrap();
    let (h, v) = (
        column(&program, &results, "h"),
        column(&program, &results, "v"),
    );
    assert_eq!(right, left + 1);
    assert_eq!(h[left], h[right]);
    // One product: the same numbers.
    assert_eq!(v[right], -0.8 * v[left]);
    // The crossing is located to rounding of the time, here of 0.45 s at 4.4 m/s.
    assert!(h[left].abs() <= 1e-14, "{}", h[left]);
}

#[test]
fn bounces_without_end_are_a_failure_that_names_the_floor() {
    let program = ball();
    let failure = run(&program, &[(LEFT, 0.5)], vec![0.0, 3.0]).unwrap_err();
    // The sum of the geometric series.
    let limit = (2.0_f64 / 9.81).sqrt() * 3.0;
    let FailureKind::Zeno { cause, sum_s } = &failure.kind else {
        panic!("{:?}", failure.kind);
    };
    assert_eq!(cause, "h < 0");
    // A geometric series; a dozen flights are integrated with rtol 1e-6.
    assert!((sum_s - limit).abs() < 1e-5, "{sum_s}");
    assert_eq!(failure.origins[0], origin("floor"));
    // A run of a dozen ever shorter flights is called endless once the last is 1e-4 of the first: 2^-13.
    assert!(
        failure.t < limit && failure.t > limit - 1e-3,
        "{}",
        failure.t
    );
}

#[test]
fn derivatives_are_those_of_differences() {
    assert_partials(&ball(), &[0.4, -1.3], &[0.7, 2.0], &[0.0]);
}
