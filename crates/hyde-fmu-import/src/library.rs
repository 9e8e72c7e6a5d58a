//! [`Library`]: an FMU that is unpacked and loaded, and [`Slave`]: what both versions of the standard do for an instance.
#![allow(unsafe_code, reason = "the library is foreign")]

use crate::description::{Description, FmuVariable, Use, Version};
use crate::exchange::Exchanged;
use crate::log::Log;
use crate::unpacked::Unpacked;
use crate::{Fmu, fmi_2_0, fmi_3_0};
use fmi_sys::fmi2::Fmi2Binding;
use fmi_sys::fmi3::Fmi3Binding;
use libloading::os::unix::{Library as UnixLibrary, RTLD_GLOBAL, RTLD_LOCAL, RTLD_NOW};
use std::mem::ManuallyDrop;
use std::path::Path;
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
    Two(Box<ManuallyDrop<Fmi2Binding>>),
    Three(Box<ManuallyDrop<Fmi3Binding>>),
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
        let library = open(&path).map_err(|error| {
            let shown = error.replace(&format!("{}/", folder.path().display()), "");
            format!("its library cannot be loaded: {shown}")
        })?;
        // SAFETY: the functions have the types of the standard, which the model description declares.
        let functions = unsafe {
            match fmu.description.version {
                Version::Two => Fmi2Binding::from_library(library)
                    .map(|own| Functions::Two(Box::new(ManuallyDrop::new(own)))),
                Version::Three => Fmi3Binding::from_library(library)
                    .map(|own| Functions::Three(Box::new(ManuallyDrop::new(own)))),
            }
        };
        let functions = functions.map_err(|error| error.to_string())?;
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
        let Description {
            used, tolerance, ..
        } = fmu.description;
        Ok(match (&self.functions, used) {
            (Functions::Two(_), Use::CoSimulation) => {
                Box::new(fmi_2_0::Instance::new(self, fmu, name, log)?)
            }
            (Functions::Three(_), Use::CoSimulation) => {
                Box::new(fmi_3_0::Instance::new(self, fmu, name, log)?)
            }
            (Functions::Two(_), Use::ModelExchange) => {
                let instance = fmi_2_0::Instance::new(self, fmu, name, log)?;
                Box::new(Exchanged::new(instance, tolerance))
            }
            (Functions::Three(_), Use::ModelExchange) => {
                let instance = fmi_3_0::Instance::new(self, fmu, name, log)?;
                Box::new(Exchanged::new(instance, tolerance))
            }
        })
    }
}

/// Loads a library, and Python before it if it needs that.
fn open(path: &Path) -> Result<libloading::Library, String> {
    let error = match opened(path, RTLD_NOW | RTLD_LOCAL) {
        Ok(library) => return Ok(library.into()),
        Err(error) => error.to_string(),
    };
    if !error.contains("undefined symbol: Py") && !error.contains("undefined symbol: _Py") {
        return Err(error);
    }
    let names = PYTHON.map(|minor| format!("libpython3.{minor}.so.1.0"));
    for name in &names {
        let Ok(python) = opened(Path::new(name), RTLD_NOW | RTLD_GLOBAL) else {
            continue;
        };
        // An interpreter that has begun does not end before its process.
        std::mem::forget(python);
        return match opened(path, RTLD_NOW | RTLD_LOCAL) {
            Ok(library) => Ok(library.into()),
            Err(error) => Err(error.to_string()),
        };
    }
    Err(format!(
        "{error}: it needs Python, and the system has none of {}; set LD_PRELOAD to that of yours",
        names.join(", ")
    ))
}

/// The minor versions of Python that are looked for, the first that there is being taken.
const PYTHON: [u32; 6] = [13, 12, 11, 10, 9, 8];

fn opened(path: &Path, flags: i32) -> Result<UnixLibrary, libloading::Error> {
    // SAFETY: loading runs the initialisers of the library, which is what the user asks for by running the model. All its
    // symbols are looked up at once: one that is missing is an error here, not the end of the process later.
    unsafe { UnixLibrary::open(Some(path), flags) }
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
