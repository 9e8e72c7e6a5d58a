//! [`Handle`]: what a pointer of an importer stands for.

use hyde_fmi::{Instance, Model, Refusal, Use};
use std::ffi::{CString, c_char, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::rc::Rc;

/// How a call ended; the numbers are those of both versions of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Status {
    Ok = 0,
    /// The call had no effect; others may.
    Discard = 2,
    Error = 3,
}

/// The categories of messages in the description.
pub(crate) const EVENTS: &str = "logEvents";
pub(crate) const ERRORS: &str = "logStatusError";

/// Where messages go.
pub(crate) trait Log {
    /// Hands a message over.
    fn log(&self, status: Status, category: &str, message: &str);
}

/// An importer that looks on within a step.
pub(crate) trait Watch {
    /// Tells that the solver has ended a step at a time in s. Gives the time at which the importer wants to return, which it may
    /// ask for if `early`.
    fn reached(&self, t: f64, early: bool) -> Option<f64>;
}

/// An instance with where its messages go.
pub(crate) struct Handle {
    pub(crate) instance: Instance,
    /// Who looks on within steps. It calls the instance in turn, so that no call may have the handle meanwhile.
    pub(crate) watch: Option<Rc<dyn Watch>>,
    log: Box<dyn Log>,
    /// Whether events are told, and the categories that are; all of them if there are none.
    logging: bool,
    categories: Vec<String>,
    /// What an importer has been handed as the last state of a step.
    pub(crate) last_successful_s: f64,
}

/// What a call comes to.
pub(crate) type Outcome = Result<Status, Refusal>;

impl Handle {
    /// Makes an instance; null where there is none, which the log says.
    pub(crate) fn create(
        log: Box<dyn Log>,
        logging: bool,
        (token, resources): (&str, &Path),
        used: Use,
    ) -> *mut c_void {
        let made = catch_unwind(AssertUnwindSafe(|| {
            let model = crate::models::model(resources, token)?;
            Instance::new(&model, used).map_err(|refusal| refusal.to_string())
        }));
        let made = made.unwrap_or_else(|_| Err(PANICKED.to_owned()));
        match made {
            Ok(instance) => Box::into_raw(Box::new(Self {
                instance,
                watch: None,
                log,
                logging,
                categories: Vec::new(),
                last_successful_s: 0.0,
            }))
            .cast(),
            Err(reason) => {
                log.log(Status::Error, ERRORS, &reason);
                std::ptr::null_mut()
            }
        }
    }

    /// Frees an instance.
    ///
    /// # Safety
    /// `instance` is null or from [`Handle::create`], and is not used again.
    pub(crate) unsafe fn free(instance: *mut c_void) {
        if !instance.is_null() {
            // SAFETY: it was made by `Box::into_raw` there, and nobody has it any more.
            let handle = unsafe { Box::from_raw(instance.cast::<Self>()) };
            drop(catch_unwind(AssertUnwindSafe(move || drop(handle))));
        }
    }

    /// Works on an instance. What is refused is logged; what panics is an error.
    ///
    /// # Safety
    /// `instance` is null or from [`Handle::create`], and no other thread uses it during the call.
    pub(crate) unsafe fn on(
        instance: *mut c_void,
        work: impl FnOnce(&mut Self) -> Outcome,
    ) -> Status {
        // SAFETY: by the caller's promise it is one of ours, and this call has it alone.
        let Some(handle) = (unsafe { instance.cast::<Self>().as_mut() }) else {
            return Status::Error;
        };
        let outcome = catch_unwind(AssertUnwindSafe(|| work(handle)));
        let (status, message) = match outcome {
            Ok(Ok(status)) => {
                handle.tell_events();
                return status;
            }
            Ok(Err(refusal)) => {
                let status = match refusal {
                    Refusal::Misuse(_) => Status::Error,
                    Refusal::Value(_) | Refusal::Failure(_) => Status::Discard,
                };
                (status, refusal.to_string())
            }
            Err(_) => (Status::Error, PANICKED.to_owned()),
        };
        handle.tell_events();
        handle.log.log(status, ERRORS, &message);
        status
    }

    /// Whether events are told.
    pub(crate) fn set_logging(&mut self, on: bool, categories: Vec<String>) {
        (self.logging, self.categories) = (on, categories);
    }

    /// The model.
    pub(crate) fn model(&self) -> &Model {
        self.instance.model()
    }

    fn tell_events(&mut self) {
        let events = self.instance.take_events();
        let wanted = self.categories.is_empty() || self.categories.iter().any(|c| c == EVENTS);
        if self.logging && wanted {
            for event in events {
                self.log.log(Status::Ok, EVENTS, &event);
            }
        }
    }
}

const PANICKED: &str = "Hyde has failed in a way that it should not; please report the model";

/// A text as C has it: without what would end it early.
pub(crate) fn c_text(text: &str) -> CString {
    CString::new(text.replace('\0', " ")).unwrap_or_default()
}

/// A text that lives as long as the library.
pub(crate) const fn constant(text: &'static std::ffi::CStr) -> *const c_char {
    text.as_ptr()
}
