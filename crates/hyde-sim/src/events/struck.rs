//! A state that an event sets keeps that value for the instant, whatever holds it. A mode that fixes it to another one is left, by
//! the first exit to one in which the state can have the value: a body that is struck is held no longer, and one that slides
//! and is thrown back does not stick on the way. Where there is no such exit the run ends.

use super::Instant;
use crate::failure::Failure;
use crate::results::EventKind;
use crate::selection::choose_struck;
use crate::start_modes::leave_modes;
use hyde_program::{ReactionKind, Target};

impl Instant<'_, '_> {
    /// Makes states of what the reactions `fired` set, where constraints leave a choice, and leaves the modes that fix one to
    /// another value. What a mode entered by `impact` fixes stays: the impact is meant.
    pub(super) fn let_go(
        &mut self,
        fired: &[usize],
        entered: &[(usize, usize, bool)],
    ) -> Result<(), Box<Failure>> {
        let program = self.state.program;
        let reactions = fired.iter().map(|&number| &program.reactions[number]);
        let assignments = reactions.flat_map(|reaction| reaction.assignments.clone());
        let struck = assignments.filter_map(|number| match program.assignments[number].target {
            Target::State(position) => Some(position),
            Target::Memory(_) => None,
        });
        let now: Vec<usize> = struck.collect();
        if !now.is_empty() {
            choose_struck(self.state, self.now.at(), &now);
            self.struck.extend(now);
        }
        if self.struck.is_empty() || program.pins.is_empty() {
            return Ok(());
        }
        let struck = std::mem::take(&mut self.struck);
        let given = |automaton: usize, position: usize| {
            let meant = entered
                .iter()
                .any(|&(of, _, impact)| of == automaton && impact);
            struck.contains(&position) && !meant
        };
        let relations = program.relations.len();
        let truths = self.state.z[..relations].to_vec();
        let slopes = self.slopes_of_assignments();
        let at = self.now.at();
        let taken = leave_modes(self.state, at, &given)?;
        self.struck = struck;
        self.state.z[..relations].copy_from_slice(&truths);
        for number in taken {
            let reaction = &program.reactions[number];
            if let ReactionKind::Transition {
                automaton,
                from,
                to,
                ..
            } = reaction.kind
            {
                let kind = EventKind::Transition {
                    automaton,
                    from,
                    to,
                };
                self.note(kind, STRUCK, &reaction.origin, false);
            }
            if let Some(sensitivities) = &mut self.sensitivities {
                for index in reaction.assignments.clone() {
                    sensitivities.assign(program.assignments[index].target, &slopes, index);
                }
            }
        }
        Ok(())
    }
}

/// The cause of such a change of modes in the list of events.
const STRUCK: &str = "a state that it fixes was set";
