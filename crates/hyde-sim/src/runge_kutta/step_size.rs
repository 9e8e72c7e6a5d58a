//! How long the next step is, from the estimated errors of the last two.
//!
//! A step that only follows the last error swings about the right length where a solution oscillates: one step in five is
//! refused, and nearly each takes a factorization. The filter of second order with both the errors and the ratio of the steps
//! in it lets the step follow slowly (G. Söderlind, Digital filters in adaptive time-stepping, ACM Trans. Math. Softw. 29
//! (2003) 1, table III, H211b with b = 4):
//!
//! ```text
//! next = step * (1/error * 1/error before)^(1/(4*5)) * (step/step before)^(-1/4)
//! ```
//!
//! Errors are in units of the tolerance, of order 5 in the step. Where the run starts anew there is no error before, and
//! the step follows the error alone until it no longer grows.

/// The order of the estimated error.
const ORDER: f64 = 5.0;
/// What the filter weakens.
const B: f64 = 4.0;
/// The factors between which a step may be to the one before. After a step that failed it does not grow.
const SHRINK: f64 = 0.2;
const GROW: f64 = 6.0;
/// Of the step that the error allows, the part that is taken where nothing tells how the error changes; after a step that
/// failed it is no longer than this part of it.
const SAFETY: f64 = 0.9;
/// A step that could be longer or should be shorter by no more is kept, for each other length takes a factorization.
const KEEP: std::ops::Range<f64> = 0.9..1.2;
/// Errors below this tell no more than this one.
const LEAST: f64 = 1e-10;

/// Of the step that is right for order 1, how many times it the first one is before any was tried (measured on axes with a
/// clock: between 10 and 100 it makes little difference, and a step too long is only taken again).
const LONGER_FIRST_STEP: f64 = 40.0;

/// What the choice of the next step remembers.
pub(super) struct StepSize {
    /// Of the step that is right for order 1, how many times it the first one is, and its length in s while it is to come.
    longer: f64,
    first_s: Option<f64>,
    /// The last accepted step in s, and its error in units of the tolerance; none while steps grow from a new start.
    last: Option<(f64, f64)>,
}

impl Default for StepSize {
    fn default() -> Self {
        Self {
            longer: LONGER_FIRST_STEP,
            first_s: None,
            last: None,
        }
    }
}

impl StepSize {
    /// The first step in s where a run starts anew, from the one that is right for order 1. The errors before say nothing of
    /// what comes; those of earlier first steps do.
    pub(super) fn first(&mut self, by_curvature_s: f64) -> f64 {
        self.last = None;
        let first_s = self.longer * by_curvature_s;
        self.first_s = Some(first_s).filter(|first_s| first_s.is_finite());
        first_s
    }

    /// The step in s after one of `step` s with this error of at most 1; no longer where an attempt at it had failed.
    pub(super) fn after(&mut self, step: f64, error: f64, failed: bool) -> f64 {
        let error = error.max(LEAST);
        let right = (SAFETY * error.powf(-1.0 / ORDER)).clamp(SHRINK, GROW);
        if let Some(first_s) = self.first_s.take()
            && (failed || step > first_s / KEEP.end)
        {
            self.longer *= (step * right / first_s).sqrt();
        }
        let factor = match self.last {
            None => right,
            Some((step_before, before)) => {
                (error * before).powf(-1.0 / (B * ORDER)) * (step / step_before).powf(-1.0 / B)
            }
        };
        let factor = factor.clamp(SHRINK, if failed { 1.0 } else { GROW });
        if self.last.is_some() || factor < KEEP.end {
            self.last = Some((step, error));
        }
        if KEEP.contains(&factor) {
            step
        } else {
            step * factor
        }
    }

    /// The step in s to try after one of `step` s whose error was above 1.
    pub(super) fn retry(step: f64, error: f64) -> f64 {
        step * error.powf(-1.0 / ORDER).clamp(SHRINK, SAFETY)
    }
}

#[cfg(test)]
mod tests {
    use super::{GROW, StepSize};

    /// Steps of a method of order 5 whose error is 1 at a step of `right(n)` s, from 1 ms: the lengths taken and how many
    /// were refused.
    fn taken(right: impl Fn(usize) -> f64) -> (Vec<f64>, usize) {
        let (mut size, mut step, mut refused) = (StepSize::default(), 1e-3, 0);
        let mut steps = Vec::new();
        for n in 0..400 {
            let mut failed = false;
            let error = |step: f64| (step / right(n)).powi(5);
            while error(step) > 1.0 {
                step = StepSize::retry(step, error(step));
                refused += 1;
                failed = true;
            }
            steps.push(step);
            step = size.after(step, error(step), failed);
        }
        (steps, refused)
    }

    #[test]
    fn a_step_comes_to_the_right_length_and_stays() {
        let (steps, _) = taken(|_| 0.02);
        let last = steps[399];
        assert!((0.65..1.0).contains(&(last / 0.02)), "{last}");
        let stays = |step: &f64| step.to_bits() == last.to_bits();
        assert!(steps[300..].iter().all(stays), "{steps:?}");
    }

    #[test]
    fn an_error_that_swings_refuses_few_steps_and_keeps_most_lengths() {
        let (steps, refused) = taken(|n| 0.02 * (1.0 + 0.15 * (n as f64).sin()));
        assert!(refused < 20, "{refused}");
        let changes = |pair: &&[f64]| pair[0].to_bits() != pair[1].to_bits();
        let changed = steps.windows(2).filter(changes).count();
        assert!(changed < 80, "{changed}");
    }

    #[test]
    fn after_a_new_start_the_step_follows_the_error_alone() {
        let mut size = StepSize::default();
        size.after(1.0, 0.5, false);
        size.first(f64::INFINITY);
        assert!((size.after(1.0, 1e-9, false) - GROW).abs() < 1e-12);
    }
}
