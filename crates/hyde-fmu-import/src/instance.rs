//! [`InProcess`]: instances in this process, and what is done at each tick.
//!
//! At the first tick parameters and inputs are set and the instance is initialised: its outputs are those of the initial
//! values. At every other tick the step from the tick before is made, with the inputs of that tick; its outputs hold from
//! now on, and the inputs of now are set for the next step.

use crate::Fmu;
use crate::description::FmuVariable;
use crate::library::{Called, Library, Slave};
use crate::log::Log;
use hyde_program::{Foreign, ForeignInstance, ForeignTick, Stopped};
use std::sync::{Arc, Mutex, PoisonError};

/// Runs an FMU in this process.
pub struct InProcess {
    fmu: Arc<Fmu>,
    library: Mutex<Option<Arc<Library>>>,
}

impl std::fmt::Debug for InProcess {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} in this process", self.fmu.file)
    }
}

impl InProcess {
    /// For an FMU; nothing is unpacked or loaded before the first instance.
    #[must_use]
    pub fn new(fmu: Arc<Fmu>) -> Self {
        Self {
            fmu,
            library: Mutex::new(None),
        }
    }

    fn library(&self) -> Result<Arc<Library>, String> {
        let mut library = self.library.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(library) = &*library {
            return Ok(library.clone());
        }
        Ok(library.insert(Arc::new(Library::load(&self.fmu)?)).clone())
    }
}

impl Foreign for InProcess {
    fn instance(&self, component: &str) -> Result<Box<dyn ForeignInstance>, Stopped> {
        let log = Log::new();
        let made = self
            .library()
            .and_then(|library| library.instance(&self.fmu, component, &log));
        match made {
            Ok(slave) => Ok(Box::new(Running {
                slave,
                fmu: self.fmu.clone(),
                log,
                stepped_to: None,
            })),
            Err(what) => Err(Stopped {
                what,
                log: log.messages(),
            }),
        }
    }
}

/// An instance in a run.
struct Running {
    slave: Box<dyn Slave>,
    fmu: Arc<Fmu>,
    log: Arc<Log>,
    /// The tick before.
    stepped_to: Option<f64>,
}

impl ForeignInstance for Running {
    fn tick(&mut self, tick: ForeignTick<'_>) -> Result<(), Stopped> {
        self.go(tick).map_err(|what| Stopped {
            what,
            log: self.log.messages(),
        })
    }
}

impl Running {
    fn go(&mut self, tick: ForeignTick<'_>) -> Called {
        let fmu = self.fmu.clone();
        let [parameters, inputs, outputs] = &fmu.interface.variables;
        match self.stepped_to {
            None => {
                self.set(&fmu, parameters, tick.parameters, true)?;
                let stop = Some(tick.stop).filter(|stop| stop.is_finite());
                self.slave.enter_initialization(tick.t, stop)?;
                self.set(&fmu, inputs, tick.inputs, false)?;
                self.slave.exit_initialization()?;
                self.get(&fmu, outputs, tick.outputs)?;
            }
            Some(before) => {
                self.slave.step(before, tick.period)?;
                self.get(&fmu, outputs, tick.outputs)?;
                self.set(&fmu, inputs, tick.inputs, false)?;
            }
        }
        self.stepped_to = Some(tick.t);
        Ok(())
    }

    /// Sets variables; those that have their start values need not be set.
    fn set(&mut self, fmu: &Fmu, list: &[usize], values: &[f64], but_starts: bool) -> Called {
        let mut rest = values;
        for &number in list {
            let variable = &fmu.description.variables[number];
            let (own, others) = rest.split_at(variable.len.unwrap_or(1).min(rest.len()));
            rest = others;
            if but_starts && has_start(variable, own) {
                continue;
            }
            let in_si = &variable.in_si;
            let values: Vec<f64> = own
                .iter()
                .map(|value| (value - in_si.offset) / in_si.factor)
                .collect();
            if let Some(wrong) = values.iter().find(|value| !value.is_finite()) {
                return Err(format!("its input `{}` would be {wrong}", variable.name));
            }
            let called = self.slave.set(variable, &values);
            called.map_err(|what| format!("{what} for `{}`", variable.name))?;
        }
        Ok(())
    }

    fn get(&mut self, fmu: &Fmu, list: &[usize], values: &mut [f64]) -> Called {
        let mut rest = values;
        for &number in list {
            let variable = &fmu.description.variables[number];
            let len = variable.len.unwrap_or(1).min(rest.len());
            let (own, others) = std::mem::take(&mut rest).split_at_mut(len);
            rest = others;
            let called = self.slave.get(variable, own);
            called.map_err(|what| format!("{what} for `{}`", variable.name))?;
            for value in own {
                *value = variable.in_si.factor * *value + variable.in_si.offset;
                if !value.is_finite() {
                    return Err(format!("its output `{}` is {value}", variable.name));
                }
            }
        }
        Ok(())
    }
}

/// Whether values are those that the variable has anyway, but for the rounding of a unit.
fn has_start(variable: &FmuVariable, values: &[f64]) -> bool {
    let in_si = &variable.in_si;
    let near = |(value, start): (&f64, &f64)| {
        let start = in_si.factor * start + in_si.offset;
        (value - start).abs() <= 4.0 * f64::EPSILON * start.abs()
    };
    variable.start.len() == values.len() && values.iter().zip(&variable.start).all(near)
}
