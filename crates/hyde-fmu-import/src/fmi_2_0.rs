//! An instance of FMI 2.0.
#![allow(unsafe_code, reason = "the functions are those of a foreign library")]

use crate::Fmu;
use crate::description::{FmuVariable, NumberKind, Use};
use crate::exchange::{Exchange, Updated};
use crate::library::{Called, Functions, Library, Slave, checked, whole};
use crate::log::{Log, hyde_fmu_logger};
use fmi_sys::fmi2::{
    Fmi2Binding, fmi2CallbackFunctions, fmi2Component, fmi2EventInfo, fmi2Type_fmi2CoSimulation,
    fmi2Type_fmi2ModelExchange,
};
use std::ffi::{CString, c_void};
use std::sync::Arc;

/// Calls a function that a library need not have.
macro_rules! call {
    ($self:ident, $name:ident ( $($argument:expr),* )) => {{
        let Ok(function) = &$self.functions().$name else {
            return Err(format!("the library has no function `{}`", stringify!($name)));
        };
        // SAFETY: the function has the type of the standard; the component is the one it made and is not freed; pointers
        // hold for the call.
        let status = unsafe { function($self.component, $($argument),*) };
        checked(stringify!($name), status, &mut $self.dead)
    }};
}

/// The instance with what its library points to.
pub(crate) struct Instance {
    component: fmi2Component,
    library: Arc<Library>,
    /// The library keeps a pointer to them.
    _callbacks: Box<fmi2CallbackFunctions>,
    _log: Arc<Log>,
    dead: u8,
    running: bool,
    counts: (usize, usize),
}

// SAFETY: an instance may be called from any thread as long as one calls at a time, which `&mut self` holds.
unsafe impl Send for Instance {}

unsafe extern "C" {
    fn calloc(count: usize, size: usize) -> *mut c_void;
    fn free(memory: *mut c_void);
}

unsafe extern "C" fn allocate(count: usize, size: usize) -> *mut c_void {
    // SAFETY: any two sizes are allowed.
    unsafe { calloc(count, size) }
}

unsafe extern "C" fn release(memory: *mut c_void) {
    // SAFETY: the library gives back what `allocate` gave it.
    unsafe { free(memory) }
}

impl Instance {
    pub(crate) fn new(
        library: &Arc<Library>,
        fmu: &Fmu,
        name: &str,
        log: &Arc<Log>,
    ) -> Result<Self, String> {
        let Functions::Two(functions) = &library.functions else {
            return Err("the library is not one of FMI 2.0".to_owned());
        };
        let Ok(instantiate) = &functions.fmi2Instantiate else {
            return Err("the library has no function `fmi2Instantiate`".to_owned());
        };
        let text = |text: &str| CString::new(text).map_err(|error| error.to_string());
        let resources = format!("file://{}", library.folder.file("resources").display());
        let (name, token, resources) = (
            text(name)?,
            text(&fmu.description.token)?,
            text(&resources)?,
        );
        let callbacks = Box::new(fmi2CallbackFunctions {
            logger: Some(hyde_fmu_logger),
            allocateMemory: Some(allocate),
            freeMemory: Some(release),
            stepFinished: None,
            componentEnvironment: log.environment(),
        });
        // SAFETY: the strings hold for the call, callbacks and log as long as the instance.
        let component = unsafe {
            instantiate(
                name.as_ptr(),
                match fmu.description.used {
                    Use::CoSimulation => fmi2Type_fmi2CoSimulation,
                    Use::ModelExchange => fmi2Type_fmi2ModelExchange,
                },
                token.as_ptr(),
                resources.as_ptr(),
                &raw const *callbacks,
                0,
                1,
            )
        };
        if component.is_null() {
            return Err("`fmi2Instantiate` gave no instance".to_owned());
        }
        Ok(Self {
            component,
            library: library.clone(),
            _callbacks: callbacks,
            _log: log.clone(),
            dead: 0,
            running: false,
            counts: fmu.description.counts,
        })
    }

    #[allow(
        clippy::unreachable,
        reason = "an instance is made of a library of its own version alone"
    )]
    fn functions(&self) -> &Fmi2Binding {
        match &self.library.functions {
            Functions::Two(functions) => functions,
            Functions::Three(_) => unreachable!(),
        }
    }
}

impl Slave for Instance {
    fn set(&mut self, variable: &FmuVariable, values: &[f64]) -> Called {
        let reference = [variable.reference];
        let Some(&value) = values.first() else {
            return Ok(());
        };
        match variable.numbers.kind() {
            NumberKind::Real => call!(self, fmi2SetReal(reference.as_ptr(), 1, &raw const value)),
            NumberKind::Truth => {
                let value = i32::from(value != 0.0);
                call!(
                    self,
                    fmi2SetBoolean(reference.as_ptr(), 1, &raw const value)
                )
            }
            NumberKind::Whole => {
                let value: i32 = whole(variable, value)?;
                call!(
                    self,
                    fmi2SetInteger(reference.as_ptr(), 1, &raw const value)
                )
            }
        }
    }

    fn get(&mut self, variable: &FmuVariable, values: &mut [f64]) -> Called {
        let reference = [variable.reference];
        let Some(place) = values.first_mut() else {
            return Ok(());
        };
        let mut whole = 0_i32;
        match variable.numbers.kind() {
            NumberKind::Real => {
                return call!(self, fmi2GetReal(reference.as_ptr(), 1, &raw mut *place));
            }
            NumberKind::Truth => {
                call!(self, fmi2GetBoolean(reference.as_ptr(), 1, &raw mut whole))?;
                whole = i32::from(whole != 0);
            }
            NumberKind::Whole => {
                call!(self, fmi2GetInteger(reference.as_ptr(), 1, &raw mut whole))?
            }
        }
        *place = f64::from(whole);
        Ok(())
    }

    fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Called {
        let (defined, stop) = (i32::from(stop.is_some()), stop.unwrap_or(0.0));
        call!(self, fmi2SetupExperiment(0, 0.0, start, defined, stop))?;
        call!(self, fmi2EnterInitializationMode())
    }

    fn exit_initialization(&mut self) -> Called {
        call!(self, fmi2ExitInitializationMode())?;
        self.running = true;
        Ok(())
    }

    fn step(&mut self, t: f64, step: f64) -> Called {
        call!(self, fmi2DoStep(t, step, 1))
    }
}

impl Exchange for Instance {
    fn counts(&mut self) -> Result<(usize, usize), String> {
        Ok(self.counts)
    }

    fn set_time(&mut self, t: f64) -> Called {
        call!(self, fmi2SetTime(t))
    }

    fn states(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi2GetContinuousStates(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn set_states(&mut self, values: &[f64]) -> Called {
        call!(self, fmi2SetContinuousStates(values.as_ptr(), values.len()))
    }

    fn derivatives(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(self, fmi2GetDerivatives(values.as_mut_ptr(), values.len())),
        }
    }

    fn indicators(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi2GetEventIndicators(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn nominals(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi2GetNominalsOfContinuousStates(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn enter_event_mode(&mut self) -> Called {
        call!(self, fmi2EnterEventMode())
    }

    fn update(&mut self) -> Result<Updated, String> {
        let mut info = fmi2EventInfo {
            newDiscreteStatesNeeded: 0,
            terminateSimulation: 0,
            nominalsOfContinuousStatesChanged: 0,
            valuesOfContinuousStatesChanged: 0,
            nextEventTimeDefined: 0,
            nextEventTime: 0.0,
        };
        call!(self, fmi2NewDiscreteStates(&raw mut info))?;
        Ok(Updated {
            again: info.newDiscreteStatesNeeded != 0,
            terminate: info.terminateSimulation != 0,
            next: (info.nextEventTimeDefined != 0).then_some(info.nextEventTime),
        })
    }

    fn enter_continuous_mode(&mut self) -> Called {
        call!(self, fmi2EnterContinuousTimeMode())
    }

    fn completed_step(&mut self) -> Result<bool, String> {
        let (mut event, mut terminate) = (0, 0);
        call!(
            self,
            fmi2CompletedIntegratorStep(1, &raw mut event, &raw mut terminate)
        )?;
        match terminate {
            0 => Ok(event != 0),
            _ => Err("it asked to end the simulation".to_owned()),
        }
    }
}

impl Drop for Instance {
    fn drop(&mut self) {
        let functions = self.functions();
        // SAFETY: the instance is the library's own; after an error it may be freed, after a fatal one nothing may be called.
        unsafe {
            if self.dead == 0
                && self.running
                && let Ok(terminate) = &functions.fmi2Terminate
            {
                terminate(self.component);
            }
            if self.dead < 2
                && let Ok(free) = &functions.fmi2FreeInstance
            {
                free(self.component);
            }
        }
    }
}
