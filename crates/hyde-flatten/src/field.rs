//! Fields on a mesh: linear finite elements on equal cells.
//!
//! A domain of n cells has the nodes 0..n. A field that is a state lies at the nodes, a flux (a field whose value
//! contains `pder`) in the middle of the cells, cell j between nodes j-1 and j:
//!
//! ```text
//! field Torque q on bar = G*Ip*pder(th, x);      for j in 1..n:   q[j] = G*Ip*((th[j] - th[j-1])/h)
//! rho*Ip*der(w) = pder(q, x) indomain bar        for k in 1..n-1: M[k] = (q[k+1] - q[k])/h
//!                                                k = 0:           M[0] = (q[1] - q.left)/(h/2)
//!                                                k = n:           M[n] = (q.right - q[n])/(h/2)
//! ```
//!
//! with the end fluxes `q.left` and `q.right` as two more unknowns for the model's boundary equations (F2). M is what
//! stands beside the fluxes. `fv` takes it at the node. `fem` weights it by the mean of the consistent and the lumped
//! mass matrix, 1/12, 10/12, 1/12 (5/6, 1/6 at an end), which raises the order of the frequencies from two to four
//! (Goudreau and Taylor, Comp. Meth. Appl. Mech. Eng. 2, 1973); both conserve energy. `load(x, F)` adds F with the
//! weights of the linear shape functions at x, the same with which `field.at(x)` reads (F4).

use crate::dimension::Dim;
use crate::instance::{DomainId, Field, FieldPlace, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::flat::Equation;
use hyde_ir::{Expr as Ir, ExprId, Id as _, Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{Binary, Expr, ExprKind, Place, Reference, Unary};

/// A point on the mesh: the node left of it, its cell's share left of it (of parameters), and whether it is the node.
struct Point {
    node: usize,
    share: ExprId,
    at_node: bool,
}

impl<'a> Model<'a, '_> {
    /// The value of a field where the expression is evaluated.
    pub(crate) fn field_value(
        &mut self,
        var: VarId,
        field: Field,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let (domain, index, cell) = match scope.place {
            FieldPlace::Node(domain, index) => (domain, index, false),
            FieldPlace::Cell(domain, index) => (domain, index, true),
            FieldPlace::Nowhere => {
                let name = self.flat.variables[var].name.clone();
                self.field_needs_place(&name, span);
                return self.poison(span);
            }
        };
        if domain != field.domain {
            self.report(
                Diagnostic::error(Code::FieldUse, "a field of another domain").label(
                    span,
                    format!("lies on `{}`", self.domains[field.domain].name),
                ),
            );
            return self.poison(span);
        }
        let id = match (field.flux, cell) {
            (false, false) => self.flat.exprs.add(Ir::Var(var, index)),
            (true, true) => self.flat.exprs.add(Ir::Var(var, shifted(index, -1))),
            (false, true) => {
                let (left, right) = (self.node(var, index, -1), self.node(var, index, 0));
                let sum = self.flat.exprs.plus(left, right);
                let half = self.flat.exprs.constant(0.5);
                self.flat.exprs.times(half, sum)
            }
            (true, false) => match self.end_trace(field, index) {
                Some(trace) => self.flat.exprs.var(trace),
                None => {
                    let name = self.flat.variables[var].name.clone();
                    self.report(
                        Diagnostic::error(
                            Code::FieldUse,
                            format!("the flux `{name}` stands outside `pder`"),
                        )
                        .label(
                            span,
                            "a flux lies between the nodes, this is evaluated at them",
                        )
                        .help("write `pder(q, x)`, or read the flux in another flux"),
                    );
                    return self.poison(span);
                }
            },
        };
        let dim = self.dim(var);
        self.typed(id, dim, span)
    }

    /// The coordinate where a field expression is evaluated.
    pub(crate) fn coordinate_value(&mut self, scope: &Scope<'a>, span: Span) -> Typed {
        let (FieldPlace::Node(domain, index) | FieldPlace::Cell(domain, index)) = scope.place
        else {
            return self.poison(span);
        };
        let (from, h, dim) = self.mesh(domain);
        let arena = &mut self.flat.exprs;
        let counter = arena.add(Ir::Counter);
        let stride = arena.constant(f64::from(index.stride));
        let middle = if matches!(scope.place, FieldPlace::Cell(..)) {
            0.5
        } else {
            0.0
        };
        let offset = arena.constant(f64::from(index.offset) - middle);
        let counted = arena.times(stride, counter);
        let number = arena.plus(counted, offset);
        let along = arena.times(number, h);
        let id = arena.plus(from, along);
        self.typed(id, dim, span)
    }

    /// `pder(f, x)`: between nodes the slope of a nodal field.
    pub(crate) fn pder(&mut self, args: &[&'a Expr], scope: &Scope<'a>, span: Span) -> Typed {
        let Some([f, by]) = self.exactly("pder", args, span) else {
            return self.poison(span);
        };
        let Some((var, field)) = self.field_named(f, scope) else {
            return self.poison(span);
        };
        let coordinate = self.domains[field.domain].coordinate;
        if !matches!(&by.kind, ExprKind::Reference(name) if name.as_word() == Some(coordinate)) {
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("the coordinate of this field is `{coordinate}`"),
                )
                .label(by.span, "not its coordinate"),
            );
        }
        let (_, h, length) = self.mesh(field.domain);
        let dim = self.dim(var).divide(&length);
        let id = match (field.flux, scope.place) {
            (false, FieldPlace::Cell(domain, index)) if domain == field.domain => {
                let (left, right) = (self.node(var, index, -1), self.node(var, index, 0));
                let step = self.flat.exprs.minus(right, left);
                self.flat.exprs.over(step, h)
            }
            (true, FieldPlace::Node(domain, index)) if domain == field.domain => {
                self.flux_difference(var, field.domain, index, h)
            }
            (false, _) => {
                self.report(
                    Diagnostic::error(Code::FieldUse, "a space derivative outside a flux")
                        .label(span, "an equation of a field takes derivatives of fluxes")
                        .help("give the flux a name: `field Torque q on bar = k*pder(th, x);` and write `pder(q, x)`"),
                );
                return self.poison(span);
            }
            (true, _) => {
                self.report(
                    Diagnostic::error(
                        Code::FieldUse,
                        "the derivative of a flux outside an equation on the domain",
                    )
                    .label(span, "evaluated where there are no nodes")
                    .help("write the equation `indomain bar`"),
                );
                return self.poison(span);
            }
        };
        self.typed(id, dim, span)
    }

    /// `th.at(x)`: a nodal field read at a place, with the weights that `load` uses.
    pub(crate) fn field_at(
        &mut self,
        function: &'a Reference,
        at: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let name = Reference {
            parts: function.parts[..function.parts.len() - 1].to_vec(),
            span: function.span,
        };
        let Some((var, field)) = self.field_of_parts(&name, scope) else {
            return self.poison(span);
        };
        if field.flux {
            let name = self.flat.variables[var].name.clone();
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("the flux `{name}` is not read at a point"),
                )
                .label(span, "lies between the nodes"),
            );
            return self.poison(span);
        }
        let Some(point) = self.point(field.domain, at, scope) else {
            return self.poison(span);
        };
        let at_index = |node: usize| Index::fixed(i32::try_from(node).unwrap_or(i32::MAX));
        let arena = &mut self.flat.exprs;
        let left = arena.add(Ir::Var(var, at_index(point.node)));
        let id = if point.at_node {
            left
        } else {
            let right = arena.add(Ir::Var(var, at_index(point.node + 1)));
            let one = arena.constant(1.0);
            let rest = arena.minus(one, point.share);
            let (a, b) = (arena.times(rest, left), arena.times(point.share, right));
            arena.plus(a, b)
        };
        let dim = self.dim(var);
        self.typed(id, dim, span)
    }

    /// The binding of a field, `field … on bar = e`.
    pub(crate) fn field_binding(
        &mut self,
        var: VarId,
        field: Field,
        value: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let n = self.cells(field.domain);
        let origin = self
            .origin(scope.instance, span)
            .made_by(MadeBy::Discretization);
        let places = if field.flux {
            vec![Range { first: 1, last: n }]
        } else {
            pieces(n, &[])
        };
        let dim = self.dim(var);
        for range in places {
            let index = counted_index(range);
            let place = if field.flux {
                FieldPlace::Cell(field.domain, index)
            } else {
                FieldPlace::Node(field.domain, index)
            };
            let rhs = self.value(value, &scope.at(place));
            let element = if field.flux {
                shifted(index, -1)
            } else {
                index
            };
            let lhs = self.flat.exprs.add(Ir::Var(var, element));
            let left = self.typed(lhs, dim.clone(), span);
            self.agree(&left, &rhs, "the field and its value are", scope.instance);
            let (lhs, rhs) = (
                self.fix_counter(lhs, range),
                self.fix_counter(rhs.id, range),
            );
            self.flat.equations.push(Equation {
                range: collapsed(range),
                lhs,
                rhs,
                origin: origin.clone(),
            });
        }
    }

    /// `lhs = rhs indomain bar load(…)` or `… indomain bar.left`.
    pub(crate) fn field_equation(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let name = place.domain.text.as_str();
        let Some(domain) = self.domain_named(scope.instance, &place.domain) else {
            return;
        };
        match place.end.as_ref().map(|end| (end.text.as_str(), end.span)) {
            None => self.interior(domain, lhs, rhs, place, scope, span),
            Some(("left", _)) => self.boundary(domain, 0, lhs, rhs, scope, span),
            Some(("right", _)) => self.boundary(domain, self.cells(domain), lhs, rhs, scope, span),
            Some((other, at)) => self.report(
                Diagnostic::error(Code::FieldUse, format!("a domain has no end `{other}`"))
                    .label(at, "not an end")
                    .help(format!("write `{name}.left` or `{name}.right`")),
            ),
        }
    }

    /// Makes the end fluxes that an equation on a domain needs.
    pub(crate) fn traces_of(
        &mut self,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let member = self.instances[scope.instance]
            .members
            .get(place.domain.text.as_str());
        let Some(crate::instance::Member::Domain(domain)) = member else {
            return;
        };
        let domain = *domain;
        let (mut mass, mut fluxes) = (Vec::new(), Vec::new());
        split(lhs, true, &mut mass, &mut fluxes);
        split(rhs, false, &mut mass, &mut fluxes);
        self.make_traces(domain, &fluxes, scope, span);
    }

    /// A boundary equation: fields stand for their value or flux at the end.
    fn boundary(
        &mut self,
        domain: DomainId,
        node: i32,
        lhs: &'a Expr,
        rhs: &'a Expr,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let scope = scope.at(FieldPlace::Node(domain, Index::fixed(node)));
        let (left, right) = (self.value(lhs, &scope), self.value(rhs, &scope));
        self.agree(&left, &right, "`=` equates", scope.instance);
        let range = Range {
            first: node,
            last: node,
        };
        let (lhs, rhs) = (
            self.fix_counter(left.id, range),
            self.fix_counter(right.id, range),
        );
        let origin = self.origin(scope.instance, span);
        self.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs,
            origin,
        });
    }

    /// An equation at every node.
    fn interior(
        &mut self,
        domain: DomainId,
        lhs: &'a Expr,
        rhs: &'a Expr,
        place: &'a Place,
        scope: &Scope<'a>,
        span: Span,
    ) {
        let n = self.cells(domain);
        let mut mass = Vec::new();
        let mut fluxes = Vec::new();
        split(lhs, true, &mut mass, &mut fluxes);
        split(rhs, false, &mut mass, &mut fluxes);
        let mut loads = Vec::new();
        for (at, force) in &place.loads {
            let Some(point) = self.point(domain, at, scope) else {
                continue;
            };
            let force = self.value(force, scope);
            loads.push((point, force));
        }
        let mut loaded: Vec<i32> = Vec::new();
        for (point, _) in &loads {
            let node = i32::try_from(point.node).unwrap_or(i32::MAX);
            loaded.push(node);
            if !point.at_node {
                loaded.push(node + 1);
            }
        }
        let origin = self
            .origin(scope.instance, span)
            .made_by(MadeBy::Discretization);
        let averaged = self.domains[domain].averaged && !fluxes.is_empty();
        for range in pieces(n, &loaded) {
            let index = counted_index(range);
            let at = |shift: i32| scope.at(FieldPlace::Node(domain, shifted(index, shift)));
            if range.first == range.last || range.first == 1 {
                // The dimensions of the whole equation, once.
                let (left, right) = (self.value(lhs, &at(0)), self.value(rhs, &at(0)));
                self.agree(&left, &right, "`=` equates", scope.instance);
                let side = Typed {
                    dim: crate::lower::sum_dim(&left.dim, &right.dim),
                    ..left
                };
                self.agree_loads(&side, &loads, domain, scope);
            }
            let left = if averaged {
                self.weighted(&mass, range, n, &at)
            } else {
                self.total(&mass, &at(0))
            };
            let mut right = self.total(&fluxes, &at(0));
            for (point, force) in &loads {
                right = self.with_load(right, point, force.id, range, n, domain);
            }
            let (lhs, rhs) = (
                self.fix_counter(left, range),
                self.fix_counter(right, range),
            );
            self.flat.equations.push(Equation {
                range: collapsed(range),
                lhs,
                rhs,
                origin: origin.clone(),
            });
        }
    }

    /// The mean of the consistent and the lumped mass matrix, applied to M.
    fn weighted(
        &mut self,
        mass: &[(&'a Expr, bool)],
        range: Range,
        n: i32,
        at: &dyn Fn(i32) -> Scope<'a>,
    ) -> ExprId {
        let ends: &[(i32, f64, f64)] = if range.first == 0 {
            &[(0, 5.0, 6.0), (1, 1.0, 6.0)]
        } else if range.first == n {
            &[(0, 5.0, 6.0), (-1, 1.0, 6.0)]
        } else {
            &[(-1, 1.0, 12.0), (0, 10.0, 12.0), (1, 1.0, 12.0)]
        };
        let mut sum = self.flat.exprs.constant(0.0);
        for &(shift, above, below) in ends {
            let value = self.total(mass, &at(shift));
            let weight = self.flat.exprs.constant(above / below);
            let term = self.flat.exprs.times(weight, value);
            sum = self.flat.exprs.plus(sum, term);
        }
        sum
    }

    /// The sum of terms with their signs.
    fn total(&mut self, terms: &[(&'a Expr, bool)], scope: &Scope<'a>) -> ExprId {
        let mut sum = self.flat.exprs.constant(0.0);
        for &(term, positive) in terms {
            let value = self.value(term, scope).id;
            sum = if positive {
                self.flat.exprs.plus(sum, value)
            } else {
                self.flat.exprs.minus(sum, value)
            };
        }
        sum
    }

    /// Adds the share of a point load at a node: shape function over the node's length.
    fn with_load(
        &mut self,
        sum: ExprId,
        point: &Point,
        force: ExprId,
        range: Range,
        n: i32,
        domain: DomainId,
    ) -> ExprId {
        let node = i32::try_from(point.node).unwrap_or(i32::MAX);
        if range.first != range.last
            || !(range.first == node || (!point.at_node && range.first == node + 1))
        {
            return sum;
        }
        let (_, h, _) = self.mesh(domain);
        let arena = &mut self.flat.exprs;
        let half = arena.constant(0.5);
        let length = if range.first == 0 || range.first == n {
            arena.times(half, h)
        } else {
            h
        };
        let density = arena.over(force, length);
        let weight = if point.at_node {
            arena.constant(1.0)
        } else if range.first == node {
            let one = arena.constant(1.0);
            arena.minus(one, point.share)
        } else {
            point.share
        };
        let share = arena.times(weight, density);
        arena.plus(sum, share)
    }

    /// A load has the unit of the equation times the domain's length (U3).
    fn agree_loads(
        &mut self,
        side: &Typed,
        loads: &[(Point, Typed)],
        domain: DomainId,
        scope: &Scope<'a>,
    ) {
        let (_, _, length) = self.mesh(domain);
        for (_, force) in loads {
            let spread = Typed {
                dim: force.dim.divide(&length),
                ..force.clone()
            };
            self.agree(
                side,
                &spread,
                "the equation and the load per length are",
                scope.instance,
            );
        }
    }

    /// The end fluxes of every flux whose derivative is taken.
    fn make_traces(
        &mut self,
        domain: DomainId,
        fluxes: &[(&'a Expr, bool)],
        scope: &Scope<'a>,
        span: Span,
    ) {
        let mut found = Vec::new();
        for (term, _) in fluxes {
            arguments_of_pder(term, &mut found);
        }
        for argument in found {
            let Some((var, mut field)) = self.field_named(argument, scope) else {
                continue;
            };
            if !field.flux || field.domain != domain || field.traces.is_some() {
                continue;
            }
            let (name, origin) = (
                self.flat.variables[var].name.clone(),
                self.flat.variables[var].origin.clone(),
            );
            let bar = self.domains[domain].name;
            let mut end = |side: &str| {
                let trace = self.add_variable(
                    scope.instance,
                    format!("{name}.{side}"),
                    VariableKind::Continuous,
                    self.dim(var),
                    span,
                    MadeBy::Discretization,
                );
                self.flat.variables[trace].trace = Some(format!("{bar}.{side}"));
                self.flat.variables[trace].origin = origin.clone().made_by(MadeBy::Discretization);
                trace
            };
            field.traces = Some((end("left"), end("right")));
            self.variables[var.index()].field = Some(field);
        }
    }

    /// `(q[k+1] - q[k])/h`, with the end fluxes and half cells at the ends.
    fn flux_difference(&mut self, var: VarId, domain: DomainId, index: Index, h: ExprId) -> ExprId {
        let n = self.cells(domain);
        let traces = self.notes(var).field.and_then(|field| field.traces);
        let (below, above) = match (index, traces) {
            (
                Index {
                    stride: 0,
                    offset: 0,
                },
                Some((left, _)),
            ) => (
                self.flat.exprs.var(left),
                self.flat.exprs.add(Ir::Var(var, Index::fixed(0))),
            ),
            (Index { stride: 0, offset }, Some((_, right))) if offset == n => (
                self.flat.exprs.add(Ir::Var(var, Index::fixed(n - 1))),
                self.flat.exprs.var(right),
            ),
            _ => (
                self.flat.exprs.add(Ir::Var(var, shifted(index, -1))),
                self.flat.exprs.add(Ir::Var(var, index)),
            ),
        };
        let arena = &mut self.flat.exprs;
        let step = arena.minus(above, below);
        let at_end = index.stride == 0 && (index.offset == 0 || index.offset == n);
        let half = arena.constant(0.5);
        let length = if at_end { arena.times(half, h) } else { h };
        arena.over(step, length)
    }

    /// The end flux, where a flux is read at an end node.
    fn end_trace(&self, field: Field, index: Index) -> Option<VarId> {
        let n = self.cells(field.domain);
        let (left, right) = field.traces?;
        match index {
            Index {
                stride: 0,
                offset: 0,
            } => Some(left),
            Index { stride: 0, offset } if offset == n => Some(right),
            _ => None,
        }
    }

    /// Lower end, cell length, and dimension of a domain.
    fn mesh(&mut self, domain: DomainId) -> (ExprId, ExprId, Dim) {
        if let Some(mesh) = &self.domains[domain].mesh {
            return mesh.clone();
        }
        let (instance, from, to, cells) = {
            let domain = &self.domains[domain];
            (domain.instance, domain.from, domain.to, domain.cells)
        };
        let scope = Scope::new(instance, Setting::Parameter);
        let (from, to) = (self.value(from, &scope), self.value(to, &scope));
        self.agree(&from, &to, "the ends of a domain are", instance);
        let arena = &mut self.flat.exprs;
        let length = arena.minus(to.id, from.id);
        let count = arena.constant(cells as f64);
        let h = arena.over(length, count);
        let mesh = (from.id, h, to.dim);
        self.domains[domain].mesh = Some(mesh.clone());
        mesh
    }

    /// Where a place of parameters lies on the mesh: the cell is structural, the share within it is not.
    fn point(&mut self, domain: DomainId, at: &'a Expr, scope: &Scope<'a>) -> Option<Point> {
        let (from, h, dim) = self.mesh(domain);
        let place = self.value(at, &scope.with(Setting::Parameter));
        let along = Typed {
            dim,
            ..place.clone()
        };
        self.agree(
            &place,
            &along,
            "the place and the coordinate are",
            scope.instance,
        );
        let arena = &mut self.flat.exprs;
        let distance = arena.minus(place.id, from);
        let number = arena.over(distance, h);
        let value = self.evaluate(number)?;
        let cells = self.domains[domain].cells;
        let outside = !(-1e-9..=cells as f64 + 1e-9).contains(&value);
        if outside {
            self.report(
                Diagnostic::error(Code::FieldUse, "the place lies outside the domain")
                    .label(
                        at.span,
                        format!("{:.3} cells from the start, of {cells}", value),
                    )
                    .label(self.domains[domain].span, "the domain"),
            );
            return None;
        }
        let nearest = value.round();
        let at_node = (value - nearest).abs() < 1e-9;
        let node = if at_node {
            nearest as usize
        } else {
            value.floor() as usize
        };
        let first = self.flat.exprs.constant(node as f64);
        let share = self.flat.exprs.minus(number, first);
        Some(Point {
            node,
            share,
            at_node,
        })
    }

    fn field_named(&mut self, expr: &'a Expr, scope: &Scope<'a>) -> Option<(VarId, Field)> {
        let ExprKind::Reference(name) = &expr.kind else {
            self.report(
                Diagnostic::error(Code::FieldUse, "the derivative of an expression")
                    .label(expr.span, "not a field by name")
                    .help("give it a name: `field … q on bar = …;`"),
            );
            return None;
        };
        let resolved = self.resolve(name, scope)?;
        if let Resolved::Variable(var, None) = resolved
            && let Some(field) = self.notes(var).field
        {
            return Some((var, field));
        }
        self.report(
            Diagnostic::error(Code::FieldUse, format!("`{}` is no field", name.dotted()))
                .label(expr.span, "has no derivative in space"),
        );
        None
    }

    /// A field by a name that was cut out of a longer one.
    fn field_of_parts(&mut self, name: &Reference, scope: &Scope<'a>) -> Option<(VarId, Field)> {
        let mut at = scope.instance;
        let mut found = None;
        for (position, part) in name.parts.iter().enumerate() {
            let word = part.name.text.as_str();
            let mut member = self.instances[at].members.get(word);
            while position == 0 && member.is_none() {
                let Some(outer) = self.instances[at].outer else {
                    break;
                };
                at = outer;
                member = self.instances[at].members.get(word);
            }
            match member {
                Some(crate::instance::Member::Instance(inner)) => at = *inner,
                Some(crate::instance::Member::Variable(var)) => found = Some(*var),
                _ => {
                    found = None;
                    break;
                }
            }
        }
        let field = found.and_then(|var| Some((var, self.notes(var).field?)));
        if field.is_none() {
            self.report(
                Diagnostic::error(Code::FieldUse, format!("`{}` is no field", name.dotted()))
                    .label(name.span, "only a field is read at a place"),
            );
        }
        field
    }

    fn field_needs_place(&mut self, name: &str, span: Span) {
        let short = name.rsplit('.').next().unwrap_or(name);
        self.report(
            Diagnostic::error(
                Code::FieldUse,
                format!("the field `{name}` has no single value"),
            )
            .label(span, "at which place?")
            .help(format!(
                "read it at a place, `{short}.at(xn)`, or write the equation `indomain …`"
            )),
        );
    }

    fn node(&mut self, var: VarId, index: Index, shift: i32) -> ExprId {
        self.flat.exprs.add(Ir::Var(var, shifted(index, shift)))
    }

    fn cells(&self, domain: DomainId) -> i32 {
        i32::try_from(self.domains[domain].cells).unwrap_or(i32::MAX)
    }

    /// An equation at a single node is a scalar one: its counter is a number.
    fn fix_counter(&mut self, id: ExprId, range: Range) -> ExprId {
        if range.first != range.last {
            return id;
        }
        self.flat.exprs.at_counter(id, range.first)
    }
}

/// The nodes 0..n in pieces: each end, each node with a load, and the runs between them.
fn pieces(n: i32, loaded: &[i32]) -> Vec<Range> {
    let mut single: Vec<i32> = loaded.to_vec();
    single.extend([0, n]);
    single.sort_unstable();
    single.dedup();
    let mut found = Vec::new();
    let mut next = 0;
    for node in single {
        if next < node {
            found.push(Range {
                first: next,
                last: node - 1,
            });
        }
        found.push(Range {
            first: node,
            last: node,
        });
        next = node + 1;
    }
    found
}

/// The index of a node over a range: its number where there is only one.
fn counted_index(range: Range) -> Index {
    if range.first == range.last {
        Index::fixed(range.first)
    } else {
        Index {
            stride: 1,
            offset: 0,
        }
    }
}

fn collapsed(range: Range) -> Range {
    if range.first == range.last {
        Range::SCALAR
    } else {
        range
    }
}

fn shifted(index: Index, by: i32) -> Index {
    Index {
        offset: index.offset + by,
        ..index
    }
}

/// Splits a side into terms, those with the derivative of a flux apart. `left` tells the sign in `M = fluxes`.
fn split<'a>(
    expr: &'a Expr,
    left: bool,
    mass: &mut Vec<(&'a Expr, bool)>,
    fluxes: &mut Vec<(&'a Expr, bool)>,
) {
    match &expr.kind {
        ExprKind::Binary(Binary::Add, a, b) => {
            split(a, left, mass, fluxes);
            split(b, left, mass, fluxes);
        }
        ExprKind::Binary(Binary::Sub, a, b) => {
            split(a, left, mass, fluxes);
            split(b, !left, mass, fluxes);
        }
        ExprKind::Unary(Unary::Negative, inner) => split(inner, !left, mass, fluxes),
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..) => {
            if expr.calls("pder") {
                fluxes.push((expr, !left));
            } else {
                mass.push((expr, left));
            }
        }
    }
}

fn arguments_of_pder<'a>(expr: &'a Expr, found: &mut Vec<&'a Expr>) {
    match &expr.kind {
        ExprKind::Call(name, arguments) => {
            if let (Some("pder"), Some(first)) = (name.as_word(), arguments.first()) {
                found.push(&first.value);
            } else {
                arguments
                    .iter()
                    .for_each(|argument| arguments_of_pder(&argument.value, found));
            }
        }
        ExprKind::Unary(_, inner) => arguments_of_pder(inner, found),
        ExprKind::Binary(_, a, b) => {
            arguments_of_pder(a, found);
            arguments_of_pder(b, found);
        }
        ExprKind::If(branches, otherwise) => {
            branches
                .iter()
                .for_each(|(_, value)| arguments_of_pder(value, found));
            arguments_of_pder(otherwise, found);
        }
        ExprKind::Array(items, _) => items.iter().for_each(|item| arguments_of_pder(item, found)),
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_) => {}
    }
}
