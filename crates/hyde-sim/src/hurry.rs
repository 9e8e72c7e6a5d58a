//! Events without end: a ball that bounces ever lower meets infinitely many in a finite time (Zeno).

use crate::failure::FailureKind;
use crate::results::{Event, EventKind};
use crate::setup::Setup;
use hyde_diag::Origin;

/// So many intervals must have become shorter each time, fewer if they shrink evenly.
const LEAST_COUNT: u64 = 12;
const LEAST_EVEN: u64 = 4;
const EVEN: f64 = 0.05;
/// Of intervals that shrink unevenly the slowest of so many ratios tells what is still to come.
const RATIOS: usize = 6;
/// What is still to come is nothing if it is this part of the first interval. A stroke, or a guard, may yet lead to a mode of
/// rest; a switch in the equations leads to none, and instants that are close run together into one.
const NOTHING: f64 = 1e-6;
const NOTHING_OF_A_SWITCH: f64 = 1e-4;
/// So many instants with events within a billionth of the run are no solution any more.
const MAX_AT_ONCE: u64 = 2000;
const AT_ONCE: f64 = 1e-9;

/// So many steps that take the run no further than this part of it would never end it.
const STEPS: u64 = 20_000;
const NO_FURTHER: f64 = 1e-5;

/// Whether events follow each other faster and faster, or steps.
#[derive(Default)]
pub(crate) struct Hurry {
    /// Of each condition, by its text and its origin.
    series: Vec<(String, Origin, Series)>,
    /// The time of the last instant with one `when` condition and nothing else, and the condition.
    alone: Option<(f64, String, Origin)>,
    /// Start of the window in which all events are counted, and their number.
    crowd: (f64, u64),
    /// The same for steps.
    steps: (f64, u64),
}

/// The events of one condition.
#[derive(Default)]
struct Series {
    /// Time of the last event in s.
    last: f64,
    /// The first interval of the run of ever shorter ones, the latest, and their number.
    first: f64,
    interval: f64,
    count: u64,
    /// The latest ratios of two intervals, the newest last, and how many in a row were near each other.
    ratios: [f64; RATIOS],
    even: u64,
}

impl Hurry {
    /// Takes note of the events of an instant, and tells if there is no end of them.
    pub(crate) fn no_end(
        &mut self,
        t: f64,
        events: &[Event],
        setup: &Setup<'_>,
    ) -> Option<FailureKind> {
        for (number, event) in events.iter().enumerate() {
            let same = |other: &Event| other.cause == event.cause && other.origin == event.origin;
            if events[..number].iter().any(same) {
                continue;
            }
            let mut known = self.series.iter_mut();
            let known = known.find(|known| known.0 == event.cause && known.1 == event.origin);
            let Some((.., series)) = known else {
                let series = Series {
                    last: t,
                    ..Series::default()
                };
                let (cause, origin) = (event.cause.clone(), event.origin.clone());
                self.series.push((cause, origin, series));
                continue;
            };
            let nothing = match matches!(event.kind, EventKind::Relation(_)) {
                true => NOTHING_OF_A_SWITCH,
                false => NOTHING,
            };
            if let Some(sum_s) = series.next(t, nothing) {
                let cause = event.cause.clone();
                return Some(FailureKind::Zeno { cause, sum_s });
            }
        }
        let at_once = AT_ONCE * (setup.stop_s - setup.start_s);
        if let Some(cause) = self.again_at_once(t, events, at_once) {
            return Some(FailureKind::Zeno { cause, sum_s: t });
        }
        let (start, _) = self.crowd;
        if t - start > at_once {
            self.crowd = (t, 0);
        }
        self.crowd.1 += 1;
        let (start, count) = self.crowd;
        (count > MAX_AT_ONCE).then_some(FailureKind::TooManyEvents {
            count,
            span_s: t - start,
        })
    }
}

impl Hurry {
    /// The `when` condition that became true again at once, with nothing else between: what bounces is too low to be told from
    /// what it bounces on.
    fn again_at_once(&mut self, t: f64, events: &[Event], at_once: f64) -> Option<String> {
        let before = self.alone.take();
        let [event] = events else {
            return None;
        };
        if event.kind != EventKind::When {
            return None;
        }
        self.alone = Some((t, event.cause.clone(), event.origin.clone()));
        let (last, cause, origin) = before?;
        let same = cause == event.cause && origin == event.origin;
        (same && t - last < at_once).then_some(cause)
    }

    /// Takes note of a step, and tells if they lead nowhere: something jumps to and fro that is no event.
    pub(crate) fn no_way(&mut self, t: f64, setup: &Setup<'_>) -> Option<FailureKind> {
        let (start, count) = &mut self.steps;
        *count += 1;
        if *count < STEPS {
            return None;
        }
        let span_s = t - *start;
        (*start, *count) = (t, 0);
        let told = format!("{STEPS} steps advanced it by only {span_s:.1e} s");
        (span_s < NO_FURTHER * (setup.stop_s - setup.start_s)).then_some(FailureKind::Solver(told))
    }
}

impl Series {
    /// Takes note of the next event. If they have become ever faster down to nothing: the time in s that they add up to, with
    /// intervals that shrink as the last did. What is still to come is `nothing` if it is that part of the first.
    fn next(&mut self, t: f64, nothing: f64) -> Option<f64> {
        let interval = t - self.last;
        let ratio = interval / self.interval;
        if interval < self.interval {
            self.count += 1;
        } else {
            (self.first, self.count) = (interval, 0);
        }
        let near = (ratio - self.ratios[RATIOS - 1]).abs() <= EVEN * ratio;
        self.even = if near { self.even + 1 } else { 0 };
        self.ratios.rotate_left(1);
        self.ratios[RATIOS - 1] = ratio;
        (self.last, self.interval) = (t, interval);
        // A geometric series. Intervals that only shrink for a while, as where a heavy ball turns back a light one, or one
        // short interval in a swept sine, have a ratio near one among the latest, and their rest stays long.
        let slowest = if self.count >= LEAST_EVEN && self.even + 2 >= LEAST_EVEN {
            ratio
        } else if self.count >= LEAST_COUNT {
            self.ratios.iter().copied().fold(0.0, f64::max)
        } else {
            return None;
        };
        let rest = interval * slowest / (1.0 - slowest);
        (rest < nothing * self.first).then_some(t + rest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The time to which a condition with events after these intervals is told to add up.
    fn told(mut intervals: impl Iterator<Item = f64>) -> Option<f64> {
        let (mut series, mut t) = (Series::default(), 0.0);
        intervals.find_map(|interval| {
            t += interval;
            series.next(t, NOTHING)
        })
    }

    #[test]
    fn a_geometric_series_is_told_with_its_sum() {
        let end = told((0..100).map(|k| 0.5_f64.powi(k))).expect("it has an end");
        // 1 + 1/2 + 1/4 + …, each known to rounding of the time.
        assert!((end - 2.0).abs() < 1e-9, "{end}");
    }

    #[test]
    fn one_short_interval_in_a_swept_sine_is_none() {
        // Friction that sticks once a period, the periods 1 % shorter each, and lets go once for a moment.
        let periods = (0..40).map(|k| 0.1 * 0.99_f64.powi(k));
        assert_eq!(told(periods.chain([0.0003, 0.0662, 0.0655])), None);
    }

    #[test]
    fn intervals_that_shrink_and_grow_again_are_none() {
        // Impacts of a heavy ball that drives a light one to a wall and turns, masses as a million to one: times go with the
        // cotangent of equal angles (Galperin 2003).
        let time = |k: i32| -1.0 / (f64::from(k) * 1e-3).tan();
        assert_eq!(told((1..3141).map(|k| time(k + 1) - time(k))), None);
        assert_eq!(told(std::iter::repeat_n(1e-3, 100)), None);
    }
}
