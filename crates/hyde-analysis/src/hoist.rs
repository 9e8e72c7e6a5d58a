//! What depends on parameters alone is computed once a run: each such expression becomes a derived parameter.
//!
//! ```text
//! G*Ip*((th[i] - th[i-1])/h)      p1 = G*Ip and h are read, not computed, in the loop
//! a/p with p of parameters        a*(1/p), the reciprocal a derived parameter: division costs five multiplications
//! ```
//! The reciprocal changes the rounding, so it is part of the IR that interpreter and machine code both follow.

use hyde_ir::dae::Dae;
use hyde_ir::{BinaryOp, Expr, ExprId, Parameter, Quantity};
use rustc_hash::FxHashMap;

/// Replaces the largest parts made of parameters alone, everywhere.
pub(crate) fn hoist(dae: &mut Dae) {
    let mut hoisting = Hoisting {
        constant: FxHashMap::default(),
        memo: FxHashMap::default(),
        count: 0,
    };
    let mut residuals = std::mem::take(&mut dae.residuals);
    residuals
        .iter_mut()
        .for_each(|residual| hoisting.apply(dae, &mut residual.value));
    dae.residuals = residuals;
    let mut definitions = std::mem::take(&mut dae.definitions);
    definitions
        .iter_mut()
        .for_each(|definition| hoisting.apply(dae, &mut definition.value));
    dae.definitions = definitions;
    let mut relations = std::mem::take(&mut dae.relations);
    relations
        .iter_mut()
        .for_each(|relation| hoisting.apply(dae, &mut relation.root));
    dae.relations = relations;
    let mut ticks = std::mem::take(&mut dae.ticks);
    for assignment in ticks.iter_mut().flat_map(|tick| &mut tick.assignments) {
        hoisting.apply(dae, &mut assignment.value);
    }
    dae.ticks = ticks;
    let mut delays = std::mem::take(&mut dae.delays);
    delays
        .iter_mut()
        .for_each(|delay| hoisting.apply(dae, &mut delay.value));
    dae.delays = delays;
    let mut outputs = std::mem::take(&mut dae.outputs);
    outputs
        .iter_mut()
        .for_each(|output| hoisting.apply(dae, &mut output.value));
    dae.outputs = outputs;
    let mut partials = std::mem::take(&mut dae.partials);
    for partial in partials.iter_mut().flat_map(|(_, list)| list) {
        hoisting.apply(dae, &mut partial.value);
    }
    dae.partials = partials;
}

struct Hoisting {
    /// Whether a node is made of parameters and numbers alone.
    constant: FxHashMap<ExprId, bool>,
    memo: FxHashMap<ExprId, ExprId>,
    count: usize,
}

impl Hoisting {
    fn apply(&mut self, dae: &mut Dae, root: &mut ExprId) {
        let constant = &self.constant;
        for id in dae.exprs.below_new(*root, |id| constant.contains_key(&id)) {
            let mut constant = dae.exprs[id].is_one_number();
            dae.exprs[id].for_each_child(|child| constant &= self.constant[&child]);
            self.constant.insert(id, constant);
        }
        if self.constant[root] {
            *root = self.derived(dae, *root);
            return;
        }
        let known = |id: ExprId| self.constant[&id] || self.memo.contains_key(&id);
        for id in dae.exprs.below_new(*root, known) {
            let new = match dae.exprs[id] {
                Expr::Binary(BinaryOp::Div, a, b)
                    if self.constant[&b] && !matches!(dae.exprs[b], Expr::Const(_)) =>
                {
                    let one = dae.exprs.constant(1.0);
                    let inverse = dae.exprs.over(one, b);
                    self.constant.insert(inverse, true);
                    let (a, inverse) = (self.child(dae, a), self.derived(dae, inverse));
                    dae.exprs.times(a, inverse)
                }
                Expr::Binary(op, a, b) => {
                    let (a, b) = (self.child(dae, a), self.child(dae, b));
                    dae.exprs.binary(op, a, b)
                }
                Expr::Unary(op, a) => {
                    let a = self.child(dae, a);
                    dae.exprs.unary(op, a)
                }
                Expr::NoEvent(a) => {
                    let a = self.child(dae, a);
                    dae.exprs.no_event(a)
                }
                Expr::If(c, a, b) => {
                    let (c, a, b) = (self.child(dae, c), self.child(dae, a), self.child(dae, b));
                    dae.exprs.if_else(c, a, b)
                }
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => id,
            };
            self.memo.insert(id, new);
        }
        *root = self.memo[root];
    }

    fn child(&mut self, dae: &mut Dae, id: ExprId) -> ExprId {
        if self.constant[&id] {
            self.derived(dae, id)
        } else {
            self.memo[&id]
        }
    }

    /// The derived parameter for an expression of parameters; a plain parameter or a number stays.
    fn derived(&mut self, dae: &mut Dae, id: ExprId) -> ExprId {
        if matches!(dae.exprs[id], Expr::Const(_) | Expr::Param(..)) {
            return id;
        }
        if let Some(&known) = self.memo.get(&id) {
            return known;
        }
        self.count += 1;
        let (last, first) = (dae.n_parameters.1, dae.parameters.iter().next());
        let origin = first.map_or_else(
            || dae.residuals.first().map(|r| r.origins[0].clone()),
            |p| Some(p.origin.clone()),
        );
        let Some(origin) = origin else { return id };
        let name = format!("p{}", self.count);
        let param = dae.parameters.push(Parameter {
            is_final: true,
            derived: true,
            ..Parameter::new(name, id, Quantity::number(), origin)
        });
        dae.parameter_places.push(last);
        dae.parameter_order.push(param);
        dae.n_parameters.1 = last + 1;
        let leaf = dae.exprs.add(Expr::Param(param, hyde_ir::Index::SCALAR));
        self.memo.insert(id, leaf);
        leaf
    }
}
