//! How long the run is in which mode, and slides on which surface.

use crate::integrator::Integrator;
use crate::results::Results;

/// Adds a time to the modes of all automata and to the surfaces slid on. Two modes that a run slides between have their
/// shares of it, by the weights where the integrator stands.
pub(crate) fn count_modes(integrator: &mut Integrator<'_>, results: &mut Results, span_s: f64) {
    let state = integrator.state();
    let program = state.program;
    for automaton in 0..program.automata.len() {
        let mode = program.mode(&state.z, automaton);
        results.mode_times[automaton][mode] += span_s;
    }
    if state.slides.is_empty() {
        return;
    }
    let now = integrator.now.clone();
    let state = integrator.state_mut();
    let weights = state.weights(now.at());
    for (slide, weight) in state.slides.iter().zip(weights) {
        let text = &program.relations[slide.surface].text;
        match results.sliding.iter_mut().find(|(known, _)| known == text) {
            Some((_, time)) => *time += span_s,
            None => results.sliding.push((text.clone(), span_s)),
        }
        if let Some(pair) = slide.modes {
            let times = &mut results.mode_times[pair.automaton];
            times[program.mode(&state.z, pair.automaton)] -= span_s;
            for (mode, share) in pair.modes.into_iter().zip([1.0 - weight, weight]) {
                times[mode] += share * span_s;
            }
        }
    }
}
