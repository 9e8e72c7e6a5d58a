//! From where to where an axis goes when nobody says.

use crate::Scale;

/// Magnitudes beyond this are drawn as this, so that differences stay finite.
const LARGEST: f64 = 1e300;

/// How much room the data get.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Room {
    /// None: time and frequency fill the width; an end within 1 % of a round value goes there.
    Tight,
    /// 5 % at both ends, so that no curve lies on the frame.
    Padded,
}

/// The range for `values` (as shown): `lo < hi`, both finite, both positive on a log axis.
///
/// Without any value that can be shown: 0 to 1, on a log axis 1 to 10.
pub(crate) fn automatic(values: impl Iterator<Item = f64>, scale: Scale, room: Room) -> (f64, f64) {
    let log = scale == Scale::Log;
    let shown = values.filter(|value| value.is_finite() && (!log || *value > 0.0));
    let place = |value: f64| {
        if log {
            value.log10().clamp(-300.0, 300.0)
        } else {
            value.clamp(-LARGEST, LARGEST)
        }
    };
    let (lo, hi) = shown
        .map(place)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(lo, hi), at| {
            (lo.min(at), hi.max(at))
        });
    let (lo, hi) = if lo > hi {
        (0.0, 1.0)
    } else {
        widen(lo, hi, log, room)
    };
    if log {
        (10f64.powf(lo.max(-303.0)), 10f64.powf(hi.min(303.0)))
    } else {
        (lo, hi)
    }
}

/// The range asked for, if it can be shown: ends in order, distinct, finite, positive on a log axis.
pub(crate) fn usable(asked: (f64, f64), scale: Scale) -> Option<(f64, f64)> {
    let (lo, hi) = (
        asked.0.min(asked.1).max(-LARGEST),
        asked.0.max(asked.1).min(LARGEST),
    );
    let distinct = hi - lo > 1e-12 * lo.abs().max(hi.abs());
    (asked.0.is_finite()
        && asked.1.is_finite()
        && distinct
        && (scale != Scale::Log || lo >= 1.0 / LARGEST))
        .then_some((lo, hi))
}

/// Room around the data, in the coordinate along the axis (decades if `log`).
fn widen(lo: f64, hi: f64, log: bool, room: Room) -> (f64, f64) {
    let size = lo.abs().max(hi.abs());
    // A span in the last digits is a constant with rounding errors.
    let constant = hi - lo <= 1e-12 * size || hi - lo < 1e-299;
    if constant && log {
        return (lo - 0.5, hi + 0.5);
    }
    if constant {
        let around = if size < 1e-290 { 1.0 } else { 0.1 * size };
        return (lo - around, hi + around);
    }
    let span = hi - lo;
    match room {
        Room::Padded => (
            (lo - 0.05 * span).max(-1.1 * LARGEST),
            (hi + 0.05 * span).min(1.1 * LARGEST),
        ),
        Room::Tight => (snap(lo, span, f64::floor), snap(hi, span, f64::ceil)),
    }
}

/// The round value just outside `end`, if it is within 1 % of the span.
fn snap(end: f64, span: f64, outwards: fn(f64) -> f64) -> f64 {
    let step = 10f64.powf((span / 2.0).log10().floor());
    let round = outwards(end / step) * step;
    if (round - end).abs() <= 0.01 * span {
        round
    } else {
        end
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64], scale: Scale, room: Room) -> (f64, f64) {
        automatic(values.iter().copied(), scale, room)
    }

    fn close(found: (f64, f64), expected: (f64, f64)) {
        let size = expected.0.abs().max(expected.1.abs());
        // Rounding of a few operations, through log10 and powf on log axes.
        let near = |a: f64, b: f64| (a - b).abs() <= 1e-12 * size;
        assert!(
            near(found.0, expected.0) && near(found.1, expected.1),
            "{found:?} is not {expected:?}"
        );
    }

    #[test]
    fn nothing_to_show() {
        close(of(&[], Scale::Linear, Room::Padded), (0.0, 1.0));
        close(
            of(&[f64::NAN, f64::INFINITY], Scale::Linear, Room::Tight),
            (0.0, 1.0),
        );
        close(of(&[0.0, -3.0], Scale::Log, Room::Tight), (1.0, 10.0));
    }

    #[test]
    fn constants_get_a_tenth_on_both_sides() {
        close(of(&[0.0, 0.0], Scale::Linear, Room::Padded), (-1.0, 1.0));
        close(of(&[5.0], Scale::Linear, Room::Padded), (4.5, 5.5));
        close(
            of(&[-5.0, -5.0 + 1e-15], Scale::Linear, Room::Tight),
            (-5.5, -4.5),
        );
        close(
            of(&[100.0], Scale::Log, Room::Tight),
            (10f64.powf(1.5), 10f64.powf(2.5)),
        );
    }

    #[test]
    fn time_ends_at_a_round_value_if_nearly_there() {
        close(of(&[0.0, 1.9995], Scale::Linear, Room::Tight), (0.0, 2.0));
        close(of(&[0.0, 1.93], Scale::Linear, Room::Tight), (0.0, 1.93));
        close(of(&[1.001, 999.0], Scale::Log, Room::Tight), (1.0, 1000.0));
    }

    #[test]
    fn values_get_room_and_stay_finite() {
        close(
            of(&[-1.0, 1.0, f64::NAN], Scale::Linear, Room::Padded),
            (-1.1, 1.1),
        );
        let (lo, hi) = of(&[f64::MIN, f64::MAX], Scale::Linear, Room::Padded);
        assert!(lo.is_finite() && hi.is_finite() && (hi - lo).is_finite());
    }

    #[test]
    fn log_ranges_of_extreme_values_are_finite() {
        for values in [[5e-324, f64::MAX], [f64::MAX, f64::MAX], [5e-324, 5e-324]] {
            let (lo, hi) = of(&values, Scale::Log, Room::Padded);
            assert!(lo > 0.0 && hi > lo && hi.is_finite(), "{lo} {hi}");
        }
    }

    #[test]
    fn ranges_asked_for() {
        assert_eq!(usable((2.0, 1.0), Scale::Linear), Some((1.0, 2.0)));
        assert_eq!(usable((1.0, 1.0), Scale::Linear), None);
        assert_eq!(usable((f64::NAN, 1.0), Scale::Linear), None);
        assert_eq!(usable((0.0, 1.0), Scale::Log), None);
    }
}
