//! FMI 3.0: the life of an instance and its events.

mod absent;
pub(crate) mod exchange;
pub(crate) mod states;
mod steps;
pub(crate) mod values;

use crate::export::export;
use crate::handle::{Handle, Log, Outcome, Status, c_text, constant};
use crate::memory::{given, put, text};
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{
    fmi3Boolean, fmi3Float64, fmi3Instance, fmi3InstanceEnvironment,
    fmi3IntermediateUpdateCallback, fmi3LogMessageCallback, fmi3Status, fmi3String,
    fmi3ValueReference,
};
use hyde_fmi::Use;
use std::path::Path;

/// The log of an importer.
struct Callback {
    environment: fmi3InstanceEnvironment,
    callback: fmi3LogMessageCallback,
}

impl Log for Callback {
    fn log(&self, status: Status, category: &str, message: &str) {
        if let Some(callback) = self.callback {
            let (category, message) = (c_text(category), c_text(message));
            // SAFETY: the importer handed the function over for this, with its environment; the texts live during the call.
            unsafe {
                callback(
                    self.environment,
                    status as fmi3Status,
                    category.as_ptr(),
                    message.as_ptr(),
                );
            }
        }
    }
}

/// Works on an instance.
///
/// # Safety
/// As for [`Handle::on`].
pub(crate) unsafe fn on(
    instance: fmi3Instance,
    work: impl FnOnce(&mut Handle) -> Outcome,
) -> fmi3Status {
    // SAFETY: by the caller's promise.
    unsafe { Handle::on(instance, work) as fmi3Status }
}

export! { sys::fmi3GetVersionTYPE, fmi3GetVersion() -> fmi3String {
    constant(c"3.0")
} }

export! { sys::fmi3SetDebugLoggingTYPE, fmi3SetDebugLogging(
    instance: fmi3Instance, loggingOn: fmi3Boolean, nCategories: usize, categories: *const fmi3String,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and as many texts as it says.
    unsafe {
        let categories = given(categories, nCategories);
        let categories = categories.iter().map(|category| text(*category)).collect();
        on(instance, |handle| {
            handle.set_logging(loggingOn, categories);
            Ok(Status::Ok)
        })
    }
} }

export! { sys::fmi3InstantiateModelExchangeTYPE, fmi3InstantiateModelExchange(
    _instanceName: fmi3String, instantiationToken: fmi3String, resourcePath: fmi3String, _visible: fmi3Boolean,
    loggingOn: fmi3Boolean, instanceEnvironment: fmi3InstanceEnvironment, logMessage: fmi3LogMessageCallback,
) -> fmi3Instance {
    // SAFETY: an importer passes texts that end.
    let (token, resources) = unsafe { (text(instantiationToken), text(resourcePath)) };
    let log = Callback { environment: instanceEnvironment, callback: logMessage };
    let of = (token.as_str(), Path::new(&resources));
    Handle::create(Box::new(log), loggingOn, of, Use::ModelExchange)
} }

export! { sys::fmi3InstantiateCoSimulationTYPE, fmi3InstantiateCoSimulation(
    _instanceName: fmi3String, instantiationToken: fmi3String, resourcePath: fmi3String, _visible: fmi3Boolean,
    loggingOn: fmi3Boolean, eventModeUsed: fmi3Boolean, earlyReturnAllowed: fmi3Boolean,
    _requiredIntermediateVariables: *const fmi3ValueReference, _nRequiredIntermediateVariables: usize,
    instanceEnvironment: fmi3InstanceEnvironment, logMessage: fmi3LogMessageCallback,
    intermediateUpdate: fmi3IntermediateUpdateCallback,
) -> fmi3Instance {
    // SAFETY: an importer passes texts that end.
    let (token, resources) = unsafe { (text(instantiationToken), text(resourcePath)) };
    let log = Callback { environment: instanceEnvironment, callback: logMessage };
    let of = (token.as_str(), Path::new(&resources));
    let used = Use::CoSimulation { event_mode: eventModeUsed, early_return: earlyReturnAllowed };
    let instance = Handle::create(Box::new(log), loggingOn, of, used);
    // SAFETY: it has just been made, or is null.
    unsafe { steps::watch(instance, instanceEnvironment, intermediateUpdate) };
    instance
} }

export! { sys::fmi3FreeInstanceTYPE, fmi3FreeInstance(instance: fmi3Instance) {
    // SAFETY: an importer passes its instance, for the last time.
    unsafe { Handle::free(instance) }
} }

export! { sys::fmi3EnterInitializationModeTYPE, fmi3EnterInitializationMode(
    instance: fmi3Instance, toleranceDefined: fmi3Boolean, tolerance: fmi3Float64, startTime: fmi3Float64,
    stopTimeDefined: fmi3Boolean, stopTime: fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        let stop = stopTimeDefined.then_some(stopTime);
        let tolerance = toleranceDefined.then_some(tolerance);
        handle.instance.set_up(startTime, stop, tolerance)?;
        handle.instance.enter_initialization()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3ExitInitializationModeTYPE, fmi3ExitInitializationMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.exit_initialization()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3EnterEventModeTYPE, fmi3EnterEventMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.enter_event_mode()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3TerminateTYPE, fmi3Terminate(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.terminate();
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3ResetTYPE, fmi3Reset(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.reset();
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3UpdateDiscreteStatesTYPE, fmi3UpdateDiscreteStates(
    instance: fmi3Instance, discreteStatesNeedUpdate: *mut fmi3Boolean, terminateSimulation: *mut fmi3Boolean,
    nominalsOfContinuousStatesChanged: *mut fmi3Boolean, valuesOfContinuousStatesChanged: *mut fmi3Boolean,
    nextEventTimeDefined: *mut fmi3Boolean, nextEventTime: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and room for what it wants to know.
    unsafe { on(instance, |handle| {
        let update = handle.instance.update_discrete_states()?;
        put(discreteStatesNeedUpdate, false);
        put(terminateSimulation, false);
        put(nominalsOfContinuousStatesChanged, false);
        put(valuesOfContinuousStatesChanged, update.states_changed);
        put(nextEventTimeDefined, update.next_s.is_some());
        put(nextEventTime, update.next_s.unwrap_or(f64::INFINITY));
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3EvaluateDiscreteStatesTYPE, fmi3EvaluateDiscreteStates(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |_| Ok(Status::Ok)) }
} }

export! { sys::fmi3EnterStepModeTYPE, fmi3EnterStepMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.enter_step_mode()?;
        Ok(Status::Ok)
    }) }
} }
