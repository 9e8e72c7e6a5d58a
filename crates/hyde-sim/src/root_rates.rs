//! Where a root function that is zero goes (M2), and what counts as zero.

use crate::consistent::Consistent;
use crate::state::State;
use hyde_program::{Function, Wrt};

/// How far from zero rounding of its arguments alone takes each root function: two modes that meet at a point, one with a
/// guard `g > 0` and the other with `g < 0`, must not both see theirs true. A state that has come to zero from afar, as the
/// height of a ball that lies down, is known to rounding of what it was.
pub(crate) fn rounding(
    state: &mut State<'_>,
    t: f64,
    y: &[f64],
    yp: &[f64],
    largest: &[f64],
) -> Vec<f64> {
    let program = state.program;
    let mut rounding = vec![0.0; program.relations.len()];
    let partials = state.partials(Function::Roots, t, y, yp);
    let delayed = state.delayed().to_vec();
    for (entry, value) in program.partials(Function::Roots).iter().zip(partials) {
        let argument = match entry.wrt {
            Wrt::Unknown(column) if state.differential[column] => {
                let most = largest.get(column).copied().unwrap_or(0.0);
                most.max(y[column].abs())
            }
            Wrt::Unknown(column) => y[column],
            Wrt::Derivative(column) => yp[column],
            Wrt::Delayed(number) => delayed[number],
            Wrt::Time => t,
            Wrt::Parameter(_) | Wrt::Memory(_) => 0.0,
        };
        rounding[entry.row] += 16.0 * f64::EPSILON * (value * argument).abs();
    }
    rounding
}

/// How far the rounding of an instant may reach, in s.
pub(crate) fn moment(t: f64) -> f64 {
    1e-9 * (1.0 + t.abs())
}

/// Where a root function goes: its derivative now, and the mean of that and the one a moment later.
#[derive(Clone, Copy, Default)]
pub(crate) struct RootRate {
    pub(crate) now: f64,
    pub(crate) mean: f64,
}

impl RootRate {
    /// How far a root function may be on the other side of zero before it goes where it goes: within the moment it turns,
    /// and not farther than it would go on.
    pub(crate) fn detour(self, t: f64) -> f64 {
        match self.now * self.mean < 0.0 {
            true => self.now.abs() * moment(t),
            false => 0.0,
        }
    }
}

/// In which direction each root function leaves zero along the flow: the sign of the mean.
///
/// A friction that breaks away does so where the acceleration is still zero, so the derivative alone would be rounding;
/// a moment later it has its sign.
pub(crate) fn root_rates(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    t: f64,
    y: &[f64],
    yp: &[f64],
) -> Vec<RootRate> {
    let Some((now, dy, dyp)) = rates_at(Function::Roots, state, consistent, t, y, yp) else {
        return vec![RootRate::default(); state.program.relations.len()];
    };
    let with = |later: &[f64]| -> Vec<RootRate> {
        let pairs = now.iter().zip(later);
        let rate = |(&now, later): (&f64, &f64)| RootRate {
            now,
            mean: 0.5 * (now + later),
        };
        pairs.map(rate).collect()
    };
    let moment = moment(t);
    // To second order: what breaks away may do so where its acceleration is not quite zero yet.
    let ahead = |i: usize| {
        let bend = if state.differential[i] { dyp[i] } else { 0.0 };
        y[i] + moment * (dy[i] + 0.5 * moment * bend)
    };
    let mut y_later: Vec<f64> = (0..y.len()).map(ahead).collect();
    let mut yp_later = yp.to_vec();
    if consistent
        .solve(state, t + moment, &mut y_later, &mut yp_later, false)
        .is_err()
    {
        return with(&now);
    }
    let later = rates_at(
        Function::Roots,
        state,
        consistent,
        t + moment,
        &y_later,
        &yp_later,
    );
    with(later.as_ref().map_or(&now, |(later, ..)| later))
}

/// The derivatives of a function along the flow at a point, and those of y and y'.
pub(crate) fn rates_at(
    function: Function,
    state: &mut State<'_>,
    consistent: &mut Consistent,
    t: f64,
    y: &[f64],
    yp: &[f64],
) -> Option<(Vec<f64>, Vec<f64>, Vec<f64>)> {
    let program = state.program;
    let mut rates = vec![0.0; program.rows(function)];
    let (dy, dyp) = consistent.flow(state, t, y, yp)?;
    let partials = state.partials(function, t, y, yp);
    for (entry, value) in program.partials(function).iter().zip(partials) {
        rates[entry.row] += match entry.wrt {
            Wrt::Unknown(column) => value * dy[column],
            Wrt::Derivative(column) => value * dyp[column],
            Wrt::Delayed(_) | Wrt::Time | Wrt::Parameter(_) | Wrt::Memory(_) => 0.0,
        };
    }
    // The time itself, and record columns and delayed values that move with it.
    let step = 1e-7 * (1e-3 + t.abs());
    let (mut later, mut now) = (vec![0.0; rates.len()], vec![0.0; rates.len()]);
    state.evaluate(function, t + step, y, yp, &mut later);
    state.evaluate(function, t, y, yp, &mut now);
    for (rate, (later, now)) in rates.iter_mut().zip(later.iter().zip(&now)) {
        *rate += (later - now) / step;
    }
    Some((rates, dy, dyp))
}
