//! What a trace shows of inertia and friction, by least squares over short blocks.
//!
//! ```text
//! J/K a + Tc/K sign(v) + b/K v + i0 = i        where the axis moves in one direction
//! ```
//! With block means of positions, p, the second difference is the acceleration weighted as the current is here:
//! `a = (p[k+1] - 2 p[k] + p[k-1])/T^2`, `i = (i[k-1] + 4 i[k] + i[k+1])/6`, `v = (p[k+1] - p[k-1])/(2 T)`
//! (quadratic B-spline; de Boor, A Practical Guide to Splines, chapter X).

use super::channels::Channels;
use super::{Template, Trace};
use hyde_signal::Cursor;
use nalgebra::{DMatrix, DVector};

/// The length of a block in s, and the fewest samples in one.
const BLOCK_S: f64 = 0.01;
const SAMPLES: usize = 5;
/// The axis moves where it is faster than this part of its greatest speed.
const MOVES: f64 = 0.05;
/// Fewer blocks, or less of the current explained, tell nothing.
const BLOCKS: usize = 20;
const EXPLAINED: f64 = 0.3;

/// Inertia and friction per torque or force of an ampere, at the motor; SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Estimate {
    pub(super) inertia: f64,
    pub(super) coulomb: f64,
    pub(super) viscous: f64,
    /// The current acts against the measured direction.
    pub(super) reversed: bool,
    /// The part of the current's mean square that they explain.
    pub(super) explained: f64,
}

/// Estimates from a trace, where it shows enough.
pub(super) fn of(
    trace: &Trace,
    channels: &Channels,
    template: Template,
    ratio: f64,
) -> Option<Estimate> {
    let (measured, factor) = match (&channels.motor, &channels.load) {
        (Some(motor), _) if motor.is_way(template) => (motor, 1.0 / ratio),
        (Some(motor), _) => (motor, 1.0),
        (None, Some(load)) if template == Template::Linear => (load, 1.0),
        (None, Some(load)) if template.slides() => (load, 1.0 / ratio),
        (None, Some(load)) => (load, ratio),
        (None, None) => return None,
    };
    let part = trace.table.holding(&measured.name);
    let (time, values) = (part.time(), part.column(&measured.name)?.values());
    let step_s = part.usual_step()?;
    let current = trace.table.signal(&channels.drive.name)?;
    let mut cursor = Cursor::default();
    let current: Vec<f64> = time
        .iter()
        .map(|&t| current.held(t + 1e-12, &mut cursor))
        .collect();
    let length = ((BLOCK_S / step_s).round() as usize).max(SAMPLES);
    let blocks = |values: &[f64], factor: f64| -> Vec<f64> {
        let whole = values.chunks_exact(length);
        whole
            .map(|block| factor * block.iter().sum::<f64>() / length as f64)
            .collect()
    };
    let (shown, current) = (blocks(values, factor), blocks(&current, 1.0));
    let block_s = step_s * length as f64;
    let motion = motion(&shown, &current, block_s, measured.is_speed);
    solve(&motion)
}

/// Current, acceleration and speed at a block.
type Moved = (f64, f64, f64);

fn motion(shown: &[f64], current: &[f64], block_s: f64, is_speed: bool) -> Vec<Moved> {
    let inner = 1..shown.len().saturating_sub(1);
    let each = inner.map(|k| {
        let (before, here, after) = (shown[k - 1], shown[k], shown[k + 1]);
        let (i0, i1, i2) = (current[k - 1], current[k], current[k + 1]);
        match is_speed {
            true => (
                (i0 + 2.0 * i1 + i2) / 4.0,
                (after - before) / (2.0 * block_s),
                here,
            ),
            false => (
                (i0 + 4.0 * i1 + i2) / 6.0,
                (after - 2.0 * here + before) / (block_s * block_s),
                (after - before) / (2.0 * block_s),
            ),
        }
    });
    let all: Vec<Moved> = each.collect();
    let fastest = all.iter().fold(0.0_f64, |most, (.., v)| most.max(v.abs()));
    let moves = |at: usize| {
        let near = &all[at.saturating_sub(1)..(at + 2).min(all.len())];
        let (.., own) = all[at];
        near.iter()
            .all(|(i, a, v)| v * own.signum() > MOVES * fastest && i.is_finite() && a.is_finite())
    };
    (0..all.len())
        .filter(|&at| moves(at))
        .map(|at| all[at])
        .collect()
}

fn solve(motion: &[Moved]) -> Option<Estimate> {
    if motion.len() < BLOCKS {
        return None;
    }
    let both_ways = motion.iter().any(|(.., v)| *v > 0.0) && motion.iter().any(|(.., v)| *v < 0.0);
    let columns = if both_ways { 4 } else { 3 };
    let matrix = DMatrix::from_fn(motion.len(), columns, |row, column| {
        let (_, a, v) = motion[row];
        [a, v.signum(), v, 1.0][column]
    });
    let currents = DVector::from_iterator(motion.len(), motion.iter().map(|(i, ..)| *i));
    let scale: Vec<f64> = matrix
        .column_iter()
        .map(|own| own.norm().max(1e-300))
        .collect();
    let scaled = DMatrix::from_fn(motion.len(), columns, |row, column| {
        matrix[(row, column)] / scale[column]
    });
    let found = scaled.clone().svd(true, true).solve(&currents, 1e-9).ok()?;
    let left = (&scaled * &found - &currents).norm_squared();
    let mean = currents.mean();
    let whole = currents.iter().map(|i| (i - mean).powi(2)).sum::<f64>();
    let explained = 1.0 - left / whole.max(1e-300);
    let inertia = found[0] / scale[0];
    let sign = inertia.signum();
    let positive = |at: usize| (sign * found[at] / scale[at]).max(0.0);
    (explained > EXPLAINED && inertia != 0.0).then(|| Estimate {
        inertia: inertia.abs(),
        coulomb: positive(1),
        viscous: positive(2),
        reversed: sign < 0.0,
        explained,
    })
}

#[cfg(test)]
mod tests {
    use super::{Moved, motion, solve};

    /// Strokes there and back: i = 2 a + 3 sign(v) + 0.5 v + 0.25.
    #[test]
    fn inertia_and_friction_of_strokes_are_found() {
        let block_s = 0.01;
        let place = |t: f64| 0.3 * (3.0 * t).sin() + 0.1 * (7.0 * t).sin();
        let fine = 200;
        let mean = |k: usize, f: &dyn Fn(f64) -> f64| {
            let at = |n: usize| block_s * (k as f64 + (n as f64 + 0.5) / f64::from(fine));
            (0..fine as usize).map(|n| f(at(n))).sum::<f64>() / f64::from(fine)
        };
        let speed = |t: f64| 0.9 * (3.0 * t).cos() + 0.7 * (7.0 * t).cos();
        let rate = |t: f64| -2.7 * (3.0 * t).sin() - 4.9 * (7.0 * t).sin();
        let drawn = |t: f64| 2.0 * rate(t) + 3.0 * speed(t).signum() + 0.5 * speed(t) + 0.25;
        let shown: Vec<f64> = (0..400).map(|k| mean(k, &place)).collect();
        let current: Vec<f64> = (0..400).map(|k| mean(k, &drawn)).collect();
        let moved: Vec<Moved> = motion(&shown, &current, block_s, false);
        let found = solve(&moved).unwrap();
        assert!((found.inertia - 2.0).abs() < 0.01, "{found:?}");
        assert!((found.coulomb - 3.0).abs() < 0.03, "{found:?}");
        assert!((found.viscous - 0.5).abs() < 0.03, "{found:?}");
        assert!(!found.reversed && found.explained > 0.999, "{found:?}");
    }

    #[test]
    fn a_current_that_counts_the_other_way_is_seen() {
        let motion: Vec<Moved> = (0..100)
            .map(|k| {
                let (a, v) = ((0.3 * f64::from(k)).sin(), (0.3 * f64::from(k)).cos());
                (-(2.0 * a + v.signum()), a, v)
            })
            .collect();
        let found = solve(&motion).unwrap();
        assert!(
            found.reversed && (found.coulomb - 1.0).abs() < 1e-9,
            "{found:?}"
        );
    }

    #[test]
    fn an_axis_that_stands_shows_nothing() {
        assert!(solve(&motion(&[1.0; 100], &[0.5; 100], 0.01, false)).is_none());
    }
}
