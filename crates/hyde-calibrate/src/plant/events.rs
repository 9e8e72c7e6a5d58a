//! Events of the fixed-step form: reactions fire together until nothing fires (M7), by the rules of [`Program::firing`] and its
//! neighbours, at the instants that the steps know.
//!
//! A relation that is exactly zero counts as its declaration says: a guard that leaves zero is true one shortest step
//! later. Asserts are not looked at. Rounds without end are left after a few dozen: an estimate that is corrected at every row
//! may well hop.

use super::driven::Plant;
use hyde_program::{Function, Program, ReactionKind, RelationUse};

const MAX_ROUNDS: usize = 30;

/// The relations that matter in the modes that the memory says.
pub(crate) fn watched(program: &Program, z: &[f64]) -> Vec<usize> {
    let in_mode = |automaton, mode| program.mode(z, automaton) == mode;
    let matters = |number: &usize| {
        let used = program.relations[*number].used;
        used != RelationUse::Assert && used.matters(in_mode)
    };
    (0..program.relations.len()).filter(matters).collect()
}

impl Plant<'_> {
    /// Iterates until nothing fires.
    pub(crate) fn settle(&mut self) {
        let program = self.program;
        if program.relations.is_empty() {
            return;
        }
        for _ in 0..MAX_ROUNDS {
            let flipped = self.flip();
            let fired = self.fired();
            if fired.is_empty() && flipped.is_empty() {
                return;
            }
            self.apply(&fired, &flipped);
            if self.enter().is_err() {
                return;
            }
        }
    }

    /// Writes the truths of watched relations to the memory; those of equations that changed.
    fn flip(&mut self) -> Vec<usize> {
        let program = self.program;
        let mut roots = vec![0.0; program.relations.len()];
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Roots, at, workspace, &mut roots);
        let watched = self.watched.iter();
        let truths =
            watched.map(|&number| (number, program.relations[number].truth(roots[number])));
        program.write_truths(&mut self.z, truths)
    }

    /// The reactions that fire.
    fn fired(&mut self) -> Vec<usize> {
        let program = self.program;
        let mut truths = vec![0.0; program.reactions.len()];
        let (at, workspace) = self.point();
        program.kernels.conditions(at, workspace, &mut truths);
        let holds: Vec<bool> = truths.iter().map(|truth| *truth != 0.0).collect();
        let in_mode = |automaton, mode| program.mode(&self.z, automaton) == mode;
        let fired = program.firing(&holds, &self.conditions, in_mode);
        self.conditions = holds;
        fired
    }

    /// Carries out the assignments of reactions, all from the values before; then modes, then pins.
    fn apply(&mut self, fired: &[usize], flipped: &[usize]) {
        let program = self.program;
        let mut values = vec![0.0; program.rows(Function::Assignments)];
        Program::turn(&mut self.z, flipped);
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Assignments, at, workspace, &mut values);
        Program::turn(&mut self.z, flipped);
        let reactions = || fired.iter().map(|&number| &program.reactions[number]);
        for index in reactions().flat_map(|reaction| reaction.assignments.clone()) {
            let target = program.assignments[index].target;
            target.set(values[index], &mut self.y, &mut self.z);
        }
        for reaction in reactions() {
            if let ReactionKind::Transition { automaton, to, .. } = reaction.kind {
                program.set_mode(&mut self.z, automaton, to);
            }
        }
        self.pin();
    }

    /// Fixes the states of the modes it is in.
    pub(crate) fn pin(&mut self) {
        let program = self.program;
        if program.pins.is_empty() {
            return;
        }
        let mut values = vec![0.0; program.rows(Function::Assignments)];
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Assignments, at, workspace, &mut values);
        self.pinned.clear();
        let pins = program.pins_in(&self.z);
        self.pinned
            .extend(pins.map(|(row, pin)| (pin.state, values[row])));
        self.apply_pins();
    }
}
