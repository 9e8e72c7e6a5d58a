//! [`History`]: one quantity over the last while, as the solver's steps gave it.
//!
//! A step is kept as the polynomial of degree 6 through seven Chebyshev points of its interpolant. IDA's interpolant has
//! degree 5 at most, so of a state this is the interpolant itself. Steps form *pieces*; a piece ends where the quantity or
//! its slope jumps, and what is read stays within a piece until its end is asked for: at a jump the left and the right
//! limit are two readings.

use std::collections::VecDeque;

/// The Chebyshev points of a step, as parts of it: (1 - cos(k pi/6))/2.
pub(crate) const PLACES: [f64; 7] = [
    0.0,
    0.066_987_298_107_780_68,
    0.25,
    0.5,
    0.75,
    0.933_012_701_892_219_3,
    1.0,
];
/// Their weights in the barycentric formula (Berrut and Trefethen, SIAM Review 46 (2004) 501, eq. 5.4).
const WEIGHTS: [f64; 7] = [0.5, -1.0, 1.0, -1.0, 1.0, -1.0, 0.5];

/// A step, or a part of it.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Step {
    pub(crate) from: f64,
    pub(crate) to: f64,
    /// Values at [`PLACES`].
    pub(crate) values: [f64; 7],
}

/// Steps over which the quantity is smooth.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
struct Piece {
    /// The value it begins with.
    first: f64,
    steps: VecDeque<Step>,
    /// Where it ends, and whether the value jumps there; not known of the last piece.
    end: Option<(f64, bool)>,
}

/// A quantity over the last while.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct History {
    pieces: VecDeque<Piece>,
    /// The largest value it had: what is much smaller is rounding.
    largest: f64,
}

impl Step {
    /// The polynomial at a time within the step; what does not change is that to the last bit.
    pub(crate) fn value(&self, t: f64) -> f64 {
        let last = self.values[6];
        let part = (t - self.from) / (self.to - self.from);
        let (mut above, mut below) = (0.0, 0.0);
        for ((place, weight), value) in PLACES.iter().zip(WEIGHTS).zip(self.values) {
            let distance = part - place;
            if distance == 0.0 {
                return value;
            }
            above += weight / distance * (value - last);
            below += weight / distance;
        }
        last + above / below
    }

    /// Its slope at the end.
    fn last_slope(&self) -> f64 {
        let mut slope = 0.0;
        for ((place, weight), value) in PLACES.iter().zip(WEIGHTS).zip(self.values).take(6) {
            slope += weight / WEIGHTS[6] * (value - self.values[6]) / (1.0 - place);
        }
        slope / (self.to - self.from)
    }
}

impl History {
    /// A quantity that had one value for ever until `t`.
    pub(crate) fn constant(t: f64, value: f64) -> Self {
        let always = Step {
            from: f64::NEG_INFINITY,
            to: t,
            values: [value; 7],
        };
        Self {
            pieces: VecDeque::from([Piece {
                first: value,
                steps: VecDeque::from([always]),
                end: None,
            }]),
            largest: value.abs(),
        }
    }

    /// The value at a time, within the piece that is read now; beyond its end straight on.
    pub(crate) fn value(&self, t: f64) -> f64 {
        let Some(piece) = self.pieces.front() else {
            return 0.0;
        };
        let number = piece.steps.partition_point(|step| step.to < t);
        match (piece.steps.get(number), piece.steps.back()) {
            (Some(step), _) if step.from.is_infinite() => step.values[0],
            (Some(step), _) => step.value(t.max(step.from)),
            (None, Some(last)) if last.from.is_infinite() => last.values[6],
            (None, Some(last)) => last.values[6] + (t - last.to) * last.last_slope(),
            (None, None) => piece.first,
        }
    }

    /// Adds a step after the last one.
    pub(crate) fn push(&mut self, step: Step) {
        let size = |most: f64, value: &f64| most.max(value.abs());
        self.largest = step.values.iter().fold(self.largest, size);
        if let Some(piece) = self.pieces.back_mut() {
            piece.steps.push_back(step);
        }
    }

    /// Ends the last piece at `t` if the value or the slope there differs from side to side, and begins another one.
    pub(crate) fn mark(&mut self, t: f64, left: (f64, f64), right: (f64, f64)) {
        // Values on both sides are solved for to rounding; slopes come from a difference quotient.
        let jump = (left.0 - right.0).abs() > 1e-10 * self.largest.max(right.0.abs());
        let kink = (left.1 - right.1).abs() > 1e-4 * (left.1.abs() + right.1.abs());
        let Some(last) = self.pieces.back_mut().filter(|_| jump || kink) else {
            return;
        };
        if last.steps.is_empty() {
            last.first = right.0;
            let before = self.pieces.len().checked_sub(2);
            if let Some((_, jumps)) = before.and_then(|at| self.pieces[at].end.as_mut()) {
                *jumps |= jump;
            }
            return;
        }
        last.end = Some((t, jump));
        self.pieces.push_back(Piece {
            first: right.0,
            steps: VecDeque::new(),
            end: None,
        });
    }

    /// Where the piece that is read now ends.
    pub(crate) fn end(&self) -> Option<f64> {
        let (end, _) = self.pieces.front()?.end?;
        Some(end)
    }

    /// Goes on to the next piece. Returns whether the value jumps.
    pub(crate) fn next_piece(&mut self) -> bool {
        let ended = self.pieces.pop_front();
        matches!(
            ended,
            Some(Piece {
                end: Some((_, true)),
                ..
            })
        )
    }

    /// Forgets what lies before `t`.
    pub(crate) fn forget(&mut self, t: f64) {
        if let Some(piece) = self.pieces.front_mut() {
            while piece.steps.len() > 1 && piece.steps[0].to < t {
                piece.steps.pop_front();
            }
        }
    }
}

#[allow(clippy::float_cmp, reason = "limits at a jump are exact")]
#[cfg(test)]
mod tests {
    use super::*;

    fn step(from: f64, to: f64, f: impl Fn(f64) -> f64) -> Step {
        let values = PLACES.map(|part| f(from + part * (to - from)));
        Step { from, to, values }
    }

    #[test]
    fn a_polynomial_of_degree_six_is_kept_as_it_is() {
        let f = |t: f64| 1.0 - t + 0.3 * t.powi(3) - 0.01 * t.powi(6);
        let kept = step(0.5, 2.5, f);
        for t in [0.5, 0.51, 1.234, 2.0, 2.499, 2.5] {
            // Rounding of seven terms.
            assert!((kept.value(t) - f(t)).abs() < 1e-14, "{t}");
        }
        let slope = -1.0 + 0.9 * 2.5_f64.powi(2) - 0.06 * 2.5_f64.powi(5);
        assert!((kept.last_slope() - slope).abs() < 1e-12);
    }

    #[test]
    fn at_a_jump_each_piece_has_its_own_limit() {
        let mut history = History::constant(0.0, 5.0);
        history.mark(0.0, (5.0, 0.0), (1.0, 1.0));
        history.push(step(0.0, 1.0, |t| 1.0 + t));
        assert_eq!(history.value(-3.0), 5.0);
        assert_eq!(history.value(0.0), 5.0);
        assert_eq!(history.end(), Some(0.0));
        assert!(history.next_piece());
        assert_eq!(history.value(0.0), 1.0);
        assert!((history.value(0.25) - 1.25).abs() < 1e-15);
        assert_eq!(history.end(), None);
        // Beyond the last step straight on.
        assert!((history.value(1.5) - 2.5).abs() < 1e-12);
    }

    #[test]
    fn a_kink_ends_a_piece_and_a_smooth_event_does_not() {
        let mut history = History::constant(0.0, 0.0);
        history.mark(0.0, (0.0, 0.0), (0.0, 2.0));
        history.push(step(0.0, 1.0, |t| 2.0 * t));
        history.mark(1.0, (2.0, 2.0), (2.0, 2.0));
        history.push(step(1.0, 2.0, |t| 2.0 * t));
        assert_eq!(history.end(), Some(0.0));
        assert!(!history.next_piece());
        assert_eq!(history.end(), None);
        history.forget(1.5);
        assert!((history.value(1.5) - 3.0).abs() < 1e-15);
        // What is forgotten is not read again: the first step left begins at 1.
        assert!((history.value(0.5) - 2.0).abs() < 1e-15);
    }
}
