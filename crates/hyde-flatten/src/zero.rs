//! Temperatures with a zero point of their own: the difference of two of them is in K.
//!
//! Inside there are kelvins alone, and `20 [degC]` is 293.15 K. So a difference that is declared in degC would be shown
//! 273.15 too low, `T + 5 [degC]` adds 278.15 K, `2*5 [degC]` is 556.3 K, and `T1 - T2 > 5 [degC]` waits for 278.15 K.

use crate::instance::{Typed, VariableNotes};
use crate::refusals::dimensions as refused;
use crate::shown::quantity_of;
use hyde_diag::{Diagnostic, Sources};
use hyde_ir::{BinaryOp, Expr, ExprId, FlatModel, Id as _, Index, Quantity, VariableKind};
use hyde_syntax::ast::UnitText;
use hyde_units::{Dimension, Unit, significant};

/// What is known of the zero point of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Zero {
    /// Nothing.
    Open,
    /// It counts from a zero point of its own: 20 degC.
    Own,
    /// It is such a value with its sign changed.
    Opposite,
    /// It is the difference of two such values.
    Difference,
    /// It is the difference of two values of which nothing is known.
    Perhaps,
}

impl Zero {
    /// The zero point of a sum or a difference.
    pub(crate) fn of_sum(op: BinaryOp, a: Self, b: Self) -> Self {
        let own = a == Self::Own || b == Self::Own;
        match (a, b) {
            (Self::Own, Self::Difference) if op == BinaryOp::Sub => Self::Own,
            (Self::Difference, Self::Difference | Self::Open) => Self::Difference,
            (Self::Open, Self::Difference) if op == BinaryOp::Add => Self::Difference,
            (Self::Open, Self::Open) if op == BinaryOp::Sub => Self::Perhaps,
            (Self::Opposite, Self::Own) | (Self::Own, Self::Opposite) if op == BinaryOp::Add => {
                Self::Difference
            }
            _ if own && op == BinaryOp::Sub => Self::Difference,
            _ if own => Self::Own,
            _ => Self::Open,
        }
    }

    /// The zero point of the difference of two values of one signal, `last(T) - first(T)` or `T[2] - T[1]`: both count from the
    /// same one, whatever it is.
    pub(crate) fn of_one_signal(flat: &FlatModel, (a, b): (ExprId, ExprId)) -> Option<Self> {
        let same = signal(flat, a)? == signal(flat, b)?;
        same.then_some(Self::Difference)
    }

    /// The zero point of a value with its sign changed.
    pub(crate) fn of_opposite(self) -> Self {
        match self {
            Self::Own => Self::Opposite,
            Self::Opposite => Self::Own,
            Self::Open | Self::Difference | Self::Perhaps => self,
        }
    }

    /// The zero point of a multiple: that of a difference is one.
    pub(crate) fn of_multiple(a: &Typed, b: &Typed) -> Self {
        let one = match (is_number(a), is_number(b)) {
            (_, true) => a.zero,
            (true, false) => b.zero,
            (false, false) => Self::Open,
        };
        match one {
            Self::Difference | Self::Perhaps => one,
            Self::Open | Self::Own | Self::Opposite => Self::Open,
        }
    }

    /// The zero point of one of two values.
    pub(crate) fn of_either(a: Self, b: Self) -> Self {
        if a == Self::Open { b } else { a }
    }

    /// The zero point of what is read: that of its declared unit.
    pub(crate) fn of_name(flat: &FlatModel, notes: &[VariableNotes<'_>], id: ExprId) -> Self {
        if let Expr::Var(var, _) = flat.exprs[id]
            && notes[var.index()].difference
        {
            return Self::Difference;
        }
        match quantity_of(flat, id) {
            Some(quantity) if quantity.unit.unit().is_absolute() => Self::Own,
            Some(_) | None => Self::Open,
        }
    }
}

/// The variable that is read, or of which a number of the whole run is made, or else the expression.
fn signal(flat: &FlatModel, id: ExprId) -> Option<Expr> {
    let (Expr::Var(var, _) | Expr::Pre(var, _)) = flat.exprs[id] else {
        return None;
    };
    let VariableKind::Reduction(number) = flat.variables[var].kind else {
        return Some(Expr::Var(var, Index::SCALAR));
    };
    let value = flat.exprs[flat.experiment.reductions.get(number)?.value];
    Some(if let Expr::Var(var, _) = value {
        Expr::Var(var, Index::SCALAR)
    } else {
        value
    })
}

/// 0 K in a unit with a zero point: `-273.15 degC`.
pub(crate) fn absolute_zero(unit: Unit, text: &UnitText) -> String {
    format!("{} {}", significant(unit.from_si(0.0), 7), text.text)
}

/// What to say of a literal in degC that is added: its zero point is added as well.
pub(crate) fn added_as_difference(op: BinaryOp, (a, b): (&Typed, &Typed)) -> Option<Diagnostic> {
    let both = a.difference.is_some() && b.difference.is_some();
    if op == BinaryOp::Sub || both {
        return None;
    }
    // A literal that comes first is what a difference is added to, `20 [degC] + rise`, unless the other counts from a zero
    // point too.
    let of_literal = |(literal, other): (&Typed, &Typed), first: bool| {
        let counts = match other.zero {
            Zero::Own => true,
            Zero::Open => !first,
            Zero::Opposite | Zero::Difference | Zero::Perhaps => false,
        };
        let may = literal.zero == Zero::Own && counts;
        let text = may.then(|| as_difference(literal));
        Some((literal.span, text??))
    };
    let (span, text) = of_literal((b, a), false).or_else(|| of_literal((a, b), true))?;
    Some(refused::zero_point_counts(
        "added as a difference",
        span,
        &text,
    ))
}

/// What to say of a literal in degC that a number multiplies, twice 10 degC are 566.3 K, or that something without a temperature
/// divides: `5 [degC]/(10 [s])` is 27.8 K/s.
pub(crate) fn scaled(op: BinaryOp, (a, b): (&Typed, &Typed)) -> Option<Diagnostic> {
    if op == BinaryOp::Div && a.zero == Zero::Own && !is_number(b) && !is_open(b) {
        let text = as_difference(a).filter(|_| !has_temperature(b));
        return text.map(|text| refused::zero_point_counts("divided", a.span, &text));
    }
    let of_literal = |(literal, number): (&Typed, &Typed)| {
        let may = literal.zero == Zero::Own && is_number(number);
        let text = may.then(|| as_difference(literal));
        Some((literal.span, text??))
    };
    let swapped = || (op == BinaryOp::Mul).then(|| of_literal((b, a))).flatten();
    let (span, text) = of_literal((a, b)).or_else(swapped)?;
    Some(refused::zero_point_counts(
        "multiplied by a number",
        span,
        &text,
    ))
}

fn is_open(value: &Typed) -> bool {
    value.dim.as_known().is_none()
}

fn has_temperature(value: &Typed) -> bool {
    let known = value.dim.as_known();
    let exponents = known.and_then(Dimension::si_exponents);
    exponents.is_none_or(|[.., kelvin, _, _, _]| kelvin != 0)
}

fn is_number(value: &Typed) -> bool {
    let known = value.dim.as_known();
    known.is_some_and(Dimension::is_dimensionless)
}

/// What to say of a literal in degC that is the step of a grid.
pub(crate) fn as_step(step: &Typed) -> Option<Diagnostic> {
    let may = step.zero == Zero::Own;
    let text = may.then(|| as_difference(step))??;
    Some(refused::zero_point_counts(
        "the step of a grid",
        step.span,
        &text,
    ))
}

/// What to say of a difference that is held against a temperature with a zero point: that is 273.15 K too high.
pub(crate) fn beside_difference(a: &Typed, b: &Typed, sources: &Sources) -> Option<Diagnostic> {
    let (difference, own) = match (a.zero, b.zero) {
        (Zero::Difference, Zero::Own) => (a, b),
        (Zero::Own, Zero::Difference) => (b, a),
        _ => return None,
    };
    let help = match as_difference(own) {
        Some(text) => format!("write `{text}` for a difference"),
        None => without_zero_point(own, sources),
    };
    Some(refused::beside_difference(difference.span, own.span, &help))
}

/// What to say of a noise or a band that counts from a zero point.
pub(crate) fn as_width(width: &Typed, sources: &Sources) -> Option<Diagnostic> {
    let own = width.zero == Zero::Own;
    own.then(|| refused::zero_point_of_width(width.span, &without_zero_point(width, sources)))
}

fn without_zero_point(own: &Typed, sources: &Sources) -> String {
    let unit = own.dim.as_known().map(|dim| dim.usual_unit());
    format!(
        "declare `{}` in {}, without a zero point, if it is a difference",
        sources.text(own.span),
        unit.unwrap_or_default()
    )
}

/// The text of a literal as a difference: `5 [K]` of `5 [degC]` and of `9 [degF]`; `None` of what is no literal.
fn as_difference(literal: &Typed) -> Option<String> {
    let si = significant(literal.difference?, 10);
    let unit = literal.dim.as_known()?.usual_unit();
    Some(format!("{si} [{unit}]"))
}

/// What is set to a difference is shown as one: in K where its type says degC.
pub(crate) fn show_difference(
    flat: &mut FlatModel,
    notes: &mut [VariableNotes<'_>],
    (target, value): (&Typed, &Typed),
) {
    if value.zero != Zero::Difference {
        return;
    }
    let Expr::Var(var, _) = flat.exprs[target.id] else {
        return;
    };
    let quantity = &mut flat.variables[var].quantity;
    if quantity.unit.unit().is_absolute() {
        *quantity = Quantity::usual(quantity.dimension);
    }
    notes[var.index()].difference = true;
}
