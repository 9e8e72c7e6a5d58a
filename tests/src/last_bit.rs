//! [`Place`]: a point at which two programs of one model are compared, kernel by kernel, in numbers of the machine.

use hyde_program::{Function, Kernels, Point, Program, Workspace};

/// A point that owns its vectors.
pub(crate) struct Place {
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    z: Vec<f64>,
    u: Vec<f64>,
    p: Vec<f64>,
}

impl Place {
    /// Unknowns, rates and inputs of many sizes, any truths and modes, the model's own parameters.
    pub(crate) fn random(program: &Program, random: &mut Random) -> Self {
        let mut numbers = |n: usize| (0..n).map(|_| random.number()).collect::<Vec<f64>>();
        let (y, yp) = (numbers(program.n_unknowns), numbers(program.n_unknowns));
        let (mut z, u) = (
            numbers(program.n_memory),
            numbers(2 * program.columns.len() + program.delays.len()),
        );
        let t = numbers(1)[0].abs();
        for truth in z.iter_mut().take(program.relations.len()) {
            *truth = random.below(2);
        }
        for automaton in &program.automata {
            z[automaton.place] = random.below(automaton.modes.len());
        }
        let mut p = vec![0.0; program.n_parameters];
        program.kernels.parameters(&[], &mut p);
        Self { t, y, yp, z, u, p }
    }

    /// As the kernels take it.
    pub(crate) fn point(&self) -> Point<'_> {
        Point {
            t: self.t,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p: &self.p,
        }
    }

    /// The largest distance of any number that any kernel gives here.
    pub(crate) fn apart(&self, a: &Program, b: &Program) -> Result<u64, String> {
        let (a_numbers, b_numbers) = (self.numbers(a), self.numbers(b));
        let finite = a_numbers.iter().filter(|number| number.is_finite()).count();
        if a_numbers.len() != b_numbers.len() || 2 * finite < a_numbers.len() {
            return Err(format!(
                "{finite} of {} numbers to compare",
                a_numbers.len()
            ));
        }
        let pairs = a_numbers.iter().zip(&b_numbers);
        Ok(pairs.map(|(&a, &b)| ulp_apart(a, b)).max().unwrap_or(0))
    }

    /// Everything that the kernels of a program compute here.
    fn numbers(&self, program: &Program) -> Vec<f64> {
        let kernels: &dyn Kernels = &*program.kernels;
        let at = self.point();
        let mut room = Workspace::new(program.n_work);
        let plain: Vec<usize> = program
            .parameters
            .iter()
            .filter(|parameter| !parameter.structural)
            .flat_map(|parameter| parameter.place..parameter.place + parameter.len)
            .collect();
        let mut all = Vec::new();
        let mut take = |n: usize, fill: &mut dyn FnMut(&mut [f64])| {
            let start = all.len();
            all.resize(start + n, 0.0);
            fill(&mut all[start..]);
        };
        take(program.n_parameters, &mut |out| {
            kernels.parameters(&[], out)
        });
        let (mut y, mut z) = (vec![0.0; program.n_unknowns], vec![0.0; program.n_memory]);
        kernels.start(&self.p, &mut y, &mut z);
        take(y.len(), &mut |out| out.copy_from_slice(&y));
        take(z.len(), &mut |out| out.copy_from_slice(&z));
        for function in Function::ALL {
            take(program.rows(function), &mut |out| {
                kernels.evaluate(function, at, &mut room, out);
            });
            take(program.partials(function).len(), &mut |out| {
                kernels.partials(function, at, &mut room, out);
            });
            let by_parameters = kernels.parameter_partials(function, &plain, at, &mut room);
            take(by_parameters.len(), &mut |out| {
                for (value, (_, known)) in out.iter_mut().zip(&by_parameters) {
                    *value = *known;
                }
            });
        }
        take(program.reactions.len(), &mut |out| {
            kernels.conditions(at, &mut room, out);
        });
        for clock in 0..program.clocks.len() {
            take(program.n_memory, &mut |out| {
                out.copy_from_slice(&self.z);
                kernels.tick(clock, at, &mut room, out);
            });
            let partials = kernels.tick_partials(clock, at, &mut room);
            take(partials.len(), &mut |out| {
                for (value, (_, _, known)) in out.iter_mut().zip(&partials) {
                    *value = *known;
                }
            });
        }
        all
    }
}

/// How many numbers of the machine two numbers are apart; two that are none agree.
fn ulp_apart(a: f64, b: f64) -> u64 {
    if a.is_nan() && b.is_nan() {
        return 0;
    }
    // Bit patterns as integers in the order of the numbers; the two zeros are one.
    let place = |x: f64| {
        let bits = i64::from_ne_bytes(x.to_bits().to_ne_bytes());
        i128::from(if bits < 0 {
            i64::MIN.wrapping_sub(bits)
        } else {
            bits
        })
    };
    u64::try_from((place(a) - place(b)).abs()).unwrap_or(u64::MAX)
}

/// The generator `SplitMix64` (Steele, Lea and Flood, OOPSLA 2014): the same numbers on every machine.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Between 0 and 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Nearly of a normal distribution: the sum of twelve numbers between 0 and 1, without its mean.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }

    /// Of either sign, from a millionth to a thousand.
    fn number(&mut self) -> f64 {
        let size = 10_f64.powf(9.0 * self.unit() - 6.0);
        if self.unit() < 0.5 { -size } else { size }
    }

    /// A whole number below `n`.
    fn below(&mut self, n: usize) -> f64 {
        (self.unit() * n as f64).floor()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_are_one_apart() {
        assert_eq!(ulp_apart(1.0, 1.0 + f64::EPSILON), 1);
        assert_eq!(ulp_apart(0.0, -0.0), 0);
        assert_eq!(ulp_apart(f64::from_bits(1), -f64::from_bits(1)), 2);
        assert_eq!(ulp_apart(f64::NAN, f64::NAN), 0);
        assert!(ulp_apart(f64::NAN, 1.0) > 1 << 50);
    }
}
