//! [`design`]: a signal of a kind, asked for and made.

use super::chirp::chirp;
use super::jogs::{jogs, slowed_by};
use super::limits::{Bounds, Impossible, Peak, Quantity};
use super::multisine::multisine;
use super::path::{Leg, Path};
use super::pulses::pulses;
use super::reversals::reversals;
use super::written::{PLANNED, Size, Written, decimals, digits, written};
use hyde_units::NamedUnit;
use std::fmt;

/// A record has at most so many samples.
const LONGEST: f64 = 5e6;
/// A chirp needs so many samples of its last sine, a multisine a little more than two.
const SAMPLES_OF_A_SINE: f64 = 5.0;

/// A kind of signal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Sines at all lines of a band, phases of low crest.
    Multisine,
    /// One sine through a band.
    Chirp,
    /// Strokes both ways at several speeds; of an effort pulses of several sizes.
    Jogs,
    /// Small moves there and back at several places.
    Reversals,
}

impl fmt::Display for Shape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Multisine => "multisine",
            Self::Chirp => "chirp",
            Self::Jogs => "jogs",
            Self::Reversals => "reversals",
        })
    }
}

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Wish {
    /// The kind.
    pub shape: Shape,
    /// What must not be exceeded.
    pub bounds: Bounds,
    /// The band of a multisine or chirp, Hz.
    pub band_hz: (f64, f64),
    /// How long the record is, s.
    pub duration_s: f64,
    /// Its sampling period, s.
    pub step_s: f64,
    /// Where the axis stands at first, SI.
    pub start: f64,
    /// The unit that it is written in.
    pub unit: NamedUnit,
    /// The number of speeds of jogs, or of sizes of pulses.
    pub speeds: usize,
    /// The number of places of reversals.
    pub places: usize,
    /// The size of a reversal, SI.
    pub reversal: f64,
}

/// The lines of a multisine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lines {
    /// The lowest one, Hz.
    pub first_hz: f64,
    /// How far they are apart, Hz: one over the period.
    pub apart_hz: f64,
    /// How many.
    pub count: usize,
    /// Crest factor within a period: the largest peak over the largest root mean square, each in units of its limit.
    pub crest: f64,
}

/// A signal as it is written.
#[derive(Clone, Debug, PartialEq)]
pub struct Design {
    /// What was asked for.
    pub wish: Wish,
    /// What it reaches of each limit.
    pub peaks: Vec<Peak>,
    /// The lines of a multisine.
    pub lines: Option<Lines>,
    /// The moves of jogs and reversals; none of others.
    pub legs: Vec<Leg>,
    /// The limit that keeps jogs from the speed that they may have.
    pub slowed_by: Option<Quantity>,
    counts: Vec<i64>,
    decimals: i32,
}

/// Makes a design.
///
/// # Errors
/// No signal of the kind keeps the limits: see [`Impossible`].
pub fn design(wish: &Wish) -> Result<Design, Impossible> {
    check(wish)?;
    let rows = (wish.duration_s / wish.step_s).round() as usize + 1;
    let (bounds, step_s) = (&wish.bounds, wish.step_s);
    let (mut lines, mut path) = (None, None);
    let mut slowed = None;
    let samples = match (wish.shape, bounds) {
        (Shape::Multisine, _) => {
            let made = multisine(bounds, wish.band_hz, rows, step_s)?;
            let apart_hz = 1.0 / (made.period as f64 * step_s);
            lines = Some(Lines {
                first_hz: made.first as f64 * apart_hz,
                apart_hz,
                count: made.lines,
                crest: made.crest,
            });
            made.samples
        }
        (Shape::Chirp, _) => chirp(bounds, wish.band_hz, rows, step_s),
        (Shape::Jogs, Bounds::Effort(_)) => pulses(wish.speeds, rows),
        (Shape::Reversals, Bounds::Effort(_)) => return Err(Impossible::NoMotion),
        (Shape::Jogs | Shape::Reversals, Bounds::Motion(limits)) => {
            let planned = limits.times(PLANNED);
            let mut made = match wish.shape {
                Shape::Jogs => {
                    slowed = slowed_by(&planned);
                    jogs(&planned, wish.speeds, wish.duration_s)?
                }
                Shape::Multisine | Shape::Chirp | Shape::Reversals => {
                    reversals(&planned, wish.places, wish.reversal, wish.duration_s)?
                }
            };
            made.wait((wish.duration_s - made.duration_s()).max(0.0));
            let samples = made.samples(rows, step_s);
            path = Some(made);
            samples
        }
    };
    let size = match path {
        Some(_) => Size::AsItIs,
        None => Size::Largest,
    };
    let unit = wish.unit.unit();
    let Written {
        counts,
        decimals,
        peaks,
    } = written(&samples, wish.start, unit, step_s, bounds, size)?;
    Ok(Design {
        wish: wish.clone(),
        peaks,
        lines,
        legs: path.map_or_else(Vec::new, |path: Path| path.legs),
        slowed_by: slowed,
        counts,
        decimals,
    })
}

fn check(wish: &Wish) -> Result<(), Impossible> {
    let positive = |value: f64, quantity| match value > 0.0 && value.is_finite() {
        true => Ok(()),
        false => Err(Impossible::NotPositive(quantity)),
    };
    match wish.bounds {
        Bounds::Effort(peak) => positive(peak, Quantity::Effort)?,
        Bounds::Motion(limits) => {
            positive(limits.travel, Quantity::Travel)?;
            positive(limits.speed, Quantity::Speed)?;
            positive(limits.acceleration, Quantity::Acceleration)?;
            positive(limits.jerk, Quantity::Jerk)?;
        }
    }
    let rows = wish.duration_s / wish.step_s;
    if rows.is_nan() || rows > LONGEST || wish.step_s <= 0.0 {
        return Err(Impossible::Long);
    }
    if rows < 20.0 {
        return Err(Impossible::Short {
            needed_s: 20.0 * wish.step_s,
            binds: Quantity::Speed,
        });
    }
    let one = wish.unit.unit().difference_to_si(1.0);
    decimals(&wish.bounds, wish.start, one, wish.step_s)?;
    let banded = matches!(wish.shape, Shape::Multisine | Shape::Chirp);
    if !banded {
        return Ok(());
    }
    let (from_hz, to_hz) = wish.band_hz;
    if !(from_hz > 0.0 && to_hz > from_hz && to_hz.is_finite()) {
        return Err(Impossible::Band(from_hz, to_hz));
    }
    let most_hz = 1.0 / (SAMPLES_OF_A_SINE * wish.step_s);
    if to_hz > most_hz * (1.0 + 1e-9) {
        return Err(Impossible::High { to_hz, most_hz });
    }
    let needed_s = 2.0 / from_hz;
    if wish.shape == Shape::Chirp && wish.duration_s < needed_s {
        return Err(Impossible::Low { from_hz, needed_s });
    }
    Ok(())
}

impl Design {
    /// Number of samples.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.counts.len()
    }

    /// The value of a sample as it is written, in the unit of the design.
    #[must_use]
    pub fn cell(&self, row: usize) -> String {
        self.counts
            .get(row)
            .map_or_else(String::new, |&count| digits(count, self.decimals))
    }

    /// The samples as they are written, SI.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        let unit = self.wish.unit.unit();
        let last = 10.0_f64.powi(self.decimals);
        let each = self.counts.iter();
        each.map(|&count| unit.difference_to_si(count as f64 / last))
            .collect()
    }

    /// The time of a sample, s, as it is written.
    #[must_use]
    pub fn time(&self, row: usize) -> f64 {
        let exact = row as f64 * self.wish.step_s;
        // Nanoseconds: a product of a period has more digits than anybody wrote.
        (exact * 1e9).round() / 1e9
    }

    /// What is nearest to its limit.
    #[must_use]
    pub fn binds(&self) -> Option<&Peak> {
        self.peaks
            .iter()
            .max_by(|a, b| a.part().total_cmp(&b.part()))
    }

    /// Samples in counts of the last decimal, and how many decimals there are.
    pub(super) fn counts(&self) -> (&[i64], i32) {
        (&self.counts, self.decimals)
    }
}

mod joined;
#[cfg(test)]
mod tests;
