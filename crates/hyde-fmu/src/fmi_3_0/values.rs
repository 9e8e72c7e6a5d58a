//! Values of FMI 3.0: numbers, whole numbers and truths. There are no variables of other types.

use super::on;
use crate::export::export;
use crate::handle::{Handle, Outcome, Status};
use crate::memory::{given, room};
use fmi_sys::fmi3 as sys;
use fmi_sys::fmi3::{
    fmi3Boolean, fmi3Float64, fmi3Instance, fmi3Int32, fmi3Status, fmi3ValueReference,
};
use hyde_fmi::{Kind, Refusal};

/// Reads variables of a kind.
pub(crate) fn get<T>(
    handle: &mut Handle,
    kind: Kind,
    references: &[u32],
    values: &mut [T],
    of: impl Fn(f64) -> T,
) -> Outcome {
    same_count(references.len(), values.len())?;
    for (&reference, value) in references.iter().zip(values) {
        of_kind(handle, kind, reference)?;
        *value = of(handle.instance.get(reference as usize)?);
    }
    Ok(Status::Ok)
}

/// Sets variables of a kind.
pub(crate) fn set<T: Copy>(
    handle: &mut Handle,
    kind: Kind,
    references: &[u32],
    values: &[T],
    number: impl Fn(T) -> f64,
) -> Outcome {
    same_count(references.len(), values.len())?;
    for (&reference, &value) in references.iter().zip(values) {
        of_kind(handle, kind, reference)?;
        handle.instance.set(reference as usize, number(value))?;
    }
    Ok(Status::Ok)
}

fn same_count(references: usize, values: usize) -> Result<(), Refusal> {
    match references == values {
        true => Ok(()),
        false => Err(Refusal::Misuse(format!(
            "{references} variables, but {values} values"
        ))),
    }
}

fn of_kind(handle: &Handle, kind: Kind, reference: u32) -> Result<(), Refusal> {
    let variable = handle.model().interface.variables.get(reference as usize);
    match variable {
        Some(variable) if variable.kind != kind => Err(Refusal::Misuse(format!(
            "`{}` is of another type",
            variable.name
        ))),
        Some(_) | None => Ok(()),
    }
}

macro_rules! values {
    ($get:ident: $get_type:ident, $set:ident: $set_type:ident, $of:ty, $kind:expr, $from:expr, $into:expr) => {
        export! { sys::$get_type, $get(
            instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
            values: *mut $of, nValues: usize,
        ) -> fmi3Status {
            // SAFETY: an importer passes its instance, as many references and as much room as it says.
            unsafe {
                let (references, values) = (given(valueReferences, nValueReferences), room(values, nValues));
                on(instance, |handle| get(handle, $kind, references, values, $from))
            }
        } }

        export! { sys::$set_type, $set(
            instance: fmi3Instance, valueReferences: *const fmi3ValueReference, nValueReferences: usize,
            values: *const $of, nValues: usize,
        ) -> fmi3Status {
            // SAFETY: an importer passes its instance, as many references and values as it says.
            unsafe {
                let (references, values) = (given(valueReferences, nValueReferences), given(values, nValues));
                on(instance, |handle| set(handle, $kind, references, values, $into))
            }
        } }
    };
}

values!(
    fmi3GetFloat64: fmi3GetFloat64TYPE,
    fmi3SetFloat64: fmi3SetFloat64TYPE,
    fmi3Float64,
    Kind::Real,
    |value| value,
    |value| value
);
values!(
    fmi3GetInt32: fmi3GetInt32TYPE,
    fmi3SetInt32: fmi3SetInt32TYPE,
    fmi3Int32,
    Kind::Integer,
    |value| value as i32,
    f64::from
);
values!(
    fmi3GetBoolean: fmi3GetBooleanTYPE,
    fmi3SetBoolean: fmi3SetBooleanTYPE,
    fmi3Boolean,
    Kind::Boolean,
    |value| value != 0.0,
    |value| f64::from(u8::from(value))
);
