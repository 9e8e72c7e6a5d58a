//! Functions of FMI 3.0 that the description does not offer: a call is an error, which the log says.

use super::on;
use crate::export::export;
use crate::handle::Status;
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{
    fmi3Binary, fmi3Boolean, fmi3Clock, fmi3DependencyKind, fmi3Float32, fmi3Float64, fmi3Instance,
    fmi3Int8, fmi3Int16, fmi3Int32, fmi3Int64, fmi3IntervalQualifier, fmi3Status, fmi3String,
    fmi3UInt8, fmi3UInt16, fmi3UInt32, fmi3UInt64, fmi3ValueReference,
};
use hyde_fmi::Refusal;

/// Refuses a call; one for no variables is none.
///
/// # Safety
/// As for [`on`].
unsafe fn absent(instance: fmi3Instance, variables: usize, what: &str) -> fmi3Status {
    // SAFETY: by the caller's promise.
    unsafe {
        on(instance, |_| match variables {
            0 => Ok(Status::Ok),
            _ => Err(Refusal::Misuse(format!("there are no {what}"))),
        })
    }
}

export! { sys::fmi3InstantiateScheduledExecutionTYPE, fmi3InstantiateScheduledExecution(
    _instanceName: fmi3String, _instantiationToken: fmi3String, _resourcePath: fmi3String, _visible: fmi3Boolean,
    _loggingOn: fmi3Boolean, _instanceEnvironment: sys::fmi3InstanceEnvironment, _logMessage: sys::fmi3LogMessageCallback,
    _clockUpdate: sys::fmi3ClockUpdateCallback, _lockPreemption: sys::fmi3LockPreemptionCallback,
    _unlockPreemption: sys::fmi3UnlockPreemptionCallback,
) -> fmi3Instance {
    std::ptr::null_mut()
} }

export! { sys::fmi3GetFloat32TYPE, fmi3GetFloat32(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3Float32, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetFloat32TYPE, fmi3SetFloat32(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3Float32, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetInt8TYPE, fmi3GetInt8(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3Int8, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetInt8TYPE, fmi3SetInt8(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3Int8, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetUInt8TYPE, fmi3GetUInt8(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3UInt8, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetUInt8TYPE, fmi3SetUInt8(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3UInt8, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetInt16TYPE, fmi3GetInt16(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3Int16, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetInt16TYPE, fmi3SetInt16(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3Int16, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetUInt16TYPE, fmi3GetUInt16(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3UInt16, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetUInt16TYPE, fmi3SetUInt16(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3UInt16, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetUInt32TYPE, fmi3GetUInt32(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3UInt32, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetUInt32TYPE, fmi3SetUInt32(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3UInt32, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetInt64TYPE, fmi3GetInt64(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3Int64, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetInt64TYPE, fmi3SetInt64(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3Int64, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetUInt64TYPE, fmi3GetUInt64(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3UInt64, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetUInt64TYPE, fmi3SetUInt64(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3UInt64, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetStringTYPE, fmi3GetString(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3String, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetStringTYPE, fmi3SetString(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3String, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetBinaryTYPE, fmi3GetBinary(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _valueSizes: *mut usize, _values: *mut fmi3Binary, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetBinaryTYPE, fmi3SetBinary(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _valueSizes: *const usize, _values: *const fmi3Binary, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetClockTYPE, fmi3GetClock(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *mut fmi3Clock,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3SetClockTYPE, fmi3SetClock(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, nValueReferences: usize, _values: *const fmi3Clock,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, nValueReferences, "values of this type") }
} }

export! { sys::fmi3GetNumberOfVariableDependenciesTYPE, fmi3GetNumberOfVariableDependencies(
    instance: fmi3Instance, _valueReference: fmi3ValueReference, _nDependencies: *mut usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "dependencies of variables") }
} }

export! { sys::fmi3GetVariableDependenciesTYPE, fmi3GetVariableDependencies(
    instance: fmi3Instance, _dependent: fmi3ValueReference, _elementIndicesOfDependent: *mut usize, _independents: *mut fmi3ValueReference, _elementIndicesOfIndependents: *mut usize, _dependencyKinds: *mut fmi3DependencyKind, _nDependencies: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "dependencies of variables") }
} }

export! { sys::fmi3GetOutputDerivativesTYPE, fmi3GetOutputDerivatives(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _orders: *const fmi3Int32, _values: *mut fmi3Float64, _nValues: usize,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "derivatives of variables") }
} }

export! { sys::fmi3EnterConfigurationModeTYPE, fmi3EnterConfigurationMode(
    instance: fmi3Instance,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "structural parameters") }
} }

export! { sys::fmi3ExitConfigurationModeTYPE, fmi3ExitConfigurationMode(
    instance: fmi3Instance,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "structural parameters") }
} }

export! { sys::fmi3GetIntervalDecimalTYPE, fmi3GetIntervalDecimal(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _intervals: *mut fmi3Float64, _qualifiers: *mut fmi3IntervalQualifier,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3GetIntervalFractionTYPE, fmi3GetIntervalFraction(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _counters: *mut fmi3UInt64, _resolutions: *mut fmi3UInt64, _qualifiers: *mut fmi3IntervalQualifier,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3GetShiftDecimalTYPE, fmi3GetShiftDecimal(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _shifts: *mut fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3GetShiftFractionTYPE, fmi3GetShiftFraction(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _counters: *mut fmi3UInt64, _resolutions: *mut fmi3UInt64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3SetIntervalDecimalTYPE, fmi3SetIntervalDecimal(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _intervals: *const fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3SetIntervalFractionTYPE, fmi3SetIntervalFraction(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _counters: *const fmi3UInt64, _resolutions: *const fmi3UInt64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3SetShiftDecimalTYPE, fmi3SetShiftDecimal(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _shifts: *const fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3SetShiftFractionTYPE, fmi3SetShiftFraction(
    instance: fmi3Instance, _valueReferences: *const fmi3ValueReference, _nValueReferences: usize, _counters: *const fmi3UInt64, _resolutions: *const fmi3UInt64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }

export! { sys::fmi3ActivateModelPartitionTYPE, fmi3ActivateModelPartition(
    instance: fmi3Instance, _clockReference: fmi3ValueReference, _activationTime: fmi3Float64,
) -> fmi3Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(instance, 1, "clocks") }
} }
