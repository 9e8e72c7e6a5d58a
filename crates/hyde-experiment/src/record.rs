//! A record as its experiment declares it: the table in a file, CSV or Parquet.

use crate::refusals::records as refused;
use hyde_diag::Diagnostic;
use hyde_signal::{CountUnit, DeclaredColumn, Layout, LayoutKind, Table};
use hyde_syntax::ast::{Expr, ExprKind, LayoutSetting, Name, RecordItem};
use hyde_units::NamedUnit;

/// Reads the content of a record's file; `name` is the file as messages call it.
///
/// # Errors
/// A diagnostic at the declaration: the content is no record, or the declaration cannot be followed.
pub fn read_record(item: &RecordItem, name: &str, bytes: &[u8]) -> Result<Table, Diagnostic> {
    hyde_signal::read(bytes, &layout(item)?).map_err(|error| {
        let repair = error.repair(&item.name.text);
        refused::unreadable(item, name, &error.to_string(), &repair)
    })
}

/// What is declared of the file.
fn layout(item: &RecordItem) -> Result<Layout, Diagnostic> {
    let mut layout = Layout {
        every_s: item.every.as_ref().map(period_s).transpose()?,
        kind: item.kind.as_ref().map(kind).transpose()?,
        ..Layout::default()
    };
    for setting in &item.layout {
        let (name, value) = (setting.name.text.as_str(), setting.value.text.as_str());
        let here = setting.value.span;
        let twice = || refused::setting_twice(&item.name.text, name, here);
        let known = matches!(
            name,
            "columns" | "header" | "separator" | "decimal" | "encoding" | "sheet" | "run"
        );
        if known && (setting.unit.is_some() || setting.wraps.is_some()) {
            return Err(refused::unit_of_setting(name, here));
        }
        match name {
            "time" if layout.time.is_some() => return Err(twice()),
            "time" => {
                if let Some(every) = &item.every {
                    return Err(refused::time_twice(setting.name.span, every.span));
                }
                layout.time = Some(column(setting)?);
            }
            "column" => layout.columns.push(column(setting)?),
            "columns" if layout.headings.is_some() => return Err(twice()),
            "columns" => {
                let names = value.split([',', ';']).map(|name| name.trim().to_owned());
                layout.headings = Some(names.collect());
            }
            "header" if layout.header.is_some() => return Err(twice()),
            "header" => {
                layout.header =
                    Some(whole(setting).ok_or_else(|| refused::header_is_no_line(here))?);
            }
            "run" if layout.run.is_some() => return Err(twice()),
            "run" => {
                let run = whole(setting).and_then(|run| usize::try_from(run).ok());
                layout.run = Some(
                    run.filter(|run| *run > 0)
                        .ok_or_else(|| refused::not_a_run(here))?,
                );
            }
            "separator" => {
                layout.separator =
                    Some(separator(value).ok_or_else(|| refused::not_a_separator(value, here))?)
            }
            "decimal" => {
                layout.decimal = Some(match value {
                    "." => '.',
                    "," => ',',
                    _ => return Err(refused::not_a_decimal_sign(value, here)),
                })
            }
            "sheet" => layout.sheet = Some(value.to_owned()),
            "encoding" => layout.encoding = Some(value.to_owned()),
            _ => return Err(refused::unknown_setting(&setting.name)),
        }
    }
    Ok(layout)
}

/// The value of a setting that counts.
fn whole(setting: &LayoutSetting) -> Option<u64> {
    let number = setting
        .number
        .filter(|number| *number >= 0.0 && number.fract() == 0.0);
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "checked above"
    )]
    number.map(|number| number as u64)
}

/// `layout twincat`.
fn kind(word: &Name) -> Result<LayoutKind, Diagnostic> {
    LayoutKind::of_word(&word.text).ok_or_else(|| {
        let known: Vec<String> = LayoutKind::words()
            .map(|word| format!("`{word}`"))
            .collect();
        refused::unknown_layout(word, &known)
    })
}

fn separator(text: &str) -> Option<char> {
    let mut signs = text.chars();
    match (text, signs.next(), signs.next()) {
        ("tab" | "\\t", ..) => Some('\t'),
        ("blank" | "blanks" | "space", ..) => Some(' '),
        (_, Some(sign), None) if sign.is_ascii() && !sign.is_alphanumeric() && sign != '"' => {
            Some(sign)
        }
        _ => None,
    }
}

/// `"cycle" in 125 [us] wraps 65536`.
fn column(setting: &LayoutSetting) -> Result<DeclaredColumn, Diagnostic> {
    let unit = setting.unit.as_ref().map(|(factor, unit)| {
        let named = NamedUnit::parse(&unit.text).map_err(|error| {
            let bad = match setting.name.text.as_str() {
                "time" => refused::bad_unit_of_time,
                _ => refused::bad_unit_of_column,
            };
            bad(&error.to_string(), unit.span)
        })?;
        Ok(CountUnit {
            factor: factor.unwrap_or(1.0),
            unit: named,
        })
    });
    let wraps = setting.wraps;
    if wraps.is_some_and(|period| period <= 0.0) {
        return Err(refused::wraps_after_nothing(setting.value.span));
    }
    Ok(DeclaredColumn {
        name: setting.value.text.clone(),
        unit: unit.transpose()?,
        wraps,
    })
}

/// `every 1 [ms]`.
fn period_s(expr: &Expr) -> Result<f64, Diagnostic> {
    literal_time(expr)
        .filter(|&period| period > 0.0)
        .ok_or_else(|| refused::bad_period(expr.span))
}

fn literal_time(expr: &Expr) -> Option<f64> {
    let ExprKind::Number(value, Some(unit)) = &expr.kind else {
        return None;
    };
    let unit = hyde_units::parse_unit(&unit.text).ok()?;
    (unit.dimension == hyde_units::Dimension::TIME).then(|| unit.to_si(*value))
}
