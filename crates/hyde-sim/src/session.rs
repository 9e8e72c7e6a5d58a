//! [`Session`]: a run that its caller takes from one time to the next, as a co-simulation does, or integrates itself.
//!
//! The solver chooses its own steps and may be ahead of the caller; values at the caller's time then come from the step's
//! interpolant, as the rows of [`crate::simulate`] do. So a session that nothing is set in gives the digits of a run. Where a
//! parameter is set, the run starts anew at the caller's time.

use crate::failure::Failure;
use crate::results::Event;
use crate::setup::Setup;
use crate::simulation::{Advance, Advanced, Simulation, Snapshot};
use hyde_program::Program;

/// A change of what a session is given at a point, or of what follows from it there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variation {
    /// Of the solver's vector.
    pub y: Vec<f64>,
    /// Of its derivative.
    pub yp: Vec<f64>,
    /// Of the outputs.
    pub outputs: Vec<f64>,
}

/// A run under way.
pub struct Session<'a> {
    run: Simulation<'a>,
}

impl<'a> Session<'a> {
    /// Starts a run: initial values, first events, first ticks.
    ///
    /// # Errors
    /// As for [`crate::simulate`].
    pub fn start(program: &'a Program, setup: &'a Setup<'a>) -> Result<Self, Box<Failure>> {
        let mut run = Simulation::new(program, setup)?;
        run.begin()?;
        Ok(Self { run })
    }

    /// The caller's time in s.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.run.place().t
    }

    /// Goes on to a time in s, events there included.
    ///
    /// # Errors
    /// A [`Failure`]; the session stays where it last was.
    pub fn advance(&mut self, to: f64, how: Advance) -> Result<Advanced, Box<Failure>> {
        let advanced = self.run.advance_by_caller(to, how)?;
        self.run.forget_rows();
        Ok(advanced)
    }

    /// Whether an event waits at the caller's time.
    #[must_use]
    pub fn waits(&self) -> bool {
        self.run.waits_for_caller()
    }

    /// Works on the event that waits at the caller's time.
    ///
    /// # Errors
    /// As for [`Session::advance`].
    pub fn happen(&mut self) -> Result<(), Box<Failure>> {
        self.run.happen()?;
        self.run.forget_rows();
        Ok(())
    }

    /// The values of all outputs at the caller's time, SI.
    pub fn outputs(&mut self) -> &[f64] {
        self.run.outputs_of_caller()
    }

    /// The solver's vector and its derivative at the caller's time.
    #[must_use]
    pub fn point(&self) -> (&[f64], &[f64]) {
        let place = self.run.place();
        (&place.y, &place.yp)
    }

    /// The parameter vector, with what initial equations found.
    #[must_use]
    pub fn parameters(&self) -> &[f64] {
        self.run.parameters()
    }

    /// Sets the whole parameter vector from the caller's time on. What the solver has computed behind it is dropped.
    ///
    /// # Errors
    /// There are no consistent values with these parameters.
    pub fn set_parameters(&mut self, parameters: Vec<f64>) -> Result<(), Box<Failure>> {
        self.run.enter_parameters(parameters)?;
        self.run.forget_rows();
        Ok(())
    }

    /// Sets the whole parameter vector within a step of the caller's own integration: values follow where it is placed next.
    pub fn replace_parameters(&mut self, parameters: Vec<f64>) {
        self.run.replace_parameters(parameters);
    }

    /// The events since they were last taken.
    pub fn take_events(&mut self) -> Vec<Event> {
        self.run.take_events()
    }

    /// The next instant in s that is known beforehand: a tick, a step of a record, a switch by the time. Infinite if there is
    /// none.
    #[must_use]
    pub fn next_instant(&self) -> f64 {
        self.run.next_instant()
    }

    /// Takes states of the caller's own integration at a time: positions in the solver's vector and values. The other
    /// unknowns follow from the equations.
    ///
    /// # Errors
    /// The equations have no solution there.
    pub fn place_at(
        &mut self,
        t: f64,
        positions: &[usize],
        states: &[f64],
    ) -> Result<(), Box<Failure>> {
        self.run.place_at(t, positions, states)
    }

    /// The root functions where the caller is, one a relation: positive where it is true. Of one that does not matter in the
    /// current modes there is none.
    pub fn roots(&mut self) -> Vec<Option<f64>> {
        self.run.roots_of_caller()
    }

    /// Accepts the caller's point as the end of a step of its own integration. Returns whether an event has been passed.
    pub fn accept(&mut self) -> bool {
        self.run.accept()
    }

    /// Where the session is, to return to.
    ///
    /// # Errors
    /// There are no consistent values at the caller's time.
    pub fn snapshot(&mut self) -> Result<Snapshot, Box<Failure>> {
        self.run.snapshot()
    }

    /// Returns to where a session of this program was, whichever it was. Whether the snapshot is one of this program; if not,
    /// nothing changes.
    ///
    /// # Errors
    /// The solver cannot begin there.
    pub fn restore(&mut self, snapshot: Snapshot) -> Result<bool, Box<Failure>> {
        self.run.restore(snapshot)
    }

    /// How values at the caller's point change with states (positions in the solver's vector) and parameters (positions in the
    /// parameter vector), each by so much: the derivative in that direction, by the equations as they are there. None while
    /// the run slides on a surface, or where the equations are singular.
    pub fn vary(
        &mut self,
        states: &[(usize, f64)],
        parameters: &[(usize, f64)],
    ) -> Option<Variation> {
        self.run.vary(states, parameters)
    }

    /// Works on the events at the point that the caller has come to by its own integration.
    ///
    /// # Errors
    /// As for [`Session::advance`].
    pub fn happen_here(&mut self) -> Result<(), Box<Failure>> {
        self.run.happen_here()?;
        self.run.forget_rows();
        Ok(())
    }
}
