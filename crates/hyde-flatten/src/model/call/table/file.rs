//! Tables from files: `table(x, "grease.csv", "v", "F")` takes the places from one column and the values from another,
//! `table(x, "grease.csv")` from the first two.

use super::Points;
use crate::dimension::Dim;
use crate::input::TableFile;
use crate::model::Model;
use crate::refusals::calls as refused;
use hyde_diag::Span;
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
                self.report(refused::columns_of_table(name, span));
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
            self.report(refused::one_point(written, xs.2.len(), path.span));
            return None;
        }
        if xs.2.len() > MAX_ROWS {
            let rows = (xs.2.len(), MAX_ROWS);
            self.report(refused::too_many_rows(written, rows, path.span));
            return None;
        }
        if let Some(row) = (1..xs.2.len()).find(|&row| xs.2[row - 1] >= xs.2[row]) {
            let shown = |row: usize| {
                let unit = xs.1.as_ref();
                unit.map_or(xs.2[row], |unit| unit.unit().from_si(xs.2[row]))
            };
            let values = (shown(row), shown(row - 1));
            let column = (xs.0.as_str(), written.as_str());
            self.report(refused::rows_descend(column, path.span, row + 1, values));
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
                self.report(refused::single_column(path, span));
            }
            return found;
        };
        let ExprKind::String(word) = &name.kind else {
            self.report(refused::column_without_quotes(name.span));
            return None;
        };
        let found = file.columns.iter().find(|(known, ..)| known == word);
        if found.is_none() {
            let known: Vec<&str> = file
                .columns
                .iter()
                .map(|(name, ..)| name.as_str())
                .collect();
            self.report(refused::no_column(path, (word, name.span), &known));
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
