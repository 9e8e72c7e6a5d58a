//! [`alone`]: the classes of a file, each by itself.
//!
//! A model that no experiment uses is instantiated with the values that it declares, an effect is put on a component of the type
//! that it is for, and a function is called with variables of the types of its inputs. Such a model need not be solvable: its
//! connectors are open, and a parameter may have no value yet. Therefore only the kinds of mistakes count that no surrounding
//! model can mend ([`is_sure`]), and only those in the file itself.

use crate::load::File;
use crate::pipeline::input;
use crate::{Backend, Request};
use hyde_diag::{Code, Diagnostic, Diagnostics, FileId, Severity, Sources, Span};
use hyde_flatten::{Additions, Candidate, Form, FreeInputs};
use hyde_syntax::ast::{
    self, Class, ClassBody, ClassKind, Declaration, Element, Item, Prefix, Reference,
};
use std::collections::BTreeMap;
use std::sync::Arc;

/// What was looked at.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Alone {
    /// The kind and the name of each class that was looked at, in the order of the file.
    pub classes: Vec<(&'static str, String)>,
    /// The same of those that cannot be looked at by themselves: functions of arrays.
    pub left_out: Vec<(&'static str, String)>,
}

/// Looks at the classes of the first file, each by itself, but for models of these names, which were compiled. What is wrong is
/// in `diagnostics`; `stop` is asked before each class, and true ends the search.
pub fn alone(
    sources: &Sources,
    file: &File,
    compiled: &[String],
    stop: &dyn Fn() -> bool,
    diagnostics: &mut Diagnostics,
) -> Alone {
    let mut found = Alone::default();
    let (Some((own, tree)), false) = (file.files.first(), diagnostics.has_errors()) else {
        return found;
    };
    let classes = tree.items.iter().filter_map(|item| match item {
        Item::Class(class) => Some(class),
        Item::Experiment(_) | Item::Type(_) | Item::Study(_) => None,
    });
    let classes: Vec<&Class> = classes.collect();
    let frames = Frames::of(sources, file, *own, &classes);
    for class in &classes {
        let name = class.name.text.clone();
        if stop() {
            return found;
        }
        if class.kind == ClassKind::Model && compiled.contains(&name) {
            continue;
        }
        let noted = (class.kind.word(), name.clone());
        let Some(model) = frames.model_of(class) else {
            found.left_out.push(noted);
            continue;
        };
        let mut additions = Additions::kept();
        if class.kind == ClassKind::Effect {
            additions.put(*own, &on_the_host(name));
        }
        let mut errors = Diagnostics::new();
        let request = frames.request(&model);
        // The errors count, whether there is a model or not.
        let _flat = hyde_flatten::flatten(&input(&request, &additions), &mut errors);
        let open = Open::of(&errors, file);
        let sure = errors.iter().filter(|own| open.is_sure(own, class.kind));
        let sure = sure.filter_map(|error| frames.in_file(error));
        let sure = sure.filter(|error| !is_confounded(tree, error.labels[0].span));
        sure.for_each(|error| diagnostics.push(error));
        found.classes.push(noted);
    }
    found
}

/// Models around classes that are none: a component of the type, or a call.
struct Frames {
    sources: Sources,
    file: File,
    /// The number of the text with them, and where they begin in it.
    own: FileId,
    behind: usize,
    nothing: BTreeMap<String, f64>,
    records: BTreeMap<String, hyde_flatten::Header>,
}

/// The component in a frame.
const HOST: &str = "host";

impl Frames {
    fn of(sources: &Sources, file: &File, own: FileId, classes: &[&Class]) -> Self {
        let mut file = file.clone();
        let texts: Vec<String> = classes
            .iter()
            .filter_map(|class| frame(class, &file))
            .collect();
        // They stand behind the text of the file: what is in a package is found from where it is named.
        let text = format!("{}\n", sources.get(own).text);
        let behind = text.len();
        let text = text + &texts.concat();
        let mut extended = Sources::new();
        for (id, source) in sources.iter() {
            let text = if id == own { &text } else { &source.text };
            extended.add(source.name.clone(), text.clone());
        }
        // What is wrong in the file itself is known, and the frames have no errors.
        let mut frames = hyde_syntax::parse(&extended, own, &mut Diagnostics::new());
        frames.items.retain(
            |item| matches!(item, Item::Class(class) if class.span.start as usize >= behind),
        );
        for item in &mut frames.items {
            if let Item::Class(own) = item
                && let Some(host) = classes
                    .iter()
                    .find(|class| name_of(class) == own.name.text)
                    .and_then(|class| host_of(class))
                && in_its_package(&file, host).is_none()
            {
                in_the_words_of(own, host);
            }
        }
        if let Some((_, tree)) = file.files.first_mut() {
            Arc::make_mut(tree).items.append(&mut frames.items);
        }
        Self {
            sources: extended,
            file,
            own,
            behind,
            nothing: BTreeMap::new(),
            records: BTreeMap::new(),
        }
    }

    /// The model that has a class; of a model itself.
    fn model_of(&self, class: &Class) -> Option<String> {
        match class.kind {
            ClassKind::Model => Some(class.name.text.clone()),
            ClassKind::Connector | ClassKind::Effect | ClassKind::Function => {
                let name = name_of(class);
                self.file
                    .models()
                    .any(|known| known == name)
                    .then_some(name)
            }
        }
    }

    /// A mistake that is in the file, without the places in a frame.
    fn in_file(&self, error: &Diagnostic) -> Option<Diagnostic> {
        let is_own = |span: Span| {
            span.file == self.own && (span.start as usize) < self.behind && span.start < span.end
        };
        let first = error.labels.first()?;
        let mut found = error.clone();
        found
            .labels
            .retain(|label| label.span.file != self.own || is_own(label.span));
        is_own(first.span).then_some(found)
    }

    fn request<'a>(&'a self, model: &'a str) -> Request<'a> {
        Request {
            sources: &self.sources,
            file: &self.file,
            model,
            experiment: None,
            settings: &self.nothing,
            records: &self.records,
            free_inputs: FreeInputs::Undriven,
            ledger: false,
            form: Form::Run,
            backend: Backend::Native,
        }
    }
}

/// The name of the model around a class: one that no file has.
fn name_of(class: &Class) -> String {
    format!("{}_by_itself_in_a_check", class.name.text)
}

/// The type that an effect is for.
fn host_of(class: &Class) -> Option<&Reference> {
    match &class.body {
        ClassBody::Long { host, .. } => host.as_ref(),
        ClassBody::Short { .. } => None,
    }
}

/// The name of a class with its package: `Translational.Mass`, for `Mass` alone may be a quantity; nothing of a class of the file
/// itself, and of one that is not known.
fn in_its_package(file: &File, name: &Reference) -> Option<String> {
    let word = name.as_word()?;
    let has = |tree: &ast::File| {
        let mut items = tree.items.iter();
        items.any(|item| matches!(item, Item::Class(class) if class.name.text == word))
    };
    let found = file.files.iter().position(|(_, tree)| has(tree))?;
    let package = file.files[found].1.package.as_ref();
    let package = package.filter(|_| found > 0).map(|(path, _)| path.dotted());
    package.map(|package| format!("{package}.{word}"))
}

/// The text of a model around a class; nothing for a model, and for what cannot stand in one.
fn frame(class: &Class, file: &File) -> Option<String> {
    let name = name_of(class);
    let inside = match class.kind {
        ClassKind::Model => return None,
        ClassKind::Connector => format!("  {} {HOST};\n", class.name.text),
        ClassKind::Effect => {
            let host = host_of(class)?;
            let own = || hyde_syntax::format_reference(host);
            let host = in_its_package(file, host).unwrap_or_else(own);
            format!("  {host} {HOST};\n")
        }
        ClassKind::Function => call(class)?,
    };
    Some(format!("model {name}\n{inside}end {name};\n"))
}

/// A call of a function with variables for those of its inputs that need a value; nothing for a function of arrays.
fn call(class: &Class) -> Option<String> {
    let ClassBody::Long { elements, .. } = &class.body else {
        return None;
    };
    let mut text = String::new();
    let mut arguments = Vec::new();
    let mut result = None;
    for element in elements {
        let Element::Declaration(own) = element else {
            continue;
        };
        let is = |prefix: Prefix| own.prefixes.contains(&prefix);
        if (is(Prefix::Input) || is(Prefix::Output)) && has_dimensions(own) {
            return None;
        }
        let type_name = hyde_syntax::format_reference(&own.type_name);
        if is(Prefix::Output) {
            result = Some(type_name);
        } else if is(Prefix::Input) {
            for declarator in own.declarators.iter().filter(|one| one.binding.is_none()) {
                let variable = format!("given_{}", arguments.len());
                text += &format!("  {type_name} {variable};\n");
                arguments.push(format!("{} = {variable}", declarator.name.text));
            }
        }
    }
    let call = format!("{}({})", class.name.text, arguments.join(", "));
    Some(format!("{text}  {} found = {call};\n", result?))
}

fn has_dimensions(own: &Declaration) -> bool {
    let mut each = own.declarators.iter();
    !own.dims.is_empty() || each.any(|one| !one.dims.is_empty())
}

/// Lets the type of the component in a frame stand where the effect names it: a mistake in it is there.
fn in_the_words_of(frame: &mut Class, host: &Reference) {
    if let ClassBody::Long { elements, .. } = &mut frame.body {
        for element in elements {
            if let Element::Declaration(own) = element {
                own.type_name = host.clone();
            }
        }
    }
}

/// An effect on the component of its frame.
fn on_the_host(effect: String) -> Candidate {
    Candidate {
        instance: effect.clone(),
        effect,
        package: String::new(),
        host: String::new(),
        host_package: String::new(),
        doc: String::new(),
        site: HOST.to_owned(),
        aliases: Vec::new(),
        sizes: Vec::new(),
        shapes: Vec::new(),
        signature: Vec::new(),
        confounds: Vec::new(),
        replaces: Vec::new(),
    }
}

/// What of a class is open, so that some mistakes may be none of its own.
struct Open {
    /// Something has no value, or is not known: parts may be missing that are changed or connected.
    parts: bool,
    /// A parameter of no dimension of its own has no value that gives it one.
    dimensions: bool,
}

impl Open {
    fn of(errors: &Diagnostics, file: &File) -> Self {
        // The last place is that of the declaration.
        let is_plain = |error: &Diagnostic| {
            let place = error.labels.last().map(|label| label.span);
            place.is_none_or(|place| !has_own_dimension(file, place))
        };
        Self {
            parts: errors.iter().any(|own| kind_of(own.code).is_none()),
            dimensions: errors
                .iter()
                .any(|own| own.code == Code::NoValue && is_plain(own)),
        }
    }

    /// Whether a diagnostic is a mistake whatever surrounds the class.
    fn is_sure(&self, own: &Diagnostic, class: ClassKind) -> bool {
        let counts = match kind_of(own.code) {
            Some(Mistake::Word) => true,
            Some(Mistake::Dimension) => !self.dimensions,
            Some(Mistake::Part) => !self.parts && class != ClassKind::Function,
            None => false,
        };
        counts && own.severity == Severity::Error
    }
}

/// What a mistake of a class by itself is about.
enum Mistake {
    /// A word that is not known, or is used as what it is not.
    Word,
    /// Units.
    Dimension,
    /// What is connected or modified.
    Part,
}

/// What a mistake is about; nothing of those that a surrounding model may mend.
fn kind_of(code: Code) -> Option<Mistake> {
    let words = [
        Code::UnknownName,
        Code::UnknownType,
        Code::UnknownFunction,
        Code::BadArguments,
        Code::Duplicate,
        Code::WrongType,
        Code::BadUnit,
    ];
    let dimensions = [Code::UnitMismatch, Code::AngleMismatch, Code::ZeroPoint];
    let parts = [
        Code::Cycle,
        Code::BadConnection,
        Code::UnknownModification,
        Code::FinalModified,
        Code::SiteVariables,
    ];
    if words.contains(&code) {
        Some(Mistake::Word)
    } else if dimensions.contains(&code) {
        Some(Mistake::Dimension)
    } else {
        parts.contains(&code).then_some(Mistake::Part)
    }
}

/// Whether a declaration at a place has a type with a dimension: not `Real`.
fn has_own_dimension(file: &File, place: Span) -> bool {
    let mut trees = file.files.iter();
    let Some((_, tree)) = trees.find(|(id, _)| *id == place.file) else {
        return false;
    };
    let covers = |span: Span| span.start <= place.start && place.end <= span.end;
    let mut types = tree.items.iter().flat_map(elements).filter_map(|element| {
        let Element::Declaration(own) = element else {
            return None;
        };
        covers(own.span).then(|| own.type_name.as_word() != Some("Real"))
    });
    types.next_back().unwrap_or(false)
}

/// The elements of a class.
fn elements(item: &Item) -> &[Element] {
    match item {
        Item::Class(Class {
            body: ClassBody::Long { elements, .. },
            ..
        }) => elements,
        Item::Class(_) | Item::Experiment(_) | Item::Type(_) | Item::Study(_) => &[],
    }
}

/// Whether a place is that of an effect for which another one is easily taken: its package need not be loaded.
fn is_confounded(tree: &ast::File, place: Span) -> bool {
    let mut named = tree.items.iter().flat_map(elements);
    named.any(|element| {
        let Element::Confounds(names) = element else {
            return false;
        };
        names.iter().any(|name| name.span == place)
    })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
mod tests {
    use super::*;
    use crate::{Packages, load};

    fn of(text: &str) -> (Alone, Vec<(Code, String)>) {
        let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
        let file = load(
            &mut sources,
            "t.hyde",
            text,
            &Packages::LIBRARY,
            &mut diagnostics,
        );
        assert!(!diagnostics.has_errors(), "{diagnostics:?}");
        let found = alone(&sources, &file, &[], &|| false, &mut diagnostics);
        let at = |own: &Diagnostic| {
            let span = own.labels.first().unwrap().span;
            text[span.start as usize..span.end as usize].to_owned()
        };
        let errors = diagnostics.iter().map(|own| (own.code, at(own)));
        (found, errors.collect())
    }

    #[test]
    fn every_class_is_looked_at() {
        let text = include_str!("../../../tests/cases/mistakes_of_a_library/many.hyde");
        let (found, errors) = of(text);
        assert_eq!(found.classes.len(), 7, "{found:?}");
        let known = |code: Code, at: &str| errors.contains(&(code, at.to_owned()));
        assert!(known(Code::UnknownName, "undefined_name"), "{errors:?}");
        assert!(known(Code::UnknownType, "Nope"), "{errors:?}");
        assert!(known(Code::UnknownType, "Nowhere"), "{errors:?}");
        assert!(known(Code::UnknownName, "nosite"), "{errors:?}");
        let units = errors.iter().filter(|own| own.0 == Code::UnitMismatch);
        assert_eq!(units.count(), 3, "{errors:?}");
    }

    #[test]
    fn what_is_open_is_no_mistake() {
        let text = include_str!("../../../tests/cases/mistakes_of_a_library/open.hyde");
        let (found, errors) = of(text);
        assert_eq!(found.classes.len(), 7, "{found:?}");
        assert_eq!(errors, []);
    }
}
