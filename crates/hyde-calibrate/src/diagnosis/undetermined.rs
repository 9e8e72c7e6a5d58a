//! Shapes of an effect that its records do not determine: each stays as declared.
//!
//! A saturation that is seen over its first part alone looks the same in every form. Its fit then runs along a valley to the
//! end of the range, and what stands on a bound says "something like it, but not this". Where the interval of such a shape
//! holds its declared value, that says as much as any other: it is kept, and the rest is fitted again ([`held`]). So is one that
//! makes up for the size without end, as the time constant of a drift that has only begun: neither is told beside the other.
//!
//! What is told of everything else is then true for the declared value alone: [`super::spread`] looks at all the others.

use super::hypothesis::Knob;
use crate::fit::{LIMIT, Solution, Varied, covariance, inflation, inflation_of};
use hyde_signal::statistics::distributions::TWO_SIDED;
use std::ops::Range;

/// Takes the shapes that might as well be as declared from what is varied, and with them their values, where they stand on a
/// bound, or where no essential size is told beside them; gives their full names and declared values. `own` are the numbers of
/// what the effect varies, `essential` those of its essential sizes.
pub(crate) fn held(
    solution: &Solution,
    varied: &mut Vec<Varied>,
    values: &mut Vec<f64>,
    shapes: &[Knob],
    own: Range<usize>,
    mut essential: Range<usize>,
) -> Vec<(String, f64)> {
    let covariance = covariance(solution, inflation_of(solution, own.clone()));
    let deviation = |number: usize, varied: &Varied| {
        covariance[(number, number)].max(0.0).sqrt() * varied.scale()
    };
    let told = essential
        .any(|size| solution.values[size].abs() > TWO_SIDED * deviation(size, &varied[size]));
    let mut held = Vec::new();
    for number in own.rev() {
        let name = &varied[number].name;
        let mut shapes = shapes.iter();
        let Some(shape) = shapes.find(|shape| name.ends_with(&format!(".{}", shape.name))) else {
            continue;
        };
        let off = (values[number] - shape.value).abs();
        let free = !told || shape.is_at_bound(values[number]);
        if free && off <= TWO_SIDED * deviation(number, &varied[number]) {
            held.push((varied.remove(number).name, shape.value));
            values.remove(number);
        }
    }
    held
}

/// By how much the cost of a solution may grow where so many of its numbers are held elsewhere: the records allow that.
pub(crate) fn given_up(solution: &Solution, count: usize) -> f64 {
    LIMIT * count as f64 * inflation(&solution.innovations)
}
