//! What the user's effects say of themselves beside equations: the marks they leave, and what they are taken for.

use crate::model::Model;
use crate::names::{FileIndex, Names};
use crate::refusals::effects as refused;
use hyde_diag::Diagnostics;
use hyde_syntax::ast::{
    Argument, Class, ClassBody, ClassKind, Element, ExprKind, Name, Prefix, Reference,
};

/// The marks that an effect can leave in measurements, with what stands in parentheses behind each.
pub(crate) const MARKS: [(&str, &str); 12] = [
    ("velocity", ""),
    ("acceleration", ""),
    ("direction", ""),
    ("reversal", ""),
    ("offset", ""),
    ("position", "a period or a position"),
    ("angle", "a number per turn"),
    ("resonance", "a frequency"),
    ("time", "a time"),
    ("current", ""),
    ("torque", ""),
    ("delay", ""),
];

/// Checks the words of the effects in the user's file, whether they are used or not.
pub(crate) fn check_effect_words(model: &mut Model<'_, '_>) {
    for (file, _, class) in model.names.effects() {
        let ClassBody::Long { elements, .. } = &class.body else {
            continue;
        };
        if file != 0 {
            continue;
        }
        for element in elements {
            match element {
                Element::Signature(marks) => {
                    for (mark, arguments) in marks {
                        check_mark(model, file, class, mark, arguments);
                    }
                }
                Element::Confounds(names) => {
                    for name in names {
                        check_confounded(model.names, model.diagnostics, file, class, name);
                    }
                }
                Element::Extends(..)
                | Element::Declaration(_)
                | Element::Domain(_)
                | Element::Discretize(_)
                | Element::Modes(_)
                | Element::Clocked(_)
                | Element::Equation(_)
                | Element::InitialEquation(_)
                | Element::Wrap(..)
                | Element::Add(_)
                | Element::Replace(..)
                | Element::Measure(_)
                | Element::Account(..) => {}
            }
        }
    }
}

/// `angle(N)`: a mark that there is, of a shape of the effect.
fn check_mark<'a>(
    model: &mut Model<'a, '_>,
    file: FileIndex,
    class: &'a Class,
    mark: &Name,
    arguments: &'a [Argument],
) {
    let all: Vec<&str> = MARKS.iter().map(|(name, _)| *name).collect();
    let Some((_, of)) = MARKS.iter().find(|(name, _)| *name == mark.text) else {
        model.report(refused::no_signature(mark, &all));
        return;
    };
    let found = match arguments {
        [] => return,
        [only] if !of.is_empty() => only,
        _ if of.is_empty() => {
            model.report(refused::signature_takes_no_shape(mark));
            return;
        }
        _ => {
            model.report(refused::signature_takes_one_shape(mark, of));
            return;
        }
    };
    let shapes = shapes(model, file, class);
    if let ExprKind::Reference(name) = &found.value.kind
        && name.as_word().is_some_and(|word| shapes.contains(&word))
    {
        return;
    }
    let names = (class.name.text.as_str(), mark.text.as_str());
    model.report(refused::no_such_shape(names, found.value.span, of, &shapes));
}

/// The names of the shapes of an effect and of what it extends.
fn shapes<'a>(model: &Model<'a, '_>, file: FileIndex, class: &'a Class) -> Vec<&'a str> {
    let (mut waiting, mut seen) = (vec![(file, class)], Vec::<&'a Class>::new());
    let mut found = Vec::new();
    while let Some((file, class)) = waiting.pop() {
        if seen.iter().any(|&known| std::ptr::eq(known, class)) {
            continue;
        }
        seen.push(class);
        let ClassBody::Long { elements, .. } = &class.body else {
            continue;
        };
        for element in elements {
            if let Element::Declaration(declaration) = element
                && declaration.prefixes.contains(&Prefix::Shape)
            {
                let names = declaration.declarators.iter();
                found.extend(names.map(|declarator| declarator.name.text.as_str()));
            }
            if let Element::Extends(base, _) = element {
                waiting.extend(model.names.class(file, base));
            }
        }
    }
    found
}

/// `confounds Stribeck`: another effect that there is.
fn check_confounded(
    names: Names<'_>,
    diagnostics: &mut Diagnostics,
    file: FileIndex,
    class: &Class,
    name: &Reference,
) {
    let found = names.class(file, name);
    let diagnostic = match found {
        Some((_, other)) if std::ptr::eq(other, class) => refused::confused_with_itself(name.span),
        Some((_, other)) if other.kind == ClassKind::Effect => return,
        Some((_, other)) => refused::confused_with_no_effect(&other.name.text, name.span),
        None => names.unknown(file, name),
    };
    diagnostics.push(diagnostic);
}
