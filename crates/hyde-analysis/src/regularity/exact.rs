//! Values of parameters and factors as residues: `1 + ratio` less `ratio` is 1, whatever the ratio.

use super::residue::Residue;
use hyde_ir::{BinaryOp, Expr, ExprId, FlatModel, ParamId, UnaryOp};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// A value twice: as a residue, and as a double for what residues cannot do.
#[derive(Clone, Copy, Debug)]
struct Value {
    residue: Residue,
    number: f64,
}

/// Parameters with their declared values.
pub(crate) struct Exact<'a> {
    flat: &'a FlatModel,
    known: BTreeMap<(ParamId, i32), Option<Value>>,
}

impl<'a> Exact<'a> {
    pub(crate) fn new(flat: &'a FlatModel) -> Self {
        Self {
            flat,
            known: BTreeMap::new(),
        }
    }

    /// The residue of an expression of `exprs` at a value of the counter; `None` if it is not made of parameters alone, or
    /// has no finite value.
    pub(crate) fn residue(
        &mut self,
        exprs: &hyde_ir::ExprArena,
        id: ExprId,
        counter: i32,
    ) -> Option<Residue> {
        self.value(exprs, id, counter).map(|value| value.residue)
    }

    fn value(&mut self, exprs: &hyde_ir::ExprArena, root: ExprId, counter: i32) -> Option<Value> {
        let mut values: FxHashMap<ExprId, Value> = FxHashMap::default();
        for id in exprs.below(&[root]) {
            let of = |number: f64| {
                let residue = Residue::of(number)?;
                Some(Value { residue, number })
            };
            let value = match exprs[id] {
                Expr::Const(number) => of(number.0)?,
                Expr::Counter => of(f64::from(counter))?,
                Expr::Param(param, index) => self.parameter(param, index.at(counter))?,
                Expr::Unary(UnaryOp::Neg, a) => Value {
                    residue: Residue::ZERO.minus(values[&a].residue),
                    number: -values[&a].number,
                },
                Expr::Unary(op, a) => of(op.apply(values[&a].number))?,
                Expr::Binary(op, a, b) => {
                    let (a, b) = (values[&a], values[&b]);
                    let number = op.apply(a.number, b.number);
                    let residue = match op {
                        BinaryOp::Add => a.residue.plus(b.residue),
                        BinaryOp::Sub => a.residue.minus(b.residue),
                        BinaryOp::Mul => a.residue.times(b.residue),
                        BinaryOp::Div => a.residue.times(b.residue.inverse()?),
                        BinaryOp::Pow
                        | BinaryOp::Min
                        | BinaryOp::Max
                        | BinaryOp::Atan2
                        | BinaryOp::FloorTo
                        | BinaryOp::RoundTo
                        | BinaryOp::Lt
                        | BinaryOp::Le
                        | BinaryOp::Gt
                        | BinaryOp::Ge
                        | BinaryOp::Eq
                        | BinaryOp::Ne
                        | BinaryOp::And
                        | BinaryOp::Or => Residue::of(number)?,
                    };
                    Value { residue, number }
                }
                Expr::If(c, a, b) => match values[&c].number {
                    0.0 => values[&b],
                    _ => values[&a],
                },
                Expr::NoEvent(a) => values[&a],
                Expr::Time
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..) => return None,
            };
            values.insert(id, value);
        }
        values.get(&root).copied()
    }

    /// An element of a parameter. A parameter's value uses those declared before it alone.
    fn parameter(&mut self, param: ParamId, element: i32) -> Option<Value> {
        if let Some(value) = self.known.get(&(param, element)) {
            return *value;
        }
        let parameter = &self.flat.parameters[param];
        let at = usize::try_from(element).unwrap_or(0);
        let id = parameter.value.get(at).or_else(|| parameter.value.first());
        let flat = self.flat;
        let value = id.and_then(|&id| self.value(&flat.exprs, id, element));
        self.known.insert((param, element), value);
        value
    }
}
