//! [`jogs`]: strokes both ways at several speeds, which show friction over speed.

use super::limits::{Impossible, Limits, Quantity};
use super::path::Path;
use super::profile::Profile;

/// The slowest speed is this part of the fastest one.
const SLOWEST: f64 = 1.0 / 30.0;
/// At most this part of a stroke is for speeding up and slowing down.
const RAMPS: f64 = 0.5;
/// The axis stands so long behind each move.
const DWELL_S: f64 = 0.1;

/// Strokes: for each speed there, back past the middle, and to the middle again.
pub(super) fn jogs(limits: &Limits, speeds: usize, duration_s: f64) -> Result<Path, Impossible> {
    let speeds = speeds.max(1);
    let half = 0.5 * limits.travel;
    let fastest = fastest(limits);
    let share_s = duration_s / speeds as f64;
    let (mut path, mut needed) = (Path::default(), Vec::new());
    for number in 0..speeds {
        let along = match speeds {
            1 => 0.0,
            _ => number as f64 / (speeds - 1) as f64,
        };
        let own = Limits {
            speed: fastest * SLOWEST.powf(along),
            ..*limits
        };
        let far = |to: f64| {
            let mut tried = Path::default();
            for place in [to, -to, 0.0] {
                tried.go(place, &own, DWELL_S);
            }
            tried
        };
        let least = (ramps(&own) / RAMPS).min(half);
        let shortest = far(least);
        if shortest.duration_s() > share_s {
            let binds = Profile::new(2.0 * least, &own).binds(limits);
            needed.push((shortest.duration_s(), binds));
            continue;
        }
        let (mut low, mut high) = (least, half);
        if far(high).duration_s() <= share_s {
            low = high;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if far(middle).duration_s() <= share_s {
                low = middle;
            } else {
                high = middle;
            }
        }
        for place in [low, -low, 0.0] {
            path.go(place, &own, DWELL_S);
        }
    }
    let most = needed.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    match most {
        None => Ok(path),
        Some((one_s, binds)) => Err(Impossible::Short {
            needed_s: one_s * speeds as f64,
            binds,
        }),
    }
}

/// The way of speeding up to a speed and slowing down again.
fn ramps(limits: &Limits) -> f64 {
    let a_top = limits.acceleration.min((limits.speed * limits.jerk).sqrt());
    limits.speed * (limits.speed / a_top + a_top / limits.jerk)
}

/// The highest speed whose ramps leave something of half the travel.
fn fastest(limits: &Limits) -> f64 {
    let fits = |speed: f64| ramps(&Limits { speed, ..*limits }) <= RAMPS * 0.5 * limits.travel;
    if fits(limits.speed) {
        return limits.speed;
    }
    let (mut low, mut high) = (0.0, limits.speed);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if fits(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// The limit that keeps jogs from the speed that they may have; `None` where they reach it.
pub(super) fn slowed_by(limits: &Limits) -> Option<Quantity> {
    (fastest(limits) < 0.999 * limits.speed).then_some(Quantity::Travel)
}
