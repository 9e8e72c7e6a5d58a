//! FMI 2.0: the life of an instance, its values, its steps.

mod absent;
mod exchange;
mod states;

use crate::export::export;
use crate::fmi_3_0::values::{get, set};
use crate::handle::{Handle, Log, Outcome, Status, c_text, constant};
use crate::memory::{given, put, room, text};
use crate::models::folder_of;
use fmi_sys::fmi2 as sys;
use fmi_sys::fmi2::{
    fmi2Boolean, fmi2CallbackFunctions, fmi2CallbackLogger, fmi2Component,
    fmi2ComponentEnvironment, fmi2Integer, fmi2Real, fmi2Status, fmi2StatusKind, fmi2String,
    fmi2Type, fmi2ValueReference,
};
use hyde_fmi::{Kind, Refusal, Use};
use std::ffi::CString;

/// The log of an importer.
struct Callback {
    environment: fmi2ComponentEnvironment,
    name: CString,
    callback: fmi2CallbackLogger,
}

impl Log for Callback {
    fn log(&self, status: Status, category: &str, message: &str) {
        if let Some(callback) = self.callback {
            let (category, message) = (c_text(category), c_text(message));
            // SAFETY: the importer handed the function over for this, with its environment; the texts live during the call,
            // and the format takes the one text behind it.
            unsafe {
                callback(
                    self.environment,
                    self.name.as_ptr(),
                    status as fmi2Status,
                    category.as_ptr(),
                    c"%s".as_ptr(),
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
pub(crate) unsafe fn on(c: fmi2Component, work: impl FnOnce(&mut Handle) -> Outcome) -> fmi2Status {
    // SAFETY: by the caller's promise.
    unsafe { Handle::on(c, work) as fmi2Status }
}

/// A truth as C has it.
pub(crate) fn truth(value: bool) -> fmi2Boolean {
    fmi2Boolean::from(value)
}

export! { sys::fmi2GetTypesPlatformTYPE, fmi2GetTypesPlatform() -> fmi2String {
    constant(c"default")
} }

export! { sys::fmi2GetVersionTYPE, fmi2GetVersion() -> fmi2String {
    constant(c"2.0")
} }

export! { sys::fmi2SetDebugLoggingTYPE, fmi2SetDebugLogging(
    c: fmi2Component, loggingOn: fmi2Boolean, nCategories: usize, categories: *const fmi2String,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and as many texts as it says.
    unsafe {
        let categories = given(categories, nCategories);
        let categories = categories.iter().map(|category| text(*category)).collect();
        on(c, |handle| {
            handle.set_logging(loggingOn != 0, categories);
            Ok(Status::Ok)
        })
    }
} }

export! { sys::fmi2InstantiateTYPE, fmi2Instantiate(
    instanceName: fmi2String, fmuType: fmi2Type, fmuGUID: fmi2String, fmuResourceLocation: fmi2String,
    functions: *const fmi2CallbackFunctions, _visible: fmi2Boolean, loggingOn: fmi2Boolean,
) -> fmi2Component {
    // SAFETY: an importer passes texts that end, and a table of functions that outlives the instance.
    let (name, token, location, functions) = unsafe {
        (text(instanceName), text(fmuGUID), text(fmuResourceLocation), functions.as_ref())
    };
    let log = Callback {
        environment: functions.map_or(std::ptr::null_mut(), |own| own.componentEnvironment),
        name: c_text(&name),
        callback: functions.and_then(|own| own.logger),
    };
    let used = match fmuType {
        sys::fmi2Type_fmi2ModelExchange => Use::ModelExchange,
        _ => Use::CoSimulation { event_mode: false, early_return: false },
    };
    Handle::create(Box::new(log), loggingOn != 0, (&token, &folder_of(&location)), used)
} }

export! { sys::fmi2FreeInstanceTYPE, fmi2FreeInstance(c: fmi2Component) {
    // SAFETY: an importer passes its instance, for the last time.
    unsafe { Handle::free(c) }
} }

export! { sys::fmi2SetupExperimentTYPE, fmi2SetupExperiment(
    c: fmi2Component, toleranceDefined: fmi2Boolean, tolerance: fmi2Real, startTime: fmi2Real,
    stopTimeDefined: fmi2Boolean, stopTime: fmi2Real,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        let stop = (stopTimeDefined != 0).then_some(stopTime);
        let tolerance = (toleranceDefined != 0).then_some(tolerance);
        handle.instance.set_up(startTime, stop, tolerance)?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2EnterInitializationModeTYPE, fmi2EnterInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.enter_initialization()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2ExitInitializationModeTYPE, fmi2ExitInitializationMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.exit_initialization()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2TerminateTYPE, fmi2Terminate(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.terminate();
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2ResetTYPE, fmi2Reset(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.reset();
        Ok(Status::Ok)
    }) }
} }

macro_rules! values {
    ($get:ident: $get_type:ident, $set:ident: $set_type:ident, $of:ty, $kind:expr, $from:expr, $into:expr) => {
        export! { sys::$get_type, $get(
            c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *mut $of,
        ) -> fmi2Status {
            // SAFETY: an importer passes its instance, as many references and as much room as it says.
            unsafe {
                let (references, values) = (given(vr, nvr), room(value, nvr));
                on(c, |handle| get(handle, $kind, references, values, $from))
            }
        } }

        export! { sys::$set_type, $set(
            c: fmi2Component, vr: *const fmi2ValueReference, nvr: usize, value: *const $of,
        ) -> fmi2Status {
            // SAFETY: an importer passes its instance, as many references and values as it says.
            unsafe {
                let (references, values) = (given(vr, nvr), given(value, nvr));
                on(c, |handle| set(handle, $kind, references, values, $into))
            }
        } }
    };
}

values!(
    fmi2GetReal: fmi2GetRealTYPE,
    fmi2SetReal: fmi2SetRealTYPE,
    fmi2Real,
    Kind::Real,
    |value| value,
    |value| value
);
values!(
    fmi2GetInteger: fmi2GetIntegerTYPE,
    fmi2SetInteger: fmi2SetIntegerTYPE,
    fmi2Integer,
    Kind::Integer,
    |value| value as fmi2Integer,
    f64::from
);
values!(
    fmi2GetBoolean: fmi2GetBooleanTYPE,
    fmi2SetBoolean: fmi2SetBooleanTYPE,
    fmi2Boolean,
    Kind::Boolean,
    |value| truth(value != 0.0),
    |value: fmi2Boolean| f64::from(u8::from(value != 0))
);

export! { sys::fmi2DoStepTYPE, fmi2DoStep(
    c: fmi2Component, currentCommunicationPoint: fmi2Real, communicationStepSize: fmi2Real,
    _noSetFMUStatePriorToCurrentPoint: fmi2Boolean,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        let done = handle.instance.do_step(currentCommunicationPoint, communicationStepSize);
        handle.last_successful_s = handle.instance.t();
        handle.last_successful_s = done?.t;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2CancelStepTYPE, fmi2CancelStep(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |_| Err(Refusal::Misuse("no step is under way".to_owned()))) }
} }

export! { sys::fmi2GetStatusTYPE, fmi2GetStatus(
    c: fmi2Component, _s: fmi2StatusKind, value: *mut fmi2Status,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and room for the status.
    unsafe { on(c, |_| {
        put(value, sys::fmi2Status_fmi2OK);
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2GetRealStatusTYPE, fmi2GetRealStatus(
    c: fmi2Component, s: fmi2StatusKind, value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and room for the time.
    unsafe { on(c, |handle| {
        if s != sys::fmi2StatusKind_fmi2LastSuccessfulTime {
            return Err(Refusal::Misuse("the time of the last step is the only number".to_owned()));
        }
        put(value, handle.last_successful_s);
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2GetBooleanStatusTYPE, fmi2GetBooleanStatus(
    c: fmi2Component, _s: fmi2StatusKind, value: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and room for the truth.
    unsafe { on(c, |_| {
        put(value, truth(false));
        Ok(Status::Ok)
    }) }
} }
