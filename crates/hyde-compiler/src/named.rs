//! The packages, the types and the tables' files that a source file names.

use hyde_diag::Span;
use hyde_syntax::ast::{self, ClassBody, Element, Expr, ExprKind, Item, Prefix, Reference};

/// The packages of imports and of dotted types, each with where it is named first.
pub(crate) fn packages_named(file: &ast::File) -> Vec<(String, Span)> {
    let mut found: Vec<(String, Span)> = Vec::new();
    let mut named = |package: String, span: Span| {
        if !package.is_empty() && found.iter().all(|(known, _)| *known != package) {
            found.push((package, span));
        }
    };
    for import in &file.imports {
        let package = if import.everything {
            import.path.dotted()
        } else {
            package_of(&import.path)
        };
        named(package, import.path.span);
    }
    each_type(file, &mut |reference, _| {
        named(package_of(reference), reference.span)
    });
    found
}

/// What a name can only be, by where it stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sought {
    /// A model or a quantity.
    Either,
    /// A model: its parts are modified.
    Model,
    /// A quantity, such as that of a parameter.
    Quantity,
}

impl Sought {
    /// Whether a model, or else a quantity, is what is sought.
    pub(crate) fn takes(self, model: bool) -> bool {
        match self {
            Self::Either => true,
            Self::Model => model,
            Self::Quantity => !model,
        }
    }
}

/// The types, models and effects that are named without a package, and what each can only be.
pub(crate) fn words_named(file: &ast::File) -> Vec<(&str, Sought)> {
    let mut found = Vec::new();
    each_type(file, &mut |reference, sought| {
        found.extend(reference.as_word().map(|word| (word, sought)));
    });
    found
}

/// The files of tables, `table(x, "grease.csv")`, each with where it is named first.
pub(crate) fn tables_named(file: &ast::File) -> Vec<(String, Span)> {
    let mut found: Vec<(String, Span)> = Vec::new();
    file.each_expression(&mut |expr| in_expression(expr, &mut found));
    found
}

fn in_expression(expr: &Expr, found: &mut Vec<(String, Span)>) {
    if let ExprKind::Call(function, arguments) = &expr.kind
        && matches!(function.as_word(), Some("table" | "smooth_table"))
        && let Some(argument) = arguments.get(1)
        && let ExprKind::String(path) = &argument.value.kind
        && found.iter().all(|(known, _)| known != path)
    {
        found.push((path.clone(), argument.value.span));
    }
    for child in expr.children() {
        in_expression(child, found);
    }
}

/// What stands before the last dot.
fn package_of(reference: &Reference) -> String {
    let dotted = reference.dotted();
    dotted
        .rsplit_once('.')
        .map_or_else(String::new, |(package, _)| package.to_owned())
}

fn each_type<'a>(file: &'a ast::File, add: &mut impl FnMut(&'a Reference, Sought)) {
    for item in &file.items {
        match item {
            Item::Class(class) => match &class.body {
                ClassBody::Short { base, effects, .. } => {
                    add(base, Sought::Either);
                    let effects = effects.iter();
                    effects.for_each(|used| add(&used.effect, Sought::Either));
                }
                ClassBody::Long { elements, .. } => types_named(elements, add),
            },
            Item::Experiment(experiment) => add(&experiment.model, Sought::Model),
            Item::Type(item) => add(&item.base, Sought::Quantity),
            Item::Study(_) => {}
        }
    }
}

fn types_named<'a>(elements: &'a [Element], add: &mut impl FnMut(&'a Reference, Sought)) {
    for element in elements {
        match element {
            Element::Declaration(declaration) => {
                add(&declaration.type_name, sought(declaration));
            }
            Element::Extends(base, _) => add(base, Sought::Either),
            Element::Clocked(clocked) => types_named(&clocked.elements, add),
            Element::Replace(_, by, _) => add(by, Sought::Either),
            Element::Measure(measure) | Element::Account(_, measure) => {
                add(&measure.type_name, Sought::Quantity);
            }
            Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Signature(_) => {}
            // Effects of other packages are named whole; alone, a name is that of one beside it.
            Element::Confounds(names) => {
                let dotted = names.iter().filter(|name| name.as_word().is_none());
                dotted.for_each(|name| add(name, Sought::Either));
            }
        }
    }
}

fn sought(declaration: &ast::Declaration) -> Sought {
    let is_parameter = |prefix: &Prefix| matches!(prefix, Prefix::Parameter | Prefix::Constant);
    let mut declarators = declaration.declarators.iter();
    if declaration.prefixes.iter().any(is_parameter) {
        Sought::Quantity
    } else if declarators.any(|item| item.is_modified()) {
        Sought::Model
    } else {
        Sought::Either
    }
}
