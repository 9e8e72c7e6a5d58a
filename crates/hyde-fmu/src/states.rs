//! Saved states of instances behind the pointers of an importer.

use crate::handle::{Handle, Outcome, Status};
use crate::memory::put;
use hyde_fmi::{Refusal, Saved};
use std::ffi::c_void;

/// Saves the state of an instance; one that is there is replaced.
///
/// # Safety
/// `place` points to null or to a state from here.
pub(crate) unsafe fn save(handle: &mut Handle, place: *mut *mut c_void) -> Outcome {
    let saved = handle.instance.save()?;
    // SAFETY: by the caller's promise there is a pointer, and what it points to is ours.
    let known = unsafe {
        place
            .as_ref()
            .and_then(|known| known.cast::<Saved>().as_mut())
    };
    match known {
        Some(known) => *known = saved,
        // SAFETY: by the caller's promise there is room for a pointer.
        None => unsafe { put(place, Box::into_raw(Box::new(saved)).cast()) },
    }
    Ok(Status::Ok)
}

/// Returns to a state.
///
/// # Safety
/// `state` is null or a state from here.
pub(crate) unsafe fn restore(handle: &mut Handle, state: *mut c_void) -> Outcome {
    // SAFETY: by the caller's promise.
    let saved = unsafe { of(state)? };
    handle.instance.restore(saved)?;
    Ok(Status::Ok)
}

/// Frees a state.
///
/// # Safety
/// `place` is null, or points to null or to a state from here, which is not used again.
pub(crate) unsafe fn free(place: *mut *mut c_void) -> Outcome {
    // SAFETY: by the caller's promise.
    if let Some(state) = unsafe { place.as_mut() }
        && !state.is_null()
    {
        // SAFETY: it was made by `Box::into_raw` above, and nobody uses it any more.
        drop(unsafe { Box::from_raw(state.cast::<Saved>()) });
        *state = std::ptr::null_mut();
    }
    Ok(Status::Ok)
}

/// Writes how many bytes a state has.
///
/// # Safety
/// As for [`restore`]; `size` is null or has room for a number.
pub(crate) unsafe fn size(state: *mut c_void, size: *mut usize) -> Outcome {
    // SAFETY: by the caller's promise.
    unsafe {
        let bytes = of(state)?.to_bytes()?;
        put(size, bytes.len());
    }
    Ok(Status::Ok)
}

/// Writes a state as bytes.
///
/// # Safety
/// As for [`restore`].
pub(crate) unsafe fn serialize(state: *mut c_void, room: &mut [u8]) -> Outcome {
    // SAFETY: by the caller's promise.
    let bytes = unsafe { of(state)?.to_bytes()? };
    let Some(room) = room.get_mut(..bytes.len()) else {
        let text = format!("the state has {} bytes", bytes.len());
        return Err(Refusal::Misuse(text));
    };
    room.copy_from_slice(&bytes);
    Ok(Status::Ok)
}

/// Makes a state from bytes.
///
/// # Safety
/// `place` is null or has room for a pointer.
pub(crate) unsafe fn deserialize(bytes: &[u8], place: *mut *mut c_void) -> Outcome {
    let saved = Saved::from_bytes(bytes)?;
    // SAFETY: by the caller's promise.
    unsafe { put(place, Box::into_raw(Box::new(saved)).cast()) };
    Ok(Status::Ok)
}

/// # Safety
/// `state` is null or a state from here.
unsafe fn of<'a>(state: *mut c_void) -> Result<&'a Saved, Refusal> {
    // SAFETY: by the caller's promise.
    let saved = unsafe { state.cast::<Saved>().as_ref() };
    saved.ok_or_else(|| Refusal::Misuse("there is no state".to_owned()))
}
