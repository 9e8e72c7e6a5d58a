//! Shapes of an effect that its records do not determine: each stays as declared.
//!
//! A saturation that is seen over its first part alone looks the same in every form. Its fit then runs along a valley to the
//! end of the range, and what stands on a bound says "something like it, but not this". Where the interval of such a shape
//! holds its declared value, that says as much as any other: it is kept, and the rest is fitted again.

use super::hypothesis::Knob;
use crate::fit::{Solution, Varied, covariance, inflation_of};
use hyde_signal::statistics::distributions::TWO_SIDED;
use std::ops::Range;

/// Takes the shapes that stand on a bound and might as well be as declared from what is varied, and with them their
/// values; gives their full names and declared values. `own` are the numbers of what the effect varies.
pub(crate) fn held(
    solution: &Solution,
    varied: &mut Vec<Varied>,
    values: &mut Vec<f64>,
    shapes: &[Knob],
    own: Range<usize>,
) -> Vec<(String, f64)> {
    let covariance = covariance(solution, inflation_of(solution, own.clone()));
    let mut held = Vec::new();
    for number in own.rev() {
        let name = &varied[number].name;
        let mut shapes = shapes.iter();
        let Some(shape) = shapes.find(|shape| name.ends_with(&format!(".{}", shape.name))) else {
            continue;
        };
        let deviation = covariance[(number, number)].max(0.0).sqrt() * varied[number].scale();
        let off = (values[number] - shape.value).abs();
        if shape.is_at_bound(values[number]) && off <= TWO_SIDED * deviation {
            held.push((varied.remove(number).name, shape.value));
            values.remove(number);
        }
    }
    held
}
