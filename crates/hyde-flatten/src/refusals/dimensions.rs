//! What is said of dimensions: of sides that disagree, of turns and radians, of zero points of temperatures.

use hyde_diag::{InstancePath, Span, diagnostics};
use hyde_units::{Dimension, Exponent};

diagnostics! {
    /// `message` says both dimensions.
    fn angle_differs(
        message: &str, (left, a): (Span, Dimension), (right, b): (Span, Dimension), repair: &str,
    ) = warning AngleMismatch {
        "{message}"; at left, "this is {}", short(a); at right, "this is {}", short(b);
        note "the two differ only in the power of the angle: Hz counts turns, rad/s radians";
        help "{repair}";
    }
    /// `message` says both dimensions; the sides are one place if one of them is not written.
    fn dimensions_differ(
        message: &str, (left, a): (Span, Dimension), (right, b): (Span, Dimension),
        instance: &InstancePath, repair: Option<String>,
    ) = error UnitMismatch {
        "{message}";
        match (left == right) {
            true => { at right, "this is {}, not {}", named(b), named(a); }
            false => {
                at left, "this is {}", named(a);
                at right, "this is {}", named(b);
            }
        }
        match (instance.as_str()) {
            "" => {}
            _ => { note "in instance `{instance}`"; }
        }
        if let Some(repair) = repair { help "{repair}"; }
    }
    fn no_root(exponent: Exponent, (left, right): (Span, Span)) = error UnitMismatch {
        "no dimension to the power {exponent} makes the two sides equal";
        match (left == right) {
            true => {}
            false => { at left, "this side"; }
        }
        at right, "has a variable without a unit, to this power";
        help "declare the variable with a type or a unit, and divide it by a reference value of that unit before it is raised: `(x/(1 [m]))^1.3`";
    }
    fn difference_with_zero(here: Span, zero: &str, plain: &str) = warning ZeroPoint {
        "a difference of temperatures is shown in a unit with a zero point of its own"; at here, "0 {plain} is shown as {zero}";
        help "write `in [{plain}]`";
    }
    fn turn_applied_twice(advance: Span, angle: Span) = warning AngleMismatch {
        "the factor 2*pi for one turn is applied twice";
        at advance, "2*pi times a quantity per radian: the advance of a turn";
        at angle, "times an angle in radians";
        note "units such as mm/rev are converted to m/rad when they are read";
        help "remove the `2*pi`";
    }
    fn lost_turn(product: Span, factor: &str) = warning AngleMismatch {
        "a quantity per radian times turns per second: a factor 2*pi is missing";
        at product, "per radian, times a frequency";
        note "Hz and 1/min count turns; units such as mm/rev are converted to m/rad when they are read";
        help "write `2*pi*{factor}`, or give the frequency the unit of an angular velocity: `rpm`, `rev/s`";
    }
    fn sine_of_turns(function: &str, argument: Span, factor: &str) = warning AngleMismatch {
        "`{function}` of a number of turns: a factor 2*pi is missing";
        at argument, "a frequency times a time counts turns";
        help "write `{function}(2*pi*{factor})`";
    }
    fn turn_divided_twice((left, a): (Span, Option<Dimension>), turn: Span) = warning AngleMismatch {
        "a quantity that is per radian already, over 2*pi";
        at left, "this is {}", a.map_or_else(String::new, short);
        at turn, "divides by the turn again";
        note "units such as mm/rev are converted to m/rad when they are read";
        help "remove the `2*pi`";
    }
    fn zero_point_counts(how: &str, literal: Span, difference: &str) = warning ZeroPoint {
        "a temperature with its zero point is {how}"; at literal, "its zero point counts as well";
        help "write `{difference}` for a difference";
    }
    fn below_absolute_zero(literal: Span, least: &str) = error ZeroPoint {
        "no temperature is below absolute zero"; at literal, "below {least}";
        help "write a difference of temperatures in K";
    }
    fn zero_point_of_width(width: Span, help: &str) = warning ZeroPoint {
        "a noise or a band counts from the zero point of a temperature"; at width, "counts from a zero point that is not 0 K";
        help "{help}";
    }
    fn beside_difference(difference: Span, own: Span, help: &str) = warning ZeroPoint {
        "a difference of temperatures beside a temperature with its zero point";
        at own, "counts from a zero point that is not 0 K";
        at difference, "a difference, in K";
        help "{help}";
    }
}

/// A dimension as said of a place.
fn named(dimension: Dimension) -> String {
    if dimension.is_dimensionless() {
        short(dimension)
    } else {
        dimension.to_string()
    }
}

/// A dimension in one word: its usual unit.
pub(crate) fn short(dimension: Dimension) -> String {
    let unit = dimension.usual_unit();
    if unit.is_empty() || unit == "1" {
        "a pure number".to_owned()
    } else {
        unit
    }
}
