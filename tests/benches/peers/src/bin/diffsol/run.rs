//! What a run gives, and the two ways to take one: with samples at given times, and on to a stop time.

use diffsol::{
    DiffsolError, OdeEquationsImplicit, OdeSolverMethod, OdeSolverState, OdeSolverStopReason,
    Vector,
};
use rustix::time::{ClockId, clock_gettime};

/// What is compared, and what it cost.
#[derive(Default)]
pub struct Run {
    /// User and system time in s.
    pub cpu_s: f64,
    pub steps: usize,
    pub samples: Vec<[f64; 4]>,
    pub events: Vec<f64>,
}

impl Run {
    pub fn print(&self) {
        println!("cpu {:.9}\nsteps {}", self.cpu_s, self.steps);
        for [t, a, b, c] in &self.samples {
            println!("sample {t} {a} {b} {c}");
        }
        for t in &self.events {
            println!("event {t}");
        }
    }
}

/// Used by the process, in s.
pub fn cpu_s() -> f64 {
    let now = clock_gettime(ClockId::ProcessCPUTime);
    now.tv_sec as f64 + 1e-9 * now.tv_nsec as f64
}

/// A run until 1 s with a sample every 10 ms, interpolated in the step that passes it.
pub fn with_samples<'a, Eqn, S>(
    mut solver: S,
    sample: impl Fn(f64, &Eqn::V) -> [f64; 4],
) -> Result<Run, DiffsolError>
where
    Eqn: OdeEquationsImplicit<T = f64> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let mut samples = Vec::with_capacity(100);
    let begin = cpu_s();
    solver.set_stop_time(1.0)?;
    let mut y = solver.state().y.clone();
    loop {
        let reason = solver.step()?;
        let reached = solver.state().t;
        while samples.len() < 100 && 0.01 * (samples.len() + 1) as f64 <= reached {
            let t = 0.01 * (samples.len() + 1) as f64;
            solver.interpolate_inplace(t, &mut y)?;
            samples.push(sample(t, &y));
        }
        if reason == OdeSolverStopReason::TstopReached {
            break;
        }
    }
    Ok(Run {
        cpu_s: cpu_s() - begin,
        steps: solver.get_statistics().number_of_steps,
        samples,
        events: Vec::new(),
    })
}

/// A run until `stop_s`; `event` gets the time and the root, and changes states and rates.
pub fn with_events<'a, Eqn, S>(
    solver: &mut S,
    stop_s: f64,
    mut event: impl FnMut(f64, usize, &mut [f64], &mut [f64]),
) -> Result<Vec<f64>, DiffsolError>
where
    Eqn: OdeEquationsImplicit<T = f64> + 'a,
    S: OdeSolverMethod<'a, Eqn>,
{
    let mut events = Vec::new();
    solver.set_stop_time(stop_s)?;
    loop {
        match solver.step()? {
            OdeSolverStopReason::InternalTimestep => {}
            OdeSolverStopReason::TstopReached => return Ok(events),
            OdeSolverStopReason::RootFound(t, root) => {
                solver.state_mut_back(t)?;
                let mut state = solver.checkpoint(); // which has the Jacobian made anew
                let after = state.as_mut();
                let (mut y, mut dy) = (after.y.clone_as_vec(), after.dy.clone_as_vec());
                event(t, root, &mut y, &mut dy);
                for i in 0..y.len() {
                    after.y.set_index(i, y[i]);
                    after.dy.set_index(i, dy[i]);
                }
                solver.set_state(state);
                events.push(t);
            }
        }
    }
}
