//! [`calibrate_found`]: the last of a diagnosis: a model found with states of its own, calibrated with a gain for them.
//!
//! The search compares models by one observer, that of the declared one. A state that an effect brings, a body on a spring or
//! a bristle, has no gain there; innovations are larger than they need be, and a fit leans towards parameters that make them
//! smaller (Ljung, System Identification, 2nd ed. 1999, section 8.4: in closed loop a noise model that is wrong biases the
//! rest). So parameters, sizes and shapes with their intervals are those of a fit with the observer of the model found; errors
//! are still told by the declared one's. Where nothing but equations changed the declared gain is as good, and stays.

use super::answer::Diagnosis;
use super::inquiry::Inquiry;
use super::stage::{Ground, Stage};
use crate::fit::{MAX_STEPS, Objective, Slopes, Solution, sum_of_squares};
use crate::observer::Observer;
use crate::plant::Unsupported;

/// Calibrates the model that was found with an observer of its own, where it has states that the declared one's does not know.
pub(super) fn calibrate_found(
    inquiry: &Inquiry<'_>,
    diagnosis: &mut Diagnosis,
) -> Result<(), Unsupported> {
    if diagnosis.findings.is_empty() {
        return Ok(());
    }
    let stage = diagnosis.stage();
    let declared = inquiry.ground();
    let places = declared.set_in(&stage.program, &stage.values());
    let observer = Observer::new(&stage.program, inquiry.recordings, &places)?;
    if inquiry.observer.knows_states_of(&observer) {
        return Ok(());
    }
    let own = Ground {
        observer: &observer,
        ..declared
    };
    let set = declared.set_in(&stage.program, &stage.kept);
    let problem = own.problem(&stage.program, &stage.varied, &set, None);
    let here = problem.solve_in(&stage.solution.values, MAX_STEPS, Slopes::Tangents)?;
    let fitted = Stage {
        solution: here,
        ..stage
    }
    .polished(&own)?;
    let innovations = declared
        .problem(&fitted.program, &fitted.varied, &set, None)
        .innovations(&fitted.solution.values)?;
    let solution = Solution {
        data: sum_of_squares(&innovations),
        innovations,
        ..fitted.solution
    };
    let hypotheses = diagnosis.hypotheses(inquiry);
    let stage = Stage { solution, ..fitted };
    diagnosis.take(stage, &hypotheses);
    let last = diagnosis.findings.last().cloned();
    let law = diagnosis
        .unknown
        .as_mut()
        .and_then(|own| own.found.as_mut());
    if let (Some(law), Some(finding)) = (law, last) {
        law.rewrite(&finding);
    }
    Ok(())
}
