//! [`Sum`]: one signal over a run as one number, taken in piece by piece.

use super::cut::change;
use crate::lobatto::{self, POINTS, WEIGHTS};
use crate::results::Reduced;
use hyde_program::ReductionKind;
use hyde_signal::spectrum::strongest_frequency;

/// Even samples of a spectrum at least and at most.
const SAMPLES: (usize, usize) = (1 << 12, 1 << 18);
/// The part of the steps that may be shorter than the distance of the samples: those behind events.
const SHORTEST: f64 = 0.1;

/// A stretch of the solution without corners, or with one that is small.
pub(super) struct Piece<'p> {
    times: [f64; POINTS],
    columns: &'p [[f64; POINTS]],
    /// Whether a polynomial through the values shows what lies between them.
    is_resolved: bool,
    /// All values at any time in it.
    at: &'p mut dyn FnMut(f64) -> Vec<f64>,
}

impl<'p> Piece<'p> {
    pub(super) fn new(
        from: f64,
        to: f64,
        columns: &'p [[f64; POINTS]],
        is_resolved: bool,
        at: &'p mut dyn FnMut(f64) -> Vec<f64>,
    ) -> Self {
        Self {
            times: lobatto::times(from, to),
            columns,
            is_resolved,
            at,
        }
    }

    /// The stretches of it in which a condition holds.
    fn stretches(&mut self, condition: usize) -> Vec<(f64, f64)> {
        let holds = self.columns[condition].map(|value| value != 0.0);
        let mut stretches: Vec<(f64, f64)> = Vec::new();
        let mut since = holds[0].then_some(self.times[0]);
        for k in 1..POINTS {
            if holds[k] == holds[k - 1] {
                continue;
            }
            let true_there = |values: &[f64]| values[condition] != 0.0;
            let between = (self.times[k - 1], self.times[k]);
            let (before, behind) = change(self.at, between, holds[k - 1], true_there);
            match since.take() {
                Some(since) => stretches.push((since, before)),
                None => since = Some(behind),
            }
        }
        stretches.extend(since.map(|since| (since, self.times[POINTS - 1])));
        stretches
    }

    /// The largest value that `of` a signal has; `best` is what is known already.
    fn largest(&mut self, column: usize, sign: f64, best: f64) -> f64 {
        let values = self.columns[column].map(|value| sign * value);
        let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        let may_be_more = most + (most - least) > best && lobatto::may_peak(&values);
        let best = best.max(most);
        if !may_be_more {
            return best;
        }
        let span = self.times[POINTS - 1] - self.times[0];
        let mut read = |place: f64| {
            let t = self.times[0] + 0.5 * (place + 1.0) * span;
            sign * (self.at)(t)[column]
        };
        if self.is_resolved {
            let (place, value) = lobatto::largest(&values);
            return if value > best {
                best.max(read(place))
            } else {
                best
            };
        }
        // Round a corner: narrow down between the neighbours of the largest value.
        let most = (0..POINTS).fold(0, |most, k| if values[k] > values[most] { k } else { most });
        let side = |k: usize| lobatto::NODES[k.min(POINTS - 1)];
        let (mut a, mut b) = (side(most.saturating_sub(1)), side(most + 1));
        let (mut found, golden) = (best, 0.5 * (5.0_f64.sqrt() - 1.0));
        for _ in 0..40 {
            let (left, right) = (b - golden * (b - a), a + golden * (b - a));
            let (at_left, at_right) = (read(left), read(right));
            found = found.max(at_left).max(at_right);
            if at_left > at_right {
                b = right;
            } else {
                a = left;
            }
        }
        found
    }
}

/// What a value is made of, so far.
enum So {
    /// The largest of the signal times the sign.
    Extreme { sign: f64, best: f64 },
    /// The integral of the signal or of its square.
    Integral { square: bool },
    /// The first value, or the last.
    End { first: bool },
    /// Until when the signal was above zero: the first instant behind, infinite while it is.
    Settling { since_s: Option<f64> },
    /// The signal over time.
    Spectrum { time: Vec<f64>, values: Vec<f64> },
}

/// One reduction, up to now.
pub(super) struct Sum {
    kind: ReductionKind,
    column: usize,
    condition: Option<usize>,
    so: So,
    sum: f64,
    /// How long its condition has held, in s.
    held_s: f64,
    value: Option<f64>,
    /// When the signal was first not a number, in s, and what was.
    not_a_number: Option<(f64, Option<String>)>,
    /// Since when it has been none, in s, as far as a signal is looked at of which one end counts.
    nothing_since: Option<f64>,
}

impl Sum {
    pub(super) fn new(kind: ReductionKind, column: usize, condition: Option<usize>) -> Self {
        let so = match kind {
            ReductionKind::Max => So::Extreme {
                sign: 1.0,
                best: f64::NEG_INFINITY,
            },
            ReductionKind::Min => So::Extreme {
                sign: -1.0,
                best: f64::NEG_INFINITY,
            },
            ReductionKind::Mean | ReductionKind::Integral => So::Integral { square: false },
            ReductionKind::Rms => So::Integral { square: true },
            ReductionKind::First => So::End { first: true },
            ReductionKind::Last => So::End { first: false },
            ReductionKind::Settling => So::Settling { since_s: None },
            ReductionKind::Resonance => So::Spectrum {
                time: Vec::new(),
                values: Vec::new(),
            },
        };
        Self {
            kind,
            column,
            condition,
            so,
            sum: 0.0,
            held_s: 0.0,
            value: None,
            not_a_number: None,
            nothing_since: None,
        }
    }

    /// Takes note of a value that is not a number; whether it was. Where a condition stands, only what it takes counts.
    fn notes(&mut self, t: f64, value: f64) -> bool {
        if value.is_nan() && self.not_a_number.is_none() {
            self.not_a_number = Some((t, None));
        }
        value.is_nan()
    }

    pub(super) fn point(&mut self, t: f64, values: &[f64]) {
        let value = values[self.column];
        let holds = self.condition.is_none_or(|c| values[c] != 0.0);
        if let So::End { first } = self.so {
            let since = self.nothing_since.unwrap_or(t);
            self.nothing_since = value.is_nan().then_some(since);
            if holds && !(first && self.value.is_some()) {
                self.take_end(t, value);
            }
            return;
        }
        if !holds || self.notes(t, value) {
            return;
        }
        match &mut self.so {
            So::Extreme { sign, best } => *best = best.max(*sign * value),
            So::Settling { since_s } if value > 0.0 => *since_s = Some(f64::INFINITY),
            So::Settling { since_s } => *since_s = Some(since_s.map_or(t, |since| since.min(t))),
            So::Spectrum { time, values } => {
                time.push(t);
                values.push(value);
            }
            So::Integral { .. } => self.value = Some(value),
            So::End { .. } => {}
        }
    }

    /// The value at an end: what it is there alone tells whether it is a number.
    fn take_end(&mut self, t: f64, value: f64) {
        self.value = Some(value);
        let since = self.nothing_since.unwrap_or(t);
        self.not_a_number = value.is_nan().then_some((since, None));
    }

    pub(super) fn piece(&mut self, piece: &mut Piece<'_>) {
        if let So::End { first } = self.so {
            return self.end_in(piece, first);
        }
        let Some(condition) = self.condition else {
            return self.whole(piece);
        };
        if piece.columns[condition].iter().all(|holds| *holds != 0.0) {
            self.held_s += piece.times[POINTS - 1] - piece.times[0];
            return self.whole(piece);
        }
        for (from, to) in piece.stretches(condition) {
            let times = lobatto::times(from, to);
            let points = times.map(&mut *piece.at);
            let columns: Vec<[f64; POINTS]> = (0..piece.columns.len())
                .map(|column| std::array::from_fn(|k| points[k][column]))
                .collect();
            self.held_s += to - from;
            let is_resolved = piece.is_resolved;
            self.whole(&mut Piece {
                times,
                columns: &columns,
                is_resolved,
                at: &mut *piece.at,
            });
        }
    }

    /// Takes in all of a piece.
    fn whole(&mut self, piece: &mut Piece<'_>) {
        let values = piece.columns[self.column];
        let mut bad = false;
        for (t, value) in piece.times.iter().zip(values) {
            bad |= self.notes(*t, value);
        }
        if bad {
            return;
        }
        let half = 0.5 * (piece.times[POINTS - 1] - piece.times[0]);
        match &mut self.so {
            So::Extreme { sign, best } => *best = piece.largest(self.column, *sign, *best),
            So::Integral { square } => {
                let of = |v: f64| if *square { v * v } else { v };
                let parts = WEIGHTS.iter().zip(values);
                self.sum += half * parts.map(|(weight, v)| weight * of(v)).sum::<f64>();
            }
            So::Settling { since_s } => settle(since_s, piece, self.column),
            So::Spectrum {
                time,
                values: signal,
            } => {
                time.extend(&piece.times[1..]);
                signal.extend(&values[1..]);
            }
            So::End { .. } => {}
        }
    }

    /// The first or the last value of a stretch at which the condition holds.
    fn end_in(&mut self, piece: &mut Piece<'_>, first: bool) {
        let holds: [bool; POINTS] =
            std::array::from_fn(|k| self.condition.is_none_or(|c| piece.columns[c][k] != 0.0));
        if first && self.value.is_some() {
            return;
        }
        let at = if first {
            holds.iter().position(|holds| *holds)
        } else {
            holds.iter().rposition(|holds| *holds)
        };
        let Some(at) = at else { return };
        let beside = if first { at.wrapping_sub(1) } else { at + 1 };
        let (column, condition) = (self.column, self.condition);
        let t = match (condition, piece.times.get(beside)) {
            (Some(condition), Some(&beside)) => {
                let true_there = |values: &[f64]| values[condition] != 0.0;
                let t = piece.times[at];
                let between = (t.min(beside), t.max(beside));
                let (before, behind) = change(piece.at, between, !first, true_there);
                if first { behind } else { before }
            }
            _ => piece.times[at],
        };
        let value = (piece.at)(t)[column];
        self.take_end(t, value);
    }

    /// When it met what is not a number, as long as nobody has said what.
    pub(super) fn nameless(&self) -> Option<f64> {
        match &self.not_a_number {
            Some((t, None)) => Some(*t),
            _ => None,
        }
    }

    pub(super) fn name(&mut self, variable: String) {
        if let Some((_, name)) = &mut self.not_a_number {
            *name = Some(variable);
        }
    }

    pub(super) fn finish(&self, span_s: f64) -> Reduced {
        if let Some((t, variable)) = &self.not_a_number {
            let variable = variable.clone().unwrap_or_default();
            return Reduced::NotANumber { t: *t, variable };
        }
        let span_s = self.condition.map_or(span_s, |_| self.held_s);
        let instant = match self.condition {
            Some(_) => self.value,
            None => Some(self.value.unwrap_or(0.0)),
        };
        // Of no time it is that of an instant, if the condition holds at one.
        let mean = |of: fn(f64) -> f64| match span_s > 0.0 {
            true => Some(self.sum / span_s),
            false => instant.map(of),
        };
        let value = |found: Option<f64>| found.map_or(Reduced::Nothing, Reduced::Value);
        match (&self.so, self.kind) {
            (So::Extreme { best, .. }, _)
                if self.condition.is_some() && *best == f64::NEG_INFINITY =>
            {
                Reduced::Nothing
            }
            (So::Extreme { sign, best }, _) => Reduced::Value(sign * best),
            (So::Integral { .. }, ReductionKind::Mean) => value(mean(|instant| instant)),
            (So::Integral { square: true }, _) => {
                value(mean(|instant| instant * instant).map(f64::sqrt))
            }
            (So::Integral { .. }, _) => Reduced::Value(self.sum),
            (So::End { .. }, _) => value(self.value),
            (So::Settling { since_s }, _) => value(*since_s),
            (So::Spectrum { time, values }, _) => resonance(time, values),
        }
    }
}

/// Until when a signal is above zero, behind a piece of it.
fn settle(since_s: &mut Option<f64>, piece: &mut Piece<'_>, column: usize) {
    let values = piece.columns[column];
    let since = since_s.get_or_insert(piece.times[0]);
    if since.is_infinite() && values[0] <= 0.0 {
        // It came back where the stretch before was cut.
        *since = piece.times[0];
    }
    if values[POINTS - 1] > 0.0 {
        *since_s = Some(f64::INFINITY);
        return;
    }
    let above = |values: &[f64]| values[column] > 0.0;
    let last = values.iter().rposition(|value| *value > 0.0);
    let outside = last
        .map(|k| (piece.times[k], piece.times[k + 1]))
        .or_else(|| {
            // It may leave the band and come back between two points.
            let most = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let least = values.iter().copied().fold(f64::INFINITY, f64::min);
            if most + (most - least) <= 0.0 || !lobatto::may_peak(&values) {
                return None;
            }
            let (place, value) = lobatto::largest(&values);
            let [start, .., end] = piece.times;
            let t = start + 0.5 * (place + 1.0) * (end - start);
            (value > 0.0 && above(&(piece.at)(t))).then_some((t, end))
        });
    if let Some((from, to)) = outside {
        *since_s = Some(change(piece.at, (from, to), true, above).1);
    }
}

/// Where the spectrum is highest, of a signal read at even instants: as far apart as the short ones of its steps.
fn resonance(time: &[f64], values: &[f64]) -> Reduced {
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return Reduced::Nothing;
    };
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.retain(|step| *step > 0.0);
    steps.sort_by(f64::total_cmp);
    let Some(short) = steps.get((SHORTEST * steps.len() as f64) as usize) else {
        return Reduced::Nothing;
    };
    let count = ((last - first) / short).ceil() as usize;
    let count = count.clamp(SAMPLES.0, SAMPLES.1);
    let step = (last - first) / (count - 1) as f64;
    let mut row = 0;
    let even = (0..count).map(|k| {
        let t = first + k as f64 * step;
        while row + 2 < time.len() && time[row + 1] < t {
            row += 1;
        }
        let (from, to) = (row, (row + 1).min(time.len() - 1));
        let span = time[to] - time[from];
        let part = if span > 0.0 {
            ((t - time[from]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        values[from] + part * (values[to] - values[from])
    });
    let even: Vec<f64> = even.collect();
    match strongest_frequency(&even, 1.0 / step) {
        Ok(frequency) if frequency.is_finite() => Reduced::Value(frequency),
        Ok(_) | Err(_) => Reduced::Nothing,
    }
}
