//! [`Order`]: what a batch is asked to be, as its folder keeps it: with the order and the files beside it, any process makes
//! the same cases, wherever it runs and whatever became of the model's own files.

use crate::world::{World, read_text};
use crate::{Content, Inputs, Key, Kind};
use hyde_experiment::batch::{Identity, digest};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file of an order in its folder.
pub const ORDER: &str = "batch.json";
/// The folder of the model's files below it.
const INPUTS: &str = "inputs";
/// The form of a batch's folder.
const FORM: u32 = 1;

/// What a batch is asked to be.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Order {
    /// The model's file as printed.
    pub file: PathBuf,
    /// The sweep.
    pub sweep: String,
    /// Parameters that are set in all cases: `saddle.M=320 [kg]`.
    pub settings: Vec<String>,
    /// Files of records: `strokes=strokes.csv`.
    pub records: Vec<String>,
    /// The folder of the records.
    pub data: Option<PathBuf>,
    /// The seed of the random numbers, instead of that of the sweep.
    pub seed: Option<u64>,
    /// Variables to keep over time, beside those of the sweep.
    pub keep: Vec<String>,
}

/// An order as it is kept.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Kept {
    form: u32,
    hyde: String,
    identity: String,
    cases: usize,
    parts: BTreeMap<String, String>,
    order: Order,
    inputs: Vec<KeptInput>,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
struct KeptInput {
    kind: Kind,
    asker: String,
    name: String,
    place: String,
    sha256: String,
}

/// The identity of a batch and of what it is made of.
#[derive(Clone, Debug)]
pub struct Parts {
    /// That of the batch.
    pub whole: Identity,
    parts: BTreeMap<String, String>,
}

impl Order {
    /// Which batch this is: by the texts of the model, the library, the data, the plan and the versions. Where the files lie
    /// does not count, nor how many processes solve it.
    pub fn identity(&self, inputs: &Inputs) -> Parts {
        let all = inputs.all();
        let of = |kinds: &[Kind]| {
            let chosen = all.iter().filter(|((kind, ..), _)| kinds.contains(kind));
            let parts: Vec<&[u8]> = chosen
                .flat_map(|((kind, _, name), (_, content))| {
                    // Names of packages and tables are words of the model; those of records are places.
                    let name = if *kind == Kind::Record {
                        ""
                    } else {
                        name.as_str()
                    };
                    [name.as_bytes(), content.as_slice()]
                })
                .collect();
            digest(&parts)
        };
        let library: Vec<&[u8]> = hyde_library::PACKAGES
            .iter()
            .flat_map(|p| [p.name.as_bytes(), p.text.as_bytes()])
            .collect();
        let plan = serde_json::json!({
            "sweep": self.sweep, "set": self.settings, "seed": self.seed, "keep": self.keep,
        });
        let versions = format!(
            "{FORM} {} {}",
            env!("CARGO_PKG_VERSION"),
            hyde_ida::sundials_version()
        );
        let parts = [
            ("model", of(&[Kind::Model, Kind::Package])),
            ("library", digest(&library)),
            ("data", of(&[Kind::Table, Kind::Fmu, Kind::Record])),
            ("plan", digest(&[plan.to_string().as_bytes()])),
            ("versions", digest(&[versions.as_bytes()])),
        ];
        let whole: Vec<&[u8]> = parts.iter().map(|(_, identity)| &identity.0[..]).collect();
        Parts {
            whole: digest(&whole),
            parts: parts
                .iter()
                .map(|(name, identity)| ((*name).to_owned(), identity.to_string()))
                .collect(),
        }
    }

    /// Whether a folder holds a batch.
    pub fn is_in(world: &dyn World, folder: &Path) -> bool {
        world.is_file(&folder.join(ORDER))
    }

    /// The order that a folder holds, with its files.
    pub fn read(world: &dyn World, folder: &Path) -> Result<(Self, Inputs), String> {
        let kept = kept(world, folder)?;
        let mut found: BTreeMap<Key, Content> = BTreeMap::new();
        for input in kept.inputs {
            let path = folder.join(INPUTS).join(&input.sha256);
            let content = world.read(&path)?;
            if digest(&[&content]).to_string() != input.sha256 {
                return Err(format!(
                    "`{}` was changed since the batch was made",
                    path.display()
                ));
            }
            found.insert(
                (input.kind, input.asker, input.name),
                (input.place, content),
            );
        }
        Ok((kept.order, Inputs::replaying(found)))
    }

    /// The files that make a folder the one of this batch, to be written in this order: a folder with an order has all that
    /// the order names. None where the folder is that of this batch already.
    ///
    /// # Errors
    /// The folder is that of another batch: what differs.
    pub fn files(
        &self,
        world: &dyn World,
        folder: &Path,
        (parts, cases): (&Parts, usize),
        inputs: &Inputs,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, String> {
        if Self::is_in(world, folder) {
            let known = kept(world, folder)?;
            if known.identity == parts.whole.to_string() {
                return Ok(Vec::new());
            }
            let differs: Vec<&str> = parts
                .parts
                .iter()
                .filter(|(name, identity)| known.parts.get(*name) != Some(identity))
                .map(|(name, _)| name.as_str())
                .collect();
            return Err(format!(
                "`{}` contains another batch: it differs in the {}; use another folder, or remove this one",
                folder.display(),
                differs.join(" and the ")
            ));
        }
        let (mut files, mut list) = (Vec::new(), Vec::new());
        for ((kind, asker, name), (place, content)) in inputs.all() {
            let sha256 = digest(&[&content]).to_string();
            files.push((folder.join(INPUTS).join(&sha256), content));
            list.push(KeptInput {
                kind,
                asker,
                name,
                place,
                sha256,
            });
        }
        let kept = Kept {
            form: FORM,
            hyde: env!("CARGO_PKG_VERSION").to_owned(),
            identity: parts.whole.to_string(),
            cases,
            parts: parts.parts.clone(),
            order: self.clone(),
            inputs: list,
        };
        let text = serde_json::to_string_pretty(&kept).map_err(|error| error.to_string())?;
        files.push((folder.join(ORDER), text.into_bytes()));
        Ok(files)
    }
}

fn kept(world: &dyn World, folder: &Path) -> Result<Kept, String> {
    let path = folder.join(ORDER);
    let kept: Kept = serde_json::from_str(&read_text(world, &path)?)
        .map_err(|error| format!("`{}` does not describe a batch: {error}", path.display()))?;
    if kept.form != FORM {
        let (hyde, place) = (&kept.hyde, folder.display());
        return Err(format!(
            "`{place}` was made by hyde {hyde}, whose batches this version does not read"
        ));
    }
    Ok(kept)
}
