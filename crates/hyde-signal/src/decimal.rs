//! [`decimal`]: plain decimal numbers, read faster than by the general rule and to the same double.

/// Digits that a double holds as a whole number.
const DIGITS: usize = 15;
/// The powers of ten that a double holds and that so many digits need.
const POWERS: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// The number in a text of at most 15 digits with a sign or none and a point or none, and whether it has a point; `None` of any
/// other text.
///
/// Digits and power of ten are doubles without an error, so the one division is the only rounding (Clinger, PLDI 1990).
pub(crate) fn decimal(text: &str) -> Option<(f64, bool)> {
    let bytes = text.as_bytes();
    let (negative, digits) = match bytes {
        [b'-', rest @ ..] => (true, rest),
        [b'+', rest @ ..] => (false, rest),
        all => (false, all),
    };
    // The digits and a point.
    if digits.len() > DIGITS + 1 {
        return None;
    }
    let (mut whole, mut point) = (0_u64, None);
    for (at, &byte) in digits.iter().enumerate() {
        let digit = byte.wrapping_sub(b'0');
        if digit < 10 {
            whole = 10 * whole + u64::from(digit);
        } else if byte == b'.' && point.is_none() {
            point = Some(at);
        } else {
            return None;
        }
    }
    let count = digits.len() - usize::from(point.is_some());
    if count == 0 || count > DIGITS {
        return None;
    }
    let places = point.map_or(0, |at| digits.len() - 1 - at);
    #[allow(
        clippy::cast_precision_loss,
        reason = "at most 15 digits are held without an error"
    )]
    let value = whole as f64 / POWERS[places];
    Some((if negative { -value } else { value }, point.is_some()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn other_texts_are_left_to_the_general_rule() {
        for text in [
            "",
            "-",
            "+",
            ".",
            "-.",
            "1e3",
            "1,5",
            "1.2.3",
            " 1",
            "1 ",
            "inf",
            "NaN",
            "--1",
            "0x1",
            "1234567890123456",
            "1_0",
        ] {
            assert_eq!(decimal(text), None, "{text:?}");
        }
    }

    proptest! {
        /// What is read is the same double, to the last bit, and its sign where it is zero.
        #[test]
        fn numbers_are_those_of_the_general_rule(text in "[+-]?[0-9]{0,9}(\\.[0-9]{0,8})?") {
            if let Some((value, point)) = decimal(&text) {
                prop_assert_eq!(Ok(value.to_bits()), text.parse().map(f64::to_bits));
                prop_assert_eq!(point, text.contains('.'));
            }
        }
    }
}
