//! [`Secants`]: steps to where residuals are 0, if the derivatives of one point do for all, and by secants if they do not.
//!
//! Residuals are in units in which a step is as large as the residual where these derivatives hold. An inertia that differs by
//! direction may be several times what it is there, and such steps then grow from round to round. From the first round on
//! that leaves too much, Broyden's method (Kelley, Iterative Methods for Linear and Nonlinear Equations, SIAM 1995,
//! section 7.3) corrects the derivatives by what the last steps did.

/// A round that leaves more of the residual than this would need more rounds than there are.
const LEFT: f64 = 0.05;
/// A step becomes longer by a secant so many times at most: less of a residual than that is left by rounding.
const LONGER: f64 = 10.0;

/// The steps of a solution so far.
#[derive(Default)]
pub(crate) struct Secants {
    /// From the first one on that secants need; those behind `count` are room.
    steps: Vec<Vec<f64>>,
    count: usize,
}

impl Secants {
    /// Forgets all steps: another solution begins.
    pub(crate) fn begin(&mut self) {
        self.count = 0;
    }

    /// Makes of a residual the step that answers it.
    pub(crate) fn step(&mut self, residual: &mut [f64]) {
        let known = &self.steps[..self.count];
        let contracts = |first: &Vec<f64>| square(residual) <= LEFT * LEFT * square(first);
        if let [first] = known
            && contracts(first)
        {
            self.count = 0;
        } else if let [.., last] = known {
            for pair in known.windows(2) {
                let along = part(residual, &pair[0]);
                let each = residual.iter_mut().zip(&pair[1]);
                each.for_each(|(own, next)| *own += along * next);
            }
            let longer = 1.0 / (1.0 - part(residual, last)).max(1.0 / LONGER);
            residual.iter_mut().for_each(|own| *own *= longer);
        }
        if self.steps.len() == self.count {
            self.steps.push(Vec::new());
        }
        self.steps[self.count].clear();
        self.steps[self.count].extend_from_slice(residual);
        self.count += 1;
    }
}

/// The part of a step that a residual has of it.
fn part(residual: &[f64], step: &[f64]) -> f64 {
    dot(residual, step) / square(step).max(f64::MIN_POSITIVE)
}

fn square(values: &[f64]) -> f64 {
    dot(values, values)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::Secants;

    /// The residual after each of some steps, if the true derivative is so many times that of the steps.
    fn left(slopes: [f64; 2], rounds: usize) -> f64 {
        let mut secants = Secants::default();
        let mut x = [0.0; 2];
        for _ in 0..rounds {
            let mut residual = [0, 1].map(|i| 1.0 - slopes[i] * x[i]);
            secants.step(&mut residual);
            x = [0, 1].map(|i| x[i] + residual[i]);
        }
        let rest = [0, 1].map(|i| (1.0 - slopes[i] * x[i]).abs());
        rest[0].max(rest[1])
    }

    #[test]
    fn steps_that_would_grow_end_where_the_residual_is_0() {
        // An inertia more than four times that of the steps, and one of a quarter: plain steps leave 3.3^8 and 0.77^8.
        assert!(left([4.3, 1.0], 4) < 1e-12);
        assert!(left([0.23, 1.0], 4) < 1e-12);
        assert!(left([4.3, 0.23], 8) < 1e-9);
        assert!(left([1.0, 1.0], 1) < 1e-12);
    }
}
