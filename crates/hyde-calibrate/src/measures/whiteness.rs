//! [`Whiteness`]: whether innovations go with themselves from row to row, and with those of other channels.
//!
//! Those of a model that is right are white and do not go with each other (Ljung, System Identification, 2nd ed. 1999,
//! section 16.6).

use crate::observer::Innovations;
use hyde_program::Program;
use hyde_signal::statistics::autocorrelation;
use rayon::prelude::*;

/// How innovations of a channel go with themselves and with what was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Whiteness {
    /// The channel.
    pub channel: String,
    /// Correlation of successive innovations, before and after.
    pub correlation: (f64, f64),
    /// With which channel's innovations at which distance in rows it goes together most, after; and the correlation.
    pub cross: Option<(String, isize, f64)>,
    /// What correlations of white noise stay below, 99 times of 100.
    pub limit: f64,
}

/// Whether innovations are white, and do not go with each other.
#[must_use]
pub fn whiteness(
    program: &Program,
    before: &[&Innovations],
    after: &[&Innovations],
) -> Vec<Whiteness> {
    const LAGS: isize = 20;
    let names: Vec<&str> = program
        .experiment
        .measured
        .iter()
        .map(|measured| measured.name.as_str())
        .collect();
    let mean = |all: &[&Innovations], channel: usize| {
        let lists = all.iter().map(|own| own.of_readings(channel));
        let rows: usize = lists.clone().map(|list| list.len()).sum();
        let each = lists.map(|list| autocorrelation(&list, 1) * list.len() as f64);
        each.sum::<f64>() / (rows as f64).max(1.0)
    };
    let cross = |channel: usize| {
        let mut most: Option<(String, isize, f64)> = None;
        for (other, name) in names.iter().enumerate().filter(|(o, _)| *o != channel) {
            for lag in -LAGS..=LAGS {
                let found = crossed(after, channel, other, lag);
                if most
                    .as_ref()
                    .is_none_or(|(.., known)| found.abs() > known.abs())
                {
                    most = Some(((*name).to_owned(), lag, found));
                }
            }
        }
        most
    };
    (0..names.len())
        .into_par_iter()
        .map(|channel| {
            let lists = after.iter().map(|own| own.of_readings(channel));
            let rows: usize = lists.map(|list| list.len()).sum();
            Whiteness {
                channel: names[channel].to_owned(),
                correlation: (mean(before, channel), mean(after, channel)),
                cross: cross(channel),
                // Correlations of white noise are normal with a variance of 1/rows; 41 distances are looked at.
                limit: 3.7 / (rows as f64).max(1.0).sqrt(),
            }
        })
        .collect()
}

/// Correlation of a channel with another one some rows later, over all records.
fn crossed(all: &[&Innovations], channel: usize, other: usize, lag: isize) -> f64 {
    let (mut product, mut own_square, mut other_square) = (0.0, 0.0, 0.0);
    for innovations in all {
        let (own, other) = (&innovations.channels[channel], &innovations.channels[other]);
        let skip = lag.unsigned_abs();
        let (first, second) = match lag >= 0 {
            true => (own.as_slice(), other.get(skip..).unwrap_or_default()),
            false => (own.get(skip..).unwrap_or_default(), other.as_slice()),
        };
        product += first.iter().zip(second).map(|(a, b)| a * b).sum::<f64>();
        own_square += own.iter().map(|a| a * a).sum::<f64>();
        other_square += other.iter().map(|b| b * b).sum::<f64>();
    }
    let scale = (own_square * other_square).sqrt();
    if scale > 0.0 { product / scale } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_that_follows_another_is_found_at_its_distance() {
        // A linear congruential generator (Knuth, MMIX), of which the second channel is three rows late.
        let mut seed = 1_u64;
        let numbers: Vec<f64> = (0..2003)
            .map(|_| {
                seed = seed
                    .wrapping_mul(6_364_136_223_846_793_005)
                    .wrapping_add(1_442_695_040_888_963_407);
                (seed >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
            })
            .collect();
        let (first, second) = (numbers[3..].to_vec(), numbers[..2000].to_vec());
        let innovations = Innovations {
            channels: vec![first, second],
            counts: vec![0.0; 2],
            absent: Vec::new(),
        };
        let at = |lag| crossed(&[&innovations], 0, 1, lag);
        assert!(at(3) > 0.99, "{}", at(3));
        // 4 standard deviations of 2000 rows.
        assert!(
            at(2).abs() < 0.09 && at(-3).abs() < 0.09,
            "{} {}",
            at(2),
            at(-3)
        );
    }
}
