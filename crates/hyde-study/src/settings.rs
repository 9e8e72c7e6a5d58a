//! `--set path=value [unit]`.

use hyde_program::{Given, Parameter};
use hyde_units::{Agreement, Dimension, NamedUnit};

/// A value set from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    /// Full name of the parameter.
    pub path: String,
    /// SI.
    pub value: f64,
    /// The unit it was written in; `None` where none was.
    pub unit: Option<NamedUnit>,
    /// It was written as `true` or `false`.
    pub truth: bool,
    /// It is in SI though it was written without a unit.
    pub si: bool,
}

impl Setting {
    /// A value in SI.
    pub fn of(path: String, value: f64, unit: Option<NamedUnit>) -> Self {
        Self {
            path,
            value,
            unit,
            truth: false,
            si: false,
        }
    }

    /// A value in SI that needs no unit.
    pub fn in_si(path: String, value: f64) -> Self {
        Self {
            si: true,
            ..Self::of(path, value, None)
        }
    }
}

/// Reads `saddle.M=320 [kg]`, with or without brackets and blanks.
pub fn parse(text: &str) -> Result<Setting, String> {
    let (path, value) = text
        .split_once('=')
        .ok_or_else(|| format!("`{text}`: write `path=value [unit]`"))?;
    let value = value.trim();
    if let Ok(truth) = value.parse::<bool>() {
        return Ok(Setting {
            truth: true,
            ..Setting::of(path.trim().to_owned(), f64::from(u8::from(truth)), None)
        });
    }
    let end = value
        .find(|c: char| c == '[' || c.is_whitespace())
        .unwrap_or(value.len());
    let number: f64 = value[..end]
        .trim()
        .parse()
        .map_err(|_| format!("`{text}`: `{}` is not a number", &value[..end]))?;
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
        return Ok(Setting::of(path, number, None));
    }
    let unit = NamedUnit::parse(unit).map_err(|error| format!("`{text}`: {error}"))?;
    Ok(Setting::of(path, unit.unit().to_si(number), Some(unit)))
}

/// The value, SI, of a number whose unit, if it has one, is of this dimension; none of anything else.
pub fn quantity(text: &str, dimension: Dimension) -> Option<f64> {
    let setting = parse(&format!("value={text}")).ok()?;
    let own = setting.unit.map_or(dimension, |unit| unit.unit().dimension);
    let fits = own.agreement(dimension) == Agreement::Same;
    (fits && !setting.truth).then_some(setting.value)
}

/// Whether a setting fits a parameter; what to write instead if not.
pub fn check(setting: &Setting, parameter: &Parameter) -> Result<(), String> {
    let name = &setting.path;
    if parameter.is_whole(name) {
        let len = parameter.len;
        return Err(format!(
            "`{name}` is an array of {len}: set its elements, `--set '{name}[1]=…'`"
        ));
    }
    if setting.si {
        return Ok(());
    }
    let given = Given {
        value: setting.value,
        unit: setting.unit.as_ref(),
        truth: setting.truth,
    };
    let Some(misfit) = parameter.misfit(&given) else {
        return Ok(());
    };
    let written: Vec<String> = misfit
        .instead
        .iter()
        .map(|value| format!("`--set {name}='{value}'`"))
        .collect();
    let reason = &misfit.reason;
    Err(match written.as_slice() {
        [turns, radians] => {
            format!("`{name}` {reason}: write {turns} if it counts turns, {radians} if radians")
        }
        [only] => format!("`{name}` {reason}: write {only}"),
        _ => format!("`{name}` {reason}"),
    })
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
            "`gap=12um`: `12um` is not a number"
        );
        assert_eq!(parse("gap = 12 um").unwrap().value, 12e-6);
        assert_eq!(parse("n=3").unwrap().unit, None);
        let on = parse("on = true").unwrap();
        assert_eq!((on.value, on.truth), (1.0, true));
        assert!(parse("x").is_err());
        assert!(parse("x=1 [blah]").unwrap_err().contains("blah"));
    }
}
