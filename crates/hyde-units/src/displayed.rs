//! The unit that values are displayed in: on plots, in tables, in sentences.

use crate::{NamedUnit, Unit};

/// Numbers that are read easily.
const READABLE: std::ops::Range<f64> = 1e-3..1e5;

/// The unit that values are drawn in: that of SI, with the prefix that fits, for all that is declared in a multiple of it;
/// any other as it is declared.
pub fn drawn_in(unit: &NamedUnit) -> (String, Unit) {
    // J and N.m, Hz and 1/s are not told from each other by their dimensions.
    let symbol = unit.unit().is_si() && unit.text().chars().all(char::is_alphabetic);
    let usual = NamedUnit::usual(unit.unit().dimension);
    let drawn = match unit.is_multiple_of_si() && !symbol {
        true => &usual,
        false => unit,
    };
    (drawn.text().to_owned(), drawn.unit())
}

/// The unit that differences of values are drawn in: of temperatures in degC it is K.
pub fn difference_in(unit: &NamedUnit) -> (String, Unit) {
    match unit.unit().is_absolute() {
        true => drawn_in(&NamedUnit::usual(unit.unit().dimension)),
        false => drawn_in(unit),
    }
}

/// The unit that an error of this size is shown in, as on the console: that of the channel where it is read easily in it, else
/// that of SI.
pub fn error_in(unit: &NamedUnit, si: f64) -> (String, Unit) {
    let (_, own) = difference_in(unit);
    match READABLE.contains(&own.scale.remove(si).abs()) {
        true => difference_in(unit),
        false => drawn_in(&NamedUnit::usual(unit.unit().dimension)),
    }
}

/// A pure number has no unit on its axis.
pub fn shown(unit: &str) -> &str {
    if unit == "1" { "" } else { unit }
}
