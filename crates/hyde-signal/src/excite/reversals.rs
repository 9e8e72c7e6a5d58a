//! [`reversals`]: small moves there and back at several places, which show backlash and the spring of friction.

use super::limits::{Impossible, Limits, Quantity};
use super::path::Path;

/// The outermost places are this part of the way to the ends of the travel.
const OUTERMOST: f64 = 0.8;
/// There and back so many times at each place at least and at most.
const TIMES: (usize, usize) = (2, 20);
/// A small move takes so long, unless limits make it slower, s; the axis stands as long behind it.
const MOVE_S: f64 = 0.4;
/// The axis stands so long before the first and behind the last small move of a place.
const DWELL_S: f64 = 0.2;

/// Small moves of a size at so many places.
pub(super) fn reversals(
    limits: &Limits,
    places: usize,
    size: f64,
    duration_s: f64,
) -> Result<Path, Impossible> {
    let places = places.max(1);
    let outermost = OUTERMOST * 0.5 * limits.travel;
    if size >= (1.0 - OUTERMOST) * limits.travel {
        return Err(Impossible::Reversal);
    }
    // A move as quick as its time lets it be: its mean speed is half its top speed.
    let slow = Limits {
        speed: limits.speed.min(2.0 * size / MOVE_S),
        ..*limits
    };
    let path = |times: usize| {
        let mut path = Path::default();
        for number in 0..places {
            let along = match places {
                1 => 0.0,
                _ => 2.0 * number as f64 / (places - 1) as f64 - 1.0,
            };
            let place = along * outermost;
            path.go(place, limits, DWELL_S);
            for _ in 0..times {
                path.go(place + 0.5 * size, &slow, 0.5 * MOVE_S);
                path.go(place - 0.5 * size, &slow, 0.5 * MOVE_S);
            }
            path.go(place, &slow, DWELL_S);
        }
        path.go(0.0, limits, DWELL_S);
        path
    };
    let least = path(TIMES.0);
    if least.duration_s() > duration_s {
        let long = super::profile::Profile::new(2.0 * outermost, limits);
        let small = super::profile::Profile::new(size, &slow);
        let by_moves = small.duration_s() > 1.5 * MOVE_S || places == 1;
        let binds = match by_moves {
            true => small.binds(limits),
            false => long.binds(limits),
        };
        return Err(Impossible::Short {
            needed_s: least.duration_s(),
            binds: match binds {
                Quantity::Travel | Quantity::Effort => Quantity::Speed,
                own @ (Quantity::Speed | Quantity::Acceleration | Quantity::Jerk) => own,
            },
        });
    }
    let more = (TIMES.0 + 1..=TIMES.1).map(path);
    let fits = more.take_while(|path| path.duration_s() <= duration_s);
    Ok(fits.last().unwrap_or(least))
}
