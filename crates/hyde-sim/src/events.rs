//! Event iteration: reactions fire together, values become consistent, until nothing fires (M7).
//!
//! One round:
//! 1. the truth of every relation that matters now, with consistent values; one that is exactly zero, or whose scheduled
//!    instant this is, counts by the sign of its derivative along the flow (M2);
//! 2. the reactions whose conditions hold: of an automaton the first exit of its mode, of a `when` clause the first
//!    branch that became true;
//! 3. all their assignments, from the values before; states that the new modes fix take their values (M3);
//! 4. consistent values.
//!
//! Where relations of equations lead each other in a circle, or to where there is no solution, the other branches are
//! [searched](branches). Modes that were met before at this instant without a state having jumped: guards are looked at more
//! closely. If they lead in a circle still, the modes stay where all this is noise at rest, beneath the tolerance. Else they end
//! the run, as fifty rounds do: the conditions would fire for ever.

pub(crate) mod branches;
mod contradictions;
mod edges;
mod endless;
mod located;
mod slides;
mod struck;

use crate::active::is_active;
use crate::consistent::Consistent;
use crate::failed_equation::with_values;
use crate::failure::{Failure, FailureKind};
use crate::moment::Moment;
use crate::results::{Contradiction, Event, EventKind};
use crate::root_rates::root_rates;
use crate::sensitivity::Sensitivities;
use crate::state::State;
use crate::zero;
use branches::{Branches, Found};
use hyde_program::{Function, Program, ReactionKind, RelationUse, Target};

const MAX_ROUNDS: usize = 50;
/// Rounds at the start in which relations alone may change.
const MAX_SETTLING: usize = 20;
/// How deep guards may ask for each other.
const MAX_NESTED: usize = 8;

/// What an instant is worked on with.
pub(crate) struct Instant<'s, 'a> {
    pub(crate) state: &'s mut State<'a>,
    pub(crate) consistent: &'s mut Consistent,
    pub(crate) now: &'s mut Moment,
    /// The largest value of each unknown so far.
    pub(crate) largest: &'s [f64],
    /// Conditions as they were, to tell which become true.
    pub(crate) conditions: &'s mut Vec<bool>,
    pub(crate) log: &'s mut Vec<Event>,
    pub(crate) contradictions: &'s mut Vec<Contradiction>,
    /// Derivatives by parameters, which go along with the instant.
    pub(crate) sensitivities: Option<&'s mut Sensitivities>,
    /// The relations whose crossing this instant was located at.
    pub(crate) crossed: Vec<usize>,
    /// The states that events of this instant have set.
    pub(crate) struck: Vec<usize>,
    /// Relations of equations change, and nothing else happens.
    pub(crate) modes_are_given: bool,
    /// How long guards that are at rest stay at their zeros, in s.
    pub(crate) long_s: f64,
}

/// What is known of the relations at an instant.
struct Known {
    truths: Vec<bool>,
    roots: Vec<f64>,
    /// Relations whose truth is that of a moment later, with how far on the other side of zero their root functions may be
    /// until then.
    doubtful: Vec<(usize, f64)>,
    /// A relation whose root function has no finite value.
    not_finite: Option<usize>,
}

impl Instant<'_, '_> {
    /// Iterates until nothing fires. `scheduled` are the relations whose instant this is. Returns whether anything
    /// changed that the equations read. At the start `when` conditions that hold already do not fire.
    pub(crate) fn iterate(
        &mut self,
        scheduled: &[usize],
        at_start: bool,
    ) -> Result<bool, Box<Failure>> {
        let program = self.state.program;
        if program.relations.is_empty() && program.reactions.is_empty() {
            return Ok(false);
        }
        let mut changed = false;
        let mut seen: Vec<Vec<u64>> = Vec::new();
        let mut causes: Vec<String> = Vec::new();
        // Guards that brought the run here, now or when they were true last, with their root functions' values: zero but for
        // the location's rounding.
        let mut located: Vec<(usize, f64)> = self.state.located.clone();
        let (mut turned, mut looked_closer, mut struck) = (Vec::new(), false, false);
        // Relations of equations that changed at this instant and may have to slide.
        let mut switched: Vec<usize> = Vec::new();
        // Where the relations of equations began to settle, and what they were in the rounds since.
        let mut branches = Branches::from(self);
        for round in 0..MAX_ROUNDS {
            changed |= self.leave_slides(&mut located)?;
            let mut known = self.truths(scheduled, &located)?;
            // At the start nothing led here: a guard that is true was not crossed.
            if seen.is_empty() && !at_start {
                let short = self.short_of_zero(&known);
                if !short.is_empty() {
                    located.extend(short);
                    known = self.truths(scheduled, &located)?;
                }
                let now = self.guards_that_became_true(&known);
                self.remember_located(&now);
                located.extend(now);
            }
            let Known {
                truths,
                roots,
                doubtful,
                not_finite,
            } = known;
            turned.extend(self.true_guards(&truths, &roots));
            let numbered = truths.iter().copied().enumerate();
            let mut flipped = program.write_truths(&mut self.state.z, numbered);
            switched.extend(&flipped);
            let first_at_start = at_start && seen.is_empty();
            let conditions = self.conditions_with_edges(first_at_start);
            let mut fired = match self.modes_are_given {
                true => Vec::new(),
                false => self.fired(&conditions, first_at_start)?,
            };
            *self.conditions = conditions;
            // At the start the truths of relations are not known yet: guards wait until they are.
            let settles = first_at_start && !flipped.is_empty() && round < MAX_SETTLING;
            if settles {
                fired.clear();
            }
            let slid = !self.modes_are_given && self.enter_slides(&mut switched, &mut fired)?;
            flipped.retain(|&relation| is_active(self.state, relation));
            if fired.is_empty() && flipped.is_empty() && !slid {
                // As long as others turn, it may be a division in a branch that is left.
                if let Some(relation) = not_finite {
                    let failure = Failure::new(FailureKind::NotFinite, self.now.t);
                    return Err(failure.at_origin(&program.relations[relation].origin));
                }
                if struck && let Some(relation) = self.comes_back_at_once(&truths, &roots) {
                    return Err(self.struck_without_end(&program.relations[relation].text));
                }
                return Ok(self.end(changed, doubtful));
            }
            let exits_alone = fired
                .iter()
                .all(|&reaction| self.only_changes_mode(reaction));
            let circles = looked_closer && exits_alone && !fired.is_empty();
            if circles
                && flipped.is_empty()
                && !slid
                && let Some(at_rest) = self.at_rest(&turned)
            {
                for (guard, _) in &at_rest {
                    self.state.z[*guard] = 0.0;
                }
                // Of a guard at rest the wider band counts, which is found first.
                let bands = at_rest.into_iter().chain(doubtful).collect();
                return Ok(self.end(changed, bands));
            }
            changed = true;
            struck |= fired.iter().any(|&reaction| self.strikes(reaction));
            for &relation in &flipped {
                let relation_info = &program.relations[relation];
                causes.push(relation_info.text.clone());
                let kind = EventKind::Relation(self.state.z[relation] != 0.0);
                self.note(kind, &relation_info.text, &relation_info.origin, at_start);
            }
            self.apply(&fired, &flipped, &mut causes)?;
            if !fired.is_empty() || slid {
                branches = Branches::from(self);
            }
            let key: Vec<u64> = self.mode_key();
            if !exits_alone {
                // What has jumped may lead elsewhere.
                (seen, looked_closer) = (Vec::new(), false);
            }
            let again = exits_alone && !fired.is_empty() && seen.contains(&key);
            if again && looked_closer {
                return Err(self.chattering(&causes));
            }
            if !settles {
                seen.push(key);
            }
            let found = self.solve_or_tip(&mut branches, scheduled, &located, at_start)?;
            if let Some(sensitivities) = &mut self.sensitivities {
                let at = self.now.at();
                sensitivities.be_consistent(self.state, self.consistent, at);
            }
            if found == Found::Indifferent && fired.is_empty() {
                return Ok(self.end(changed, doubtful));
            }
            if again {
                looked_closer = true;
                seen.drain(..seen.len() - 1);
                located.extend(self.all_but_zero(&turned));
                turned.clear();
            }
        }
        Err(self.without_end(&causes, struck))
    }

    /// Ends the iteration where nothing fires, with how far from zero each doubtful relation may be until its sign counts
    /// again. Returns whether anything changed.
    fn end(&mut self, changed: bool, doubtful: Vec<(usize, f64)>) -> bool {
        self.set_edges(|_, _| false);
        self.state.doubtful = doubtful;
        changed
    }

    /// The truth of every relation that matters. A guard may ask for another relation, `if a > 0 then …`: it is looked at
    /// again once that one is known.
    fn truths(
        &mut self,
        scheduled: &[usize],
        located: &[(usize, f64)],
    ) -> Result<Known, Box<Failure>> {
        let program = self.state.program;
        let before = self.state.z[..program.relations.len()].to_vec();
        let mut found = self.truths_once(scheduled, located)?;
        for _ in 0..MAX_NESTED {
            let mut turned = false;
            for (number, relation) in program.relations.iter().enumerate() {
                if relation.used != RelationUse::Equation {
                    let truth = f64::from(u8::from(found.truths[number]));
                    turned |= truth.to_bits() != self.state.z[number].to_bits();
                    self.state.z[number] = truth;
                }
            }
            if !turned {
                break;
            }
            let roots = self.state.values(Function::Roots, self.now.at());
            let same = roots.iter().zip(&found.roots);
            if same.into_iter().all(|(a, b)| a.to_bits() == b.to_bits()) {
                break;
            }
            found = self.truths_once(scheduled, located)?;
        }
        self.state.z[..before.len()].copy_from_slice(&before);
        Ok(found)
    }

    /// The truth of every relation that matters; of the others as they were.
    fn truths_once(
        &mut self,
        scheduled: &[usize],
        located: &[(usize, f64)],
    ) -> Result<Known, Box<Failure>> {
        let program = self.state.program;
        let roots = self.state.values(Function::Roots, self.now.at());
        let rounding = zero::rounding(self.state, self.now.at(), self.largest);
        let mut zeros = Vec::new();
        let mut not_finite = None;
        for (number, &root) in roots.iter().enumerate() {
            if !is_active(self.state, number) {
                continue;
            }
            if !root.is_finite() {
                not_finite = Some(number);
                continue;
            }
            let is_zero = root.abs() <= rounding[number]
                || scheduled.contains(&number)
                || zero::is_still_at(located, number, root);
            if is_zero {
                zeros.push(number);
            }
        }
        let sign = |(number, &root): (usize, &f64)| match is_active(self.state, number)
            && root.is_finite()
        {
            true => root > 0.0,
            false => self.state.z[number] != 0.0,
        };
        let mut truths: Vec<bool> = roots.iter().enumerate().map(sign).collect();
        let mut doubtful = Vec::new();
        if !zeros.is_empty() {
            let at = self.now.at();
            let rates = root_rates(self.state, self.consistent, at, &zeros);
            for number in zeros {
                let (root, rate) = (roots[number], rates[number]);
                let inclusive = program.relations[number].inclusive;
                // What stays at its zero is no reason to leave a mode, whatever rounding makes of it. A force that counts as
                // the friction which it has not quite reached would let go, and a speed that rounding decides would stick.
                let is_guard = matches!(program.relations[number].used, RelationUse::Exit(..));
                let truth = if rate.mean == 0.0 || (is_guard && rate.is_hidden_at_zero()) {
                    if root == 0.0 || is_guard {
                        inclusive
                    } else {
                        root > 0.0
                    }
                } else {
                    rate.mean > 0.0
                };
                let band = zero::doubt(root, truth, rate.detour());
                if band > 0.0 {
                    doubtful.push((number, band));
                }
                truths[number] = truth;
            }
        }
        Ok(Known {
            truths,
            roots,
            doubtful,
            not_finite,
        })
    }

    /// The guards of current modes that are true, with their root functions' values.
    fn true_guards(&self, truths: &[bool], roots: &[f64]) -> Vec<(usize, f64)> {
        let program = self.state.program;
        let guards = (0..truths.len()).filter(|&number| {
            matches!(program.relations[number].used, RelationUse::Exit(..))
                && truths[number]
                && is_active(self.state, number)
        });
        guards.map(|number| (number, roots[number])).collect()
    }

    /// The guards of current modes that are true now and were not: of these the root function is at its zero.
    fn guards_that_became_true(&self, known: &Known) -> Vec<(usize, f64)> {
        let relations = self.state.program.relations.iter().enumerate();
        relations
            .filter(|(number, relation)| {
                let before = self.state.z[*number] != 0.0;
                matches!(relation.used, RelationUse::Exit(..)) && known.truths[*number] && !before
            })
            .map(|(number, _)| (number, known.roots[number]))
            .collect()
    }

    /// The reactions that fire, after the asserts. At the start conditions of `when` have held before.
    fn fired(&mut self, conditions: &[bool], at_start: bool) -> Result<Vec<usize>, Box<Failure>> {
        let program = self.state.program;
        for (reaction, now) in program.reactions.iter().zip(conditions) {
            if let (ReactionKind::Assert(message), true) = (&reaction.kind, now) {
                let failure = Failure::new(FailureKind::Assert(message.clone()), self.now.t);
                let failure = failure.at_origin(&reaction.origin);
                let at = self.now.at();
                return Err(with_values(failure, self.state, at, &reaction.text));
            }
        }
        let held = if at_start {
            conditions
        } else {
            self.conditions.as_slice()
        };
        let in_mode = |automaton, mode| self.state.in_mode(automaton, mode);
        Ok(program.firing(conditions, held, in_mode))
    }

    /// Carries out the assignments of reactions, all from the values before; then modes, then pins.
    fn apply(
        &mut self,
        fired: &[usize],
        flipped: &[usize],
        causes: &mut Vec<String>,
    ) -> Result<(), Box<Failure>> {
        let program = self.state.program;
        Program::turn(&mut self.state.z, flipped);
        let values = self.state.values(Function::Assignments, self.now.at());
        let slopes = self.slopes_of_assignments();
        Program::turn(&mut self.state.z, flipped);
        let mut entered: Vec<(usize, usize, bool)> = Vec::new();
        self.note_contradictions(fired, &values);
        for &number in fired {
            let reaction = &program.reactions[number];
            causes.push(reaction.text.clone());
            match &reaction.kind {
                ReactionKind::Transition {
                    automaton,
                    from,
                    to,
                    impact,
                } => {
                    entered.push((*automaton, *to, *impact));
                    let kind = EventKind::Transition {
                        automaton: *automaton,
                        from: *from,
                        to: *to,
                    };
                    self.note(kind, &reaction.text, &reaction.origin, false);
                }
                ReactionKind::When { .. } => {
                    self.note(EventKind::When, &reaction.text, &reaction.origin, false)
                }
                ReactionKind::Edge(_) | ReactionKind::Assert(_) => {}
            }
            for index in reaction.assignments.clone() {
                let target = program.assignments[index].target;
                target.set(values[index], &mut self.now.y, &mut self.state.z);
                if let Some(sensitivities) = &mut self.sensitivities {
                    sensitivities.assign(target, &slopes, index);
                }
            }
        }
        for &(automaton, to, _) in &entered {
            let slides = &mut self.state.slides;
            slides.retain(|slide| slide.modes.is_none_or(|pair| pair.automaton != automaton));
            program.set_mode(&mut self.state.z, automaton, to);
        }
        self.let_go(fired, &entered)?;
        self.pin(&entered)
    }

    /// The derivatives by parameters of what events assign and of the values of pins, if they are asked for.
    fn slopes_of_assignments(&mut self) -> Vec<Vec<f64>> {
        let at = self.now.at();
        let sensitivities = self.sensitivities.as_ref();
        sensitivities.map_or_else(Vec::new, |sensitivities| {
            sensitivities.of(Function::Assignments, self.state, at)
        })
    }

    /// Fixes the states of the modes entered, and frees those of the modes left.
    fn pin(&mut self, entered: &[(usize, usize, bool)]) -> Result<(), Box<Failure>> {
        let program = self.state.program;
        if program.pins.is_empty() {
            return Ok(());
        }
        let values = self.state.values(Function::Assignments, self.now.at());
        let slopes = self.slopes_of_assignments();
        let mut pinned = Vec::new();
        for (row, pin) in program.pins_in(&self.state.z) {
            let value = values[row];
            let entry = entered
                .iter()
                .find(|(automaton, ..)| *automaton == pin.automaton);
            if let Some((_, _, impact)) = entry {
                let now = self.now.y[pin.state];
                // The instant was located to rounding of the time: the state may be off by what it moves meanwhile.
                let rounding = zero::moved(self.now.yp[pin.state], self.now.t);
                let tolerance = 1e-6 * now.abs().max(value.abs()) + 1e-7 + rounding;
                if !impact && (now - value).abs() > tolerance {
                    let name = program.unknown_name(pin.state);
                    let failure = Failure::new(FailureKind::Impact(name, now, value), self.now.t);
                    return Err(failure.at_origin(&pin.origin));
                }
            }
            pinned.push((pin.state, value));
            if let Some(sensitivities) = &mut self.sensitivities {
                sensitivities.assign(Target::State(pin.state), &slopes, row);
            }
        }
        self.state.pinned = pinned;
        self.state.apply_pins(self.now);
        Ok(())
    }

    pub(crate) fn note(
        &mut self,
        kind: EventKind,
        cause: &str,
        origin: &hyde_diag::Origin,
        at_start: bool,
    ) {
        if !at_start {
            self.log.push(Event {
                t: self.now.t,
                kind,
                cause: cause.to_owned(),
                origin: origin.clone(),
            });
        }
    }
}
