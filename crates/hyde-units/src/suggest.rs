//! What an unknown unit symbol may have meant: `ohms`, `Nm`, `KG`, `hz`, `krad`.

use crate::UnitErrorKind;
use crate::symbol::{SYMBOLS, look_up, prefixed};

/// The kind of mistake that an unknown symbol is.
///
/// The likeliest reading is tried first: a well-known product, a word, the wrong case, a prefix that is not usual,
/// two symbols without a dot, a slip of one letter.
pub(crate) fn explain(symbol: &str) -> UnitErrorKind {
    let symbol_text = symbol.to_owned();
    if let Some((_, advice)) = AMBIGUOUS.iter().find(|(text, _)| *text == symbol) {
        return UnitErrorKind::Ambiguous {
            symbol: symbol_text,
            advice,
        };
    }
    if let Some((_, product)) = WELL_KNOWN.iter().find(|(joined, _)| *joined == symbol) {
        return UnitErrorKind::Joined {
            symbol: symbol_text,
            product: (*product).to_owned(),
        };
    }
    let meant = meant_by_word(symbol).unwrap_or_else(|| other_case(symbol));
    if !meant.is_empty() {
        return UnitErrorKind::Unknown {
            symbol: symbol_text,
            candidates: meant,
        };
    }
    if let Some((prefix, _, bare)) = prefixed(symbol) {
        return UnitErrorKind::Prefix {
            prefix,
            symbol: bare.text.to_owned(),
        };
    }
    if let Some(product) = split(symbol) {
        return UnitErrorKind::Joined {
            symbol: symbol_text,
            product,
        };
    }
    UnitErrorKind::Unknown {
        symbol: symbol_text,
        candidates: one_slip(symbol),
    }
}

/// The one unit that a symbol can mean: a product without its dot, a word, or a symbol of several letters in the wrong case.
pub(crate) fn meant(symbol: &str) -> Option<String> {
    if AMBIGUOUS.iter().any(|(text, _)| *text == symbol) {
        return None;
    }
    if let Some((_, product)) = WELL_KNOWN.iter().find(|(joined, _)| *joined == symbol) {
        return Some((*product).to_owned());
    }
    let several = symbol.chars().count() > 1;
    let candidates =
        meant_by_word(symbol).unwrap_or_else(|| match several && has_lost_case(symbol) {
            true => other_case(symbol),
            false => Vec::new(),
        });
    match candidates.as_slice() {
        [one] => Some(one.clone()),
        [] if several => split(symbol),
        _ => None,
    }
}

/// Whether a symbol is written in capitals, or in small letters, throughout, or begins as a sentence does: `RPM`, `hz`, `Rpm`.
fn has_lost_case(symbol: &str) -> bool {
    let mut letters = symbol.chars();
    let first = letters.next().is_some_and(char::is_uppercase);
    let capitals = letters.clone().all(char::is_uppercase);
    let small = letters.clone().all(char::is_lowercase);
    first && capitals || small && (!first || letters.count() > 1)
}

/// Products whose letters would also match something less likely: `nm`, `N.ms`.
#[rustfmt::skip]
const WELL_KNOWN: [(&str, &str); 15] = [
    ("Nm", "N.m"), ("NM", "N.m"), ("Nms", "N.m.s"), ("Ns", "N.s"),
    ("kgcm", "kgf.cm"), ("gcm", "gf.cm"),
    ("ozin", "ozf.in"), ("inoz", "ozf.in"), ("lbin", "lbf.in"), ("inlb", "lbf.in"), ("inlbf", "lbf.in"),
    ("lbft", "lbf.ft"), ("ftlb", "lbf.ft"), ("ftlbf", "lbf.ft"), ("inozf", "ozf.in"),
];

const EFFECTIVE_CURRENT: &str =
    "an effective value is in `A` as well; the peak of a sine is sqrt(2) times as large";
const EFFECTIVE_VOLTAGE: &str =
    "an effective value is in `V` as well; the peak of a sine is sqrt(2) times as large";

/// Symbols of data sheets that stand for more than one quantity, or for none that is a unit.
const AMBIGUOUS: [(&str, &str); 25] = [
    (
        "oz",
        "write `ozf` for a force (a torque is in `ozf.in`), `ozm` for a mass",
    ),
    (
        "lb",
        "write `lbf` for a force (a torque is in `lbf.in`), `lbm` for a mass",
    ),
    (
        "lbs",
        "write `lbf` for a force (a torque is in `lbf.in`), `lbm` for a mass",
    ),
    ("kp", "write `kgf` for a kilopond"),
    ("cpr", "write `counts/rev`"),
    ("ppr", "write `counts/rev`"),
    ("ipm", "write `in/min`"),
    ("mph", "write `1.609344 [km/h]` for a mile an hour"),
    ("U", "turns a minute, U/min, are `rpm`"),
    ("Umdr", "turns a minute are `rpm`"),
    ("r", "turns a minute, r/min, are `rpm`; a turn is `rev`"),
    ("Arms", EFFECTIVE_CURRENT),
    ("Aeff", EFFECTIVE_CURRENT),
    ("Vrms", EFFECTIVE_VOLTAGE),
    ("Veff", EFFECTIVE_VOLTAGE),
    ("Apk", "write `A`"),
    ("Ap", "write `A`"),
    ("Vdc", "write `V`"),
    ("Grad", "write `deg` for a degree; a gon is `0.9 [deg]`"),
    ("grad", "write `deg` for a degree; a gon is `0.9 [deg]`"),
    ("grd", "write `deg` for a degree; a gon is `0.9 [deg]`"),
    (
        "G",
        "write `gn` for the acceleration of gravity; a gauss is `1e-4 [T]`",
    ),
    ("LSB", "write `counts` for steps of a converter"),
    ("daN", "ten newtons: write `10 [N]`"),
    (
        "dB",
        "a ratio is a pure number: write `10^(x/20)`, for 6 dB `2`",
    ),
];

/// `ohms`, `Meter`, `kilonewtons` are words for symbols.
fn meant_by_word(symbol: &str) -> Option<Vec<String>> {
    let lower = symbol.to_lowercase();
    let singular = lower.strip_suffix('s').unwrap_or(&lower);
    for (word, prefix) in [
        ("", ""),
        ("u", "u"),
        ("m", "m"),
        ("k", "k"),
        ("micro", "u"),
        ("milli", "m"),
        ("kilo", "k"),
        ("mega", "M"),
    ] {
        let matching = |text: &str| {
            [&*lower, singular]
                .iter()
                .any(|whole| whole.strip_prefix(word) == Some(text))
        };
        let found = SYMBOLS.iter().find(|row| {
            let is_word = row.words.iter().any(|word| matching(word));
            let is_plural = row.text.len() >= 3 && matching(row.text) && symbol != row.text;
            (is_word || is_plural) && row.prefixes.contains(prefix)
        });
        if let Some(row) = found {
            return Some(vec![format!("{prefix}{}", row.text)]);
        }
    }
    (lower == "micron" || lower == "microns").then(|| vec!["um".to_owned()])
}

/// Symbols that differ in nothing but the case of letters, the one with the fewest changes first.
fn other_case(symbol: &str) -> Vec<String> {
    let mut found: Vec<String> = spellings()
        .filter(|text| text.to_lowercase() == symbol.to_lowercase())
        .collect();
    let changes = |text: &String| {
        text.chars()
            .zip(symbol.chars())
            .filter(|(a, b)| a != b)
            .count()
    };
    found.sort_by_key(changes);
    found
}

/// Two known symbols in one: `kgm` is `kg.m`.
fn split(symbol: &str) -> Option<String> {
    symbol.char_indices().skip(1).find_map(|(at, _)| {
        let (left, right) = symbol.split_at(at);
        (look_up(left).is_some() && look_up(right).is_some()).then(|| format!("{left}.{right}"))
    })
}

/// Symbols that one slip makes of another.
///
/// A short symbol with one letter more or another letter is as likely a unit that the table lacks: `inc` is not an inch,
/// `kgf` not a mass. So two letters in the wrong order are seen in three, a missing or further letter in four, a wrong
/// one in five.
fn one_slip(symbol: &str) -> Vec<String> {
    spellings()
        .filter(|text| is_one_slip(text, symbol))
        .take(3)
        .collect()
}

fn is_one_slip(a: &str, b: &str) -> bool {
    let length = a.chars().count().max(b.chars().count());
    let (a, b): (Vec<char>, Vec<char>) = (a.chars().collect(), b.chars().collect());
    let same_start = a.iter().zip(&b).take_while(|(x, y)| x == y).count();
    let (a, b) = (&a[same_start..], &b[same_start..]);
    let same_end = a
        .iter()
        .rev()
        .zip(b.iter().rev())
        .take_while(|(x, y)| x == y)
        .count();
    let (a, b) = (&a[..a.len() - same_end], &b[..b.len() - same_end]);
    let swapped = a.len() == 2 && b.len() == 2 && a[0] == b[1] && a[1] == b[0];
    let replaced = a.len() == 1 && b.len() == 1;
    let one_more = a.len() + b.len() == 1;
    length >= 3 && swapped || length >= 4 && one_more || length >= 5 && replaced
}

/// Every symbol with every prefix it takes, the bare symbols first.
fn spellings() -> impl Iterator<Item = String> {
    let bare = SYMBOLS.iter().map(|row| row.text.to_owned());
    let with_prefix = SYMBOLS.iter().flat_map(|row| {
        row.prefixes
            .chars()
            .map(move |prefix| format!("{prefix}{}", row.text))
    });
    bare.chain(with_prefix)
}

#[cfg(test)]
mod tests {
    use crate::parse_unit;

    fn message(text: &str) -> String {
        parse_unit(text).unwrap_err().to_string()
    }

    #[test]
    fn near_misses_are_named() {
        let cases = [
            ("ohms", "did you mean `ohm`?"),
            ("Ohm", "did you mean `ohm`?"),
            ("Newton", "did you mean `N`?"),
            ("kilonewtons", "did you mean `kN`?"),
            ("meters", "did you mean `m`?"),
            ("millimetre", "did you mean `mm`?"),
            ("microns", "did you mean `um`?"),
            ("sec", "did you mean `s`?"),
            ("seconds", "did you mean `s`?"),
            ("degrees", "did you mean `deg`?"),
            ("radians", "did you mean `rad`?"),
            ("rads", "did you mean `rad`?"),
            ("revs", "did you mean `rev`?"),
            ("inches", "did you mean `in`?"),
            ("Celsius", "did you mean `degC`?"),
            ("turns", "did you mean `rev`?"),
            ("KG", "did you mean `kg`?"),
            ("Kg", "did you mean `kg`?"),
            ("hz", "did you mean `Hz`?"),
            ("HZ", "did you mean `Hz`?"),
            ("RPM", "did you mean `rpm`?"),
            ("khz", "did you mean `kHz`?"),
            ("mpa", "did you mean `mPa` or `MPa`?"),
            ("mHy", "did you mean `mH`?"),
            ("rda", "did you mean `rad`?"),
            ("arcsc", "did you mean `arcsec`?"),
            ("Nm", "write `N.m`"),
            ("NM", "write `N.m`"),
            ("Nms", "write `N.m.s`"),
            ("kNm", "write `kN.m`"),
            ("Nmm", "write `N.mm`"),
            ("Vs", "write `V.s`"),
            ("As", "write `A.s`"),
            ("kgm", "write `kg.m`"),
        ];
        for (text, help) in cases {
            assert_eq!(message(text), format!("unknown unit `{text}`: {help}"));
        }
        assert_eq!(message("kgm2"), "unknown unit `kgm`: write `kg.m`");
    }

    #[test]
    fn an_unusual_prefix_is_said_to_be_one() {
        for (text, symbol) in [("krad/s", "rad"), ("kmin", "min")] {
            let said = format!(
                "`{symbol}` does not take the prefix `k`: write `{symbol}`, and the power of ten in the number"
            );
            assert_eq!(message(text), said);
        }
    }

    #[test]
    fn what_is_like_nothing_gets_no_help() {
        assert_eq!(message("furlong"), "unknown unit `furlong`");
        assert_eq!(message("m/x"), "unknown unit `x`");
    }

    #[test]
    fn a_unit_that_is_not_known_is_no_other_quantity() {
        for text in [
            "slug", "dyn", "erg", "fur", "kat", "lux", "bps", "pcs", "rqm",
        ] {
            assert!(!message(text).contains("did you mean"), "{}", message(text));
        }
        for (text, help) in [
            (
                "oz.in",
                "write `ozf` for a force (a torque is in `ozf.in`), `ozm` for a mass",
            ),
            (
                "lb.ft",
                "write `lbf` for a force (a torque is in `lbf.in`), `lbm` for a mass",
            ),
        ] {
            assert!(message(text).ends_with(help), "{}", message(text));
        }
        assert_eq!(message("kgcm"), "unknown unit `kgcm`: write `kgf.cm`");
        assert_eq!(message("ftlb"), "unknown unit `ftlb`: write `lbf.ft`");
        assert_eq!(message("msec"), "unknown unit `msec`: did you mean `ms`?");
        assert_eq!(
            message("kohms"),
            "unknown unit `kohms`: did you mean `kohm`?"
        );
    }
}
