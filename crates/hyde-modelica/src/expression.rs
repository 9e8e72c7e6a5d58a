//! Expressions as Modelica writes them. A truth of the IR is a number, 1 or 0; here it is a Boolean where one is wanted.

use crate::mode_number;
use crate::names::{Names, mode_name};
use hyde_ir::dae::{Dae, Space};
use hyde_ir::{BinaryOp, Expr, ExprId, UnaryOp, VarId};
use std::collections::HashMap;

/// Where an expression stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// In an equation.
    Equation,
    /// In what an event sets: unknowns and memory are as they were before it.
    Event,
    /// In a condition: modes and memory are as they were before the event.
    Condition,
    /// In a tick of a clock: what other clocks hold, and what equations make of it, is as it was before the instant.
    Tick,
}

/// A node as it is written, and whether it is a Boolean.
type Node = (String, bool);

impl Names<'_> {
    /// A number in an equation, at a value of the counter.
    pub(crate) fn number(&self, id: ExprId, counter: i32) -> String {
        as_number(self.node(id, counter, Place::Equation))
    }

    /// A number that an event sets.
    pub(crate) fn set(&self, id: ExprId, counter: i32) -> String {
        as_number(self.node(id, counter, Place::Event))
    }

    /// A number that a tick of a clock sets.
    pub(crate) fn ticked(&self, id: ExprId, counter: i32) -> String {
        as_number(self.node(id, counter, Place::Tick))
    }

    /// A condition of an event.
    pub(crate) fn condition(&self, id: ExprId) -> String {
        as_truth(self.node(id, 0, Place::Condition))
    }

    fn node(&self, root: ExprId, counter: i32, place: Place) -> Node {
        let mut known: HashMap<ExprId, Node> = HashMap::new();
        for id in self.dae.exprs.below(&[root]) {
            let written = self.one(self.dae.exprs[id], counter, place, &known);
            known.insert(id, written);
        }
        known
            .remove(&root)
            .unwrap_or_else(|| ("0".to_owned(), false))
    }

    fn one(&self, expr: Expr, counter: i32, place: Place, known: &HashMap<ExprId, Node>) -> Node {
        let number = |id: ExprId| as_number(known[&id].clone());
        let truth = |id: ExprId| as_truth(known[&id].clone());
        let before = |name: String| format!("pre({name})");
        match expr {
            Expr::Const(value) => (literal(value.0), false),
            Expr::Time => ("time".to_owned(), false),
            Expr::Counter => (literal(f64::from(counter)), false),
            Expr::Param(param, at) => (self.parameter(param, at.at(counter)), false),
            Expr::Var(var, at) => {
                let name = self.variable(var, at.at(counter));
                let element = at.at(counter);
                let is_before = match place {
                    Place::Equation => false,
                    Place::Event => self.is_kept(var),
                    Place::Condition => self.is_memory(var),
                    Place::Tick => match self.made_of_held(var, element) {
                        Some((value, counter)) => return self.node(value, counter, place),
                        None => self.is_sampled(var, element),
                    },
                };
                match is_before {
                    true => (before(name), false),
                    false => (name, false),
                }
            }
            Expr::Der(var, at) => (
                format!("der({})", self.variable(var, at.at(counter))),
                false,
            ),
            Expr::Pre(var, at) => (before(self.variable(var, at.at(counter))), false),
            Expr::Relation(relation) => {
                let own = &self.dae.relations[relation];
                let sign = if own.inclusive { ">=" } else { ">" };
                let (root, _) = self.node(own.root, counter, place);
                (format!("({root} {sign} 0)"), true)
            }
            Expr::InMode(automaton, mode) => {
                let name = mode_name(&self.dae.automata[automaton].name);
                let name = match place {
                    Place::Equation => name,
                    Place::Event | Place::Condition | Place::Tick => before(name),
                };
                let mode = mode_number(usize::try_from(mode).unwrap_or(0));
                (format!("({name} == {mode})"), true)
            }
            Expr::NoEvent(inner) => {
                let (text, is_truth) = known[&inner].clone();
                (format!("noEvent({text})"), is_truth)
            }
            Expr::Unary(UnaryOp::Not, a) => (format!("(not {})", truth(a)), true),
            Expr::Unary(op, a) => (unary(op, &number(a)), false),
            Expr::Binary(BinaryOp::And, a, b) => (format!("({} and {})", truth(a), truth(b)), true),
            Expr::Binary(BinaryOp::Or, a, b) => (format!("({} or {})", truth(a), truth(b)), true),
            Expr::Binary(op, a, b) => (binary(op, &number(a), &number(b)), op.is_truth()),
            Expr::If(c, a, b) => (
                format!("(if {} then {} else {})", truth(c), number(a), number(b)),
                false,
            ),
        }
    }

    /// Whether a variable is remembered.
    fn is_memory(&self, var: VarId) -> bool {
        let place = self.dae.place(var);
        place.is_some_and(|own| own.space == Space::Memory)
    }

    /// Whether a tick changes a variable at the instant at which another one samples it: a held value, and an unknown that
    /// may follow from one. A state is not set in the same step of the iteration.
    fn is_sampled(&self, var: VarId, element: i32) -> bool {
        let Some(place) = self.dae.place(var) else {
            return false;
        };
        let position = place.base + usize::try_from(element).unwrap_or(0);
        match place.space {
            Space::Memory => {
                let mut holds = self.dae.holds.iter();
                holds.any(|hold| (hold.target..hold.target + hold.len).contains(&position))
            }
            Space::Unknown => self.dae.ticks.len() > 1 && !is_state(self.dae, position),
            Space::Work | Space::Input | Space::Parameter => false,
        }
    }

    /// What an element is defined as, with the counter there, if a held value is in it: its left limit is that of the held
    /// value.
    fn made_of_held(&self, var: VarId, element: i32) -> Option<(ExprId, i32)> {
        if !self.made_of_held.contains(&var) {
            return None;
        }
        let own = self.dae.definitions.iter().filter(|own| own.var == var);
        own.flat_map(|own| own.range.iter().map(move |counter| (own, counter)))
            .find(|(own, counter)| own.index.at(*counter) == element)
            .map(|(own, counter)| (own.value, counter))
    }

    /// Whether a variable keeps its value before an event: a state or memory.
    fn is_kept(&self, var: VarId) -> bool {
        let place = self.dae.place(var);
        place.is_some_and(|own| match own.space {
            Space::Memory => true,
            Space::Unknown => is_state(self.dae, own.base),
            Space::Input | Space::Work | Space::Parameter => false,
        })
    }
}

/// Whether the derivative of a position of the solver's vector appears.
pub(crate) fn is_state(dae: &Dae, position: usize) -> bool {
    let mut blocks = dae.unknowns.iter();
    blocks.any(|own| own.differential && (own.offset..own.offset + own.len).contains(&position))
}

fn as_number((text, is_truth): Node) -> String {
    match is_truth {
        true => format!("(if {text} then 1 else 0)"),
        false => text,
    }
}

fn as_truth((text, is_truth): Node) -> String {
    match is_truth {
        true => text,
        false => format!("({text} > 0.5)"),
    }
}

fn unary(op: UnaryOp, a: &str) -> String {
    match op {
        UnaryOp::Neg => format!("(-{a})"),
        UnaryOp::Not => format!("(not {a})"),
        UnaryOp::Abs
        | UnaryOp::Sqrt
        | UnaryOp::Floor
        | UnaryOp::Ceil
        | UnaryOp::Exp
        | UnaryOp::Log
        | UnaryOp::Log10
        | UnaryOp::Sin
        | UnaryOp::Cos
        | UnaryOp::Tan
        | UnaryOp::Asin
        | UnaryOp::Acos
        | UnaryOp::Atan
        | UnaryOp::Sinh
        | UnaryOp::Cosh
        | UnaryOp::Tanh => format!("{}({a})", op.name()),
    }
}

fn binary(op: BinaryOp, a: &str, b: &str) -> String {
    match op {
        BinaryOp::Min | BinaryOp::Max | BinaryOp::Atan2 => format!("{}({a}, {b})", op.name()),
        // Four roundings of a whole number count as that number.
        BinaryOp::FloorTo => format!("(floor({a}/{b} + 8.881784197001252e-16*abs({a}/{b}))*{b})"),
        BinaryOp::RoundTo => format!("(floor({a}/{b} + 0.5)*{b})"),
        // Reals are not compared for equality.
        BinaryOp::Eq => format!("(abs({a} - {b}) <= 0)"),
        BinaryOp::Ne => format!("(abs({a} - {b}) > 0)"),
        BinaryOp::Add
        | BinaryOp::Sub
        | BinaryOp::Mul
        | BinaryOp::Div
        | BinaryOp::Pow
        | BinaryOp::Lt
        | BinaryOp::Le
        | BinaryOp::Gt
        | BinaryOp::Ge
        | BinaryOp::And
        | BinaryOp::Or => format!("({a} {} {b})", op.name()),
    }
}

/// A number with all its digits.
pub(crate) fn literal(value: f64) -> String {
    if !value.is_finite() {
        let sign = if value < 0.0 { "-" } else { "" };
        return format!("({sign}1e300)");
    }
    match value < 0.0 {
        true => format!("({value:?})"),
        false => format!("{:?}", value + 0.0),
    }
}
