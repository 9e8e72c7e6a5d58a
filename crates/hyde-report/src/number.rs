//! Numbers as they are printed: a true minus sign, superscript exponents, no more digits than asked for.

/// `value` with a fixed number of decimals; never `−0`.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    let unsigned = text.strip_prefix('-').unwrap_or(&text);
    if zero || unsigned.len() == text.len() {
        unsigned.to_owned()
    } else {
        format!("−{unsigned}")
    }
}

/// `value` rounded to `digits` significant digits; from 10⁶ on and below 10⁻³ as `1.23·10⁻⁵`, what is no number
/// as `–`.
pub(crate) fn significant(value: f64, digits: usize) -> String {
    if value.is_nan() {
        return "–".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "∞" } else { "−∞" }.to_owned();
    }
    if value.abs() < f64::MIN_POSITIVE {
        return "0".to_owned();
    }
    let places = digits.max(1) - 1;
    let rounded = format!("{value:.places$e}");
    let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..6).contains(&exponent) {
        let decimals = i32::try_from(places).unwrap_or(0) - exponent;
        return fixed(
            rounded.parse().unwrap_or(value),
            usize::try_from(decimals).unwrap_or(0),
        );
    }
    format!("{}·{}", mantissa.replace('-', "−"), power_of_ten(exponent))
}

/// `10⁻³` for −3.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    let superscript = |byte: u8| match byte {
        b'-' => '⁻',
        b'1' => '¹',
        b'2' => '²',
        b'3' => '³',
        b'4' => '⁴',
        b'5' => '⁵',
        b'6' => '⁶',
        b'7' => '⁷',
        b'8' => '⁸',
        b'9' => '⁹',
        _ => '⁰',
    };
    let raised: String = exponent.to_string().bytes().map(superscript).collect();
    format!("10{raised}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_decimals_with_a_true_minus() {
        assert_eq!(fixed(-1.25, 1), "−1.2");
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(fixed(12.0, 0), "12");
    }

    #[test]
    fn significant_digits() {
        assert_eq!(significant(0.0123456, 3), "0.0123");
        assert_eq!(significant(-1234.56, 3), "−1230");
        assert_eq!(significant(999.96, 4), "1000");
        assert_eq!(significant(1.5e-7, 3), "1.50·10⁻⁷");
        assert_eq!(significant(2.0e9, 2), "2.0·10⁹");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(significant(f64::NAN, 3), "–");
        assert_eq!(significant(f64::NEG_INFINITY, 3), "−∞");
    }

    #[test]
    fn powers_of_ten() {
        assert_eq!(power_of_ten(-12), "10⁻¹²");
        assert_eq!(power_of_ten(3), "10³");
    }
}
