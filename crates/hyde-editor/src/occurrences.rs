//! Every name of a file with what it means: where it is declared, and where it is used.

mod equation;
mod experiment;

use crate::scope::{Definition, FileIndex, Files, Inside, Thing, dotted, own_of_experiment};
use hyde_diag::Span;
use hyde_syntax::ast::{
    Change, Class, ClassBody, Declarator, EffectUse, Element, Import, Item, Measure, Name,
    Reference,
};

/// A name at a place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Occurrence<'a> {
    pub(crate) span: Span,
    pub(crate) text: &'a str,
    /// What it means; nothing where this is not known.
    pub(crate) meaning: Option<Definition<'a>>,
    /// Whether it is declared here.
    pub(crate) declares: bool,
}

/// All names of a file, in the order of the walk.
pub(crate) fn occurrences<'a>(files: Files<'a>, file: FileIndex) -> Vec<Occurrence<'a>> {
    let mut walk = Walk {
        files,
        file,
        frames: Vec::new(),
        found: Vec::new(),
    };
    walk.whole_file();
    walk.found
}

/// Names that a place knows, besides those of its file.
pub(crate) enum Frame<'a> {
    Inside(Inside<'a>),
    Experiment(FileIndex, &'a hyde_syntax::ast::Experiment),
    Local(Vec<Definition<'a>>),
}

/// What a word means in nested scopes, the innermost last.
pub(crate) fn resolve<'a>(
    files: Files<'a>,
    frames: &[Frame<'a>],
    word: &str,
) -> Option<Definition<'a>> {
    frames.iter().rev().find_map(|frame| match frame {
        Frame::Inside(inside) => files.member(*inside, word),
        Frame::Experiment(file, experiment) => own_of_experiment(*file, experiment, word),
        Frame::Local(names) => names.iter().find(|own| own.name.text == word).copied(),
    })
}

/// What the parts of a reference mean, as far as this is known, and where the members of the last one are.
pub(crate) fn resolve_parts<'a>(
    files: Files<'a>,
    first: Option<Definition<'a>>,
    rest: &[&str],
) -> (Vec<Option<Definition<'a>>>, Option<Inside<'a>>) {
    let mut meanings = vec![first];
    let mut changes = None;
    let mut inside = first.and_then(|first| files.inside(first, None));
    let mut last = first;
    for word in rest {
        if let Some(Definition {
            file,
            thing: Thing::Variable(_, declarator),
            ..
        }) = last
        {
            changes = Some((file, declarator.changes.as_slice()));
        }
        last = inside.and_then(|inside| files.member(inside, word));
        inside = last.and_then(|last| files.inside(last, changes));
        meanings.push(last);
    }
    (meanings, inside)
}

pub(crate) struct Walk<'a> {
    pub(crate) files: Files<'a>,
    pub(crate) file: FileIndex,
    pub(crate) frames: Vec<Frame<'a>>,
    pub(super) found: Vec<Occurrence<'a>>,
}

impl<'a> Walk<'a> {
    fn whole_file(&mut self) {
        let Some(tree) = self.files.file(self.file) else {
            return;
        };
        if let Some(package) = self.files.package_definition(self.file) {
            self.declare(package);
        }
        for import in &tree.imports {
            self.import(import);
        }
        for item in &tree.items {
            self.item(item);
        }
    }

    fn import(&mut self, import: &'a Import) {
        let parts = &import.path.parts;
        let package = match (import.everything, parts.split_last()) {
            (false, Some((_, package))) if !package.is_empty() => package,
            _ => parts.as_slice(),
        };
        let index = self.files.package(&dotted(package));
        let meaning = index.and_then(|index| self.files.package_definition(index));
        if let Some(last) = package.last() {
            self.add(&last.name, meaning);
        }
        if package.len() < parts.len()
            && let Some(last) = parts.last()
        {
            let item = self.files.item(self.file, &import.path);
            self.add(&last.name, item);
        }
    }

    fn item(&mut self, item: &'a Item) {
        let file = self.file;
        match item {
            Item::Type(item) => {
                self.declare(Definition {
                    file,
                    name: &item.name,
                    thing: Thing::Type(item),
                });
                self.type_name(&item.base);
            }
            Item::Class(class) => self.class(class),
            Item::Experiment(experiment) => self.experiment(experiment),
            Item::Study(study) => self.study(study),
        }
    }

    fn class(&mut self, class: &'a Class) {
        let file = self.file;
        self.declare(Definition {
            file,
            name: &class.name,
            thing: Thing::Class(class),
        });
        self.within(
            Frame::Inside(Inside::Class(file, class)),
            |walk| match &class.body {
                ClassBody::Long { host, elements } => {
                    host.iter().for_each(|host| walk.class_name(host));
                    elements.iter().for_each(|element| walk.element(element));
                }
                ClassBody::Short {
                    base,
                    changes,
                    effects,
                    fmu,
                } => {
                    if fmu.is_none() {
                        walk.class_name(base);
                    }
                    walk.changes_of_class(base, changes);
                    effects.iter().for_each(|used| walk.effect_use(used));
                }
            },
        );
    }

    /// `Stribeck(dF = 150 [N]) on guide`, the site in the present scope.
    pub(super) fn effect_use(&mut self, used: &'a EffectUse) {
        self.class_name(&used.effect);
        self.changes_of_class(&used.effect, &used.changes);
        for site in &used.sites {
            self.reference(site);
        }
    }

    fn element(&mut self, element: &'a Element) {
        let file = self.file;
        match element {
            Element::Extends(base, changes) => {
                self.class_name(base);
                self.changes_of_class(base, changes);
            }
            Element::Declaration(declaration) => {
                let meaning = self.files.declared(file, declaration);
                if meaning.is_some() {
                    self.path(&declaration.type_name, meaning);
                } else {
                    self.type_name(&declaration.type_name);
                }
                self.expressions(&declaration.dims);
                let class = meaning.and_then(|own| {
                    let Thing::Class(class) = own.thing else {
                        return None;
                    };
                    Some((own.file, class))
                });
                for declarator in &declaration.declarators {
                    self.declare(Definition {
                        file,
                        name: &declarator.name,
                        thing: Thing::Variable(declaration, declarator),
                    });
                    let inside = class.map(|(file, class)| Inside::Class(file, class));
                    self.declarator(declarator, inside);
                }
            }
            Element::Domain(domain) => {
                for (name, thing) in [
                    (&domain.name, Thing::Domain(domain)),
                    (&domain.coordinate, Thing::Coordinate(domain)),
                ] {
                    self.declare(Definition { file, name, thing });
                }
                self.range(&domain.range);
            }
            Element::Discretize(item) => {
                self.word(&item.domain);
                self.arguments(&item.arguments);
            }
            Element::Modes(modes) => self.modes(modes),
            Element::Clocked(clocked) => {
                self.declare(Definition {
                    file,
                    name: &clocked.name,
                    thing: Thing::Clocked(clocked),
                });
                self.arguments(&clocked.arguments);
                let inside = Inside::Elements(file, &clocked.elements);
                self.within(Frame::Inside(inside), |walk| {
                    clocked.elements.iter().for_each(|own| walk.element(own));
                });
            }
            Element::Equation(equation)
            | Element::InitialEquation(equation)
            | Element::Add(equation) => self.equation(equation),
            Element::Wrap(site, value) => {
                self.reference(site);
                self.expression(value);
            }
            Element::Replace(part, by, changes) => {
                self.reference(part);
                self.class_name(by);
                self.changes_of_class(by, changes);
            }
            Element::Signature(marks) => {
                marks.iter().for_each(|(_, own)| self.arguments(own));
            }
            Element::Confounds(effects) => effects.iter().for_each(|own| self.class_name(own)),
            Element::Measure(measure) => self.measure(measure, None),
            Element::Account(kind, measure) => self.measure(measure, Some(*kind)),
        }
    }

    pub(super) fn measure(
        &mut self,
        measure: &'a Measure,
        kind: Option<hyde_syntax::ast::AccountKind>,
    ) {
        self.type_name(&measure.type_name);
        self.declare(Definition {
            file: self.file,
            name: &measure.name,
            thing: Thing::Measure(measure, kind),
        });
        self.expression(&measure.value);
    }

    fn declarator(&mut self, declarator: &'a Declarator, inside: Option<Inside<'a>>) {
        self.expressions(&declarator.dims);
        if let Some(inside) = inside {
            self.changes(inside, &declarator.changes);
        } else {
            // Attributes of a quantity, such as `start`, are declared nowhere.
            for change in &declarator.changes {
                change.value.iter().for_each(|value| self.expression(value));
            }
        }
        declarator
            .domain
            .iter()
            .for_each(|domain| self.word(domain));
        declarator
            .binding
            .iter()
            .for_each(|value| self.expression(value));
        declarator.within.iter().for_each(|range| self.range(range));
        self.arguments(&declarator.over);
    }

    /// A reference in the present scope.
    pub(super) fn reference(&mut self, reference: &'a Reference) {
        let Some((first, rest)) = reference.parts.split_first() else {
            return;
        };
        let meaning = resolve(self.files, &self.frames, &first.name.text);
        let words: Vec<&str> = rest.iter().map(|part| part.name.text.as_str()).collect();
        let (meanings, _) = resolve_parts(self.files, meaning, &words);
        self.parts(reference, &meanings);
    }

    fn parts(&mut self, reference: &'a Reference, meanings: &[Option<Definition<'a>>]) {
        let column = |at: usize| {
            let before = at.checked_sub(1).and_then(|before| meanings.get(before));
            matches!(before, Some(Some(own)) if matches!(own.thing, Thing::Record(_)))
        };
        for (at, (part, meaning)) in reference.parts.iter().zip(meanings).enumerate() {
            if column(at) {
                break; // Columns and what is behind them are declared nowhere.
            }
            self.add(&part.name, *meaning);
            self.expressions(&part.subscripts);
        }
    }

    /// The name of a type, and its package.
    pub(super) fn type_name(&mut self, name: &'a Reference) {
        let builtin = ["Real", "Integer", "Boolean"];
        if !builtin.iter().any(|word| name.as_word() == Some(word)) {
            self.path(name, self.files.item(self.file, name));
        }
    }

    /// The name of a class, and its package.
    pub(super) fn class_name(&mut self, name: &'a Reference) {
        let meaning = self.files.class_definition(self.file, name);
        self.path(name, meaning);
    }

    fn path(&mut self, name: &'a Reference, meaning: Option<Definition<'a>>) {
        if let Some((last, package)) = name.parts.split_last() {
            if let Some(before) = package.last() {
                let index = self.files.package(&dotted(package));
                let package = index.and_then(|index| self.files.package_definition(index));
                self.add(&before.name, package);
            }
            self.add(&last.name, meaning);
        }
    }

    pub(super) fn changes_of_class(&mut self, class: &Reference, changes: &'a [Change]) {
        if let Some((file, class)) = self.files.class(self.file, class) {
            self.changes(Inside::Class(file, class), changes);
        }
    }

    /// Changes: their targets in the class, their values in the present scope.
    pub(super) fn changes(&mut self, inside: Inside<'a>, changes: &'a [Change]) {
        for change in changes {
            change.redeclare.iter().for_each(|own| self.class_name(own));
            let Some((first, rest)) = change.target.parts.split_first() else {
                continue;
            };
            let meaning = self.files.member(inside, &first.name.text);
            let words: Vec<&str> = rest.iter().map(|part| part.name.text.as_str()).collect();
            let (meanings, mut below) = resolve_parts(self.files, meaning, &words);
            // A change beside this one may say which class the part is.
            if let (Some(meaning), false) = (meaning, words.is_empty()) {
                let beside = Some((self.file, changes));
                if let Some(other) = self.files.inside(meaning, beside) {
                    let next = self.files.member(other, words[0]);
                    let (mut later, last) = resolve_parts(self.files, next, &words[1..]);
                    later.insert(0, Some(meaning));
                    self.parts(&change.target, &later);
                    below = last;
                } else {
                    self.parts(&change.target, &meanings);
                }
            } else {
                self.parts(&change.target, &meanings);
            }
            if let Some((file, class)) = change
                .redeclare
                .as_ref()
                .and_then(|own| self.files.class(self.file, own))
            {
                below = Some(Inside::Class(file, class));
            }
            match below {
                Some(below) => self.changes(below, &change.changes),
                None => {
                    for attribute in &change.changes {
                        attribute
                            .value
                            .iter()
                            .for_each(|value| self.expression(value));
                    }
                }
            }
            change.value.iter().for_each(|value| self.expression(value));
        }
    }

    /// A single word in the present scope.
    pub(super) fn word(&mut self, name: &'a Name) {
        let meaning = resolve(self.files, &self.frames, &name.text);
        self.add(name, meaning);
    }

    pub(super) fn within(&mut self, frame: Frame<'a>, inner: impl FnOnce(&mut Self)) {
        self.frames.push(frame);
        inner(self);
        self.frames.pop();
    }

    pub(super) fn declare(&mut self, definition: Definition<'a>) {
        self.found.push(Occurrence {
            span: definition.name.span,
            text: &definition.name.text,
            meaning: Some(definition),
            declares: true,
        });
    }

    pub(super) fn add(&mut self, name: &'a Name, meaning: Option<Definition<'a>>) {
        self.found.push(Occurrence {
            span: name.span,
            text: &name.text,
            meaning,
            declares: false,
        });
    }
}
