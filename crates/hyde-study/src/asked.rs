//! [`Asked`]: which model, with what set from outside, and where its files are.

use crate::fmus::FmuHost;
use crate::inputs::{Inputs, Kind};
use crate::settings::{self, Setting};
use crate::world::{Disk, World};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model in a file, with what is set from outside.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The model's file.
    pub file: PathBuf,
    /// The experiment; the file's only one if left out.
    pub experiment: Option<String>,
    /// The model; that of the experiment, or the last of the file, if left out.
    pub model: Option<String>,
    /// Parameters with their values.
    pub settings: Vec<Setting>,
    /// Records by name, each with its file and, behind it, how it is to be read; the others have the files that the experiment
    /// says.
    pub records: Vec<(String, PathBuf)>,
    /// The folder that the files of records are below; the model's own if left out.
    pub data: Option<PathBuf>,
    /// Every package of the library is known, named or not.
    pub whole_library: bool,
    /// Where files are.
    pub world: Arc<dyn World>,
    /// The files of the model where they are kept track of, or are to be those of another time.
    pub inputs: Option<Arc<Inputs>>,
    /// Who runs FMUs, if not this process.
    pub fmu_host: Option<Arc<dyn FmuHost>>,
}

impl Asked {
    /// A file of the disk with nothing set from outside.
    #[must_use]
    pub fn of_file(file: &Path) -> Self {
        Self {
            file: file.to_path_buf(),
            experiment: None,
            model: None,
            settings: Vec::new(),
            records: Vec::new(),
            data: None,
            whole_library: false,
            world: Arc::new(Disk),
            inputs: None,
            fmu_host: None,
        }
    }

    /// Parameters and records as a user writes them are set: `saddle.M=320 [kg]`, and `strokes=strokes.csv`.
    ///
    /// # Errors
    /// Which text is none, and what to write.
    pub fn with_texts(mut self, settings: &[String], records: &[String]) -> Result<Self, String> {
        let settings = settings.iter().map(|text| settings::parse(text));
        self.settings = settings.collect::<Result<_, String>>()?;
        let records = records.iter().map(|text| {
            let (name, path) = text
                .split_once('=')
                .ok_or_else(|| format!("`--record {text}`: write `NAME=PATH`"))?;
            Ok((name.to_owned(), PathBuf::from(path)))
        });
        self.records = records.collect::<Result<_, String>>()?;
        Ok(self)
    }

    /// Reads a file of the model: `asker` is the place of the file that names it, if one does.
    ///
    /// # Errors
    /// Which file cannot be read, and why.
    pub fn read(
        &self,
        kind: Kind,
        asker: &str,
        name: &str,
        path: &Path,
    ) -> Result<Vec<u8>, String> {
        match &self.inputs {
            Some(inputs) => inputs.read(self.world.as_ref(), kind, asker, name, path),
            None => self.world.read(path),
        }
    }
}
