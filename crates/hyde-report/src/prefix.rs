//! Which multiple of an SI unit a value is best shown in, by the habits of the trade (machine tools: mm and N/µm).

/// The unit and the factor (shown = SI × factor) that suit values up to `largest` (SI, absolute).
pub(crate) fn shown_unit(si_unit: &str, largest: f64) -> (String, f64) {
    let Some((_, choices)) = TABLE.iter().find(|(names, _)| names.contains(&si_unit)) else {
        return (si_unit.to_owned(), 1.0);
    };
    // Zero says nothing about the size: the base unit then.
    let fits = |choice: &&Choice| {
        if largest > 0.0 {
            largest >= choice.from
        } else {
            (choice.factor - 1.0).abs() < 0.5
        }
    };
    let chosen = choices.iter().rev().find(fits).or(choices.first());
    chosen.map_or_else(
        || (si_unit.to_owned(), 1.0),
        |choice| (choice.unit.to_owned(), choice.factor),
    )
}

/// A unit shown for values of at least `from` (SI).
struct Choice {
    unit: &'static str,
    factor: f64,
    from: f64,
}

const fn show(unit: &'static str, factor: f64, from: f64) -> Choice {
    Choice { unit, factor, from }
}

type Row = (&'static [&'static str], &'static [Choice]);

/// Spellings of an SI unit, and what it is shown as, from small to large. Where a unit is also read with one decimal
/// (0.5 A, 0.1 N), it begins below 1.
const TABLE: &[Row] = &[
    (
        &["m"],
        &[
            show("nm", 1e9, 0.0),
            show("µm", 1e6, 2e-7),
            show("mm", 1e3, 1e-3),
            show("m", 1.0, 10.0),
        ],
    ),
    (
        &["m/s"],
        &[
            show("µm/s", 1e6, 0.0),
            show("mm/s", 1e3, 1e-3),
            show("m/s", 1.0, 1.0),
        ],
    ),
    (
        &["m/s2", "m/s^2", "m/s²"],
        &[show("mm/s²", 1e3, 0.0), show("m/s²", 1.0, 0.1)],
    ),
    (&["m/s3", "m/s^3", "m/s³"], &[show("m/s³", 1.0, 0.0)]),
    (
        &["s"],
        &[
            show("ns", 1e9, 0.0),
            show("µs", 1e6, 1e-6),
            show("ms", 1e3, 1e-3),
            show("s", 1.0, 0.5),
        ],
    ),
    (
        &["Hz"],
        &[
            show("mHz", 1e3, 0.0),
            show("Hz", 1.0, 0.1),
            show("kHz", 1e-3, 1e4),
            show("MHz", 1e-6, 1e6),
        ],
    ),
    (
        &["A"],
        &[
            show("µA", 1e6, 0.0),
            show("mA", 1e3, 1e-3),
            show("A", 1.0, 0.5),
            show("kA", 1e-3, 1e4),
        ],
    ),
    (
        &["V"],
        &[
            show("µV", 1e6, 0.0),
            show("mV", 1e3, 1e-3),
            show("V", 1.0, 0.5),
            show("kV", 1e-3, 1e4),
        ],
    ),
    (
        &["ohm", "Ω"],
        &[
            show("mΩ", 1e3, 0.0),
            show("Ω", 1.0, 0.1),
            show("kΩ", 1e-3, 1e3),
            show("MΩ", 1e-6, 1e6),
        ],
    ),
    (
        &["H"],
        &[
            show("µH", 1e6, 0.0),
            show("mH", 1e3, 1e-3),
            show("H", 1.0, 1.0),
        ],
    ),
    (
        &["W"],
        &[
            show("mW", 1e3, 0.0),
            show("W", 1.0, 0.1),
            show("kW", 1e-3, 1e3),
            show("MW", 1e-6, 1e6),
        ],
    ),
    (
        &["J"],
        &[
            show("mJ", 1e3, 0.0),
            show("J", 1.0, 0.1),
            show("kJ", 1e-3, 1e4),
            show("MJ", 1e-6, 1e6),
        ],
    ),
    (
        &["N"],
        &[
            show("mN", 1e3, 0.0),
            show("N", 1.0, 0.1),
            show("kN", 1e-3, 1e4),
            show("MN", 1e-6, 1e7),
        ],
    ),
    (
        &["N.m", "N·m", "N*m", "N m", "Nm"],
        &[
            show("µN·m", 1e6, 0.0),
            show("mN·m", 1e3, 1e-3),
            show("N·m", 1.0, 0.1),
            show("kN·m", 1e-3, 1e4),
        ],
    ),
    (
        &["N/m"],
        &[
            show("N/m", 1.0, 0.0),
            show("N/mm", 1e-3, 1e4),
            show("N/µm", 1e-6, 1e6),
        ],
    ),
    (
        &["m/N"],
        &[
            show("nm/N", 1e9, 0.0),
            show("µm/N", 1e6, 1e-6),
            show("mm/N", 1e3, 1e-3),
            show("m/N", 1.0, 1.0),
        ],
    ),
    (
        &["Pa"],
        &[
            show("Pa", 1.0, 0.0),
            show("kPa", 1e-3, 1e3),
            show("MPa", 1e-6, 1e6),
            show("GPa", 1e-9, 1e10),
        ],
    ),
    (
        &["kg"],
        &[
            show("mg", 1e6, 0.0),
            show("g", 1e3, 1e-3),
            show("kg", 1.0, 0.1),
        ],
    ),
    (&["K"], &[show("mK", 1e3, 0.0), show("K", 1.0, 0.1)]),
    (
        &["rad"],
        &[
            show("µrad", 1e6, 0.0),
            show("mrad", 1e3, 1e-3),
            show("rad", 1.0, 0.1),
        ],
    ),
    (
        &["rad/s"],
        &[show("mrad/s", 1e3, 0.0), show("rad/s", 1.0, 0.1)],
    ),
    (&["1"], &[show("", 1.0, 0.0)]),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefixes_follow_the_size() {
        let unit = |si, largest| shown_unit(si, largest).0;
        assert_eq!(unit("m", 3e-6), "µm");
        assert_eq!(unit("m", 1.2e-8), "nm");
        assert_eq!(unit("m", 1.5), "mm"); // a stroke of 1500 mm
        assert_eq!(unit("m", 12.0), "m");
        assert_eq!(unit("m", 0.0), "m");
        assert_eq!(unit("A", 0.02), "mA");
        assert_eq!(unit("A", 0.8), "A");
        assert_eq!(unit("N", 2500.0), "N");
        assert_eq!(unit("N", 2.5e4), "kN");
        assert_eq!(unit("rad", 1e-3), "mrad");
        assert_eq!(unit("rad", 400.0), "rad");
        assert_eq!(unit("N/m", 1.6e8), "N/µm");
        assert_eq!(unit("N.m", 5.0), "N·m");
        assert_eq!(unit("1", 5.0), "");
        assert_eq!(unit("kg.m2", 5e-9), "kg.m2");
    }

    #[test]
    fn each_row_rises_and_holds_the_base_unit_it_is_named_after() {
        for (names, choices) in TABLE {
            assert!(
                choices.is_sorted_by(|a, b| a.from < b.from && a.factor > b.factor),
                "{names:?}"
            );
            assert!(
                choices
                    .iter()
                    .any(|choice| (choice.factor - 1.0).abs() < 1e-15),
                "{names:?}"
            ); // written constants
        }
    }
}
