//! The linear solver on its own, dense and sparse.

use hyde_ida::{LinearMethod, Pattern, SetAside, SparseSolver};

const METHODS: [LinearMethod; 2] = [LinearMethod::Dense, LinearMethod::Klu];

/// Numbers in -1 .. 1, the same each time (a linear congruential generator, Knuth's MMIX).
struct Numbers(u64);

impl Iterator for Numbers {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        self.0 = self
            .0
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        Some((self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0)
    }
}

/// A chain with a border: the diagonal, its neighbours, the first row and the last column.
fn bordered_chain(n: usize) -> Pattern {
    let present =
        |row: usize, column: usize| row.abs_diff(column) <= 1 || row == 0 || column == n - 1;
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for column in 0..n {
        rows.extend(
            (0..n)
                .filter(|&row| present(row, column))
                .map(|row| row as i64),
        );
        starts.push(rows.len() as i64);
    }
    Pattern::new(n, starts, rows).unwrap()
}

fn product(pattern: &Pattern, values: &[f64], x: &[f64]) -> Vec<f64> {
    let mut b = vec![0.0; x.len()];
    for (row, column, entry) in pattern.entries() {
        b[row] += values[entry] * x[column];
    }
    b
}

#[test]
fn solves_what_a_product_made() {
    for n in [1, 2, 5, 12, 13, 40] {
        for method in METHODS {
            let pattern = bordered_chain(n);
            let mut solver = SparseSolver::new(pattern.clone(), method).unwrap();
            let mut numbers = Numbers(n as u64);
            for _ in 0..3 {
                // Rows of very different size, as in equations of different units.
                let values: Vec<f64> = pattern
                    .entries()
                    .map(|(row, ..)| numbers.next().unwrap() * 10_f64.powi(row as i32 % 9 - 4))
                    .collect();
                let x: Vec<f64> = numbers.by_ref().take(n).collect();
                let mut b = product(&pattern, &values, &x);
                solver.factor(&values).unwrap();
                solver.solve(&mut b);
                // Rounding, times the condition after scaling, times what the scaling of the unknowns may hide.
                let bound = 1e-13 / solver.reciprocal_condition(&values).unwrap();
                for (found, x) in b.iter().zip(&x) {
                    assert!(
                        (found - x).abs() < bound,
                        "{method:?} {n}: {found} instead of {x}"
                    );
                }
            }
        }
    }
}

#[test]
fn a_zero_column_and_equal_columns_are_singular() {
    for method in METHODS {
        let pattern = Pattern::dense(3).unwrap();
        let mut solver = SparseSolver::new(pattern, method).unwrap();
        let zero = solver
            .factor(&[1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 2.0, 1.0, 5.0])
            .unwrap_err();
        assert_eq!(zero.unknown, 1, "{method:?}");
        let equal = solver
            .factor(&[1.0, 2.0, 4.0, 0.0, 1.0, 0.0, 1.0, 2.0, 4.0])
            .unwrap_err();
        assert!(
            equal.unknown == 0 || equal.unknown == 2,
            "{method:?}: {equal}"
        );
        solver
            .factor(&[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0])
            .unwrap();
        let mut b = [1.0, 1.0, 1.0];
        solver.solve(&mut b);
        // Powers of 2, and one division.
        assert_eq!(b, [1.0, 0.5, 1.0 / 3.0]);
    }
}

#[test]
fn an_empty_row_or_column_is_singular() {
    for method in METHODS {
        let empty_column = Pattern::new(2, vec![0, 2, 2], vec![0, 1]).unwrap();
        let error = SparseSolver::new(empty_column, method)
            .unwrap()
            .factor(&[1.0, 1.0])
            .unwrap_err();
        assert_eq!(error.unknown, 1, "{method:?}");
        let empty_row = Pattern::new(2, vec![0, 1, 2], vec![0, 0]).unwrap();
        SparseSolver::new(empty_row, method)
            .unwrap()
            .factor(&[1.0, 1.0])
            .unwrap_err();
    }
}

#[test]
fn old_pivots_are_given_up_when_they_do_not_serve() {
    for method in METHODS {
        let pattern = Pattern::dense(2).unwrap();
        let mut solver = SparseSolver::new(pattern, method).unwrap();
        solver.factor(&[1.0, 0.0, 0.0, 1.0]).unwrap();
        // As when a mode changes: the pivots of the first matrix are zero, then nearly zero, in these.
        for tiny in [0.0, 1e-30] {
            solver.factor(&[tiny, 1.0, 1.0, tiny]).unwrap();
            let mut b = [2.0, 3.0];
            solver.solve(&mut b);
            // Exchanged rows, no arithmetic but with `tiny`.
            assert_eq!(b, [3.0, 2.0], "{method:?}");
            solver.factor(&[1.0, 0.0, 0.0, 1.0]).unwrap();
        }
    }
}

#[test]
fn the_condition_does_not_depend_on_units() {
    for method in METHODS {
        let solver = SparseSolver::new(Pattern::dense(2).unwrap(), method).unwrap();
        let condition = |values: &[f64]| solver.reciprocal_condition(values).unwrap();
        assert_eq!(condition(&[1e6, 0.0, 0.0, 1e-6]), 1.0, "{method:?}");
        assert_eq!(condition(&[1.0, 2.0, 2.0, 4.0]), 0.0, "{method:?}");
        // [[1, 1], [1, 1 + d]], with rows and columns in other units: norm 2, norm of the inverse 2 (1 + d) / d.
        let d = 1e-8;
        let found = condition(&[1e3, 1e-2, 1e8, 1e3 * (1.0 + d)]);
        // The cancellation in 1 + d - 1 leaves 8 digits; the estimate of a 2 by 2 matrix is exact.
        assert!(
            (found / (d / 4.0) - 1.0).abs() < 1e-6,
            "{method:?}: {found}"
        );
    }
}

#[test]
#[should_panic(expected = "must be factored")]
fn solving_without_factors_is_a_mistake_of_the_caller() {
    SparseSolver::new(Pattern::dense(2).unwrap(), LinearMethod::Klu)
        .unwrap()
        .solve(&mut [1.0, 2.0]);
}

#[test]
fn sparse_factors_solve_what_dense_ones_solve() {
    let mut numbers = Numbers(88_172_645_463_325_252);
    for n in [1, 2, 5, 13, 40] {
        for _ in 0..40 {
            // A diagonal in another order, so that pivots are to be looked for, and a few entries beside it.
            let turned = |column: usize| (column + n / 3) % n;
            let (mut starts, mut rows) = (vec![0], Vec::new());
            for column in 0..n {
                let more = (0..n).filter(|_| numbers.next().unwrap().abs() < 2.0 / n as f64);
                let mut own: Vec<usize> = more.chain([turned(column)]).collect();
                own.sort_unstable();
                own.dedup();
                rows.extend(own.iter().map(|&row| row as i64));
                starts.push(rows.len() as i64);
            }
            let pattern = Pattern::new(n, starts, rows).unwrap();
            let mut solvers =
                METHODS.map(|method| SparseSolver::new(pattern.clone(), method).unwrap());
            for _ in 0..5 {
                let mut values = vec![0.0; pattern.n_entries()];
                for (row, column, entry) in pattern.entries() {
                    // Rows in other units, as of forces and lengths.
                    let unit = [1.0, 1e6, 1e-4][row % 3];
                    let size = if row == turned(column) { 3.0 } else { 1.0 };
                    values[entry] = unit * size * (numbers.next().unwrap());
                }
                let right: Vec<f64> = (0..n).map(|_| numbers.next().unwrap()).collect();
                let both = solvers.each_mut().map(|solver| {
                    solver.factor(&values).ok()?;
                    let mut solution = right.clone();
                    solver.solve(&mut solution);
                    Some(solution)
                });
                let [Some(dense), Some(sparse)] = both else {
                    continue;
                };
                // Old pivots may cost half of the digits before they are given up.
                let condition = solvers[0].reciprocal_condition(&values).unwrap();
                let largest = dense
                    .iter()
                    .fold(0.0_f64, |most, value| most.max(value.abs()));
                for (dense, sparse) in dense.iter().zip(&sparse) {
                    let apart = (dense - sparse).abs() / largest;
                    assert!(apart < 1e-9 / condition, "{n}: {apart:e} at {condition:e}");
                }
            }
        }
    }
}

#[test]
fn factors_set_aside_solve_again_without_another_factorization() {
    for (n, method) in [(5, LinearMethod::Dense), (40, LinearMethod::Klu)] {
        let pattern = bordered_chain(n);
        let mut solver = SparseSolver::new(pattern.clone(), method).unwrap();
        let mut numbers = Numbers(n as u64);
        // Diagonally dominant, so that the pivots of the first serve for the second.
        let mut matrix = || -> Vec<f64> {
            let mut value =
                |row, column| numbers.next().unwrap() + if row == column { 50.0 } else { 0.0 };
            let entries = pattern.entries();
            entries.map(|(row, column, _)| value(row, column)).collect()
        };
        let (first, second) = (matrix(), matrix());
        let x: Vec<f64> = (0..n).map(|k| (k as f64).cos()).collect();
        let assert_solves = |solver: &mut SparseSolver, matrix: &[f64]| {
            let mut b = product(&pattern, matrix, &x);
            solver.solve(&mut b);
            for (found, expected) in b.iter().zip(&x) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
        };
        let mut aside = SetAside::default();
        solver.factor(&first).unwrap();
        assert!(!solver.exchange(&mut aside), "nothing was set aside before");
        solver.factor(&second).unwrap();
        assert_solves(&mut solver, &second);
        assert!(solver.exchange(&mut aside));
        assert_solves(&mut solver, &first);
        assert!(solver.exchange(&mut aside));
        assert_solves(&mut solver, &second);
    }
}
