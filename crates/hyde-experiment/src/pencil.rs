//! Eigenvectors of the linearised system in the model's own unknowns, and the derivatives of its eigenvalues by parameters.
//!
//! A mode is `N(s) v = 0` with `N(s) = dF/dy + s dF/dy'`, delayed values among the unknowns. With the left vector
//! `w^H N(s) = 0` the derivative of s by a parameter p is `-w^H (dN/dp) v / (w^H (dN/ds) v)` (Lancaster, On eigenvalues of
//! matrices dependent on a parameter, Numer. Math. 6 (1964) 377). The kernels give dF/dp; dN/dp times v is its derivative
//! along v, taken as a central difference, which is exact for equations linear in the motion. The operating point is held.

use crate::linearize::{Dense, Linear};
use crate::poles::null_vector;
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use nalgebra::{Complex, DMatrix, DVector};

/// The largest displacement in SI of the differences along a mode: small against what bends equations, large against
/// rounding.
const DISPLACEMENT: f64 = 1e-3;

type Vector = DVector<Complex<f64>>;
type Matrix = DMatrix<Complex<f64>>;

/// A mode with its vectors.
#[derive(Clone, Debug)]
pub(crate) struct Eigen {
    /// In rad/s.
    pub(crate) value: Complex<f64>,
    right: Vector,
    left: Vector,
}

/// `N(s)` of a program at an operating point.
pub(crate) struct Pencil<'a> {
    program: &'a Program,
    linear: &'a Linear,
    residual: Dense,
    /// What is delayed, where something is.
    now: Dense,
    times: Vec<f64>,
}

impl<'a> Pencil<'a> {
    pub(crate) fn new(program: &'a Program, linear: &'a Linear) -> Self {
        let mut work = Workspace::new(program.n_work);
        let at = linear.point.at();
        Self {
            residual: Dense::of(program, Function::Residual, at, &mut work, &[], &[]),
            now: Dense::of(program, Function::Delayed, at, &mut work, &[], &[]),
            times: program.delays.iter().map(|delay| delay.time_s).collect(),
            program,
            linear,
        }
    }

    /// Left and right vector of an eigenvalue, by inverse iteration; `None` if it fails.
    pub(crate) fn eigen(&self, value: Complex<f64>) -> Option<Eigen> {
        // Not quite the eigenvalue, or the matrix would be singular.
        let matrix = self.at(value * (1.0 + 1e-9));
        Some(Eigen {
            value,
            left: null_vector(matrix.adjoint())?,
            right: null_vector(matrix)?,
        })
    }

    /// How much two modes are one, 0 to 1, whatever the units of their unknowns: the modal assurance criterion with the
    /// left vectors, to which all other modes of the same system are orthogonal.
    pub(crate) fn overlap(&self, a: &Eigen, b: &Eigen) -> f64 {
        let slope = self.slope(a.value);
        let product = |left: &Vector, right: &Vector| left.dotc(&(&slope * right)).norm();
        let own = product(&a.left, &a.right) * product(&b.left, &b.right);
        product(&a.left, &b.right) * product(&b.left, &a.right) / own
    }

    /// The derivatives of an eigenvalue by parameters at these places.
    pub(crate) fn derivatives(&self, mode: &Eigen, places: &[usize]) -> Vec<Complex<f64>> {
        let below = mode.left.dotc(&(self.slope(mode.value) * &mode.right));
        let moved = self.by_parameters(mode, places);
        (0..places.len())
            .map(|column| -mode.left.dotc(&moved.column(column)) / below)
            .collect()
    }

    fn at(&self, s: Complex<f64>) -> Matrix {
        let residual =
            complex(&self.residual.by_unknown) + complex(&self.residual.by_derivative) * s;
        let now = complex(&self.now.by_unknown) + complex(&self.now.by_derivative) * s;
        let mut delayed = -complex(&self.now.by_delayed);
        let turn = self.turn(s);
        for (row, turn) in turn.iter().enumerate() {
            delayed.row_mut(row).apply(|x| *x *= *turn);
            delayed[(row, row)] += 1.0;
        }
        self.joined(
            residual,
            complex(&self.residual.by_delayed),
            now,
            &turn,
            delayed,
        )
    }

    /// dN/ds.
    fn slope(&self, s: Complex<f64>) -> Matrix {
        let residual = complex(&self.residual.by_derivative);
        let by_delayed = Matrix::zeros(residual.nrows(), self.times.len());
        // Of -exp(-sT) (a + s b): exp(-sT) (T (a + s b) - b).
        let mut now = complex(&self.now.by_derivative);
        let value = complex(&self.now.by_unknown) + complex(&self.now.by_derivative) * s;
        let mut delayed = complex(&self.now.by_delayed);
        let turn = self.turn(s);
        for (row, time) in self.times.iter().enumerate() {
            let line = now.row(row) - value.row(row) * Complex::from(*time);
            now.row_mut(row).copy_from(&line);
            delayed.row_mut(row).apply(|x| *x *= turn[row] * *time);
        }
        self.joined(residual, by_delayed, now, &turn, delayed)
    }

    /// `[residual, by_delayed; -turn now, delayed]`
    fn joined(
        &self,
        residual: Matrix,
        by_delayed: Matrix,
        now: Matrix,
        turn: &[Complex<f64>],
        delayed: Matrix,
    ) -> Matrix {
        let (n, nd) = (residual.nrows(), self.times.len());
        let mut whole = Matrix::zeros(n + nd, n + nd);
        whole.view_mut((0, 0), (n, n)).copy_from(&residual);
        whole.view_mut((0, n), (n, nd)).copy_from(&by_delayed);
        whole.view_mut((n, n), (nd, nd)).copy_from(&delayed);
        for (row, turn) in turn.iter().enumerate() {
            let line = now.row(row) * -*turn;
            whole.view_mut((n + row, 0), (1, n)).copy_from(&line);
        }
        whole
    }

    fn turn(&self, s: Complex<f64>) -> Vec<Complex<f64>> {
        self.times.iter().map(|time| (-s * *time).exp()).collect()
    }

    /// dN/dp times the right vector, a column a parameter.
    fn by_parameters(&self, mode: &Eigen, places: &[usize]) -> Matrix {
        let n = self.residual.by_unknown.nrows();
        let turn = self.turn(mode.value);
        let rates = &mode.right * mode.value;
        let largest = mode.right.iter().chain(&rates).map(|x| x.norm());
        let scale = DISPLACEMENT / largest.fold(f64::MIN_POSITIVE, f64::max);
        let mut found = Matrix::zeros(mode.right.len(), places.len());
        let unit = Complex::new(0.0, 1.0);
        for (part, factor) in [(0, Complex::from(1.0)), (1, unit)] {
            let of = |x: &Complex<f64>| scale * if part == 0 { x.re } else { x.im };
            let (motion, rates): (Vec<f64>, Vec<f64>) = (
                mode.right.iter().map(of).collect(),
                rates.iter().map(of).collect(),
            );
            for (function, first) in [(Function::Residual, 0), (Function::Delayed, n)] {
                let (up, down) = (
                    self.moved(function, places, &motion, &rates, 1.0),
                    self.moved(function, places, &motion, &rates, -1.0),
                );
                let change = (up - down) / (2.0 * scale);
                for row in 0..change.nrows() {
                    let weight = if first == 0 {
                        factor
                    } else {
                        -turn[row] * factor
                    };
                    for column in 0..places.len() {
                        found[(first + row, column)] += weight * change[(row, column)];
                    }
                }
            }
        }
        found
    }

    /// A function's derivatives by parameters with the unknowns displaced.
    fn moved(
        &self,
        function: Function,
        places: &[usize],
        motion: &[f64],
        rates: &[f64],
        sign: f64,
    ) -> DMatrix<f64> {
        let (program, point) = (self.program, &self.linear.point);
        let add = |values: &[f64], by: &[f64]| -> Vec<f64> {
            values.iter().zip(by).map(|(v, d)| v + sign * d).collect()
        };
        let n = point.y.len();
        let (y, yp) = (add(&point.y, motion), add(&point.yp, rates));
        let columns = 2 * program.columns.len();
        let mut u = point.u[..columns].to_vec();
        u.extend(add(&point.delayed, &motion[n..]));
        let at = Point {
            y: &y,
            yp: &yp,
            u: &u,
            ..point.at()
        };
        let mut work = Workspace::new(program.n_work);
        let mut found = DMatrix::zeros(program.rows(function), places.len());
        let kernels = &program.kernels;
        for (entry, value) in kernels.parameter_partials(function, places, at, &mut work) {
            if let Wrt::Parameter(place) = entry.wrt
                && let Some(column) = places.iter().position(|known| *known == place)
            {
                found[(entry.row, column)] += value;
            }
        }
        found
    }
}

fn complex(matrix: &DMatrix<f64>) -> Matrix {
    matrix.map(|value| Complex::new(value, 0.0))
}
