//! Why there is no such signal: the limit that binds, and what to write instead.

use hyde_signal::excite::{Bounds, Impossible, Quantity, Shape, Wish};
use hyde_units::significant;

/// The reason and the advice, in lines.
pub fn reason(impossible: &Impossible, wish: &Wish) -> String {
    let shape = wish.shape;
    let (message, help) = match *impossible {
        Impossible::Band(from, to) => (
            format!(
                "a band from {} Hz to {} Hz is empty",
                significant(from, 4),
                significant(to, 4)
            ),
            "write the lower frequency first, `--band '1 .. 100 [Hz]'`".to_owned(),
        ),
        Impossible::Low { from_hz, needed_s } => (
            format!(
                "the duration limits the band: {} s are too short for {} Hz",
                significant(wish.duration_s, 4),
                significant(from_hz, 4)
            ),
            format!(
                "write `--duration '{} [s]'`, or a band that begins higher",
                upwards(needed_s)
            ),
        ),
        Impossible::High { to_hz, most_hz } => (
            format!(
                "the sampling period limits the band: samples every {} ms show up to {} Hz, not {} Hz",
                significant(wish.step_s * 1e3, 4),
                significant(most_hz, 4),
                significant(to_hz, 4)
            ),
            format!(
                "write `--every '{} [ms]'`, or a band that ends at {} Hz",
                downwards(1e3 * wish.step_s * most_hz / to_hz),
                significant(most_hz, 4)
            ),
        ),
        Impossible::Narrow { needed_s } => (
            "the band has no line: a period of the record is one over the distance of the lines"
                .to_owned(),
            format!(
                "write `--duration '{} [s]'`, or a wider band",
                upwards(needed_s)
            ),
        ),
        Impossible::Short { needed_s, binds } => (
            format!(
                "the {shape} take {} s and the record {} s; the {} limits them",
                significant(needed_s, 4),
                significant(wish.duration_s, 4),
                name(binds)
            ),
            format!(
                "write `--duration '{} [s]'`, a higher `--{}`, or fewer {}",
                upwards(needed_s),
                option(binds),
                match wish.shape {
                    Shape::Reversals => "`--places`",
                    Shape::Multisine | Shape::Chirp | Shape::Jogs => "`--speeds`",
                }
            ),
        ),
        Impossible::Reversal => (
            "the travel limits the reversals: they do not fit at its ends".to_owned(),
            "write a smaller `--reversal` or a larger `--travel`".to_owned(),
        ),
        Impossible::Digits(quantity) => (
            format!(
                "the {} is too small for samples every {} ms: 15 digits do not resolve it",
                name(quantity),
                significant(wish.step_s * 1e3, 4)
            ),
            format!(
                "write a longer `--every` or a higher `--{}`",
                option(quantity)
            ),
        ),
        Impossible::Long => (
            "the record has more than 5 million samples".to_owned(),
            "write a shorter `--duration` or a longer `--every`".to_owned(),
        ),
        Impossible::NotPositive(quantity) => (
            format!("the limit of the {} is not positive", name(quantity)),
            format!("write a positive `--{}`", option(quantity)),
        ),
        Impossible::NoMotion => (
            format!(
                "{shape} are moves of a position, and the limit is {}",
                match wish.bounds {
                    Bounds::Effort(_) => "that of an effort",
                    Bounds::Motion(_) => "that of a motion",
                }
            ),
            "write `--signal jogs`, or limit a motion with `--travel`".to_owned(),
        ),
    };
    format!("{message}\n  help: {help}")
}

/// What is limited, in words.
pub fn name(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Travel => "travel",
        Quantity::Speed => "speed",
        Quantity::Acceleration => "acceleration",
        Quantity::Jerk => "jerk",
        Quantity::Effort => "effort",
    }
}

fn option(quantity: Quantity) -> &'static str {
    name(quantity)
}

/// Two digits, rounded so that the advice holds.
fn upwards(value: f64) -> String {
    rounded(value * (1.0 + 1e-6), f64::ceil)
}

fn downwards(value: f64) -> String {
    rounded(value * (1.0 - 1e-9), f64::floor)
}

fn rounded(value: f64, way: fn(f64) -> f64) -> String {
    let unit = 10.0_f64.powf(value.log10().floor() - 1.0);
    significant(way(value / unit) * unit, 3)
}
