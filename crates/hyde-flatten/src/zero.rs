//! Temperatures with a zero point of their own: the difference of two of them is in K.
//!
//! Inside there are kelvins alone, and `20 [degC]` is 293.15 K. So a difference that is declared in degC would be shown
//! 273.15 too low, and `T + 5 [degC]` adds 278.15 K.

use crate::instance::Typed;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic};
use hyde_ir::{BinaryOp, Expr, Id as _, Quantity};

/// What is known of the zero point of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Zero {
    /// Nothing.
    Open,
    /// It counts from a zero point of its own: 20 degC.
    Own,
    /// It is the difference of two such values.
    Difference,
}

impl Model<'_, '_> {
    /// The zero point of a sum or a difference; a literal in degC that is added is told.
    pub(crate) fn zero_of_sum(&mut self, op: BinaryOp, a: &Typed, b: &Typed) -> Zero {
        let own = [a.zero, b.zero].contains(&Zero::Own);
        if op == BinaryOp::Sub {
            return match (a.zero, b.zero) {
                (Zero::Own, Zero::Difference) => Zero::Own,
                _ if own => Zero::Difference,
                _ => Zero::Open,
            };
        }
        for (literal, other) in [(b, a), (a, b)] {
            let is_literal = self.flat.exprs.as_constant(literal.id).is_some();
            if literal.zero == Zero::Own && is_literal && other.zero != Zero::Difference {
                let text = self.input.sources.text(literal.span);
                let number = text.split('[').next().unwrap_or("").trim();
                let unit = literal
                    .dim
                    .as_known()
                    .map_or_else(String::new, |dim| dim.usual_unit());
                self.report(
                    Diagnostic::warning(
                        Code::ZeroPoint,
                        "a temperature with its zero point is added as a difference",
                    )
                    .label(literal.span, "adds its zero point as well")
                    .help(format!("write `{number} [{unit}]` for a difference")),
                );
                return Zero::Own;
            }
        }
        match own {
            true => Zero::Own,
            false => Zero::Open,
        }
    }

    /// What is set to a difference is shown as one: in K where its type says degC.
    pub(crate) fn shown_as_difference(&mut self, target: &Typed, value: &Typed) {
        if value.zero != Zero::Difference {
            return;
        }
        let Expr::Var(var, _) = self.flat.exprs[target.id] else {
            return;
        };
        let quantity = &mut self.flat.variables[var].quantity;
        if quantity.unit.unit().is_absolute() {
            *quantity = Quantity::usual(quantity.dimension);
        }
        self.variables[var.index()].difference = true;
    }

    /// The zero point of what is read: that of its declared unit.
    pub(crate) fn zero_of_name(&self, id: hyde_ir::ExprId) -> Zero {
        if let Expr::Var(var, _) = self.flat.exprs[id]
            && self.notes(var).difference
        {
            return Zero::Difference;
        }
        match self.quantity_of(id) {
            Some(quantity) if quantity.unit.unit().is_absolute() => Zero::Own,
            Some(_) | None => Zero::Open,
        }
    }
}
