//! Model exchange: the importer integrates, and asks for derivatives and guards.

use super::{Instance, Interface, Phase, Refusal, Result};
use std::sync::Arc;

impl Instance {
    /// Enters continuous-time mode.
    ///
    /// # Errors
    /// Not from event mode.
    pub fn enter_continuous_time_mode(&mut self) -> Result<()> {
        self.only(&[Phase::Event], "continuous-time mode begins")?;
        self.phase = Phase::Continuous;
        Ok(())
    }

    /// Sets the time of an importer that integrates.
    ///
    /// # Errors
    /// Not in model exchange.
    pub fn set_time(&mut self, t: f64) -> Result<()> {
        self.integrating()?;
        if t.to_bits() != self.point.0.to_bits() {
            self.point.0 = t;
            (self.placed, self.outputs) = (false, None);
        }
        Ok(())
    }

    /// Sets the states of an importer that integrates.
    ///
    /// # Errors
    /// Not in model exchange, or not as many as there are.
    pub fn set_states(&mut self, states: &[f64]) -> Result<()> {
        self.integrating()?;
        if states.len() != self.point.1.len() {
            let text = format!("the model has {} states", self.point.1.len());
            return Err(Refusal::Misuse(text));
        }
        let mut pairs = states.iter().zip(&self.point.1);
        if pairs.any(|(a, b)| a.to_bits() != b.to_bits()) {
            self.point.1.copy_from_slice(states);
            (self.placed, self.outputs) = (false, None);
        }
        Ok(())
    }

    /// The states.
    ///
    /// # Errors
    /// There is no run yet.
    pub fn states(&mut self) -> Result<Vec<f64>> {
        self.current()?;
        let interface = Arc::clone(&self.model);
        let positions = interface.interface.states.iter();
        self.run()?.with(|session| {
            let (y, _) = session.point();
            Ok(positions.map(|(_, position)| y[*position]).collect())
        })
    }

    /// Their derivatives.
    ///
    /// # Errors
    /// The equations have no solution at the point.
    pub fn derivatives(&mut self) -> Result<Vec<f64>> {
        self.current()?;
        let model = Arc::clone(&self.model);
        let positions = model.interface.states.iter();
        self.run()?.with(|session| {
            let (_, yp) = session.point();
            Ok(positions.map(|(_, position)| yp[*position]).collect())
        })
    }

    /// The guards: the root function of every relation, positive where it is true. One that does not matter in the current modes
    /// keeps its last value.
    ///
    /// # Errors
    /// The equations have no solution at the point.
    pub fn event_indicators(&mut self) -> Result<Vec<f64>> {
        self.current()?;
        let roots = self.run()?.with(|session| session.roots());
        for (guard, (_, relation)) in self.guards.iter_mut().zip(&self.model.interface.guards) {
            if let Some(root) = roots[*relation] {
                *guard = root;
            }
        }
        Ok(self.guards.clone())
    }

    /// The sizes by which the tolerances of an importer are to be scaled, one a state.
    #[must_use]
    pub fn nominals(&self) -> Vec<f64> {
        vec![self.model.nominal(); self.model.interface.states.len()]
    }

    /// Ends a step of an importer that integrates. Whether it has passed an event.
    ///
    /// # Errors
    /// The equations have no solution at the point.
    pub fn completed_integrator_step(&mut self) -> Result<bool> {
        self.only(&[Phase::Continuous], "a step is completed")?;
        self.place()?;
        Ok(self.run()?.with(|session| session.accept()))
    }

    pub(super) fn integrating(&self) -> Result<()> {
        self.only(&[Phase::Continuous, Phase::Event], "a point is set")?;
        match self.used {
            Interface::ModelExchange => Ok(()),
            Interface::CoSimulation { .. } => {
                Err(Refusal::Misuse("the instance integrates itself".to_owned()))
            }
        }
    }

    /// Takes what is set and where the importer has come to.
    pub(super) fn place(&mut self) -> Result<()> {
        if self.pending {
            let parameters = self.allowed_parameters()?;
            self.run()?
                .with(|session| session.replace_parameters(parameters));
            self.pending = false;
        }
        if !self.placed {
            let model = Arc::clone(&self.model);
            let states = model.interface.states.iter();
            let positions: Vec<usize> = states.map(|(_, position)| *position).collect();
            let (t, states) = self.point.clone();
            self.working(|session| session.place_at(t, &positions, &states))?;
            self.placed = true;
        }
        Ok(())
    }

    /// The importer is where the run is.
    pub(super) fn take_point(&mut self) {
        let model = Arc::clone(&self.model);
        if let Some(running) = &mut self.running {
            self.point = running.with(|session| {
                let (y, _) = session.point();
                let states = model.interface.states.iter();
                (
                    session.t(),
                    states.map(|(_, position)| y[*position]).collect(),
                )
            });
            self.placed = true;
        }
    }
}
