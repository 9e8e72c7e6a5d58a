//! What the user's effects say of themselves beside equations: the marks they leave, and what they are taken for.

use crate::model::{Model, listed};
use crate::names::{FileIndex, Names, nearest};
use hyde_diag::{Code, Diagnostic, Diagnostics, Span};
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
        let diagnostic = Diagnostic::error(
            Code::UnknownName,
            format!("`{}` is not a signature of an effect", mark.text),
        )
        .label(mark.span, "not known");
        let known = format!("the signatures are `{}`", all.join("`, `"));
        model.report(match nearest(&mark.text, all.iter().copied()) {
            Some(near) => diagnostic
                .help(format!("did you mean `{near}`?"))
                .note(known),
            None => diagnostic.help(known),
        });
        return;
    };
    let wrong = |span: Span, message: String, help: String| {
        Diagnostic::error(Code::BadArguments, message)
            .label(span, "the shape that defines this signature")
            .help(help)
    };
    let found = match arguments {
        [] => return,
        [only] if !of.is_empty() => only,
        _ if of.is_empty() => {
            model.report(wrong(
                mark.span,
                format!("`{}` takes no shape", mark.text),
                format!("write `{}` alone", mark.text),
            ));
            return;
        }
        _ => {
            model.report(wrong(
                mark.span,
                format!("`{}` takes one shape", mark.text),
                format!("write {of}: `{}(…)`", mark.text),
            ));
            return;
        }
    };
    let shapes = shapes(model, file, class);
    if let ExprKind::Reference(name) = &found.value.kind
        && name.as_word().is_some_and(|word| shapes.contains(&word))
    {
        return;
    }
    let help = match shapes.as_slice() {
        [] => format!("declare {of} as a `shape`"),
        shapes => format!("its shapes are {}", listed(shapes)),
    };
    let message = format!(
        "`{}` has no such shape for its signature `{}`",
        class.name.text, mark.text
    );
    model.report(wrong(found.value.span, message, help));
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
        Some((_, other)) if std::ptr::eq(other, class) => {
            Diagnostic::error(Code::WrongType, "an effect cannot be confused with itself")
                .label(name.span, "this is the effect itself")
                .help("name other effects with the same signature, or remove the line")
        }
        Some((_, other)) if other.kind == ClassKind::Effect => return,
        Some((_, other)) => Diagnostic::error(
            Code::WrongType,
            format!("`{}` is not an effect", other.name.text),
        )
        .label(name.span, "only effects can be confused with each other"),
        None => names.unknown(file, name),
    };
    diagnostics.push(diagnostic);
}
