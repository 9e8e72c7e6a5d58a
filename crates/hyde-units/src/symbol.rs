//! The table of unit symbols and prefixes, and the look-up of one symbol such as `mV`.

use crate::{Dimension, Scale};

/// One row of the table: a symbol, what people write instead, and what it means.
pub(crate) struct Symbol {
    pub(crate) text: &'static str,
    /// Words to recognise in a mistake; singular, lower case.
    pub(crate) words: &'static [&'static str],
    base: [i16; 7],
    angle: i16,
    pub(crate) scale: Scale,
    /// Added to a value before scaling; not zero for a scale with a zero point of its own.
    pub(crate) offset: f64,
    /// The prefixes it takes, one character each.
    pub(crate) prefixes: &'static str,
}

impl Symbol {
    /// The dimension before the rule of the angle-neutral kinds.
    pub(crate) fn dimension(&self) -> Dimension {
        Dimension::si(self.base, self.angle)
    }
}

/// Prefixes with their factors.
pub(crate) const PREFIXES: [(char, Scale); 12] = [
    ('f', Scale::ratio(1.0, 1e15)),
    ('p', Scale::ratio(1.0, 1e12)),
    ('n', Scale::ratio(1.0, 1e9)),
    ('u', Scale::ratio(1.0, 1e6)),
    ('m', Scale::ratio(1.0, 1e3)),
    ('c', Scale::ratio(1.0, 1e2)),
    ('d', Scale::ratio(1.0, 1e1)),
    ('h', Scale::ratio(1e2, 1.0)),
    ('k', Scale::ratio(1e3, 1.0)),
    ('M', Scale::ratio(1e6, 1.0)),
    ('G', Scale::ratio(1e9, 1.0)),
    ('T', Scale::ratio(1e12, 1.0)),
];

/// Every symbol without a prefix. Exponents: kg, m, A, s, K, mol, cd; then the angle.
#[rustfmt::skip]
pub(crate) const SYMBOLS: [Symbol; 56] = [
    row("m",   &["metre", "meter"],     [0, 1, 0, 0, 0, 0, 0], 0, Scale::ONE, "pnumcdk"),
    row("g",   &["gram", "gramme"],     [1, 0, 0, 0, 0, 0, 0], 0, Scale::ratio(1.0, 1e3), "numk"),
    row("s",   &["second", "sec"],      [0, 0, 0, 1, 0, 0, 0], 0, Scale::ONE, "fpnum"),
    row("A",   &["ampere", "amp"],      [0, 0, 1, 0, 0, 0, 0], 0, Scale::ONE, "pnumk"),
    row("K",   &["kelvin", "degk"],     [0, 0, 0, 0, 1, 0, 0], 0, Scale::ONE, "um"),
    row("mol", &["mole"],               [0, 0, 0, 0, 0, 1, 0], 0, Scale::ONE, "umk"),
    row("cd",  &["candela"],            [0, 0, 0, 0, 0, 0, 1], 0, Scale::ONE, "m"),
    // angle and turning
    row("rad",    &["radian"],                     [0; 7], 1, Scale::ONE, "num"),
    row("deg",    &["degree"],                     [0; 7], 1, Scale::of_pi(1.0, 180.0), ""),
    row("arcmin", &["arcminute"],                  [0; 7], 1, Scale::of_pi(1.0, 10_800.0), ""),
    row("arcsec", &["arcsecond"],                  [0; 7], 1, Scale::of_pi(1.0, 648_000.0), ""),
    row("rev",    &["revolution", "turn", "rot"],  [0; 7], 1, Scale::of_pi(2.0, 1.0), ""),
    row("rpm",    &["upm"],  [0, 0, 0, -1, 0, 0, 0], 1, Scale::of_pi(1.0, 30.0), "k"),
    row("rps",    &[],       [0, 0, 0, -1, 0, 0, 0], 1, Scale::of_pi(2.0, 1.0), ""),
    row("Hz",     &["hertz", "cps"],    [0, 0, 0, -1, 0, 0, 0], 0, Scale::ONE, "umkMG"),
    // time
    row("min", &["minute"],             [0, 0, 0, 1, 0, 0, 0], 0, Scale::ratio(60.0, 1.0), ""),
    row("h",   &["hour", "hr"],         [0, 0, 0, 1, 0, 0, 0], 0, Scale::ratio(3600.0, 1.0), ""),
    // mechanics
    row("N",   &["newton"],             [1, 1, 0, -2, 0, 0, 0], 0, Scale::ONE, "numkM"),
    row("Pa",  &["pascal"],             [1, -1, 0, -2, 0, 0, 0], 0, Scale::ONE, "umhkMGT"),
    row("J",   &["joule"],              [1, 2, 0, -2, 0, 0, 0], 0, Scale::ONE, "pnumkMG"),
    row("W",   &["watt"],               [1, 2, 0, -3, 0, 0, 0], 0, Scale::ONE, "pnumkMGT"),
    row("Wh",  &[],                     [1, 2, 0, -2, 0, 0, 0], 0, Scale::ratio(3600.0, 1.0), "mkMGT"),
    row("gn",  &["g0"],                 [0, 1, 0, -2, 0, 0, 0], 0, Scale::ratio(980_665.0, 1e5), ""),
    row("bar", &[],                     [1, -1, 0, -2, 0, 0, 0], 0, Scale::ratio(1e5, 1.0), "m"),
    row("in",  &["inch", "inche"],      [0, 1, 0, 0, 0, 0, 0], 0, Scale::ratio(254.0, 1e4), ""),
    row("ft",  &["foot", "feet"],       [0, 1, 0, 0, 0, 0, 0], 0, Scale::ratio(3048.0, 1e4), ""),
    row("mil", &[],                     [0, 1, 0, 0, 0, 0, 0], 0, Scale::ratio(254.0, 1e7), ""),
    row("thou", &[],                    [0, 1, 0, 0, 0, 0, 0], 0, Scale::ratio(254.0, 1e7), ""),
    row("gf",  &["pond"],               [1, 1, 0, -2, 0, 0, 0], 0, Scale::ratio(980_665.0, 1e8), "k"),
    row("lbm", &[],                     [1, 0, 0, 0, 0, 0, 0], 0, Scale::ratio(45_359_237.0, 1e8), ""),
    row("ozm", &[],                     [1, 0, 0, 0, 0, 0, 0], 0, Scale::ratio(45_359_237.0, 16e8), ""),
    row("lbf", &[],                     [1, 1, 0, -2, 0, 0, 0], 0, Scale::ratio(44_482_216_152_605.0, 1e13), "k"),
    row("ozf", &[],                     [1, 1, 0, -2, 0, 0, 0], 0, Scale::ratio(44_482_216_152_605.0, 16e13), ""),
    row("psi", &[],                     [1, -1, 0, -2, 0, 0, 0], 0, Scale::ratio(44_482_216_152_605.0, 64_516e5), "k"),
    row("hp",  &["horsepower"],         [1, 2, 0, -3, 0, 0, 0], 0, Scale::ratio(37_284_993_579_113_512.0, 5e13), ""),
    row("PS",  &[],                     [1, 2, 0, -3, 0, 0, 0], 0, Scale::ratio(73_549_875.0, 1e5), ""),
    row("l",   &["litre", "liter"],     [0, 3, 0, 0, 0, 0, 0], 0, Scale::ratio(1.0, 1e3), "umcdh"),
    row("L",   &[],                     [0, 3, 0, 0, 0, 0, 0], 0, Scale::ratio(1.0, 1e3), "um"),
    row("t",   &["tonne", "ton"],       [1, 0, 0, 0, 0, 0, 0], 0, Scale::ratio(1e3, 1.0), "k"),
    // electricity
    row("V",   &["volt"],               [1, 2, -1, -3, 0, 0, 0], 0, Scale::ONE, "numkM"),
    row("ohm", &[],                     [1, 2, -2, -3, 0, 0, 0], 0, Scale::ONE, "numkMGT"),
    row("S",   &["siemens", "mho"],     [-1, -2, 2, 3, 0, 0, 0], 0, Scale::ONE, "pnumk"),
    row("C",   &["coulomb"],            [0, 0, 1, 1, 0, 0, 0], 0, Scale::ONE, "pnumk"),
    row("Ah",  &[],                     [0, 0, 1, 1, 0, 0, 0], 0, Scale::ratio(3600.0, 1.0), "umk"),
    row("F",   &["farad"],              [-1, -2, 2, 4, 0, 0, 0], 0, Scale::ONE, "fpnumk"),
    row("H",   &["henry", "henrie", "hy"],    [1, 2, -2, -2, 0, 0, 0], 0, Scale::ONE, "pnumk"),
    row("Wb",  &["weber"],              [1, 2, -1, -2, 0, 0, 0], 0, Scale::ONE, "numk"),
    row("T",   &["tesla"],              [1, 0, -1, -2, 0, 0, 0], 0, Scale::ONE, "pnumk"),
    row("VA",  &[],                     [1, 2, 0, -3, 0, 0, 0], 0, Scale::ONE, "mkMG"),
    // numbers
    row("%",   &["percent", "pct"],     [0; 7], 0, Scale::ratio(1.0, 100.0), ""),
    row("inc", &["increment"],          [0; 7], 0, Scale::ONE, ""),
    row("count", &[],                   [0; 7], 0, Scale::ONE, ""),
    row("counts", &["tick", "pulse", "cts"], [0; 7], 0, Scale::ONE, ""),
    row("ppm", &[],                     [0; 7], 0, Scale::ratio(1.0, 1e6), ""),
    // temperatures with a zero point of their own
    affine("degC", &["celsius", "centigrade"], Scale::ONE, 273.15),
    affine("degF", &["fahrenheit"],            Scale::ratio(5.0, 9.0), 459.67),
];

/// The symbol as it stands, or a prefix and a symbol that takes it; with the factor of both.
pub(crate) fn look_up(text: &str) -> Option<(Scale, &'static Symbol)> {
    let text = &plain(text);
    if let Some(symbol) = exact(text) {
        return Some((symbol.scale, symbol));
    }
    let (prefix, factor, symbol) = prefixed(text)?;
    symbol
        .prefixes
        .contains(prefix)
        .then(|| (factor.multiply(symbol.scale), symbol))
}

/// A prefix on a symbol, whether or not the symbol takes it.
pub(crate) fn prefixed(text: &str) -> Option<(char, Scale, &'static Symbol)> {
    let prefix = text.chars().next()?;
    let &(_, factor) = PREFIXES.iter().find(|(p, _)| *p == prefix)?;
    let symbol = exact(&text[prefix.len_utf8()..])?;
    Some((prefix, factor, symbol))
}

/// Whether a character can be part of a symbol.
pub(crate) fn is_symbol_character(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '%' | '°' | '_' | '\u{2103}' | '\u{2109}')
}

/// The spelling of the table: signs that keyboards lack have a word in ASCII.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\u{b5}' | '\u{3bc}' => plain.push('u'),
            '\u{3a9}' | '\u{2126}' => plain.push_str("ohm"),
            '°' => plain.push_str("deg"),
            '\u{2103}' => plain.push_str("degC"),
            '\u{2109}' => plain.push_str("degF"),
            '\u{212a}' => plain.push('K'),
            _ => plain.push(c),
        }
    }
    plain
}

fn exact(text: &str) -> Option<&'static Symbol> {
    SYMBOLS.iter().find(|symbol| symbol.text == text)
}

const fn row(
    text: &'static str,
    words: &'static [&'static str],
    base: [i16; 7],
    angle: i16,
    scale: Scale,
    prefixes: &'static str,
) -> Symbol {
    Symbol {
        text,
        words,
        base,
        angle,
        scale,
        offset: 0.0,
        prefixes,
    }
}

const fn affine(
    text: &'static str,
    words: &'static [&'static str],
    scale: Scale,
    offset: f64,
) -> Symbol {
    Symbol {
        text,
        words,
        base: [0, 0, 0, 0, 1, 0, 0],
        angle: 0,
        scale,
        offset,
        prefixes: "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_unit;
    use std::collections::BTreeSet;

    #[test]
    fn every_spelling_is_one_unit_and_parses() {
        let mut seen = BTreeSet::new();
        for symbol in &SYMBOLS {
            assert!(
                seen.insert(symbol.text.to_owned()),
                "`{}` is in the table twice",
                symbol.text
            );
        }
        for symbol in &SYMBOLS {
            for prefix in symbol.prefixes.chars() {
                let text = format!("{prefix}{}", symbol.text);
                assert!(
                    PREFIXES.iter().any(|(p, _)| *p == prefix),
                    "`{prefix}` is no prefix"
                );
                assert!(
                    seen.insert(text.clone()),
                    "`{text}` can be read in two ways"
                );
            }
        }
        for text in &seen {
            let unit = parse_unit(text).unwrap();
            assert!(unit.scale.factor() > 0.0, "{text}");
        }
    }
}
