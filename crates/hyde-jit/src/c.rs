//! The kernels as C11: the same routines as the machine code, as functions over plain arrays.
//!
//! ```text
//! static void hy_NAME(double t, const double *y, const double *yp, const double *z, const double *u,
//!                     const double *p, double *w, double *out)
//! ```
//! A step over a range is a loop; what several scalar steps share is computed once. Quantisers, minimum and truths are
//! written as the table of operations says; the functions of `<math.h>` stand for those of the library that the machine code
//! calls, and may differ from them in the last digit.

use crate::compiled::routines;
use crate::routine::{Leaf, Routine, Slot, Step};
use crate::wanted::is_truth;
use hyde_ir::{BinaryOp, Dae, Expr, ExprId, UnaryOp};
use rustc_hash::{FxHashMap, FxHashSet};
use std::fmt::Write as _;

/// Functions that operations call, which C has not.
const FUNCTIONS: &str = "\
static double hy_floor_to(double a, double b) { double q = a / b; return (fabs(q - round(q)) <= 4 * 0x1p-52 * fabs(q) ? round(q) : floor(q)) * b; }
static double hy_round_to(double a, double b) { return floor(a / b + 0.5) * b; }
static double hy_min(double a, double b) { return b < a ? b : a; }
static double hy_max(double a, double b) { return b > a ? b : a; }
";

/// The functions of all kernels that a fixed-step run needs: `hy_residual`, `hy_residual_partials`, `hy_roots`,
/// `hy_assignments`, `hy_conditions`, `hy_outputs` (those chosen, in their order), `hy_tick_0` and so on, and `hy_parameters`,
/// which computes the parameters that follow from others and are not given.
#[must_use]
pub fn emit_c(dae: &Dae, outputs: &[usize]) -> String {
    let mut text = String::new();
    let wanted = [
        "residual",
        "residual_partials",
        "roots",
        "assignments",
        "conditions",
    ];
    let made = routines(dae);
    let mut body = String::new();
    for name in wanted {
        match made.iter().find(|routine| routine.name == name) {
            Some(routine) => body.push_str(&function(dae, routine)),
            None => body.push_str(&function(dae, &Routine::plain(name, Vec::new()))),
        }
    }
    let mut chosen = Routine::some_rows(dae, hyde_ir::dae::Function::Outputs, outputs);
    "outputs".clone_into(&mut chosen.name);
    body.push_str(&function(dae, &chosen));
    for routine in made.iter().filter(|routine| routine.tick.is_some()) {
        body.push_str(&function(dae, routine));
    }
    body.push_str(&parameters(dae));
    for line in FUNCTIONS.lines() {
        let name = line.trim_start_matches("static double ");
        let name = name.split('(').next().unwrap_or_default();
        if body.contains(&format!("{name}(")) {
            let _ = writeln!(text, "{line}");
        }
    }
    text + &body
}

/// The parameters that follow from others.
fn parameters(dae: &Dae) -> String {
    let mut writer = Writer::new();
    let routine = Routine::plain("parameters", Vec::new());
    for &param in &dae.parameter_order {
        for step in Routine::parameter(dae, param).steps {
            if dae.exprs.as_constant(step.value).is_some() {
                continue;
            }
            writer.parameter(dae, &routine, &step);
        }
    }
    format!(
        "\nstatic void hy_parameters(const unsigned char *given, double *p)\n{{\n    (void)given;\n    (void)p;\n{}}}\n",
        writer.text
    )
}

fn function(dae: &Dae, routine: &Routine) -> String {
    let mut writer = Writer::new();
    for step in &routine.steps {
        writer.step(dae, routine, step);
    }
    let mut unused = String::new();
    for name in ["t", "y", "yp", "z", "u", "p", "w", "out"] {
        let _ = writeln!(unused, "    (void){name};");
    }
    format!(
        "\nstatic void hy_{}(double t, const double *y, const double *yp, const double *z, const double *u,\n    \
         const double *p, double *w, double *out)\n{{\n{unused}{}}}\n",
        routine.name, writer.text
    )
}

/// The body of a function.
struct Writer {
    text: String,
    /// Nodes that have a name for the rest of the function.
    known: FxHashMap<ExprId, String>,
    /// Nodes that change with the counter.
    moving: FxHashSet<ExprId>,
    next: usize,
}

impl Writer {
    fn new() -> Self {
        Self {
            text: String::new(),
            known: FxHashMap::default(),
            moving: FxHashSet::default(),
            next: 0,
        }
    }

    fn step(&mut self, dae: &Dae, routine: &Routine, step: &Step) {
        let slot = if step.slot == Slot::Work { "w" } else { "out" };
        if step.range.len() == 1 {
            let counter = step.range.first;
            let mut local = FxHashMap::default();
            let value = self.value(dae, routine, step.value, Some(counter), &mut local);
            let _ = writeln!(
                self.text,
                "    {slot}[{}] = {value};",
                step.target.at(counter)
            );
        } else {
            let (first, last) = (step.range.first, step.range.last);
            let _ = writeln!(self.text, "    for (int i = {first}; i <= {last}; ++i) {{");
            let mut local = FxHashMap::default();
            let value = self.value(dae, routine, step.value, None, &mut local);
            let target = element(step.target.stride, step.target.offset);
            let _ = writeln!(self.text, "    {slot}[{target}] = {value};\n    }}");
        }
        if routine.tick.is_some() {
            // Later assignments of the tick read what was just written.
            self.known.clear();
        }
    }

    fn parameter(&mut self, dae: &Dae, routine: &Routine, step: &Step) {
        let (first, last) = (step.range.first, step.range.last);
        let target = element(step.target.stride, step.target.offset);
        let _ = writeln!(self.text, "    for (int i = {first}; i <= {last}; ++i) {{");
        let _ = writeln!(self.text, "    if (!given[{target}]) {{");
        let value = self.value(dae, routine, step.value, None, &mut FxHashMap::default());
        let _ = writeln!(self.text, "    p[{target}] = {value};\n    }}\n    }}");
    }

    /// The name or literal of the value of a node; the code of what it needs is written before.
    fn value(
        &mut self,
        dae: &Dae,
        routine: &Routine,
        root: ExprId,
        counter: Option<i32>,
        local: &mut FxHashMap<ExprId, String>,
    ) -> String {
        // Only at the top level may a name be kept: a loop is a block of its own.
        let keeps = counter.is_some() && routine.name != "parameters";
        for id in dae.exprs.below(&[root]) {
            if local.contains_key(&id) {
                continue;
            }
            if keeps && let Some(known) = self.known.get(&id) {
                local.insert(id, known.clone());
                continue;
            }
            let expr = dae.exprs[id];
            let named = if let Expr::NoEvent(inner) = expr {
                local[&inner].clone()
            } else if let Some(leaf) = routine.leaf(dae, expr) {
                of_leaf(leaf, counter)
            } else {
                let code = operation(dae, expr, local);
                let name = format!("v{}", self.next);
                self.next += 1;
                let kind = if is_truth(expr) { "int" } else { "double" };
                let _ = writeln!(self.text, "    const {kind} {name} = {code};");
                name
            };
            local.insert(id, named);
        }
        if keeps {
            for id in dae.exprs.below(&[root]) {
                let mut moves = match routine.leaf(dae, dae.exprs[id]) {
                    Some(Leaf::Counter) => true,
                    Some(Leaf::Load(_, index)) => index.stride != 0,
                    Some(Leaf::Number(_) | Leaf::Time | Leaf::IsMode(..)) | None => false,
                };
                dae.exprs[id].for_each_child(|child| moves |= self.moving.contains(&child));
                if moves {
                    self.moving.insert(id);
                } else {
                    self.known.insert(id, local[&id].clone());
                }
            }
        }
        local[&root].clone()
    }
}

fn of_leaf(leaf: Leaf, counter: Option<i32>) -> String {
    match leaf {
        Leaf::Number(value) => number(value),
        Leaf::Time => "t".to_owned(),
        Leaf::Counter => match counter {
            Some(counter) => number(f64::from(counter)),
            None => "(double)i".to_owned(),
        },
        Leaf::IsMode(place, mode) => format!("(z[{place}] == {mode}.0)"),
        Leaf::Load(slot, index) => {
            let name = if slot == Slot::Work {
                "w"
            } else {
                slot.letter()
            };
            match counter {
                Some(counter) => format!("{name}[{}]", index.at(counter)),
                None => format!("{name}[{}]", element(index.stride, index.offset)),
            }
        }
    }
}

fn element(stride: i32, offset: i32) -> String {
    match (stride, offset) {
        (0, offset) => offset.to_string(),
        (1, 0) => "i".to_owned(),
        (1, offset) => format!("i + {offset}"),
        (stride, offset) => format!("{stride} * i + {offset}"),
    }
}

fn operation(dae: &Dae, expr: Expr, named: &FxHashMap<ExprId, String>) -> String {
    let truth = |id: ExprId| match is_truth(dae.exprs[id]) {
        true => named[&id].clone(),
        false => format!("({} != 0.0)", named[&id]),
    };
    let value = |id: ExprId| match is_truth(dae.exprs[id]) {
        true => format!("(double){}", named[&id]),
        false => named[&id].clone(),
    };
    match expr {
        Expr::Unary(UnaryOp::Not, a) => format!("!{}", truth(a)),
        Expr::Unary(op, a) => {
            let a = value(a);
            match op {
                UnaryOp::Neg => format!("-{a}"),
                UnaryOp::Abs => format!("fabs({a})"),
                UnaryOp::Not => format!("!{a}"),
                UnaryOp::Sqrt
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
        Expr::Binary(BinaryOp::And, a, b) => format!("{} && {}", truth(a), truth(b)),
        Expr::Binary(BinaryOp::Or, a, b) => format!("{} || {}", truth(a), truth(b)),
        Expr::Binary(op, a, b) => {
            let (a, b) = (value(a), value(b));
            match op {
                BinaryOp::Pow => format!("pow({a}, {b})"),
                BinaryOp::Atan2 => format!("atan2({a}, {b})"),
                BinaryOp::Min => format!("hy_min({a}, {b})"),
                BinaryOp::Max => format!("hy_max({a}, {b})"),
                BinaryOp::FloorTo => format!("hy_floor_to({a}, {b})"),
                BinaryOp::RoundTo => format!("hy_round_to({a}, {b})"),
                BinaryOp::Ne => format!("{a} != {b}"),
                BinaryOp::Add
                | BinaryOp::Sub
                | BinaryOp::Mul
                | BinaryOp::Div
                | BinaryOp::Lt
                | BinaryOp::Le
                | BinaryOp::Gt
                | BinaryOp::Ge
                | BinaryOp::Eq
                | BinaryOp::And
                | BinaryOp::Or => format!("{a} {} {b}", op.name()),
            }
        }
        Expr::If(c, a, b) => format!("{} ? {} : {}", truth(c), value(a), value(b)),
        Expr::Const(_)
        | Expr::Time
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Var(..)
        | Expr::Der(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..)
        | Expr::NoEvent(_) => "0.0".to_owned(),
    }
}

/// A number as C reads it, with all its digits.
fn number(value: f64) -> String {
    if value.is_nan() {
        return "(double)NAN".to_owned();
    }
    if value.is_infinite() {
        let sign = if value < 0.0 { "-" } else { "" };
        return format!("({sign}(double)INFINITY)");
    }
    match value.is_sign_negative() {
        true => format!("({value:?})"),
        false => format!("{value:?}"),
    }
}
