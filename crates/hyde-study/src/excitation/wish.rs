//! What the options ask for: limits, band, times; and what is assumed of those that are missing.

use super::options::Options;
use super::quantity::{self, Quantity, quantity};
use hyde_signal::excite::{Bounds, Limits, Shape, Wish};
use hyde_units::{Agreement, Dimension, NamedUnit};

/// What is asked for.
pub struct Wished {
    /// The signal.
    pub wish: Wish,
    /// The name of its column.
    pub column: String,
    /// What is assumed, in the words of the command line.
    pub assumed: Vec<String>,
}

/// Limits of an axis that slides and of one that turns, where none is given: those of the library's `Stroke`.
const SLIDES: [&str; 4] = ["100 [mm]", "100 [mm/s]", "1 [m/s2]", "50 [m/s3]"];
const TURNS: [&str; 4] = ["90 [deg]", "90 [deg/s]", "900 [deg/s2]", "45000 [deg/s3]"];
const NAMES: [&str; 4] = ["travel", "speed", "acceleration", "jerk"];
const EFFORTS: [&str; 4] = ["A", "N", "N.m", "V"];
const DURATION: &str = "20 [s]";
const EVERY: &str = "1 [ms]";
/// A band of which nothing is said begins with the fourth part of the record, or here, and ends here, Hz.
const BAND_HZ: (f64, f64) = (1.0, 100.0);
/// A sine of the highest frequency has so many samples.
const SAMPLES_OF_A_SINE: f64 = 10.0;

/// What the options ask for.
///
/// # Errors
/// What cannot be, with what to write instead.
pub fn of(options: &Options) -> Result<Wished, String> {
    let mut assumed = Vec::new();
    let (bounds, unit) = bounds(options, &mut assumed)?;
    let mut time = |name: &str, given: &Option<String>, usual: &str| {
        let text = or_assumed(name, given.as_ref(), usual, &mut assumed);
        let found = quantity(name, &text, &["s"])?;
        match found.value > 0.0 {
            true => Ok(found.value),
            false => Err(format!(
                "`--{name} '{text}'` is not positive\n  help: write `--{name} '{usual}'`"
            )),
        }
    };
    let duration_s = time("duration", &options.duration, DURATION)?;
    let step_s = time("every", &options.every, EVERY)?;
    // With a model all kinds are compared, and the wish is for each of them.
    let shape = options.signal.first().copied().unwrap_or(Shape::Multisine);
    let compared = options.of_model;
    let banded = matches!(shape, Shape::Multisine | Shape::Chirp);
    let band_hz = match &options.band {
        Some(text) => quantity::band(text)?,
        None => {
            let from = BAND_HZ.0.max(4.0 / duration_s);
            let to = BAND_HZ
                .1
                .min(1.0 / (SAMPLES_OF_A_SINE * step_s))
                .max(2.0 * from);
            if banded || compared {
                assumed.push(format!(
                    "--band '{} .. {} [Hz]'",
                    hyde_units::significant(from, 4),
                    hyde_units::significant(to, 4)
                ));
            }
            (from, to)
        }
    };
    let own = |option: &str, given: &Option<String>| {
        let text = given.as_ref();
        text.map(|text| quantity(option, text, &[unit.text()]))
            .transpose()
    };
    let start = own("start", &options.start)?.map_or(0.0, |found| found.value);
    let reversal = match (own("reversal", &options.reversal)?, bounds) {
        (Some(found), _) => found.value,
        (None, Bounds::Motion(limits)) => {
            let size = 1e-3 * limits.travel;
            if shape == Shape::Reversals || compared {
                assumed.push(format!(
                    "--reversal '{} [{unit}]'",
                    hyde_units::significant(unit.unit().from_si(size), 6)
                ));
            }
            size
        }
        (None, Bounds::Effort(_)) => 0.0,
    };
    if reversal <= 0.0 && matches!(bounds, Bounds::Motion(_)) {
        return Err(format!(
            "`--reversal` is not positive\n  help: write a size larger than the backlash, `--reversal '0.2 [{unit}]'`"
        ));
    }
    let usual = match bounds {
        Bounds::Motion(_) => "r",
        Bounds::Effort(_) => "u",
    };
    let column = options.column.clone().unwrap_or_else(|| usual.to_owned());
    if column.is_empty() || column.contains(['"', ',', '\n', '[', ']']) {
        return Err(format!(
            "`--column '{column}'` cannot be the name of a column\n  help: write letters and digits, `--column r`"
        ));
    }
    if options.start.is_none() && matches!(bounds, Bounds::Motion(_)) {
        assumed.push(format!("--start '0 [{unit}]'"));
    }
    Ok(Wished {
        wish: Wish {
            shape,
            bounds,
            band_hz,
            duration_s,
            step_s,
            start,
            unit,
            speeds: options.speeds,
            places: options.places,
            reversal,
        },
        column,
        assumed,
    })
}

/// The limits, and the unit of the column.
fn bounds(options: &Options, assumed: &mut Vec<String>) -> Result<(Bounds, NamedUnit), String> {
    if let Some(text) = &options.effort {
        let Quantity { value, unit } = quantity("effort", text, &EFFORTS)?;
        positive("effort", text, value, "10 [A]")?;
        if let (false, Some(name)) = (
            options.of_model,
            (0..4).find(|&n| option(options, n).is_some()),
        ) {
            return Err(format!(
                "`--{}` cannot be used with the limit of an effort: only a model says how far that moves the axis\n  help: name the file of a model, or leave one of them out",
                NAMES[name]
            ));
        }
        let unit = unit_of(options, unit)?;
        return Ok((Bounds::Effort(value), unit));
    }
    let mut found: [Option<Quantity>; 4] = [None, None, None, None];
    for (number, own) in found.iter_mut().enumerate() {
        *own = limit(options, number)?;
    }
    // An axis slides if no limit says that it turns.
    let turned = |number: usize| Some(turns(&found[number].as_ref()?.unit, number));
    let kinds: Vec<(usize, bool)> = (0..4)
        .filter_map(|number| Some((number, turned(number)?)))
        .collect();
    let is_turned = kinds.first().is_some_and(|(_, turns)| *turns);
    if let (Some((first, _)), Some((other, _))) = (
        kinds.first(),
        kinds.iter().find(|(_, own)| *own != is_turned),
    ) {
        return Err(format!(
            "`--{}` is of an axis that {}, `--{}` of one that {}\n  help: give all limits in units of one kind",
            NAMES[*first],
            if is_turned { "turns" } else { "slides" },
            NAMES[*other],
            if is_turned { "slides" } else { "turns" },
        ));
    }
    let usual = if is_turned { TURNS } else { SLIDES };
    let mut values = [0.0; 4];
    for (number, value) in values.iter_mut().enumerate() {
        *value = match &found[number] {
            Some(own) => own.value,
            None => {
                let text = or_assumed(NAMES[number], None, usual[number], assumed);
                quantity(
                    NAMES[number],
                    &text,
                    &[units(number)[usize::from(is_turned)].as_str()],
                )?
                .value
            }
        };
    }
    let [travel, speed, acceleration, jerk] = values;
    let own = match &found[0] {
        Some(travel) => travel.unit.clone(),
        None => named(if is_turned { "deg" } else { "mm" })?,
    };
    let unit = unit_of(options, own)?;
    let limits = Limits {
        travel,
        speed,
        acceleration,
        jerk,
    };
    Ok((Bounds::Motion(limits), unit))
}

/// The text of a limit of a motion: travel, speed, acceleration, jerk.
fn option(options: &Options, number: usize) -> Option<&String> {
    options.motion[number].as_ref()
}

/// The units of such a limit: of an axis that slides, and of one that turns.
fn units(number: usize) -> [String; 2] {
    let per = ["", "/s", "/s2", "/s3"][number];
    [format!("mm{per}"), format!("deg{per}")]
}

/// Such a limit, if it is given.
pub(super) fn limit(options: &Options, number: usize) -> Result<Option<Quantity>, String> {
    let Some(text) = option(options, number) else {
        return Ok(None);
    };
    let [slides, turns] = units(number);
    let own = quantity(NAMES[number], text, &[&slides, &turns])?;
    positive(NAMES[number], text, own.value, SLIDES[number])?;
    Ok(Some(own))
}

/// Whether a unit of such a limit is that of an axis that turns.
pub(super) fn turns(unit: &NamedUnit, number: usize) -> bool {
    let slides = NamedUnit::parse(&units(number)[0]);
    slides.is_ok_and(|slides| {
        let (own, known) = (unit.unit().dimension, slides.unit().dimension);
        own.agreement(known) != Agreement::Same
    })
}

fn positive(name: &str, text: &str, value: f64, usual: &str) -> Result<(), String> {
    match value > 0.0 {
        true => Ok(()),
        false => Err(format!(
            "`--{name} '{text}'` is not positive\n  help: write the largest size either way, `--{name} '{usual}'`"
        )),
    }
}

/// The unit of the column: that which is given, if it is of the same dimension.
fn unit_of(options: &Options, usual: NamedUnit) -> Result<NamedUnit, String> {
    let Some(text) = &options.unit else {
        return Ok(usual);
    };
    let dimension = |unit: &NamedUnit| -> Dimension { unit.unit().dimension };
    let unit = named(text)?;
    match dimension(&unit).agreement(dimension(&usual)) == Agreement::Same {
        true => Ok(unit),
        false => Err(format!(
            "`--unit {text}`: the limits are in {usual}\n  help: write a unit of the same kind, `--unit {usual}`"
        )),
    }
}

fn named(text: &str) -> Result<NamedUnit, String> {
    let text = text.trim_start_matches('[').trim_end_matches(']');
    NamedUnit::parse(text).map_err(|error| format!("`--unit {text}`: {error}"))
}

fn or_assumed(
    name: &str,
    given: Option<&String>,
    usual: &str,
    assumed: &mut Vec<String>,
) -> String {
    given.cloned().unwrap_or_else(|| {
        assumed.push(format!("--{name} '{usual}'"));
        usual.to_owned()
    })
}
