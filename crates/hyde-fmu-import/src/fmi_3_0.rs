//! An instance of FMI 3.0; for co-simulation without event mode: the FMU handles its events inside a step.
#![allow(unsafe_code, reason = "the functions are those of a foreign library")]

use crate::Fmu;
use crate::description::{FmuVariable, Numbers, Use};
use crate::exchange::{Exchange, Updated};
use crate::library::{Called, Functions, Library, Slave, checked, whole};
use crate::log::{Log, logged_in_fmi_3};
use fmi_sys::fmi3::{Fmi3Binding, fmi3Instance};
use std::ffi::CString;
use std::sync::Arc;

/// Calls a function that a library need not have.
macro_rules! call {
    ($self:ident, $name:ident ( $($argument:expr),* )) => {{
        let Ok(function) = &$self.functions().$name else {
            return Err(format!("the library has no function `{}`", stringify!($name)));
        };
        // SAFETY: the function has the type of the standard; the instance is the one it made and is not freed; pointers
        // hold for the call and point to as many values as are said.
        let status = unsafe { function($self.instance, $($argument),*) };
        checked(stringify!($name), status, &mut $self.dead)
    }};
}

/// Sets numbers of one type.
macro_rules! set {
    ($self:ident, $variable:ident, $values:ident, $name:ident, $convert:expr) => {{
        let reference = [$variable.reference];
        let values: Vec<_> = $values
            .iter()
            .map($convert)
            .collect::<Result<_, String>>()?;
        call!(
            $self,
            $name(reference.as_ptr(), 1, values.as_ptr(), values.len())
        )
    }};
}

/// Reads numbers of one type.
macro_rules! get {
    ($self:ident, $variable:ident, $values:ident, $name:ident, $zero:expr) => {{
        let reference = [$variable.reference];
        let mut read = vec![$zero; $values.len()];
        call!(
            $self,
            $name(reference.as_ptr(), 1, read.as_mut_ptr(), read.len())
        )?;
        for (place, value) in $values.iter_mut().zip(read) {
            *place = value as f64;
        }
        Ok(())
    }};
}

/// The instance with what its library points to.
pub(crate) struct Instance {
    instance: fmi3Instance,
    library: Arc<Library>,
    _log: Arc<Log>,
    dead: u8,
    running: bool,
}

// SAFETY: an instance may be called from any thread as long as one calls at a time, which `&mut self` holds.
unsafe impl Send for Instance {}

impl Instance {
    pub(crate) fn new(
        library: &Arc<Library>,
        fmu: &Fmu,
        name: &str,
        log: &Arc<Log>,
    ) -> Result<Self, String> {
        let Functions::Three(functions) = &library.functions else {
            return Err("the library is not one of FMI 3.0".to_owned());
        };
        let text = |text: &str| CString::new(text).map_err(|error| error.to_string());
        let resources = format!("{}/", library.folder.file("resources").display());
        let (name, token, resources) = (
            text(name)?,
            text(&fmu.description.token)?,
            text(&resources)?,
        );
        let missing = |name: &str| format!("the library has no function `{name}`");
        let (name, token) = (name.as_ptr(), token.as_ptr());
        let (resources, environment) = (resources.as_ptr(), log.environment());
        let logger = Some(logged_in_fmi_3 as _);
        let (instance, function) = match fmu.description.used {
            Use::CoSimulation => {
                let function = "fmi3InstantiateCoSimulation";
                let Ok(instantiate) = &functions.fmi3InstantiateCoSimulation else {
                    return Err(missing(function));
                };
                let none = std::ptr::null();
                // SAFETY: the strings hold for the call, the log as long as the instance.
                let instance = unsafe {
                    instantiate(
                        name,
                        token,
                        resources,
                        false,
                        true,
                        false,
                        false,
                        none,
                        0,
                        environment,
                        logger,
                        None,
                    )
                };
                (instance, function)
            }
            Use::ModelExchange => {
                let function = "fmi3InstantiateModelExchange";
                let Ok(instantiate) = &functions.fmi3InstantiateModelExchange else {
                    return Err(missing(function));
                };
                // SAFETY: the strings hold for the call, the log as long as the instance.
                let instance = unsafe {
                    instantiate(name, token, resources, false, true, environment, logger)
                };
                (instance, function)
            }
        };
        if instance.is_null() {
            return Err(format!("`{function}` gave no instance"));
        }
        Ok(Self {
            instance,
            library: library.clone(),
            _log: log.clone(),
            dead: 0,
            running: false,
        })
    }

    #[allow(
        clippy::unreachable,
        reason = "an instance is made of a library of its own version alone"
    )]
    fn functions(&self) -> &Fmi3Binding {
        match &self.library.functions {
            Functions::Three(functions) => functions,
            Functions::Two(_) => unreachable!(),
        }
    }
}

impl Slave for Instance {
    fn set(&mut self, v: &FmuVariable, values: &[f64]) -> Called {
        match v.numbers {
            Numbers::Float64 => set!(self, v, values, fmi3SetFloat64, |&x| Ok(x)),
            Numbers::Float32 => set!(self, v, values, fmi3SetFloat32, |&x| Ok(x as f32)),
            Numbers::Int8 => set!(self, v, values, fmi3SetInt8, |&x| whole::<i8>(v, x)),
            Numbers::UInt8 => set!(self, v, values, fmi3SetUInt8, |&x| whole::<u8>(v, x)),
            Numbers::Int16 => set!(self, v, values, fmi3SetInt16, |&x| whole::<i16>(v, x)),
            Numbers::UInt16 => set!(self, v, values, fmi3SetUInt16, |&x| whole::<u16>(v, x)),
            Numbers::Int32 => set!(self, v, values, fmi3SetInt32, |&x| whole::<i32>(v, x)),
            Numbers::UInt32 => set!(self, v, values, fmi3SetUInt32, |&x| whole::<u32>(v, x)),
            Numbers::Int64 => set!(self, v, values, fmi3SetInt64, |&x| whole::<i64>(v, x)),
            Numbers::UInt64 => set!(self, v, values, fmi3SetUInt64, |&x| whole::<u64>(v, x)),
            Numbers::Boolean => set!(self, v, values, fmi3SetBoolean, |&x| Ok(x != 0.0)),
        }
    }

    fn get(&mut self, v: &FmuVariable, values: &mut [f64]) -> Called {
        match v.numbers {
            Numbers::Float64 => get!(self, v, values, fmi3GetFloat64, 0.0_f64),
            Numbers::Float32 => get!(self, v, values, fmi3GetFloat32, 0.0_f32),
            Numbers::Int8 => get!(self, v, values, fmi3GetInt8, 0_i8),
            Numbers::UInt8 => get!(self, v, values, fmi3GetUInt8, 0_u8),
            Numbers::Int16 => get!(self, v, values, fmi3GetInt16, 0_i16),
            Numbers::UInt16 => get!(self, v, values, fmi3GetUInt16, 0_u16),
            Numbers::Int32 => get!(self, v, values, fmi3GetInt32, 0_i32),
            Numbers::UInt32 => get!(self, v, values, fmi3GetUInt32, 0_u32),
            Numbers::Int64 => get!(self, v, values, fmi3GetInt64, 0_i64),
            Numbers::UInt64 => get!(self, v, values, fmi3GetUInt64, 0_u64),
            Numbers::Boolean => {
                // As bytes: a library may write other truths than 1.
                let (reference, mut read) = ([v.reference], vec![0_u8; values.len()]);
                let places = read.as_mut_ptr().cast::<bool>();
                call!(
                    self,
                    fmi3GetBoolean(reference.as_ptr(), 1, places, values.len())
                )?;
                for (place, value) in values.iter_mut().zip(read) {
                    *place = f64::from(u8::from(value != 0));
                }
                Ok(())
            }
        }
    }

    fn enter_initialization(&mut self, start: f64, stop: Option<f64>) -> Called {
        let (defined, stop) = (stop.is_some(), stop.unwrap_or(0.0));
        call!(
            self,
            fmi3EnterInitializationMode(false, 0.0, start, defined, stop)
        )
    }

    fn exit_initialization(&mut self) -> Called {
        call!(self, fmi3ExitInitializationMode())?;
        self.running = true;
        Ok(())
    }

    fn step(&mut self, t: f64, step: f64) -> Called {
        let (mut event, mut terminate, mut early, mut reached) = (0_u8, 0_u8, 0_u8, t);
        call!(
            self,
            fmi3DoStep(
                t,
                step,
                true,
                (&raw mut event).cast(),
                (&raw mut terminate).cast(),
                (&raw mut early).cast(),
                &raw mut reached
            )
        )?;
        let at = hyde_units::significant(reached, 7);
        if terminate != 0 {
            return Err(format!("it asked to end the simulation at {at} s"));
        }
        if early != 0 {
            return Err(format!(
                "it ended its step at {at} s, which it was not allowed to"
            ));
        }
        Ok(())
    }
}

impl Exchange for Instance {
    fn counts(&mut self) -> Result<(usize, usize), String> {
        let (mut states, mut indicators) = (0, 0);
        call!(self, fmi3GetNumberOfContinuousStates(&raw mut states))?;
        call!(self, fmi3GetNumberOfEventIndicators(&raw mut indicators))?;
        Ok((states, indicators))
    }

    fn set_time(&mut self, t: f64) -> Called {
        call!(self, fmi3SetTime(t))
    }

    fn states(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi3GetContinuousStates(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn set_states(&mut self, values: &[f64]) -> Called {
        call!(self, fmi3SetContinuousStates(values.as_ptr(), values.len()))
    }

    fn derivatives(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi3GetContinuousStateDerivatives(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn indicators(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi3GetEventIndicators(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn nominals(&mut self, values: &mut [f64]) -> Called {
        match values.is_empty() {
            true => Ok(()),
            false => call!(
                self,
                fmi3GetNominalsOfContinuousStates(values.as_mut_ptr(), values.len())
            ),
        }
    }

    fn enter_event_mode(&mut self) -> Called {
        call!(self, fmi3EnterEventMode())
    }

    fn update(&mut self) -> Result<Updated, String> {
        // As bytes: a library may write other truths than 1.
        let (mut again, mut terminate, mut defined) = (0_u8, 0_u8, 0_u8);
        let (mut nominals, mut values, mut next) = (0_u8, 0_u8, 0.0);
        call!(
            self,
            fmi3UpdateDiscreteStates(
                (&raw mut again).cast(),
                (&raw mut terminate).cast(),
                (&raw mut nominals).cast(),
                (&raw mut values).cast(),
                (&raw mut defined).cast(),
                &raw mut next
            )
        )?;
        Ok(Updated {
            again: again != 0,
            terminate: terminate != 0,
            next: (defined != 0).then_some(next),
        })
    }

    fn enter_continuous_mode(&mut self) -> Called {
        call!(self, fmi3EnterContinuousTimeMode())
    }

    fn completed_step(&mut self) -> Result<bool, String> {
        let (mut event, mut terminate) = (0_u8, 0_u8);
        call!(
            self,
            fmi3CompletedIntegratorStep(true, (&raw mut event).cast(), (&raw mut terminate).cast())
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
                && let Ok(terminate) = &functions.fmi3Terminate
            {
                terminate(self.instance);
            }
            if self.dead < 2
                && let Ok(free) = &functions.fmi3FreeInstance
            {
                free(self.instance);
            }
        }
    }
}
