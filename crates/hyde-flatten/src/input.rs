//! [`Input`]: what is to be flattened, and what the experiment is made into.

use crate::additions::Additions;
use hyde_diag::{FileId, Sources};
use hyde_syntax::ast;
use hyde_units::NamedUnit;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The header of a record: its columns with their units, and whether the first one is time.
#[derive(Clone, Debug, Default)]
pub struct Header {
    /// Name and unit of each column; no unit where the file gives none.
    pub columns: Vec<(String, Option<NamedUnit>)>,
    /// The usual time between two rows, s.
    pub step_s: Option<f64>,
    /// What else the file has and cannot be used: name, what is wrong, and what to change.
    pub unusable: Vec<(String, String, String)>,
    /// Those of these that lack readings only, with their units: they can be compared, and drive nothing.
    pub sparse: Vec<(String, Option<NamedUnit>)>,
}

/// The columns of a table's file.
#[derive(Clone, Debug, Default)]
pub struct TableFile {
    /// Name, unit and values of each column; SI, or as written where there is no unit.
    pub columns: Vec<(String, Option<NamedUnit>, Vec<f64>)>,
}

/// What an FMU is to the model: the file that stands for it has one model, whose clocked part has these variables.
#[derive(Clone, Debug, Default)]
pub struct FmuInterface {
    /// The file of the FMU as the model names it.
    pub file: String,
    /// What it is given before its first step.
    pub parameters: Vec<String>,
    /// What it reads at a tick.
    pub inputs: Vec<String>,
    /// What it gives.
    pub outputs: Vec<String>,
}

/// What is to be flattened.
pub struct Input<'a> {
    /// The source texts, for messages.
    pub sources: &'a Sources,
    /// Every file that may be named, the user's file first.
    pub files: &'a [(FileId, Arc<ast::File>)],
    /// Names that no file here declares, with the packages that have them.
    pub elsewhere: &'a BTreeMap<String, Vec<String>>,
    /// The files of tables by the source file that names them and the name there.
    pub tables: &'a BTreeMap<(FileId, String), TableFile>,
    /// The FMUs, by the source file that stands for each.
    pub fmus: &'a BTreeMap<FileId, FmuInterface>,
    /// The model, in the first file.
    pub model: &'a str,
    /// Effects put on it beside those of its text.
    pub additions: &'a Additions,
    /// The experiment, in the first file.
    pub experiment: Option<&'a str>,
    /// Values set from outside, by full name of the parameter, SI.
    pub settings: &'a BTreeMap<String, f64>,
    /// The headers of the experiment's records by their name there.
    pub records: &'a BTreeMap<String, Header>,
    /// Which free inputs are parameters.
    pub free_inputs: FreeInputs,
    /// Make the energy ledger.
    pub ledger: bool,
    /// What the experiment is made into.
    pub form: Form,
}

/// Which free inputs of the model become parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FreeInputs {
    /// None: one that no stimulus drives is an error.
    #[default]
    None,
    /// Those that no stimulus drives: whoever runs the model sets them.
    Undriven,
    /// All of them, added to the stimulus where there is one: for linearisation.
    All,
}

/// What an experiment is made into.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// A run: loops stay closed, everything is reported.
    #[default]
    Run,
    /// What an observer runs: replayed columns take the place of what they replay, quantisers of measured channels are
    /// errors of a known width, and measured channels alone are reported.
    Observed,
    /// What makes a record: loops stay closed; reported are the measured channels, those that are not clocked before their
    /// quantisers with its width, and behind them what replayed columns are recorded of.
    Recorded,
}
