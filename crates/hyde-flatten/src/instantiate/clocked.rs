//! Clocked parts: instances whose variables belong to a clock.

use super::collect::Collected;
use super::modification::modifiers_for;
use crate::instance::{Instance, InstanceId, Member};
use crate::model::Model;
use crate::refusals::instantiate as refused;
use hyde_ir::flat;
use hyde_syntax::ast;

/// Makes the instance of a clocked part, without members yet; gives what is written in it.
pub(super) fn declare_clocked<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    item: &Collected<'a>,
    clocked: &'a ast::Clocked,
) -> Option<(InstanceId, Vec<Collected<'a>>)> {
    let name = clocked.name.text.as_str();
    if model.clock_of(id).is_some() {
        model.report(refused::clocked_in_clocked(clocked.name.span));
        return None;
    }
    let origin = model.tree.origin(id, clocked.name.span);
    let nothing = model.flat.exprs.constant(0.0);
    let path = model.tree.path(id).child(name);
    let clock = model.flat.clocks.push(flat::Clock {
        name: path.as_str().to_owned(),
        period: nothing,
        delay: nothing,
        phase: nothing,
        origin,
    });
    let part = model.tree.push(Instance {
        path,
        file: item.file,
        class: model.tree[id].class,
        parent: Some(id),
        outer: Some(id),
        clock: Some(clock),
        members: std::collections::BTreeMap::new(),
        elements: Vec::new(),
        span: clocked.name.span,
    });
    model.tree.name(id, name, Member::Instance(part));
    let modifiers = modifiers_for(model, (name, false), &item.modifiers);
    let collected: Vec<Collected<'a>> = clocked
        .elements
        .iter()
        .map(|element| Collected {
            element,
            file: item.file,
            modifiers: modifiers.clone(),
        })
        .collect();
    Some((part, collected))
}
