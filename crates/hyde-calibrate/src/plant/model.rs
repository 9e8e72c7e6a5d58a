//! [`Model`]: rates and algebraic variables where the states are: all equations solved, or along a step those alone that bend,
//! the linear ones being carried along.

use super::configuration::{Configuration, Places};
use super::secants::Secants;
use crate::linear::set_product;
use hyde_program::{Function, Point, Program, Workspace};

/// Vectors that rates are solved in.
pub(crate) struct Solving {
    pub(crate) residual: Vec<f64>,
    pub(crate) delta: Vec<f64>,
    /// Of the equations that bend, the residuals that have been answered.
    pub(crate) sum: Vec<f64>,
    secants: Secants,
}

impl Solving {
    pub(crate) fn new(unknowns: usize) -> Self {
        Self {
            residual: vec![0.0; unknowns],
            delta: vec![0.0; unknowns],
            sum: Vec::new(),
            secants: Secants::default(),
        }
    }
}

/// What rates are made of.
pub(crate) struct Model<'s> {
    pub(crate) program: &'s Program,
    pub(crate) places: &'s Places,
    pub(crate) p: &'s [f64],
    pub(crate) z: &'s [f64],
    pub(crate) u: &'s [f64],
    pub(crate) pinned: &'s [(usize, f64)],
}

impl Model<'_> {
    pub(crate) fn point<'a>(&'a self, t: f64, y: &'a [f64], yp: &'a [f64]) -> Point<'a> {
        Point {
            t,
            y,
            yp,
            z: self.z,
            u: self.u,
            p: self.p,
        }
    }

    /// Rates and algebraic variables for the states in y, from a guess of them.
    pub(crate) fn rates(
        &self,
        configuration: &Configuration<'_>,
        t: f64,
        y: &mut [f64],
        yp: &mut [f64],
        workspace: &mut Workspace,
        Solving {
            residual,
            delta,
            secants,
            ..
        }: &mut Solving,
    ) {
        secants.begin();
        for _ in 0..rounds(configuration) {
            let at = self.point(t, y, yp);
            self.program
                .kernels
                .evaluate(Function::Residual, at, workspace, residual);
            if !configuration.constant {
                secants.step(residual);
            }
            set_product(&configuration.inverse, residual, delta);
            let mut settled = true;
            for (index, &change) in delta.iter().enumerate() {
                let value = match self.places.differential[index] {
                    true => &mut yp[index],
                    false => &mut y[index],
                };
                *value -= change;
                settled &= is_rounding(change, *value);
            }
            if settled {
                break;
            }
        }
        self.apply_pins(y, yp);
    }

    /// Takes the states on by what a linear flow makes of them.
    pub(crate) fn carry(&self, flow: &[f64], y: &mut [f64], yp: &mut [f64]) {
        let (change, rest) = flow.split_at(self.places.states.len());
        let (rates, algebraics) = rest.split_at(change.len());
        for ((&place, change), rate) in self.places.states.iter().zip(change).zip(rates) {
            y[place] += change;
            yp[place] = *rate;
        }
        for (&place, change) in self.places.algebraics.iter().zip(algebraics) {
            y[place] += change;
        }
        self.apply_pins(y, yp);
    }

    /// Adds a change of rates and algebraic variables, one below the other.
    pub(crate) fn follow(&self, change: &[f64], y: &mut [f64], yp: &mut [f64]) {
        let (rates, algebraics) = change.split_at(self.places.states.len());
        for (&place, change) in self.places.states.iter().zip(rates) {
            yp[place] += change;
        }
        for (&place, change) in self.places.algebraics.iter().zip(algebraics) {
            y[place] += change;
        }
        self.apply_pins(y, yp);
    }

    /// Answers the residuals of the equations that bend, the linear ones being met; the sum of what was answered is left
    /// in the room.
    pub(crate) fn answer(
        &self,
        configuration: &Configuration<'_>,
        t: f64,
        y: &mut [f64],
        yp: &mut [f64],
        workspace: &mut Workspace,
        Solving {
            residual,
            delta,
            sum,
            secants,
        }: &mut Solving,
    ) {
        secants.begin();
        let bending = &configuration.bending;
        sum.clear();
        sum.resize(bending.count, 0.0);
        for _ in 0..rounds(configuration) {
            let at = self.point(t, y, yp);
            bending.residual(at, workspace, residual);
            if !configuration.constant {
                secants.step(&mut residual[..bending.count]);
            }
            bending.follow(residual, delta);
            for (sum, residual) in sum.iter_mut().zip(&*residual) {
                *sum += residual;
            }
            self.follow(delta, y, yp);
            let (rates, algebraics) = delta.split_at(self.places.states.len());
            let settled = |changes: &[f64], places: &[usize], values: &[f64]| {
                let mut pairs = changes.iter().zip(places);
                pairs.all(|(change, &place)| is_rounding(*change, values[place]))
            };
            if settled(rates, &self.places.states, yp)
                && settled(algebraics, &self.places.algebraics, y)
            {
                break;
            }
        }
    }

    fn apply_pins(&self, y: &mut [f64], yp: &mut [f64]) {
        for &(position, value) in self.pinned {
            y[position] = value;
            yp[position] = 0.0;
        }
    }
}

/// How often rates are solved for at most.
fn rounds(configuration: &Configuration<'_>) -> usize {
    if configuration.constant { 1 } else { 8 }
}

/// Whether a change of a value is no more than rounding.
fn is_rounding(change: f64, value: f64) -> bool {
    change.abs() <= 1e-10 * value.abs() + 1e-13
}
