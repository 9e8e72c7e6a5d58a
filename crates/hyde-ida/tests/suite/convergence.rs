//! An algebraic variable on a long smooth stretch: the Jacobian stays that of the begin, while what it is of does not.

use hyde_ida::{Ida, Options, Pattern, Recoverable, Stopped, System};

/// The flux of an inductor that saturates, at a sinusoidal voltage: `psi' = 1.25 cos t`, `psi = i/2 + 1.5 b atan(i/b)`.
struct Saturating;

const BEND: f64 = 0.2517;

impl System for Saturating {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - 1.25 * t.cos();
        out[1] = y[0] - flux(y[1]);
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
        let slope = 0.5 + 1.5 / (1.0 + (y[1] / BEND).powi(2));
        values.copy_from_slice(&[cj, 1.0, 0.0, -slope]);
        Ok(())
    }
}

fn flux(i: f64) -> f64 {
    0.5 * i + 1.5 * BEND * (i / BEND).atan()
}

#[test]
fn an_algebraic_variable_does_not_drift_off_unseen() {
    for tenths in 0..60 {
        let rtol = 10_f64.powf(-5.0 - 0.1 * f64::from(tenths));
        let options = Options::new(rtol, vec![1e-2 * rtol; 2], vec![true, false]);
        let pattern = Pattern::dense(2).unwrap();
        let (start, slopes) = ([0.0, 0.0], [1.25, 1.25 / 2.0]);
        let mut solver = Ida::new(Saturating, pattern, options, 0.0, &start, &slopes).unwrap();
        while solver.step(std::f64::consts::TAU).unwrap() != Stopped::Stop {
            let off = (flux(solver.y()[1]) - 1.25 * solver.t().sin()).abs();
            // Some hundred steps at the tolerance.
            assert!(off < 100.0 * rtol, "{off} at {} s with {rtol}", solver.t());
        }
    }
}
