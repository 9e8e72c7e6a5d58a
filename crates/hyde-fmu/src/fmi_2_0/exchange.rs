//! Model exchange of FMI 2.0: time, states, derivatives, event indicators, events.

use super::{on, truth};
use crate::export::export;
use crate::fmi_3_0::exchange::fill;
use crate::handle::Status;
use crate::memory::{given, put, room};
use fmi_sys::fmi2 as sys;
use fmi_sys::fmi2::{fmi2Boolean, fmi2Component, fmi2EventInfo, fmi2Real, fmi2Status};
use hyde_fmi::Refusal;

export! { sys::fmi2EnterEventModeTYPE, fmi2EnterEventMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.enter_event_mode()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2NewDiscreteStatesTYPE, fmi2NewDiscreteStates(
    c: fmi2Component, fmi2eventInfo: *mut fmi2EventInfo,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and room for what it wants to know.
    unsafe { on(c, |handle| {
        let update = handle.instance.update_discrete_states()?;
        put(fmi2eventInfo, fmi2EventInfo {
            newDiscreteStatesNeeded: truth(false),
            terminateSimulation: truth(false),
            nominalsOfContinuousStatesChanged: truth(false),
            valuesOfContinuousStatesChanged: truth(update.states_changed),
            nextEventTimeDefined: truth(update.next_s.is_some()),
            nextEventTime: update.next_s.unwrap_or(f64::INFINITY),
        });
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2EnterContinuousTimeModeTYPE, fmi2EnterContinuousTimeMode(c: fmi2Component) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.enter_continuous_time_mode()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2CompletedIntegratorStepTYPE, fmi2CompletedIntegratorStep(
    c: fmi2Component, _noSetFMUStatePriorToCurrentPoint: fmi2Boolean, enterEventMode: *mut fmi2Boolean,
    terminateSimulation: *mut fmi2Boolean,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and room for what it wants to know.
    unsafe { on(c, |handle| {
        let event = handle.instance.completed_integrator_step()?;
        put(enterEventMode, truth(event));
        put(terminateSimulation, truth(false));
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2SetTimeTYPE, fmi2SetTime(c: fmi2Component, time: fmi2Real) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(c, |handle| {
        handle.instance.set_time(time)?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi2SetContinuousStatesTYPE, fmi2SetContinuousStates(
    c: fmi2Component, x: *const fmi2Real, nx: usize,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, and as many states as it says.
    unsafe {
        let states = given(x, nx);
        on(c, |handle| {
            handle.instance.set_states(states)?;
            Ok(Status::Ok)
        })
    }
} }

macro_rules! list {
    ($name:ident: $type:ident, $work:expr) => {
        export! { sys::$type, $name(c: fmi2Component, values: *mut fmi2Real, count: usize) -> fmi2Status {
            // SAFETY: an importer passes its instance, and as much room as it says.
            unsafe {
                let room = room(values, count);
                on(c, |handle| {
                    let values: Result<Vec<f64>, Refusal> = $work(&mut handle.instance);
                    fill(room, &values?)
                })
            }
        } }
    };
}

list!(
    fmi2GetContinuousStates: fmi2GetContinuousStatesTYPE,
    |instance: &mut hyde_fmi::Instance| instance.states()
);
list!(
    fmi2GetDerivatives: fmi2GetDerivativesTYPE,
    |instance: &mut hyde_fmi::Instance| instance.derivatives()
);
list!(
    fmi2GetEventIndicators: fmi2GetEventIndicatorsTYPE,
    |instance: &mut hyde_fmi::Instance| instance.event_indicators()
);
list!(
    fmi2GetNominalsOfContinuousStates: fmi2GetNominalsOfContinuousStatesTYPE,
    |instance: &mut hyde_fmi::Instance| Ok(instance.nominals())
);
