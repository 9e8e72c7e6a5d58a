//! Files of named arrays, of MATLAB and of NumPy, as records: the first axis is the sample, the second the column, and the
//! places along all others are runs.
//!
//! An array `u` with three columns is `u_1`, `u_2`, `u_3`. Arrays that are shorter than the longest one, as gains beside a
//! signal, are left out, and a note names them.

mod mat;
mod number;
mod numpy;

use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::heading::Heading;
use crate::layout::Kind;
use crate::{Fault, Layout, Note, Table, TableError, TimeError, contradicted};
use std::fmt;

/// An array of numbers, its last axis fastest.
#[derive(Clone, Debug, PartialEq)]
struct Array {
    name: String,
    shape: Vec<usize>,
    values: Vec<f64>,
}

/// How many numbers an array of a shape has, if they can be counted.
fn places(shape: &[usize]) -> Option<usize> {
    let mut axes = shape.iter();
    axes.try_fold(1, |all: usize, axis| all.checked_mul(*axis))
}

/// The arrays of a file, and the names of what else is in it.
#[derive(Debug, Default, PartialEq)]
struct Content {
    arrays: Vec<Array>,
    others: Vec<String>,
}

/// Why a file of arrays is not a record.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is damaged, or has a form that is not read: what is wrong.
    Damaged(String),
    /// A MATLAB file of version 7.3.
    Hdf5,
    /// An array has more columns than samples: its name, samples and columns.
    Lying(String, usize, usize),
    /// It has no array of two numbers and more; what else it has, by name.
    Empty(Vec<String>),
    /// It has so many runs, and nothing says which one is meant.
    Which(usize),
    /// It has no run of that number: the number, and how many there are.
    NoRun(usize, usize),
    /// No column is the time, or the one that should be is not.
    Time(TimeError),
    /// The columns are not a table.
    Table(TableError),
}

/// Whether a file is one of arrays, by its first bytes, or a zip archive of arrays.
pub(crate) fn is_of_arrays(bytes: &[u8]) -> bool {
    mat::is_mat(bytes) || numpy::is_array(bytes) || numpy::is_archive(bytes)
}

/// Reads the arrays of a file as a record.
///
/// # Errors
/// If the file is damaged or its arrays are not a record.
pub fn read(bytes: &[u8], layout: &Layout) -> Result<Table, ReadError> {
    let content = match mat::is_mat(bytes) {
        true => mat::read(bytes)?,
        false => numpy::read(bytes)?,
    };
    let (columns, mut notes) = columns(content, layout.run)?;
    let raw = columns.into_iter().map(|(name, values)| Raw {
        cells: cells(&name, values),
        heading: Heading::plain(&name),
    });
    let raw: Vec<Raw> = raw.collect();
    crate::declared::check(raw.iter(), &layout.columns).map_err(ReadError::Time)?;
    let place = |sample: usize| format!("sample {}", sample + 1);
    notes.extend(contradicted::noted(&raw, layout.every_s, &place));
    let table = assemble(raw, layout, notes, &place);
    let table = table.map(|table| table.laid_out(Kind::Arrays));
    table.map_err(|error| match error {
        AssembleError::Time(error) => ReadError::Time(error),
        AssembleError::Table(error) => ReadError::Table(error),
    })
}

fn cells(name: &str, values: Vec<f64>) -> Cells {
    match values.iter().position(|value| !value.is_finite()) {
        None => Cells::Numbers(values, None),
        Some(sample) => Cells::Sparse(
            values,
            Fault {
                message: format!("sample {}, `{name}`: not a finite number", sample + 1),
                repair: "insert the correct value: Hyde does not guess values".to_owned(),
            },
        ),
    }
}

/// More columns than this, and than samples, are samples.
const MANY: usize = 50;

type Named = (String, Vec<f64>);

/// The columns of one run, each with its name, and a note on what is left out.
fn columns(content: Content, run: Option<usize>) -> Result<(Vec<Named>, Vec<Note>), ReadError> {
    let arrays = content.arrays.into_iter().map(upright);
    let (arrays, empty): (Vec<Array>, Vec<Array>) =
        arrays.partition(|array| !array.values.is_empty());
    let samples = arrays.iter().map(|array| array.shape[0]).max();
    let samples = samples.filter(|&samples| samples > 1);
    let Some(samples) = samples else {
        return Err(ReadError::Empty(content.others));
    };
    let is_lying = |array: &&Array| array.width() > samples.max(MANY);
    if let Some(lying) = arrays.iter().find(is_lying) {
        return Err(ReadError::Lying(
            lying.name.clone(),
            lying.shape[0],
            lying.width(),
        ));
    }
    let whole = |array: &&Array| array.shape[0] == samples;
    let runs = arrays.iter().filter(whole).map(Array::runs).max();
    let runs = runs.unwrap_or(1);
    let run = match run {
        None if runs > 1 => return Err(ReadError::Which(runs)),
        None => 1,
        Some(run) if run == 0 || run > runs => return Err(ReadError::NoRun(run, runs)),
        Some(run) => run,
    };
    let mut columns = Vec::new();
    let mut left_out = content.others;
    left_out.extend(empty.into_iter().map(|array| array.name));
    for array in &arrays {
        let fits = array.shape[0] == samples && (array.runs() == 1 || run <= array.runs());
        match fits {
            true => columns.extend(array.columns(run)),
            false => left_out.push(array.name.clone()),
        }
    }
    let mut notes = Vec::new();
    if !left_out.is_empty() {
        let names: Vec<String> = left_out.iter().map(|name| format!("`{name}`")).collect();
        notes.push(Note::new(format!(
            "Hyde leaves out {}: another length, no such run, or not numbers",
            names.join(", ")
        )));
    }
    Ok((columns, notes))
}

/// A row of numbers as a column, with at least one axis.
fn upright(mut array: Array) -> Array {
    if let [1, length] = array.shape[..] {
        array.shape = vec![length];
    }
    if array.shape.is_empty() {
        array.shape = vec![1];
    }
    array
}

impl Array {
    fn width(&self) -> usize {
        self.shape.get(1).copied().unwrap_or(1)
    }

    fn runs(&self) -> usize {
        self.shape.iter().skip(2).product()
    }

    /// The columns of a run, counted from 1.
    fn columns(&self, run: usize) -> Vec<Named> {
        let (width, runs) = (self.width(), self.runs());
        let column = |at: usize| {
            let rows = self.values.chunks_exact(width * runs);
            rows.map(|row| row[at * runs + (run - 1).min(runs - 1)])
                .collect()
        };
        let name = |at: usize| match self.shape.len() {
            1 => self.name.clone(),
            _ if width == 1 => self.name.clone(),
            _ => format!("{}_{}", self.name, at + 1),
        };
        (0..width).map(|at| (name(at), column(at))).collect()
    }
}

impl ReadError {
    /// What to change, in the file or in the experiment that calls it `record`.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Damaged(_) => {
                "write it again: `save -v7` in MATLAB, `np.savez` in Python, or export CSV"
                    .to_owned()
            }
            Self::Hdf5 => "save it as version 7: `save(\"log.mat\", \"-v7\")`".to_owned(),
            Self::Lying(name, ..) => {
                format!("save it transposed: `{name}.T` in Python, `{name}.'` in MATLAB")
            }
            Self::Empty(others) => match others.first() {
                Some(other) => format!(
                    "save its parts as arrays of real numbers whose first axis is the sample: of a MATLAB structure \
                     `save(\"log.mat\", \"-struct\", \"{other}\")`"
                ),
                None => "save signals as arrays whose first axis is the sample".to_owned(),
            },
            Self::Which(_) => format!("say which one: `record {record} = \"…\" (run = 1)`"),
            Self::NoRun(_, found) => format!("say one from 1 to {found}"),
            Self::Time(error) => error.repair(record),
            Self::Table(_) => {
                "give every array a different name, and sort the samples by time".to_owned()
            }
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Damaged(reason) => write!(f, "the file of arrays cannot be read: {reason}"),
            Self::Hdf5 => write!(f, "this is a MATLAB file of version 7.3, which is HDF5"),
            Self::Lying(name, samples, columns) => write!(
                f,
                "`{name}` has {samples} samples of {columns} columns: its first axis is the sample"
            ),
            Self::Empty(others) if others.is_empty() => {
                write!(f, "no array of the file has two samples")
            }
            Self::Empty(others) => {
                let names: Vec<String> = others.iter().map(|name| format!("`{name}`")).collect();
                write!(
                    f,
                    "the file has no array of real numbers with two samples: {} is a structure, text, or of complex numbers",
                    names.join(", ")
                )
            }
            Self::Which(runs) => write!(f, "the arrays of the file have {runs} runs"),
            Self::NoRun(asked, found) => {
                write!(f, "the file has no run {asked}: it has {found}")
            }
            Self::Time(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ReadError {}

#[cfg(test)]
mod tests;
