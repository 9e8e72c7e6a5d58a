//! What a run makes an operating point of: its values, in the modes that are asked for.

use super::Simulation;
use crate::failure::Failure;
use crate::initial;
use crate::moment::Moment;
use crate::operating_point::{OperatingPoint, PointModes, TakenMode};
use crate::setup::same_instant;
use crate::slide::Slide;
use crate::start_modes::initial_pins;
use hyde_program::{Function, Program, ReactionKind, Target};

impl Simulation<'_> {
    /// The values where the run is, taken in modes.
    pub(crate) fn point(mut self, modes: PointModes<'_>) -> Result<OperatingPoint, Box<Failure>> {
        let slides = self.leave_surfaces()?;
        let modes = match modes {
            PointModes::OfRun => Vec::new(),
            PointModes::Sliding(asked) => self.take(asked)?,
        };
        let Moment { t, y, yp } = self.integrator.now.clone();
        let state = self.integrator.state_mut();
        let u = state.read_all(t).to_vec();
        Ok(OperatingPoint {
            delayed: u[2 * self.program.columns.len()..].to_vec(),
            z: self.integrator.state().z.clone(),
            p: self.integrator.state().p.clone(),
            t,
            y,
            yp,
            u,
            modes,
            slides,
        })
    }

    /// Leaves the surfaces that the run slides on for the side that the memory has; their conditions.
    fn leave_surfaces(&mut self) -> Result<Vec<String>, Box<Failure>> {
        let slides = std::mem::take(&mut self.integrator.state_mut().slides);
        if slides.is_empty() {
            return Ok(Vec::new());
        }
        self.make_consistent()?;
        let text = |slide: &Slide| self.program.relations[slide.surface].text.clone();
        Ok(slides.iter().map(text).collect())
    }

    /// Puts automata into modes; relations follow. Which are in another mode than before.
    fn take(&mut self, asked: &[(usize, usize)]) -> Result<Vec<TakenMode>, Box<Failure>> {
        let program = self.program;
        let mut taken = Vec::new();
        for automaton in 0..program.automata.len() {
            let of_run = program.mode(&self.integrator.state().z, automaton);
            let wanted = asked.iter().find(|(number, _)| *number == automaton);
            let asked = wanted.is_some();
            let mode = match wanted {
                Some((_, mode)) => Some(*mode),
                None => first_that_slips(program, automaton, of_run),
            };
            let Some(mode) = mode.filter(|mode| *mode != of_run) else {
                continue;
            };
            let before = (
                self.integrator.now.clone(),
                self.integrator.state().z.clone(),
                self.integrator.state().pinned.clone(),
            );
            match self.enter(automaton, of_run, mode) {
                Ok(()) => taken.push(TakenMode {
                    automaton,
                    of_run,
                    taken: mode,
                    asked,
                }),
                Err(failure) if asked => return Err(failure),
                // Where nothing follows if it slips, it stays as the run has it.
                Err(_) => {
                    self.integrator.now = before.0;
                    let state = self.integrator.state_mut();
                    (state.z, state.pinned) = (before.1, before.2);
                }
            }
        }
        if !taken.is_empty() {
            self.modes_are_given = true;
            let scheduled = self.schedule.relations_at(self.integrator.now.t);
            self.iterate(&scheduled, false)?;
        }
        Ok(taken)
    }

    /// Puts an automaton into a mode, with what an exit sets that leads there.
    fn enter(&mut self, automaton: usize, from: usize, mode: usize) -> Result<(), Box<Failure>> {
        let program = self.program;
        let leads_there = |here: Option<usize>| {
            program.reactions.iter().find(|reaction| {
                matches!(reaction.kind, ReactionKind::Transition { automaton: of, from, to, .. }
                    if of == automaton && to == mode && here.is_none_or(|here| here == from))
            })
        };
        let now = self.integrator.now.clone();
        let state = self.integrator.state_mut();
        if let Some(exit) = leads_there(Some(from)).or_else(|| leads_there(None)) {
            let values = state.values(Function::Assignments, now.at());
            for index in exit.assignments.clone() {
                if let Target::Memory(position) = program.assignments[index].target {
                    state.z[position] = values[index];
                }
            }
        }
        program.set_mode(&mut state.z, automaton, mode);
        state.pinned = initial_pins(state, now.at());
        self.make_consistent()
    }

    /// Consistent values in the modes as they are; at the start what is delayed was ever as it is.
    fn make_consistent(&mut self) -> Result<(), Box<Failure>> {
        let mut now = self.integrator.now.clone();
        let state = self.integrator.state_mut();
        let consistent = &mut self.consistent;
        if same_instant(now.t, self.setup.start_s) {
            let round = initial::Round::StatesKept;
            initial::solve(state, consistent, &mut now, round)?;
        } else {
            consistent.solve(state, &mut now, false)?;
        }
        self.integrator.now = now;
        Ok(())
    }
}

/// The mode in which what a mode holds slides: that of its first exit to one that holds no speed.
fn first_that_slips(program: &Program, automaton: usize, mode: usize) -> Option<usize> {
    let holds = &program.automata[automaton].holds_speed;
    if !holds[mode] {
        return None;
    }
    program
        .reactions
        .iter()
        .find_map(|reaction| match reaction.kind {
            ReactionKind::Transition {
                automaton: of,
                from,
                to,
                ..
            } if of == automaton && from == mode && !holds[to] => Some(to),
            ReactionKind::Transition { .. }
            | ReactionKind::When { .. }
            | ReactionKind::Edge(_)
            | ReactionKind::Assert(_) => None,
        })
}
