//! `edge(b)`: that b has become true just now.
//!
//! ```text
//! when edge(b) and x > 0 then …      b becomes true while x > 0; not x while b is true
//! ```
//! In a clocked part it is `b and not pre(b)`. At an event it is a discrete variable that is true in the one round of the
//! event iteration in which its condition became true.

use crate::dimension::Dim;
use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::calls as refused;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::Edge;
use hyde_ir::{BinaryOp, Expr as Ir, ExprId, UnaryOp, VariableKind};
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    pub(super) fn edge(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([a]) = self.exactly("edge", args, span) else {
            return self.poison(span);
        };
        let id = match scope.setting {
            Setting::Condition | Setting::Action => {
                let condition = self.truth(a, &scope.with(Setting::Condition));
                self.edge_at_events(condition, scope, a.span)
            }
            Setting::Clocked => self.edge_at_ticks(a, scope),
            Setting::Equation | Setting::Parameter | Setting::Report | Setting::Measure => {
                self.report(refused::edge_between_events(span));
                return self.poison(span);
            }
        };
        Typed {
            truth: true,
            ..self.typed(id, Dim::NUMBER, span)
        }
    }

    fn edge_at_events(&mut self, condition: ExprId, scope: &Scope<'a>, span: Span) -> ExprId {
        let mut known = self.flat.edges.iter();
        if let Some(known) = known.find(|edge| edge.condition == condition) {
            return self.flat.exprs.var(known.var);
        }
        let text = self.input.sources.text(span).to_owned();
        let path = &self.tree[scope.instance].path;
        let var = self.add_variable(
            scope.instance,
            path.member(&format!("edge({text})")),
            VariableKind::Discrete,
            Dim::NUMBER,
            span,
            MadeBy::Expression,
        );
        self.flat.variables[var].boolean = true;
        let origin = self.tree.origin(scope.instance, span);
        self.flat.edges.push(Edge {
            condition,
            var,
            origin,
        });
        self.flat.exprs.var(var)
    }

    fn edge_at_ticks(&mut self, a: &'a Expr, scope: &Scope<'a>) -> ExprId {
        let now = self.truth(a, scope);
        let Ir::Var(var, index) = self.flat.exprs[now] else {
            self.report(refused::edge_of_expression(a.span));
            return now;
        };
        let arena = &mut self.flat.exprs;
        let before = arena.add(Ir::Pre(var, index));
        let not_before = arena.unary(UnaryOp::Not, before);
        arena.binary(BinaryOp::And, now, not_before)
    }
}
