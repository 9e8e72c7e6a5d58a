//! The functions that interpreter and machine code share: everything that is no single instruction everywhere.

use hyde_ir::{BinaryOp, UnaryOp};

macro_rules! unary_functions {
    ($($function:ident $op:ident;)*) => {
        $(extern "C" fn $function(a: f64) -> f64 { UnaryOp::$op.apply(a) })*

        /// Name and address of the function behind an operation on one value; `None` for those that are instructions.
        pub(crate) fn unary(op: UnaryOp) -> Option<(&'static str, *const u8)> {
            match op {
                $(UnaryOp::$op => Some((stringify!($function), $function as *const u8)),)*
                UnaryOp::Neg | UnaryOp::Not | UnaryOp::Abs | UnaryOp::Sqrt => None,
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

        /// Name and address of the function behind an operation on two values; `None` for those that are instructions.
        pub(crate) fn binary(op: BinaryOp) -> Option<(&'static str, *const u8)> {
            match op {
                $(BinaryOp::$op => Some((stringify!($function), $function as *const u8)),)*
                BinaryOp::Add
                | BinaryOp::Sub
                | BinaryOp::Mul
                | BinaryOp::Div
                | BinaryOp::Min
                | BinaryOp::Max
                | BinaryOp::Lt
                | BinaryOp::Le
                | BinaryOp::Gt
                | BinaryOp::Ge
                | BinaryOp::Eq
                | BinaryOp::Ne
                | BinaryOp::And
                | BinaryOp::Or => None,
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
