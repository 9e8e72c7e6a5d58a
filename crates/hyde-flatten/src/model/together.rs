//! Many elements lowered at once, as one expression of a counter, as far as they have one form.
//!
//! `together` is tried first for a loop and for a whole array. What is met on the way and has no common form (an item of a
//! list, a component of an array of them, the time of a delay) calls `unroll`, and the elements are lowered one by one.

use crate::model::Model;

/// Whether what is lowered stands for many elements at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Together {
    /// It is one element.
    No,
    /// It stands for many, and has one form for all of them until now.
    Yes,
    /// Something was met that has a form of its own in each.
    Unroll,
}

impl Model<'_, '_> {
    /// Lowers many elements as one; `None` if each needs a form of its own.
    pub(crate) fn together<T>(&mut self, lower: impl FnOnce(&mut Self) -> T) -> Option<T> {
        let outer = std::mem::replace(&mut self.together, Together::Yes);
        let lowered = lower(self);
        let met = std::mem::replace(&mut self.together, outer);
        (met == Together::Yes).then_some(lowered)
    }

    /// Asks that the elements which are lowered together are lowered one by one; `false` if there is only one.
    pub(crate) fn unroll(&mut self) -> bool {
        if self.together == Together::No {
            return false;
        }
        self.together = Together::Unroll;
        true
    }
}
