//! A record as its experiment declares it: the table in a file, CSV or Parquet.

use hyde_diag::{Code, Diagnostic};
use hyde_signal::{CountUnit, DeclaredColumn, Layout, LayoutKind, Table};
use hyde_syntax::ast::{Expr, ExprKind, LayoutSetting, Name, RecordItem};
use hyde_units::NamedUnit;

/// Reads the content of a record's file; `name` is the file as messages call it.
///
/// # Errors
/// A diagnostic at the declaration: the content is no record, or the declaration cannot be followed.
pub fn read_record(item: &RecordItem, name: &str, bytes: &[u8]) -> Result<Table, Diagnostic> {
    hyde_signal::read(bytes, &layout(item)?).map_err(|error| {
        Diagnostic::error(Code::BadRecord, format!("`{name}`: {error}"))
            .label(
                item.default.as_ref().unwrap_or(&item.name).span,
                "the record is declared here",
            )
            .help(error.repair(&item.name.text))
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
        let wrong = |message: String, help: &str| {
            Diagnostic::error(Code::BadRecord, message)
                .label(setting.value.span, "declared here")
                .help(help.to_owned())
        };
        let twice = || {
            let message = format!("the record `{}` has `{name}` twice", item.name.text);
            wrong(message, "leave one of the two out")
        };
        let known = matches!(
            name,
            "columns" | "header" | "separator" | "decimal" | "encoding" | "sheet" | "run"
        );
        if known && (setting.unit.is_some() || setting.wraps.is_some()) {
            let message = format!("`{name}` has neither a unit nor a range");
            return Err(wrong(
                message,
                "units belong to columns: `column = \"x\" in [mm]`",
            ));
        }
        match name {
            "time" if layout.time.is_some() => return Err(twice()),
            "time" => {
                if let Some(every) = &item.every {
                    let message = "the time of the record is declared twice";
                    return Err(Diagnostic::error(Code::BadRecord, message)
                        .label(setting.name.span, "by a column")
                        .label(every.span, "by a period")
                        .help("leave one of the two out"));
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
                layout.header = Some(whole(setting).ok_or_else(|| {
                    wrong("the header is not the number of a line".to_owned(), "write its line, counted from 1: `header = 5`")
                })?);
            }
            "run" if layout.run.is_some() => return Err(twice()),
            "run" => {
                let run = whole(setting).and_then(|run| usize::try_from(run).ok());
                layout.run = Some(run.filter(|run| *run > 0).ok_or_else(|| {
                    wrong("the run is not the number of one".to_owned(), "write which run of the file is meant, counted from 1: `run = 2`")
                })?);
            }
            "separator" => layout.separator = Some(separator(value).ok_or_else(|| {
                wrong(
                    format!("`{value}` is not a separator"),
                    "write one sign, or a word for one: `separator = \";\"`, `\"tab\"`, `\"blank\"`",
                )
            })?),
            "decimal" => layout.decimal = Some(match value {
                "." => '.',
                "," => ',',
                _ => {
                    let message = format!("`{value}` is not a decimal sign");
                    return Err(wrong(message, "write `decimal = \".\"` or `decimal = \",\"`"));
                }
            }),
            "sheet" => layout.sheet = Some(value.to_owned()),
            "encoding" => layout.encoding = Some(value.to_owned()),
            _ => {
                let message = format!("a record has no setting `{name}`");
                return Err(Diagnostic::error(Code::BadRecord, message)
                    .label(setting.name.span, "not known here")
                    .help("its settings are `time`, `column`, `columns`, `header`, `separator`, `decimal`, `encoding`, `sheet` and `run`: `time = \"Timestamp\" in [ms]`"));
            }
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
        Diagnostic::error(
            Code::BadRecord,
            format!("there is no layout `{}`", word.text),
        )
        .label(word.span, "not known")
        .help(format!("its layouts are {}", known.join(", ")))
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
            let is = match setting.name.text.as_str() {
                "time" => (
                    "the unit of the time",
                    "write a unit of time: `s`, `ms`, `us`",
                ),
                _ => (
                    "the unit of the column",
                    "write a unit as in a model, `[mm/s]`",
                ),
            };
            Diagnostic::error(Code::BadUnit, error.to_string())
                .label(unit.span, is.0)
                .help(is.1)
        })?;
        Ok(CountUnit {
            factor: factor.unwrap_or(1.0),
            unit: named,
        })
    });
    let wraps = setting.wraps;
    if wraps.is_some_and(|period| period <= 0.0) {
        return Err(
            Diagnostic::error(Code::BadRecord, "a column wraps after a number above 0")
                .label(setting.value.span, "declared here")
                .help("write the number of its values: `wraps 65536` for 16 bits"),
        );
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
        .ok_or_else(|| {
            Diagnostic::error(
                Code::BadRecord,
                "the sampling period is not a positive time",
            )
            .label(expr.span, "a number with a unit of time is expected")
            .help("write `every 1 [ms]`")
        })
}

fn literal_time(expr: &Expr) -> Option<f64> {
    let ExprKind::Number(value, Some(unit)) = &expr.kind else {
        return None;
    };
    let unit = hyde_units::parse_unit(&unit.text).ok()?;
    (unit.dimension == hyde_units::Dimension::TIME).then(|| unit.to_si(*value))
}
