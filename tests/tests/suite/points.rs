//! Points at which kernels are evaluated: made up, but the same in every run.

use hyde_program::{Point, Program};

/// Numbers that look random (the multiplier of Knuth's MMIX).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// Between 0 and 1.
    fn unit(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Between -1 and 1.
    pub(crate) fn next(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    /// Normal, of mean 0 and variance 1: the sum of twelve uniform ones.
    pub(crate) fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.unit()).sum::<f64>() - 6.0
    }

    /// One of the first `n` whole numbers.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        let number = (0.5 * (self.next() + 1.0) * n as f64) as usize;
        number.min(n - 1)
    }
}

/// The vectors of a point.
pub(crate) struct Values {
    t: f64,
    pub(crate) y: Vec<f64>,
    pub(crate) yp: Vec<f64>,
    z: Vec<f64>,
    u: Vec<f64>,
}

impl Values {
    /// Some values within ±1, in some modes, with some truths.
    pub(crate) fn of(program: &Program, random: &mut Random) -> Self {
        let mut some = |n: usize| (0..n).map(|_| random.next()).collect::<Vec<f64>>();
        let (t, y, yp) = (0.1, some(program.n_unknowns), some(program.n_unknowns));
        let n_inputs = 2 * program.columns.len() + program.delays.len();
        let (mut z, u) = (some(program.n_memory), some(n_inputs));
        for truth in &mut z[..program.relations.len()] {
            *truth = f64::from(u8::from(*truth > 0.0));
        }
        for automaton in &program.automata {
            let mode = random.below(automaton.modes.len());
            z[automaton.place] = f64::from(u32::try_from(mode).unwrap());
        }
        Self { t, y, yp, z, u }
    }

    /// As the kernels take it.
    pub(crate) fn point<'a>(&'a self, p: &'a [f64]) -> Point<'a> {
        Point {
            t: self.t,
            y: &self.y,
            yp: &self.yp,
            z: &self.z,
            u: &self.u,
            p,
        }
    }
}

/// The parameter vector with some values set: position and value.
pub(crate) fn parameters(program: &Program, set: &[(usize, f64)]) -> Vec<f64> {
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(set, &mut p);
    p
}

/// The positions of parameters that may be set without compiling anew.
pub(crate) fn plain(program: &Program) -> Vec<usize> {
    let plain = program
        .parameters
        .iter()
        .filter(|parameter| !parameter.structural && !parameter.is_final);
    plain
        .flat_map(|parameter| parameter.place..parameter.place + parameter.len)
        .collect()
}
