//! An integrator under a sampled proportional controller, whose held output changes a delay after the tick.

use crate::by_hand::{Equations, Partial, column, origin, program, run, state};
use crate::differences::assert_partials;
use hyde_program::{Clock, Constant, Function, Hold, Point, Program, TickWrt, Workspace, Wrt};
use hyde_sim::Results;

/// Places of the parameters: the gain, the set point, the start, the clock's period and its delay.
const GAIN: usize = 0;
const TARGET: usize = 1;
const START: usize = 2;
const PERIOD: usize = 3;
const DELAY: usize = 4;

/// Places in the memory: what the controller computes, and what is held of it.
const COMPUTED: usize = 0;
const HELD: usize = 1;

/// Ticks of a run.
const TICKS: i32 = 40;

struct Loop;

impl Equations for Loop {
    fn declared(&self) -> Vec<f64> {
        vec![2.0, 1.0, 0.0, 0.1, 0.02]
    }

    fn start(&self, p: &[f64], y: &mut [f64], _z: &mut [f64]) {
        y[0] = p[START];
    }

    fn constant(&self, which: Constant, p: &[f64]) -> Option<f64> {
        if which == Constant::Period(0) {
            Some(p[PERIOD])
        } else if which == Constant::Delay(0) {
            Some(p[DELAY])
        } else if which == Constant::Phase(0) {
            Some(0.0)
        } else {
            None
        }
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        match function {
            Function::Residual => vec![at.yp[0] - at.z[HELD]],
            Function::Outputs => vec![at.y[0], at.z[COMPUTED], at.z[HELD]],
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }

    fn partials(&self, function: Function, _at: Point<'_>) -> Vec<Partial> {
        match function {
            Function::Residual => vec![(0, Wrt::Derivative(0), 1.0)],
            Function::Outputs => vec![(0, Wrt::Unknown(0), 1.0)],
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }

    fn tick(&self, _clock: usize, at: Point<'_>, after: &mut [f64]) {
        after[COMPUTED] = at.p[GAIN] * (at.p[TARGET] - at.y[0]);
    }

    fn tick_partials(&self, _clock: usize, at: Point<'_>) -> Vec<(usize, TickWrt, f64)> {
        vec![(COMPUTED, TickWrt::Unknown(0), -at.p[GAIN])]
    }
}

fn control_loop() -> Program {
    Program {
        clocks: vec![Clock {
            name: "controller".to_owned(),
            origin: origin("controller"),
        }],
        clock_order: vec![0],
        holds: vec![Hold {
            clock: 0,
            source: COMPUTED,
            target: HELD,
            len: 1,
            read: true,
        }],
        ..program(
            Loop,
            vec![state("x", 0, "plant")],
            2,
            &["x", "computed", "held"],
        )
    }
}

fn run_ticks(program: &Program, set: &[(usize, f64)]) -> Results {
    // Half a period beyond the last tick, which is number TICKS - 1.
    run(program, set, vec![0.0, 0.1 * f64::from(TICKS) - 0.05]).unwrap()
}

/// The error at a tick, x - TARGET over that at the start. Over a period x gains (period - delay) times the new held
/// value and delay times the one before, so that z^2 - (1 - gain (period - delay)) z + gain delay = 0, and there is
/// nothing held before the first tick: the error before it counts as zero.
fn error_at(tick: i32, gain: f64, period: f64, delay: f64) -> f64 {
    let sum = 1.0 - gain * (period - delay);
    let root = (sum * sum - 4.0 * gain * delay).sqrt();
    let (a, b) = (0.5 * (sum + root), 0.5 * (sum - root));
    (a.powi(tick + 1) - b.powi(tick + 1)) / (a - b)
}

#[test]
fn states_and_held_values_are_those_of_the_difference_equation() {
    for delay in [0.0, 0.02] {
        let program = control_loop();
        let set = [(DELAY, delay)];
        // Rows at the ticks and where the held value changes.
        let mut rows: Vec<f64> = (0..TICKS).map(|k| f64::from(k) * 0.1).collect();
        if delay > 0.0 {
            rows.extend((0..TICKS).map(|k| f64::from(k) * 0.1 + delay));
        }
        rows.sort_by(f64::total_cmp);
        let results = run(&program, &set, rows).unwrap();
        let of = |name| column(&program, &results, name);
        for tick in 0..TICKS {
            let t = f64::from(tick) * 0.1;
            let (_, row) = results.rows_at(t).unwrap();
            let (before, after) = results.rows_at(t + delay).unwrap();
            let x = 1.0 - error_at(tick, 2.0, 0.1, delay);
            let held = 2.0 * (1.0 - x);
            // Between changes x is a straight line, which the solver has to rounding; 40 periods of it.
            assert!(
                (of("x")[row] - x).abs() <= 1e-12,
                "tick {tick}: {}",
                of("x")[row]
            );
            assert!((of("held")[after] - held).abs() <= 1e-11, "tick {tick}");
            // It is the number that was computed, to the last bit, and not before its time.
            assert_eq!(of("held")[after], of("computed")[row]);
            assert!(of("held")[before] != of("held")[after], "tick {tick}");
        }
    }
}

#[test]
fn a_tick_that_changes_nothing_does_not_start_the_solver_anew() {
    let program = control_loop();
    let moving = run_ticks(&program, &[]).statistics;
    assert_eq!(moving.ticks, TICKS as u64);
    let at_rest = run_ticks(&program, &[(START, 1.0)]).statistics;
    assert_eq!(at_rest.ticks, TICKS as u64);
    // Every held value differs from the one before.
    assert_eq!(moving.restarts - at_rest.restarts, TICKS as u64);
    // That of the start.
    assert!(at_rest.restarts <= 1, "{} restarts", at_rest.restarts);
}

#[test]
fn a_held_value_that_no_equation_reads_does_not_either() {
    let mut program = control_loop();
    program.holds[0].read = false;
    let unread = run_ticks(&program, &[]).statistics;
    assert_eq!(unread.ticks, TICKS as u64);
    assert!(unread.restarts <= 1, "{} restarts", unread.restarts);
}

#[test]
fn derivatives_are_those_of_differences() {
    let program = control_loop();
    assert_partials(&program, &[0.4], &[0.7], &[0.2, 0.5]);
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&[], &mut p);
    let tick = |y: &[f64]| {
        let mut after = vec![0.2, 0.5];
        let at = at(y, &p);
        program
            .kernels
            .tick(0, at, &mut Workspace::default(), &mut after);
        after
    };
    let (up, down) = (tick(&[0.5]), tick(&[0.3]));
    let partials = program
        .kernels
        .tick_partials(0, at(&[0.4], &p), &mut Workspace::default());
    for place in [COMPUTED, HELD] {
        let of_place = partials.iter().filter(|(position, ..)| *position == place);
        let written: f64 = of_place.map(|(.., value)| value).sum();
        // Linear: rounding over the step of 0.2.
        assert!((written - (up[place] - down[place]) / 0.2).abs() <= 1e-14);
    }
}

fn at<'a>(y: &'a [f64], p: &'a [f64]) -> Point<'a> {
    Point {
        t: 0.0,
        y,
        yp: &[0.0],
        z: &[0.2, 0.5],
        u: &[],
        p,
    }
}
