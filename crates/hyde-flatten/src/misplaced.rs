//! Continuous variables that a clocked part computes, as programs would: told once, at the equation, and no more where they
//! are read.
//!
//! ```text
//! Velocity e;                              e is continuous, for it is declared outside
//! clocked control(1 [ms])
//!   e = 1 [m/s] - sample(v);               told here
//! end control;
//! der(v) = 10 [1/s]*hold(e);               nothing more to tell
//! ```

use crate::instance::{InstanceId, Member};
use crate::instantiate::InstanceTree;
use crate::model::Model;
use crate::refusals::equations as refused;
use hyde_ir::{VarId, VariableKind};
use hyde_syntax::ast::{Element, EquationKind, ExprKind, Reference};

/// Finds and tells them.
pub(crate) fn find_misplaced(model: &mut Model<'_, '_>) {
    for id in model.tree.ids() {
        if model.clock_of(id).is_none() {
            continue;
        }
        for (_, element) in model.tree[id].elements.clone() {
            let (Element::Equation(equation) | Element::Add(equation)) = element else {
                continue;
            };
            let EquationKind::Equality { lhs, .. } = &equation.kind else {
                continue;
            };
            let ExprKind::Reference(name) = &lhs.kind else {
                continue;
            };
            let Some(var) = variable_of(&model.tree, id, name) else {
                continue;
            };
            if model.flat.variables[var].kind == VariableKind::Continuous {
                let part = model.tree.path(id);
                let part = part.as_str().rsplit('.').next().unwrap_or_default();
                let told = refused::computed_in_clocked(name, part);
                model.report(told);
                model.misplaced.insert(var);
            }
        }
    }
}

/// The variable that a name means in an instance, if that can be told without a word.
fn variable_of(tree: &InstanceTree<'_>, id: InstanceId, name: &Reference) -> Option<VarId> {
    let mut parts = name.parts.iter().map(|part| part.name.text.as_str());
    let first = parts.next()?;
    let mut scopes = std::iter::successors(Some(id), |&at| tree[at].outer);
    let mut member = scopes.find_map(|at| tree[at].members.get(first))?;
    for part in parts {
        let Member::Instance(inner) = member else {
            return None;
        };
        member = tree[*inner].members.get(part)?;
    }
    match member {
        Member::Variable(var) => Some(*var),
        Member::Parameter(_) | Member::Instance(_) | Member::Instances(_) | Member::Domain(_) => {
            None
        }
    }
}
