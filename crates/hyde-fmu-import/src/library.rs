//! [`Library`]: an FMU that is unpacked and loaded, and [`Slave`]: what both versions of the standard do for an instance.
#![allow(unsafe_code, reason = "the library is foreign")]

use crate::description::{FmuVariable, Version};
use crate::log::Log;
use crate::unpacked::Unpacked;
use crate::{Fmu, fmi_2_0, fmi_3_0};
use std::mem::ManuallyDrop;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A call with what went wrong: the function and its status.
pub(crate) type Called = Result<(), String>;

/// One instance. Values are those of the FMU, in its units.
pub(crate) trait Slave: Send {
    /// Sets a variable.
    fn set(&mut self, variable: &FmuVariable, values: &[f64]) -> Called;
    /// Reads a variable.
    fn get(&mut self, variable: &FmuVariable, values: &mut [f64]) -> Called;
    /// Begins to initialise, at a start time and up to a stop time.
    fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Called;
    /// Ends it.
    fn exit_initialization(&mut self) -> Called;
    /// A communication step from a time.
    fn step(&mut self, t: f64, step: f64) -> Called;
}

/// The functions of a library. It is never unloaded: libraries that hold an interpreter or have started threads do not
/// survive that.
pub(crate) enum Functions {
    Two(ManuallyDrop<fmi_sys::fmi2::Fmi2Binding>),
    Three(ManuallyDrop<fmi_sys::fmi3::Fmi3Binding>),
}

/// An FMU that is loaded in this process.
pub(crate) struct Library {
    pub(crate) functions: Functions,
    pub(crate) folder: Unpacked,
    used: AtomicBool,
}

impl Library {
    /// Unpacks and loads an FMU.
    pub(crate) fn load(fmu: &Fmu) -> Result<Self, String> {
        let folder = Unpacked::of(fmu)?;
        let path = folder.file(&fmu.library);
        let failed = |error: &dyn std::fmt::Display| {
            let shown = error
                .to_string()
                .replace(&format!("{}/", folder.path().display()), "");
            format!("its library cannot be loaded: {shown}")
        };
        // SAFETY: loading runs the initialisers of the library, which is what the user asked for by running the model; its
        // functions have the types of the standard, which its model description declares.
        let functions = unsafe {
            match fmu.description.version {
                Version::Two => Functions::Two(ManuallyDrop::new(
                    fmi_sys::fmi2::Fmi2Binding::new(&path).map_err(|error| failed(&error))?,
                )),
                Version::Three => Functions::Three(ManuallyDrop::new(
                    fmi_sys::fmi3::Fmi3Binding::new(&path).map_err(|error| failed(&error))?,
                )),
            }
        };
        Ok(Self {
            functions,
            folder,
            used: AtomicBool::new(false),
        })
    }

    /// A new instance.
    pub(crate) fn instance(
        self: &Arc<Self>,
        fmu: &Fmu,
        name: &str,
        log: &Arc<Log>,
    ) -> Result<Box<dyn Slave>, String> {
        let used = self.used.swap(true, Ordering::SeqCst);
        if used && fmu.description.once_per_process {
            return Err(
                "a process can have one instance of it only, and this one has had it: `--sandbox` \
                 gives each its own process"
                    .to_owned(),
            );
        }
        Ok(match &self.functions {
            Functions::Two(_) => Box::new(fmi_2_0::Instance::new(self, fmu, name, log)?),
            Functions::Three(_) => Box::new(fmi_3_0::Instance::new(self, fmu, name, log)?),
        })
    }
}

/// What a function returned. `dead` is set where the standard forbids further calls (2) or allows freeing alone (1).
pub(crate) fn checked(function: &str, status: u32, dead: &mut u8) -> Called {
    let word = match status {
        0 | 1 => return Ok(()),
        2 => "Discard",
        3 => "Error",
        4 => "Fatal",
        5 => "Pending, which is for steps in the background",
        other => {
            *dead = 1;
            return Err(format!(
                "`{function}` returned the status {other}, which does not exist"
            ));
        }
    };
    *dead = (*dead).max(match status {
        4 => 2,
        _ => 1,
    });
    Err(format!("`{function}` returned {word}"))
}

/// A number of the model as an integer of the FMU.
pub(crate) fn whole<T: TryFrom<i128>>(variable: &FmuVariable, value: f64) -> Result<T, String> {
    let rounded = value.round();
    // Within 2^64, which an i128 holds.
    let whole = (rounded.is_finite() && rounded.abs() < 2e19).then_some(rounded as i128);
    whole
        .and_then(|whole| T::try_from(whole).ok())
        .ok_or_else(|| {
            format!(
                "`{}` is an integer of the FMU that cannot be {}",
                variable.name,
                hyde_units::significant(value, 6)
            )
        })
}
