//! States of instances of FMI 2.0, to return to, and derivatives at the point where an instance is.

use super::on;
use crate::export::export;
use crate::fmi_3_0::exchange::fill;
use crate::fmi_3_0::states::numbers;
use crate::memory::{given, room};
use crate::states::{deserialize, free, restore, save, serialize};
use fmi_sys::fmi2 as sys;
use fmi_sys::fmi2::{
    fmi2Byte, fmi2Component, fmi2FMUstate, fmi2Real, fmi2Status, fmi2ValueReference,
};

export! { sys::fmi2GetFMUstateTYPE, fmi2GetFMUstate(
    c: fmi2Component, FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |handle| save(handle, FMUstate)) }
} }

export! { sys::fmi2SetFMUstateTYPE, fmi2SetFMUstate(
    c: fmi2Component, FMUstate: fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |handle| restore(handle, FMUstate)) }
} }

export! { sys::fmi2FreeFMUstateTYPE, fmi2FreeFMUstate(
    c: fmi2Component, FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |_| free(FMUstate)) }
} }

export! { sys::fmi2SerializedFMUstateSizeTYPE, fmi2SerializedFMUstateSize(
    c: fmi2Component, FMUstate: fmi2FMUstate, size: *mut usize,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |_| crate::states::size(FMUstate, size)) }
} }

export! { sys::fmi2SerializeFMUstateTYPE, fmi2SerializeFMUstate(
    c: fmi2Component, FMUstate: fmi2FMUstate, serializedState: *mut fmi2Byte, size: usize,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |_| serialize(FMUstate, room(serializedState.cast(), size))) }
} }

export! { sys::fmi2DeSerializeFMUstateTYPE, fmi2DeSerializeFMUstate(
    c: fmi2Component, serializedState: *const fmi2Byte, size: usize, FMUstate: *mut fmi2FMUstate,
) -> fmi2Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(c, |_| deserialize(given(serializedState.cast(), size), FMUstate)) }
} }

export! { sys::fmi2GetDirectionalDerivativeTYPE, fmi2GetDirectionalDerivative(
    c: fmi2Component, vUnknown_ref: *const fmi2ValueReference, nUnknown: usize, vKnown_ref: *const fmi2ValueReference,
    nKnown: usize, dvKnown: *const fmi2Real, dvUnknown: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: an importer passes its instance, as many references and seeds and as much room as it says.
    unsafe {
        let (unknowns, knowns) = (numbers(given(vUnknown_ref, nUnknown)), numbers(given(vKnown_ref, nKnown)));
        let (seed, room) = (given(dvKnown, nKnown), room(dvUnknown, nUnknown));
        on(c, |handle| {
            let found = handle.instance.directional_derivative(&unknowns, &knowns, seed)?;
            fill(room, &found)
        })
    }
} }
