//! [`write_values`]: values of parameters written into the text that gives them. Layout and comments stay.
//!
//! A number that stands in the file is replaced by the new one, in its unit. A value that is computed, comes from a default of
//! another file, or is shared with another part, becomes a modification in the experiment:
//!
//! ```text
//! experiment bench of Axis               experiment bench of Axis(saddle.M = 318.2 [kg])
//! ```

use crate::load::File;
use hyde_diag::{Diagnostics, Sources, Span};
use hyde_syntax::ast::{
    self, Change, Class, ClassBody, Declarator, Element, Expr, ExprKind, Item, Unary,
};
use hyde_units::{NamedUnit, significant};
use std::ops::Range;

/// Digits of a value that is written.
const DIGITS: usize = 7;

/// A parameter with its new value.
#[derive(Clone, Debug)]
pub struct NewValue {
    /// Its full name.
    pub path: String,
    /// The value, SI.
    pub si: f64,
    /// The unit to write where the file gives none.
    pub unit: NamedUnit,
    /// Where its value is given now.
    pub given: Span,
    /// Whether that place gives the value of other parameters too.
    pub shared: bool,
}

/// Writes values into the text of the user's file, for an experiment of it.
///
/// # Errors
/// Why a value cannot be written: what to write by hand.
pub fn write_values(
    file: &File,
    text: &str,
    experiment: &str,
    values: &[NewValue],
) -> Result<String, String> {
    let Some((_, tree)) = file.files.first() else {
        return Err("there is no file".to_owned());
    };
    let mut edits: Vec<(Range<usize>, String)> = Vec::new();
    let mut added: Vec<String> = Vec::new();
    for value in values {
        let given = expression(tree, value.given).filter(|_| !value.shared);
        match given.and_then(|own| Some((own.span, literal_unit(own)?))) {
            Some((span, unit)) => {
                let bytes = span.start as usize..span.end as usize;
                let unit = unit.and_then(|text| NamedUnit::parse(text).ok());
                edits.push((
                    bytes,
                    number(value.si, unit.as_ref().unwrap_or(&value.unit)),
                ));
            }
            None if value.path.contains('[') => {
                return Err(format!(
                    "`{}` is an element of an array, and a modification cannot set one: write its value by hand",
                    value.path
                ));
            }
            None => {
                let number = number(value.si, &value.unit);
                added.push(format!("{} = {number}", value.path));
            }
        }
    }
    if !added.is_empty() {
        edits.push(modification(file, text, experiment, &added)?);
    }
    edits.sort_by_key(|(bytes, _)| bytes.start);
    let mut new = text.to_owned();
    for (bytes, with) in edits.into_iter().rev() {
        if new.get(bytes.clone()).is_none() {
            return Err("the text is not the one that was compiled".to_owned());
        }
        new.replace_range(bytes, &with);
    }
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let id = sources.add("", new.as_str());
    hyde_syntax::parse(&sources, id, &mut diagnostics);
    match diagnostics.has_errors() {
        true => Err("the new text would have a syntax error; this is a defect of Hyde".to_owned()),
        false => Ok(new),
    }
}

/// `318.2 [kg]`
fn number(si: f64, unit: &NamedUnit) -> String {
    let number = significant(unit.unit().from_si(si), DIGITS);
    match unit.text() {
        "" | "1" => number,
        text => format!("{number} [{text}]"),
    }
}

/// The unit of a literal as it is written; nothing where it is not a literal.
fn literal_unit(expr: &Expr) -> Option<Option<&str>> {
    if let ExprKind::Number(_, unit) = &expr.kind {
        return Some(unit.as_ref().map(|unit| unit.text.as_str()));
    }
    if let ExprKind::Unary(Unary::Negative | Unary::Positive, inner) = &expr.kind {
        return literal_unit(inner);
    }
    None
}

/// Modifications put behind the model of an experiment, before those that are there.
fn modification(
    file: &File,
    text: &str,
    experiment: &str,
    added: &[String],
) -> Result<(Range<usize>, String), String> {
    let mut experiments = file.experiments();
    let own = experiments.find(|own| own.name.text == experiment);
    let own = own.ok_or_else(|| format!("the file has no experiment `{experiment}`"))?;
    let list = added.join(", ");
    let at = own.model.span.end as usize;
    let rest = text.get(at..).unwrap_or_default();
    let blanks = rest.len() - rest.trim_start().len();
    Ok(match own.changes.is_empty() {
        true => (at..at, format!("({list})")),
        false => {
            let inner = at + blanks + 1;
            (inner..inner, format!("{list}, "))
        }
    })
}

/// The expression that gives the value at a place: the name of a declaration, or the target of a modification.
fn expression(tree: &ast::File, place: Span) -> Option<&Expr> {
    tree.items.iter().find_map(|item| match item {
        Item::Class(class) => in_class(class, place),
        Item::Experiment(experiment) => in_changes(&experiment.changes, place),
        Item::Type(_) | Item::Study(_) => None,
    })
}

fn in_class(class: &Class, place: Span) -> Option<&Expr> {
    match &class.body {
        ClassBody::Long { elements, .. } => in_elements(elements, place),
        ClassBody::Short {
            changes, effects, ..
        } => {
            let mut all = effects.iter();
            in_changes(changes, place)
                .or_else(|| all.find_map(|used| in_changes(&used.changes, place)))
        }
    }
}

fn in_elements(elements: &[Element], place: Span) -> Option<&Expr> {
    elements.iter().find_map(|element| match element {
        Element::Declaration(own) => {
            let mut all = own.declarators.iter();
            all.find_map(|declarator| in_declarator(declarator, place))
        }
        Element::Extends(_, changes) | Element::Replace(_, _, changes) => {
            in_changes(changes, place)
        }
        Element::Clocked(clocked) => in_elements(&clocked.elements, place),
        Element::Domain(_)
        | Element::Discretize(_)
        | Element::Modes(_)
        | Element::Equation(_)
        | Element::InitialEquation(_)
        | Element::Wrap(..)
        | Element::Add(_)
        | Element::Signature(_)
        | Element::Confounds(_)
        | Element::Measure(_)
        | Element::Account(..) => None,
    })
}

fn in_declarator(declarator: &Declarator, place: Span) -> Option<&Expr> {
    match declarator.name.span == place {
        true => declarator.binding.as_ref(),
        false => in_changes(&declarator.changes, place),
    }
}

fn in_changes(changes: &[Change], place: Span) -> Option<&Expr> {
    changes.iter().find_map(|change| {
        let own = change
            .value
            .as_ref()
            .filter(|_| change.target.span == place);
        own.or_else(|| in_changes(&change.changes, place))
    })
}
