//! [`pulses`]: an effort forwards, backwards and forwards again, at several sizes: a free mass ends where it began, at rest.

/// The smallest pulse is this part of the largest one.
const SMALLEST: f64 = 0.25;
/// The axis is left alone for this part of each pattern behind it.
const PAUSE: f64 = 0.2;
/// A pulse rises and falls over this part of its time.
const EDGE: f64 = 0.2;

/// So many patterns of pulses of decreasing size over so many samples, the largest 1.
pub(super) fn pulses(sizes: usize, rows: usize) -> Vec<f64> {
    let sizes = sizes.max(1);
    let at = |row: usize| {
        let along = row as f64 / rows.max(2) as f64 * sizes as f64;
        let number = (along.floor() as usize).min(sizes - 1);
        let within = (along - number as f64) / (1.0 - PAUSE);
        let size = match sizes {
            1 => 1.0,
            _ => SMALLEST.powf(number as f64 / (sizes - 1) as f64),
        };
        size * pattern(within)
    };
    (0..rows).map(at).collect()
}

/// One pattern over 0 .. 1: a quarter forwards, a half backwards, a quarter forwards.
fn pattern(t: f64) -> f64 {
    let edge = 0.25 * EDGE;
    let whole = 1.0 - edge;
    let change = |at: f64| super::multisine::step((t - at * whole) / edge);
    change(0.0) - 2.0 * change(0.25) + 2.0 * change(0.75) - change(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A free mass that the effort pushes.
    #[test]
    fn a_free_mass_is_hardly_moved_in_the_end() {
        let rows = 20_000;
        let effort = pulses(3, rows);
        let (mut v, mut x, mut farthest) = (0.0, 0.0, 0.0_f64);
        for a in &effort {
            v += a;
            x += v;
            farthest = farthest.max(f64::abs(x));
        }
        let rows = rows as f64;
        assert!(v.abs() < 1e-3 * rows / 12.0, "{v}");
        assert!(x.abs() < 0.15 * farthest, "{x} of {farthest}");
        let peak = effort.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!((peak - 1.0).abs() < 1e-9, "{peak}");
    }
}
