//! Modifications: each as a single change with the scope its value stands in, and what of them nothing used.

use crate::instance::{Binding, InstanceId, Position};
use crate::model::Model;
use crate::refusals::instantiate as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{Change, Declarator, ExprKind};

/// A modification of something below an instance, with the scope its value stands in.
#[derive(Clone)]
pub(super) struct Modifier<'a> {
    pub(super) target: Vec<&'a str>,
    pub(super) change: &'a Change,
    pub(super) scope: InstanceId,
    /// Given by the experiment, so that it can read the records' columns.
    pub(super) records: bool,
    /// The elements of arrays of components that it came to, the outermost first.
    pub(super) elements: Vec<Position>,
    /// For how many arrays of components on its way it holds whole: once for each `each`.
    pub(super) each: usize,
    /// Index into the model's list of modifications, to tell which were used.
    pub(super) number: usize,
}

/// The modifications of `name`, with it taken off their targets.
pub(super) fn modifiers_for<'a>(
    model: &mut Model<'a, '_>,
    name: &str,
    modifiers: &[Modifier<'a>],
) -> Vec<Modifier<'a>> {
    let mut found = Vec::new();
    for modifier in modifiers
        .iter()
        .filter(|modifier| modifier.target.first() == Some(&name))
    {
        let mut inner = modifier.clone();
        inner.target.remove(0);
        if inner.target.is_empty() {
            model.making.modifications[inner.number].2 = true;
        }
        found.push(inner);
    }
    found
}

/// Nested changes as a list of single ones.
pub(super) fn modifiers_of<'a>(
    model: &mut Model<'a, '_>,
    changes: &'a [Change],
    scope: InstanceId,
    out: &mut Vec<Modifier<'a>>,
) {
    modifiers_below(model, changes, scope, (&[], 0), out);
}

fn modifiers_below<'a>(
    model: &mut Model<'a, '_>,
    changes: &'a [Change],
    scope: InstanceId,
    (above, each): (&[&'a str], usize),
    out: &mut Vec<Modifier<'a>>,
) {
    for change in changes {
        let mut parts = change.target.parts.iter();
        if parts.any(|part| !part.subscripts.is_empty()) {
            let inner = change.changes.first().map(|inner| &inner.target);
            let chosen = change.redeclare.as_ref();
            model.report(refused::modifies_one_element(&change.target, inner, chosen));
            continue;
        }
        let mut target = above.to_vec();
        target.extend(
            change
                .target
                .parts
                .iter()
                .map(|part| part.name.text.as_str()),
        );
        let each = each + usize::from(change.each);
        modifiers_below(model, &change.changes, scope, (&target, each), out);
        if change.redeclare.is_some()
            || change.value.is_some()
            || change.prior.is_some()
            || change.source.is_some()
        {
            let number = model.making.modifications.len();
            model
                .making
                .modifications
                .push((change.target.span, target.join("."), false));
            out.push(Modifier {
                target,
                change,
                scope,
                records: false,
                elements: Vec::new(),
                each,
                number,
            });
        }
    }
}

/// Notes the instance that the last words of modifications are looked up in.
pub(super) fn note_modified<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    modifiers: &[Modifier<'a>],
) {
    let last_words = modifiers
        .iter()
        .filter(|modifier| modifier.target.len() == 1);
    model
        .making
        .modified
        .extend(last_words.map(|modifier| (modifier.number, id)));
}

pub(super) fn report_unused_modifications(model: &mut Model<'_, '_>) {
    let unused: Vec<(usize, Span, String)> = (0..)
        .zip(&model.making.modifications)
        .filter(|(_, (.., used))| !used)
        .map(|(number, (span, name, _))| (number, *span, name.clone()))
        .collect();
    for (number, span, name) in unused {
        if name.split('.').any(|word| model.undeclared.contains(word)) {
            continue;
        }
        let Some(instance) = model
            .making
            .modified
            .get(&number)
            .map(|&id| &model.tree[id])
        else {
            model.report(refused::nothing_to_modify(&name, span));
            continue;
        };
        let known: Vec<&str> = instance.members.keys().copied().collect();
        let class = &instance.class.name.text;
        model.report(refused::no_element_to_modify(&name, span, class, &known));
    }
}

/// The value of a name: the outermost modification, else the declaration.
pub(super) fn binding<'a>(
    id: InstanceId,
    declarator: &'a Declarator,
    modifiers: &[Modifier<'a>],
) -> Option<Binding<'a>> {
    let modified = modifiers
        .iter()
        .find(|modifier| modifier.target.is_empty() && modifier.change.value.is_some());
    match modified {
        Some(modifier) => {
            let expr = modifier.change.value.as_ref()?;
            Some(Binding {
                expr,
                scope: modifier.scope,
                records: modifier.records,
                elements: modifier.elements.clone(),
                span: modifier.change.target.span,
            })
        }
        None => {
            let expr = declarator.binding.as_ref()?;
            Some(Binding {
                expr,
                scope: id,
                records: false,
                elements: Vec::new(),
                span: declarator.name.span,
            })
        }
    }
}

/// `start`, `fixed` or `state` of a variable: the outermost modification, else the declaration.
pub(super) fn attribute<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    declarator: &'a Declarator,
    modifiers: &[Modifier<'a>],
    word: &str,
) -> Option<Binding<'a>> {
    let modified = modifiers
        .iter()
        .find(|modifier| modifier.target == [word] && modifier.change.value.is_some());
    if let Some(modifier) = modified {
        model.making.modifications[modifier.number].2 = true;
        let expr = modifier.change.value.as_ref()?;
        return Some(Binding {
            expr,
            scope: modifier.scope,
            records: modifier.records,
            elements: modifier.elements.clone(),
            span: expr.span,
        });
    }
    let change = declarator
        .changes
        .iter()
        .find(|change| change.target.as_word() == Some(word))?;
    let expr = change.value.as_ref()?;
    Some(Binding {
        expr,
        scope: id,
        records: false,
        elements: Vec::new(),
        span: expr.span,
    })
}

/// The bounds that a quantity declares, `min` and `max`.
pub(super) fn declared_bounds<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    declarator: &'a Declarator,
    modifiers: &[Modifier<'a>],
) -> [Option<Binding<'a>>; 2] {
    ["min", "max"].map(|word| attribute(model, id, declarator, modifiers, word))
}

/// Reports attributes that are not among those that the declaration can have.
pub(super) fn check_attributes<'a>(
    model: &mut Model<'a, '_>,
    declarator: &'a Declarator,
    modifiers: &[Modifier<'a>],
    known: &[&str],
) {
    for modifier in modifiers {
        if modifier.target.is_empty()
            || matches!(modifier.target.as_slice(), [word] if known.contains(word))
        {
            model.making.modifications[modifier.number].2 = true;
        }
    }
    for change in &declarator.changes {
        let word = change.target.as_word();
        if word.is_none_or(|word| !known.contains(&word)) {
            let of = if known.contains(&"state") {
                "variable"
            } else {
                "parameter"
            };
            let text = match change.value.as_ref().map(|value| &value.kind) {
                Some(ExprKind::String(text)) => text.as_str(),
                Some(_) | None => "unit",
            };
            let instead = word.and_then(|word| hyde_syntax::instead_of_attribute(word, text));
            model.report(refused::no_attribute(&change.target, of, known, instead));
        }
    }
}
