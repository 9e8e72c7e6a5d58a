//! Slices and texts of an importer. Its pointers are good for the call, by the standard; a null pointer is an empty slice.

use std::ffi::{CStr, c_char};

/// Values that an importer hands over.
///
/// # Safety
/// `values` is null or points to `count` values that stay as they are during the call.
pub(crate) unsafe fn given<'a, T>(values: *const T, count: usize) -> &'a [T] {
    if values.is_null() || count == 0 {
        return &[];
    }
    // SAFETY: by the caller's promise there are as many values.
    unsafe { std::slice::from_raw_parts(values, count) }
}

/// Room that an importer hands over.
///
/// # Safety
/// `values` is null or points to room for `count` values that nobody else uses during the call.
pub(crate) unsafe fn room<'a, T>(values: *mut T, count: usize) -> &'a mut [T] {
    if values.is_null() || count == 0 {
        return &mut [];
    }
    // SAFETY: by the caller's promise there is as much room.
    unsafe { std::slice::from_raw_parts_mut(values, count) }
}

/// A text that an importer hands over; an empty one for a null pointer.
///
/// # Safety
/// `text` is null or points to characters that end with 0.
pub(crate) unsafe fn text(text: *const c_char) -> String {
    if text.is_null() {
        return String::new();
    }
    // SAFETY: by the caller's promise it ends.
    let text = unsafe { CStr::from_ptr(text) };
    text.to_string_lossy().into_owned()
}

/// Writes a value where an importer wants it, if it does.
///
/// # Safety
/// `place` is null or points to room for one value.
pub(crate) unsafe fn put<T>(place: *mut T, value: T) {
    if !place.is_null() {
        // SAFETY: by the caller's promise there is room.
        unsafe { place.write(value) };
    }
}
