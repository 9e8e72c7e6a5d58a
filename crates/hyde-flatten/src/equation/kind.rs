//! An equation by its kind: an equality, or what stands among equations.

use super::branch::if_equation;
use super::event::when;
use super::range::for_equation;
use super::unroll::can_unroll;
use crate::allowed::check_whole;
use crate::connect::connection;
use crate::instance::{Counter, Elementwise, Position, Scope, Setting};
use crate::model::Model;
use crate::refusals::equations as refused;
use crate::zero;
use hyde_diag::Span;
use hyde_ir::Range;
use hyde_ir::flat::{Assert, Equation};
use hyde_syntax::ast::{self, EquationKind, Expr, ExprKind};

/// Lowers an equation or what stands among equations; connections, events and asserts go where they belong.
pub(crate) fn lower_equation<'a>(
    model: &mut Model<'a, '_>,
    equation: &'a ast::Equation,
    scope: &Scope<'a>,
) -> Vec<Equation> {
    let span = equation.span;
    match &equation.kind {
        EquationKind::Equality {
            lhs,
            rhs,
            place: Some(place),
        } => {
            model.field_equation(lhs, rhs, place, scope, span);
            Vec::new()
        }
        EquationKind::Equality {
            lhs,
            rhs,
            place: None,
        } => equality(model, lhs, rhs, scope, span),
        EquationKind::Connect(sides) => {
            connection(model, sides, scope, span);
            Vec::new()
        }
        EquationKind::For {
            counter,
            first,
            last,
            equations,
        } => for_equation(model, counter, first, last, equations, scope),
        EquationKind::If {
            branches,
            otherwise,
        } => if_equation(model, branches, otherwise, scope, span),
        EquationKind::When(branches) => {
            when(model, branches, scope, span);
            Vec::new()
        }
        EquationKind::Assert(condition, message) => {
            let condition = model.truth(condition, &scope.with(Setting::Condition));
            let origin = model.tree.origin(scope.instance, span);
            model.flat.asserts.push(Assert {
                condition,
                message: message.clone(),
                origin,
            });
            Vec::new()
        }
        EquationKind::Reinit(state, _) => {
            model.report(refused::reinit_outside_event(state.span));
            Vec::new()
        }
    }
}

/// `lhs = rhs`, of scalars or of whole arrays: one equation over a range, or one an element where lists or components
/// are among them.
fn equality<'a>(
    model: &mut Model<'a, '_>,
    lhs: &'a Expr,
    rhs: &'a Expr,
    scope: &Scope<'a>,
    span: Span,
) -> Vec<Equation> {
    let len = model.array_length(lhs, scope);
    let Some(len) = len.or_else(|| model.array_length(rhs, scope)) else {
        return vec![one_equality(model, (lhs, rhs), Range::SCALAR, scope, span)];
    };
    let range = Range {
        first: 0,
        last: i32::try_from(len).unwrap_or(i32::MAX) - 1,
    };
    let counted = scope.elements(Elementwise::Range(len));
    let counts = |(_, counter): &(_, Counter)| matches!(counter, Counter::Symbolic);
    if scope.counters.iter().any(counts) {
        // One counter an equation: the loop around it is unrolled.
        model.unroll();
        return Vec::new();
    }
    let whole = |model: &mut Model<'a, '_>| one_equality(model, (lhs, rhs), range, &counted, span);
    if let Some(whole) = model.together(whole) {
        return vec![whole];
    }
    if !can_unroll(model.diagnostics, len, span) {
        return Vec::new();
    }
    let one = |at| scope.elements(Elementwise::One(Position { at, of: len }));
    (0..len)
        .map(|at| one_equality(model, (lhs, rhs), Range::SCALAR, &one(at), span))
        .collect()
}

fn one_equality<'a>(
    model: &mut Model<'a, '_>,
    (lhs, rhs): (&'a Expr, &'a Expr),
    range: Range,
    scope: &Scope<'a>,
    span: Span,
) -> Equation {
    let (left, right) = (model.lower(lhs, scope), model.lower(rhs, scope));
    model.same_kind(&left, &right);
    if matches!(lhs.kind, ExprKind::Reference(_)) {
        check_whole(model, &left, &right);
        zero::show_difference(&mut model.flat, &mut model.variables, (&left, &right));
    }
    model.agree(&left, &right, "`=` equates", scope.instance);
    let origin = model.tree.origin(scope.instance, span);
    Equation {
        range,
        lhs: left.id,
        rhs: right.id,
        origin,
    }
}
