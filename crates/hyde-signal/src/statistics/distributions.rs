//! Quantiles of the normal, the chi-squared and Student's distribution, as tests and intervals need them.

/// The value that a normal number exceeds with a probability below 0.15, in standard deviations: by bisection of the
/// complementary error function's asymptotic continued fraction (Abramowitz and Stegun 26.2.14).
#[must_use]
pub fn normal(probability: f64) -> f64 {
    let upper = |x: f64| {
        let mut fraction = x;
        for k in (1..=60).rev() {
            fraction = x + f64::from(k) / fraction;
        }
        (-0.5 * x * x).exp() / (std::f64::consts::TAU.sqrt() * fraction)
    };
    let (mut low, mut high) = (1.0, 12.0);
    for _ in 0..80 {
        let middle = 0.5 * (low + high);
        if upper(middle) > probability {
            low = middle
        } else {
            high = middle
        }
    }
    low
}

/// The value that chi squared with so many degrees of freedom exceeds with a small probability; from three degrees on by
/// Wilson and Hilferty's cube (Proc. Natl. Acad. Sci. 17, 1931, 684).
#[must_use]
pub fn chi_squared(freedoms: usize, probability: f64) -> f64 {
    match freedoms {
        0 | 1 => normal(0.5 * probability).powi(2),
        2 => -2.0 * probability.ln(),
        _ => {
            let k = freedoms as f64;
            let part = 2.0 / (9.0 * k);
            k * (1.0 - part + normal(probability) * part.sqrt()).powi(3)
        }
    }
}

/// The probability outside of the intervals that reports give, which are of 95 %.
pub const OUTSIDE: f64 = 0.05;

/// Half the width of a 95 % interval of a normal number, in standard deviations.
pub const TWO_SIDED: f64 = 1.96;

/// Student's 97.5 % quantile over the normal one, by so many degrees of freedom (Abramowitz and Stegun 26.7.5).
#[must_use]
pub fn student(freedoms: usize) -> f64 {
    let (x, n) = (TWO_SIDED, freedoms.max(1) as f64);
    let first = (x.powi(2) + 1.0) / 4.0;
    let second = (5.0 * x.powi(4) + 16.0 * x.powi(2) + 3.0) / 96.0;
    1.0 + first / n + second / n.powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_those_of_tables() {
        // Abramowitz and Stegun, tables 26.6 and 26.8.
        assert!((normal(0.001) - 3.0902).abs() < 1e-4);
        for (freedoms, value) in [(1, 10.828), (2, 13.816), (4, 18.467)] {
            let found = chi_squared(freedoms, 0.001);
            assert!((found / value - 1.0).abs() < 0.02, "{freedoms}: {found}");
        }
        // Table 26.10, over 1.960.
        for (freedoms, value) in [(5, 2.571), (10, 2.228), (30, 2.042)] {
            let found = TWO_SIDED * student(freedoms);
            assert!((found / value - 1.0).abs() < 0.01, "{freedoms}: {found}");
        }
    }
}
