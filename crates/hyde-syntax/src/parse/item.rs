//! Items: the file itself, and classes element by element.

use super::Parser;
use super::build::{Builder, Node, has, parts, significant};
use crate::ast::{
    Class, ClassBody, ClassKind, Clocked, EffectUse, Element, File, Import, Item, Name, TypeItem,
};
use crate::grammar::Rule;
use crate::{habits, recover, refusals};
use hyde_diag::Span;

/// Which section the elements of a class are in.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Declarations,
    Equations,
    InitialEquations,
}

impl Parser<'_> {
    pub(super) fn file(mut self) -> File {
        let mut file = File::default();
        while self.more() {
            let start = self.at;
            let errors = self.diagnostics.iter().count();
            self.part(&mut file);
            let broken = self.diagnostics.iter().count() > errors;
            self.end_part(start, broken);
        }
        file
    }

    /// The package clause, an import or an item.
    fn part(&mut self, file: &mut File) {
        let start = self.at;
        if self.refuse_too_deep() {
            return;
        }
        if self.looking_at("end") {
            self.end_of_nothing();
        } else if self.looking_at("package") {
            self.refuse_second(file);
            if let Some(pairs) = self.expect(Rule::package_clause) {
                let mut inner = significant(pairs).flat_map(parts);
                let mut build = self.build(start);
                if let Some(path) = inner.next()
                    && file.package.is_none()
                {
                    file.package = Some((build.reference(path), inner.next().map(Builder::text)));
                }
            }
        } else if self.looking_at("import") {
            if let Some(pairs) = self.expect(Rule::import_clause) {
                let mut inner = significant(pairs).flat_map(parts);
                let mut build = self.build(start);
                if let Some(path) = inner.next() {
                    file.imports.push(Import {
                        path: build.reference(path),
                        everything: inner.next().is_some(),
                    });
                }
            }
        } else if let Some(item) = self.item() {
            file.items.push(item);
            return;
        }
        if self.at == start {
            let behind = habits::behind_prefix(self.text, start);
            self.at = behind.unwrap_or_else(|| recover::skip_item(self.text, start));
        }
    }

    /// A file is one package.
    fn refuse_second(&mut self, file: &File) {
        let Some((first, _)) = &file.package else {
            return;
        };
        let span = Span::new(self.file, self.at, self.at + "package".len());
        self.diagnostics
            .push(refusals::second_package(span, first.span));
    }

    /// `end NAME;` outside of everything, as of a package.
    fn end_of_nothing(&mut self) {
        let start = self.at;
        let span = Span::new(self.file, start, start + "end".len());
        self.diagnostics.push(refusals::end_of_nothing(span));
        self.at = recover::skip_statement(self.text, start + "end".len());
    }

    fn item(&mut self) -> Option<Item> {
        let start = self.at;
        if self.looking_at("type") {
            let pairs = self.expect(Rule::type_item)?;
            let node = significant(pairs).next()?;
            return self.build(start).type_item(node).map(Item::Type);
        }
        if self.looking_at("experiment") {
            return self.experiment().map(Item::Experiment);
        }
        if ["calibrate", "diagnose", "sweep"]
            .iter()
            .any(|word| self.looking_at(word))
        {
            return self.study().map(Item::Study);
        }
        if self.looking_at("model")
            && self.nth_word(2) == Some("=")
            && self.nth_word(3) == Some("fmu")
            && self.nth_word(5).is_some_and(|word| word.starts_with('"'))
        {
            let pairs = self.expect(Rule::fmu_item)?;
            let node = significant(pairs).next()?;
            return self.build(start).fmu_class(node).map(Item::Class);
        }
        if self.looking_at("model")
            && self.nth_word(2) == Some("=")
            && let Some(pairs) = self.accept(Rule::short_item)
        {
            let node = significant(pairs).next()?;
            return self.build(start).short_class(node).map(Item::Class);
        }
        self.class().map(Item::Class)
    }

    fn class(&mut self) -> Option<Class> {
        let start = self.at;
        let pairs = self.expect(Rule::class_header)?;
        let node = significant(pairs).next()?;
        let mut build = self.build(start);
        let mut kind = ClassKind::Model;
        let (mut name, mut host, mut doc) = (None, None, None);
        for part in parts(node) {
            match part.as_rule() {
                Rule::class_kind => kind = class_kind(&part),
                Rule::ident => name = Some(build.name(&part)),
                Rule::host => host = parts(part).next().map(|path| build.reference(path)),
                _ => doc = Some(Builder::text(part)),
            }
        }
        let name = name?;
        let elements = self.elements(&name, Section::Declarations);
        let body = ClassBody::Long { host, elements };
        Some(Class {
            kind,
            name,
            doc,
            body,
            span: Span::new(self.file, start, self.at),
        })
    }

    /// Elements up to `end NAME;`. Equations in `first` section `Equations` need no `equation` before them.
    fn elements(&mut self, name: &Name, first: Section) -> Vec<Element> {
        let mut elements = Vec::new();
        let mut section = first;
        while self.more() {
            let start = self.at;
            if self.looking_at("end") {
                self.end(name);
                return elements;
            }
            if let Some(pairs) = self.accept(Rule::section) {
                let initial = pairs
                    .into_iter()
                    .any(|node| has(&node, Rule::initial_section));
                section = if initial {
                    Section::InitialEquations
                } else {
                    Section::Equations
                };
                continue;
            }
            if self.refuse_too_deep() || self.refuse_nested(name) {
                continue;
            }
            if self.at_item() {
                break;
            }
            let Some(pairs) = self.expect(Rule::element) else {
                self.at = self.behind_broken(start);
                continue;
            };
            for node in significant(pairs) {
                match node.as_rule() {
                    Rule::clocked_header => {
                        if let Some(clocked) = self.clocked(start, node) {
                            elements.push(Element::Clocked(clocked));
                        }
                    }
                    rule => {
                        if rule == Rule::added {
                            section = Section::Equations;
                        }
                        let span = self.build(start).span(&node);
                        let Some(element) = self.build(start).element(node) else {
                            continue;
                        };
                        let is_equation = matches!(element, Element::Equation(_));
                        elements.push(self.placed(element, section, span));
                        if is_equation && section == Section::Declarations {
                            section = Section::Equations; // The word is missing once, not at every equation.
                        }
                    }
                }
            }
        }
        self.missing_end(name);
        elements
    }

    /// Reports and skips a class inside of another; whether there was one.
    fn refuse_nested(&mut self, outer: &Name) -> bool {
        const CLASSES: [&str; 5] = ["model", "connector", "effect", "function", "package"];
        let (Some(word), Some(name)) = (self.nth_word(0), self.nth_word(1)) else {
            return false;
        };
        // At the beginning of a line it is the outer one that has no end.
        if !CLASSES.contains(&word) || self.text[..self.at].ends_with('\n') {
            return false;
        }
        let span = Span::new(self.file, self.at, self.at + word.len());
        self.diagnostics
            .push(refusals::nested_class((name, span), &outer.text));
        self.at = recover::skip_class(self.text, self.at, name);
        true
    }

    /// Where elements go on after a broken one.
    fn behind_broken(&self, start: usize) -> usize {
        let readable = habits::behind_prefix(self.text, start)
            .or_else(|| habits::behind_comment(self.text, start));
        if let Some(behind) = readable {
            return behind;
        }
        let of_assignments = self.looking_at("algorithm") || self.nth_word(1) == Some("algorithm");
        let behind = if of_assignments {
            recover::skip_section(self.text, start)
        } else {
            recover::skip_statement(self.text, start)
        };
        let behind = behind.max(start + 1);
        // The `end;` of a block that is not called by its word.
        let block = self
            .nth_word(0)
            .is_some_and(|word| recover::BLOCKS.contains(&word));
        match recover::behind_bare_end(self.text, behind) {
            Some(end) if block => end,
            _ => behind,
        }
    }

    /// An equation in its section; one outside of any is reported.
    fn placed(&mut self, element: Element, section: Section, span: Span) -> Element {
        match (element, section) {
            (Element::Equation(equation), Section::InitialEquations) => {
                Element::InitialEquation(equation)
            }
            (element @ Element::Equation(_), Section::Declarations) => {
                self.diagnostics
                    .push(refusals::equation_among_declarations(span));
                element
            }
            (element, _) => element,
        }
    }

    fn clocked(&mut self, start: usize, node: Node<'_>) -> Option<Clocked> {
        let mut inner = parts(node);
        let mut build = self.build(start);
        let name = build.name(&inner.next()?);
        let arguments = build.arguments(inner.next()?);
        let elements = self.elements(&name, Section::Equations);
        Some(Clocked {
            name,
            arguments,
            elements,
            span: Span::new(self.file, start, self.at),
        })
    }

    /// `end NAME;`, with the name that was opened.
    pub(super) fn end(&mut self, opened: &Name) {
        let start = self.at;
        if self.nth_word(1) == Some(";") {
            let span = Span::new(self.file, start, start + "end".len());
            self.diagnostics
                .push(refusals::end_without_name(opened, span));
            self.at = recover::skip_statement(self.text, start + "end".len());
            return;
        }
        let Some(pairs) = self.expect(Rule::end_clause) else {
            self.at = recover::skip_statement(self.text, start + 3);
            return;
        };
        let Some(node) = significant(pairs).flat_map(parts).next() else {
            return;
        };
        let closed = self.build(start).name(&node);
        if closed.text != opened.text {
            self.diagnostics
                .push(refusals::end_of_another(opened, &closed));
        }
    }

    pub(super) fn missing_end(&mut self, opened: &Name) {
        self.diagnostics.push(refusals::no_end(opened));
    }

    /// Whether a new item begins here, at the start of a line.
    pub(super) fn at_item(&self) -> bool {
        self.text[..self.at].ends_with('\n')
            && recover::ITEMS.iter().any(|word| self.looking_at(word))
    }
}

impl Builder<'_> {
    fn type_item(&mut self, node: Node<'_>) -> Option<TypeItem> {
        let mut inner = parts(node);
        let name = self.name(&inner.next()?);
        let base = self.reference(inner.next()?);
        let mut item = TypeItem {
            name,
            base,
            unit: None,
            doc: None,
        };
        for part in inner {
            if part.as_rule() == Rule::unit {
                item.unit = Some(self.unit(part));
            } else {
                item.doc = Some(Self::text(part));
            }
        }
        Some(item)
    }

    fn short_class(&mut self, node: Node<'_>) -> Option<Class> {
        let span = self.span(&node);
        let mut inner = parts(node).filter(|part| part.as_rule() != Rule::kw_model);
        let name = self.name(&inner.next()?);
        let base = self.reference(inner.next()?);
        let (mut changes, mut effects, mut doc) = (Vec::new(), Vec::new(), None);
        for part in inner {
            match part.as_rule() {
                Rule::modification => changes = self.changes(part),
                Rule::effects => {
                    effects = parts(part)
                        .filter_map(|part| self.effect_use(part))
                        .collect()
                }
                _ => doc = Some(Self::text(part)),
            }
        }
        let body = ClassBody::Short {
            base,
            fmu: None,
            changes,
            effects,
        };
        Some(Class {
            kind: ClassKind::Model,
            name,
            doc,
            body,
            span,
        })
    }

    /// `model Controller = fmu("controller.fmu", Kp = 2);`
    fn fmu_class(&mut self, node: Node<'_>) -> Option<Class> {
        let span = self.span(&node);
        let words = [Rule::kw_model, Rule::kw_fmu];
        let mut inner = parts(node).filter(|part| !words.contains(&part.as_rule()));
        let name = self.name(&inner.next()?);
        let file = inner.next()?;
        let place = self.span(&file);
        let (mut changes, mut doc) = (Vec::new(), None);
        for part in inner {
            match part.as_rule() {
                Rule::change => changes.extend(self.only_change(part)),
                _ => doc = Some(Self::text(part)),
            }
        }
        let word = crate::ast::Name {
            text: "fmu".to_owned(),
            span: place,
        };
        let body = ClassBody::Short {
            base: crate::ast::Reference {
                parts: vec![crate::ast::Part {
                    name: word,
                    subscripts: Vec::new(),
                }],
                span: place,
            },
            fmu: Some((Self::string(&file), place)),
            changes,
            effects: Vec::new(),
        };
        Some(Class {
            kind: ClassKind::Model,
            name,
            doc,
            body,
            span,
        })
    }

    pub(super) fn effect_use(&mut self, node: Node<'_>) -> Option<EffectUse> {
        let mut inner = parts(node);
        let effect = self.reference(inner.next()?);
        let mut used = EffectUse {
            effect,
            changes: Vec::new(),
            sites: Vec::new(),
        };
        for part in inner {
            if part.as_rule() == Rule::modification {
                used.changes = self.changes(part);
            } else {
                used.sites.push(self.reference(part));
            }
        }
        Some(used)
    }
}

fn class_kind(node: &Node<'_>) -> ClassKind {
    if has(node, Rule::kw_connector) {
        ClassKind::Connector
    } else if has(node, Rule::kw_effect) {
        ClassKind::Effect
    } else if has(node, Rule::kw_function) {
        ClassKind::Function
    } else {
        ClassKind::Model
    }
}
