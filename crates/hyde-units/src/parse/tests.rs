//! The grammar of units, their equalities, and every mistake with its place.

#![allow(clippy::float_cmp, reason = "factors are exact")]

use super::*;
use crate::{Agreement, AngleExponent, Dimension};
use proptest::prelude::*;

fn dimension(text: &str) -> Dimension {
    parse_unit(text).unwrap().dimension
}

#[test]
fn the_grammar_in_all_its_spellings() {
    let newton_metre = dimension("kg.m2/s2");
    for text in [
        "N.m",
        "N*m",
        "N·m",
        "kg.m^2/s^2",
        "kg.m²/s²",
        "kg.m2.s-2",
        "kg.m^2.s^-2",
        "J",
        " N . m ",
    ] {
        assert_eq!(dimension(text), newton_metre, "{text}");
    }
    assert_eq!(dimension("m/s/s"), dimension("m/s2"));
    assert_eq!(dimension("J/(kg.K)"), dimension("m2/(s2.K)"));
    assert_eq!(dimension("V/(m/s)"), dimension("V.s/m"));
    assert_eq!(dimension("(m/s)2"), dimension("m2/s2"));
    assert_eq!(dimension("s⁻¹"), dimension("1/s"));
    assert_eq!(dimension("m^(1/2)"), Dimension::LENGTH.sqrt().unwrap());
    assert_eq!(dimension("1"), Dimension::DIMENSIONLESS);
    assert_eq!(dimension("%"), Dimension::DIMENSIONLESS);
    assert_eq!(parse_unit("mm2/us").unwrap().scale.factor(), 1.0);
}

#[test]
fn signs_and_their_words_are_the_same_unit() {
    for (sign, word) in [
        ("µm", "um"),
        ("μm", "um"),
        ("Ω", "ohm"),
        ("Ω", "ohm"),
        ("mΩ", "mohm"),
        ("°", "deg"),
        ("°C", "degC"),
        ("\u{2103}", "degC"),
        ("\u{2109}", "degF"),
        ("\u{212a}", "K"),
    ] {
        assert_eq!(parse_unit(sign), parse_unit(word), "{sign}");
    }
}

#[test]
fn known_equalities_of_si() {
    for (a, b) in [
        ("N", "kg.m/s2"),
        ("Pa", "N/m2"),
        ("W", "N.m/s"),
        ("W", "V.A"),
        ("V", "W/A"),
        ("ohm", "V/A"),
        ("S", "1/ohm"),
        ("H", "V.s/A"),
        ("F", "A.s/V"),
        ("Wb", "V.s"),
        ("T", "Wb/m2"),
        ("C", "A.s"),
        ("Hz", "1/s"),
        ("V.s/rad", "N.m/A"),
    ] {
        assert_eq!(parse_unit(a), parse_unit(b), "{a} and {b}");
    }
}

#[test]
fn angles_are_counted() {
    let angle = |text| dimension(text).angle();
    let known = |n| AngleExponent::Known(Exponent::integer(n));
    assert_eq!(angle("mm/rev"), known(-1));
    assert_eq!(angle("A.s/rad"), known(-1));
    assert_eq!(angle("rpm"), known(1));
    assert_eq!(angle("deg/s2"), known(1));
    assert_eq!(angle("Hz"), known(0));
    assert_eq!(angle("1/min"), known(0));
    assert_eq!(angle("N.m/deg"), AngleExponent::Neutral);
    assert_eq!(angle("V/rpm"), AngleExponent::Neutral);
}

#[test]
fn mistakes_are_told_with_their_place() {
    let cases = [
        ("", 0..0, "a unit is missing: write `1` for a bare number"),
        ("  ", 0..2, "a unit is missing: write `1` for a bare number"),
        (
            "-",
            0..1,
            "expected a unit, found `-`: write `1` for a bare number",
        ),
        ("N.m/foo", 4..7, "unknown unit `foo`"),
        ("m/", 2..2, "expected a unit, found the end"),
        ("m//s", 2..3, "expected a unit, found `/`"),
        ("N m", 2..3, "expected `.` or `/`, found `m`"),
        ("m)", 1..2, "expected `.` or `/`, found `)`"),
        ("J/(kg.K", 7..7, "expected `)`, found the end"),
        (
            "10 mm",
            0..2,
            "a unit cannot contain a factor such as `10`: multiply the value by it instead",
        ),
        (
            "2.5m",
            0..3,
            "a unit cannot contain a factor such as `2.5`: multiply the value by it instead",
        ),
        (
            "J/kg.K",
            4..6,
            "a product after `/` is ambiguous: write `/(kg.K)`",
        ),
        (
            "W/degC",
            2..6,
            "`degC` has an offset zero point and cannot be part of a product: write `K`",
        ),
        (
            "degC2",
            0..4,
            "`degC` has an offset zero point and cannot be part of a product: write `K`",
        ),
        (
            "m^999999",
            1..8,
            "the exponent `999999` is too large or not exact",
        ),
        ("km^400000", 0..9, "the factor to SI is out of range"),
        (
            "((rev/rad)^600)^600",
            1..14,
            "the factor to SI is out of range",
        ),
        (
            "m99999999999",
            1..12,
            "the exponent `99999999999` is too large or not exact",
        ),
        (
            "m^(1/11)",
            1..8,
            "the exponent `(1/11)` is too large or not exact",
        ),
        (
            "m^(1/0)",
            1..7,
            "the exponent `(1/0)` is too large or not exact",
        ),
        ("m^x", 2..3, "expected a whole number, found `x`"),
        ("fs20.fs20", 0..9, "the factor to SI is out of range"),
    ];
    for (text, at, message) in cases {
        let error = parse_unit(text).unwrap_err();
        assert_eq!(
            (error.at.clone(), error.to_string().as_str()),
            (at, message),
            "{text}"
        );
    }
}

proptest! {
    #[test]
    fn the_unit_of_any_dimension_reads_back(
        parts in proptest::array::uniform8(prop_oneof![
            3 => Just((0, 1)),
            3 => (-60_i32..60, Just(1)),
            2 => (-60_i32..60, prop_oneof![Just(2), Just(3), Just(7), Just(16)]),
            1 => (any::<i32>(), Just(5040)),
        ]),
    ) {
        let exponent = |(n, d)| Exponent::ratio(n, d).unwrap();
        let [kg, m, a, s, k, mol, cd, angle] = parts.map(exponent);
        let dimension = Dimension {
            base: [kg, m, a, s, k, mol, cd],
            angle: AngleExponent::Known(angle),
        };
        for text in [dimension.usual_unit(), dimension.base_units()] {
            let unit = parse_unit(&text).unwrap();
            prop_assert_eq!(unit.dimension.agreement(dimension), Agreement::Same, "{}", text);
            prop_assert!(unit.is_si(), "{}", text);
        }
    }
}

#[test]
fn odd_text_never_panics() {
    let deep = "(".repeat(100_000);
    assert_eq!(parse_unit(&deep).unwrap_err().kind, UnitErrorKind::TooDeep);
    for text in [
        "é", "m^", "m^(", "m⁻", "Ω²⁻", "1²", "°°", "\u{0}", "µ", "m.(", "((m))^2", "🦀/s",
    ] {
        let _ = parse_unit(text);
    }
}
