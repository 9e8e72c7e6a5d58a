//! A declarator: its name, which must be free, and its length.

use crate::instance::{InstanceId, Member};
use crate::model::Model;
use crate::refusals::instantiate as refused;
use hyde_syntax::ast::{Declaration, Declarator, Expr};

/// Whether nothing has its name yet; reported if something has.
pub(super) fn free_name<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    declarator: &'a Declarator,
) -> bool {
    let name = declarator.name.text.as_str();
    let Some(member) = model.tree[id].members.get(name) else {
        return true;
    };
    let first = match member {
        Member::Variable(var) => Some(model.flat.variables[*var].origin.span),
        Member::Parameter(param) => Some(model.flat.parameters[*param].origin.span),
        Member::Instance(part) => Some(model.tree[*part].span),
        Member::Instances(parts) => parts.first().map(|part| model.tree[*part].span),
        Member::Domain(domain) => Some(model.domains[*domain].span),
    };
    model.report(refused::declared_twice(&declarator.name, first));
    false
}

/// Whether the type or the name has dimensions.
pub(super) fn is_array(declaration: &Declaration, declarator: &Declarator) -> bool {
    !declaration.dims.is_empty() || !declarator.dims.is_empty()
}

/// The length that dimensions after the type or the name give.
pub(super) fn length<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    of_type: &'a [Expr],
    of_name: &'a [Expr],
) -> Option<usize> {
    let dims: Vec<&'a Expr> = of_name.iter().chain(of_type).collect();
    match dims.as_slice() {
        [] => None,
        [dim] => {
            let Some(length) = model.structural_integer(id, dim) else {
                return Some(0); // Reported; no element is looked for in it.
            };
            if !(0..=100_000_000).contains(&length) {
                model.report(refused::bad_length(length, dim.span));
                return Some(0);
            }
            usize::try_from(length).ok()
        }
        [_, second, ..] => {
            model.report(refused::second_dimension(second.span));
            None
        }
    }
}
