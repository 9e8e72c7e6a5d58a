//! The energy ledger: what components say of their energy, and the connectors through which they exchange it.
//!
//! ```text
//! stored Energy kinetic = M*v^2/2;             an account: one scalar
//! stored Energy twist = integral(e, bar);      an account: one share a cell
//! connector Rail Length s; flow Force f; …     a port of the component: the power f*der(s) enters it
//! ```
//!
//! It is made only where it is asked for; the equations do not change.

use crate::dimension::Dim;
use crate::input::Input;
use crate::instance::{InstanceId, Member, Scope, Setting, Typed};
use crate::instantiate::InstanceTree;
use crate::model::Model;
use hyde_ir::flat::{Account, AccountKind, Port, PortKind};
use hyde_ir::{Expr as Ir, FlatModel, Index, Range, VarId};
use hyde_syntax::ast::{self, Binary, ClassKind, Element, Expr, ExprKind, Unary};
use hyde_units::{Agreement, Dimension};

/// Lowers the accounts of every instance.
pub(crate) fn accounts(model: &mut Model<'_, '_>) {
    if !model.input.ledger {
        return;
    }
    for id in model.tree.ids() {
        for (_, element) in model.tree[id].elements.clone() {
            if let Element::Account(kind, measure) = element {
                account(model, id, *kind, measure);
            }
        }
    }
}

fn account<'a>(
    model: &mut Model<'a, '_>,
    id: InstanceId,
    kind: ast::AccountKind,
    account: &'a ast::Measure,
) {
    let scope = Scope::new(id, Setting::Report);
    let (kind, dimension) = match kind {
        ast::AccountKind::Stored => (AccountKind::Stored, Dimension::ENERGY),
        ast::AccountKind::Dissipated => (AccountKind::Dissipated, Dimension::POWER),
        ast::AccountKind::Supplied => (AccountKind::Supplied, Dimension::POWER),
    };
    let mut terms = Vec::new();
    terms_of(&account.value, true, &mut terms);
    let mut pieces = Vec::new();
    for (term, positive) in terms {
        let Some((range, value)) = piece(model, term, &scope) else {
            continue;
        };
        let declared = Typed {
            dim: Dim::known(dimension),
            span: account.name.span,
            ..value.clone()
        };
        model.agree(&declared, &value, "the account and its value are", id);
        let value = if positive {
            value.id
        } else {
            model.flat.exprs.negative(value.id)
        };
        // What is reported makes no events.
        let value = model.flat.exprs.no_event(value);
        pieces.push((range, value));
    }
    model.flat.experiment.ledger.accounts.push(Account {
        component: model.tree[id].path.clone(),
        name: account.name.text.clone(),
        kind,
        pieces,
    });
}

/// A term: an integral over a domain, or a scalar.
fn piece<'a>(
    model: &mut Model<'a, '_>,
    term: &'a Expr,
    scope: &Scope<'a>,
) -> Option<(Range, Typed)> {
    if let ExprKind::Call(function, arguments) = &term.kind
        && function.as_word() == Some("integral")
    {
        let args: Vec<&'a Expr> = arguments.iter().map(|a| &a.value).collect();
        return model.integral(&args, scope, term.span);
    }
    Some((Range::SCALAR, model.value(term, scope)))
}

/// Finds the ports of every component. Dimensions are known by now.
pub(crate) fn ports(input: &Input<'_>, tree: &InstanceTree<'_>, flat: &mut FlatModel) {
    if !input.ledger {
        return;
    }
    for id in tree.ids() {
        let Some(parent) = tree[id].parent else {
            continue;
        };
        let is_connector = tree[id].class.kind == ClassKind::Connector;
        if !is_connector || tree[parent].parent.is_none() {
            continue;
        }
        let mut flows = Vec::new();
        let mut potentials = Vec::new();
        // In the order of declaration: the first flow belongs to the first potential.
        let mut own: Vec<VarId> = tree[id]
            .members
            .values()
            .filter_map(|member| match member {
                Member::Variable(var) => Some(*var),
                Member::Parameter(_)
                | Member::Instance(_)
                | Member::Instances(_)
                | Member::Domain(_) => None,
            })
            .collect();
        own.sort_unstable();
        for var in own {
            let variable = &flat.variables[var];
            if variable.len.is_none() && !variable.boolean {
                if variable.flow {
                    &mut flows
                } else {
                    &mut potentials
                }
                .push(var);
            }
        }
        for (&flow, &potential) in flows.iter().zip(&potentials) {
            let Some(kind) = port_kind(flat, flow, potential) else {
                continue;
            };
            let mut leaf = |var| flat.exprs.add(Ir::Var(var, Index::SCALAR));
            let (flow, potential) = (leaf(flow), leaf(potential));
            flat.experiment.ledger.ports.push(Port {
                component: tree[parent].path.clone(),
                kind,
                flow,
                potential,
            });
        }
    }
}

fn port_kind(flat: &FlatModel, flow: VarId, potential: VarId) -> Option<PortKind> {
    let dimension = |var: VarId| flat.variables[var].quantity.dimension;
    let product = dimension(flow).multiply(dimension(potential));
    let is = |a: Dimension, b: Dimension| a.agreement(b) != Agreement::Different;
    if is(product, Dimension::ENERGY) {
        Some(PortKind::Work)
    } else if is(product, Dimension::POWER) {
        Some(PortKind::Power)
    } else if is(dimension(flow), Dimension::POWER) {
        Some(PortKind::Heat)
    } else {
        None
    }
}

/// The terms of a sum with their signs.
pub(crate) fn terms_of<'a>(expr: &'a Expr, positive: bool, terms: &mut Vec<(&'a Expr, bool)>) {
    match &expr.kind {
        ExprKind::Binary(Binary::Add, a, b) => {
            terms_of(a, positive, terms);
            terms_of(b, positive, terms);
        }
        ExprKind::Binary(Binary::Sub, a, b) => {
            terms_of(a, positive, terms);
            terms_of(b, !positive, terms);
        }
        ExprKind::Unary(Unary::Negative, inner) => terms_of(inner, !positive, terms),
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => terms.push((expr, positive)),
    }
}
