//! P1 and P4: a steel shaft between a motor and a load, with a torque step or in a sampled P-PI loop.

use crate::run::{Run, cpu_s, with_samples};
use diffsol::{
    DiffsolError, FaerSparseMat, KLU, MatrixCommon, OdeBuilder, OdeEquationsImplicit,
    OdeSolverMethod, OdeSolverProblem, OdeSolverStopReason, Vector,
};
use std::cell::Cell;
use std::rc::Rc;

type M = FaerSparseMat<f64>;
type V = <M as MatrixCommon>::V;
type C = <M as MatrixCommon>::C;
type Solver = KLU<M>;

const BRAKE: f64 = 0.5;

/// Inertias of the nodes, stiffnesses and dampings of the elements between them.
#[derive(Clone)]
pub struct Shaft {
    pub inertia: Vec<f64>,
    pub stiffness: Vec<f64>,
    pub damping: Vec<f64>,
}

impl Shaft {
    pub fn new(cells: usize) -> Self {
        let nodes = cells + 2;
        let (section, length) = (
            std::f64::consts::PI * 0.032f64.powi(4) / 32.0,
            1.0 / cells as f64,
        );
        let mut inertia = vec![7850.0 * section * length; nodes];
        inertia[0] = 5e-3;
        inertia[nodes - 1] = 5e-3;
        let mut stiffness = vec![80e9 * section / length; nodes - 1];
        stiffness[0] *= 2.0;
        stiffness[nodes - 2] *= 2.0;
        let damping = stiffness.iter().map(|k| 2e-5 * k).collect();
        Self {
            inertia,
            stiffness,
            damping,
        }
    }

    pub fn nodes(&self) -> usize {
        self.inertia.len()
    }

    /// The rates with a torque on the first node; with a torque of 0 it is the product with the Jacobian.
    fn rates(&self, y: &[f64], torque: f64, dy: &mut [f64]) {
        let m = self.nodes();
        let (angle, speed) = y.split_at(m);
        let (angle_rate, speed_rate) = dy.split_at_mut(m);
        angle_rate.copy_from_slice(speed);
        let mut before = -torque;
        for i in 0..m - 1 {
            let after = self.stiffness[i] * (angle[i + 1] - angle[i])
                + self.damping[i] * (speed[i + 1] - speed[i]);
            speed_rate[i] = (after - before) / self.inertia[i];
            before = after;
        }
        speed_rate[m - 1] = (-before - BRAKE * speed[m - 1]) / self.inertia[m - 1];
    }
}

pub fn sample(nodes: usize) -> impl Fn(f64, &V) -> [f64; 4] {
    move |t, y| {
        let at = |i| y.get_index(i);
        [t, at(nodes), at(2 * nodes - 1), at(0) - at(nodes - 1)]
    }
}

fn problem(
    cells: usize,
    rtol: f64,
    torque: Rc<Cell<f64>>,
) -> Result<OdeSolverProblem<impl OdeEquationsImplicit<M = M, V = V, T = f64, C = C>>, DiffsolError>
{
    let shaft = Shaft::new(cells);
    let (of_rates, n) = (shaft.clone(), 2 * shaft.nodes());
    OdeBuilder::<M>::new()
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(
            move |y, _p, _t, dy| of_rates.rates(y, torque.get(), dy),
            move |_y, _p, _t, v, jv| shaft.rates(v, 0.0, jv),
        )
        .init(|_p, _t, y| y.fill(0.0), n)
        .build()
}

pub fn step(cells: usize, rtol: f64) -> Result<Run, DiffsolError> {
    let problem = problem(cells, rtol, Rc::new(Cell::new(10.0)))?;
    with_samples(problem.bdf::<Solver>()?, sample(cells + 2))
}

pub fn sampled(cells: usize, rtol: f64, every_s: f64) -> Result<Run, DiffsolError> {
    let torque = Rc::new(Cell::new(3.0));
    let problem = problem(cells, rtol, Rc::clone(&torque))?;
    controlled(problem.bdf::<Solver>()?, cells, every_s, &torque)
}

fn controlled<'a, Eqn, S>(
    mut solver: S,
    cells: usize,
    every_s: f64,
    torque: &Cell<f64>,
) -> Result<Run, DiffsolError>
where
    Eqn: OdeEquationsImplicit<M = M, V = V, T = f64, C = C> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let shaft = Shaft::new(cells);
    let sample = sample(shaft.nodes());
    let ticks = (1.0 / every_s).round() as usize;
    let rows = (0.01 / every_s).round() as usize;
    let mut run = Run::default();
    let mut integral = 0.0;
    let begin = cpu_s();
    for k in 1..=ticks {
        let t = k as f64 * every_s;
        solver.set_stop_time(t)?;
        while solver.step()? != OdeSolverStopReason::TstopReached {}
        let state = solver.state();
        if k % rows == 0 {
            run.samples.push(sample(t, state.y));
        }
        let speed = state.y.get_index(shaft.nodes());
        let error = 10.0 * (1.0 - state.y.get_index(0)) - speed;
        integral += every_s * error;
        let next = (0.3 * error + 3.0 * integral).clamp(-30.0, 30.0);
        let jump = (next - torque.get()) / shaft.inertia[0];
        torque.set(next);
        let state = solver.state_mut();
        let rate = state.dy.get_index(shaft.nodes());
        state.dy.set_index(shaft.nodes(), rate + jump);
    }
    run.cpu_s = cpu_s() - begin;
    run.steps = solver.get_statistics().number_of_steps;
    Ok(run)
}
