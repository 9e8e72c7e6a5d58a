//! [`ResidualMap`]: what innovations depend on: their mean over time, measured quantities, their speeds, the time since a
//! reversal and the place in a turn, and their power over frequency; each with what shuffled innovations stay below.
//!
//! Rows are put into bins of equal numbers. The band of a mean comes from innovations whose blocks of 50 ms have random
//! signs, so that what makes them alike from row to row is kept, and what ties them to the motion is not; that of the
//! power from innovations in random order. Moving them round their record would not do: a motion that repeats would fit
//! again. It holds for all bins of a map together: the largest of 99 draws (a permutation test at 1 %; Phipson and Smyth,
//! Stat. Appl. Genet. Mol. Biol. 9, 2010, 39).

mod variable;

use crate::observer::Innovations;
use crate::records::Recording;
use hyde_program::Program;
use hyde_signal::spectrum::power_spectral_density;
use hyde_units::{Dimension, NamedUnit};
use rayon::prelude::*;
use variable::{Variable, variables};

/// Bins of a map.
const BINS: usize = 24;
/// Draws of a permutation test.
const DRAWS: usize = 99;
/// Length of the blocks that keep one sign, in s.
const BLOCK_S: f64 = 0.05;
/// Rows of a segment of a spectrum.
const SEGMENT: usize = 512;

/// Innovations of a channel over something.
#[derive(Clone, Debug, PartialEq)]
pub struct ResidualMap {
    /// The channel.
    pub channel: String,
    /// Over what: `x`, `speed of x`, `frequency`.
    pub over: String,
    /// The unit that it is declared in; the bins are SI.
    pub unit: NamedUnit,
    /// Middles of the bins, SI.
    pub bins: Vec<f64>,
    /// Mean of the whitened innovations in each bin, before; over frequency their power beyond an even one.
    pub before: Vec<f64>,
    /// After.
    pub after: Vec<f64>,
    /// What chance stays within, after.
    pub band: Vec<f64>,
    /// How many times the band the largest bin is, before and after: above 1 it is no chance.
    pub excess: (f64, f64),
}

/// Every map of every channel over records, those that say most before first.
#[must_use]
pub fn residual_maps(
    program: &Program,
    recordings: &[Recording],
    before: &[&Innovations],
    after: &[&Innovations],
) -> Vec<ResidualMap> {
    let variables = variables(program, recordings);
    let measured = &program.experiment.measured;
    let mut tasks: Vec<(usize, Option<&Variable>)> = Vec::new();
    for channel in 0..measured.len() {
        tasks.extend(variables.iter().map(|variable| (channel, Some(variable))));
        tasks.push((channel, None));
    }
    let rate_hz = recordings.first().map_or(1.0, |r| 1.0 / r.step_s);
    let hertz = NamedUnit::parse("Hz");
    let hertz = hertz.unwrap_or_else(|_| NamedUnit::usual(Dimension::FREQUENCY));
    let mut maps: Vec<ResidualMap> = tasks
        .par_iter()
        .filter_map(|&(channel, variable)| {
            let of = |all: &[&Innovations]| -> Vec<Vec<f64>> {
                let each = all.iter().map(|own| own.of_readings(channel).into_owned());
                each.collect()
            };
            let (old, new) = (of(before), of(after));
            // A channel that is read in some rows only has fewer readings a second.
            let rows: usize = after.iter().map(|own| own.channels[channel].len()).sum();
            let readings: usize = new.iter().map(Vec::len).sum();
            let rate_hz = rate_hz * readings.max(1) as f64 / rows.max(1) as f64;
            let block = ((BLOCK_S * rate_hz).round() as usize).max(1);
            let (over, unit, sorted) = match variable {
                Some(variable) => {
                    let values = variable.values.iter().zip(after);
                    let values = values.map(|(values, own)| own.of_rows(channel, values));
                    let bins = Bins::of(&values.collect::<Vec<_>>())?;
                    let tested = |lists: &[Vec<f64>]| bins.tested(lists, block);
                    (variable.name.clone(), variable.unit.clone(), {
                        let (old, new) = (tested(&old), tested(&new));
                        (bins.middles.clone(), old, new)
                    })
                }
                None => {
                    let (middles, old) = powers(&old, rate_hz)?;
                    let (_, new) = powers(&new, rate_hz)?;
                    ("frequency".to_owned(), hertz.clone(), (middles, old, new))
                }
            };
            let (bins, old, new) = sorted;
            Some(ResidualMap {
                channel: measured[channel].name.clone(),
                over,
                unit,
                bins,
                excess: (old.excess(), new.excess()),
                before: old.values,
                after: new.values,
                band: new.band,
            })
        })
        .collect();
    maps.sort_by(|a, b| b.excess.0.total_cmp(&a.excess.0));
    maps
}

/// Rows by their bin; the number of bins where a row has none.
struct Bins {
    middles: Vec<f64>,
    of_rows: Vec<Vec<usize>>,
    counts: Vec<f64>,
}

/// Values of bins, their band, and its test.
struct Tested {
    values: Vec<f64>,
    band: Vec<f64>,
}

impl Tested {
    fn excess(&self) -> f64 {
        let each = self.values.iter().zip(&self.band);
        each.map(|(value, band)| value.abs() / band)
            .filter(|part| part.is_finite())
            .fold(0.0, f64::max)
    }
}

impl Bins {
    /// Bins with equal numbers of rows; `None` where the variable has too few values to tell apart.
    fn of(values: &[impl AsRef<[f64]>]) -> Option<Self> {
        let each = || values.iter().flat_map(|list| list.as_ref().iter());
        let mut all: Vec<f64> = each().copied().collect();
        all.retain(|value| value.is_finite());
        all.sort_unstable_by(f64::total_cmp);
        let mut edges: Vec<f64> = (1..BINS)
            .map(|bin| all.get(bin * all.len() / BINS).copied())
            .collect::<Option<Vec<f64>>>()?;
        edges.dedup();
        if edges.len() < 3 || all.len() < 20 * BINS {
            return None;
        }
        let count = edges.len() + 1;
        let bin = |value: &f64| match value.is_finite() {
            true => edges.partition_point(|edge| edge <= value),
            false => count,
        };
        let of_rows: Vec<Vec<usize>> = values
            .iter()
            .map(|list| list.as_ref().iter().map(bin).collect())
            .collect();
        let (mut sums, mut counts) = (vec![0.0; count], vec![0.0; count]);
        for (value, &bin) in each().zip(of_rows.iter().flatten()) {
            if bin < count {
                sums[bin] += value;
                counts[bin] += 1.0;
            }
        }
        Some(Self {
            middles: sums.iter().zip(&counts).map(|(s, n)| s / n).collect(),
            of_rows,
            counts,
        })
    }

    /// Mean in each bin, each block of a record times its sign.
    fn means(&self, lists: &[Vec<f64>], block: usize, mut sign: impl FnMut() -> f64) -> Vec<f64> {
        let mut sums = vec![0.0; self.counts.len() + 1];
        for (list, bins) in lists.iter().zip(&self.of_rows) {
            for (values, bins) in list.chunks(block).zip(bins.chunks(block)) {
                let sign = sign();
                for (value, &bin) in values.iter().zip(bins) {
                    sums[bin] += sign * value;
                }
            }
        }
        sums.iter().zip(&self.counts).map(|(s, n)| s / n).collect()
    }

    fn tested(&self, lists: &[Vec<f64>], block: usize) -> Tested {
        let mut random = Random(1);
        let mut largest = 0.0_f64;
        for _ in 0..DRAWS {
            let means = self.means(lists, block, || [-1.0, 1.0][random.below(2)]);
            let sizes = means.iter().zip(&self.counts);
            largest = sizes.fold(largest, |most, (mean, n)| most.max(mean.abs() * n.sqrt()));
        }
        Tested {
            values: self.means(lists, block, || 1.0),
            band: self.counts.iter().map(|n| largest / n.sqrt()).collect(),
        }
    }
}

/// Power in bands of frequency beyond an even one; `None` where records are too short.
fn powers(lists: &[Vec<f64>], rate_hz: f64) -> Option<(Vec<f64>, Tested)> {
    let spectrum = |lists: &[Vec<f64>]| -> Option<(Vec<f64>, Vec<f64>)> {
        let mut sum: Vec<f64> = Vec::new();
        let mut frequency_hz = Vec::new();
        for list in lists {
            let density = power_spectral_density(list, rate_hz, SEGMENT).ok()?;
            sum.resize(density.1.len(), 0.0);
            let part = 0.5 * rate_hz / lists.len() as f64;
            for (sum, value) in sum.iter_mut().zip(&density.1) {
                *sum += part * value;
            }
            frequency_hz = density.0;
        }
        Some((frequency_hz, sum))
    };
    let (frequency_hz, plain) = spectrum(lists)?;
    let low = frequency_hz.get(2).copied()?;
    let high = frequency_hz.last().copied()?;
    let edge = |bin: usize| low * (high / low).powf(bin as f64 / BINS as f64);
    let bins: Vec<Vec<usize>> = (0..BINS)
        .map(|bin| {
            let inside = |line: &usize| (edge(bin)..edge(bin + 1)).contains(&frequency_hz[*line]);
            (0..frequency_hz.len()).filter(inside).collect()
        })
        .filter(|lines: &Vec<usize>| !lines.is_empty())
        .collect();
    let mean = |values: &[f64], lines: &[usize]| {
        lines.iter().map(|&line| values[line]).sum::<f64>() / lines.len() as f64
    };
    let beyond = |values: &[f64]| -> Vec<f64> {
        let even = values.iter().sum::<f64>() / values.len() as f64;
        bins.iter()
            .map(|lines| mean(values, lines) - even)
            .collect()
    };
    let mut random = Random(2);
    let mut shuffled = lists.to_vec();
    let mut largest = 0.0_f64;
    for _ in 0..DRAWS {
        for list in &mut shuffled {
            for row in (1..list.len()).rev() {
                list.swap(row, random.below(row + 1));
            }
        }
        let found = beyond(&spectrum(&shuffled)?.1);
        let sizes = found.iter().zip(&bins);
        largest = sizes.fold(largest, |most, (value, lines)| {
            most.max(value.abs() * (lines.len() as f64).sqrt())
        });
    }
    let band = bins
        .iter()
        .map(|lines| largest / (lines.len() as f64).sqrt());
    let middles = bins.iter().map(|lines| mean(&frequency_hz, lines));
    Some((
        middles.collect(),
        Tested {
            values: beyond(&plain),
            band: band.collect(),
        },
    ))
}

/// Numbers of a linear congruential generator (Knuth, MMIX): the same on every machine.
struct Random(u64);

impl Random {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let part = (self.0 >> 11) as f64 / (1_u64 << 53) as f64;
        ((part * count as f64) as usize).min(count.saturating_sub(1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// Noise of unit variance.
    fn noise(seed: u64, rows: usize) -> Vec<f64> {
        let mut random = Random(seed);
        let mut normal = || (0..12).map(|_| random.below(1 << 20) as f64).sum::<f64>();
        let scale = f64::from(1 << 20);
        (0..rows).map(|_| normal() / scale - 6.0).collect()
    }

    #[test]
    fn a_mean_that_goes_with_the_place_is_seen_and_noise_is_not() {
        let rows = 24_000;
        let place: Vec<f64> = (0..rows).map(|k| (k as f64 * 0.0131).sin()).collect();
        let bins = Bins::of(std::slice::from_ref(&place)).unwrap();
        let plain = noise(7, rows);
        assert!(bins.tested(std::slice::from_ref(&plain), 50).excess() < 1.5);
        let tied: Vec<f64> = plain.iter().zip(&place).map(|(e, x)| e + 0.5 * x).collect();
        let tested = bins.tested(&[tied], 50);
        assert!(tested.excess() > 2.0, "{}", tested.excess());
        // The mean in the outermost bins is 0.5 times the place there, which is nearly 1; sd of a bin is 1/sqrt(1000).
        assert!((tested.values[0] + 0.5).abs() < 0.2);
    }

    #[test]
    fn an_oscillation_is_seen_where_it_is() {
        let rows = 6000;
        let with = |amplitude: f64| -> Vec<f64> {
            let wave = (0..rows).map(|k| amplitude * (TAU * 40.0 * k as f64 / 1000.0).sin());
            noise(3, rows)
                .iter()
                .zip(wave)
                .map(|(e, w)| e + w)
                .collect()
        };
        let (_, plain) = powers(&[with(0.0)], 1000.0).unwrap();
        assert!(plain.excess() < 1.5, "{}", plain.excess());
        let (middles, seen) = powers(&[with(0.5)], 1000.0).unwrap();
        assert!(seen.excess() > 2.0, "{}", seen.excess());
        let top = (0..middles.len()).max_by(|&a, &b| seen.values[a].total_cmp(&seen.values[b]));
        let at = middles[top.unwrap()];
        // The bands there are 20 % wide.
        assert!((at / 40.0 - 1.0).abs() < 0.25, "{at}");
    }
}
