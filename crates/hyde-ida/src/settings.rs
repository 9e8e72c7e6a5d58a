//! What can be changed of a solver between steps.

use sundials_sys as sys;

use crate::options::{check_length, check_max_step, check_tolerances};
use crate::{Crossing, Error, Ida, System};

impl<S: System> Ida<S> {
    /// Says for each root function which crossings to stop at; `None` for both, as in a new solver.
    ///
    /// # Errors
    /// [`Error::Length`].
    pub fn set_root_directions(&mut self, directions: &[Option<Crossing>]) -> Result<(), Error> {
        check_length("directions", directions.len(), self.directions.len())?;
        for (code, direction) in self.directions.iter_mut().zip(directions) {
            *code = match direction {
                None => 0,
                Some(Crossing::Rising) => 1,
                Some(Crossing::Falling) => -1,
            };
        }
        self.give_directions()
    }

    /// Changes the tolerances, from the next step on.
    ///
    /// # Errors
    /// As for [`Options`](crate::Options).
    pub fn set_tolerances(&mut self, rtol: f64, atol: &[f64]) -> Result<(), Error> {
        check_tolerances(rtol, atol, self.y().len())?;
        let bridge = self.bridge.get_mut();
        bridge.rtol = rtol;
        bridge.atol.copy_from_slice(atol);
        Ok(())
    }

    /// Changes the largest step, in s, infinity for none, from the next step on.
    ///
    /// # Errors
    /// [`Error::Option`] unless it is positive.
    pub fn set_max_step(&mut self, max_step_s: f64) -> Result<(), Error> {
        check_max_step(max_step_s)?;
        self.max_step_s = max_step_s;
        // IDA takes 0 for no limit.
        let limit = if max_step_s.is_finite() {
            max_step_s
        } else {
            0.0
        };
        // SAFETY: the memory is valid.
        let flag = unsafe { sys::IDASetMaxStep(self.memory.ida(), limit) };
        self.accept(flag)
    }

    /// Changes which unknowns are states, as a mode may; to be followed by [`reinit`](Self::reinit).
    ///
    /// # Errors
    /// [`Error::Length`].
    pub fn set_differential(&mut self, differential: &[bool]) -> Result<(), Error> {
        check_length("differential", differential.len(), self.y().len())?;
        let ids = self.scratch.as_mut_slice();
        for (id, &differential) in ids.iter_mut().zip(differential) {
            *id = f64::from(u8::from(differential));
        }
        self.differential.copy_from_slice(differential);
        // SAFETY: IDA copies the vector.
        let flag = unsafe { sys::IDASetId(self.memory.ida(), self.scratch.raw()) };
        self.accept(flag)
    }

    /// Tells IDA of the directions.
    pub(crate) fn give_directions(&mut self) -> Result<(), Error> {
        if self.directions.is_empty() {
            return Ok(());
        }
        // SAFETY: there is one direction for each root function; IDA copies them.
        let flag =
            unsafe { sys::IDASetRootDirection(self.memory.ida(), self.directions.as_mut_ptr()) };
        self.accept(flag)
    }
}
