//! The operations of the IR, one row each: name and meaning. Interpreter, machine code and differentiation follow
//! this table; the functions behind it come from one mathematical library on every machine.

macro_rules! operations {
    ($(#[$meta:meta])* $kind:ident, $signature:ty, ($($arg:ident),+), $call:tt;
     $($name:ident $text:literal $doc:literal => $meaning:expr;)*) => {
        $(#[$meta])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
        pub enum $kind { $(#[doc = $doc] $name,)* }

        impl $kind {
            /// Every operation of the table.
            pub const ALL: &'static [Self] = &[$(Self::$name,)*];

            /// Its name in printed IR.
            #[must_use]
            pub fn name(self) -> &'static str {
                match self { $(Self::$name => $text,)* }
            }

            /// Its meaning.
            #[must_use]
            pub fn apply(self, $($arg: f64),+) -> f64 {
                let meaning: $signature = match self { $(Self::$name => $meaning,)* };
                meaning $call
            }
        }
    };
}

operations! {
    /// An operation on one value.
    UnaryOp, fn(f64) -> f64, (a), (a);
    Neg "-" "Negation." => |a| -a;
    Not "not" "1 where the argument is 0, else 0." => |a| truth(a == 0.0);
    Abs "abs" "Magnitude." => f64::abs;
    Sqrt "sqrt" "Square root." => f64::sqrt;
    Floor "floor" "Largest integer not above." => f64::floor;
    Ceil "ceil" "Smallest integer not below." => f64::ceil;
    Exp "exp" "Exponential." => libm::exp;
    Log "log" "Natural logarithm." => libm::log;
    Log10 "log10" "Decimal logarithm." => libm::log10;
    Sin "sin" "Sine." => libm::sin;
    Cos "cos" "Cosine." => libm::cos;
    Tan "tan" "Tangent." => libm::tan;
    Asin "asin" "Arc sine." => libm::asin;
    Acos "acos" "Arc cosine." => libm::acos;
    Atan "atan" "Arc tangent." => libm::atan;
    Sinh "sinh" "Hyperbolic sine." => libm::sinh;
    Cosh "cosh" "Hyperbolic cosine." => libm::cosh;
    Tanh "tanh" "Hyperbolic tangent." => libm::tanh;
}

operations! {
    /// An operation on two values.
    BinaryOp, fn(f64, f64) -> f64, (a, b), (a, b);
    Add "+" "Sum." => |a, b| a + b;
    Sub "-" "Difference." => |a, b| a - b;
    Mul "*" "Product." => |a, b| a * b;
    Div "/" "Quotient." => |a, b| a / b;
    Pow "^" "Power." => libm::pow;
    Min "min" "The second where it is less, else the first." => |a, b| if b < a { b } else { a };
    Max "max" "The second where it is greater, else the first." => |a, b| if b > a { b } else { a };
    Atan2 "atan2" "Angle of the point (b, a)." => libm::atan2;
    FloorTo "floor_to" "Largest multiple of b not above a: a quantiser, differentiated as the identity (S3)." => |a, b| whole_below(a / b) * b;
    RoundTo "round_to" "Nearest multiple of b: a quantiser, differentiated as the identity (S3)." => |a, b| (a / b + 0.5).floor() * b;
    Lt "<" "1 where a < b, else 0." => |a, b| truth(a < b);
    Le "<=" "1 where a <= b, else 0." => |a, b| truth(a <= b);
    Gt ">" "1 where a > b, else 0." => |a, b| truth(a > b);
    Ge ">=" "1 where a >= b, else 0." => |a, b| truth(a >= b);
    Eq "==" "1 where equal, else 0." => |a, b| truth(equal(a, b));
    Ne "<>" "1 where not equal, else 0." => |a, b| truth(!equal(a, b));
    And "and" "1 where both are not 0, else 0." => |a, b| truth(a != 0.0 && b != 0.0);
    Or "or" "1 where one is not 0, else 0." => |a, b| truth(a != 0.0 || b != 0.0);
}

impl BinaryOp {
    /// Whether it compares its operands.
    #[must_use]
    pub fn is_comparison(self) -> bool {
        matches!(
            self,
            Self::Lt | Self::Le | Self::Gt | Self::Ge | Self::Eq | Self::Ne
        )
    }

    /// Whether it yields a truth.
    #[must_use]
    pub fn is_truth(self) -> bool {
        self.is_comparison() || matches!(self, Self::And | Self::Or)
    }
}

/// Sine and cosine of a value, each to the last bit what it is alone. Both share the reduction of the argument.
#[must_use]
pub fn sine_and_cosine(value: f64) -> (f64, f64) {
    libm::sincos(value)
}

/// The largest whole number not above a quotient. The quotient of a multiple is often rounded to below a whole number:
/// 2 um/0.1 um is 19.999999999999996. So what four roundings can make of a whole number counts as that number.
fn whole_below(quotient: f64) -> f64 {
    let near = quotient.round();
    if (quotient - near).abs() <= 4.0 * f64::EPSILON * quotient.abs() {
        near
    } else {
        quotient.floor()
    }
}

fn truth(condition: bool) -> f64 {
    f64::from(u8::from(condition))
}

#[expect(
    clippy::float_cmp,
    reason = "the language's `==` asks whether two values are the same, not whether they are near"
)]
fn equal(a: f64, b: f64) -> bool {
    a == b
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_are_not_below_themselves() {
        for step in [0.1, 1e-7, 1e-6, 2e-5 * std::f64::consts::TAU, 0.3] {
            for k in -2000..2000 {
                let multiple = f64::from(k) * step;
                let between = (f64::from(k) + 0.999) * step;
                assert_eq!(
                    BinaryOp::FloorTo.apply(multiple, step).to_bits(),
                    multiple.to_bits(),
                    "{k}"
                );
                assert_eq!(
                    BinaryOp::FloorTo.apply(between, step).to_bits(),
                    multiple.to_bits(),
                    "{k}"
                );
            }
        }
        // As text they are multiples too.
        assert!((BinaryOp::FloorTo.apply(2e-6, 1e-7) - 2e-6).abs() < 1e-20);
        assert!((BinaryOp::FloorTo.apply(-2e-6, 1e-7) + 2e-6).abs() < 1e-20);
    }

    #[test]
    fn sine_and_cosine_together_are_what_each_is_alone() {
        let powers = (-1074..1024).map(|exponent| 1.37 * libm::exp2(f64::from(exponent)));
        let angles = (0..20_000).map(|k| f64::from(k) * 0.011);
        let special = [0.0, f64::INFINITY, f64::NAN, std::f64::consts::FRAC_PI_4];
        for value in powers.chain(angles).chain(special) {
            for value in [value, -value] {
                let (sine, cosine) = sine_and_cosine(value);
                assert_eq!(
                    sine.to_bits(),
                    UnaryOp::Sin.apply(value).to_bits(),
                    "{value}"
                );
                assert_eq!(
                    cosine.to_bits(),
                    UnaryOp::Cos.apply(value).to_bits(),
                    "{value}"
                );
            }
        }
    }
}
