//! Poles of a linearised system as it runs: of a loop that clocks close those of its exact discrete map.
//!
//! Over the common period T of the clocks the map takes (x, m, h), states, memory and held values, to themselves; its
//! eigenvalues are z = exp(sT) (Franklin, Powell, Workman, Digital Control of Dynamic Systems, ch. 4). Of s the frequency
//! is known but for multiples of 1/T and for its sign: the one nearest to a pole of the plant counts. What a tick overwrites
//! without reading it has z = 0, as a rule several times over; rounding would make numbers of every size of that, so it
//! is taken out first, range by range.

use crate::common_period::CommonPeriod;
use crate::linearize::Linear;
use crate::modes::{NaturalMode, balanced, characteristic, continuous_roots, eigenvalues};
use nalgebra::{Complex, DMatrix, DVector};

/// A part of a matrix below this, relative to its largest, is none of it.
const NOTHING: f64 = 1e-12;
/// A pole that falls below this within a period is over before the next.
const OVER: f64 = 1e-6;
/// So near to rest or to the limit of stability it is asked what rounding does to a pole.
const CLOSE: f64 = 1e-3;
/// A pole is exact to this many times what rounding does to the matrix, as far as its vectors let it.
const ROUNDING: f64 = 1e3 * f64::EPSILON;
/// A part of an eigenvector below this, relative to its largest, is none of it.
const UNMOVED: f64 = 1e-7;

/// Frequencies that ticks do not tell apart are told apart by the poles of a plant of so many states at most.
const MOST_STATES: usize = 300;

type Vector = DVector<Complex<f64>>;
type Matrix = DMatrix<Complex<f64>>;

/// A pole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pole {
    /// In rad/s; of a pair the one that turns forwards.
    pub s: Complex<f64>,
    /// It grows, beyond what rounding can make of one that does not.
    pub grows: bool,
    /// Of the map over the common period.
    z: Complex<f64>,
}

/// The poles of a system: all but those at rest and, with clocks, those that are over within a period.
#[derive(Clone, Debug)]
pub struct Poles {
    /// In no order.
    pub all: Vec<Pole>,
    /// The common period of the clocks in s, where clocks close a loop.
    pub period_s: Option<f64>,
    /// What they are the eigenvalues of, its rows and columns scaled, in a basis of its range.
    matrix: DMatrix<f64>,
    basis: DMatrix<f64>,
    scale: DVector<f64>,
}

impl Pole {
    /// Natural frequency and damping.
    #[must_use]
    pub fn mode(&self) -> NaturalMode {
        NaturalMode {
            frequency_hz: self.s.norm() / std::f64::consts::TAU,
            damping: -self.s.re / self.s.norm(),
            eigenvalue: self.s,
        }
    }

    /// Whether it is a pair that oscillates.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.s.im > 1e-6 * (1.0 + self.s.re.abs())
    }

    /// The time in which it grows or decays by a factor of 2, in s.
    #[must_use]
    pub fn doubling_s(&self) -> f64 {
        std::f64::consts::LN_2 / self.s.re.abs()
    }
}

impl Poles {
    /// Those that grow, the fastest first.
    #[must_use]
    pub fn unstable(&self) -> Vec<Pole> {
        let mut found = self.chosen(|pole| pole.grows);
        found.sort_by(|a, b| b.s.re.total_cmp(&a.s.re));
        found
    }

    /// Those that oscillate, by ascending frequency.
    #[must_use]
    pub fn oscillating(&self) -> Vec<Pole> {
        let mut found = self.chosen(Pole::oscillates);
        found.sort_by(|a, b| a.s.norm().total_cmp(&b.s.norm()));
        found
    }

    /// Those that do not, the slowest first.
    #[must_use]
    pub fn real(&self) -> Vec<Pole> {
        let mut found = self.chosen(|pole| !pole.oscillates());
        found.sort_by(|a, b| a.s.re.abs().total_cmp(&b.s.re.abs()));
        found
    }

    fn chosen(&self, test: impl Fn(&Pole) -> bool) -> Vec<Pole> {
        self.all.iter().copied().filter(|pole| test(pole)).collect()
    }

    /// Amplitude and phase of each state in a pole, in the order of [`Linear::states`]; `None` where it is one of clocked
    /// parts alone.
    #[must_use]
    pub fn states(&self, linear: &Linear, pole: &Pole) -> Option<Vector> {
        if self.period_s.is_none() {
            // Not quite the eigenvalue, or the matrix would be singular.
            return null_vector(characteristic(linear, pole.s * (1.0 + 1e-9))?);
        }
        let whole = complex(&self.basis) * null_vector(self.shifted(pole))?;
        let largest = whole.iter().map(|x| x.norm()).fold(0.0, f64::max);
        let states = whole.rows(0, linear.states.len());
        let moves = states.iter().any(|x| x.norm() > UNMOVED * largest);
        moves.then(|| DVector::from_fn(states.nrows(), |i, _| states[i] * self.scale[i]))
    }

    /// The part that each state and, behind them, each number of a clocked part has in a pole, whatever their units: left
    /// times right eigenvector (Perez-Arriaga, Verghese, Schweppe, IEEE Trans. PAS 101 (1982) 3117), 1 together.
    #[must_use]
    pub fn participation(&self, pole: &Pole) -> Option<Vec<f64>> {
        let basis = complex(&self.basis);
        let shifted = self.shifted(pole);
        let left = &basis * null_vector(shifted.adjoint())?;
        let right = &basis * null_vector(shifted)?;
        let parts = left.iter().zip(&right).map(|(l, r)| (l.conj() * r).norm());
        let parts: Vec<f64> = parts.collect();
        let whole: f64 = parts.iter().sum();
        Some(parts.into_iter().map(|part| part / whole).collect())
    }

    /// How far rounding may have put an eigenvalue: the farther, the nearer its two vectors are to perpendicular.
    fn error(&self, value: Complex<f64>) -> f64 {
        let shifted = shifted(&self.matrix, value);
        let along = null_vector(shifted.adjoint())
            .zip(null_vector(shifted))
            .map_or(0.0, |(left, right)| left.dotc(&right).norm());
        ROUNDING * self.matrix.norm() / along
    }

    fn shifted(&self, pole: &Pole) -> Matrix {
        shifted(&self.matrix, pole.z)
    }
}

/// The poles of a system: with clocks those of the closed loop, with delays those that [`crate::modes`] finds.
#[must_use]
pub fn poles(linear: &Linear) -> Poles {
    let period = linear.sampled.as_ref();
    match period.and_then(|sampled| CommonPeriod::new(linear, sampled)) {
        Some(period) => of_map(linear, &period),
        None => of_plant(linear),
    }
}

fn of_plant(linear: &Linear) -> Poles {
    let (matrix, scale) = balanced(&linear.a);
    let size = matrix.nrows();
    let mut poles = Poles {
        all: Vec::new(),
        period_s: None,
        basis: DMatrix::identity(size, size),
        matrix,
        scale,
    };
    // A body that moves freely has two eigenvalues 0; rounding parts them by the root of what it leaves.
    let rest = 1e-8 * poles.matrix.norm();
    let roots = continuous_roots(linear, &poles.matrix);
    for s in roots {
        if s.im < 0.0 || s.norm() <= rest {
            continue;
        }
        let error = match &linear.delayed {
            Some(_) => 1e-9 * s.norm(),
            None if s.re > 0.0 => poles.error(s),
            None => 0.0,
        };
        poles.all.push(Pole {
            s,
            grows: s.re > error,
            z: s,
        });
    }
    poles
}

fn of_map(linear: &Linear, period: &CommonPeriod<'_>) -> Poles {
    let (map, scale) = balanced(&period.transition());
    let (matrix, basis) = without_what_is_over(map);
    let mut poles = Poles {
        all: Vec::new(),
        period_s: Some(period.period_s()),
        matrix,
        basis,
        scale,
    };
    for z in eigenvalues(&poles.matrix) {
        if z.im < 0.0 || z.norm() < OVER {
            continue;
        }
        let close = (z.norm() - 1.0).abs() < CLOSE;
        let error = if close { poles.error(z) } else { 0.0 };
        // A state that is where it is and stays there.
        if close && (z - 1.0).norm() <= error {
            continue;
        }
        poles.all.push(Pole {
            s: z.ln() / period.period_s(),
            grows: z.norm() - 1.0 > error,
            z,
        });
    }
    let plant = if linear.a.nrows() > MOST_STATES {
        Vec::new()
    } else {
        eigenvalues(&balanced(&linear.a).0)
    };
    between_ticks(&mut poles.all, period.period_s(), &plant);
    poles
}

/// Gives each pole that swings the frequency that it has between ticks. Ticks do not tell apart frequencies that differ by a
/// multiple of their rate, nor mirror images. Poles of the closed loop and of the plant are paired, the nearest first, each
/// once; a pole without a pair keeps its frequency below half the rate.
fn between_ticks(poles: &mut [Pole], period: f64, plant: &[Complex<f64>]) {
    let step = std::f64::consts::TAU / period;
    let mut pairs = Vec::new();
    for (number, pole) in poles.iter().enumerate() {
        // A real pole is of no pair, and so is one that alternates from tick to tick.
        if pole.s.im < 1e-9 * step || pole.s.im > (0.5 - 1e-9) * step {
            continue;
        }
        for (mode, own) in plant.iter().enumerate().filter(|(_, own)| own.im > 0.0) {
            for base in [pole.s, pole.s.conj()] {
                let turns = ((own.im - base.im) / step).round();
                let alike = base + Complex::new(0.0, turns * step);
                pairs.push(((alike - own).norm(), number, mode, alike));
            }
        }
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut paired = (vec![false; poles.len()], vec![false; plant.len()]);
    for (_, number, mode, alike) in pairs {
        if !paired.0[number] && !paired.1[mode] {
            (paired.0[number], paired.1[mode]) = (true, true);
            poles[number].s = Complex::new(alike.re, alike.im.abs());
        }
    }
}

/// A matrix without the part of it that becomes 0 when it is applied again and again, in a basis of what is left.
fn without_what_is_over(matrix: DMatrix<f64>) -> (DMatrix<f64>, DMatrix<f64>) {
    let mut basis = DMatrix::identity(matrix.nrows(), matrix.nrows());
    let mut map = matrix;
    while map.nrows() > 0 {
        let size = map.norm();
        let factors = map.clone().col_piv_qr();
        let diagonal = factors.r().diagonal();
        let rank = diagonal.iter().filter(|x| x.abs() > NOTHING * size).count();
        if rank == map.nrows() {
            break;
        }
        let range = factors.q().columns(0, rank).into_owned();
        map = range.transpose() * &map * &range;
        basis *= range;
    }
    (map, basis)
}

fn shifted(matrix: &DMatrix<f64>, value: Complex<f64>) -> Matrix {
    let n = matrix.nrows();
    // Not quite the eigenvalue, or the matrix would be singular.
    Matrix::identity(n, n) * (value * (1.0 + 1e-10)) - complex(matrix)
}

/// The vector that a matrix takes to next to nothing: three steps of inverse iteration (Golub and Van Loan, *Matrix
/// Computations*, 7.6.1) from one that no other is perpendicular to.
pub(crate) fn null_vector(matrix: Matrix) -> Option<Vector> {
    let n = matrix.nrows();
    let factors = matrix.lu();
    let mut vector = Vector::from_fn(n, |i, _| Complex::new(1.0, 0.1 * (1.0 + i as f64).sqrt()));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        let norm = vector.norm();
        if !norm.is_finite() || norm <= 0.0 {
            return None;
        }
        vector.unscale_mut(norm);
    }
    Some(vector)
}

fn complex(matrix: &DMatrix<f64>) -> Matrix {
    matrix.map(|value| Complex::new(value, 0.0))
}
