//! Values of an instance: what is read, and what an importer sets.

use super::{Instance, Phase, Refusal, Result};
use crate::interface::{Causality, Source, Variability};
use hyde_units::significant;

impl Instance {
    /// The value of a variable.
    ///
    /// # Errors
    /// There is no such variable, or it has no value now.
    pub fn get(&mut self, reference: usize) -> Result<f64> {
        match self.source(reference)? {
            Source::Time => Ok(self.t()),
            Source::Parameter(place) => self.parameter(place),
            Source::Output(number) => {
                self.current()?;
                if self.outputs.is_none() {
                    let outputs = self.run()?.with(|session| session.outputs().to_vec());
                    self.outputs = Some(outputs);
                }
                Ok(self.outputs.as_ref().map_or(f64::NAN, |all| all[number]))
            }
            Source::State(position) => {
                self.current()?;
                Ok(self.run()?.with(|session| session.point().0[position]))
            }
            Source::Derivative(position) => {
                self.current()?;
                Ok(self.run()?.with(|session| session.point().1[position]))
            }
            Source::Guard(_) => {
                let number = self.model.interface.guards.iter();
                let mut number = number.map(|(known, _)| *known);
                let number = number.position(|known| known == reference);
                let guards = self.event_indicators()?;
                Ok(number.map_or(f64::NAN, |number| guards[number]))
            }
        }
    }

    /// Sets a variable.
    ///
    /// # Errors
    /// It may not be set, not now, or not to this value.
    pub fn set(&mut self, reference: usize, value: f64) -> Result<()> {
        let source = self.source(reference)?;
        self.between_steps("a variable is set")?;
        let variable = &self.model.interface.variables[reference];
        let name = &variable.name;
        let Source::Parameter(place) = source else {
            return Err(Refusal::Misuse(format!("`{name}` cannot be set")));
        };
        let before = matches!(self.phase, Phase::Instantiated | Phase::Initialization);
        match (variable.causality, variable.variability) {
            (Causality::Input, _) => {}
            (Causality::Parameter, _) if before => {}
            (Causality::Parameter, Variability::Tunable) if self.phase != Phase::Continuous => {}
            (Causality::Parameter, _) => {
                return Err(Refusal::Misuse(format!(
                    "`{name}` cannot be set after the initialisation"
                )));
            }
            _ => return Err(Refusal::Misuse(format!("`{name}` cannot be set"))),
        }
        let parameter = self.model.program.parameter_at(place);
        if let Some((parameter, _)) = parameter {
            let refusal = match value.is_finite() {
                true => parameter.allowed.refusal(value, &parameter.unit),
                false => Some("it must be finite".to_owned()),
            };
            if let Some(refusal) = refusal {
                let text = format!("`{name}` cannot be {}: {refusal}", significant(value, 9));
                return Err(Refusal::Value(text));
            }
        }
        let same = self.parameter(place)?.to_bits() == value.to_bits();
        if self.set.insert(place, value) != Some(value) && !same {
            self.pending = true;
            self.outputs = None;
            self.placed = false;
            if before {
                self.running = None;
            }
        }
        Ok(())
    }

    pub(super) fn source(&self, reference: usize) -> Result<Source> {
        let variable = self.model.interface.variables.get(reference);
        let unknown = || Refusal::Misuse(format!("there is no variable {reference}"));
        Ok(variable.ok_or_else(unknown)?.source)
    }

    /// The value of a parameter, what is set but not in the run yet included.
    pub(super) fn parameter(&mut self, place: usize) -> Result<f64> {
        if let Some(&value) = self.set.get(&place) {
            return Ok(value);
        }
        match &mut self.running {
            Some(running) if !self.pending => {
                Ok(running.with(|session| session.parameters()[place]))
            }
            Some(_) | None => Ok(self.parameters()[place]),
        }
    }

    /// The whole parameter vector with what is set, where all of it is within its bounds: what importers set one after the
    /// other may be so only together.
    pub(super) fn allowed_parameters(&mut self) -> Result<Vec<f64>> {
        let parameters = self.parameters();
        let allowed = hyde_experiment::within_bounds(&self.model.program, &parameters);
        allowed.map_err(|error| Refusal::Value(self.model.explain(&error)))?;
        Ok(parameters)
    }

    /// The whole parameter vector with what is set; what initial equations found stays.
    pub(super) fn parameters(&mut self) -> Vec<f64> {
        let mut values = self.model.set_places();
        values.extend(self.set.iter().map(|(&place, &value)| (place, value)));
        if let Some(running) = &mut self.running {
            let found = self.model.program.parameters.iter().filter(|p| p.found);
            running.with(|session| {
                for parameter in found {
                    for place in parameter.place..parameter.place + parameter.len {
                        values.push((place, session.parameters()[place]));
                    }
                }
            });
        }
        let mut all = vec![0.0; self.model.program.n_parameters];
        self.model.program.kernels.parameters(&values, &mut all);
        all
    }
}
