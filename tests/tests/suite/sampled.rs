//! A lag under a sampled controller against its difference equations: what a clock does is exact, not approximate.

use crate::models::{Solved, close, solve};

const LAG: f64 = 50e-3;
const PERIOD: f64 = 10e-3;
const KP: f64 = 2.0;
const KI: f64 = 30.0;
const R: f64 = 1.0;
const TICKS: usize = 31;

/// Samples and outputs of the controller, tick by tick, with what it puts out held `delay` later.
fn closed_form(delay: f64) -> (Vec<f64>, Vec<f64>) {
    // x' = (u - x)/T with u constant over `dt`.
    let over = |x: f64, u: f64, dt: f64| u + (x - u) * (-dt / LAG).exp();
    let (mut x, mut held, mut sum) = (0.0, 0.0, 0.0);
    let (mut samples, mut outputs) = (Vec::new(), Vec::new());
    for _ in 0..TICKS {
        sum += KI * (R - x) * PERIOD;
        let u = KP * (R - x) + sum;
        samples.push(x);
        outputs.push(u);
        x = over(x, held, delay);
        x = over(x, u, PERIOD - delay);
        held = u;
    }
    (samples, outputs)
}

fn check(loop_: &Solved, delay: f64) {
    let (samples, outputs) = closed_form(delay);
    let time = loop_.time();
    let (x, u) = (loop_.column("x"), loop_.column("control.pi.u"));
    let held = loop_.column("u");
    let mut last = 0.0;
    for (k, (sample, output)) in (0_u32..).zip(samples.iter().zip(&outputs)) {
        let tick = f64::from(k) * PERIOD;
        let (_, after) = loop_.rows_at(tick);
        // rtol 1e-10; the loop is stable and forgets.
        close(x[after], *sample, 1e-8);
        close(u[after], *output, 1e-7);
        // Between its changes the held value is the controller's, bit by bit.
        let from = tick + delay;
        for row in 0..time.len() {
            let inside = time[row] > from + 1e-9 && time[row] < from + PERIOD - 1e-9;
            if inside {
                assert_eq!(
                    held[row].to_bits(),
                    u[after].to_bits(),
                    "at {} s",
                    time[row]
                );
            }
        }
        // It changes at that instant and no sooner: the row before has the last value.
        if from < time[time.len() - 1] {
            let (left, right) = loop_.rows_at(from);
            let before: f64 = held[left];
            assert_eq!(before.to_bits(), f64::to_bits(last), "before {from} s");
            assert_eq!(held[right].to_bits(), u[after].to_bits(), "after {from} s");
        }
        last = u[after];
    }
    let ticks = loop_.run.results.statistics.ticks;
    assert_eq!(usize::try_from(ticks).unwrap(), TICKS);
    assert!(loop_.events().is_empty(), "a tick is no event");
}

#[test]
fn a_held_controller_obeys_its_difference_equation() {
    check(&solve("sampled", "direct"), 0.0);
}

#[test]
fn a_delay_comes_between_tick_and_hold() {
    check(&solve("sampled", "late"), 3e-3);
}
