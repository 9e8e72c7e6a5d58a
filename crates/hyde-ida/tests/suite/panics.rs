//! A panic in the model crosses the C code unharmed.

use std::panic::{AssertUnwindSafe, catch_unwind};

use hyde_ida::{Ida, Options, Pattern, Recoverable, Stopped, System};

/// `y' = 1`, which panics in one of its functions from `t = 1` on.
struct Fragile {
    breaks: &'static str,
}

impl Fragile {
    fn call(&self, function: &'static str, t: f64) {
        assert!(t < 1.0 || self.breaks != function, "{function} broke");
    }
}

impl System for Fragile {
    fn residual(
        &mut self,
        t: f64,
        _y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        self.call("residual", t);
        out[0] = yp[0] - 1.0;
        Ok(())
    }

    fn jacobian(
        &mut self,
        t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        self.call("jacobian", t);
        values[0] = cj;
        Ok(())
    }

    fn n_roots(&self) -> usize {
        1
    }

    fn roots(
        &mut self,
        t: f64,
        _y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        self.call("roots", t);
        out[0] = 1.0;
        Ok(())
    }
}

#[test]
fn it_goes_on_in_the_caller_and_leaves_the_solver_usable() {
    for function in ["residual", "jacobian", "roots"] {
        let options = Options::new(1e-6, vec![1e-6], vec![true]);
        let pattern = Pattern::dense(1).unwrap();
        let system = Fragile { breaks: function };
        let mut solver = Ida::new(system, pattern, options, 0.0, &[0.0], &[1.0]).unwrap();
        let payload = catch_unwind(AssertUnwindSafe(|| {
            while solver.step(10.0).unwrap() != Stopped::Stop {}
        }))
        .unwrap_err();
        assert_eq!(
            *payload.downcast::<String>().unwrap(),
            format!("{function} broke")
        );

        // The roots are looked at when the step has been taken, the other functions while it is tried.
        assert_eq!(solver.t() < 1.0, function != "roots");
        // The line is exact.
        assert!((solver.y()[0] - solver.t()).abs() < 1e-12);
        solver.system_mut().breaks = "nothing";
        while solver.step(10.0).unwrap() != Stopped::Stop {}
        assert_eq!(solver.t(), 10.0);
    }
}

#[test]
fn at_the_very_first_call_the_solver_stays_at_its_start() {
    let options = Options::new(1e-6, vec![1e-6], vec![true]);
    let pattern = Pattern::dense(1).unwrap();
    let system = Fragile { breaks: "residual" };
    let mut solver = Ida::new(system, pattern, options, 5.0, &[2.0], &[1.0]).unwrap();
    catch_unwind(AssertUnwindSafe(|| solver.step(10.0))).unwrap_err();
    assert_eq!((solver.t(), solver.y()[0], solver.yp()[0]), (5.0, 2.0, 1.0));
}
