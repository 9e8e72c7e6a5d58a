//! The shape of a mode, and the parts of a drive in which its energy is.
//!
//! The shape is the eigenvector of the linearised system. The energies are those that components declare as `stored`: over a period each swings between
//! its values at the shape's real and its imaginary part, so their mean counts. Energies are taken to the second order
//! about the operating point.

use crate::linearize::Linear;
use crate::poles::{Pole, Poles};
use hyde_program::{AccountKind, Function, Point, Program, Workspace};
use nalgebra::{Complex, DVector};

/// The energy in J that a shape is scaled to: small against what a drive stores, large against rounding.
const ENERGY: f64 = 1e-4;

/// How a mode moves.
#[derive(Clone, Debug)]
pub struct ModeShape {
    /// Amplitude and phase of each state, in the order of [`Linear::states`].
    pub states: Vec<Complex<f64>>,
    /// Component, account, and its share of the energy, in the order of the model; empty if nothing is declared.
    pub shares: Vec<(String, String, f64)>,
}

/// The shape of a pole; `None` if it is one of clocked parts alone, or the iteration for its vector fails.
#[must_use]
pub fn mode_shape(
    program: &Program,
    linear: &Linear,
    (poles, pole): (&Poles, &Pole),
) -> Option<ModeShape> {
    let shape = poles.states(linear, pole)?;
    let mut energies = Energies::new(program, linear);
    let parts = [shape.map(|x| x.re), shape.map(|x| x.im)];
    // The scale is found from the first look at a unit vector.
    let mut scale = 1.0;
    let mut found = Vec::new();
    for _ in 0..2 {
        let [a, b] = parts.clone().map(|part| energies.at(&(part * scale)));
        found = a.iter().zip(&b).map(|(a, b)| a + b).collect::<Vec<f64>>();
        let total: f64 = found.iter().sum();
        if total.is_nan() || total <= 0.0 {
            break;
        }
        scale *= (ENERGY / total).sqrt();
    }
    let total: f64 = found.iter().sum();
    let accounts = program.experiment.ledger.accounts.iter();
    let shares = accounts
        .filter(|account| account.kind == AccountKind::Stored)
        .zip(found)
        .map(|(account, energy)| {
            (
                account.component.clone(),
                account.name.clone(),
                energy / total,
            )
        });
    Some(ModeShape {
        states: shape.iter().copied().collect(),
        shares: shares.collect(),
    })
}

/// Stored energies about the operating point.
struct Energies<'a> {
    program: &'a Program,
    linear: &'a Linear,
    work: Workspace,
    outputs: Vec<f64>,
    still: Vec<f64>,
}

impl<'a> Energies<'a> {
    fn new(program: &'a Program, linear: &'a Linear) -> Self {
        let mut energies = Self {
            program,
            linear,
            work: Workspace::new(program.n_work),
            outputs: vec![0.0; program.rows(Function::Outputs)],
            still: Vec::new(),
        };
        energies.still = energies.stored(&DVector::zeros(linear.states.len()), 0.0);
        energies
    }

    /// What a displacement of the states adds to each energy.
    fn at(&mut self, x: &DVector<f64>) -> Vec<f64> {
        let (up, down) = (self.stored(x, 1.0), self.stored(x, -1.0));
        let both = up.iter().zip(&down).zip(&self.still);
        both.map(|((up, down), still)| 0.5 * (up + down) - still)
            .collect()
    }

    fn stored(&mut self, x: &DVector<f64>, sign: f64) -> Vec<f64> {
        let (linear, point) = (self.linear, &self.linear.point);
        let (dy, dyp) = (&linear.unknowns * x, &linear.a * x);
        let y: Vec<f64> = point.y.iter().zip(&dy).map(|(y, d)| y + sign * d).collect();
        let mut yp = point.yp.clone();
        for (&state, rate) in linear.states.iter().zip(&dyp) {
            yp[state] += sign * rate;
        }
        // Energies are of states: delayed values stay as they are.
        let at = Point {
            y: &y,
            yp: &yp,
            ..point.at()
        };
        let kernels = &self.program.kernels;
        kernels.evaluate(Function::Outputs, at, &mut self.work, &mut self.outputs);
        let accounts = self.program.experiment.ledger.accounts.iter();
        accounts
            .filter(|account| account.kind == AccountKind::Stored)
            .map(|account| self.outputs[account.outputs.clone()].iter().sum())
            .collect()
    }
}
