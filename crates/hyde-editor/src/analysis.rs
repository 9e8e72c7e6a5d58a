//! A text with the packages it names, parsed, and its names with their meanings.

use crate::occurrences::{Occurrence, occurrences};
use crate::scope::{Definition, Files};
use hyde_compiler::{Form, FreeInputs, Meaning, Request};
use hyde_diag::{Diagnostics, FileId, Span};
use hyde_study::world::World;
use hyde_study::{Asked, Loaded};
use hyde_syntax::ast::{ClassKind, Item};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::Arc;

/// A parsed text.
pub(crate) struct Analysis {
    pub(crate) path: PathBuf,
    pub(crate) loaded: Loaded,
    pub(crate) world: Arc<dyn World>,
    /// What the expressions of models and experiments mean, by the number of the item.
    meanings: RefCell<BTreeMap<usize, Rc<Meaning>>>,
}

/// Where something is declared, the same in every analysis: the name of the source text and the first byte.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Identity {
    pub(crate) source: String,
    pub(crate) start: u32,
}

impl Analysis {
    /// Parses the file at a path.
    pub(crate) fn of(world: &Arc<dyn World>, path: &Path) -> Option<Self> {
        let asked = Asked {
            world: Arc::clone(world),
            ..Asked::of_file(path)
        };
        let loaded = Loaded::of(&asked).ok()?;
        Some(Self {
            path: path.to_path_buf(),
            loaded,
            world: Arc::clone(world),
            meanings: RefCell::default(),
        })
    }

    /// The text of the file itself.
    pub(crate) fn text(&self) -> &str {
        match self.own() {
            Some(file) => &self.loaded.sources.get(file).text,
            None => "",
        }
    }

    /// The file itself among the sources.
    pub(crate) fn own(&self) -> Option<FileId> {
        self.loaded.file.files.first().map(|(id, _)| *id)
    }

    /// The items of the file itself, each with its place.
    pub(crate) fn items(&self) -> impl Iterator<Item = (&Item, Span)> {
        let tree = self.files().file(0).into_iter();
        tree.flat_map(|tree| &tree.items).map(|item| {
            let span = match item {
                Item::Class(class) => class.span,
                Item::Experiment(experiment) => experiment.span,
                Item::Study(study) => study.span,
                Item::Type(item) => item.name.span.to(item.base.span),
            };
            (item, span)
        })
    }

    /// What the expressions mean that stand at a byte of the file itself: in the model or the experiment there, elsewhere in
    /// every model of the file.
    pub(crate) fn meanings_at(&self, byte: usize) -> Vec<Rc<Meaning>> {
        let at = |span: Span| (span.start as usize) <= byte && byte <= span.end as usize;
        let here = self.items().position(|(_, span)| at(span));
        if let Some(own) = here.and_then(|number| self.meaning(number)) {
            return vec![own];
        }
        let numbers = 0..self.items().count();
        match here {
            Some(_) => numbers.filter_map(|number| self.meaning(number)).collect(),
            None => Vec::new(),
        }
    }

    /// What the expressions of an item mean, if it is a model or an experiment; found once.
    pub(crate) fn meaning(&self, number: usize) -> Option<Rc<Meaning>> {
        if let Some(known) = self.meanings.borrow().get(&number) {
            return Some(Rc::clone(known));
        }
        let (model, experiment) = match self.items().nth(number)?.0 {
            Item::Class(class) if class.kind == ClassKind::Model => (class.name.text.clone(), None),
            Item::Experiment(own) => (own.model.dotted(), Some(own.name.text.as_str())),
            Item::Class(_) | Item::Type(_) | Item::Study(_) => return None,
        };
        let request = self.request(&model, experiment);
        let found = Rc::new(hyde_compiler::meaning(&request, &mut Diagnostics::new()));
        self.meanings.borrow_mut().insert(number, Rc::clone(&found));
        Some(found)
    }

    fn request<'a>(&'a self, model: &'a str, experiment: Option<&'a str>) -> Request<'a> {
        static SETTINGS: BTreeMap<String, f64> = BTreeMap::new();
        static RECORDS: BTreeMap<String, hyde_compiler::Header> = BTreeMap::new();
        Request {
            sources: &self.loaded.sources,
            file: &self.loaded.file,
            model,
            experiment,
            settings: &SETTINGS,
            // A record can be large: its columns are left out.
            records: &RECORDS,
            free_inputs: FreeInputs::All,
            ledger: true,
            form: Form::Run,
            backend: hyde_compiler::Backend::Interpreter,
        }
    }

    pub(crate) fn files(&self) -> Files<'_> {
        Files {
            files: &self.loaded.file.files,
        }
    }

    /// The names of the file itself.
    pub(crate) fn occurrences(&self) -> Vec<Occurrence<'_>> {
        occurrences(self.files(), 0)
    }

    /// The name at a byte of the file itself, or just before it.
    pub(crate) fn occurrence_at(&self, byte: usize) -> Option<Occurrence<'_>> {
        let own = self.occurrences().into_iter();
        let mut at: Vec<Occurrence<'_>> = own
            .filter(|found| (found.span.start as usize) <= byte && byte <= found.span.end as usize)
            .collect();
        at.sort_by_key(|found| (found.span.end as usize == byte, found.meaning.is_none()));
        at.first().copied()
    }

    pub(crate) fn identity(&self, definition: &Definition<'_>) -> Identity {
        self.identity_of(definition.name.span)
    }

    pub(crate) fn identity_of(&self, span: Span) -> Identity {
        Identity {
            source: self.loaded.sources.get(span.file).name.clone(),
            start: span.start,
        }
    }
}
