//! When sliding begins and ends (Filippov).
//!
//! A relation that changes its truth, or a mode that is left, is at its surface g = 0. If the new side leads back to it and
//! the old one led there, time cannot go on by switching: the run slides. It leaves to the side whose weight exceeds one, or
//! when an event takes g away from zero. The equations while sliding are those of `state/sliding.rs`.

use super::Instant;
use crate::active::is_active;
use crate::failed_equation::with_values;
use crate::failure::{Failure, FailureKind};
use crate::results::EventKind;
use crate::slide::{ModePair, ROUNDING, Slide};
use crate::zero::{is_off_surface, located_s, of_surface};
use hyde_program::{ReactionKind, RelationUse};

/// Rates of the two sides that differ by less, over their size, are one: the switch does nothing to its own surface.
const NO_JUMP: f64 = 1e-9;
/// A mean of the two sides' rates that is off by more shows that a switch acts on the equations in no linear way.
const NOT_LINEAR: f64 = 1e-6;

/// The rates of the states on one side of a switch, and that of its root function with the size of its parts.
struct Flow {
    yp: Vec<f64>,
    rate: f64,
    size: f64,
}

/// What became of a switch that may slide.
enum Verdict {
    /// It slides from now on.
    Slides,
    /// One side leads away from the surface.
    Crosses,
    /// Both sides lead to it, but there is no mean of the two: why.
    Cannot(&'static str),
}

impl Instant<'_, '_> {
    /// Ends slides that cannot go on; values are consistent then. Returns whether there were any. The relations that were
    /// held are added to those at their zero.
    pub(crate) fn leave_slides(
        &mut self,
        located: &mut Vec<(usize, f64)>,
    ) -> Result<bool, Box<Failure>> {
        let mut left = false;
        while let Some((number, side)) = self.slide_to_leave() {
            left = true;
            let slide = self.state.slides.remove(number);
            self.state.set_side(&slide, side);
            let size = self.size_of(slide.surface);
            for &(relation, _) in &slide.relations {
                located.push((relation, of_surface(size)));
            }
            self.log_slide(&slide, None, Some(side));
            let rows = self.state.choose_rows(self.now.at());
            let solved = self.consistent.solve(self.state, self.now, false);
            if !rows || solved.is_err() {
                return Err(self.cannot_slide(&slide, NO_ROW));
            }
        }
        Ok(left)
    }

    /// The first slide that cannot go on, and the side it leaves to.
    fn slide_to_leave(&mut self) -> Option<(usize, usize)> {
        let slides = self.state.slides.clone();
        if slides.is_empty() {
            return None;
        }
        for (number, slide) in slides.iter().enumerate() {
            let height = self.state.height(slide.surface, self.now.at());
            if is_off_surface(height, self.size_of(slide.surface)) {
                return Some((number, usize::from(height > 0.0)));
            }
        }
        let weights = self.state.weights(self.now.at());
        let beyond = |weight: f64| (-weight).max(weight - 1.0);
        let (number, weight) = weights
            .into_iter()
            .enumerate()
            .max_by(|a, b| beyond(a.1).total_cmp(&beyond(b.1)))?;
        (beyond(weight) > 0.5 * ROUNDING).then_some((number, usize::from(weight > 0.5)))
    }

    /// Lets switches slide that cannot do otherwise: of the relations `turned` at this instant and of the exits that fire.
    /// Exits of modes that slide are taken from `fired`. Returns whether there were any.
    pub(crate) fn enter_slides(
        &mut self,
        turned: &mut Vec<usize>,
        fired: &mut Vec<usize>,
    ) -> Result<bool, Box<Failure>> {
        let mut entered = false;
        for number in fired.clone() {
            let Some(slide) = self.pair_of_modes(number) else {
                continue;
            };
            if self.enter(slide)? {
                entered = true;
                fired.retain(|other| *other != number);
            }
        }
        // What is set at this instant comes first: it may take the state away from the surface.
        if !fired.is_empty() {
            return Ok(entered);
        }
        for relation in std::mem::take(turned) {
            let of_states = self.state.is_of_states(relation);
            if of_states && is_active(self.state, relation) {
                let slide = self.slide_at(relation, None);
                entered |= self.enter(slide)?;
            }
        }
        Ok(entered)
    }

    /// Two modes that lead to each other at one surface, of which an exit fires.
    fn pair_of_modes(&mut self, reaction: usize) -> Option<Slide> {
        let program = self.state.program;
        let ReactionKind::Transition {
            automaton,
            from,
            to,
            ..
        } = program.reactions[reaction].kind
        else {
            return None;
        };
        let fixes =
            |pin: &hyde_program::Pin| pin.automaton == automaton && [from, to].contains(&pin.mode);
        let slides = self.state.slides.iter().filter_map(|slide| slide.modes);
        if from == to
            || !program.reactions[reaction].assignments.is_empty()
            || program.pins.iter().any(fixes)
            || slides.clone().any(|pair| pair.automaton == automaton)
        {
            return None;
        }
        let back = program.reactions.iter().position(|back| {
            matches!(back.kind, ReactionKind::Transition { automaton: a, from: f, to: t, .. } if (a, f, t) == (automaton, to, from))
                && back.assignments.is_empty()
        })?;
        let guards = |mode: usize| -> Vec<usize> {
            let relations = program.relations.iter().enumerate();
            relations
                .filter(|(_, relation)| relation.used == RelationUse::Exit(automaton, mode))
                .map(|(number, _)| number)
                .filter(|&number| self.state.is_of_states(number))
                .collect()
        };
        let (leaving, returning) = (guards(from), guards(to));
        for there in leaving {
            let truth = std::mem::replace(&mut self.state.z[there], 0.0);
            let decides = !self.state.conditions(self.now.at())[reaction];
            self.state.z[there] = truth;
            if truth == 0.0 || !decides {
                continue;
            }
            for &here in &returning {
                let before = std::mem::replace(&mut self.state.z[here], 1.0);
                let leads_back = self.state.conditions(self.now.at())[back];
                self.state.z[here] = before;
                if leads_back && self.same_surface(there, here) == Some(false) {
                    let modes = ModePair {
                        automaton,
                        modes: [from, to],
                    };
                    let mut slide = self.slide_at(there, Some(modes));
                    if !slide.holds(here) {
                        slide.relations.push((here, false));
                    }
                    return Some(slide);
                }
            }
        }
        None
    }

    /// Everything that switches at the surface of a relation.
    fn slide_at(&mut self, surface: usize, modes: Option<ModePair>) -> Slide {
        let program = self.state.program;
        let mut relations = vec![(surface, true)];
        for other in 0..program.relations.len() {
            let in_equations = program.relations[other].used == RelationUse::Equation;
            if other != surface && in_equations && is_active(self.state, other) {
                relations.extend(self.same_surface(surface, other).map(|up| (other, up)));
            }
        }
        Slide {
            surface,
            relations,
            modes,
            direction: vec![0.0; self.now.y.len()],
            row: 0,
        }
    }

    /// Whether two relations switch at the same place, and if so, whether in the same direction.
    fn same_surface(&mut self, a: usize, b: usize) -> Option<bool> {
        let gradient = |state: &mut crate::state::State<'_>, k| state.gradient(k, self.now.at());
        let (of_a, of_b) = (gradient(self.state, a), gradient(self.state, b));
        let (column, first) = *of_a.iter().max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()))?;
        let along = |list: &[(usize, f64)], column: usize| -> f64 {
            list.iter()
                .filter(|(c, _)| *c == column)
                .map(|(_, v)| v)
                .sum()
        };
        let ratio = along(&of_b, column) / first;
        if ratio == 0.0 || !ratio.is_finite() {
            return None;
        }
        let columns = of_a.iter().chain(&of_b).map(|(column, _)| *column);
        for column in columns {
            let difference = along(&of_b, column) - ratio * along(&of_a, column);
            if difference.abs() > of_surface((ratio * first).abs()) {
                return None;
            }
        }
        let height = |state: &mut crate::state::State<'_>, k| state.height(k, self.now.at());
        let apart = height(self.state, b) - ratio * height(self.state, a);
        let size = self.size_of(b).max(ratio.abs() * self.size_of(a));
        (apart.abs() <= of_surface(size)).then_some(ratio > 0.0)
    }

    /// The size of what a root function is the difference of.
    fn size_of(&mut self, relation: usize) -> f64 {
        let gradient = self.state.gradient(relation, self.now.at());
        gradient
            .iter()
            .map(|&(column, value)| (value * self.now.y[column]).abs())
            .sum()
    }

    /// Lets a switch slide if it must. Returns whether it does.
    fn enter(&mut self, slide: Slide) -> Result<bool, Box<Failure>> {
        let (memory, before) = (self.state.z.clone(), self.state.slides.clone());
        let now = self.now.clone();
        let verdict = self.try_to_slide(slide.clone());
        self.state.z = memory;
        match verdict {
            Verdict::Slides => {
                let before = 1 - self.side_now(&slide);
                self.log_slide(&slide, Some(before), None);
                if slide.modes.is_some() {
                    // Exits that hold each other in balance do not fire.
                    for &(relation, _) in &slide.relations {
                        if self.state.program.relations[relation].used != RelationUse::Equation {
                            self.state.z[relation] = 0.0;
                        }
                    }
                }
                Ok(true)
            }
            Verdict::Crosses => {
                self.state.slides = before;
                *self.now = now;
                Ok(false)
            }
            Verdict::Cannot(why) => {
                self.state.slides = before;
                Err(self.cannot_slide(&slide, why))
            }
        }
    }

    fn try_to_slide(&mut self, mut slide: Slide) -> Verdict {
        let surface = slide.surface;
        // An instant is known to rounding of the time; further away no crossing was located.
        let rate = self.state.height_rate(surface, self.now.at());
        let near = rate.abs() * located_s(self.now.t) + of_surface(self.size_of(surface));
        let height = self.state.height(surface, self.now.at());
        if height.abs() > near {
            return Verdict::Crosses;
        }
        // The new side first: mostly it leads on, and there is nothing more to do.
        let new = self.side_now(&slide);
        let Some(ahead) = self.flow_on(&slide, new) else {
            return Verdict::Crosses;
        };
        let leads_on = if new == 1 { ahead.rate } else { -ahead.rate };
        if leads_on > ROUNDING * ahead.size {
            return Verdict::Crosses;
        }
        let Some(behind) = self.flow_on(&slide, 1 - new) else {
            return Verdict::Crosses;
        };
        let (lower, upper) = if new == 1 {
            (behind, ahead)
        } else {
            (ahead, behind)
        };
        let jump = lower.rate - upper.rate;
        let weight = lower.rate / jump;
        let inside = -0.1 * ROUNDING..=1.0 + 0.1 * ROUNDING;
        if jump <= NO_JUMP * (lower.size + upper.size) || !inside.contains(&weight) {
            return Verdict::Crosses;
        }
        if self.height_differs(&slide) {
            return Verdict::Cannot("the guard itself jumps where it switches");
        }
        slide.direction = self.direction(surface, &lower, &upper);
        self.state.slides.push(slide);
        if !self.state.choose_rows(self.now.at()) {
            return Verdict::Cannot(NO_ROW);
        }
        self.state.put_on_surfaces(self.now);
        let solved = self.consistent.solve(self.state, self.now, false);
        if solved.is_err() {
            return Verdict::Cannot(NO_ROW);
        }
        if self.acts_linearly() {
            Verdict::Slides
        } else {
            Verdict::Cannot("the switched terms do not act linearly on the motion")
        }
    }

    /// The flow with a switch on one side; `None` where there is none.
    fn flow_on(&mut self, slide: &Slide, side: usize) -> Option<Flow> {
        self.state.set_side(slide, side);
        let mut on_side = self.now.clone();
        let solved = self.consistent.solve(self.state, &mut on_side, false);
        solved.ok()?;
        let gradient = self.state.gradient(slide.surface, on_side.at());
        let size = gradient
            .iter()
            .map(|&(column, value)| (value * on_side.yp[column]).abs())
            .sum();
        let rate = self.state.height_rate(slide.surface, on_side.at());
        Some(Flow {
            yp: on_side.yp,
            rate,
            size,
        })
    }

    /// The direction in which the rates of the states differ; of its components on the surface the leading one is 1.
    fn direction(&mut self, surface: usize, lower: &Flow, upper: &Flow) -> Vec<f64> {
        let differential = &self.state.differential;
        let difference = |i: usize| {
            if differential[i] {
                upper.yp[i] - lower.yp[i]
            } else {
                0.0
            }
        };
        let mut direction: Vec<f64> = (0..self.now.y.len()).map(difference).collect();
        let gradient = self.state.gradient(surface, self.now.at());
        let size = |entry: &&(usize, f64)| (entry.1 * direction[entry.0]).abs();
        let leading = gradient.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
        let leading = leading.map_or(1.0, |&(column, _)| direction[column]);
        direction.iter_mut().for_each(|part| *part /= leading);
        direction
    }

    /// Whether the rates while sliding are the mean of those of the two sides of the last slide, as they are where what it
    /// switches acts linearly.
    fn acts_linearly(&mut self) -> bool {
        let weight = self.state.weights(self.now.at()).pop().unwrap_or(f64::NAN);
        let Some(slide) = self.state.slides.pop() else {
            return true;
        };
        let flows = [0, 1].map(|side| self.flow_on(&slide, side));
        self.state.slides.push(slide);
        let [Some(lower), Some(upper)] = flows else {
            return false;
        };
        let mut states = (0..self.now.y.len()).filter(|&i| self.state.differential[i]);
        let largest = lower
            .yp
            .iter()
            .chain(&upper.yp)
            .fold(0.0_f64, |most, rate| most.max(rate.abs()));
        states.all(|i| {
            let (lower, upper) = (lower.yp[i], upper.yp[i]);
            let mean = weight * upper + (1.0 - weight) * lower;
            let size = lower.abs().max(upper.abs()).max(NO_JUMP * largest);
            (self.now.yp[i] - mean).abs() <= NOT_LINEAR * size
        })
    }

    /// The side that the memory is on.
    fn side_now(&self, slide: &Slide) -> usize {
        match slide.modes {
            // An exit leads to the upper side.
            Some(_) => 1,
            None => usize::from(self.state.z[slide.surface] != 0.0),
        }
    }

    /// Whether the root function of a surface depends on the switch.
    fn height_differs(&mut self, slide: &Slide) -> bool {
        let [lower, upper] = [0, 1].map(|side| {
            self.state.set_side(slide, side);
            self.state.height(slide.surface, self.now.at())
        });
        (upper - lower).abs() > of_surface(self.size_of(slide.surface))
    }

    /// Takes down that sliding begins, from a side, or ends, to one.
    pub(crate) fn log_slide(&mut self, slide: &Slide, before: Option<usize>, after: Option<usize>) {
        let number = |side: usize| slide.modes.map_or(side, |pair| pair.modes[side]);
        let kind = EventKind::Slide {
            automaton: slide.modes.map(|pair| pair.automaton),
            before: before.map(number),
            after: after.map(number),
        };
        let relation = &self.state.program.relations[slide.surface];
        self.note(kind, &relation.text, &relation.origin, false);
    }

    /// The failure of a switch that both sides lead to and that cannot slide.
    fn cannot_slide(&mut self, slide: &Slide, why: &'static str) -> Box<Failure> {
        let relations = &self.state.program.relations;
        let mut causes = Vec::new();
        for (relation, _) in &slide.relations {
            let text = &relations[*relation].text;
            if !causes.contains(text) {
                causes.push(text.clone());
            }
        }
        let failure = Failure::new(FailureKind::CannotSlide(causes.clone(), why), self.now.t);
        let failure = slide
            .relations
            .iter()
            .fold(failure, |failure, (relation, _)| {
                failure.at_origin(&relations[*relation].origin)
            });
        let at = self.now.at();
        causes.iter().fold(failure, |failure, cause| {
            with_values(failure, self.state, at, cause)
        })
    }
}

const NO_ROW: &str =
    "the switched equations contain no free force or rate that could hold it there";
