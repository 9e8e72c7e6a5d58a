//! What may be written at a place: members behind a dot, parameters in a modification, units in brackets, names and keywords.

use crate::analysis::Analysis;
use crate::describe::signature;
use crate::occurrences::{Frame, resolve, resolve_parts};
use crate::scope::{Definition, Files, Inside, Thing};
use hyde_syntax::ast::{ClassBody, Element, Experiment, Item, Part, Prefix, Reference};
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
const IN_STUDY: &[&str] = &["vary", "end"];

/// What may be written at a byte.
pub(crate) fn complete(analysis: &Analysis, byte: usize) -> Vec<CompletionItem> {
    let text = analysis.text();
    let Some(before) = text.get(..byte) else {
        return Vec::new();
    };
    let Some(open) = open_brackets(before) else {
        return Vec::new(); // A comment or a text.
    };
    let word = before
        .rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_')
        .map_or(0, |at| {
            at + before[at..].chars().next().map_or(1, char::len_utf8)
        });
    let rest = &before[..word];
    let place = Place {
        analysis,
        files: analysis.files(),
        frames: frames(analysis, byte),
    };
    if let Some(chain) = rest.strip_suffix('.') {
        return place.members(chain);
    }
    if let Some((at, '[')) = open.last().copied() {
        let value = before[..at].trim_end();
        let number = value.ends_with(|c: char| c.is_ascii_digit() || c == '}' || c == '±');
        if number || value.ends_with("Real") {
            return place.units();
        }
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
    }
    items.extend(place.names());
    items
}

/// The brackets that are open at the end of a text; nothing in a comment or a text.
fn open_brackets(before: &str) -> Option<Vec<(usize, char)>> {
    let mut open = Vec::new();
    let mut at = 0;
    while let Some(sign) = before[at..].chars().next() {
        let rest = &before[at..];
        at += if rest.starts_with("//") {
            rest.find('\n')?
        } else if let Some(inner) = rest.strip_prefix("/*") {
            inner.find("*/")? + 4
        } else if sign == '"' {
            let mut escaped = false;
            let end = rest.char_indices().skip(1).find(|(_, own)| {
                let ends = *own == '"' && !escaped;
                escaped = *own == '\\' && !escaped;
                ends
            });
            end?.0 + 1
        } else {
            match sign {
                '(' | '[' | '{' => open.push((at, sign)),
                ')' | ']' | '}' => drop(open.pop()),
                // A statement ends: a bracket before it was forgotten.
                ';' => open.retain(|(_, own)| *own == '{'),
                _ => {}
            }
            sign.len_utf8()
        };
    }
    Some(open)
}

/// The names that are known at a byte of the file itself.
pub(crate) fn frames(analysis: &Analysis, byte: usize) -> Vec<Frame<'_>> {
    let files = analysis.files();
    let Some(tree) = files.file(0) else {
        return Vec::new();
    };
    let holds = |span: hyde_diag::Span| (span.start as usize) <= byte && byte <= span.end as usize;
    for item in &tree.items {
        match item {
            Item::Class(class) if holds(class.span) => {
                let mut frames = vec![Frame::Inside(Inside::Class(0, class))];
                if let ClassBody::Long { elements, .. } = &class.body {
                    for element in elements {
                        if let Element::Clocked(clocked) = element
                            && holds(clocked.span)
                        {
                            frames.push(Frame::Inside(Inside::Elements(0, &clocked.elements)));
                        }
                    }
                }
                return frames;
            }
            Item::Experiment(experiment) if holds(experiment.span) => {
                return experiment_frames(files, experiment);
            }
            Item::Study(study) if holds(study.span) => {
                let word = study.of.as_word().unwrap_or_default();
                if let Some(experiment) = files.experiment(0, word) {
                    return experiment_frames(files, experiment);
                }
                let class = files.class(0, &study.of);
                let own = class.map(|(file, class)| Frame::Inside(Inside::Class(file, class)));
                return own.into_iter().collect();
            }
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => {}
        }
    }
    Vec::new()
}

fn experiment_frames<'a>(files: Files<'a>, experiment: &'a Experiment) -> Vec<Frame<'a>> {
    let model = files.class(0, &experiment.model);
    let model = model.map(|(file, class)| Frame::Inside(Inside::Class(file, class)));
    let mut frames: Vec<Frame<'a>> = model.into_iter().collect();
    frames.push(Frame::Experiment(0, experiment));
    frames
}

struct Place<'a> {
    analysis: &'a Analysis,
    files: Files<'a>,
    frames: Vec<Frame<'a>>,
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
        let (_, inside) = resolve_parts(self.files, meaning, rest);
        let mut items = Vec::new();
        if let Some(inside) = inside {
            self.files.each_member(inside, &mut |member| {
                items.push(self.item(&member));
            });
        }
        unique(items)
    }

    /// The class whose parts are changed in the open bracket of that number.
    fn modified(&self, before: &str, open: &[(usize, char)], number: usize) -> Option<Inside<'a>> {
        let (at, _) = *open.get(number).filter(|(_, sign)| *sign == '(')?;
        let head = before.get(..at)?.trim_end();
        let words = chain_words(head);
        let (first, rest) = words.split_first()?;
        let name_start = head.len() - chain_len(head);
        let left = head[..name_start].trim_end();
        // `Type name(`, `extends Type(`, `of Type(`, `model A = Type(`, `by Type(`, `with Type(`
        let keyword = ["extends", "of", "=", "by", "with"];
        let is_class = keyword.iter().any(|word| left.ends_with(word));
        let outer = number.checked_sub(1).filter(|_| !is_class);
        if let Some(outer) = outer
            && let Some(inside) = self.modified(before, open, outer)
        {
            let redeclared = chain_words(left);
            if chain_words(left[..left.len() - chain_len(left)].trim_end()) == ["redeclare"] {
                return self.class_inside(&redeclared);
            }
            let member = self.files.member(inside, first);
            return resolve_parts(self.files, member, rest).1;
        }
        if is_class {
            return self.class_inside(&words);
        }
        let declared = chain_words(left);
        (rest.is_empty() && !declared.is_empty())
            .then(|| self.class_inside(&declared))
            .flatten()
    }

    fn class_inside(&self, words: &[&str]) -> Option<Inside<'a>> {
        let (id, _) = self.files.files.first()?;
        let span = hyde_diag::Span::new(*id, 0, 0);
        let parts = words.iter().map(|word| Part {
            name: hyde_syntax::ast::Name {
                text: (*word).to_owned(),
                span,
            },
            subscripts: Vec::new(),
        });
        let name = Reference {
            parts: parts.collect(),
            span,
        };
        let (file, class) = self.files.class(0, &name)?;
        Some(Inside::Class(file, class))
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

    /// The units that the types and the values of the loaded files have.
    fn units(&self) -> Vec<CompletionItem> {
        let mut units: BTreeSet<String> = BTreeSet::new();
        for (id, tree) in self.files.files {
            for item in &tree.items {
                if let Item::Type(item) = item {
                    units.extend(item.unit.as_ref().map(|unit| unit.text.clone()));
                }
            }
            let text = &self.analysis.loaded.sources.get(*id).text;
            for part in text.split(['0', '1', '2', '3', '4', '5', '6', '7', '8', '9']) {
                let unit = part.strip_prefix(" [").and_then(|own| own.split_once(']'));
                units.extend(unit.map(|(unit, _)| unit.trim().to_owned()));
            }
        }
        let units = units.into_iter().filter(|unit| !unit.is_empty());
        units
            .map(|label| CompletionItem {
                label,
                kind: Some(CompletionItemKind::UNIT),
                ..CompletionItem::default()
            })
            .collect()
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

/// The words of the dotted name at the end of a text, subscripts left out.
fn chain_words(text: &str) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = text;
    loop {
        if rest.ends_with(']') {
            rest = match rest.rfind('[') {
                Some(at) => rest[..at].trim_end(),
                None => return Vec::new(),
            };
        }
        let start = rest
            .rfind(|c: char| !c.is_ascii_alphanumeric() && c != '_')
            .map_or(0, |at| {
                at + rest[at..].chars().next().map_or(1, char::len_utf8)
            });
        if start == rest.len() {
            return words;
        }
        words.insert(0, &rest[start..]);
        match rest[..start].strip_suffix('.') {
            Some(before) => rest = before,
            None => return words,
        }
    }
}

/// The length of the dotted name at the end of a text, with its subscripts.
fn chain_len(text: &str) -> usize {
    let mut rest = text;
    loop {
        if rest.ends_with(']') {
            match rest.rfind('[') {
                Some(at) => rest = rest[..at].trim_end(),
                None => return text.len() - rest.len(),
            }
        }
        rest = rest.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
        match rest.strip_suffix('.') {
            Some(before) => rest = before,
            None => return text.len() - rest.len(),
        }
    }
}
