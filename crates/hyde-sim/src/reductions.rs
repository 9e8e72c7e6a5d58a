//! [`Reductions`]: signals over a run as one number each, of the continuous solution.
//!
//! What a measure reads is evaluated at the end of every step and on both sides of every instant at which something
//! happens. A smooth signal is the polynomial through the last of those values: if it foretold the value at the end of
//! the step, what lies between is read from it. Else the signal is evaluated at the five [points of Lobatto's
//! rule](crate::lobatto) on the solver's interpolant, and a stretch in which it bends more than they show, as at the
//! corner of an `abs`, is halved. Where a comparison in what is read changes, as in `max(e, abs(v) > 0.1 [m/s])`, a stretch is
//! [cut](cut). Nothing is taken from rows of the results: a number does not depend on how far those are apart.

mod cut;
mod past;
mod sum;

use crate::lobatto::{self, MIDDLE, POINTS};
use crate::results::Reduced;
use hyde_program::{Reduction, ReductionKind};
use past::Past;
use sum::{Piece, Sum};

/// Of the range of a signal, what its polynomial may have beyond a cubic: five points are exact to the square of it.
const BENT: f64 = 1e-3;
/// Of the range of a signal, what a value may differ by from the foretold one: between the steps it is a fortieth of it.
const SURPRISE: f64 = 1e-4;
/// The same of its largest value: less is rounding.
const ROUNDING: f64 = 1e-9;
/// Halvings of a stretch at most.
const MAX_HALVINGS: u32 = 10;
/// Halvings of a run at most: these, and one a stretch. A signal that is rounding alone bends everywhere.
const SPARE_HALVINGS: u64 = 2000;
/// Changes of comparisons that a run is cut at, and halvings that look for them, at most.
const SPARE_CUTS: u64 = 100_000;

/// Values of what is reduced, at a time in s, written in the order of [`Reductions::outputs`].
pub(crate) type Values<'v> = dyn FnMut(f64, &mut [f64]) + 'v;

/// What of an output counts.
#[derive(Clone, Copy, PartialEq)]
enum Column {
    /// All of it.
    Signal,
    /// Whether a condition holds.
    Condition,
    /// What a comparison compares: all of it, for where it crosses zero.
    Margin,
    /// Its value at one instant.
    End,
}

/// The reductions of a run, up to now.
pub(crate) struct Reductions {
    /// The outputs that are read, ascending.
    outputs: Vec<usize>,
    sums: Vec<Sum>,
    /// Whether anything but the first and the last value of a run is read.
    along: bool,
    /// Nothing before counts, in s; then the first time that does.
    from_s: f64,
    begun: bool,
    /// The values since the last instant at which something happened.
    past: Past,
    /// The least and the largest value of each output.
    ranges: Vec<(f64, f64)>,
    columns: Vec<Column>,
    halvings_left: u64,
    cuts_left: u64,
    /// Room for the values of a piece, by output.
    room: Vec<[f64; POINTS]>,
}

impl Reductions {
    /// Those asked for; `None` where there are none.
    pub(crate) fn new(asked: &[Reduction], from_s: f64) -> Option<Self> {
        if asked.is_empty() {
            return None;
        }
        let ends = |one: &Reduction| matches!(one.kind, ReductionKind::First | ReductionKind::Last);
        let along = |one: &&Reduction| !ends(one) || one.condition.is_some();
        let margins = || asked.iter().filter(along).flat_map(|one| &one.margins);
        let read = asked.iter();
        let read = read.flat_map(|one| std::iter::once(one.output).chain(one.condition));
        let mut outputs: Vec<usize> = read.chain(margins().copied()).collect();
        outputs.sort_unstable();
        outputs.dedup();
        let column = |output: usize| outputs.partition_point(|&other| other < output);
        let mut columns = vec![Column::End; outputs.len()];
        for condition in asked.iter().filter_map(|one| one.condition) {
            columns[column(condition)] = Column::Condition;
        }
        for one in asked.iter().filter(|one| !ends(one)) {
            columns[column(one.output)] = Column::Signal;
        }
        for margin in margins() {
            columns[column(*margin)] = Column::Margin;
        }
        Some(Self {
            sums: asked
                .iter()
                .map(|one| Sum::new(one.kind, column(one.output), one.condition.map(column)))
                .collect(),
            along: asked.iter().any(|one| along(&one)),
            from_s,
            begun: false,
            past: Past::new(outputs.len()),
            ranges: vec![(f64::INFINITY, f64::NEG_INFINITY); outputs.len()],
            columns,
            halvings_left: SPARE_HALVINGS,
            cuts_left: SPARE_CUTS,
            room: vec![[0.0; POINTS]; outputs.len()],
            outputs,
        })
    }

    /// The outputs that it reads.
    pub(crate) fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// Takes in one side of an instant.
    pub(crate) fn point(&mut self, t: f64, values: &[f64]) {
        if t < self.from_s {
            return;
        }
        self.begin(t);
        self.extend_ranges(values);
        for sum in &mut self.sums {
            sum.point(t, values);
        }
        self.past.begin(t, values);
    }

    /// Takes in a stretch without corners, from the end of the last one on.
    pub(crate) fn stretch(&mut self, from: f64, to: f64, values: &mut Values<'_>) {
        let from = from.max(self.from_s);
        if !self.along || to <= from {
            return;
        }
        self.begin(from);
        self.halvings_left += 1;
        let width = self.outputs.len();
        let mut at = |t: f64| {
            let mut out = vec![0.0; width];
            values(t, &mut out);
            out
        };
        if self.past.ends_at() != Some(from) {
            self.past.begin(from, &at(from));
        }
        let right = at(to);
        self.extend_ranges(&right);
        let left: Vec<f64> = self.past.last().collect();
        if self.is_foretold(to, &left, &right) {
            self.past.add(to, &right);
            self.past.between(&left, &mut self.room);
            if self.turns(from, to) {
                self.past.begin(from, &left);
                return self.evaluate((from, to), left, right, &mut at);
            }
            for ((room, what), value) in self.room.iter_mut().zip(&self.columns).zip(&left) {
                if *what == Column::Condition {
                    *room = [*value; POINTS];
                }
            }
            let mut piece = Piece::new(from, to, &self.room, true, &mut at);
            self.sums.iter_mut().for_each(|sum| sum.piece(&mut piece));
        } else {
            self.evaluate((from, to), left, right, &mut at);
        }
    }

    /// Takes in a stretch by values inside it, halved until they show it.
    fn evaluate(
        &mut self,
        (from, to): (f64, f64),
        left: Vec<f64>,
        right: Vec<f64>,
        at: &mut dyn FnMut(f64) -> Vec<f64>,
    ) {
        // The last of each says whether its signals may jump where it begins.
        let mut pieces = vec![(from, to, left, right, 0, false)];
        while let Some((from, to, left, right, halvings, jumps)) = pieces.pop() {
            let times = lobatto::times(from, to);
            let [second, middle, fourth] = [times[1], times[MIDDLE], times[3]].map(&mut *at);
            let points = [left, second, middle, fourth, right];
            for values in &points {
                self.extend_ranges(values);
            }
            for (column, room) in self.room.iter_mut().enumerate() {
                *room = std::array::from_fn(|k| points[k][column]);
            }
            if self.cuts_left > 0
                && let Some((before, behind)) = self.change(&times, at)
            {
                self.cuts_left -= 1;
                let [left, .., right] = points;
                if behind < to {
                    pieces.push((behind, to, at(behind), right, halvings, true));
                }
                if before > from {
                    pieces.push((from, before, left, at(before), halvings, jumps));
                }
                continue;
            }
            let is_resolved = self.is_resolved(Column::Signal);
            let shows_changes = self.is_resolved(Column::Margin);
            let left = match is_resolved {
                true => &mut self.cuts_left,
                false => &mut self.halvings_left,
            };
            let narrow = times[MIDDLE] <= from || times[MIDDLE] >= to;
            if is_resolved && shows_changes || narrow || halvings == MAX_HALVINGS || *left == 0 {
                if jumps {
                    self.past.begin(from, &points[0]);
                }
                let mut piece = Piece::new(from, to, &self.room, is_resolved, at);
                self.sums.iter_mut().for_each(|sum| sum.piece(&mut piece));
                for (t, values) in times.iter().zip(&points).skip(1) {
                    self.past.add(*t, values);
                }
            } else {
                *left -= 1;
                let [left, _, middle, _, right] = points;
                let half = halvings + 1;
                pieces.push((times[MIDDLE], to, middle.clone(), right, half, false));
                pieces.push((from, times[MIDDLE], left, middle, half, jumps));
            }
        }
    }

    /// Whether a comparison changes in a stretch, as far as the values at its points show.
    fn turns(&self, from: f64, to: f64) -> bool {
        let times = lobatto::times(from, to);
        let mut margins = self.margins();
        margins.any(|column| cut::turn(&times, &self.room[column]).is_some())
    }

    fn margins(&self) -> impl Iterator<Item = usize> {
        let columns = self.columns.iter().enumerate();
        columns.filter_map(|(column, what)| (*what == Column::Margin).then_some(column))
    }

    /// The instants on both sides of where a comparison changes first between these times.
    fn change(
        &self,
        times: &[f64; POINTS],
        at: &mut dyn FnMut(f64) -> Vec<f64>,
    ) -> Option<(f64, f64)> {
        let mut first: Option<(f64, f64)> = None;
        for column in self.margins() {
            let above = |values: &[f64]| values[column] > 0.0;
            let Some((point, second)) = cut::turn(times, &self.room[column]) else {
                continue;
            };
            let at_first = self.room[column][point] > 0.0;
            if at_first != above(&at(second)) {
                let own = cut::change(at, (times[point], second), at_first, above);
                first = Some(first.map_or(own, |known| if own.0 < known.0 { own } else { known }));
            }
        }
        first
    }

    fn begin(&mut self, t: f64) {
        if !self.begun {
            (self.from_s, self.begun) = (t, true);
        }
    }

    fn extend_ranges(&mut self, values: &[f64]) {
        for (range, value) in self.ranges.iter_mut().zip(values) {
            *range = (range.0.min(*value), range.1.max(*value));
        }
    }

    /// What is small of an output.
    fn small(&self, column: usize, part: f64) -> f64 {
        let (least, most) = self.ranges[column];
        part * (most - least) + ROUNDING * least.abs().max(most.abs())
    }

    /// Whether the polynomials through the past show the values at a time.
    fn is_foretold(&self, t: f64, before: &[f64], values: &[f64]) -> bool {
        let is = |column: usize| {
            let (foretold, allowed) = match self.columns[column] {
                Column::Signal | Column::Margin => {
                    (self.past.value(column, t), self.small(column, SURPRISE))
                }
                Column::Condition => (before[column], 0.0),
                Column::End => return true,
            };
            (values[column] - foretold).abs() <= allowed
        };
        self.past.foretells() && (0..values.len()).all(is)
    }

    /// Whether the five values of all columns of a kind show what lies between them. What is not a number never does, nor more
    /// of them.
    fn is_resolved(&self, kind: Column) -> bool {
        let columns = self.room.iter().zip(&self.columns).enumerate();
        let mut columns = columns.filter(|(_, (_, what))| **what == kind);
        columns.all(|(column, (values, _))| {
            let bent = lobatto::beyond_cubic(values);
            bent.is_nan() || bent <= self.small(column, BENT)
        })
    }

    /// The reductions that have met what is not a number and do not yet know what: their numbers, and when first, in s.
    pub(crate) fn nameless(&self) -> Vec<(usize, f64)> {
        let sums = self.sums.iter().enumerate();
        sums.filter_map(|(number, sum)| Some((number, sum.nameless()?)))
            .collect()
    }

    /// Says which variable is not a number.
    pub(crate) fn name(&mut self, number: usize, variable: String) {
        self.sums[number].name(variable);
    }

    /// What a run that ended here is reduced to.
    pub(crate) fn finish(&self) -> Vec<Reduced> {
        let span = self.past.ends_at().map_or(0.0, |t| t - self.from_s);
        self.sums.iter().map(|sum| sum.finish(span)).collect()
    }
}
