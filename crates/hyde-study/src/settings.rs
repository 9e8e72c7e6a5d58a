//! `--set path=value [unit]`.

use hyde_program::{Given, Parameter};
use hyde_units::{Agreement, Dimension, NamedUnit, format_value, significant};

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

/// Reads `saddle.M=320 [kg]`, with blanks or without.
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
    let word = value[..end].trim();
    let number: f64 = word.parse().map_err(|_| {
        let instead = instead_of(path.trim(), word);
        format!("`{text}`: `{word}` is not a number: {instead}")
    })?;
    if !number.is_finite() {
        return Err(format!("`{text}`: the number must be finite"));
    }
    let path = path.trim().to_owned();
    let behind = value[end..].trim();
    if behind.is_empty() {
        return Ok(Setting::of(path, number, None));
    }
    let Some(unit) = in_brackets(behind) else {
        let unit = behind.trim_matches(|c: char| "[]".contains(c) || c.is_whitespace());
        let instead = match NamedUnit::parse(unit) {
            Ok(_) if !unit.is_empty() => format!("`{path}='{word} [{unit}]'`"),
            Ok(_) | Err(_) => format!("`{path}={word}`, or with a unit `{path}='{word} [mm]'`"),
        };
        return Err(format!(
            "`{text}`: behind the number there is no unit in brackets: write {instead}"
        ));
    };
    let unit = NamedUnit::parse(unit).map_err(|error| format!("`{text}`: {error}"))?;
    Ok(Setting::of(path, unit.unit().to_si(number), Some(unit)))
}

/// The text of a unit, `[kg]`, without its brackets.
fn in_brackets(text: &str) -> Option<&str> {
    let unit = text.strip_prefix('[')?.strip_suffix(']')?.trim();
    let is_one = !unit.is_empty() && !unit.contains(['[', ']']);
    is_one.then_some(unit)
}

/// What to write instead of a word that is not a number.
fn instead_of(path: &str, word: &str) -> String {
    if word.starts_with('{') {
        return format!("an array is set element by element, `{path}[1]=…`");
    }
    if let Ok(number) = word.replacen(',', ".", 1).parse::<f64>() {
        return format!("the decimal sign is a point, `{path}={number}`");
    }
    let ends = word.char_indices().rev().map(|(at, _)| word.split_at(at));
    let mut parted = ends
        .filter_map(|(number, unit)| Some((number.parse::<f64>().ok()?, unit)))
        .filter(|(_, unit)| NamedUnit::parse(unit).is_ok());
    match parted.next() {
        Some((number, unit)) => {
            format!("a blank parts it from its unit, `{path}='{number} [{unit}]'`")
        }
        None => format!("write one number, and its unit if it has one, `{path}='2.5 [mm]'`"),
    }
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
        return check_si(setting, parameter);
    }
    let given = Given {
        value: setting.value,
        unit: setting.unit.as_ref(),
        truth: setting.truth,
    };
    let Some(misfit) = parameter.misfit(&given) else {
        return check_share(setting, parameter);
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

/// Whether a number without a unit is one beyond doubt: of a parameter in percent 7 may be 7 % or 700 %.
fn check_share(setting: &Setting, parameter: &Parameter) -> Result<(), String> {
    let (name, value) = (&setting.path, setting.value);
    let unit = parameter.unit.unit();
    let is_plain = setting.unit.is_some() || setting.truth || value.abs() <= 0.0;
    if is_plain || unit.is_si() || !parameter.dimension.is_dimensionless() {
        return Ok(());
    }
    let shown = parameter.unit.text();
    let whole = significant(unit.from_si(value), 10);
    Err(format!(
        "`{name}` is in {shown}: write `--set {name}='{value} [{shown}]'`, or `--set {name}='{whole} [{shown}]'` for the number {value}"
    ))
}

/// Whether a number that is SI as it stands is one that the parameter may have.
fn check_si(setting: &Setting, parameter: &Parameter) -> Result<(), String> {
    let (name, value) = (&setting.path, setting.value);
    if !value.is_finite() {
        return Err(format!(
            "`{name}` cannot be {value}: it takes finite numbers"
        ));
    }
    match parameter.allowed.refusal(value, &parameter.unit) {
        None => Ok(()),
        Some(why) => {
            let shown = format_value(value, &parameter.unit);
            Err(format!("`{name}` cannot be {shown}: {why}"))
        }
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
    fn values_take_their_unit_in_brackets() {
        let setting = parse("saddle.M=320 [kg]").unwrap();
        assert_eq!((setting.path.as_str(), setting.value), ("saddle.M", 320.0));
        for (wrong, instead) in [
            ("gap=12um", "gap='12 [um]'"),
            ("gap=1e-5m", "gap='0.00001 [m]'"),
            ("gap=1,5", "gap=1.5"),
            ("gap=2*3", "gap='2.5 [mm]'"),
        ] {
            let refused = parse(wrong).unwrap_err();
            assert!(refused.ends_with(&format!("`{instead}`")), "{refused}");
            assert!(parse(&instead.replace('\'', "")).is_ok(), "{instead}");
        }
        assert!(parse("m={1,2}").unwrap_err().ends_with("`m[1]=…`"));
        assert_eq!(parse("gap = 12[um]").unwrap().value, 12e-6);
        for wrong in [
            "12 um",
            "12 [um",
            "12[um",
            "12 um]",
            "12 [um]]",
            "12 [[um]",
            "12 [um] [m]",
            "12 [",
            "12 ]",
            "12[",
            "12 []",
        ] {
            let refused = parse(&format!("gap={wrong}")).unwrap_err();
            assert!(
                refused.contains("`gap='12 [") || refused.contains("`gap=12`"),
                "{refused}"
            );
        }
        assert_eq!(parse("n=3").unwrap().unit, None);
        let on = parse("on = true").unwrap();
        assert_eq!((on.value, on.truth), (1.0, true));
        assert!(parse("x").is_err());
        assert!(parse("x=1 [blah]").unwrap_err().contains("blah"));
    }
}
