//! What the solver asks of a model: residual, Jacobian values, root functions.

/// A differential-algebraic system `0 = F(t, y, y')` of as many equations as unknowns.
///
/// Slices have the length of the [`Pattern`](crate::Pattern) the solver was made with. A NaN or an infinity in an
/// output is found by the wrapper and treated like [`Recoverable`]. A panic does not cross the C code: it is parked,
/// IDA is told to stop, and the panic goes on in the caller of the solver.
pub trait System {
    /// Writes `F(t, y, y')` to `out`, one entry per equation.
    ///
    /// # Errors
    /// [`Recoverable`] where the residual has no value: IDA then tries a smaller step.
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable>;

    /// Writes all values of `dF/dy + cj dF/dy'` to `values`, in the order of the pattern (compressed columns), whatever
    /// the linear solver. `values` holds what was written the last time.
    ///
    /// # Errors
    /// [`Recoverable`] where the Jacobian has no value: IDA then tries a smaller step.
    fn jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable>;

    /// Where `F` is affine in `y` and `y'`, with coefficients that are the same wherever a run goes on from its last start: a
    /// number that is the same as long as the coefficients are.
    fn coefficients(&self) -> Option<u64> {
        None
    }

    /// The number of root functions; asked once, when the solver is made.
    fn n_roots(&self) -> usize {
        0
    }

    /// Writes the root functions at `(t, y, y')` to `out`; the solver stops where one of them changes sign.
    ///
    /// # Errors
    /// [`Recoverable`] where a root function has no value; this ends the run, since IDA cannot step around it.
    #[expect(
        unused_variables,
        reason = "named for those who write a system with root functions"
    )]
    fn roots(&mut self, t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), Recoverable> {
        Ok(())
    }
}

/// The model cannot be evaluated here, but might be at a point nearer to the last accepted one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Recoverable;
