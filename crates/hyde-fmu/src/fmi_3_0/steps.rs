//! Steps of FMI 3.0, within which an importer may look on: it is called after each step of the solver, and reads values then.

use super::on;
use crate::export::export;
use crate::handle::{Status, Watch};
use crate::memory::put;
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{
    fmi3Boolean, fmi3Float64, fmi3Instance, fmi3InstanceEnvironment,
    fmi3IntermediateUpdateCallback, fmi3Status,
};
use hyde_fmi::{Arrival, Progress};
use std::rc::Rc;

/// The function of an importer for intermediate updates.
struct Callback {
    environment: fmi3InstanceEnvironment,
    callback: fmi3IntermediateUpdateCallback,
}

impl Watch for Callback {
    fn reached(&self, t: f64, early: bool) -> Option<f64> {
        let callback = self.callback?;
        let (mut wanted, mut wanted_s) = (false, t);
        // SAFETY: the importer handed the function over for this, with its environment; both places live during the call.
        unsafe {
            callback(
                self.environment,
                t,
                false,
                true,
                true,
                early,
                &raw mut wanted,
                &raw mut wanted_s,
            );
        }
        (early && wanted).then_some(wanted_s)
    }
}

/// Has an importer look on within the steps of an instance, if it has a function for it.
///
/// # Safety
/// As for [`on`].
pub(super) unsafe fn watch(
    instance: fmi3Instance,
    environment: fmi3InstanceEnvironment,
    callback: fmi3IntermediateUpdateCallback,
) {
    if instance.is_null() || callback.is_none() {
        return;
    }
    let watch = Rc::new(Callback {
        environment,
        callback,
    });
    // SAFETY: by the caller's promise.
    unsafe {
        on(instance, |handle| {
            handle.watch = Some(watch);
            Ok(Status::Ok)
        });
    }
}

export! { sys::fmi3DoStepTYPE, fmi3DoStep(
    instance: fmi3Instance, currentCommunicationPoint: fmi3Float64, communicationStepSize: fmi3Float64,
    _noSetFMUStatePriorToCurrentPoint: fmi3Boolean, eventHandlingNeeded: *mut fmi3Boolean,
    terminateSimulation: *mut fmi3Boolean, earlyReturn: *mut fmi3Boolean, lastSuccessfulTime: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, and room for what it wants to know. No call has the instance while the importer
    // looks on, which calls it in turn.
    unsafe {
        put(eventHandlingNeeded, false);
        put(terminateSimulation, false);
        put(earlyReturn, false);
        let mut watch = None;
        let mut status = on(instance, |handle| {
            watch.clone_from(&handle.watch);
            put(lastSuccessfulTime, handle.instance.t());
            handle.instance.begin_step(currentCommunicationPoint, communicationStepSize, watch.is_some())?;
            Ok(Status::Ok)
        });
        while status == Status::Ok as fmi3Status {
            let mut progress = None;
            status = on(instance, |handle| {
                let done = handle.instance.go_on();
                put(lastSuccessfulTime, handle.instance.t());
                progress = Some((done?, handle.instance.may_return_early()));
                Ok(Status::Ok)
            });
            match progress {
                Some((Progress::OnTheWay(t), early)) => {
                    let wanted = watch.as_ref().and_then(|watch| watch.reached(t, early));
                    if let Some(wanted) = wanted {
                        on(instance, |handle| {
                            handle.instance.end_step_at(wanted);
                            Ok(Status::Ok)
                        });
                    }
                }
                Some((Progress::Arrived(Arrival { t, event, early }), _)) => {
                    put(eventHandlingNeeded, event);
                    put(earlyReturn, early);
                    put(lastSuccessfulTime, t);
                    break;
                }
                None => break,
            }
        }
        status
    }
} }
