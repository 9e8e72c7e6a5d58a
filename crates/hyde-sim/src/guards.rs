//! Watches the relations over a step and locates the first change (M8).
//!
//! After each step the root functions are evaluated at its end. Where they are arithmetic of the unknowns and the ends of
//! the last steps show that they bend too little to reach zero between, that is all. Else they are evaluated at a few
//! Chebyshev points of the step's interpolant as well, and in between where they bend enough to reach zero, or where a sine in
//! them turns too far for that to be seen; a change of sign between two of them brackets a crossing, which is located on the
//! interpolant. Where consistent values do not show it there, or where the step may have gone over a kink of a record, they are looked at over the whole step: the interpolant
//! of a force bends there to a crossing that there is not, or that is earlier or later.

use crate::active::is_active;
use crate::consistent::Consistent;
use crate::integrator::Integrator;
use crate::moment::Moment;
use crate::slide::margins;
use crate::state::State;
use hyde_program::Function;
use smallvec::SmallVec;

/// Chebyshev points inside a step.
const INSIDE: [f64; 3] = [0.146_446_609_406_726_24, 0.5, 0.853_553_390_593_273_8];

/// Points before a step that show how much a root function bends.
const BEFORE: usize = 3;
/// How many times nearer to zero than it bends within a step a root function must not come.
const CLEARANCE: f64 = 4.0;

/// Between two points that are looked at a sine in a root function turns by no more than this, rad.
const TURN: f64 = 1.0;

/// Values of the watched relations, and behind them the angles of the sines in root functions; of a few they are no allocation.
type Roots = SmallVec<[f64; 8]>;

/// The root functions at the last points before a step, as long as nothing happens; and room to evaluate them.
#[derive(Default)]
pub(crate) struct Trail {
    watched: Vec<usize>,
    /// Time in s, and values of the watched relations; the last is where a step begins.
    points: Vec<(f64, Roots)>,
    /// Room for what is watched in a step.
    in_step: Vec<Watched>,
    then: Moment,
    roots: Vec<f64>,
    angles: Vec<f64>,
}

impl Trail {
    /// Forgets the points: the equations, or what they remember, are others from here on.
    pub(crate) fn clear(&mut self) {
        self.points.clear();
    }

    /// Forgets the points if they are of other relations, or do not lead to where a step begins.
    fn lead_to(&mut self, start: f64, watched: &[usize]) {
        let leads = self
            .points
            .last()
            .is_some_and(|(t, _)| t.to_bits() == start.to_bits());
        if !leads || self.watched != watched {
            self.points.clear();
            self.watched.clear();
            self.watched.extend_from_slice(watched);
        }
    }

    /// Goes on by points of a step.
    fn extend(&mut self, points: impl IntoIterator<Item = (f64, Roots)>) {
        let start = self.points.last().map(|(t, _)| *t);
        let more = points.into_iter().filter(|(t, _)| start != Some(*t));
        self.points.extend(more);
        let too_many = self.points.len().saturating_sub(BEFORE);
        self.points.drain(..too_many);
    }
}

/// A located change: its time, and the relations that change; beyond the relations, the margin of a slide.
pub(crate) struct Crossing {
    pub(crate) t: f64,
    pub(crate) relations: Vec<usize>,
}

/// The relations to watch: in equations, in `when` and `assert`, and in exits of current modes. Scheduled ones are not
/// searched for. Behind the relations follow the margins of the slides, two of each.
pub(crate) fn active(state: &State<'_>) -> Vec<usize> {
    let relations = &state.program.relations;
    let watched = |number: &usize| !relations[*number].scheduled && is_active(state, *number);
    let margins = relations.len()..relations.len() + 2 * state.slides.len();
    (0..relations.len())
        .filter(watched)
        .chain(margins)
        .collect()
}

/// The first change of a watched relation within the last step, which began at `from`. Without one, relations that have left
/// their zero are no longer doubtful.
pub(crate) fn first_change(
    integrator: &mut Integrator<'_>,
    consistent: &mut Consistent,
    trail: &mut Trail,
    watched: &[usize],
    from: f64,
) -> Option<Crossing> {
    if watched.is_empty() {
        return None;
    }
    let (start, end) = (from, integrator.now.t);
    trail.lead_to(start, watched);
    let n_relations = integrator.state().program.relations.len();
    let state = integrator.state();
    let watch = |&number: &usize| {
        let doubtful = state.doubtful.iter().find(|(other, _)| *other == number);
        Watched {
            number,
            truth: number >= n_relations || state.z[number] != 0.0,
            band: doubtful.map_or(0.0, |(_, band)| *band),
        }
    };
    let mut in_step = std::mem::take(&mut trail.in_step);
    in_step.clear();
    in_step.extend(watched.iter().map(watch));
    let before = std::mem::take(&mut trail.points);
    let mut search = Search {
        probe: Probe::new(integrator, consistent, trail),
        watched: &in_step,
        points: Vec::new(),
    };
    let at_end = search.values(integrator, end);
    let goes_on = search.goes_on(integrator, &before, (end, &at_end));
    let found = if goes_on {
        None
    } else {
        let at_start = before.last().map(|(_, values)| values.clone());
        search.first_shown(integrator, (start, at_start), (end, &at_end))
    };
    let points = search.points;
    trail.points = before;
    if found.is_none() {
        let doubtful = &mut integrator.state_mut().doubtful;
        if !doubtful.is_empty() {
            // What has left its zero is known by its sign from here on.
            let pairs = in_step.iter().zip(&at_end);
            doubtful.retain(|(number, _)| {
                let left = |(watched, root): (&Watched, &f64)| {
                    watched.number == *number && root.abs() > watched.band
                };
                !pairs.clone().any(left)
            });
        }
        match goes_on {
            true => trail.extend([(end, at_end)]),
            false => trail.extend(points),
        }
    }
    trail.in_step = in_step;
    found
}

/// Halvings of a piece of a step in which a root function may reach zero between two points.
const MAX_HALVINGS: usize = 12;

/// So many rounds a search by secants may take until its bracket is half as wide.
const SLOW_ROUNDS: usize = 3;

/// At an event a root function is zero; so is what is smaller by this than its neighbour.
const AT_ZERO: f64 = 1e-3;
/// Between two points it is straight if its slope changes by less than this part.
const STRAIGHT: f64 = 0.5;

/// The search for the first change.
struct Search<'s> {
    probe: Probe<'s>,
    watched: &'s [Watched],
    /// The points of the step where the root functions were evaluated.
    points: Vec<(f64, Roots)>,
}

impl Search<'_> {
    /// Whether nothing has changed at the end of a step, and the root functions, as the points before and the end show, bend
    /// too little to have come to zero in it.
    fn goes_on(
        &self,
        integrator: &Integrator<'_>,
        before: &[(f64, Roots)],
        (end, at_end): (f64, &[f64]),
    ) -> bool {
        let state = integrator.state();
        // A force may have the kinks of a record, which the ends of steps do not show.
        let smooth = is_smooth(state);
        let arithmetic = |watched: &Watched| {
            let relation = state.program.relations.get(watched.number);
            relation.is_some_and(|relation| relation.arithmetic)
                && (smooth || state.is_of_states(watched.number))
        };
        let mut pairs = self.watched.iter().zip(at_end);
        let [a, b, c] = before else { return false };
        if !pairs.all(|(watched, root)| arithmetic(watched) && watched.holds(*root))
            || self.turns(&c.1, at_end)
        {
            return false;
        }
        let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
        (0..self.watched.len()).all(|k| {
            let [a, b, c] = [a, b, c].map(|(t, values)| (*t, values[k]));
            let d = (end, at_end[k]);
            let (first, second, third) = (slope(a, b), slope(b, c), slope(c, d));
            let curvature = (second - first) / (c.0 - a.0);
            let curvature = curvature.abs().max(((third - second) / (d.0 - b.0)).abs());
            // How far the parabola is from its chord in the middle of the step.
            let bend = 0.25 * curvature * (d.0 - c.0).powi(2);
            c.1.abs().min(d.1.abs()) > CLEARANCE * bend
        })
    }

    /// The first change in a step, on consistent values where those of the interpolant show one that is not there.
    fn first_shown(
        &mut self,
        integrator: &mut Integrator<'_>,
        (start, at_start): (f64, Option<Roots>),
        (end, at_end): (f64, &[f64]),
    ) -> Option<Crossing> {
        let at_start = at_start.unwrap_or_else(|| self.values(integrator, start));
        let found = self.first(integrator, (start, at_start), (end, at_end.into()))?;
        let state = integrator.state();
        let mut numbers = found.relations.iter();
        // What states alone decide is on the interpolant what it is.
        if numbers.any(|number| state.is_of_states(*number)) {
            return Some(found);
        }
        self.probe.exact = true;
        let smooth = is_smooth(integrator.state());
        let at_found = self.values(integrator, found.t);
        let shown = !self.changed(&at_found).is_empty();
        if smooth && shown {
            return Some(found);
        }
        let last = if shown {
            (found.t, at_found)
        } else {
            let at_end = self.values(integrator, end);
            if smooth && !self.changed(&at_end).is_empty() {
                // The interpolant crosses a little before its time.
                return Some(self.locate(integrator, (found.t, &at_found), (end, &at_end)));
            }
            (end, at_end)
        };
        // Behind a kink the interpolant crosses before its time or late.
        let at_start = self.values(integrator, start);
        self.first(integrator, (start, at_start), last)
    }

    /// The first change in a step.
    fn first(
        &mut self,
        integrator: &mut Integrator<'_>,
        start: (f64, Roots),
        end: (f64, Roots),
    ) -> Option<Crossing> {
        let (from, length) = (start.0, end.0 - start.0);
        let mut points = vec![start];
        for part in INSIDE {
            let t = from + part * length;
            points.push((t, self.values(integrator, t)));
        }
        points.push(end);
        self.points.clone_from(&points);
        for (number, pair) in points.windows(2).enumerate() {
            let around = &points[number.saturating_sub(1)..(number + 3).min(points.len())];
            let depth = if self.may_reach_zero(around) {
                0
            } else {
                MAX_HALVINGS + 1
            };
            let (a, b) = (&pair[0], &pair[1]);
            let found = self.between(integrator, (a.0, &a.1), (b.0, &b.1), depth);
            if found.is_some() {
                return found;
            }
        }
        None
    }

    /// The first change after `a` and up to `b`, halving where the curvature is large enough for an excursion to zero.
    fn between(
        &mut self,
        integrator: &mut Integrator<'_>,
        a: (f64, &[f64]),
        b: (f64, &[f64]),
        depth: usize,
    ) -> Option<Crossing> {
        let changes = !self.changed(b.1).is_empty();
        if !changes && depth > MAX_HALVINGS {
            return None;
        }
        let t = 0.5 * (a.0 + b.0);
        if t > a.0 && t < b.0 && depth <= MAX_HALVINGS {
            let middle = self.values(integrator, t);
            let points = [(a.0, a.1.into()), (t, middle.clone()), (b.0, b.1.into())];
            if self.may_reach_zero(&points) {
                let left = self.between(integrator, a, (t, &middle), depth + 1);
                return left.or_else(|| self.between(integrator, (t, &middle), b, depth + 1));
            }
            if !self.changed(&middle).is_empty() {
                return Some(self.locate(integrator, a, (t, &middle)));
            }
        }
        changes.then(|| self.locate(integrator, a, b))
    }

    /// Which of the watched have changed, by their values: their places among them.
    fn changed(&self, values: &[f64]) -> Vec<usize> {
        let pairs = self.watched.iter().zip(values).enumerate();
        pairs
            .filter(|(_, (watched, root))| !watched.holds(**root))
            .map(|(place, _)| place)
            .collect()
    }

    /// The first of several changes between `low`, where none has happened, and `high`, where all have that count.
    fn locate(
        &mut self,
        integrator: &mut Integrator<'_>,
        low: (f64, &[f64]),
        high: (f64, &[f64]),
    ) -> Crossing {
        let (mut a, mut b) = (low.0, high.0);
        let mut remaining = self.changed(high.1);
        // Values of the one whose secant guides the search.
        let mut at_a = Some(low.1[remaining[0]]);
        let mut at_b = high.1[remaining[0]];
        let mut side = 0_i32;
        let mut widths = [f64::INFINITY; SLOW_ROUNDS];
        for round in 0..200 {
            let tolerance = 4.0 * f64::EPSILON * b.abs().max(a.abs()) + 1e-15 * (high.0 - low.0);
            if b - a <= tolerance {
                break;
            }
            let secant = at_a
                .map(|at_a| b - at_b * (b - a) / (at_b - at_a))
                .filter(|t| *t > a && *t < b);
            // Where secants have not halved the bracket for some rounds, it is halved.
            let slow = b - a > 0.5 * widths[round % SLOW_ROUNDS];
            widths[round % SLOW_ROUNDS] = b - a;
            let t = secant.filter(|_| !slow).unwrap_or(0.5 * (a + b));
            // A secant that lands on an end moves by the tolerance, so that the bracket closes from that side.
            let t = t.clamp(a + 0.5 * tolerance, b - 0.5 * tolerance);
            let values = self.values(integrator, t);
            let changed: Vec<usize> = remaining
                .iter()
                .copied()
                .filter(|&place| !self.watched[place].holds(values[place]))
                .collect();
            if changed.is_empty() {
                a = t;
                at_a = Some(values[remaining[0]]);
                if side == -1 {
                    // Illinois: the end that stays twice counts half.
                    at_b *= 0.5;
                }
                side = -1;
            } else {
                let same = changed[0] == remaining[0];
                b = t;
                at_b = values[changed[0]];
                if side == 1 {
                    at_a = at_a.map(|value| 0.5 * value);
                }
                if !same {
                    at_a = None;
                }
                side = 1;
                remaining = changed;
            }
        }
        let relations = remaining.iter();
        Crossing {
            t: b,
            relations: relations.map(|&place| self.watched[place].number).collect(),
        }
    }

    /// Whether sines in root functions turn so far between two points that these may come to zero and back unseen.
    fn turns(&self, a: &[f64], b: &[f64]) -> bool {
        let angles = a.iter().zip(b).skip(self.watched.len());
        angles.into_iter().any(|(a, b)| (b - a).abs() > TURN)
    }

    /// Whether a root function bends so much between neighbouring points that it may touch zero between them.
    fn may_reach_zero(&self, points: &[(f64, Roots)]) -> bool {
        if points
            .windows(2)
            .any(|two| self.turns(&two[0].1, &two[1].1))
        {
            return true;
        }
        points.windows(3).any(|three| {
            let [a, b, c] = three else { return false };
            let part = (b.0 - a.0) / (c.0 - a.0);
            (0..self.watched.len()).any(|k| {
                let (at_a, at_b, at_c) = (a.1[k], b.1[k], c.1[k]);
                let chord = at_a + part * (at_c - at_a);
                let bend = (at_b - chord).abs();
                // Straight away from a zero where the piece begins, or straight to one where it ends, it meets no other.
                let straight = |zero: f64, first: f64, second: f64| {
                    let rise = (at_b - zero).abs() / first;
                    zero.abs() <= AT_ZERO * at_b.abs() && bend / second < STRAIGHT * rise
                };
                let (first, second) = (b.0 - a.0, c.0 - b.0);
                let mut nearest = at_b.abs();
                if !straight(at_a, first, second) {
                    nearest = nearest.min(at_a.abs());
                }
                if !straight(at_c, second, first) {
                    nearest = nearest.min(at_c.abs());
                }
                nearest < 2.0 * bend && bend > 1e-9 * (at_a.abs() + at_c.abs())
            })
        })
    }

    /// The watched root functions at a time.
    fn values(&mut self, integrator: &mut Integrator<'_>, t: f64) -> Roots {
        let (roots, angles) = self.probe.roots(integrator, t);
        let watched = self.watched.iter().map(|watched| roots[watched.number]);
        watched.chain(angles.iter().copied()).collect()
    }
}

/// Whether forces have no kinks of a record or of the past within a step.
fn is_smooth(state: &State<'_>) -> bool {
    state.program.columns.is_empty() && state.program.delays.is_empty()
}

/// A relation that is watched: its number, its truth, and how far from zero its root function says nothing.
#[derive(Clone, Copy)]
struct Watched {
    number: usize,
    truth: bool,
    band: f64,
}

impl Watched {
    /// Whether the sign of the root function is that of the truth; at zero the truth stays.
    fn holds(&self, root: f64) -> bool {
        root.abs() <= self.band || (root > 0.0) == self.truth
    }
}

/// Evaluates root functions on the interpolant, and the margins of slides.
struct Probe<'c> {
    consistent: &'c mut Consistent,
    /// Whether on consistent values with the states of the interpolant.
    exact: bool,
    room: &'c mut Trail,
}

impl<'c> Probe<'c> {
    fn new(
        integrator: &Integrator<'_>,
        consistent: &'c mut Consistent,
        room: &'c mut Trail,
    ) -> Self {
        let program = integrator.state().program;
        room.then.y.resize(program.n_unknowns, 0.0);
        room.then.yp.resize(program.n_unknowns, 0.0);
        Self {
            consistent,
            exact: false,
            room,
        }
    }

    /// The root functions and the angles of their sines at a time.
    fn roots(&mut self, integrator: &mut Integrator<'_>, t: f64) -> (&[f64], &[f64]) {
        let Trail {
            then,
            roots,
            angles,
            ..
        } = &mut *self.room;
        then.t = t;
        integrator.interpolate(then);
        let state = integrator.state_mut();
        roots.resize(state.program.relations.len(), 0.0);
        match self.exact {
            true => self.consistent.make_exact(state, then),
            false => self.consistent.refine(state, then),
        }
        state.evaluate(Function::Roots, then.at(), roots);
        if !state.slides.is_empty() {
            let weights = state.weights(then.at());
            roots.extend(weights.into_iter().flat_map(margins));
        }
        angles.resize(state.program.angles, 0.0);
        if !angles.is_empty() {
            state.evaluate(Function::Angles, then.at(), angles);
        }
        (roots, angles)
    }
}
