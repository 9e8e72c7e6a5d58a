//! What events do to the memory and the states: the rules that the simulator and the fixed-step form of an observer share.
//!
//! ```text
//! truth           of a relation by its root function          Relation::truth
//! matters         whether it is looked at in these modes      RelationUse::matters
//! write truths    to the memory; which equations they switch  Program::write_truths
//! firing          the reactions that answer them              Program::firing
//! assign          what they set, all from the values before   Program::turn, Target::set
//! set mode        the modes that they enter                   Program::set_mode
//! pins            the states that these modes fix             Program::pins_in
//! ```
//! Where root functions come from, when rounds end, and what is exactly at zero along the flow each of the two knows itself.

use crate::event::{Pin, Relation};
use crate::program::Program;
use hyde_ir::dae::{ReactionKind, RelationUse};

impl Relation {
    /// Its truth where the root function has a value: true above zero, and at a zero that stays zero as it is declared.
    #[must_use]
    #[allow(clippy::float_cmp, reason = "a zero that stays zero is exact")]
    pub fn truth(&self, root: f64) -> bool {
        root > 0.0 || (root == 0.0 && self.inclusive)
    }
}

impl Program {
    /// The number of the mode that an automaton is in.
    #[must_use]
    pub fn mode(&self, memory: &[f64], automaton: usize) -> usize {
        memory[self.automata[automaton].place] as usize
    }

    /// Puts an automaton into a mode.
    pub fn set_mode(&self, memory: &mut [f64], automaton: usize, mode: usize) {
        memory[self.automata[automaton].place] = mode as f64;
    }

    /// Writes truths of relations to the memory; the numbers of those of equations whose truth changed.
    pub fn write_truths(
        &self,
        memory: &mut [f64],
        truths: impl IntoIterator<Item = (usize, bool)>,
    ) -> Vec<usize> {
        let mut switched = Vec::new();
        for (number, truth) in truths {
            let value = f64::from(u8::from(truth));
            if memory[number].to_bits() != value.to_bits() {
                memory[number] = value;
                if self.relations[number].used == RelationUse::Equation {
                    switched.push(number);
                }
            }
        }
        switched
    }

    /// Turns truths of relations over: what an event sets is made of values before it, also of those that a relation switches
    /// at this instant.
    pub fn turn(memory: &mut [f64], relations: &[usize]) {
        for &relation in relations {
            memory[relation] = 1.0 - memory[relation];
        }
    }

    /// The reactions that fire: of each automaton the first exit of its mode whose condition holds, of each `when` clause the
    /// first branch whose condition holds and did not before.
    #[must_use]
    pub fn firing(
        &self,
        holds: &[bool],
        held: &[bool],
        in_mode: impl Fn(usize, usize) -> bool,
    ) -> Vec<usize> {
        let (mut fired, mut left, mut clauses) = (Vec::new(), Vec::new(), Vec::new());
        for (number, reaction) in self.reactions.iter().enumerate() {
            match &reaction.kind {
                ReactionKind::Transition {
                    automaton, from, ..
                } => {
                    if holds[number] && in_mode(*automaton, *from) && !left.contains(automaton) {
                        left.push(*automaton);
                        fired.push(number);
                    }
                }
                ReactionKind::When { clause } => {
                    if holds[number] && !held[number] && !clauses.contains(clause) {
                        clauses.push(*clause);
                        fired.push(number);
                    }
                }
                ReactionKind::Edge(_) | ReactionKind::Assert(_) => {}
            }
        }
        fired
    }

    /// The pins of the modes in the memory, each with the row of [`crate::Function::Assignments`] that is its value.
    pub fn pins_in<'a>(&'a self, memory: &'a [f64]) -> impl Iterator<Item = (usize, &'a Pin)> {
        let each = self.pins.iter().enumerate();
        let on = each.filter(|(_, pin)| self.mode(memory, pin.automaton) == pin.mode);
        on.map(|(number, pin)| (self.assignments.len() + number, pin))
    }
}
