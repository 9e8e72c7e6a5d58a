//! A mass with dry friction, pulled by a spring whose end moves at a constant speed: stick fixes the velocity by a pin,
//! whose mode exchanges the rows of the velocity and the friction force.

use crate::by_hand::{Equations, Partial, RTOL, algebraic, column, origin, program, run, state};
use crate::differences::assert_partials;
use hyde_program::{
    Automaton, Function, Pin, Point, Program, Reaction, ReactionKind, Relation, RelationUse, Wrt,
};
use hyde_sim::{EventKind, Setup};

/// Mass in kg, stiffness in N/m, speed of the spring's end in m/s, friction at breakaway and in slip in N.
const M: f64 = 2.0;
const K: f64 = 50.0;
const SPEED: f64 = 0.1;
const BREAKAWAY: f64 = 6.0;
const SLIDING: f64 = 4.0;

const STICK: usize = 0;
const SLIP: usize = 1;
/// Places in the memory: two relations, then the mode.
const MODE: usize = 2;

struct StickSlip;

impl Equations for StickSlip {
    fn declared(&self) -> Vec<f64> {
        vec![]
    }

    fn start(&self, _p: &[f64], _y: &mut [f64], z: &mut [f64]) {
        z[MODE] = STICK as f64;
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        let (x, v, friction) = (at.y[0], at.y[1], at.y[2]);
        let motion = M * at.yp[1] - K * (SPEED * at.t - x) + friction;
        match function {
            Function::Residual if stuck(at) => vec![at.yp[0] - v, at.yp[1], motion],
            Function::Residual => vec![at.yp[0] - v, motion, friction - SLIDING],
            Function::Roots => vec![friction - BREAKAWAY, -v],
            // No assignments, one pin.
            Function::Assignments => vec![0.0],
            Function::Outputs => vec![v, friction, at.z[MODE]],
            Function::Initial | Function::Delayed | Function::Angles => vec![],
        }
    }

    fn partials(&self, function: Function, at: Point<'_>) -> Vec<Partial> {
        // The row of the motion is that of the velocity in slip, that of the friction in stick.
        let (stick, slip) = if stuck(at) { (1.0, 0.0) } else { (0.0, 1.0) };
        match function {
            Function::Residual => vec![
                (0, Wrt::Derivative(0), 1.0),
                (0, Wrt::Unknown(1), -1.0),
                (1, Wrt::Derivative(1), stick + slip * M),
                (1, Wrt::Unknown(0), slip * K),
                (1, Wrt::Unknown(2), slip),
                (2, Wrt::Derivative(1), stick * M),
                (2, Wrt::Unknown(0), stick * K),
                (2, Wrt::Unknown(2), 1.0),
            ],
            Function::Roots => vec![(0, Wrt::Unknown(2), 1.0), (1, Wrt::Unknown(1), -1.0)],
            Function::Outputs => vec![(0, Wrt::Unknown(1), 1.0), (1, Wrt::Unknown(2), 1.0)],
            Function::Assignments | Function::Initial | Function::Delayed | Function::Angles => {
                vec![]
            }
        }
    }

    fn conditions(&self, z: &[f64]) -> Vec<f64> {
        vec![z[0], z[1]]
    }
}

fn stuck(at: Point<'_>) -> bool {
    at.z[MODE] == STICK as f64
}

fn stick_slip() -> Program {
    let unknowns = vec![
        state("x", 0, "mass"),
        state("v", 1, "mass"),
        algebraic("friction", 2, "guide"),
    ];
    let exit = |from: usize, text: &str| Relation {
        inclusive: false,
        scheduled: false,
        arithmetic: true,
        used: RelationUse::Exit(0, from),
        text: text.to_owned(),
        origin: origin("guide"),
    };
    let transition = |from: usize, to: usize, text: &str| Reaction {
        kind: ReactionKind::Transition {
            automaton: 0,
            from,
            to,
            impact: false,
        },
        assignments: 0..0,
        text: text.to_owned(),
        origin: origin("guide"),
    };
    Program {
        relations: vec![exit(STICK, "friction > breakaway"), exit(SLIP, "v < 0")],
        automata: vec![Automaton {
            name: "guide".to_owned(),
            modes: vec!["stick".to_owned(), "slip".to_owned()],
            holds_speed: vec![true, false],
            initial: STICK,
            place: MODE,
            origin: origin("guide"),
        }],
        reactions: vec![
            transition(STICK, SLIP, "friction > breakaway"),
            transition(SLIP, STICK, "v < 0"),
        ],
        pins: vec![Pin {
            automaton: 0,
            mode: STICK,
            state: 1,
            origin: origin("guide"),
        }],
        ..program(StickSlip, unknowns, 3, &["v", "friction", "mode"])
    }
}

/// Times of the first slip and the first stick in s, and the period of the motion from then on.
///
/// In slip the spring's extension s obeys M s'' = SLIDING - K s with s = BREAKAWAY/K and s' = SPEED at its beginning: an
/// oscillation with w^2 = K/M round SLIDING/K, of which v = SPEED - s' = SPEED (1 - cos w t) + a w sin w t, with a the
/// extension above that. Half angles give its next zero, tan(w t/2) = -a w/SPEED; by symmetry the extension is then as
/// far below, and grows at SPEED until the next slip.
fn closed_form() -> (f64, f64, f64) {
    let w = (K / M).sqrt();
    let a = (BREAKAWAY - SLIDING) / K;
    let slip = BREAKAWAY / (K * SPEED);
    let duration = 2.0 * (std::f64::consts::PI - (a * w / SPEED).atan()) / w;
    (slip, slip + duration, duration + 2.0 * a / SPEED)
}

#[test]
fn slip_and_stick_begin_at_their_times() {
    let program = stick_slip();
    let (slip, stick, period) = closed_form();
    let results = run(&program, &[], vec![0.0, stick + 4.1 * period]).unwrap();
    // Four whole periods, then slip and stick of the fifth.
    assert_eq!(results.events.len(), 10);
    for (number, event) in results.events.iter().enumerate() {
        let begins_slip = number % 2 == 0;
        let (from, to) = if begins_slip {
            (STICK, SLIP)
        } else {
            (SLIP, STICK)
        };
        let kind = EventKind::Transition {
            automaton: 0,
            from,
            to,
        };
        assert_eq!(event.kind, kind);
        let first = if begins_slip { slip } else { stick };
        let expected = first + (number / 2) as f64 * period;
        // Till the first slip only the friction moves, in proportion to the time. Each slip adds what its steps are off by,
        // ten times rtol in the position; over the speed of the spring's end that is the error in time.
        let slips = number.div_ceil(2) as f64;
        let tolerance = 1e-14 + slips * 10.0 * RTOL / SPEED;
        assert!(
            (event.t - expected).abs() <= tolerance,
            "event {number} at {} s, not {expected} s",
            event.t
        );
    }
}

#[test]
fn a_mass_that_sticks_has_velocity_zero_to_the_last_bit() {
    let program = stick_slip();
    let (slip, _, period) = closed_form();
    let rows = Setup::rows_every(0.0, slip + 3.0 * period, 1e-3);
    let results = run(&program, &[], rows).unwrap();
    let of = |name| column(&program, &results, name);
    let (mut stuck, mut most) = (0, 0.0_f64);
    for ((v, friction), mode) in of("v").iter().zip(&of("friction")).zip(&of("mode")) {
        if *mode == STICK as f64 {
            assert_eq!(v.to_bits(), 0.0_f64.to_bits());
            stuck += 1;
            most = most.max(*friction);
        } else {
            assert_eq!(*friction, SLIDING);
        }
    }
    assert!(stuck > 1000, "{stuck} rows");
    // The left limit at a slip: the crossing is located to rounding of the time, and consistent there.
    assert!((most - BREAKAWAY).abs() <= 1e-12, "{most}");
}

#[test]
fn time_in_the_modes_adds_up() {
    let program = stick_slip();
    let (slip, stick, _) = closed_form();
    let results = run(&program, &[], vec![0.0, stick + 0.1]).unwrap();
    let spent = &results.mode_times[0];
    // As the events: one slip.
    let tolerance = 10.0 * RTOL / SPEED;
    assert!(
        (spent[STICK] - (slip + 0.1)).abs() <= tolerance,
        "{spent:?}"
    );
    assert!(
        (spent[SLIP] - (stick - slip)).abs() <= tolerance,
        "{spent:?}"
    );
}

#[test]
fn derivatives_are_those_of_differences_in_both_modes() {
    for mode in [STICK, SLIP] {
        let z = [0.0, 0.0, mode as f64];
        assert_partials(&stick_slip(), &[0.4, -1.3, 5.0], &[0.7, 2.0, 0.0], &z);
    }
}
