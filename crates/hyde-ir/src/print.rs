//! Prints both stages as text: array equations with their range, never their elements; every line with its origin.

mod dae;
mod flat;
mod structure;

pub use dae::print_dae;
pub use flat::print_flat;
pub use structure::print_structure;

use crate::expr::{Expr, ExprArena, Index, Number, Range};
use crate::id::{AutomatonId, ExprId, IdVec, ParamId, RelationId, VarId};
use crate::{BinaryOp, Parameter, UnaryOp, Variable};
use hyde_diag::{MadeBy, Origin, Sources};

/// Longer expressions are cut; the arena shares what the text would repeat.
const MAX_NODES: usize = 400;

/// The names an expression is printed with.
pub struct Names<'a> {
    /// The expressions.
    pub exprs: &'a ExprArena,
    /// The variables.
    pub variables: &'a IdVec<VarId, Variable>,
    /// The parameters.
    pub parameters: &'a IdVec<ParamId, Parameter>,
    /// Name of an automaton and of one of its modes.
    pub mode: &'a dyn Fn(AutomatonId, u32) -> String,
    /// Text of a relation.
    pub relation: &'a dyn Fn(RelationId) -> String,
}

impl Names<'_> {
    /// An expression as text.
    #[must_use]
    pub fn expr(&self, id: ExprId) -> String {
        let mut budget = MAX_NODES;
        self.text(id, 0, &mut budget)
    }

    /// An element of a variable, `th[i+1]`.
    #[must_use]
    pub fn element(&self, var: VarId, index: Index) -> String {
        let variable = &self.variables[var];
        match variable.len {
            None => variable.name.clone(),
            Some(_) => format!("{}[{}]", variable.name, subscript(index, variable.first)),
        }
    }

    fn text(&self, id: ExprId, least: u8, budget: &mut usize) -> String {
        if *budget == 0 {
            return "…".to_owned();
        }
        *budget -= 1;
        let expr = self.exprs[id];
        let text = match expr {
            Expr::Const(Number(value)) => number(value),
            Expr::Time => "time".to_owned(),
            Expr::Counter => "i".to_owned(),
            Expr::Param(param, index) => {
                let parameter = &self.parameters[param];
                match parameter.len {
                    None => parameter.name.clone(),
                    Some(_) => format!("{}[{}]", parameter.name, subscript(index, 1)),
                }
            }
            Expr::Var(var, index) => self.element(var, index),
            Expr::Der(var, index) => format!("der({})", self.element(var, index)),
            Expr::Pre(var, index) => format!("pre({})", self.element(var, index)),
            Expr::Relation(relation) => format!("«{}»", (self.relation)(relation)),
            Expr::InMode(automaton, mode) => format!("in {}", (self.mode)(automaton, mode)),
            Expr::NoEvent(a) => format!("noEvent({})", self.text(a, 0, budget)),
            Expr::Unary(UnaryOp::Neg, a) => format!("-{}", self.text(a, 7, budget)),
            Expr::Unary(UnaryOp::Not, a) => format!("not {}", self.text(a, 7, budget)),
            Expr::Unary(op, a) => format!("{}({})", op.name(), self.text(a, 0, budget)),
            Expr::Binary(op, a, b) => match level(expr) {
                9 => format!(
                    "{}({}, {})",
                    op.name(),
                    self.text(a, 0, budget),
                    self.text(b, 0, budget)
                ),
                level => {
                    let left = self.text(a, level, budget);
                    let right = self.text(b, level + 1, budget);
                    let tight = matches!(op, BinaryOp::Mul | BinaryOp::Div | BinaryOp::Pow);
                    let space = if tight { "" } else { " " };
                    format!("{left}{space}{}{space}{right}", op.name())
                }
            },
            Expr::If(c, a, b) => format!(
                "if {} then {} else {}",
                self.text(c, 0, budget),
                self.text(a, 0, budget),
                self.text(b, 0, budget)
            ),
        };
        if level(expr) < least {
            format!("({text})")
        } else {
            text
        }
    }
}

/// `for i in 1..23: ` before an array equation; nothing before a scalar one.
fn counted(range: Range) -> String {
    if range == Range::SCALAR {
        String::new()
    } else {
        format!("for i in {}..{}: ", range.first, range.last)
    }
}

/// `  // screw axis.hyde:64`, with who made it where that is not the source.
fn comment(origin: &Origin, sources: &Sources) -> String {
    let made_by = match origin.made_by {
        MadeBy::Source => "",
        MadeBy::Connection => " connect",
        MadeBy::Unconnected => " unconnected",
        MadeBy::Binding => " binding",
        MadeBy::Discretization => " discretize",
        MadeBy::Derivative => " derivative",
        MadeBy::Pin => " pin",
        MadeBy::Start => " start",
        MadeBy::Expression => " named",
        MadeBy::Experiment => " experiment",
    };
    let instance = if origin.instance.as_str().is_empty() {
        String::new()
    } else {
        format!("{} ", origin.instance)
    };
    format!("  // {instance}{}{made_by}", sources.place(origin.span))
}

fn subscript(index: Index, first: i32) -> String {
    let offset = index.offset + first;
    let counter = match index.stride {
        0 => return offset.to_string(),
        1 => "i".to_owned(),
        -1 => "-i".to_owned(),
        stride => format!("{stride}*i"),
    };
    match offset {
        0 => counter,
        offset if offset > 0 => format!("{counter}+{offset}"),
        offset => format!("{counter}{offset}"),
    }
}

fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e6).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

fn level(expr: Expr) -> u8 {
    match expr {
        Expr::If(..) => 0,
        Expr::Unary(UnaryOp::Neg, _) => 6,
        Expr::Unary(UnaryOp::Not, _) => 3,
        Expr::Const(Number(value)) if value < 0.0 => 6,
        Expr::Binary(op, ..) => match op {
            BinaryOp::Or => 1,
            BinaryOp::And => 2,
            BinaryOp::Lt
            | BinaryOp::Le
            | BinaryOp::Gt
            | BinaryOp::Ge
            | BinaryOp::Eq
            | BinaryOp::Ne => 4,
            BinaryOp::Add | BinaryOp::Sub => 5,
            BinaryOp::Mul | BinaryOp::Div => 7,
            BinaryOp::Pow => 8,
            BinaryOp::Min
            | BinaryOp::Max
            | BinaryOp::Atan2
            | BinaryOp::FloorTo
            | BinaryOp::RoundTo => 9,
        },
        Expr::Const(_)
        | Expr::Time
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Var(..)
        | Expr::Der(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..)
        | Expr::Unary(..)
        | Expr::NoEvent(_) => 9,
    }
}
