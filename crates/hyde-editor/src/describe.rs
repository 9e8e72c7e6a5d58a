//! What a name is, as text for a hover: its declaration, type, unit, value and documentation.

use crate::analysis::Analysis;
use crate::scope::{Definition, FileIndex, Thing};
use hyde_diag::Span;
use hyde_syntax::ast::{AccountKind, Reference};
use hyde_syntax::{format_expression, format_reference};

/// A name as Markdown.
pub(crate) fn hover(analysis: &Analysis, definition: &Definition<'_>) -> String {
    let (line, doc) = signature(analysis, definition);
    let mut text = format!("```hyde\n{line}\n```");
    if let Some(doc) = doc {
        text.push_str(&format!("\n\n{doc}"));
    }
    let about = facts(analysis, definition);
    if !about.is_empty() {
        text.push_str(&format!("\n\n{}", about.join("  \n")));
    }
    text
}

/// The declaration of a name on one line, and its documentation.
pub(crate) fn signature(
    analysis: &Analysis,
    definition: &Definition<'_>,
) -> (String, Option<String>) {
    let name = &definition.name.text;
    match definition.thing {
        Thing::Package(tree) => {
            let (path, doc) = match &tree.package {
                Some((path, doc)) => (path.dotted(), doc.clone()),
                None => (name.clone(), None),
            };
            (format!("package {path}"), doc)
        }
        Thing::Type(item) => {
            let unit = item.unit.as_ref();
            let unit = unit.map_or_else(String::new, |unit| format!(" [{}]", unit.text));
            let base = item.base.dotted();
            (format!("type {name} = {base}{unit}"), item.doc.clone())
        }
        Thing::Class(class) => (format!("{} {name}", class.kind.word()), class.doc.clone()),
        Thing::Variable(declaration, declarator) => {
            let words = declaration.prefixes.iter().map(|prefix| prefix.word());
            let mut line: Vec<String> = words.map(str::to_owned).collect();
            line.push(format_reference(&declaration.type_name));
            line.push(name.clone());
            if let Some(value) = &declarator.binding {
                line.push(format!("= {}", format_expression(value)));
            }
            if let Some(prior) = &declarator.prior {
                line.push(analysis.loaded.sources.text(prior.span).to_owned());
            }
            if let Some(source) = &declarator.source {
                line.push(format!("from \"{source}\""));
            }
            if let Some(range) = &declarator.within {
                let (from, to) = (format_expression(&range.from), format_expression(&range.to));
                line.push(format!("in {from} .. {to}"));
            }
            (line.join(" "), declarator.doc.clone())
        }
        Thing::Measure(measure, kind) => {
            let word = kind.map_or("measure", AccountKind::word);
            let value = format_expression(&measure.value);
            let type_name = measure.type_name.dotted();
            (
                format!("{word} {type_name} {name} = {value}"),
                measure.doc.clone(),
            )
        }
        Thing::Domain(domain) | Thing::Coordinate(domain) => {
            let (from, to) = (&domain.range.from, &domain.range.to);
            let (from, to) = (format_expression(from), format_expression(to));
            let (own, coordinate) = (&domain.name.text, &domain.coordinate.text);
            (
                format!("domain {own}({coordinate} in {from} .. {to})"),
                None,
            )
        }
        Thing::Clocked(_) => (format!("clocked {name}"), None),
        Thing::Modes(_) => (format!("modes {name}"), None),
        Thing::Mode => (format!("mode {name}"), None),
        Thing::Counter => (format!("for {name}"), None),
        Thing::ModeParameter(type_name) => (format!("{} {name}", type_name.dotted()), None),
        Thing::Record(record) => {
            let file = record.default.as_ref();
            let file = file.map_or_else(String::new, |file| format!(" = \"{}\"", file.text));
            (format!("record {name}{file}"), None)
        }
        Thing::Experiment(experiment) => (
            format!("experiment {name} of {}", experiment.model.dotted()),
            experiment.doc.clone(),
        ),
        Thing::Study(study) => {
            let word = study.kind.word();
            (
                format!("{word} {name} of {}", study.of.dotted()),
                study.doc.clone(),
            )
        }
    }
}

/// The unit of its type, and where it is declared.
fn facts(analysis: &Analysis, definition: &Definition<'_>) -> Vec<String> {
    let mut facts = Vec::new();
    let file = definition.file;
    let type_name = type_name(definition);
    if let Some(type_name) = type_name
        && let Some(item) = if let Thing::Variable(declaration, _) = definition.thing {
            analysis.files().declared(file, declaration)
        } else {
            analysis.files().item(file, type_name)
        }
    {
        let (line, doc) = signature(analysis, &item);
        let doc = doc.map_or_else(String::new, |doc| format!(": {doc}"));
        let is_type = matches!(item.thing, Thing::Type(_));
        let own = is_type.then(|| unit(analysis, file, type_name)).flatten();
        facts.push(match own {
            Some(unit) => format!("unit `{unit}`"),
            None => format!("`{line}`{doc}"),
        });
    }
    let own = analysis.own();
    if Some(definition.name.span.file) != own {
        facts.push(format!(
            "declared in `{}`",
            place(analysis, definition.name.span)
        ));
    }
    facts
}

/// The type of what is declared with one.
pub(crate) fn type_name<'a>(definition: &Definition<'a>) -> Option<&'a Reference> {
    match definition.thing {
        Thing::Variable(declaration, _) => Some(&declaration.type_name),
        Thing::Measure(measure, _) => Some(&measure.type_name),
        Thing::ModeParameter(type_name) => Some(type_name),
        Thing::Package(_)
        | Thing::Type(_)
        | Thing::Class(_)
        | Thing::Domain(_)
        | Thing::Coordinate(_)
        | Thing::Clocked(_)
        | Thing::Modes(_)
        | Thing::Mode
        | Thing::Counter
        | Thing::Record(_)
        | Thing::Experiment(_)
        | Thing::Study(_) => None,
    }
}

/// The unit of a type, through the types that it is made from.
pub(crate) fn unit(analysis: &Analysis, file: FileIndex, type_name: &Reference) -> Option<String> {
    let (mut file, mut name) = (file, type_name);
    for _ in 0..16 {
        let found = analysis.files().item(file, name)?;
        let Thing::Type(item) = found.thing else {
            return None;
        };
        if let Some(unit) = &item.unit {
            return Some(unit.text.clone());
        }
        (file, name) = (found.file, &item.base);
    }
    None
}

fn place(analysis: &Analysis, span: Span) -> String {
    analysis.loaded.sources.place(span)
}
