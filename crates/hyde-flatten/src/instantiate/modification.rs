//! Modifications: each as a single change with the scope its value stands in, and what of them nothing used.

use crate::instance::{Binding, InstanceId, Position};
use crate::model::Model;
use crate::refusals::instantiate as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{Change, Declarator, Expr, ExprKind};

/// A word of the way to what is modified.
#[derive(Clone, Copy, PartialEq)]
pub(super) struct Word<'a> {
    pub(super) name: &'a str,
    /// The component meant, of an array of them, from 1.
    component: Option<Number>,
}

/// A number in brackets, and where it stands.
#[derive(Clone, Copy)]
struct Number {
    value: usize,
    span: Span,
}

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

/// The model that `redeclare` chooses, where its name stands, and how many words of the way are behind its component.
#[derive(Clone, Copy)]
struct Chosen {
    model: Span,
    behind: usize,
}

/// A modification of something below an instance, with the scope its value stands in.
#[derive(Clone)]
pub(super) struct Modifier<'a> {
    target: Vec<Word<'a>>,
    /// The only component for which it is, of the array of them that its way has come to.
    component: Option<Number>,
    pub(super) change: &'a Change,
    pub(super) scope: InstanceId,
    /// Given by the experiment, so that it can read the records' columns.
    pub(super) records: bool,
    /// The elements of arrays of components that it came to, the outermost first.
    pub(super) elements: Vec<Position>,
    /// For how many arrays of components on its way it holds whole: once for each `each`.
    pub(super) each: usize,
    /// The models that it goes with: it stands in the brackets behind them.
    with: Vec<Chosen>,
    /// Index into the model's list of modifications, to tell which were used.
    pub(super) number: usize,
}

impl<'a> Modifier<'a> {
    /// Whether it is of the value or the model of what its way has come to.
    pub(super) fn is_of_itself(&self) -> bool {
        self.target.is_empty()
    }

    /// Whether another modification gives the same another value or model.
    fn is_again(&self, other: &Self) -> bool {
        let both = |gives: fn(&Change) -> bool| gives(self.change) && gives(other.change);
        self.target == other.target
            && (both(|change| change.value.is_some()) || both(|change| change.redeclare.is_some()))
    }

    /// The word that is left of its way, if it is one.
    fn last_word(&self) -> Option<&'a str> {
        match self.target.as_slice() {
            [word] => Some(word.name),
            _ => None,
        }
    }

    /// The modification as it is for one component of an array of them; `None` if it is for another.
    pub(super) fn of_component(&self, position: Position) -> Option<Self> {
        let mut own = self.clone();
        match own.component.take() {
            Some(number) => return (number.value == position.at + 1).then_some(own),
            None if own.each > 0 => own.each -= 1,
            None => own.elements.push(position),
        }
        Some(own)
    }
}

/// The modifications of `name`, which is no array of components but may be one of values, with it taken off their targets.
pub(super) fn modifiers_for<'a>(
    model: &mut Model<'a, '_>,
    (name, is_array): (&str, bool),
    modifiers: &[Modifier<'a>],
) -> Vec<Modifier<'a>> {
    let mut found = modifiers_for_components(model, name, modifiers);
    found.retain(|modifier| {
        let Some(number) = modifier.component else {
            return true;
        };
        let way: Vec<&str> = modifier.target.iter().map(|word| word.name).collect();
        model.report(match is_array {
            true => refused::modifies_one_element((name, number.span), &way),
            false => refused::element_of_no_array((name, number.span), &way),
        });
        model.making.modifications[modifier.number].2 = true;
        false
    });
    found
}

/// The modifications of `name`, with it taken off their targets.
pub(super) fn modifiers_for_components<'a>(
    model: &mut Model<'a, '_>,
    name: &str,
    modifiers: &[Modifier<'a>],
) -> Vec<Modifier<'a>> {
    let mut found = Vec::new();
    for modifier in modifiers {
        let Some((first, rest)) = modifier.target.split_first() else {
            continue;
        };
        if first.name != name {
            continue;
        }
        if rest.is_empty() {
            model.making.modifications[modifier.number].2 = true;
        }
        found.push(Modifier {
            target: rest.to_vec(),
            component: first.component,
            ..modifier.clone()
        });
    }
    found
}

/// Reports modifications of components that an array of them does not have.
pub(super) fn check_components(
    model: &mut Model<'_, '_>,
    count: usize,
    modifiers: &[Modifier<'_>],
) {
    let mut numbers: Vec<Number> = modifiers.iter().filter_map(|m| m.component).collect();
    numbers.retain(|number| number.value == 0 || number.value > count);
    for number in numbers {
        model.report(refused::modifies_no_component(count, number.span));
    }
}

/// Drops the modifications of a component that go with a model which another redeclaration of it has replaced: `d.c = 4` of
/// `redeclare Quad d(c = 4)` where `d` has become a `Lin`.
pub(super) fn drop_replaced(
    model: &mut Model<'_, '_>,
    chosen: Option<Span>,
    modifiers: &mut Vec<Modifier<'_>>,
) {
    modifiers.retain(|modifier| {
        let words = modifier.target.len();
        let mut own = modifier.with.iter().filter(|with| with.behind == words);
        let stays = own.all(|with| Some(with.model) == chosen);
        if !stays {
            model.making.modifications[modifier.number].2 = true;
        }
        stays
    });
}

/// Marks the modifications of an array of components that has none: there is nothing that they could change.
pub(super) fn of_no_component(model: &mut Model<'_, '_>, modifiers: &[Modifier<'_>]) {
    for modifier in modifiers {
        model.making.modifications[modifier.number].2 = true;
    }
}

/// Nested changes as a list of single ones. Those of one component of an array come before those of all.
pub(super) fn modifiers_of<'a>(
    model: &mut Model<'a, '_>,
    changes: &'a [Change],
    scope: InstanceId,
    out: &mut Vec<Modifier<'a>>,
) {
    let mut own = Vec::new();
    let outermost = Way {
        words: Vec::new(),
        each: 0,
        with: Vec::new(),
    };
    modifiers_below(model, changes, scope, &outermost, &mut own);
    let of_all = |modifier: &Modifier<'_>| {
        let mut words = modifier.target.iter();
        words.all(|word| word.component.is_none())
    };
    own.sort_by_key(of_all);
    for (number, modifier) in own.iter().enumerate() {
        if let Some(first) = own[..number].iter().find(|first| first.is_again(modifier)) {
            let (here, there) = (&modifier.change.target, first.change.target.span);
            model.report(refused::modified_twice(here, there));
        }
    }
    out.extend(own);
}

/// The words around nested changes, how many `each` and which chosen models are among them; the models with the number of
/// words up to their component.
struct Way<'a> {
    words: Vec<Word<'a>>,
    each: usize,
    with: Vec<(Span, usize)>,
}

fn modifiers_below<'a>(
    model: &mut Model<'a, '_>,
    changes: &'a [Change],
    scope: InstanceId,
    above: &Way<'a>,
    out: &mut Vec<Modifier<'a>>,
) {
    for change in changes {
        let Some(target) = way(model, &above.words, change) else {
            continue;
        };
        let each = above.each + usize::from(change.each);
        let mut inner = Way {
            words: target.clone(),
            each,
            with: above.with.clone(),
        };
        if let Some(chosen) = &change.redeclare {
            inner.with.push((chosen.span, target.len()));
        }
        modifiers_below(model, &change.changes, scope, &inner, out);
        if change.redeclare.is_some()
            || change.value.is_some()
            || change.prior.is_some()
            || change.source.is_some()
        {
            let number = model.making.modifications.len();
            let names: Vec<&str> = target.iter().map(|word| word.name).collect();
            model
                .making
                .modifications
                .push((change.target.span, names.join("."), false));
            let chosen = |&(model, words): &(Span, usize)| Chosen {
                model,
                behind: target.len() - words,
            };
            out.push(Modifier {
                with: above.with.iter().map(chosen).collect(),
                target,
                component: None,
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

/// The way to what a change is of; `None` if it is refused.
fn way<'a>(
    model: &mut Model<'a, '_>,
    above: &[Word<'a>],
    change: &'a Change,
) -> Option<Vec<Word<'a>>> {
    let mut target = above.to_vec();
    for part in &change.target.parts {
        let component = match part.subscripts.as_slice() {
            [] => None,
            [subscript] => {
                if let Some(chosen) = &change.redeclare {
                    model.report(refused::chooses_for_one(&change.target, chosen));
                    return None;
                }
                let Some(value) = whole_number(subscript) else {
                    model.report(refused::component_without_number(subscript.span));
                    return None;
                };
                Some(Number {
                    value,
                    span: change.target.span,
                })
            }
            [_, second, ..] => {
                model.report(refused::component_without_number(second.span));
                return None;
            }
        };
        target.push(Word {
            name: part.name.text.as_str(),
            component,
        });
    }
    Some(target)
}

fn whole_number(subscript: &Expr) -> Option<usize> {
    if let ExprKind::Number(value, None) = subscript.kind
        && value.fract() == 0.0
        && (0.0..=1e9).contains(&value)
    {
        Some(value as usize)
    } else {
        None
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
        .filter(|modifier| modifier.last_word().is_some());
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
        .find(|modifier| modifier.is_of_itself() && modifier.change.value.is_some());
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
        .find(|modifier| modifier.last_word() == Some(word) && modifier.change.value.is_some());
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
        let attribute = modifier
            .last_word()
            .is_some_and(|word| known.contains(&word));
        if attribute || modifier.is_of_itself() {
            model.making.modifications[modifier.number].2 = true;
        }
    }
    for (number, change) in declarator.changes.iter().enumerate() {
        let word = change.target.as_word();
        let mut before = declarator.changes[..number].iter();
        if let Some(first) = before.find(|first| first.target.as_word() == word) {
            model.report(refused::modified_twice(&change.target, first.target.span));
        }
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
