//! The zone of a stamp: its offset from UTC where the stamp says one.

/// What a stamp says of its zone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Zone {
    /// Its offset from UTC in ns: an hour for `+01:00`, 0 for `Z`.
    Offset(i128),
    /// Nothing, or a name whose offset is not known.
    Named(String),
}

const MINUTE: i128 = 60 * super::NANOSECONDS;

impl Zone {
    /// `Z`, `UTC`, `+01:00`, `-0530`, `+01`, `+01:00[Europe/Berlin]`; any other text is a name.
    pub(super) fn of(text: &str) -> Self {
        let own = text.split('[').next().unwrap_or(text).trim();
        let utc = ["z", "utc", "gmt"];
        match utc.iter().any(|word| own.eq_ignore_ascii_case(word)) {
            true => Self::Offset(0),
            false => offset(own).map_or_else(|| Self::Named(own.to_owned()), Self::Offset),
        }
    }

    /// The offset from UTC in ns; 0 where none is said.
    pub(super) fn nanoseconds(&self) -> i128 {
        match self {
            Self::Offset(offset) => *offset,
            Self::Named(_) => 0,
        }
    }

    /// Whether stamps of both are of one clock as they stand, or after their offsets.
    pub(super) fn is_like(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Offset(_), Self::Offset(_)) => true,
            (Self::Named(own), Self::Named(other)) => own == other,
            (Self::Offset(_), Self::Named(_)) | (Self::Named(_), Self::Offset(_)) => false,
        }
    }
}

/// The offset that signs and digits say: `+01:00`, `-0530`, `+1`, and the same behind `UTC` or `GMT`.
fn offset(text: &str) -> Option<i128> {
    let upper = text.to_ascii_uppercase();
    let own = ["UTC", "GMT"]
        .iter()
        .find_map(|word| upper.strip_prefix(word))
        .unwrap_or(&upper);
    let (sign, digits) = match own.chars().next()? {
        '+' => (1, &own[1..]),
        '-' => (-1, &own[1..]),
        '−' => (-1, &own['−'.len_utf8()..]),
        _ => return None,
    };
    let number = |text: &str| {
        let all = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
        all.then(|| text.parse::<i128>().ok())?
    };
    let (hours, minutes) = match (digits.split_once(':'), digits.len()) {
        (Some((hours, minutes)), _) => (number(hours)?, number(minutes)?),
        (None, 4) => (number(digits.get(..2)?)?, number(digits.get(2..)?)?),
        (None, 1 | 2) => (number(digits)?, 0),
        (None, _) => return None,
    };
    (hours <= 18 && minutes < 60).then_some(sign * (60 * hours + minutes) * MINUTE)
}

impl std::fmt::Display for Zone {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Offset(offset) => {
                let minutes = offset / MINUTE;
                let sign = if minutes < 0 { '-' } else { '+' };
                let minutes = minutes.abs();
                write!(f, "UTC{sign}{:02}:{:02}", minutes / 60, minutes % 60)
            }
            Self::Named(name) => f.write_str(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn offsets_are_read_in_all_their_forms() {
        for (text, minutes) in [
            ("Z", 0),
            ("utc", 0),
            ("+01:00", 60),
            ("-05:30", -330),
            ("−0530", -330),
            ("+2", 120),
            ("UTC+01:00", 60),
            ("+01:00[Europe/Berlin]", 60),
        ] {
            assert_eq!(Zone::of(text), Zone::Offset(minutes * MINUTE), "{text}");
        }
        for name in ["", "CET", "+25:00", "+1:75", "Uhr", "+x"] {
            assert_eq!(Zone::of(name), Zone::Named(name.to_owned()));
        }
        assert_eq!(Zone::of("-05:30").to_string(), "UTC-05:30");
    }
}
