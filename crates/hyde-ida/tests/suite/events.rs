//! Root functions, restarts, and what a restart keeps.

use hyde_ida::{Crossing, Ida, Options, Pattern, Recoverable, Stopped, System};

const GRAVITY: f64 = 9.81;
const RESTITUTION: f64 = 0.8;

/// A ball above the ground: `x' = v`, `v' = -g`, with a root at `x = 0`.
struct Ball;

impl System for Ball {
    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - y[1];
        out[1] = yp[1] + GRAVITY;
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
        values.copy_from_slice(&[cj, 0.0, -1.0, cj]);
        Ok(())
    }

    fn n_roots(&self) -> usize {
        1
    }

    fn roots(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = y[0];
        Ok(())
    }
}

#[test]
fn a_bouncing_ball_hits_the_ground_when_it_should() {
    let options = Options::new(1e-10, vec![1e-12; 2], vec![true; 2]);
    let pattern = Pattern::dense(2).unwrap();
    let mut solver = Ida::new(Ball, pattern, options, 0.0, &[1.0, 0.0], &[0.0, -GRAVITY]).unwrap();
    solver
        .set_root_directions(&[Some(Crossing::Falling)])
        .unwrap();

    let mut impact = (2.0 / GRAVITY).sqrt();
    let mut speed = (2.0 * GRAVITY).sqrt();
    for _ in 0..10 {
        while solver.step(10.0).unwrap() != Stopped::Root {}
        // The motion is a parabola, which order 2 follows exactly; what is left is the first steps of order 1, each
        // within the tolerance, and some ten bounces of them.
        assert!(
            (solver.t() - impact).abs() < 1e-8,
            "{} instead of {impact}",
            solver.t()
        );
        assert!((solver.y()[1] + speed).abs() < 1e-7);
        assert_eq!(
            solver.roots_found().collect::<Vec<_>>(),
            [(0, Crossing::Falling)]
        );
        speed *= RESTITUTION;
        impact += 2.0 * speed / GRAVITY;
        solver
            .reinit(solver.t(), &[0.0, speed], &[speed, -GRAVITY], Some(1e-4))
            .unwrap();
        assert_eq!(solver.roots_found().count(), 0);
    }
    assert_eq!(solver.statistics().restarts, 10);
}

/// `y' = slope`, with a root function that is 0 until `armed`, then `y - 1`.
struct Ramp {
    slope: f64,
    armed: bool,
}

impl System for Ramp {
    fn residual(
        &mut self,
        _t: f64,
        _y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - self.slope;
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
        values[0] = cj;
        Ok(())
    }

    fn n_roots(&self) -> usize {
        1
    }

    fn roots(
        &mut self,
        _t: f64,
        y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = if self.armed { y[0] - 1.0 } else { 0.0 };
        Ok(())
    }
}

fn ramp() -> Ida<Ramp> {
    let options = Options::new(1e-8, vec![1e-8], vec![true]);
    let system = Ramp {
        slope: 1.0,
        armed: false,
    };
    Ida::new(
        system,
        Pattern::dense(1).unwrap(),
        options,
        0.0,
        &[0.0],
        &[1.0],
    )
    .unwrap()
}

#[test]
fn a_root_function_that_was_zero_is_watched_from_the_restart_on() {
    let mut solver = ramp();
    while solver.step(0.5).unwrap() != Stopped::Stop {}
    solver.system_mut().armed = true;
    // A first step so long that the crossing at t = 1 lies inside it.
    solver.reinit(0.5, &[0.5], &[1.0], Some(2.0)).unwrap();
    assert_eq!(solver.step(4.0).unwrap(), Stopped::Root);
    // The line is exact; IDA locates roots to 100 units in the last place.
    assert!((solver.t() - 1.0).abs() < 1e-13);
}

#[test]
fn directions_outlive_a_restart() {
    let mut solver = ramp();
    solver.system_mut().armed = true;
    solver
        .set_root_directions(&[Some(Crossing::Falling)])
        .unwrap();
    solver.reinit(0.0, &[0.0], &[1.0], None).unwrap();
    while solver.step(2.0).unwrap() != Stopped::Stop {}
    assert_eq!(solver.t(), 2.0);
}

#[test]
fn a_step_cut_short_by_a_root_goes_on_to_its_end() {
    let mut solver = ramp();
    solver.system_mut().armed = true;
    solver.reinit(0.0, &[0.0], &[1.0], Some(3.0)).unwrap();
    assert_eq!(solver.step(10.0).unwrap(), Stopped::Root);
    assert_eq!(solver.last_interval(), (0.0, 3.0));
    assert_eq!(solver.step(10.0).unwrap(), Stopped::Step);
    assert_eq!(solver.t(), 3.0);
}

#[test]
fn a_stop_inside_the_step_that_had_a_root_is_kept() {
    let mut solver = ramp();
    solver.system_mut().armed = true;
    solver.reinit(0.0, &[0.0], &[1.0], Some(3.0)).unwrap();
    assert_eq!(solver.step(10.0).unwrap(), Stopped::Root);
    assert_eq!(solver.step(2.0).unwrap(), Stopped::Stop);
    assert_eq!(solver.t(), 2.0);
    // The polynomial is the line, up to the rounding of divided differences.
    assert!((solver.y()[0] - 2.0).abs() < 1e-12);
}
