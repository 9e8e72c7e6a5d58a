//! What may be written at a place: members behind a dot, parameters in a modification, units in brackets, connectors that fit,
//! effects that fit, columns of records, names and keywords.

mod columns;
mod connectors;
mod effects;
mod units;

use crate::analysis::Analysis;
use crate::before::{chain_words, open_brackets, word_start};
use crate::describe::signature;
use crate::occurrences::{Frame, resolve, resolve_parts};
use crate::place::Place;
use crate::scope::{Definition, Inside, Thing};
use crate::values::call_of;
use hyde_compiler::FUNCTIONS;
use hyde_syntax::ast::{Item, Prefix};
use lsp_types::{CompletionItem, CompletionItemKind, Documentation};
use std::collections::BTreeSet;

const TOP: &[&str] = &[
    "package",
    "import",
    "type",
    "model",
    "connector",
    "effect",
    "function",
    "experiment",
    "calibrate",
    "diagnose",
    "sweep",
];
const IN_CLASS: &[&str] = &[
    "extends",
    "parameter",
    "constant",
    "final",
    "flow",
    "input",
    "output",
    "replaceable",
    "site",
    "field",
    "domain",
    "discretize",
    "initial equation",
    "equation",
    "connect",
    "when",
    "if",
    "for",
    "modes",
    "mode",
    "exit",
    "clocked",
    "assert",
    "reinit",
    "measure",
    "stored",
    "dissipated",
    "supplied",
    "wrap",
    "add",
    "replace",
    "signature",
    "confounds",
    "end",
];
const IN_EXPERIMENT: &[&str] = &[
    "stimulus", "measured", "replay", "expect", "measure", "figure", "budget", "solve", "start",
    "stop", "every", "skip", "bode", "margins", "end",
];
const IN_STUDY: &[&str] = &["vary", "per", "end"];

/// What may be written at a byte.
pub(crate) fn complete(analysis: &Analysis, byte: usize) -> Vec<CompletionItem> {
    let text = analysis.text();
    let Some(before) = text.get(..byte) else {
        return Vec::new();
    };
    let Some(open) = open_brackets(before) else {
        return Vec::new(); // A comment or a text.
    };
    let rest = &before[..word_start(before)];
    let place = Place::at(analysis, byte);
    if let Some((at, '(')) = open.last().copied()
        && chain_words(before[..at].trim_end()) == ["connect"]
    {
        let list = place.connectors(&before[at + 1..]);
        if !list.is_empty() {
            return list;
        }
    }
    if let Some(list) = place.effects(before) {
        return list;
    }
    if let Some(chain) = rest.strip_suffix('.') {
        return place.members(chain);
    }
    if let Some((at, '[')) = open.last().copied() {
        let value = before[..at].trim_end();
        let number = value.ends_with(|c: char| c.is_ascii_digit() || c == '}' || c == '±');
        if number || value.ends_with("Real") {
            return place.units(before, &open);
        }
    }
    if rest.trim_end().ends_with("extends") {
        let mut classes = place.names();
        classes.retain(|own| own.kind == Some(CompletionItemKind::CLASS));
        return classes;
    }
    let mut items = Vec::new();
    if let Some((at, '(')) = open.last().copied()
        && rest.trim_end().ends_with(['(', ','])
        && let Some(inside) = place.modified(before, &open, open.len() - 1)
    {
        items.extend(place.parameters(inside, &before[at + 1..]));
        return items;
    }
    let line = rest.rsplit('\n').next().unwrap_or_default();
    if line.trim().is_empty() {
        items.extend(place.keywords().iter().map(|word| CompletionItem {
            label: (*word).to_owned(),
            kind: Some(CompletionItemKind::KEYWORD),
            ..CompletionItem::default()
        }));
    } else {
        items.extend(functions());
    }
    items.extend(place.names());
    items
}

/// The functions of the language.
fn functions() -> impl Iterator<Item = CompletionItem> {
    FUNCTIONS.iter().map(|name| CompletionItem {
        label: (*name).to_owned(),
        kind: Some(CompletionItemKind::FUNCTION),
        detail: Some(call_of(name)),
        ..CompletionItem::default()
    })
}

impl<'a> Place<'a> {
    /// The members of what stands before a dot.
    fn members(&self, chain: &str) -> Vec<CompletionItem> {
        let words = chain_words(chain);
        let Some((first, rest)) = words.split_first() else {
            return Vec::new();
        };
        let meaning = resolve(self.files, &self.frames, first);
        if meaning.is_none() {
            return match self.files.package(&words.join(".")) {
                Some(package) => self.items_of(package),
                None => Vec::new(),
            };
        }
        if let (
            Some(Definition {
                thing: Thing::Record(record),
                ..
            }),
            [],
        ) = (meaning, rest)
        {
            return self.columns(record);
        }
        let (_, inside) = resolve_parts(self.files, meaning, rest);
        let mut items = Vec::new();
        if let Some(inside) = inside {
            self.files.each_member(inside, &mut |member| {
                items.push(self.item(&member));
            });
        }
        unique(items)
    }

    /// What can be changed in a class and is not yet changed in the list.
    fn parameters(&self, inside: Inside<'a>, list: &str) -> Vec<CompletionItem> {
        let set: BTreeSet<&str> = list
            .split(['(', ',', ')'])
            .filter_map(|own| own.split_once('=').map(|(name, _)| name.trim()))
            .collect();
        let mut items = Vec::new();
        self.files.each_member(inside, &mut |member| {
            let Thing::Variable(declaration, declarator) = member.thing else {
                return;
            };
            let fixed = [Prefix::Final, Prefix::Constant];
            if set.contains(member.name.text.as_str())
                || declaration.prefixes.iter().any(|own| fixed.contains(own))
            {
                return;
            }
            let parameter = [
                Prefix::Parameter,
                Prefix::Input,
                Prefix::Size,
                Prefix::Shape,
            ];
            let given = declaration
                .prefixes
                .iter()
                .any(|own| parameter.contains(own));
            // First what must be given, then what may be.
            let rank = match (given, declarator.binding.is_none()) {
                (true, true) => 0,
                (true, false) => 1,
                (false, _) => 2,
            };
            items.push(CompletionItem {
                insert_text: given.then(|| format!("{} = ", member.name.text)),
                sort_text: Some(format!("{rank}{}", member.name.text)),
                ..self.item(&member)
            });
        });
        unique(items)
    }

    fn keywords(&self) -> &'static [&'static str] {
        let experiment = |frame: &Frame<'_>| matches!(frame, Frame::Experiment(..));
        match self.frames.as_slice() {
            [] => TOP,
            frames if frames.iter().any(experiment) => IN_EXPERIMENT,
            [Frame::Inside(Inside::Class(0, _)), ..] => IN_CLASS,
            _ => IN_STUDY,
        }
    }

    /// Every name that is known here.
    fn names(&self) -> Vec<CompletionItem> {
        let mut items = Vec::new();
        for frame in self.frames.iter().rev() {
            match frame {
                Frame::Inside(inside) => self.files.each_member(*inside, &mut |member| {
                    items.push(self.item(&member));
                }),
                Frame::Experiment(file, experiment) => {
                    let names = experiment.records.iter().map(|own| &own.name);
                    for name in names {
                        let own = crate::scope::own_of_experiment(*file, experiment, &name.text);
                        items.extend(own.map(|own| self.item(&own)));
                    }
                }
                Frame::Local(names) => items.extend(names.iter().map(|own| self.item(own))),
            }
        }
        items.extend(self.items_of(0));
        if let Some(tree) = self.files.file(0) {
            for import in &tree.imports {
                if import.everything {
                    let package = self.files.package(&import.path.dotted());
                    items.extend(package.into_iter().flat_map(|own| self.items_of(own)));
                } else {
                    let own = self.files.item(0, &import.path);
                    items.extend(own.map(|own| self.item(&own)));
                }
            }
        }
        unique(items)
    }

    /// The classes and types of a file.
    fn items_of(&self, file: usize) -> Vec<CompletionItem> {
        let tree = self.files.file(file);
        let items = tree.into_iter().flat_map(|tree| &tree.items);
        let definitions = items.filter_map(|item| match item {
            Item::Class(class) => Some(Definition {
                file,
                name: &class.name,
                thing: Thing::Class(class),
            }),
            Item::Type(item) => Some(Definition {
                file,
                name: &item.name,
                thing: Thing::Type(item),
            }),
            Item::Experiment(_) | Item::Study(_) => None,
        });
        definitions.map(|own| self.item(&own)).collect()
    }

    fn item(&self, definition: &Definition<'_>) -> CompletionItem {
        let (line, doc) = signature(self.analysis, definition);
        let kind = match definition.thing {
            Thing::Package(_) => CompletionItemKind::MODULE,
            Thing::Type(_) | Thing::Class(_) => CompletionItemKind::CLASS,
            Thing::Variable(declaration, _) => {
                match declaration.prefixes.contains(&Prefix::Parameter) {
                    true => CompletionItemKind::CONSTANT,
                    false => CompletionItemKind::FIELD,
                }
            }
            Thing::Experiment(_) | Thing::Study(_) => CompletionItemKind::EVENT,
            Thing::Mode => CompletionItemKind::ENUM_MEMBER,
            Thing::Measure(..)
            | Thing::Domain(_)
            | Thing::Coordinate(_)
            | Thing::Clocked(_)
            | Thing::Modes(_)
            | Thing::Counter
            | Thing::ModeParameter(_)
            | Thing::Record(_) => CompletionItemKind::VARIABLE,
        };
        CompletionItem {
            label: definition.name.text.clone(),
            kind: Some(kind),
            detail: Some(line),
            documentation: doc.map(Documentation::String),
            ..CompletionItem::default()
        }
    }
}

/// The first of several items with one name: it hides the others.
fn unique(items: Vec<CompletionItem>) -> Vec<CompletionItem> {
    let mut seen = BTreeSet::new();
    let new = |item: &CompletionItem| seen.insert(item.label.clone());
    items.into_iter().filter(new).collect()
}
