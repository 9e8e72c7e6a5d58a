//! [`tried`]: a step of the method of Dormand and Prince of order 5 with its error estimate and its interpolant of order 4.
//!
//! Coefficients: E. Hairer, S. P. Nørsett, G. Wanner, Solving Ordinary Differential Equations I, 2nd ed., table II.5.2 and
//! section II.6.

/// Number of stages.
const STAGES: usize = 7;

const NODES: [f64; STAGES] = [0.0, 0.2, 0.3, 0.8, 8.0 / 9.0, 1.0, 1.0];

const MATRIX: [&[f64]; STAGES] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[
        19372.0 / 6561.0,
        -25360.0 / 2187.0,
        64448.0 / 6561.0,
        -212.0 / 729.0,
    ],
    &[
        9017.0 / 3168.0,
        -355.0 / 33.0,
        46732.0 / 5247.0,
        49.0 / 176.0,
        -5103.0 / 18656.0,
    ],
    &[
        35.0 / 384.0,
        0.0,
        500.0 / 1113.0,
        125.0 / 192.0,
        -2187.0 / 6784.0,
        11.0 / 84.0,
    ],
];

/// The result of order 5 less that of order 4.
const ERROR: [f64; STAGES] = [
    71.0 / 57600.0,
    0.0,
    -71.0 / 16695.0,
    71.0 / 1920.0,
    -17253.0 / 339_200.0,
    22.0 / 525.0,
    -1.0 / 40.0,
];

/// The last term of the interpolant.
const DENSE: [f64; STAGES] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// A step.
#[derive(Clone, Debug)]
pub(crate) struct Step {
    /// Its width in s.
    pub(crate) width: f64,
    from: Vec<f64>,
    /// The states at its end.
    pub(crate) to: Vec<f64>,
    rates: Vec<Vec<f64>>,
}

/// Makes a step from a point where the derivatives are `first`.
///
/// # Errors
/// The derivatives cannot be had.
pub(crate) fn tried(
    t: f64,
    from: &[f64],
    first: &[f64],
    width: f64,
    mut derivatives: impl FnMut(f64, &[f64]) -> Result<Vec<f64>, String>,
) -> Result<Step, String> {
    let mut rates = vec![first.to_vec()];
    let mut to = from.to_vec();
    for stage in 1..STAGES {
        to.copy_from_slice(from);
        for (factor, rate) in MATRIX[stage].iter().zip(&rates) {
            to.iter_mut()
                .zip(rate)
                .for_each(|(own, rate)| *own += width * factor * rate);
        }
        rates.push(derivatives(t + NODES[stage] * width, &to)?);
    }
    Ok(Step {
        width,
        from: from.to_vec(),
        to,
        rates,
    })
}

impl Step {
    fn sum(&self, factors: &[f64; STAGES], state: usize) -> f64 {
        let pairs = factors.iter().zip(&self.rates);
        let terms = pairs.map(|(factor, rates)| factor * rates[state]);
        self.width * terms.sum::<f64>()
    }

    /// The error estimate over the weights, root mean square; not a number if a value is none.
    pub(crate) fn error(&self, weights: &[f64]) -> f64 {
        if weights.is_empty() {
            return 0.0;
        }
        let part = |(state, weight): (usize, &f64)| (self.sum(&ERROR, state) / weight).powi(2);
        let sum: f64 = weights.iter().enumerate().map(part).sum();
        (sum / weights.len() as f64).sqrt()
    }
}

/// The states at a part of a step, 0 at its beginning and 1 at its end.
pub(crate) fn interpolated(step: &Step, part: f64) -> Vec<f64> {
    let rest = 1.0 - part;
    let of = |state: usize| {
        let (first, last) = (step.rates[0][state], step.rates[STAGES - 1][state]);
        let difference = step.to[state] - step.from[state];
        let second = step.width * first - difference;
        let third = difference - step.width * last - second;
        let fourth = step.sum(&DENSE, state);
        step.from[state] + part * (difference + rest * (second + part * (third + rest * fourth)))
    };
    (0..step.to.len()).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// x'' = -x: a step of width h has an error of order 6, its interpolant one of order 5.
    #[test]
    fn orders_are_those_of_the_method() {
        let at = |width: f64| {
            let oscillator = |_: f64, x: &[f64]| Ok(vec![x[1], -x[0]]);
            let step = tried(0.0, &[0.0, 1.0], &[1.0, 0.0], width, oscillator).unwrap();
            let middle = interpolated(&step, 0.3);
            let [end, dense] = [(width, step.to[0]), (0.3 * width, middle[0])]
                .map(|(t, value)| (value - t.sin()).abs());
            (end, dense, step.error(&[1.0, 1.0]))
        };
        let (coarse, fine) = (at(0.4), at(0.2));
        for (a, b, least) in [
            (coarse.0, fine.0, 50.0),
            (coarse.1, fine.1, 25.0),
            (coarse.2, fine.2, 25.0),
        ] {
            assert!(a / b > least && a < 1e-4, "{a} {b}");
        }
        // Both ends of the interpolant are those of the step.
        let step = tried(0.0, &[2.0], &[-2.0], 0.5, |_, x| Ok(vec![-x[0]])).unwrap();
        assert_eq!(interpolated(&step, 0.0), vec![2.0]);
        assert!((interpolated(&step, 1.0)[0] - step.to[0]).abs() < 1e-15);
    }

    #[test]
    fn a_value_that_is_none_makes_no_small_error() {
        let step = tried(0.0, &[1.0], &[1.0], 0.1, |_, _| Ok(vec![f64::NAN])).unwrap();
        assert!(step.error(&[1.0]).is_nan());
    }
}
