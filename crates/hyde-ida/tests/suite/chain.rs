//! A chain of masses in one of its modes: many unknowns, KLU, restarts.

use hyde_ida::{Ida, Options, Pattern, Recoverable, Stopped, System};

/// Unit masses between fixed ends, joined by unit springs: `x_i' = v_i`, `v_i' = x_(i-1) - 2 x_i + x_(i+1)`.
///
/// Unknowns are all `x`, then all `v`; the equations have the same order.
struct Chain {
    masses: usize,
    pattern: Pattern,
}

impl Chain {
    fn new(masses: usize) -> Self {
        let n = masses;
        let mut starts = vec![0];
        let mut rows: Vec<i64> = Vec::new();
        for column in 0..2 * n {
            let mass = column % n;
            if column < n {
                rows.push(mass as i64);
                let neighbours = mass.saturating_sub(1)..=(mass + 1).min(n - 1);
                rows.extend(neighbours.map(|row| (n + row) as i64));
            } else {
                rows.extend([mass as i64, (n + mass) as i64]);
            }
            starts.push(rows.len() as i64);
        }
        Self {
            masses,
            pattern: Pattern::new(2 * n, starts, rows).unwrap(),
        }
    }

    /// Displacement and speed of a mass at `t` in the mode with this many half waves.
    fn mode(&self, half_waves: usize, mass: usize, t: f64) -> (f64, f64) {
        let phase = std::f64::consts::PI * half_waves as f64 / (self.masses + 1) as f64;
        let omega = 2.0 * (0.5 * phase).sin();
        let shape = (phase * (mass + 1) as f64).sin();
        (
            shape * (omega * t).cos(),
            -omega * shape * (omega * t).sin(),
        )
    }
}

impl System for Chain {
    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        let n = self.masses;
        let x = |mass: isize| {
            if (0..n as isize).contains(&mass) {
                y[mass as usize]
            } else {
                0.0
            }
        };
        for mass in 0..n {
            let at = mass as isize;
            out[mass] = yp[mass] - y[n + mass];
            out[n + mass] = yp[n + mass] - x(at - 1) + 2.0 * x(at) - x(at + 1);
        }
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        let n = self.masses;
        for (row, column, entry) in self.pattern.entries() {
            values[entry] = match (row < n, column < n) {
                (true, true) => cj,
                (true, false) => -1.0,
                (false, true) => {
                    if row - n == column {
                        2.0
                    } else {
                        -1.0
                    }
                }
                (false, false) => cj,
            };
        }
        Ok(())
    }
}

#[test]
fn swings_in_its_mode() {
    let chain = Chain::new(37);
    let (n, pattern) = (chain.masses, chain.pattern.clone());
    let state = |t: f64| -> Vec<f64> {
        let mode = |mass| chain.mode(3, mass, t);
        (0..n)
            .map(|mass| mode(mass).0)
            .chain((0..n).map(|mass| mode(mass).1))
            .collect()
    };
    let (y0, speeds) = (state(0.0), vec![0.0; n]);
    let omega = 2.0 * (1.5 * std::f64::consts::PI / (n + 1) as f64).sin();
    let accelerations: Vec<f64> = y0[..n].iter().map(|x| -omega * omega * x).collect();
    let yp0 = [speeds, accelerations].concat();
    let options = Options::new(1e-8, vec![1e-8; 2 * n], vec![true; 2 * n]);
    let mut solver = Ida::new(Chain::new(n), pattern, options, 0.0, &y0, &yp0).unwrap();
    for stop in [10.0, 20.0, 30.0] {
        while solver.step(stop).unwrap() != Stopped::Stop {}
        for (found, exact) in solver.y().iter().zip(state(stop)) {
            // Some hundred steps within 1e-8, which add up.
            assert!(
                (found - exact).abs() < 1e-6,
                "{found} instead of {exact} at t = {stop}"
            );
        }
        let (y, yp) = (solver.y().to_vec(), solver.yp().to_vec());
        solver.reinit(stop, &y, &yp, Some(1e-3)).unwrap();
    }
    let statistics = solver.statistics();
    assert_eq!(
        statistics.factorizations, 1,
        "restarts keep analysis and pivots: {statistics:?}"
    );
    assert_eq!(
        statistics.refactorizations,
        statistics.jacobian_evaluations - 1
    );
    assert_eq!(statistics.restarts, 3);
}
