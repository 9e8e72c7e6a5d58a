//! `--set path=value [unit]`.

use hyde_units::{Agreement, Dimension, NamedUnit};

/// A value set from outside.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Setting {
    /// Full name of the parameter.
    pub(crate) path: String,
    /// SI.
    pub(crate) value: f64,
    /// Dimension of the unit; `None` where none was written.
    pub(crate) dimension: Option<Dimension>,
}

/// Reads `saddle.M=320 [kg]`, with or without brackets and blanks.
pub(crate) fn parse(text: &str) -> Result<Setting, String> {
    let (path, value) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}`: write `path=value [unit]`"))?;
    let value = value.trim();
    let end = value
        .find(|c: char| c == '[' || c.is_whitespace())
        .unwrap_or(value.len());
    let number: f64 = value[..end]
        .trim()
        .parse()
        .map_err(|_| format!("`{text}`: `{}` is no number", &value[..end]))?;
    if !number.is_finite() {
        return Err(format!("`{text}`: the number must be finite"));
    }
    let unit = value[end..]
        .trim()
        .trim_start_matches('[')
        .trim_end_matches(']')
        .trim();
    let path = path.trim().to_owned();
    if unit.is_empty() {
        return Ok(Setting {
            path,
            value: number,
            dimension: None,
        });
    }
    let unit = NamedUnit::parse(unit).map_err(|error| format!("`{text}`: {error}"))?;
    let unit = unit.unit();
    Ok(Setting {
        path,
        value: unit.to_si(number),
        dimension: Some(unit.dimension),
    })
}

/// Whether a setting fits a parameter; what to write instead if not.
pub(crate) fn check(
    setting: &Setting,
    name: &str,
    dimension: Dimension,
    unit: &NamedUnit,
) -> Result<(), String> {
    let shown = unit.text();
    match setting.dimension {
        None if dimension.is_dimensionless() || setting.value == 0.0 => Ok(()),
        None => Err(format!(
            "`{name}` has a unit: write `--set {name}='{} [{shown}]'`",
            setting.value
        )),
        Some(given) if given.agreement(dimension) == Agreement::Different => {
            Err(format!("`{name}` is in {shown}, not in {given}"))
        }
        Some(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(
        clippy::float_cmp,
        reason = "a number without a prefix is the nearest double"
    )]
    fn values_take_their_unit_with_or_without_brackets() {
        let setting = parse("saddle.M=320 [kg]").unwrap();
        assert_eq!((setting.path.as_str(), setting.value), ("saddle.M", 320.0));
        assert_eq!(
            parse("gap=12um").unwrap_err(),
            "`gap=12um`: `12um` is no number"
        );
        assert_eq!(parse("gap = 12 um").unwrap().value, 12e-6);
        assert_eq!(parse("n=3").unwrap().dimension, None);
        assert!(parse("x").is_err());
        assert!(parse("x=1 [blah]").unwrap_err().contains("blah"));
    }
}
