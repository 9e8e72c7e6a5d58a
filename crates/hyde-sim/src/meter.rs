//! [`Meter`]: adds up, step by step, what the energy ledger asks for.
//!
//! Over a stretch of the solution the work at a port is `∫ flow d(potential)`, the energy of a power `∫ power dt`. Both
//! are taken by the [rule of Lobatto](crate::lobatto) on the solver's own interpolant; the slope of the potential is that
//! of the polynomial through its five values. A stretch ends where the solution has a corner: at steps and events. A power
//! may have one where no equation has, as the heat of what is pressed in beyond a gap; a stretch whose powers and flows bend
//! more than five values show is halved. At an event an energy may jump; jumps are summed apart.

use crate::consistent::Consistent;
use crate::integrator::Integrator;
use crate::lobatto::{self, MIDDLE, NODES, POINTS, WEIGHTS};
use crate::results::Energies;
use hyde_program::{AccountKind, Function, Ledger, PortKind};

/// Of its largest value, what a power or a flow may have beyond a cubic: five points are exact to the square of it.
const BENT: f64 = 1e-4;
/// Halvings of a stretch at most.
const MAX_HALVINGS: u32 = 10;
/// Halvings of a run at most: these, and one a stretch. A power that is rounding alone bends everywhere.
const SPARE_HALVINGS: u64 = 2000;

/// Sums up to now.
pub(crate) struct Meter<'a> {
    ledger: &'a Ledger,
    slopes: [[f64; POINTS]; POINTS],
    sums: Energies,
    /// The largest power of each account, then the largest flow of each port.
    largest: Vec<f64>,
    halvings_left: u64,
}

impl<'a> Meter<'a> {
    /// Begins at the outputs of the start; `None` where no ledger was asked for.
    pub(crate) fn new(ledger: &'a Ledger) -> Option<Self> {
        let (accounts, ports) = (ledger.accounts.len(), ledger.ports.len());
        if accounts + ports == 0 {
            return None;
        }
        Some(Self {
            ledger,
            slopes: slopes(),
            sums: Energies {
                received: vec![0.0; ports],
                accounts: vec![0.0; accounts],
                jumps: vec![0.0; accounts],
                passed: 0.0,
            },
            largest: vec![0.0; accounts + ports],
            halvings_left: SPARE_HALVINGS,
        })
    }

    /// Adds a stretch of the solver's last step.
    pub(crate) fn step(
        &mut self,
        integrator: &mut Integrator<'_>,
        consistent: &mut Consistent,
        (from, to): (f64, f64),
    ) {
        if to <= from {
            return;
        }
        let mut then = integrator.room(from);
        self.between(from, to, &mut |t| {
            then.t = t;
            integrator.solution(consistent, &mut then);
            let state = integrator.state_mut();
            state.values(Function::Outputs, then.at())
        });
    }

    /// Adds a stretch by the outputs at its points, halved until they show what lies between.
    fn between(&mut self, from: f64, to: f64, at: &mut dyn FnMut(f64) -> Vec<f64>) {
        self.halvings_left += 1;
        let mut pieces = vec![(from, to, 0)];
        while let Some((from, to, halvings)) = pieces.pop() {
            let times = lobatto::times(from, to);
            let outputs = times.map(&mut *at);
            let middle = times[MIDDLE];
            let narrow = middle <= from || middle >= to || halvings == MAX_HALVINGS;
            if self.are_resolved(&outputs) || narrow || self.halvings_left == 0 {
                self.stretch(to - from, &outputs);
            } else {
                self.halvings_left -= 1;
                pieces.extend([(middle, to, halvings + 1), (from, middle, halvings + 1)]);
            }
        }
    }

    /// Whether the outputs at five points show every power and every flow between them.
    fn are_resolved(&mut self, outputs: &[Vec<f64>; POINTS]) -> bool {
        let powers = self
            .ledger
            .accounts
            .iter()
            .map(|account| match account.kind {
                AccountKind::Dissipated | AccountKind::Supplied => account.outputs.clone(),
                AccountKind::Stored => 0..0,
            });
        let ports = self.ledger.ports.iter();
        let flows = ports.map(|port| port.flow..port.flow + 1);
        let mut resolved = true;
        for (read, largest) in powers.chain(flows).zip(&mut self.largest) {
            let values = std::array::from_fn(|k| outputs[k][read.clone()].iter().sum::<f64>());
            *largest = values.iter().fold(*largest, |most, v| most.max(v.abs()));
            let bent = lobatto::beyond_cubic(&values);
            resolved &= bent.is_nan() || bent <= BENT * *largest;
        }
        resolved
    }

    /// Adds a stretch of `span` s with the outputs at its points.
    fn stretch(&mut self, span: f64, outputs: &[Vec<f64>; POINTS]) {
        let half = 0.5 * span;
        for (number, port) in self.ledger.ports.iter().enumerate() {
            let mut energy = 0.0;
            for (i, at) in outputs.iter().enumerate() {
                let flow = at[port.flow];
                energy += WEIGHTS[i]
                    * match port.kind {
                        PortKind::Work => {
                            let rate = self.slopes[i].iter().zip(outputs);
                            flow * rate.map(|(d, at)| d * at[port.potential]).sum::<f64>()
                        }
                        PortKind::Power => half * flow * at[port.potential],
                        PortKind::Heat => half * flow,
                    };
            }
            self.sums.received[number] += energy;
            // What leaves one component enters another: each joule is seen twice.
            self.sums.passed += 0.5 * energy.abs();
        }
        for (number, account) in self.ledger.accounts.iter().enumerate() {
            let value = |at: &Vec<f64>| at[account.outputs.clone()].iter().sum::<f64>();
            self.sums.accounts[number] += match account.kind {
                AccountKind::Stored => value(&outputs[POINTS - 1]) - value(&outputs[0]),
                AccountKind::Dissipated | AccountKind::Supplied => {
                    let powers = WEIGHTS.iter().zip(outputs);
                    half * powers.map(|(w, at)| w * value(at)).sum::<f64>()
                }
            };
        }
    }

    /// Adds what happened to the stored energies at an instant.
    pub(crate) fn instant(&mut self, before: &[f64], after: &[f64]) {
        for (number, account) in self.ledger.accounts.iter().enumerate() {
            if account.kind == AccountKind::Stored {
                let value = |at: &[f64]| at[account.outputs.clone()].iter().sum::<f64>();
                let jump = value(after) - value(before);
                self.sums.jumps[number] += jump;
                // What is lost on an impact leaves its component too.
                self.sums.passed += jump.abs();
            }
        }
    }

    /// The sums.
    pub(crate) fn sums(&self) -> Energies {
        self.sums.clone()
    }
}

/// The slope at each node of the polynomial through values at all of them: barycentric weights (Berrut and Trefethen,
/// SIAM Review 46, 2004).
fn slopes() -> [[f64; POINTS]; POINTS] {
    let weight = |i: usize| -> f64 {
        let others = (0..POINTS).filter(|&k| k != i);
        others.map(|k| 1.0 / (NODES[i] - NODES[k])).product()
    };
    let mut matrix = [[0.0; POINTS]; POINTS];
    for i in 0..POINTS {
        for k in 0..POINTS {
            if i != k {
                matrix[i][k] = weight(k) / weight(i) / (NODES[i] - NODES[k]);
            }
        }
        matrix[i][i] = -matrix[i].iter().sum::<f64>();
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_program::{Account, Port};

    #[test]
    fn the_corner_of_a_power_is_found() {
        let ledger = Ledger {
            accounts: vec![Account {
                component: "c".to_owned(),
                name: "heat".to_owned(),
                kind: AccountKind::Dissipated,
                outputs: 0..1,
            }],
            ports: Vec::new(),
        };
        let mut meter = Meter::new(&ledger).unwrap();
        meter.between(0.0, 1.0, &mut |t| vec![(t - 0.3).max(0.0)]);
        // 0.7^2/2, but for the stretch of 2^-10 with the corner in it: its error is a part of the square of that.
        let heat = meter.sums().accounts[0];
        assert!((heat - 0.245).abs() < 1e-7, "{heat}");
    }

    #[test]
    fn work_along_polynomials_is_exact() {
        let ledger = Ledger {
            accounts: vec![Account {
                component: "c".to_owned(),
                name: "kinetic".to_owned(),
                kind: AccountKind::Stored,
                outputs: 2..3,
            }],
            ports: vec![Port {
                component: "c".to_owned(),
                kind: PortKind::Work,
                flow: 0,
                potential: 1,
            }],
        };
        let mut meter = Meter::new(&ledger).unwrap();
        // f = 3 t^2, s = t^3 from 1 to 3: work 9 t^5/5.
        let times = crate::lobatto::times(1.0, 3.0);
        let outputs = times.map(|t: f64| vec![3.0 * t * t, t.powi(3), t]);
        meter.stretch(2.0, &outputs);
        meter.instant(&[0.0, 0.0, 3.0], &[0.0, 0.0, 2.5]);
        let sums = meter.sums();
        let work = 1.8 * (3.0_f64.powi(5) - 1.0);
        // Rounding of some twenty operations.
        assert!((sums.received[0] / work - 1.0).abs() < 1e-14);
        // Half of the work, and the jump.
        assert!(((sums.passed - 0.5) / work - 0.5).abs() < 1e-14);
        assert_eq!(sums.accounts, [2.0]);
        assert_eq!(sums.jumps, [-0.5]);
    }
}
