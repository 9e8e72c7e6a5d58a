//! Events of the fixed-step form: reactions fire together until nothing fires (M7), as in hyde-sim, at the instants that
//! the steps know.
//!
//! A relation that is exactly zero counts as its declaration says: a guard that leaves zero is true one shortest step
//! later. Rounds without end are left after a few dozen: an estimate that is corrected at every row may well hop.

use super::driven::{Plant, truth};
use hyde_program::{Function, Program, ReactionKind, RelationUse, Target};

const MAX_ROUNDS: usize = 30;

/// The relations that matter in the modes that the memory says.
pub(crate) fn watched(program: &Program, z: &[f64]) -> Vec<usize> {
    let matters = |number: &usize| match program.relations[*number].used {
        RelationUse::Exit(automaton, mode) => in_mode(program, z, automaton, mode),
        RelationUse::Equation | RelationUse::When => true,
        RelationUse::Assert => false,
    };
    (0..program.relations.len()).filter(matters).collect()
}

fn in_mode(program: &Program, z: &[f64], automaton: usize, mode: usize) -> bool {
    z[program.automata[automaton].place] as usize == mode
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

    /// Writes the truths of relations to the memory; those of equations that changed.
    fn flip(&mut self) -> Vec<usize> {
        let program = self.program;
        let mut roots = vec![0.0; program.relations.len()];
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Roots, at, workspace, &mut roots);
        let mut flipped = Vec::new();
        for &number in &self.watched {
            let value = f64::from(u8::from(truth(program, number, roots[number])));
            if self.z[number].to_bits() != value.to_bits() {
                self.z[number] = value;
                if program.relations[number].used == RelationUse::Equation {
                    flipped.push(number);
                }
            }
        }
        flipped
    }

    /// The reactions that fire: the first true exit of each current mode, branches of `when` that became true.
    fn fired(&mut self) -> Vec<usize> {
        let program = self.program;
        let mut truths = vec![0.0; program.reactions.len()];
        let (at, workspace) = self.point();
        program.kernels.conditions(at, workspace, &mut truths);
        let (mut fired, mut left, mut clauses) = (Vec::new(), Vec::new(), Vec::new());
        for (number, reaction) in program.reactions.iter().enumerate() {
            let (now, before) = (truths[number] != 0.0, self.conditions[number]);
            self.conditions[number] = now;
            match &reaction.kind {
                ReactionKind::Transition {
                    automaton, from, ..
                } => {
                    let here = in_mode(program, &self.z, *automaton, *from);
                    if now && here && !left.contains(automaton) {
                        left.push(*automaton);
                        fired.push(number);
                    }
                }
                ReactionKind::When { clause } => {
                    if now && !before && !clauses.contains(clause) {
                        clauses.push(*clause);
                        fired.push(number);
                    }
                }
                ReactionKind::Edge(_) | ReactionKind::Assert(_) => {}
            }
        }
        fired
    }

    /// Carries out the assignments of reactions, all from the values before; then modes, then pins.
    fn apply(&mut self, fired: &[usize], flipped: &[usize]) {
        let program = self.program;
        let mut values = vec![0.0; program.rows(Function::Assignments)];
        self.turn(flipped);
        let (at, workspace) = self.point();
        program
            .kernels
            .evaluate(Function::Assignments, at, workspace, &mut values);
        self.turn(flipped);
        for &number in fired {
            let reaction = &program.reactions[number];
            for index in reaction.assignments.clone() {
                match program.assignments[index].target {
                    Target::State(position) => self.y[position] = values[index],
                    Target::Memory(position) => self.z[position] = values[index],
                }
            }
        }
        for &number in fired {
            if let ReactionKind::Transition { automaton, to, .. } = program.reactions[number].kind {
                self.z[program.automata[automaton].place] = to as f64;
            }
        }
        self.pin();
    }

    fn turn(&mut self, relations: &[usize]) {
        for &relation in relations {
            self.z[relation] = 1.0 - self.z[relation];
        }
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
        for (number, pin) in program.pins.iter().enumerate() {
            if in_mode(program, &self.z, pin.automaton, pin.mode) {
                let value = values[program.assignments.len() + number];
                self.pinned.push((pin.state, value));
            }
        }
        self.apply_pins();
    }
}
