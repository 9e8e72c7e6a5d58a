//! The derivatives that the compiler makes, against derivatives by a complex step: each function of the equations is computed
//! with complex numbers, and the imaginary part of a value over that of an argument is the derivative, without the error of a
//! difference (Squire and Trapp, Using Complex Variables to Estimate Derivatives of Real Functions, SIAM Review 1998).

use crate::last_bit::Place;
use hyde_ir::dae::{Function, Space};
use hyde_ir::{BinaryOp, Dae, Expr, ExprId, Id as _, Index, Range, UnaryOp, VarId};
use hyde_program::{Function as Evaluated, Program, Workspace, Wrt};
use nalgebra::Complex;
use std::collections::HashMap;

/// The step: its square is nothing beside one.
const STEP: f64 = 1e-20;
/// How far a derivative may be off, as a part of the largest of its row, and of 1.
const OFF: f64 = 1e-9;

type Number = Complex<f64>;

/// The first derivative at a point that is not that of a complex step.
pub(super) fn wrong(dae: &Dae, program: &Program, at: &Place) -> Option<String> {
    for (function, evaluated) in [
        (Function::Residual, Evaluated::Residual),
        (Function::Roots, Evaluated::Roots),
        (Function::Assignments, Evaluated::Assignments),
        (Function::Outputs, Evaluated::Outputs),
        (Function::Delayed, Evaluated::Delayed),
    ] {
        let entries = program.partials(evaluated);
        let mut values = vec![0.0; entries.len()];
        let mut work = Workspace::new(program.n_work);
        program
            .kernels
            .partials(evaluated, at.point(), &mut work, &mut values);
        let rows = program.rows(evaluated);
        let mut largest = vec![1.0_f64; rows];
        let mut known: HashMap<(usize, Wrt), f64> = HashMap::new();
        for (entry, value) in entries.iter().zip(&values) {
            largest[entry.row] = largest[entry.row].max(value.abs());
            *known.entry((entry.row, entry.wrt)).or_default() += value;
        }
        let wrts = (0..program.n_unknowns)
            .flat_map(|k| [Wrt::Unknown(k), Wrt::Derivative(k)])
            .chain((0..dae.n_delayed()).map(Wrt::Delayed))
            // Nothing asks for the residual's derivative by the time.
            .chain((function != Function::Residual).then_some(Wrt::Time));
        for wrt in wrts {
            let step = Step { dae, at, wrt };
            let found = step.rows(function, rows);
            for (row, value) in found.iter().enumerate() {
                let exact = value.im / STEP;
                let own = known.get(&(row, wrt)).copied().unwrap_or(0.0);
                let off = (exact - own).abs();
                // A value that is not a number has no derivative.
                if value.re.is_finite()
                    && exact.is_finite()
                    && (off.is_nan() || off > OFF * largest[row].max(exact.abs()))
                {
                    return Some(format!(
                        "{function:?}, row {row}, by {wrt:?} ({}): {own:e}, by a complex step {exact:e}",
                        match wrt {
                            Wrt::Unknown(k) | Wrt::Derivative(k) => program.unknown_name(k),
                            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time =>
                                String::new(),
                        }
                    ));
                }
            }
        }
    }
    None
}

/// One argument with an imaginary part.
struct Step<'a> {
    dae: &'a Dae,
    at: &'a Place,
    wrt: Wrt,
}

impl Step<'_> {
    /// The values of a function.
    fn rows(&self, function: Function, count: usize) -> Vec<Number> {
        let dae = self.dae;
        let mut work = vec![Number::default(); dae.n_work];
        for definition in &dae.definitions {
            let base = dae.place(definition.var).map_or(0, |place| place.base);
            self.fill(
                definition.range,
                definition.value,
                definition.index,
                base,
                &mut work,
            );
        }
        let mut out = vec![Number::default(); count];
        for (range, index, value) in hyde_analysis::rows(dae, function) {
            for counter in range.iter() {
                let row = usize::try_from(index.at(counter)).unwrap_or(usize::MAX);
                out[row] = self.value(value, counter, &work);
            }
        }
        out
    }

    fn fill(&self, range: Range, value: ExprId, index: Index, base: usize, work: &mut [Number]) {
        for counter in range.iter() {
            let place = base + usize::try_from(index.at(counter)).unwrap_or(usize::MAX);
            work[place] = self.value(value, counter, work);
        }
    }

    fn value(&self, root: ExprId, counter: i32, work: &[Number]) -> Number {
        let exprs = &self.dae.exprs;
        let mut values: HashMap<ExprId, Number> = HashMap::new();
        for id in exprs.below(&[root]) {
            let value = match exprs[id] {
                Expr::Unary(op, a) => unary(op, values[&a]),
                Expr::Binary(op, a, b) => binary(op, values[&a], values[&b]),
                Expr::If(c, a, b) if values[&c].re == 0.0 => {
                    let _ = a;
                    values[&b]
                }
                Expr::If(_, a, _) | Expr::NoEvent(a) => values[&a],
                leaf @ (Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Param(..)
                | Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)) => self.leaf(leaf, counter, work),
            };
            values.insert(id, value);
        }
        values[&root]
    }

    fn leaf(&self, leaf: Expr, counter: i32, work: &[Number]) -> Number {
        let (dae, at) = (self.dae, self.at.point());
        let real = |value: f64| Number::new(value, 0.0);
        let moved =
            |value: f64, wrt: Wrt| Number::new(value, if wrt == self.wrt { STEP } else { 0.0 });
        let element = |base: usize, index: Index| {
            base + usize::try_from(index.at(counter)).unwrap_or(usize::MAX)
        };
        let base = |var: VarId| dae.place(var).map_or(usize::MAX, |place| place.base);
        match leaf {
            Expr::Const(number) => real(number.0),
            Expr::Time => moved(at.t, Wrt::Time),
            Expr::Counter => real(f64::from(counter)),
            Expr::Param(param, index) => real(at.p[element(dae.parameter_places[param], index)]),
            Expr::Var(var, index) => {
                let k = element(base(var), index);
                match dae.place(var).map(|place| place.space) {
                    Some(Space::Unknown) => moved(at.y[k], Wrt::Unknown(k)),
                    Some(Space::Memory) => real(at.z[k]),
                    Some(Space::Input) => match k.checked_sub(2 * dae.columns.len()) {
                        Some(delayed) => moved(at.u[k], Wrt::Delayed(delayed)),
                        None => real(at.u[k]),
                    },
                    Some(Space::Work) => work[k],
                    Some(Space::Parameter) => real(at.p[k]),
                    None => real(f64::NAN),
                }
            }
            Expr::Der(var, index) => {
                let k = element(base(var), index);
                moved(at.yp[k], Wrt::Derivative(k))
            }
            Expr::Pre(var, index) => real(at.z[element(base(var), index)]),
            Expr::Relation(relation) => real(at.z[relation.index()]),
            Expr::InMode(automaton, mode) => {
                let own = at.z[dae.automata[automaton].place];
                real(f64::from(u8::from(
                    own.to_bits() == f64::from(mode).to_bits(),
                )))
            }
            Expr::Unary(..) | Expr::Binary(..) | Expr::If(..) | Expr::NoEvent(_) => real(f64::NAN),
        }
    }
}

fn truth(condition: bool) -> Number {
    Number::new(f64::from(u8::from(condition)), 0.0)
}

/// An operation on a complex number. Inverse functions, whose complex form loses a step so small, take it to first order.
fn unary(op: UnaryOp, a: Number) -> Number {
    let real = op.apply(a.re);
    let by = |slope: f64| Number::new(real, slope * a.im);
    match op {
        UnaryOp::Neg => -a,
        UnaryOp::Not | UnaryOp::Floor | UnaryOp::Ceil => Number::new(real, 0.0),
        UnaryOp::Abs if a.re < 0.0 => -a,
        UnaryOp::Abs => a,
        UnaryOp::Sqrt => by(0.5 / real),
        UnaryOp::Exp => Number::from_polar(real, a.im),
        UnaryOp::Log => by(1.0 / a.re),
        UnaryOp::Log10 => by(1.0 / (a.re * std::f64::consts::LN_10)),
        UnaryOp::Sin => a.sin(),
        UnaryOp::Cos => a.cos(),
        UnaryOp::Tan => a.sin() / a.cos(),
        UnaryOp::Asin => by(1.0 / (1.0 - a.re * a.re).sqrt()),
        UnaryOp::Acos => by(-1.0 / (1.0 - a.re * a.re).sqrt()),
        UnaryOp::Atan => by(1.0 / (1.0 + a.re * a.re)),
        UnaryOp::Sinh => a.sinh(),
        UnaryOp::Cosh => a.cosh(),
        UnaryOp::Tanh => by(1.0 - real * real),
    }
}

fn binary(op: BinaryOp, a: Number, b: Number) -> Number {
    let real = op.apply(a.re, b.re);
    match op {
        BinaryOp::Add => a + b,
        BinaryOp::Sub => a - b,
        BinaryOp::Mul => a * b,
        // The quotient of the library divides by a square, which overflows sooner.
        BinaryOp::Div => Number::new(real, (a.im - real * b.im) / b.re),
        BinaryOp::Pow => power(a, b, real),
        BinaryOp::Min if b.re < a.re => b,
        BinaryOp::Max if b.re > a.re => b,
        BinaryOp::Min | BinaryOp::Max => a,
        BinaryOp::Atan2 => {
            let square = a.re * a.re + b.re * b.re;
            Number::new(real, (b.re * a.im - a.re * b.im) / square)
        }
        // Quantisers are differentiated as the identity.
        BinaryOp::FloorTo | BinaryOp::RoundTo => Number::new(real, a.im),
        BinaryOp::Lt
        | BinaryOp::Le
        | BinaryOp::Gt
        | BinaryOp::Ge
        | BinaryOp::Eq
        | BinaryOp::Ne
        | BinaryOp::And
        | BinaryOp::Or => truth(real != 0.0),
    }
}

fn power(a: Number, b: Number, real: f64) -> Number {
    if b.re.fract() == 0.0 && b.re.abs() < 100.0 && b.im == 0.0 {
        return a.powi(b.re as i32);
    }
    let slope = b.re * libm_pow(a.re, b.re - 1.0) * a.im;
    let of_exponent = if b.im == 0.0 {
        0.0
    } else {
        real * a.re.ln() * b.im
    };
    Number::new(real, slope + of_exponent)
}

fn libm_pow(a: f64, b: f64) -> f64 {
    BinaryOp::Pow.apply(a, b)
}
