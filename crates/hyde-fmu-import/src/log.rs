//! [`Log`]: what an instance reports through the logger that it is given.
#![allow(unsafe_code, reason = "a logger is called by a foreign library")]

use std::collections::VecDeque;
use std::ffi::{CStr, c_char, c_uint, c_void};
use std::sync::{Arc, Mutex, PoisonError};

/// How many messages are kept: the newest.
const KEPT: usize = 8;

/// The environment that the library hands back with every message; `logger.c` reads its first field.
#[repr(C)]
pub(crate) struct Log {
    logged: unsafe extern "C" fn(*mut c_void, c_uint, *const c_char),
    messages: Mutex<VecDeque<String>>,
}

unsafe extern "C" {
    /// The logger of FMI 2.0, in `logger.c`.
    pub(crate) fn hyde_fmu_logger(
        environment: *mut c_void,
        instance: *const c_char,
        status: c_uint,
        category: *const c_char,
        format: *const c_char,
        ...
    );
}

impl Log {
    pub(crate) fn new() -> Arc<Self> {
        Arc::new(Self {
            logged,
            messages: Mutex::new(VecDeque::new()),
        })
    }

    /// What a library is given as its environment.
    pub(crate) fn environment(self: &Arc<Self>) -> *mut c_void {
        Arc::as_ptr(self).cast_mut().cast()
    }

    /// The newest messages, each with its status.
    pub(crate) fn messages(&self) -> Vec<String> {
        let messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        messages.iter().cloned().collect()
    }

    fn keep(&self, status: c_uint, text: &str) {
        let Some(word) = word(status) else {
            return;
        };
        let mut messages = self.messages.lock().unwrap_or_else(PoisonError::into_inner);
        if messages.len() == KEPT {
            messages.pop_front();
        }
        messages.push_back(format!("{word}: {}", text.trim()));
    }
}

/// The status as a word, if the message is worth keeping.
fn word(status: c_uint) -> Option<&'static str> {
    match status {
        1 => Some("Warning"),
        2 => Some("Discard"),
        3 => Some("Error"),
        4 => Some("Fatal"),
        _ => None,
    }
}

/// Called by `logger.c`.
unsafe extern "C" fn logged(environment: *mut c_void, status: c_uint, message: *const c_char) {
    if environment.is_null() || message.is_null() {
        return;
    }
    // SAFETY: the environment is that of `Log::environment`, which the instance keeps alive as long as the library may log;
    // the message is a terminated string of the caller.
    let (log, message) = unsafe { (&*environment.cast::<Log>(), CStr::from_ptr(message)) };
    log.keep(status, &message.to_string_lossy());
}

/// The logger of FMI 3.0.
pub(crate) unsafe extern "C" fn logged_in_fmi_3(
    environment: *mut c_void,
    status: fmi_sys::fmi3::fmi3Status,
    _category: *const c_char,
    message: *const c_char,
) {
    // SAFETY: the arguments are those of `logged`.
    unsafe { logged(environment, status, message) }
}
