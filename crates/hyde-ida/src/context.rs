//! The SUNDIALS context of one solver, and what SUNDIALS has to say, kept instead of printed.

use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{self, NonNull};

use sundials_sys as sys;

use crate::Error;

/// A `SUNContext` whose error handler collects messages. One per solver, so that solvers in different threads share
/// nothing.
pub(crate) struct Context {
    raw: sys::SUNContext,
    messages: NonNull<Vec<String>>,
}

impl Context {
    pub(crate) fn new() -> Result<Self, Error> {
        let mut raw = ptr::null_mut();
        // SAFETY: `raw` is a place for the new context.
        if unsafe { sys::SUNContext_Create(sys::SUN_COMM_NULL, &raw mut raw) } != 0 {
            return Err(Error::OutOfMemory);
        }
        let messages = NonNull::from(Box::leak(Box::<Vec<String>>::default()));
        // SAFETY: the context is valid; the handler gets the messages, which live until the context is freed.
        unsafe {
            sys::SUNContext_ClearErrHandlers(raw);
            sys::SUNContext_PushErrHandler(raw, Some(keep_message), messages.as_ptr().cast());
        }
        Ok(Self { raw, messages })
    }

    pub(crate) fn raw(&self) -> sys::SUNContext {
        self.raw
    }

    /// Takes what was said since the last call, as one line.
    pub(crate) fn take_messages(&self) -> String {
        // SAFETY: only this function and the handler reach the messages, and the handler runs only inside calls of
        // SUNDIALS, of which there is none now: the context is not `Sync`.
        let messages = unsafe { &mut *self.messages.as_ptr() };
        if messages.is_empty() {
            return String::new();
        }
        std::mem::take(messages).join("; ")
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        // SAFETY: everything made in this context is freed by now (the solver drops it last), and `messages` came from
        // a box.
        unsafe {
            sys::SUNContext_Free(&raw mut self.raw);
            drop(Box::from_raw(self.messages.as_ptr()));
        }
    }
}

unsafe extern "C" fn keep_message(
    _line: c_int,
    _function: *const c_char,
    _file: *const c_char,
    message: *const c_char,
    _code: sys::SUNErrCode,
    messages: *mut c_void,
    _context: sys::SUNContext,
) {
    if message.is_null() {
        return;
    }
    // SAFETY: SUNDIALS gives a C string, and the pointer pushed with this handler, to which nothing else refers while
    // SUNDIALS runs.
    unsafe {
        let message = CStr::from_ptr(message).to_string_lossy().trim().to_owned();
        (*messages.cast::<Vec<String>>()).push(message);
    }
}
