//! Functions of FMI 2.0 that the description does not offer: a call is an error, which the log says.

use super::on;
use crate::export::export;
use crate::handle::Status;
use fmi_sys::fmi2 as sys;
use fmi_sys::fmi2::{
    fmi2Component, fmi2Integer, fmi2Real, fmi2Status, fmi2StatusKind, fmi2String,
    fmi2ValueReference,
};
use hyde_fmi::Refusal;

/// Refuses a call; one for no variables is none.
///
/// # Safety
/// As for [`on`].
unsafe fn absent(c: fmi2Component, variables: usize, what: &str) -> fmi2Status {
    // SAFETY: by the caller's promise.
    unsafe {
        on(c, |_| match variables {
            0 => Ok(Status::Ok),
            _ => Err(Refusal::Misuse(format!("there are no {what}"))),
        })
    }
}

export! { sys::fmi2GetStringTYPE, fmi2GetString(
    c: fmi2Component, _vr: *const fmi2ValueReference, nvr: usize, _value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, nvr, "values of this type") }
} }

export! { sys::fmi2SetStringTYPE, fmi2SetString(
    c: fmi2Component, _vr: *const fmi2ValueReference, nvr: usize, _value: *const fmi2String,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, nvr, "values of this type") }
} }

export! { sys::fmi2SetRealInputDerivativesTYPE, fmi2SetRealInputDerivatives(
    c: fmi2Component, _vr: *const fmi2ValueReference, _nvr: usize, _order: *const fmi2Integer, _value: *const fmi2Real,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, 1, "derivatives of variables") }
} }

export! { sys::fmi2GetRealOutputDerivativesTYPE, fmi2GetRealOutputDerivatives(
    c: fmi2Component, _vr: *const fmi2ValueReference, _nvr: usize, _order: *const fmi2Integer, _value: *mut fmi2Real,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, 1, "derivatives of variables") }
} }

export! { sys::fmi2GetIntegerStatusTYPE, fmi2GetIntegerStatus(
    c: fmi2Component, _s: fmi2StatusKind, _value: *mut fmi2Integer,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, 1, "asynchronous steps") }
} }

export! { sys::fmi2GetStringStatusTYPE, fmi2GetStringStatus(
    c: fmi2Component, _s: fmi2StatusKind, _value: *mut fmi2String,
) -> fmi2Status {
    // SAFETY: an importer passes its instance.
    unsafe { absent(c, 1, "asynchronous steps") }
} }
