//! Ten masses that stick and slip, against fixed steps of a program of its own.

use super::solved::{Solved, close, same, solve, solve_with};
use hyde_experiment::Options;

const N: usize = 10;
const STIFFNESS: f64 = 100.0;
const DAMPING: f64 = 1.0;
const PULL: f64 = 0.1;
const SLIDING: f64 = 0.5;
const BREAKAWAY: f64 = 1.5;
const STOP: f64 = 20.0;

/// Time in s, number of the mass, and the sign of its motion from then on.
type Switch = (f64, usize, f64);

/// Every mass sticks and slips, in the same order and at the same times as there.
pub(super) fn ten_masses() -> Result<(), String> {
    let expected = by_fixed_steps(5e-4);
    let moved = (0..N).filter(|i| expected.iter().any(|switch| switch.1 == *i));
    same("masses that moved", &moved.count(), &N)?;
    // Steps of a tenth of the length move these times by 3e-10 s; rtol 1e-9 is off by 2e-8 s.
    agree(&solve("events/chain", "creep")?, &expected, 1e-7)?;
    let options = Options {
        rtol: Some(1e-6),
        atol: Some(1e-8),
        ..Options::default()
    };
    // What a user gets who asks for no more: off by 3e-5 s.
    agree(
        &solve_with("events/chain", "creep", &options)?,
        &expected,
        1e-4,
    )
}

fn agree(chain: &Solved, expected: &[Switch], tolerance: f64) -> Result<(), String> {
    let events = chain.events();
    same("number of events", &events.len(), &expected.len())?;
    for (event, &(t, mass, sign)) in events.iter().zip(expected) {
        let floor = format!("floor[{}].", mass + 1);
        let cause = match sign {
            1.0 => format!("{floor}a.f - {floor}drag > {floor}Fs"),
            -1.0 => format!("{floor}a.f - {floor}drag < -{floor}Fs"),
            _ => format!("{floor}slip.s*body[{}].v < 0", mass + 1),
        };
        same("condition", &event.cause, &cause)?;
        close(&cause, event.t, t, tolerance)?;
    }
    Ok(())
}

/// Places, speeds, and the sign of motion: 0 for a mass that sticks.
#[derive(Clone)]
struct Chain {
    s: [f64; N],
    v: [f64; N],
    sign: [f64; N],
}

/// Runge–Kutta steps of one length; a step in which a mass starts or stops is shortened by bisection to that instant.
fn by_fixed_steps(step: f64) -> Vec<Switch> {
    let mut chain = Chain {
        s: [0.0; N],
        v: [0.0; N],
        sign: [0.0; N],
    };
    let (mut t, mut switches) = (0.0, Vec::new());
    while t < STOP {
        let mut high = step.min(STOP - t);
        if chain.after(t, high).switching(t + high).is_some() {
            let mut low = 0.0;
            // Down to rounding of the time.
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                match chain.after(t, middle).switching(t + middle) {
                    Some(_) => high = middle,
                    None => low = middle,
                }
            }
        }
        chain = chain.after(t, high);
        t += high;
        while let Some((mass, sign)) = chain.switching(t) {
            switches.push((t, mass, sign));
            (chain.v[mass], chain.sign[mass]) = (0.0, sign);
        }
    }
    switches
}

impl Chain {
    /// Forces of the springs at each mass.
    fn forces(&self, t: f64) -> [f64; N] {
        let mut force = [0.0; N];
        force[0] = STIFFNESS * (PULL * t - self.s[0]);
        for i in 1..N {
            let (stretch, rate) = (self.s[i] - self.s[i - 1], self.v[i] - self.v[i - 1]);
            let between = STIFFNESS * stretch + DAMPING * rate;
            force[i - 1] += between;
            force[i] -= between;
        }
        force
    }

    /// The first mass that must start or stop, and its sign from then on.
    fn switching(&self, t: f64) -> Option<(usize, f64)> {
        let force = self.forces(t);
        (0..N).find_map(|i| {
            let starts = self.sign[i] == 0.0 && force[i].abs() > BREAKAWAY;
            let stops = self.sign[i] * self.v[i] < 0.0;
            (starts || stops).then(|| (i, if starts { force[i].signum() } else { 0.0 }))
        })
    }

    /// One step of the classical Runge–Kutta method; the masses are 1 kg.
    fn after(&self, t: f64, h: f64) -> Self {
        let mut sum = (self.s, self.v);
        let mut slope = (self.v, [0.0; N]);
        for (stage, (at, weight)) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)]
            .into_iter()
            .enumerate()
        {
            let mut there = self.clone();
            if stage > 0 {
                for i in 0..N {
                    there.s[i] += at * h * slope.0[i];
                    there.v[i] += at * h * slope.1[i];
                }
            }
            let force = there.forces(t + at * h);
            for (i, &force) in force.iter().enumerate() {
                let sign = self.sign[i];
                let acceleration = if sign == 0.0 {
                    0.0
                } else {
                    force - sign * SLIDING
                };
                slope.0[i] = there.v[i];
                slope.1[i] = acceleration;
                sum.0[i] += h / 6.0 * weight * slope.0[i];
                sum.1[i] += h / 6.0 * weight * acceleration;
            }
        }
        Self {
            s: sum.0,
            v: sum.1,
            sign: self.sign,
        }
    }
}
