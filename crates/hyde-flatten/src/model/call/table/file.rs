//! Tables from files: `table(x, "grease.csv", "v", "F")` takes the places from one column and the values from another,
//! `table(x, "grease.csv")` from the first two.

use super::Points;
use crate::TableFile;
use crate::dimension::Dim;
use crate::model::{Model, listed};
use crate::names::nearest;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_syntax::ast::{Expr, ExprKind};
use hyde_units::NamedUnit;

type Column = (String, Option<NamedUnit>, Vec<f64>);

/// Rows of a file at most: more take minutes to compile.
const MAX_ROWS: usize = 20_000;

impl<'a> Model<'a, '_> {
    /// The places and values of a table's file.
    pub(super) fn file_points(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        span: Span,
    ) -> Option<(Points, Points)> {
        let (path, xs, ys) = match args {
            [_, path] => (path, None, None),
            [_, path, xs, ys] => (path, Some(*xs), Some(*ys)),
            _ => {
                self.report(
                    Diagnostic::error(
                        Code::BadArguments,
                        format!("`{name}` of a file takes two columns of it, or none"),
                    )
                    .label(span, "called here")
                    .help(format!("write `{name}(x, \"grease.csv\", \"v\", \"F\")`")),
                );
                return None;
            }
        };
        let ExprKind::String(written) = &path.kind else {
            return None;
        };
        // A file that could not be read is reported by who reads files.
        let file = self.input.tables.get(&(path.span.file, written.clone()))?;
        let xs = self.column_of(file, written, (xs, 0), path.span)?;
        let ys = self.column_of(file, written, (ys, 1), path.span)?;
        if xs.2.len() < 2 {
            self.report(
                Diagnostic::error(
                    Code::BadShape,
                    format!("`{written}` has {} row", xs.2.len()),
                )
                .label(path.span, "a table has two points at least"),
            );
            return None;
        }
        if xs.2.len() > MAX_ROWS {
            let message = format!(
                "`{written}` has {} rows: a table has {MAX_ROWS} at most, for each becomes a branch of the equations",
                xs.2.len()
            );
            let thin = xs.2.len().div_ceil(MAX_ROWS);
            let help = format!(
                "keep one row of {thin}; what depends on time alone may be a record, which has any number of rows"
            );
            let diagnostic = Diagnostic::error(Code::BadShape, message);
            self.report(diagnostic.label(path.span, "too many rows").help(help));
            return None;
        }
        if let Some(row) = (1..xs.2.len()).find(|&row| xs.2[row - 1] >= xs.2[row]) {
            let shown = |row: usize| {
                let unit = xs.1.as_ref();
                unit.map_or(xs.2[row], |unit| unit.unit().from_si(xs.2[row]))
            };
            self.report(
                Diagnostic::error(
                    Code::BadShape,
                    format!("`{}` of `{written}` does not ascend", xs.0),
                )
                .label(
                    path.span,
                    format!(
                        "row {} below the header has {}, the row above it {}",
                        row + 1,
                        hyde_units::significant(shown(row), 6),
                        hyde_units::significant(shown(row - 1), 6)
                    ),
                )
                .help("sort the rows by the places, each once"),
            );
            return None;
        }
        Some((points(xs), points(ys)))
    }

    /// The column of a name, or that at a place where none is given.
    fn column_of<'f>(
        &mut self,
        file: &'f TableFile,
        path: &str,
        (name, place): (Option<&'a Expr>, usize),
        span: Span,
    ) -> Option<&'f Column> {
        let Some(name) = name else {
            let found = file.columns.get(place);
            if found.is_none() {
                self.report(
                    Diagnostic::error(Code::NoColumn, format!("`{path}` has one column"))
                        .label(span, "a table has places and values"),
                );
            }
            return found;
        };
        let ExprKind::String(word) = &name.kind else {
            self.report(
                Diagnostic::error(Code::BadArguments, "a column of a file is named in quotes")
                    .label(name.span, "not the name of a column")
                    .help("write `table(x, \"grease.csv\", \"v\", \"F\")`"),
            );
            return None;
        };
        let found = file.columns.iter().find(|(known, ..)| known == word);
        if found.is_none() {
            let known: Vec<&str> = file
                .columns
                .iter()
                .map(|(name, ..)| name.as_str())
                .collect();
            let diagnostic =
                Diagnostic::error(Code::NoColumn, format!("`{path}` has no column `{word}`"))
                    .label(name.span, "not in its header");
            self.report(match nearest(word, known.iter().copied()) {
                Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
                None => diagnostic.help(format!("it has {}", listed(&known))),
            });
        }
        found
    }
}

/// A column without a unit is of pure numbers.
fn points((_, unit, values): &Column) -> Points {
    let dim = unit
        .as_ref()
        .map_or(Dim::NUMBER, |unit| Dim::known(unit.unit().dimension));
    (values.clone(), dim)
}
