//! The vectors of IDA: serial ones, whose busiest operations are replaced by ours.

use std::ptr::NonNull;
use std::slice;

use sundials_sys as sys;

use crate::context::Context;
use crate::{Error, operations};

/// An `N_Vector` that we own. The vectors IDA makes after its likeness have the same operations.
pub(crate) struct Vector {
    raw: NonNull<sys::_generic_N_Vector>,
}

impl Vector {
    /// A vector of `n` zeros.
    pub(crate) fn new(n: usize, context: &Context) -> Result<Self, Error> {
        // SAFETY: the context is valid.
        let raw = unsafe { sys::N_VNew_Serial(n as i64, context.raw()) };
        let vector = Self {
            raw: NonNull::new(raw).ok_or(Error::OutOfMemory)?,
        };
        // SAFETY: a new vector has a table of operations of its own, and memory that nothing else refers to, for `n`
        // numbers.
        unsafe {
            operations::install(&mut *(*raw).ops);
            parts(raw).1.write_bytes(0, n);
        }
        Ok(vector)
    }

    pub(crate) fn from_slice(values: &[f64], context: &Context) -> Result<Self, Error> {
        let mut vector = Self::new(values.len(), context)?;
        vector.as_mut_slice().copy_from_slice(values);
        Ok(vector)
    }

    pub(crate) fn raw(&self) -> sys::N_Vector {
        self.raw.as_ptr()
    }

    pub(crate) fn as_slice(&self) -> &[f64] {
        // SAFETY: the vector is serial, and nothing writes to it while it is borrowed: IDA does so only in calls that
        // borrow the whole solver mutably.
        unsafe { values(self.raw()) }
    }

    pub(crate) fn as_mut_slice(&mut self) -> &mut [f64] {
        // SAFETY: as above, and nothing else reads it either.
        unsafe { values_mut(self.raw()) }
    }
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: the vector is ours and valid.
        unsafe { sys::N_VDestroy(self.raw()) };
    }
}

/// The length and the data of a serial vector.
///
/// # Safety
/// `vector` must be a valid serial vector.
pub(crate) unsafe fn parts(vector: sys::N_Vector) -> (usize, *mut f64) {
    // SAFETY: the content of a serial vector is this struct.
    let content = unsafe { &*(*vector).content.cast::<sys::_N_VectorContent_Serial>() };
    (content.length as usize, content.data)
}

/// The numbers of a serial vector.
///
/// # Safety
/// `vector` must be a valid serial vector that nothing writes to during `'a`.
pub(crate) unsafe fn values<'a>(vector: sys::N_Vector) -> &'a [f64] {
    // SAFETY: the data are as many numbers as the length says, and initialised: ours are, and so are copies of them.
    unsafe {
        let (length, data) = parts(vector);
        slice::from_raw_parts(data, length)
    }
}

/// The numbers of a serial vector, to be written.
///
/// # Safety
/// `vector` must be a valid serial vector that nothing else reads or writes during `'a`.
pub(crate) unsafe fn values_mut<'a>(vector: sys::N_Vector) -> &'a mut [f64] {
    // SAFETY: as above.
    unsafe {
        let (length, data) = parts(vector);
        slice::from_raw_parts_mut(data, length)
    }
}
