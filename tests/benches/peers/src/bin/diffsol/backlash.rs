//! P3 and P5: two masses with a gap between them, the first moved by a drive; of one gap, or of many.

use crate::run::{Run, cpu_s, with_events};
use diffsol::{DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod, Vector};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;

type M = NalgebraMat<f64>;

const M1: f64 = 50.0;
const M2: f64 = 200.0;
const K: f64 = 1e8;
const D: f64 = 1e4;
const KP: f64 = 5e6;
const KD: f64 = 2e4;
const VISCOUS: f64 = 2000.0;
/// Distance beyond a root before it is found again: a contact begins and ends at one.
const PASSED: f64 = 1e-14;

/// `contact` is -1, 0 (none) or 1: the side that touches.
fn force(contact: f64, gap: f64, y: &[f64]) -> f64 {
    contact.abs() * (K * (y[0] - y[1] - contact * gap) + D * (y[2] - y[3]))
}

fn rates(contact: f64, gap: f64, t: f64, y: &[f64], dy: &mut [f64]) {
    let f = force(contact, gap, y);
    let drive = KP * (0.01 * (TAU * t).sin() - y[0]) + KD * (0.01 * TAU * (TAU * t).cos() - y[2]);
    dy[0] = y[2];
    dy[1] = y[3];
    dy[2] = (drive - f) / M1;
    dy[3] = (f - VISCOUS * y[3]) / M2;
}

fn jacobian_times(contact: f64, v: &[f64], jv: &mut [f64]) {
    let f = force(contact.abs(), 0.0, v);
    jv[0] = v[2];
    jv[1] = v[3];
    jv[2] = (-KP * v[0] - KD * v[2] - f) / M1;
    jv[3] = (f - VISCOUS * v[3]) / M2;
}

pub fn solve(rtol: f64, gap: f64) -> Result<Run, DiffsolError> {
    let mut run = solve_all(rtol, gap, gap, 1)?;
    run.samples.clear();
    Ok(run)
}

pub fn solve_all(rtol: f64, first: f64, last: f64, cases: usize) -> Result<Run, DiffsolError> {
    let contact = Rc::new(Cell::new(0.0f64));
    let gap = Rc::new(Cell::new(first));
    // The side at which the last contact has ended, while there is none.
    let left = Rc::new(Cell::new(0.0f64));
    let (of_rates, of_jacobian) = ((contact.clone(), gap.clone()), contact.clone());
    let of_roots = (contact.clone(), gap.clone(), left.clone());
    let problem = OdeBuilder::<M>::new()
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(
            move |y, _p, t, dy| rates(of_rates.0.get(), of_rates.1.get(), t, y, dy),
            move |_y, _p, _t, v, jv| jacobian_times(of_jacobian.get(), v, jv),
        )
        .init(|_p, _t, y| y.fill(0.0), 4)
        .root(
            move |y, _p, _t, g| {
                let (contact, gap, left) = (of_roots.0.get(), of_roots.1.get(), of_roots.2.get());
                let distance = y[0] - y[1];
                let passed =
                    |side: f64| PASSED * (f64::from(contact == side) - f64::from(left == side));
                g[0] = distance - gap + passed(1.0);
                g[1] = distance + gap - passed(-1.0);
            },
            2,
        )
        .build()?;
    let begin = cpu_s();
    let mut run = Run::default();
    for i in 0..cases {
        let part = i as f64 / (cases.max(2) - 1) as f64;
        gap.set(first + (last - first) * part);
        contact.set(0.0);
        left.set(0.0);
        let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
        let events = with_events(&mut solver, 10.0, |t, root, y, dy| {
            let side = [1.0, -1.0][root];
            let ends = contact.get() == side;
            contact.set(if ends { 0.0 } else { side });
            left.set(if ends { side } else { 0.0 });
            rates(contact.get(), gap.get(), t, y, dy);
        });
        let events = match events {
            Ok(events) => events,
            Err(error) if cases == 1 => return Err(error),
            // It gives up on a case: no end state, and the wrong number of events.
            Err(_) => {
                run.samples.push([gap.get(), f64::NAN, f64::NAN, f64::NAN]);
                continue;
            }
        };
        let y = solver.state().y;
        let (x1, x2) = (y.get_index(0), y.get_index(1));
        run.samples
            .push([gap.get(), x2, x1 - x2, events.len() as f64]);
        run.steps += solver.get_statistics().number_of_steps;
        run.events = events;
    }
    run.cpu_s = cpu_s() - begin;
    if cases > 1 {
        run.events.clear();
    }
    Ok(run)
}
