//! A record as its experiment declares it: the table in a file, CSV or Parquet.

use hyde_diag::{Code, Diagnostic};
use hyde_signal::Table;
use hyde_syntax::ast::{Expr, ExprKind, RecordItem};

/// Reads the content of a record's file; `name` is the file as messages call it.
///
/// # Errors
/// A diagnostic at the declaration: the content is no record, or `every` is no positive time.
pub fn read_record(item: &RecordItem, name: &str, bytes: &[u8]) -> Result<Table, Diagnostic> {
    let every = match &item.every {
        Some(expr) => Some(period_s(expr)?),
        None => None,
    };
    hyde_signal::read(bytes, every).map_err(|error| {
        Diagnostic::error(Code::BadRecord, format!("`{name}`: {error}"))
            .label(
                item.default.as_ref().unwrap_or(&item.name).span,
                "the record is declared here",
            )
            .help(error.repair())
    })
}

/// `every 1 [ms]`.
fn period_s(expr: &Expr) -> Result<f64, Diagnostic> {
    literal_time(expr)
        .filter(|&period| period > 0.0)
        .ok_or_else(|| {
            Diagnostic::error(Code::BadRecord, "the time between rows is no positive time")
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
