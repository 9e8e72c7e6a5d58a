//! Makes the data set of a batch from its store: one row a case, in their order, whoever solved them and when.

use super::prepare::Prepared;
use crate::store::Store;
use hyde_experiment::batch::{Gathered, Outcome, ROWS, Summary};
use hyde_signal::parquet::{Field, Kind, Values, Writer};
use std::fmt::Write as _;
use std::io::{BufWriter, Write};

/// File format of a data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableForm {
    /// Parquet, with units in the metadata.
    Parquet,
    /// CSV, with a header of `name [unit]` columns.
    Csv,
}

impl TableForm {
    /// The file of a table called so: `cases.parquet`.
    #[must_use]
    pub fn file(self, table: &str) -> String {
        match self {
            Self::Parquet => format!("{table}.parquet"),
            Self::Csv => format!("{table}.csv"),
        }
    }
}

/// Writes the data set of a batch whose store has every case, and sums it up.
///
/// # Errors
/// The sink cannot be written, or the store cannot be read.
pub fn cases(
    batch: &Prepared,
    store: &dyn Store,
    form: TableForm,
    sink: impl Write + Send,
) -> std::io::Result<Summary> {
    let fields = batch.dataset.fields(&batch.plan);
    let mut out = Table::new(BufWriter::new(sink), form, &fields, &notes(batch))?;
    let mut gathered = Gathered::default();
    let mut rows: Vec<(usize, Outcome)> = Vec::with_capacity(ROWS);
    each(batch, store, |case, outcome| {
        gathered.add(&batch.plan, case, &outcome);
        let trajectory = None;
        rows.push((
            case,
            Outcome {
                trajectory,
                ..outcome
            },
        ));
        if rows.len() == ROWS {
            out.rows(&batch.dataset.rows(&batch.plan, &rows))?;
            rows.clear();
        }
        Ok(())
    })?;
    if !rows.is_empty() {
        out.rows(&batch.dataset.rows(&batch.plan, &rows))?;
    }
    out.finish()?;
    Ok(gathered.summary(&batch.dataset))
}

/// Writes what was kept over time: the rows of each case behind those of the one before, each case a group.
///
/// # Errors
/// The sink cannot be written, or the store cannot be read.
pub fn trajectories(
    batch: &Prepared,
    store: &dyn Store,
    form: TableForm,
    sink: impl Write + Send,
) -> std::io::Result<()> {
    let fields = batch.dataset.trajectory_fields();
    let mut out = Table::new(BufWriter::new(sink), form, &fields, &notes(batch))?;
    each(batch, store, |case, outcome| match outcome.trajectory {
        Some(trajectory) => out.rows(&batch.dataset.trajectory_rows(case, &trajectory)),
        None => Ok(()),
    })?;
    out.finish()
}

/// What the metadata of both tables say.
fn notes(batch: &Prepared) -> Vec<(String, String)> {
    let mut notes = batch.dataset.roles(&batch.plan);
    for (key, value) in [
        ("hyde", env!("CARGO_PKG_VERSION").to_owned()),
        ("batch", batch.parts.whole.to_string()),
        ("sweep", batch.draft.name.clone()),
        ("experiment", batch.draft.experiment.clone()),
        ("model", batch.project.model.clone()),
    ] {
        notes.push((key.to_owned(), value));
    }
    notes
}

/// Gives the outcome of each case, in their order.
fn each(
    batch: &Prepared,
    store: &dyn Store,
    mut take: impl FnMut(usize, Outcome) -> std::io::Result<()>,
) -> std::io::Result<()> {
    for case in 1..=batch.plan.count() {
        let bytes = store
            .get(&Prepared::key(case))
            .map_err(std::io::Error::other)?;
        let outcome = bytes.and_then(|bytes| Outcome::decode(&bytes));
        let outcome =
            outcome.ok_or_else(|| std::io::Error::other(format!("case {case} is missing")))?;
        take(case, outcome)?;
    }
    Ok(())
}

/// A table that is written row by row.
enum Table<W: Write + Send> {
    Parquet(Box<Writer<W>>),
    Csv(W),
}

impl<W: Write + Send> Table<W> {
    fn new(
        mut sink: W,
        form: TableForm,
        fields: &[Field],
        notes: &[(String, String)],
    ) -> std::io::Result<Self> {
        match form {
            TableForm::Parquet => Ok(Self::Parquet(Box::new(Writer::new(sink, fields, notes)?))),
            TableForm::Csv => {
                let names = fields.iter().map(|field| match (&field.unit, field.kind) {
                    (Some(unit), _) => quoted(&format!("{} [{unit}]", field.name)),
                    (None, Kind::Number | Kind::Integer | Kind::Text) => quoted(&field.name),
                });
                writeln!(sink, "{}", names.collect::<Vec<_>>().join(","))?;
                Ok(Self::Csv(sink))
            }
        }
    }

    fn rows(&mut self, values: &[Values]) -> std::io::Result<()> {
        match self {
            Self::Parquet(writer) => writer.rows(values),
            Self::Csv(sink) => {
                let mut line = String::new();
                for row in 0..values.first().map_or(0, Values::len) {
                    line.clear();
                    for (at, column) in values.iter().enumerate() {
                        if at > 0 {
                            line.push(',');
                        }
                        // Writing to a string cannot fail.
                        let _ = match column {
                            Values::Numbers(list) if list[row].is_nan() => Ok(()),
                            Values::Numbers(list) => write!(line, "{}", list[row]),
                            Values::Integers(list) => write!(line, "{}", list[row]),
                            Values::Texts(list) => write!(line, "{}", quoted(&list[row])),
                        };
                    }
                    writeln!(sink, "{line}")?;
                }
                Ok(())
            }
        }
    }

    fn finish(self) -> std::io::Result<()> {
        match self {
            Self::Parquet(writer) => writer.finish()?.flush(),
            Self::Csv(mut sink) => sink.flush(),
        }
    }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
