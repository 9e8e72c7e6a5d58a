//! [`Kept`]: what an FMU holds of its model: every file that the model is made of, and what was asked on export.
//!
//! It is one compressed file that only Hyde reads; it is not encrypted. The text of the model is in it, because the library in
//! the FMU compiles it for the machine that it finds itself on when the FMU is instantiated.

use flate2::Compression;
use flate2::read::ZlibDecoder;
use flate2::write::ZlibEncoder;
use hyde_study::{Content, Inputs, Key, Kind};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};

/// The name of the file below `resources/`.
pub const RESOURCE: &str = "model.hydefmu";

/// The first bytes of the file.
const MAGIC: &[u8] = b"HYDEFMU1";

/// A model as an FMU holds it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kept {
    /// The version of Hyde that made it.
    pub hyde: String,
    /// The model's file.
    pub file: PathBuf,
    /// The experiment, if there is one.
    pub experiment: Option<String>,
    /// The model.
    pub model: String,
    /// `--set` as given.
    pub settings: Vec<String>,
    /// The files given for records.
    pub records: Vec<(String, PathBuf)>,
    /// The folder of the records, if it is not that of the model.
    pub data: Option<PathBuf>,
    /// Inputs whose stimuli are left out.
    pub inputs: Vec<String>,
    /// The variables that are outputs; those of [`crate::Interface::of`] if there are none.
    pub outputs: Vec<String>,
    /// The files; their contents follow in the same order.
    files: Vec<KeptFile>,
    #[serde(skip)]
    contents: Vec<Vec<u8>>,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct KeptFile {
    kind: Kind,
    asker: String,
    name: String,
    place: String,
    len: usize,
}

impl Kept {
    /// A model of a file with the files that were read for it. Places are told from the folder of the model's file on.
    #[must_use]
    pub fn of(file: &Path, model: &str, inputs: &Inputs) -> Self {
        let folder = file.parent().unwrap_or(Path::new(""));
        let short = |place: &str| {
            let path = Path::new(place);
            path.strip_prefix(folder)
                .map_or_else(|_| place.to_owned(), |p| p.to_string_lossy().into_owned())
        };
        let mut kept = Self {
            hyde: env!("CARGO_PKG_VERSION").to_owned(),
            file: PathBuf::from(short(&file.to_string_lossy())),
            experiment: None,
            model: model.to_owned(),
            settings: Vec::new(),
            records: Vec::new(),
            data: None,
            inputs: Vec::new(),
            outputs: Vec::new(),
            files: Vec::new(),
            contents: Vec::new(),
        };
        for ((kind, asker, name), (place, content)) in inputs.all() {
            kept.files.push(KeptFile {
                kind,
                asker: short(&asker),
                // Names of packages and tables are words of the model; those of records are places.
                name: match kind {
                    Kind::Record => short(&name),
                    Kind::Model | Kind::Package | Kind::Table | Kind::Fmu => name,
                },
                place: short(&place),
                len: content.len(),
            });
            kept.contents.push(content);
        }
        kept
    }

    /// The folder of the records, told from the folder of the model's file on.
    #[must_use]
    pub fn with_data(mut self, data: Option<&Path>, file: &Path) -> Self {
        let folder = file.parent().unwrap_or(Path::new(""));
        self.data = data.map(|data| data.strip_prefix(folder).unwrap_or(data).to_path_buf());
        self
    }

    /// The files with their keys, as a study reads them.
    #[must_use]
    pub fn files(&self) -> BTreeMap<Key, Content> {
        let files = self.files.iter().zip(&self.contents);
        files
            .map(|(file, content)| {
                let key = (file.kind, file.asker.clone(), file.name.clone());
                (key, (file.place.clone(), content.clone()))
            })
            .collect()
    }

    /// The texts of the model and of its packages, each with its place: what `--with-source` puts into the archive.
    #[must_use]
    pub fn sources(&self) -> Vec<(String, Vec<u8>)> {
        let files = self.files.iter().zip(&self.contents);
        let texts = files.filter(|(file, _)| matches!(file.kind, Kind::Model | Kind::Package));
        texts
            .map(|(file, content)| (file.place.clone(), content.clone()))
            .collect()
    }

    /// The bytes of the file in the FMU.
    ///
    /// # Errors
    /// It cannot be written as bytes: why.
    pub fn to_bytes(&self) -> Result<Vec<u8>, String> {
        let head = serde_json::to_vec(self).map_err(|error| error.to_string())?;
        let length = u64::try_from(head.len()).map_err(|error| error.to_string())?;
        let mut encoder = ZlibEncoder::new(MAGIC.to_vec(), Compression::default());
        let mut write = |bytes: &[u8]| encoder.write_all(bytes).map_err(|e| e.to_string());
        write(&length.to_le_bytes())?;
        write(&head)?;
        for content in &self.contents {
            write(content)?;
        }
        encoder.finish().map_err(|error| error.to_string())
    }

    /// What tells the description of these bytes from that of others.
    #[must_use]
    pub fn token(bytes: &[u8]) -> String {
        use sha2::{Digest as _, Sha256};
        let digest = format!("{:x}", Sha256::digest(bytes));
        let parts = [
            &digest[..8],
            &digest[8..12],
            &digest[12..16],
            &digest[16..20],
            &digest[20..32],
        ];
        format!("{{{}}}", parts.join("-"))
    }

    /// Reads the bytes of the file in an FMU.
    ///
    /// # Errors
    /// Why it is no such file.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, String> {
        let damaged = || format!("`{RESOURCE}` is damaged");
        let packed = bytes
            .strip_prefix(MAGIC)
            .ok_or_else(|| format!("`{RESOURCE}` was not made by this version of Hyde"))?;
        let mut all = Vec::new();
        ZlibDecoder::new(packed)
            .read_to_end(&mut all)
            .map_err(|_| damaged())?;
        let (length, rest) = all.split_first_chunk::<8>().ok_or_else(damaged)?;
        let length = usize::try_from(u64::from_le_bytes(*length)).map_err(|_| damaged())?;
        let (head, mut rest) = rest.split_at_checked(length).ok_or_else(damaged)?;
        let mut kept: Self = serde_json::from_slice(head).map_err(|_| damaged())?;
        for file in &kept.files {
            let (content, behind) = rest.split_at_checked(file.len).ok_or_else(damaged)?;
            kept.contents.push(content.to_vec());
            rest = behind;
        }
        Ok(kept)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_and_damage_is_told() {
        let inputs = Inputs::recording();
        inputs.note(
            Kind::Model,
            "",
            "",
            ("a/b.hyde".to_owned(), b"model M end M;".to_vec()),
        );
        let kept = Kept::of(Path::new("a/b.hyde"), "M", &inputs);
        let bytes = kept.to_bytes().unwrap();
        assert_eq!(Kept::from_bytes(&bytes).unwrap(), kept);
        assert_eq!(kept.sources()[0].0, "b.hyde");
        assert!(Kept::from_bytes(&bytes[..bytes.len() - 6]).is_err());
        assert!(Kept::from_bytes(b"other").is_err());
    }
}
