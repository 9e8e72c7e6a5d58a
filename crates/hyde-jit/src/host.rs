//! How each operation is made in machine code: by instructions, or by a call of the function that the interpreter uses.

use cranelift_codegen::ir::condcodes::FloatCC;
use hyde_ir::{BinaryOp, UnaryOp, sine_and_cosine};

/// How an operation on one value is made.
#[derive(Clone, Copy)]
pub(crate) enum Unary {
    Neg,
    Not,
    Abs,
    Sqrt,
    Call(Function),
}

/// How an operation on two values is made.
#[derive(Clone, Copy)]
pub(crate) enum Binary {
    Add,
    Sub,
    Mul,
    Div,
    And,
    Or,
    /// The second where it compares so with the first, else the first.
    Pick(FloatCC),
    Compare(FloatCC),
    Call(Function),
}

/// A function that both interpreter and machine code call: its name and its address.
pub(crate) type Function = (&'static str, *const u8);

/// Every function that machine code may call.
pub(crate) fn functions() -> Vec<Function> {
    let unary = UnaryOp::ALL.iter().filter_map(|&op| match unary(op) {
        Unary::Call(function) => Some(function),
        Unary::Neg | Unary::Not | Unary::Abs | Unary::Sqrt => None,
    });
    let binary = BinaryOp::ALL.iter().filter_map(|&op| match binary(op) {
        Binary::Call(function) => Some(function),
        Binary::Add
        | Binary::Sub
        | Binary::Mul
        | Binary::Div
        | Binary::And
        | Binary::Or
        | Binary::Pick(_)
        | Binary::Compare(_) => None,
    });
    let both = (SINE_AND_COSINE, hyde_sine_and_cosine as *const u8);
    unary.chain(binary).chain([both]).collect()
}

/// The function that returns the sine of its first argument and writes the cosine where the second one says.
pub(crate) const SINE_AND_COSINE: &str = "hyde_sine_and_cosine";

extern "C" fn hyde_sine_and_cosine(a: f64, cosine: &mut f64) -> f64 {
    let (sine, other) = sine_and_cosine(a);
    *cosine = other;
    sine
}

macro_rules! unary_functions {
    ($($function:ident $op:ident;)*) => {
        $(extern "C" fn $function(a: f64) -> f64 { UnaryOp::$op.apply(a) })*

        /// How an operation on one value is made.
        pub(crate) fn unary(op: UnaryOp) -> Unary {
            match op {
                UnaryOp::Neg => Unary::Neg,
                UnaryOp::Not => Unary::Not,
                UnaryOp::Abs => Unary::Abs,
                UnaryOp::Sqrt => Unary::Sqrt,
                $(UnaryOp::$op => Unary::Call((stringify!($function), $function as *const u8)),)*
            }
        }
    };
}

unary_functions! {
    hyde_floor Floor;
    hyde_ceil Ceil;
    hyde_exp Exp;
    hyde_log Log;
    hyde_log10 Log10;
    hyde_sin Sin;
    hyde_cos Cos;
    hyde_tan Tan;
    hyde_asin Asin;
    hyde_acos Acos;
    hyde_atan Atan;
    hyde_sinh Sinh;
    hyde_cosh Cosh;
    hyde_tanh Tanh;
}

macro_rules! binary_functions {
    ($($function:ident $op:ident;)*) => {
        $(extern "C" fn $function(a: f64, b: f64) -> f64 { BinaryOp::$op.apply(a, b) })*

        /// How an operation on two values is made. Unordered operands compare as in the table of operations: unequal,
        /// and nothing else.
        pub(crate) fn binary(op: BinaryOp) -> Binary {
            match op {
                BinaryOp::Add => Binary::Add,
                BinaryOp::Sub => Binary::Sub,
                BinaryOp::Mul => Binary::Mul,
                BinaryOp::Div => Binary::Div,
                BinaryOp::And => Binary::And,
                BinaryOp::Or => Binary::Or,
                BinaryOp::Min => Binary::Pick(FloatCC::LessThan),
                BinaryOp::Max => Binary::Pick(FloatCC::GreaterThan),
                BinaryOp::Lt => Binary::Compare(FloatCC::LessThan),
                BinaryOp::Le => Binary::Compare(FloatCC::LessThanOrEqual),
                BinaryOp::Gt => Binary::Compare(FloatCC::GreaterThan),
                BinaryOp::Ge => Binary::Compare(FloatCC::GreaterThanOrEqual),
                BinaryOp::Eq => Binary::Compare(FloatCC::Equal),
                BinaryOp::Ne => Binary::Compare(FloatCC::NotEqual),
                $(BinaryOp::$op => Binary::Call((stringify!($function), $function as *const u8)),)*
            }
        }
    };
}

binary_functions! {
    hyde_pow Pow;
    hyde_atan2 Atan2;
    hyde_floor_to FloorTo;
    hyde_round_to RoundTo;
}
