//! Robertson's kinetics against the output published with SUNDIALS 7: `idaRoberts_dns.out` and `idaRoberts_klu.out` in
//! `examples/ida/serial`.

use hyde_ida::{Crossing, Ida, LinearMethod, Options, Pattern, Recoverable, Stopped, System};

/// `t`, `y1`, `y2`, `y3` as printed, and the root function found there with its crossing.
type Line = (f64, [f64; 3], Option<(usize, Crossing)>);

/// What the two programs print in common, with dense matrices and with KLU.
const PUBLISHED: [Line; 8] = [
    (
        2.6402e-01,
        [9.8997e-01, 3.4706e-05, 1.0000e-02],
        Some((1, Crossing::Rising)),
    ),
    (4.0000e-01, [9.8517e-01, 3.3864e-05, 1.4794e-02], None),
    (4.0000e+00, [9.0553e-01, 2.2406e-05, 9.4452e-02], None),
    (4.0000e+01, [7.1579e-01, 9.1838e-06, 2.8420e-01], None),
    (4.0000e+02, [4.5044e-01, 3.2218e-06, 5.4956e-01], None),
    (4.0000e+03, [1.8320e-01, 8.9444e-07, 8.1680e-01], None),
    (4.0000e+04, [3.8992e-02, 1.6221e-07, 9.6101e-01], None),
    (4.0000e+05, [4.9369e-03, 1.9842e-08, 9.9506e-01], None),
];

const PUBLISHED_DENSE: [Line; 6] = [
    (4.0000e+06, [5.1674e-04, 2.0684e-09, 9.9948e-01], None),
    (
        2.0788e+07,
        [1.0000e-04, 4.0004e-10, 9.9990e-01],
        Some((0, Crossing::Falling)),
    ),
    (4.0000e+07, [5.2009e-05, 2.0805e-10, 9.9995e-01], None),
    (4.0000e+08, [5.2012e-06, 2.0805e-11, 9.9999e-01], None),
    (4.0000e+09, [5.1850e-07, 2.0740e-12, 1.0000e+00], None),
    (4.0000e+10, [4.8641e-08, 1.9456e-13, 1.0000e+00], None),
];

const PUBLISHED_KLU: [Line; 6] = [
    (4.0000e+06, [5.1693e-04, 2.0688e-09, 9.9948e-01], None),
    (
        2.0801e+07,
        [1.0000e-04, 4.0004e-10, 9.9990e-01],
        Some((0, Crossing::Falling)),
    ),
    (4.0000e+07, [5.2043e-05, 2.0818e-10, 9.9995e-01], None),
    (4.0000e+08, [5.2113e-06, 2.0845e-11, 9.9999e-01], None),
    (4.0000e+09, [5.2515e-07, 2.1006e-12, 1.0000e+00], None),
    (4.0000e+10, [5.1251e-08, 2.0500e-13, 1.0000e+00], None),
];

/// Three species: two slow equations and the conservation of mass.
pub(crate) struct Robertson;

impl System for Robertson {
    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        let rate = -0.04 * y[0] + 1e4 * y[1] * y[2];
        out[0] = rate - yp[0];
        out[1] = -rate - 3e7 * y[1] * y[1] - yp[1];
        out[2] = y[0] + y[1] + y[2] - 1.0;
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values[..3].copy_from_slice(&[-0.04 - cj, 0.04, 1.0]);
        values[3..6].copy_from_slice(&[1e4 * y[2], -1e4 * y[2] - 6e7 * y[1] - cj, 1.0]);
        values[6..].copy_from_slice(&[1e4 * y[1], -1e4 * y[1], 1.0]);
        Ok(())
    }

    fn n_roots(&self) -> usize {
        2
    }

    fn roots(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = y[0] - 1e-4;
        out[1] = y[2] - 0.01;
        Ok(())
    }
}

pub(crate) fn solver(method: LinearMethod) -> Ida<Robertson> {
    let mut options = Options::new(1e-4, vec![1e-8, 1e-6, 1e-6], vec![true, true, false]);
    options.suppress_algebraic = false;
    options.linear_method = method;
    // As published, digit by digit and step by step.
    options.watch_convergence = false;
    let pattern = Pattern::dense(3).unwrap();
    Ida::new(
        Robertson,
        pattern,
        options,
        0.0,
        &[1.0, 0.0, 0.0],
        &[-0.04, 0.04, 0.0],
    )
    .unwrap()
}

/// Runs to the end and compares with what is published for this method.
pub(crate) fn compare(mut solver: Ida<Robertson>, method: LinearMethod) {
    // The counts of steps, residuals and Jacobians.
    let (last_lines, counts) = match method {
        LinearMethod::Dense | LinearMethod::Auto => (PUBLISHED_DENSE, [362, 537, 60]),
        LinearMethod::Klu => (PUBLISHED_KLU, [375, 529, 54]),
    };
    let mut t_out = 0.4;
    for (t, y, root) in PUBLISHED.into_iter().chain(last_lines) {
        let stopped = solver.solve(t_out, f64::INFINITY).unwrap();
        assert_eq!(
            stopped,
            if root.is_some() {
                Stopped::Root
            } else {
                Stopped::Output
            }
        );
        assert_eq!(
            solver.roots_found().collect::<Vec<_>>(),
            Vec::from_iter(root)
        );
        // The same method with the same tolerances: all five digits, but for the rounding of the last.
        let close = |found: f64, printed: f64| (found / printed - 1.0).abs() < 1e-4;
        assert!(close(solver.t(), t), "t = {} instead of {t}", solver.t());
        for (found, printed) in solver.y().iter().zip(y) {
            assert!(
                close(*found, printed),
                "{found} instead of {printed} at t = {t}"
            );
        }
        if root.is_none() {
            t_out *= 10.0;
        }
    }
    let found = solver.statistics();
    let found = [
        found.steps,
        found.residual_evaluations,
        found.jacobian_evaluations,
    ];
    for (found, published) in found.into_iter().zip(counts) {
        // Equal where this was written; another compiler's rounding may shift the choice of a step here and there.
        assert!(
            found.abs_diff(published) <= 10,
            "{found} instead of {published}"
        );
    }
}

#[test]
fn dense_gives_the_published_values() {
    compare(solver(LinearMethod::Dense), LinearMethod::Dense);
}

#[test]
fn klu_gives_the_published_values() {
    compare(solver(LinearMethod::Klu), LinearMethod::Klu);
}
