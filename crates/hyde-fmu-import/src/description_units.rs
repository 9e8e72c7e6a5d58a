//! Units that an FMU declares, as units of a model: a product of SI units with a factor and an offset.

use crate::description::{InSi, child};
use hyde_units::parse_unit;
use roxmltree::Node;
use std::collections::BTreeMap;

/// The unit definitions of an FMU.
pub(crate) struct Units {
    defined: BTreeMap<String, Option<Base>>,
}

/// A definition by SI units.
struct Base {
    text: String,
    factor: f64,
    offset: f64,
}

/// The base units of FMI with the words that Hyde has for them.
const BASE: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// Reads the unit definitions.
pub(crate) fn units(root: Node<'_, '_>) -> Units {
    let mut defined = BTreeMap::new();
    let all = child(root, "UnitDefinitions").into_iter();
    for unit in all.flat_map(|all| all.children()) {
        let Some(name) = unit.attribute("name") else {
            continue;
        };
        let base = child(unit, "BaseUnit").map(|base| {
            let number = |attribute: &str, otherwise: f64| {
                let value = base.attribute(attribute).map(str::trim);
                value
                    .and_then(|value| value.parse().ok())
                    .unwrap_or(otherwise)
            };
            let exponents = BASE.map(|unit| number(unit, 0.0) as i32);
            Base {
                text: product(&exponents),
                factor: number("factor", 1.0),
                offset: number("offset", 0.0),
            }
        });
        defined.insert(name.to_owned(), base);
    }
    Units { defined }
}

/// A product of SI units as Hyde writes it.
fn product(exponents: &[i32; 8]) -> String {
    let list = |sign: i32| -> Vec<String> {
        let pairs = BASE.iter().zip(exponents);
        pairs
            .filter(|(_, exponent)| **exponent * sign > 0)
            .map(|(unit, exponent)| match exponent.abs() {
                1 => (*unit).to_owned(),
                n => format!("{unit}^{n}"),
            })
            .collect()
    };
    let (above, below) = (list(1), list(-1));
    let above = match above.is_empty() {
        true => "1".to_owned(),
        false => above.join("."),
    };
    match below.len() {
        0 => above,
        1 => format!("{above}/{}", below[0]),
        _ => format!("{above}/({})", below.join(".")),
    }
}

impl Units {
    /// How a number in a unit becomes one in SI, and what is to be told of it. `relative` numbers are differences.
    pub(crate) fn in_si(&self, name: &str, relative: bool) -> Option<(InSi, Option<String>)> {
        let by_name = parse_unit(name).ok();
        let Some(Some(base)) = self.defined.get(name) else {
            // A name without a definition: what it means in Hyde.
            let unit = by_name?;
            let offset = if relative { 0.0 } else { unit.to_si(0.0) };
            let factor = unit.difference_to_si(1.0);
            let note =
                format!("the unit `{name}` is not defined by SI units: it is read as that of Hyde");
            let in_si = InSi {
                unit: name.to_owned(),
                factor,
                offset,
            };
            return Some((in_si, Some(note)));
        };
        if base.factor == 0.0 || !base.factor.is_finite() || !base.offset.is_finite() {
            return None;
        }
        let offset = if relative { 0.0 } else { base.offset };
        let si = parse_unit(&base.text).ok()?;
        // The name, if it means the same: so that the model shows values in it.
        let same = by_name.filter(|unit| {
            let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * a.abs().max(b.abs());
            unit.dimension == si.dimension
                && near(unit.difference_to_si(1.0), base.factor)
                && near(unit.to_si(0.0), base.offset)
                && !unit.is_absolute()
        });
        let unit = match same {
            Some(_) => name.to_owned(),
            None => base.text.clone(),
        };
        let in_si = InSi {
            unit,
            factor: base.factor,
            offset,
        };
        Some((in_si, None))
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
mod tests {
    use super::*;

    #[test]
    fn products_of_base_units_are_units_of_hyde() {
        let volt = product(&[1, 2, -3, -1, 0, 0, 0, 0]);
        assert_eq!(volt, "kg.m^2/(s^3.A)");
        let same = |text: &str, other: &str| {
            let (a, b) = (parse_unit(text).unwrap(), parse_unit(other).unwrap());
            assert_eq!(a.dimension, b.dimension, "{text}");
        };
        same(&volt, "V");
        same(&product(&[0, 0, -1, 0, 0, 0, 0, 1]), "rad/s");
        same(&product(&[0, 0, -1, 0, 0, 0, 0, 0]), "1/s");
        same(&product(&[0; 8]), "1");
    }

    #[test]
    fn a_unit_is_converted_as_its_definition_says() {
        let text = r#"<r><UnitDefinitions>
            <Unit name="rpm"><BaseUnit s="-1" rad="1" factor="0.10471975511965977"/></Unit>
            <Unit name="degC"><BaseUnit K="1" offset="273.15"/></Unit>
            <Unit name="nought"><BaseUnit m="1" factor="0"/></Unit>
            </UnitDefinitions></r>"#;
        let document = roxmltree::Document::parse(text).unwrap();
        let units = units(document.root_element());
        let (rpm, note) = units.in_si("rpm", false).unwrap();
        assert!((rpm.factor - std::f64::consts::PI / 30.0).abs() < 1e-15 && note.is_none());
        let (warm, _) = units.in_si("degC", false).unwrap();
        assert!((warm.factor * 20.0 + warm.offset - 293.15).abs() < 1e-12);
        let (warmer, _) = units.in_si("degC", true).unwrap();
        assert!((warmer.factor * 20.0 + warmer.offset - 20.0).abs() < 1e-12);
        assert!(units.in_si("nought", false).is_none());
        let (known, note) = units.in_si("mm", false).unwrap();
        assert!((known.factor - 1e-3).abs() < 1e-18 && note.is_some());
        assert!(units.in_si("furlong/fortnight", false).is_none());
    }
}
