//! [`assert_partials`]: derivatives written by hand beside differences of the values.

use hyde_program::{Function, Point, Program, Workspace, Wrt};

/// Compares all derivatives by unknowns with central differences: a place that the entries do not name must be zero.
pub(crate) fn assert_partials(program: &Program, y: &[f64], yp: &[f64], z: &[f64]) {
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&[], &mut p);
    let workspace = &mut Workspace::new(program.n_work);
    let n = program.n_unknowns;
    for function in Function::ALL {
        let rows = program.rows(function);
        let entries = program.partials(function);
        let mut values = vec![0.0; entries.len()];
        let point = Point {
            t: 0.3,
            y,
            yp,
            z,
            u: &[],
            p: &p,
        };
        let kernels = &program.kernels;
        kernels.partials(function, point, workspace, &mut values);
        let mut evaluate = |y: &[f64], yp: &[f64]| {
            let mut out = vec![f64::NAN; rows];
            kernels.evaluate(function, Point { y, yp, ..point }, workspace, &mut out);
            out
        };
        for column in 0..2 * n {
            let wrt = match column.checked_sub(n) {
                None => Wrt::Unknown(column),
                Some(of) => Wrt::Derivative(of),
            };
            let mut moved = |by: f64| {
                let (mut y, mut yp) = (y.to_vec(), yp.to_vec());
                match column.checked_sub(n) {
                    None => y[column] += by,
                    Some(of) => yp[of] += by,
                }
                evaluate(&y, &yp)
            };
            let (up, down) = (moved(1e-5), moved(-1e-5));
            for row in 0..rows {
                let listed = entries.iter().zip(&values);
                let written: f64 = listed
                    .filter(|(entry, _)| entry.row == row && entry.wrt == wrt)
                    .map(|(_, value)| value)
                    .sum();
                let difference = (up[row] - down[row]) / 2e-5;
                // Rounding of values up to 1e3 over the step: 1e-8; the third derivative times its square: less.
                assert!(
                    (written - difference).abs() <= 1e-7 * (1.0 + difference.abs()),
                    "{function:?}, row {row} by {wrt:?}: {written}, by differences {difference}"
                );
            }
        }
    }
}
