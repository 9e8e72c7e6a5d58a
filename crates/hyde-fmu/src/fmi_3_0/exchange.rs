//! Model exchange of FMI 3.0: time, states, derivatives, event indicators.

use super::on;
use crate::export::export;
use crate::handle::{Outcome, Status};
use crate::memory::{given, put, room};
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{fmi3Boolean, fmi3Float64, fmi3Instance, fmi3Status};
use hyde_fmi::Refusal;

/// Copies values into an importer's room for them.
pub(crate) fn fill(room: &mut [f64], values: &[f64]) -> Outcome {
    if room.len() != values.len() {
        let text = format!(
            "there are {} values, and room for {}",
            values.len(),
            room.len()
        );
        return Err(Refusal::Misuse(text));
    }
    room.copy_from_slice(values);
    Ok(Status::Ok)
}

export! { sys::fmi3EnterContinuousTimeModeTYPE, fmi3EnterContinuousTimeMode(instance: fmi3Instance) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.enter_continuous_time_mode()?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3CompletedIntegratorStepTYPE, fmi3CompletedIntegratorStep(
    instance: fmi3Instance, _noSetFMUStatePriorToCurrentPoint: fmi3Boolean, enterEventMode: *mut fmi3Boolean,
    terminateSimulation: *mut fmi3Boolean,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and room for what it wants to know.
    unsafe { on(instance, |handle| {
        let event = handle.instance.completed_integrator_step()?;
        put(enterEventMode, event);
        put(terminateSimulation, false);
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3SetTimeTYPE, fmi3SetTime(instance: fmi3Instance, time: fmi3Float64) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { on(instance, |handle| {
        handle.instance.set_time(time)?;
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3SetContinuousStatesTYPE, fmi3SetContinuousStates(
    instance: fmi3Instance, continuousStates: *const fmi3Float64, nContinuousStates: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and as many states as it says.
    unsafe {
        let states = given(continuousStates, nContinuousStates);
        on(instance, |handle| {
            handle.instance.set_states(states)?;
            Ok(Status::Ok)
        })
    }
} }

macro_rules! list {
    ($name:ident: $type:ident, $work:expr) => {
        export! { sys::$type, $name(
            instance: fmi3Instance, values: *mut fmi3Float64, nValues: usize,
        ) -> fmi3Status {
            // SAFETY: an importer passes its instance, and as much room as it says.
            unsafe {
                let room = room(values, nValues);
                on(instance, |handle| {
                    let values: Result<Vec<f64>, Refusal> = $work(&mut handle.instance);
                    fill(room, &values?)
                })
            }
        } }
    };
}

list!(
    fmi3GetContinuousStates: fmi3GetContinuousStatesTYPE,
    |instance: &mut hyde_fmi::Instance| instance.states()
);
list!(
    fmi3GetContinuousStateDerivatives: fmi3GetContinuousStateDerivativesTYPE,
    |instance: &mut hyde_fmi::Instance| instance.derivatives()
);
list!(
    fmi3GetEventIndicators: fmi3GetEventIndicatorsTYPE,
    |instance: &mut hyde_fmi::Instance| instance.event_indicators()
);
list!(
    fmi3GetNominalsOfContinuousStates: fmi3GetNominalsOfContinuousStatesTYPE,
    |instance: &mut hyde_fmi::Instance| Ok(instance.nominals())
);

export! { sys::fmi3GetNumberOfContinuousStatesTYPE, fmi3GetNumberOfContinuousStates(
    instance: fmi3Instance, nContinuousStates: *mut usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and room for the number.
    unsafe { on(instance, |handle| {
        put(nContinuousStates, handle.model().interface.states.len());
        Ok(Status::Ok)
    }) }
} }

export! { sys::fmi3GetNumberOfEventIndicatorsTYPE, fmi3GetNumberOfEventIndicators(
    instance: fmi3Instance, nEventIndicators: *mut usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and room for the number.
    unsafe { on(instance, |handle| {
        put(nEventIndicators, handle.model().interface.guards.len());
        Ok(Status::Ok)
    }) }
} }
