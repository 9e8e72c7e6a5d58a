//! Components: an instance or an array of them, of the declared or the redeclared model.

use super::collect::Collected;
use super::declarator::length;
use super::effect::replaced;
use super::modification::{
    Modifier, check_components, drop_replaced, modifiers_for, modifiers_for_components,
    modifiers_of, of_no_component,
};
use super::{Place, instantiate};
use crate::instance::{InstanceId, Member, Position};
use crate::model::Model;
use crate::names::{FileIndex, Names};
use crate::refusals::instantiate as refused;
use hyde_diag::{Diagnostics, InstancePath, Span};
use hyde_syntax::ast::{Class, ClassKind, Declaration, Declarator, Prefix};

pub(super) fn declare_component<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    item: &Collected<'a>,
    declaration: &'a Declaration,
    declarator: &'a Declarator,
    file: FileIndex,
    class: &'a Class,
) {
    if class.kind == ClassKind::Effect {
        model.report(refused::effect_as_component(
            &class.name.text,
            declaration.type_name.span,
        ));
        return;
    }
    if let Some(binding) = &declarator.binding {
        model.report(refused::component_with_value(
            &declarator.name.text,
            binding.span,
        ));
    }
    let count = length(model, id, &declaration.dims, &declarator.dims);
    let name = declarator.name.text.as_str();
    let mut inner = match count {
        Some(count) => {
            let inner = modifiers_for_components(model, name, &item.modifiers);
            check_components(model, count, &inner);
            inner
        }
        None => modifiers_for(model, (name, false), &item.modifiers),
    };
    modifiers_of(model, &declarator.changes, id, &mut inner);
    let by_effect = replaced(model, id, declaration, declarator, &mut inner);
    let class = by_effect.unwrap_or((file, class));
    let Some(((file, class), chosen)) = redeclared(
        model.names,
        model.diagnostics,
        declaration,
        declarator,
        &inner,
        class,
    ) else {
        model.undeclared.insert(name);
        return;
    };
    drop_replaced(model, chosen, &mut inner);
    let (path, clock) = (model.tree.path(id), model.clock_of(id));
    let place = |path: InstancePath| Place {
        path,
        parent: Some(id),
        clock,
        span: declarator.name.span,
    };
    match count {
        None => {
            let part = instantiate(model, file, class, inner, place(path.child(name)));
            model.tree.name(id, name, Member::Instance(part));
        }
        Some(count) => {
            if count == 0 {
                of_no_component(model, &inner);
            }
            let mut parts = Vec::new();
            for index in 0..count {
                let position = Position {
                    at: index,
                    of: count,
                };
                let own = inner.iter().filter_map(|m| m.of_component(position));
                let own = own.collect();
                let child = path.child(&format!("{name}[{}]", index + 1));
                parts.push(instantiate(model, file, class, own, place(child)));
            }
            model.tree.name(id, name, Member::Instances(parts.into()));
        }
    }
}

/// The class of a component: that of the outermost redeclaration, if there is one, with the place of its name there.
fn redeclared<'a>(
    names: Names<'a>,
    diagnostics: &mut Diagnostics,
    declaration: &Declaration,
    declarator: &Declarator,
    modifiers: &[Modifier<'a>],
    declared: (FileIndex, &'a Class),
) -> Option<((FileIndex, &'a Class), Option<Span>)> {
    let redeclaration = modifiers.iter().find_map(|modifier| {
        let new = modifier.change.redeclare.as_ref()?;
        modifier.is_of_itself().then_some((modifier, new))
    });
    let Some((modifier, new)) = redeclaration else {
        return Some((declared, None));
    };
    if !declaration.prefixes.contains(&Prefix::Replaceable) {
        let here = modifier.change.target.span;
        let class = &declared.1.name.text;
        diagnostics.push(refused::cannot_redeclare(here, &declarator.name, class));
        return None;
    }
    let file = names.file_of(new.span)?;
    let class = names.class(file, new);
    if class.is_none() {
        let diagnostic = names.unknown(file, new);
        diagnostics.push(diagnostic);
    }
    Some((class?, Some(new.span)))
}
