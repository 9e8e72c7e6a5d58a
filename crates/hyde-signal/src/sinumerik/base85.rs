//! Doubles in base 85: five characters for four bytes, the higher ones first; `.` stands for four bytes of zeros.

/// The digits in their order; those that XML has a meaning for are none of them.
const DIGITS: &[u8; 85] =
    b"0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ!#$`()*+-/:;=?@[]^_{|}~";

/// The doubles of a text; nothing if it is not of this kind.
pub(super) fn doubles(text: &str) -> Option<Vec<f64>> {
    let mut digits = text
        .bytes()
        .filter(|byte| !byte.is_ascii_whitespace())
        .peekable();
    let mut values = Vec::new();
    while digits.peek().is_some() {
        let high = word(&mut digits)?;
        let low = word(&mut digits)?;
        values.push(f64::from_bits(u64::from(high) << 32 | u64::from(low)));
    }
    Some(values)
}

/// Four bytes. The last group of a text may be shorter: what is missing of it is 0.
fn word(digits: &mut std::iter::Peekable<impl Iterator<Item = u8>>) -> Option<u32> {
    if digits.peek() == Some(&b'.') {
        digits.next();
        return Some(0);
    }
    let mut word = 0_u64;
    for place in 0..5 {
        let digit = match digits.next_if(|digit| *digit != b'.') {
            Some(digit) => DIGITS.iter().position(|known| *known == digit)?,
            None if place > 0 && digits.peek().is_none() => 0,
            None => return None,
        };
        word = word * 85 + digit as u64;
    }
    u32::try_from(word).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(values: &[f64]) -> String {
        let mut out = String::new();
        for value in values {
            let bits = value.to_bits();
            for mut word in [bits >> 32, bits & 0xffff_ffff] {
                if word == 0 {
                    out.push('.');
                    continue;
                }
                let mut digits = [0; 5];
                for digit in digits.iter_mut().rev() {
                    *digit = DIGITS[usize::try_from(word % 85).unwrap()];
                    word /= 85;
                }
                out.push_str(str::from_utf8(&digits).unwrap());
            }
        }
        out
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "bits are copied")]
    fn what_is_written_is_read() {
        let values = [0.0, 1.0, -2.5, 1.0 / 3.0, 1e-300, 0.255_75, f64::MAX];
        assert_eq!(doubles(&text(&values)).unwrap(), values);
        assert_eq!(doubles("").unwrap(), []);
        assert_eq!(doubles("&&&&&"), None);
        assert_eq!(doubles("kH"), None);
        assert_eq!(DIGITS.len(), 85);
    }
}
