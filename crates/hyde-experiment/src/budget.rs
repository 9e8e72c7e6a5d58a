//! The error budget: what each imperfection of a model contributes to a measure, one at a time.
//!
//! ```text
//! measure = sum of shares + interaction + left
//! ```
//!
//! The *share* of an imperfection is what the measure falls by when it alone is made ideal: what a repair of it brings.
//! What it does *alone* is what the measure grows by when it is the only one that is not ideal. Where they differ, it acts
//! together with others: play is seen only where something rubs. *Left* is the measure with all of them ideal, and
//! *interaction* what is missing in the sum.
//!
//! All of them are differences of runs, small ones of large ones: how many of their digits count is told by the same runs at
//! a tighter tolerance ([`Estimate`]).

/// The digits that are shown at most.
const DIGITS: i32 = 4;

/// A number, and how far it may be off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The number, SI.
    pub value: f64,
    /// The size of its error; NaN where that is not known.
    pub error: f64,
}

impl Estimate {
    /// A number of a run, and the same at tighter tolerances. It is off by the difference, which may be small by chance, and by
    /// the relative tolerance at least.
    #[must_use]
    pub fn new(value: f64, tighter: f64, rtol: f64) -> Self {
        let changed = (value - tighter).abs();
        let promised = rtol * value.abs();
        Self {
            value,
            error: if changed < promised {
                promised
            } else {
                changed
            },
        }
    }

    /// What it is more than another. Errors of two runs add up as independent ones do.
    #[must_use]
    pub fn minus(self, other: Self) -> Self {
        Self {
            value: self.value - other.value,
            error: self.error.hypot(other.error),
        }
    }

    /// How many of its digits count, of four: in the last one it is off by a half at most. 0 where it is no larger than its
    /// error, 1 at least where it is.
    #[must_use]
    pub fn digits(self) -> usize {
        let size = self.value.abs();
        if !size.is_finite() || self.error.is_nan() {
            return DIGITS as usize;
        }
        if size <= self.error {
            return 0;
        }
        let places = size.log10().floor() - (2.0 * self.error).log10().ceil();
        (places.min(f64::from(DIGITS)) as i32 + 1).clamp(1, DIGITS) as usize
    }
}

/// What an imperfection does to a measure, in the measure's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Its number.
    pub ideal: usize,
    /// What the measure falls by without it.
    pub share: Estimate,
    /// What the measure of the ideal model grows by with it.
    pub alone: Estimate,
}

/// What a measure is made of, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct BudgetOf {
    /// The measure with the model as it is.
    pub value: Estimate,
    /// What each imperfection does, the largest share first.
    pub shares: Vec<Share>,
    /// What the shares miss of the difference that all together make.
    pub interaction: Estimate,
    /// The measure with all of them ideal.
    pub left: Estimate,
}

impl BudgetOf {
    /// From the values of the measure: as it is, with all ideal, and for each imperfection without it and with it alone.
    #[must_use]
    pub fn new(value: Estimate, left: Estimate, each: &[(Estimate, Estimate)]) -> Self {
        let share = |(ideal, &(without, alone)): (usize, &(Estimate, Estimate))| Share {
            ideal,
            share: value.minus(without),
            alone: alone.minus(left),
        };
        let mut shares: Vec<Share> = each.iter().enumerate().map(share).collect();
        let whole = value.minus(left);
        let interaction = shares
            .iter()
            .fold(whole, |rest, share| rest.minus(share.share));
        shares.sort_by(|a, b| b.share.value.abs().total_cmp(&a.share.value.abs()));
        Self {
            value,
            shares,
            interaction,
            left,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Of a measure `1 + 2a + 5b + 4ab` at a = b = 1, made ideal by a = 0 or b = 0.
    #[test]
    fn the_parts_sum_up_and_a_product_is_interaction() {
        let exact = |value| Estimate { value, error: 0.0 };
        let of = |a: f64, b: f64| exact(1.0 + 2.0 * a + 5.0 * b + 4.0 * a * b);
        let each = [(of(0.0, 1.0), of(1.0, 0.0)), (of(1.0, 0.0), of(0.0, 1.0))];
        let budget = BudgetOf::new(of(1.0, 1.0), of(0.0, 0.0), &each);
        // Small whole numbers: exact.
        let found = budget.shares.iter();
        let found = found.map(|s| (s.ideal, s.share.value, s.alone.value));
        assert_eq!(found.collect::<Vec<_>>(), [(1, 9.0, 5.0), (0, 6.0, 2.0)]);
        // Both shares have the product: it is counted once too often.
        assert_eq!((budget.interaction, budget.left), (exact(-4.0), exact(1.0)));
    }

    #[test]
    fn digits_count_as_far_as_half_of_the_last_one_is_known() {
        let digits = |value, error| Estimate { value, error }.digits();
        // 11.92 +- 0.02 is 11.9, and 9.96 +- 0.06 no longer.
        assert_eq!(digits(11.92, 0.02), 3);
        assert_eq!(digits(-11.92, 0.05), 3);
        assert_eq!(digits(11.92, 0.06), 2);
        assert_eq!(digits(9.96, 0.06), 1);
        assert_eq!(digits(11.92, 8.0), 1);
        assert_eq!(digits(11.92, 12.0), 0);
        assert_eq!(digits(11.92, 0.0), 4);
        assert_eq!(digits(0.0, 0.0), 0);
        assert_eq!(digits(11.92, f64::NAN), 4);
        assert_eq!(digits(f64::NAN, 0.1), 4);
    }

    #[test]
    fn a_small_difference_has_the_errors_of_both_runs() {
        let of = |value, tighter| Estimate::new(value, tighter, 1e-6);
        let share = of(37.0, 37.03).minus(of(36.5, 36.54));
        assert!((share.value - 0.5).abs() < 1e-12, "{}", share.value);
        assert!((share.error - 0.05).abs() < 1e-12, "{}", share.error);
        assert!((of(50.0, 50.0).error - 50e-6).abs() < 1e-15);
        assert!(of(50.0, f64::NAN).error.is_nan());
    }
}
