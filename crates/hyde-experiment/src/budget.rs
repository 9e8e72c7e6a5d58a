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

/// What an imperfection does to a measure, in the measure's unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Its number.
    pub ideal: usize,
    /// What the measure falls by without it.
    pub share: f64,
    /// What the measure of the ideal model grows by with it.
    pub alone: f64,
}

/// What a measure is made of, in its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct BudgetOf {
    /// The measure with the model as it is.
    pub value: f64,
    /// What each imperfection does, the largest share first.
    pub shares: Vec<Share>,
    /// What the shares miss of the difference that all together make.
    pub interaction: f64,
    /// The measure with all of them ideal.
    pub left: f64,
}

impl BudgetOf {
    /// From the values of the measure: as it is, with all ideal, and for each imperfection without it and with it alone.
    #[must_use]
    pub fn new(value: f64, left: f64, each: &[(f64, f64)]) -> Self {
        let share = |(ideal, &(without, alone)): (usize, &(f64, f64))| Share {
            ideal,
            share: value - without,
            alone: alone - left,
        };
        let mut shares: Vec<Share> = each.iter().enumerate().map(share).collect();
        let sum: f64 = shares.iter().map(|share| share.share).sum();
        shares.sort_by(|a, b| b.share.abs().total_cmp(&a.share.abs()));
        Self {
            value,
            shares,
            interaction: value - left - sum,
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
        let of = |a: f64, b: f64| 1.0 + 2.0 * a + 5.0 * b + 4.0 * a * b;
        let each = [(of(0.0, 1.0), of(1.0, 0.0)), (of(1.0, 0.0), of(0.0, 1.0))];
        let budget = BudgetOf::new(of(1.0, 1.0), of(0.0, 0.0), &each);
        // Small whole numbers: exact.
        let found = budget.shares.iter().map(|s| (s.ideal, s.share, s.alone));
        assert_eq!(found.collect::<Vec<_>>(), [(1, 9.0, 5.0), (0, 6.0, 2.0)]);
        // Both shares have the product: it is counted once too often.
        assert_eq!((budget.interaction, budget.left), (-4.0, 1.0));
    }
}
