//! Expressions as Modelica writes them. A truth of the IR is a number, 1 or 0; here it is a Boolean where one is wanted.

use crate::mode_number;
use crate::names::{Names, mode_name};
use hyde_ir::dae::Dae;
use hyde_ir::{BinaryOp, Expr, ExprId, UnaryOp, VarId};
use std::collections::HashMap;

/// Where an expression stands.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// In an equation.
    Equation,
    /// In what an event sets: unknowns and memory are as they were before it.
    Event,
    /// In a condition: modes are as they were before the event.
    Condition,
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
                match place == Place::Event && self.is_kept(var) {
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
                    Place::Event | Place::Condition => before(name),
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

    /// Whether a variable keeps its value before an event: a state or memory.
    fn is_kept(&self, var: VarId) -> bool {
        let place = self.dae.place(var);
        place.is_some_and(|own| match own.space {
            hyde_ir::dae::Space::Memory => true,
            hyde_ir::dae::Space::Unknown => is_state(self.dae, own.base),
            hyde_ir::dae::Space::Input
            | hyde_ir::dae::Space::Work
            | hyde_ir::dae::Space::Parameter => false,
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
        BinaryOp::FloorTo => format!("(floor({a}/{b})*{b})"),
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
