//! A record as its experiment declares it: the table in a file, CSV or Parquet.

use hyde_diag::{Code, Diagnostic};
use hyde_signal::{Layout, Table, TimeColumn};
use hyde_syntax::ast::{Expr, ExprKind, RecordItem};
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
        time: None,
    };
    for setting in &item.layout {
        let (name, value) = (&setting.name, &setting.value);
        if name.text != "time" || layout.time.is_some() {
            let message = match layout.time {
                Some(_) => format!("the record `{}` has two settings", item.name.text),
                None => format!("a record has no setting `{}`", name.text),
            };
            return Err(Diagnostic::error(Code::BadRecord, message)
                .label(name.span, "not known here")
                .help("write which column is the time: `time = \"Timestamp\" in [ms]`"));
        }
        if let Some(every) = &item.every {
            let message = "the time of the record is declared twice";
            return Err(Diagnostic::error(Code::BadRecord, message)
                .label(name.span, "by a column")
                .label(every.span, "by a period")
                .help("leave one of the two out"));
        }
        let unit = setting.unit.as_ref().map(|unit| {
            NamedUnit::parse(&unit.text).map_err(|error| {
                Diagnostic::error(Code::BadUnit, error.to_string())
                    .label(unit.span, "the unit of the time")
                    .help("write a unit of time: `s`, `ms`, `us`")
            })
        });
        layout.time = Some(TimeColumn {
            name: value.text.clone(),
            unit: unit.transpose()?,
        });
    }
    Ok(layout)
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
