//! Derivatives of what an instance computes by what it is given, at the point where it is.

use super::{Instance, Refusal, Result};
use crate::interface::Source;
use hyde_sim::Variation;

impl Instance {
    /// How the unknowns change if each of the knowns changes by its seed. Knowns are inputs, parameters and states; unknowns
    /// reported quantities, states and derivatives of states.
    ///
    /// # Errors
    /// A variable is none of these, or the derivative is not defined where the instance is.
    pub fn directional_derivative(
        &mut self,
        unknowns: &[usize],
        knowns: &[usize],
        seed: &[f64],
    ) -> Result<Vec<f64>> {
        if knowns.len() != seed.len() {
            let text = format!("{} knowns, but {} seeds", knowns.len(), seed.len());
            return Err(Refusal::Misuse(text));
        }
        self.current()?;
        let (mut states, mut parameters) = (Vec::new(), Vec::new());
        for (&known, &by) in knowns.iter().zip(seed) {
            match self.source(known)? {
                Source::State(position) => states.push((position, by)),
                Source::Parameter(place) => parameters.push((place, by)),
                Source::Time | Source::Output(_) | Source::Derivative(_) | Source::Guard(_) => {
                    return Err(self.no_derivative(known, "by"));
                }
            }
        }
        let varied = self
            .run()?
            .with(|session| session.vary(&states, &parameters));
        let varied = varied.ok_or_else(|| {
            let why = "no derivative is defined here: the run slides on a switching surface, or the equations are singular";
            Refusal::Failure(why.to_owned())
        })?;
        unknowns
            .iter()
            .map(|&unknown| self.of(&varied, unknown))
            .collect()
    }

    /// How the sum of the unknowns, each times its seed, changes with each of the knowns.
    ///
    /// # Errors
    /// As for [`Instance::directional_derivative`].
    pub fn adjoint_derivative(
        &mut self,
        unknowns: &[usize],
        knowns: &[usize],
        seed: &[f64],
    ) -> Result<Vec<f64>> {
        if unknowns.len() != seed.len() {
            let text = format!("{} unknowns, but {} seeds", unknowns.len(), seed.len());
            return Err(Refusal::Misuse(text));
        }
        let each = knowns.iter().map(|&known| {
            let column = self.directional_derivative(unknowns, &[known], &[1.0])?;
            Ok(column.iter().zip(seed).map(|(of, by)| of * by).sum())
        });
        each.collect()
    }

    fn of(&self, varied: &Variation, unknown: usize) -> Result<f64> {
        match self.source(unknown)? {
            Source::Output(number) => Ok(varied.outputs[number]),
            Source::State(position) => Ok(varied.y[position]),
            Source::Derivative(position) => Ok(varied.yp[position]),
            Source::Time | Source::Parameter(_) | Source::Guard(_) => {
                Err(self.no_derivative(unknown, "of"))
            }
        }
    }

    fn no_derivative(&self, variable: usize, word: &str) -> Refusal {
        let name = &self.model.interface.variables[variable].name;
        Refusal::Misuse(format!("there is no derivative {word} `{name}`"))
    }
}
