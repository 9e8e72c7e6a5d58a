//! Designs one after another, and smaller ones.

use super::Design;

/// The axis stands for so many samples between two designs: their differences do not overlap.
const BETWEEN: usize = 4;

impl Design {
    /// Designs of one column one after another; `None` of none, or where one begins elsewhere than the one before ends.
    #[must_use]
    pub fn joined(parts: Vec<Self>) -> Option<Self> {
        let mut parts = parts.into_iter();
        let mut all = parts.next()?;
        for next in parts {
            let decimals = all.decimals.max(next.decimals);
            let finer = |own: &Self| -> Option<Vec<i64>> {
                let times = 10_i64.checked_pow(u32::try_from(decimals - own.decimals).ok()?)?;
                own.counts.iter().map(|c| c.checked_mul(times)).collect()
            };
            let (mut counts, own) = (finer(&all)?, finer(&next)?);
            let last = *counts.last()?;
            if own.first() != Some(&last) {
                return None;
            }
            counts.extend([last; BETWEEN]);
            let begin_s = counts.len() as f64 * all.wish.step_s;
            counts.extend(own);
            all.legs = match all.legs.is_empty() || next.legs.is_empty() {
                // G-code of both has points alone.
                true => Vec::new(),
                false => {
                    let later = next.legs.iter().map(|leg| super::Leg {
                        begin_s: leg.begin_s + begin_s,
                        ..*leg
                    });
                    all.legs.iter().copied().chain(later).collect()
                }
            };
            for (peak, other) in all.peaks.iter_mut().zip(&next.peaks) {
                peak.reached = peak.reached.max(other.reached);
            }
            all.lines = all.lines.or(next.lines);
            all.slowed_by = all.slowed_by.or(next.slowed_by);
            all.wish.duration_s = (counts.len() - 1) as f64 * all.wish.step_s;
            (all.counts, all.decimals) = (counts, decimals);
        }
        Some(all)
    }

    /// The same with a part of its size.
    #[must_use]
    pub fn scaled(&self, part: f64) -> Self {
        let first = self.counts.first().copied().unwrap_or(0);
        // Cut towards the start: no difference of an effort matters, and none becomes larger than it was by more than digits.
        let cut = |count: &i64| first + ((count - first) as f64 * part).trunc() as i64;
        let mut scaled = self.clone();
        scaled.counts = self.counts.iter().map(cut).collect();
        for peak in &mut scaled.peaks {
            peak.reached *= part;
        }
        scaled
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Shape, Wish, design};
    use super::Design;
    use crate::excite::{Bounds, Limits};
    use hyde_units::NamedUnit;

    #[test]
    fn one_after_another_they_keep_the_limits() {
        let limits = Limits {
            travel: 0.1,
            speed: 0.1,
            acceleration: 1.0,
            jerk: 50.0,
        };
        let wish = |shape| Wish {
            shape,
            bounds: Bounds::Motion(limits),
            band_hz: (2.0, 50.0),
            duration_s: 6.0,
            step_s: 1e-3,
            start: 0.02,
            unit: NamedUnit::parse("mm").unwrap(),
            speeds: 2,
            places: 2,
            reversal: 1e-4,
        };
        let parts = [Shape::Jogs, Shape::Multisine].map(|shape| design(&wish(shape)).unwrap());
        let rows: usize = parts.iter().map(Design::rows).sum();
        let joined = Design::joined(parts.to_vec()).unwrap();
        assert_eq!(joined.rows(), rows + 4);
        let values = joined.values();
        let third = values
            .windows(4)
            .map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs() / 1e-9);
        // Differences of doubles: a millionth for their rounding.
        assert!(third.fold(0.0, f64::max) < 50.0 * (1.0 + 1e-6));
        let half = joined.scaled(0.5);
        assert!((half.values()[3000] - 0.02 - 0.5 * (values[3000] - 0.02)).abs() < 1e-9);
    }
}
