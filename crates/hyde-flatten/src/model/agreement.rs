//! Dimensions that must agree: what is asked of the solver, and what is told where two sides cannot be the same.

use super::Model;
use crate::dimension::Dim;
use crate::dimension::constraints::{Demand, Dimensions, Disagreements, InScope};
use crate::instance::{InstanceId, Member, ParameterNotes, Typed};
use crate::instantiate::InstanceTree;
use crate::words::short;
use hyde_diag::{Diagnostic, InstancePath, Severity, Span};
use hyde_ir::{Expr, ExprId, FlatModel, Id as _, Quantity};
use hyde_units::Dimension;

impl Model<'_, '_> {
    /// Demands that two dimensions agree, and reports it if they cannot.
    ///
    /// False where they are known to disagree; that is reported.
    pub(crate) fn agree(
        &mut self,
        a: &Typed,
        b: &Typed,
        what: &'static str,
        instance: InstanceId,
    ) -> bool {
        let sides = self.sides();
        let demand = Demand {
            what,
            spans: (a.span, b.span),
            instance,
            bare: (a.bare, b.bare),
            written: (self.bare_text(a), self.bare_text(b)),
            said: (sides.said(a), sides.said(b)),
            sides: (a.id, b.id),
        };
        let Self {
            dimensions,
            tree,
            parameters,
            flat,
            ..
        } = self;
        let found = dimensions.agree(&a.dim, &b.dim, demand, &|id| {
            in_scope(tree, parameters, flat, id)
        });
        let Some(diagnostic) = found.or_else(|| self.sides().lost_turn(a, b)) else {
            return true;
        };
        let error = diagnostic.severity == Severity::Error;
        let diagnostic = self.with_parts(diagnostic, (a.id, b.id));
        self.report(diagnostic);
        !error
    }

    /// Says what the names in two sides are, where one of them is more than a name. What was set in another file than that of
    /// the sides, as a parameter of a library's component, is where the mistake is.
    fn with_parts(&self, diagnostic: Diagnostic, sides: (ExprId, ExprId)) -> Diagnostic {
        let exprs = &self.flat.exprs;
        let written_in = diagnostic.labels.first().map(|label| label.span.file);
        let mut set: Vec<(&str, &Dim, Span)> = Vec::new();
        let mut named: Vec<(&str, &Dim, &Quantity)> = Vec::new();
        let composed = [sides.0, sides.1].into_iter().filter(|&side| {
            matches!(
                exprs[side],
                Expr::Unary(..) | Expr::Binary(..) | Expr::If(..)
            )
        });
        for id in exprs.below(&composed.collect::<Vec<_>>()) {
            let part = match exprs[id] {
                Expr::Param(param, _) => {
                    let own = &self.flat.parameters[param];
                    let (name, dim) = (own.name.as_str(), &self.parameters[param.index()].dim);
                    let span = own.origin.span;
                    let known = set.iter().any(|(known, ..)| *known == name);
                    if !known && !own.derived && Some(span.file) != written_in {
                        set.push((name, dim, span));
                    }
                    (name, dim, &own.quantity)
                }
                Expr::Var(var, _) => (
                    self.flat.variables[var].name.as_str(),
                    &self.variables[var.index()].dim,
                    &self.flat.variables[var].quantity,
                ),
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Unary(..)
                | Expr::Binary(..)
                | Expr::If(..)
                | Expr::NoEvent(_) => continue,
            };
            if !named.iter().any(|(name, ..)| *name == part.0) {
                named.push(part);
            }
        }
        let mut diagnostic = diagnostic;
        for (name, dim, span) in set.into_iter().rev() {
            if let Some(dimension) = self.dimensions.resolve(dim).as_known() {
                let text = format!(
                    "`{}` is {} here",
                    short(name),
                    crate::refusals::dimensions::short(dimension)
                );
                diagnostic.labels.insert(0, hyde_diag::Label { span, text });
            }
        }
        let parts: Vec<String> = named
            .iter()
            .take(6)
            .filter_map(|(name, dim, quantity)| {
                let dimension = self.dimensions.resolve(dim).as_known()?;
                // In the unit it was declared in, as long as that says what it is.
                let declared = quantity.unit.text();
                let unit = match quantity.dimension == dimension && declared != "1" {
                    true => declared.to_owned(),
                    false => crate::refusals::dimensions::short(dimension),
                };
                Some(format!("`{}` is {unit}", short(name)))
            })
            .collect();
        match parts.as_slice() {
            [] => diagnostic,
            _ => diagnostic.note(parts.join(", ")),
        }
    }

    /// A bare number as written, for a repair that gives it a unit.
    fn bare_text(&self, typed: &Typed) -> String {
        if typed.bare {
            self.input.sources.text(typed.span).to_owned()
        } else {
            String::new()
        }
    }

    /// Solves the dimensions that are still unknown, and reports what disagrees.
    pub(crate) fn solve_dimensions(&mut self) {
        self.solve_for_dimensions(Dimensions::solve);
    }

    /// The dimension of a value, as far as all that is lowered until now determines it.
    pub(crate) fn dimension_until_now(&mut self, dim: &Dim) -> Option<Dimension> {
        if self.dimensions.resolve(dim).as_known().is_none() {
            self.solve_for_dimensions(Dimensions::propagate);
        }
        self.dimensions.resolve(dim).as_known()
    }

    fn solve_for_dimensions(&mut self, solve: fn(&mut Dimensions, InScope<'_>) -> Disagreements) {
        let Self {
            dimensions,
            tree,
            parameters,
            flat,
            ..
        } = self;
        let found = solve(dimensions, &|id| in_scope(tree, parameters, flat, id));
        for (diagnostic, sides) in found {
            let diagnostic = self.with_parts(diagnostic, sides);
            self.report(diagnostic);
        }
    }
}

/// The path of an instance and its parameters with their dimensions, those of its parent after its own.
fn in_scope(
    tree: &InstanceTree<'_>,
    parameters: &[ParameterNotes<'_>],
    flat: &FlatModel,
    id: InstanceId,
) -> (InstancePath, Vec<(String, Dim)>) {
    let mut found = Vec::new();
    let chain = [Some(id), tree[id].parent];
    for instance in chain.into_iter().flatten() {
        for member in tree[instance].members.values() {
            if let Member::Parameter(param) = member {
                let name = &flat.parameters[*param].name;
                let dim = parameters[hyde_ir::Id::index(*param)].dim.clone();
                found.push((short(name).to_owned(), dim));
            }
        }
    }
    (tree[id].path.clone(), found)
}
