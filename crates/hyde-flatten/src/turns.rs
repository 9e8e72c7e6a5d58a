//! Where turns become radians: a 2*pi that is lost, or that stands twice (U1).
//!
//! A radian is 1, and a product does not tell whether it is meant: `w*r` is a speed, `w^2*r` an acceleration. So angles
//! are compared where a quantity stands alone: a number with its unit, a name, the derivative of one, their sums, their
//! whole multiples. In a product three things are seen all the same: `2*pi*lead*phi` has the turn twice, `lead*f` is per
//! radian and counts turns, and the sine of `f*time` is that of turns.

use crate::dimension::Dim;
use crate::instance::Typed;
use crate::refusals::dimensions as refused;
use crate::shown::quantity_of;
use hyde_diag::{Diagnostic, Diagnostics, Sources};
use hyde_ir::FlatModel;
use hyde_units::{AngleExponent, Dimension, with_angle_of};
use std::f64::consts::TAU;

/// What is known of turns in an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Turns {
    /// Nothing.
    Plain,
    /// `2*pi`.
    TwoPi,
    /// `2*pi*lead`, the advance of a turn.
    PerTurn,
    /// `f*time`, a number of turns.
    Counted,
    /// `lead*f`, per radian times turns.
    Lost,
}

/// What a side of a comparison is, as far as a repair can name it.
#[derive(Clone, Debug)]
pub(crate) enum Said {
    /// A number and its unit, as written.
    Literal(String, String),
    /// A variable or a parameter, and its unit.
    Name(String, String),
    /// Anything else.
    Expression,
}

/// The sides of an operation: what they are made of and how they are written.
#[derive(Clone, Copy)]
pub(crate) struct Sides<'m> {
    sources: &'m Sources,
    flat: &'m FlatModel,
}

impl<'m> Sides<'m> {
    pub(crate) fn new(sources: &'m Sources, flat: &'m FlatModel) -> Self {
        Self { sources, flat }
    }

    /// The dimension of a product or a quotient, and what is known of turns in it; what is doubtful is told.
    pub(crate) fn product(
        self,
        (a, b): (&Typed, &Typed),
        divides: bool,
        diagnostics: &mut Diagnostics,
    ) -> (Dim, Turns) {
        let raw = match divides {
            true => a.dim.divide(&b.dim),
            false => a.dim.multiply(&b.dim),
        };
        if a.bare && b.bare {
            let constant = |side: &Typed| self.flat.exprs.as_constant(side.id);
            let is_turn = match (constant(a), constant(b)) {
                (Some(a), Some(b)) => !divides && (a * b).to_bits() == TAU.to_bits(),
                _ => false,
            };
            return (raw, if is_turn { Turns::TwoPi } else { Turns::Plain });
        }
        if self.is_whole_factor(b) {
            return (raw, a.turns);
        }
        if !divides && self.is_whole_factor(a) {
            return (raw, b.turns);
        }
        let turns = match divides {
            true => turns_of_quotient(a, b, diagnostics),
            false => self.turns_of_product(a, b, diagnostics),
        };
        (raw.composed(), turns)
    }

    /// Whether a number or its reciprocal is whole, so that it is no hidden 2*pi.
    fn is_whole_factor(self, typed: &Typed) -> bool {
        let value = self.flat.exprs.as_constant(typed.id);
        typed.bare
            && value.is_some_and(|value| value.fract() == 0.0 || value.recip().fract() == 0.0)
    }

    fn turns_of_product(self, a: &Typed, b: &Typed, diagnostics: &mut Diagnostics) -> Turns {
        for (one, other) in [(a, b), (b, a)] {
            match one.turns {
                Turns::TwoPi if is_per_angle(other) => return Turns::PerTurn,
                Turns::PerTurn if is_turned(other) => {
                    diagnostics.push(refused::turn_applied_twice(one.span, other.span));
                    return Turns::Plain;
                }
                Turns::Lost if has_no_angle(other) => return Turns::Lost,
                Turns::Plain | Turns::TwoPi | Turns::PerTurn | Turns::Counted | Turns::Lost => {}
            }
            if is_hertz(one) && is_per_angle(other) {
                return Turns::Lost;
            }
            let over_time = other.dim.as_known() == Some(Dimension::TIME);
            if is_hertz(one) && over_time && !self.may_be_radians(one) {
                return Turns::Counted;
            }
        }
        Turns::Plain
    }

    /// `lead*f` beside what has its angle: the 2*pi between them is lost.
    pub(crate) fn lost_turn(self, a: &Typed, b: &Typed) -> Option<Diagnostic> {
        let angle = |typed: &Typed| Some(typed.dim.as_known()?.angle());
        let (lost, other) = match (a.turns, b.turns) {
            (Turns::Lost, Turns::Lost) => return None,
            (Turns::Lost, _) => (a, b),
            (_, Turns::Lost) => (b, a),
            _ => return None,
        };
        let (AngleExponent::Composed(has), AngleExponent::Known(wanted)) =
            (angle(lost)?, angle(other)?)
        else {
            return None;
        };
        (has != wanted).then(|| refused::lost_turn(lost.span, &self.text_as_factor(lost)))
    }

    /// `sin(f*time)`: of turns.
    pub(crate) fn sine_of_turns(self, function: &str, argument: &Typed) -> Option<Diagnostic> {
        if argument.turns != Turns::Counted {
            return None;
        }
        let text = self.text_as_factor(argument);
        Some(refused::sine_of_turns(function, argument.span, &text))
    }

    fn text_as_factor(self, typed: &Typed) -> String {
        let text = self.sources.text(typed.span);
        match text.contains(['+', '-', ' ']) {
            true => format!("({text})"),
            false => text.to_owned(),
        }
    }

    /// `20 [1/s]` may be an angular velocity, the radian left out; `20 [Hz]` and `1200 [1/min]` count turns.
    fn may_be_radians(self, typed: &Typed) -> bool {
        match self.said(typed) {
            Said::Literal(_, unit) | Said::Name(_, unit) => unit.starts_with("1/s"),
            Said::Expression => false,
        }
    }

    /// What a side of a comparison is, for a repair.
    pub(crate) fn said(self, typed: &Typed) -> Said {
        let text = self.sources.text(typed.span);
        if text.parse::<f64>().is_ok() {
            return Said::Literal(text.to_owned(), "1".to_owned());
        }
        if let Some((number, unit)) = text.split_once('[')
            && let Some(unit) = unit.strip_suffix(']')
            && number.trim().parse::<f64>().is_ok()
        {
            return Said::Literal(number.trim().to_owned(), unit.trim().to_owned());
        }
        let Some(quantity) = quantity_of(self.flat, typed.id) else {
            return Said::Expression;
        };
        let is_name = text
            .chars()
            .all(|c| c.is_alphanumeric() || matches!(c, '_' | '.'));
        match is_name {
            true => Said::Name(text.to_owned(), quantity.unit.text().to_owned()),
            false => Said::Expression,
        }
    }
}

fn turns_of_quotient(a: &Typed, b: &Typed, diagnostics: &mut Diagnostics) -> Turns {
    if is_per_angle(a) && b.turns == Turns::TwoPi {
        diagnostics.push(refused::turn_divided_twice(
            (a.span, a.dim.as_known()),
            b.span,
        ));
    }
    match a.turns {
        Turns::Lost if has_no_angle(b) => Turns::Lost,
        Turns::Plain | Turns::TwoPi | Turns::PerTurn | Turns::Counted | Turns::Lost => Turns::Plain,
    }
}

/// Per angle, as a lead is; what is computed may have its angle from a quotient such as `a/w^2`.
fn is_per_angle(typed: &Typed) -> bool {
    matches!(typed.dim.as_known().map(Dimension::angle), Some(AngleExponent::Known(e)) if e.is_negative())
}

/// An angle, or how fast one changes.
fn is_turned(typed: &Typed) -> bool {
    let angle = typed.dim.as_known().map(Dimension::angle);
    matches!(angle, Some(AngleExponent::Known(e) | AngleExponent::Composed(e)) if !e.is_zero() && !e.is_negative())
}

fn has_no_angle(typed: &Typed) -> bool {
    matches!(typed.dim.as_known().map(Dimension::angle), Some(AngleExponent::Known(e)) if e.is_zero())
}

/// Turns a second, or what is in 1/s.
fn is_hertz(typed: &Typed) -> bool {
    typed.dim.as_known() == Some(Dimension::FREQUENCY)
}

/// What to write where two sides differ in their angles alone: of the value that is bound to a declared type, else of the
/// side that counts turns.
pub(crate) fn repair(what: &str, a: Dimension, b: Dimension, said: &(Said, Said)) -> String {
    let (left, right) = ((&said.0, a, b), (&said.1, b, a));
    let turns = |side: &(&Said, Dimension, Dimension)| matches!(side.1.angle(), AngleExponent::Known(e) if e.is_zero());
    let (first, second) = match what.starts_with(DECLARED) || turns(&right) {
        true => (right, left),
        false => (left, right),
    };
    let bound = what.starts_with(DECLARED);
    instead(first)
        .or_else(|| instead(second).filter(|_| !bound))
        .unwrap_or_else(|| match turns(&left) || turns(&right) {
            true => "multiply the number of turns by 2*pi, or give the angle its unit: `1 [rad]`, `1 [rev]`".to_owned(),
            false => "check which of the two is per radian".to_owned(),
        })
}

/// How a demand begins whose left side is a declaration.
const DECLARED: &str = "the declared type";

/// What to write for one side, so that it has the angle that is wanted.
fn instead((said, is, wanted): (&Said, Dimension, Dimension)) -> Option<String> {
    match said {
        Said::Literal(number, unit) => {
            let written: Vec<String> = with_angle_of(unit, wanted)
                .iter()
                .map(|unit| format!("`{number} [{unit}]`"))
                .collect();
            match written.as_slice() {
                [turns, radians] => Some(format!(
                    "write {turns} if it counts turns, {radians} if radians"
                )),
                [only] => Some(format!("write {only}")),
                _ => None,
            }
        }
        Said::Name(name, unit) => {
            let (AngleExponent::Known(has), AngleExponent::Known(wanted_angle)) =
                (is.angle(), wanted.angle())
            else {
                return None;
            };
            if !has.is_zero() {
                return None;
            }
            let factor = match wanted_angle.is_negative() {
                true => format!("`{name}/(2*pi)`"),
                false => format!("`2*pi*{name}`"),
            };
            let help = format!("write {factor} if `{name}` counts turns");
            Some(match with_angle_of(unit, wanted).first() {
                Some(unit) => format!("{help}, or give `{name}` the unit `{unit}`"),
                None => help,
            })
        }
        Said::Expression => None,
    }
}
