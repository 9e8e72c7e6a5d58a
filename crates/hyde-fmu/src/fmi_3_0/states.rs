//! States of instances of FMI 3.0, to return to, and derivatives at the point where an instance is.

use super::exchange::fill;
use super::on;
use crate::export::export;
use crate::memory::{given, room};
use crate::states::{deserialize, free, restore, save, serialize};
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{
    fmi3Byte, fmi3FMUState, fmi3Float64, fmi3Instance, fmi3Status, fmi3ValueReference,
};

/// Value references as numbers of variables.
pub(crate) fn numbers(references: &[u32]) -> Vec<usize> {
    references
        .iter()
        .map(|&reference| reference as usize)
        .collect()
}

export! { sys::fmi3GetFMUStateTYPE, fmi3GetFMUState(
    instance: fmi3Instance, FMUState: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |handle| save(handle, FMUState)) }
} }

export! { sys::fmi3SetFMUStateTYPE, fmi3SetFMUState(
    instance: fmi3Instance, FMUState: fmi3FMUState,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |handle| restore(handle, FMUState)) }
} }

export! { sys::fmi3FreeFMUStateTYPE, fmi3FreeFMUState(
    instance: fmi3Instance, FMUState: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |_| free(FMUState)) }
} }

export! { sys::fmi3SerializedFMUStateSizeTYPE, fmi3SerializedFMUStateSize(
    instance: fmi3Instance, FMUState: fmi3FMUState, size: *mut usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |_| crate::states::size(FMUState, size)) }
} }

export! { sys::fmi3SerializeFMUStateTYPE, fmi3SerializeFMUState(
    instance: fmi3Instance, FMUState: fmi3FMUState, serializedState: *mut fmi3Byte, size: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |_| serialize(FMUState, room(serializedState, size))) }
} }

export! { sys::fmi3DeserializeFMUStateTYPE, fmi3DeserializeFMUState(
    instance: fmi3Instance, serializedState: *const fmi3Byte, size: usize, FMUState: *mut fmi3FMUState,
) -> fmi3Status {
    // SAFETY: an importer passes its instance and its states.
    unsafe { on(instance, |_| deserialize(given(serializedState, size), FMUState)) }
} }

export! { sys::fmi3GetDirectionalDerivativeTYPE, fmi3GetDirectionalDerivative(
    instance: fmi3Instance, unknowns: *const fmi3ValueReference, nUnknowns: usize, knowns: *const fmi3ValueReference,
    nKnowns: usize, seed: *const fmi3Float64, nSeed: usize, sensitivity: *mut fmi3Float64, nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, as many references and seeds and as much room as it says.
    unsafe {
        let (unknowns, knowns) = (numbers(given(unknowns, nUnknowns)), numbers(given(knowns, nKnowns)));
        let (seed, sensitivity) = (given(seed, nSeed), room(sensitivity, nSensitivity));
        on(instance, |handle| {
            let found = handle.instance.directional_derivative(&unknowns, &knowns, seed)?;
            fill(sensitivity, &found)
        })
    }
} }

export! { sys::fmi3GetAdjointDerivativeTYPE, fmi3GetAdjointDerivative(
    instance: fmi3Instance, unknowns: *const fmi3ValueReference, nUnknowns: usize, knowns: *const fmi3ValueReference,
    nKnowns: usize, seed: *const fmi3Float64, nSeed: usize, sensitivity: *mut fmi3Float64, nSensitivity: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance, as many references and seeds and as much room as it says.
    unsafe {
        let (unknowns, knowns) = (numbers(given(unknowns, nUnknowns)), numbers(given(knowns, nKnowns)));
        let (seed, sensitivity) = (given(seed, nSeed), room(sensitivity, nSensitivity));
        on(instance, |handle| {
            let found = handle.instance.adjoint_derivative(&unknowns, &knowns, seed)?;
            fill(sensitivity, &found)
        })
    }
} }
