//! Where a root function that is zero goes (M2).

use crate::consistent::{Consistent, Flow};
use crate::moment::{At, Moment};
use crate::state::State;
use crate::zero::reach_s;
use hyde_program::{Function, Wrt};

/// How many times longer the moment becomes until rounding no longer hides where a root function goes, and how often.
const LONGER: f64 = 10.0;
const MOST_TIMES: usize = 3;
/// How far from rounding a derivative has a sign.
const CLEAR: f64 = 4.0;
/// The same beside what counts as zero: that is rounding of all arguments, 16 units each, and here of the states, 2 units each.
const AT_ZERO: f64 = 32.0;

/// Where a root function goes: its derivative now, and the mean of that and the one a moment later.
#[derive(Clone, Copy, Default)]
pub(crate) struct RootRate {
    now: f64,
    pub(crate) mean: f64,
    /// What rounding of the states makes of the derivative.
    rounding: f64,
    /// How much later, in s.
    ahead_s: f64,
}

impl RootRate {
    /// Whether rounding of the states hides where a root function goes.
    fn is_hidden(self) -> bool {
        self.mean.abs() <= CLEAR * self.rounding
    }

    /// Whether rounding by which a guard led here, as large as what counts as zero, hides where a root function goes.
    pub(crate) fn is_hidden_at_zero(self) -> bool {
        self.mean.abs() <= AT_ZERO * self.rounding
    }

    /// Whether a root function turns within the moment.
    fn turns(self) -> bool {
        self.now * self.mean < 0.0
    }

    /// Whether a root function that falls turns before it has fallen by so much, or within the moment.
    pub(crate) fn returns_before(self, height: f64) -> bool {
        let bend = 2.0 * (self.mean - self.now) / self.ahead_s;
        self.now < 0.0 && (self.turns() || 0.5 * self.now.powi(2) < bend * height)
    }

    /// How far a root function may be on the other side of zero before it goes where it goes: within the moment it turns,
    /// and not farther than it would go on.
    pub(crate) fn detour(self) -> f64 {
        let back = match self.turns() {
            true => self.now.abs(),
            false => 0.0,
        };
        (back + self.rounding) * self.ahead_s
    }
}

/// In which direction some root functions leave zero along the flow: the sign of the mean. All have their rates, but only
/// for these it is looked farther ahead.
///
/// A friction that breaks away does so where the acceleration is still zero, so the derivative alone would be rounding;
/// a moment later it has its sign. In a stiff bar whose angles are large that takes longer: rounding of the angles is a
/// torque there, which is tried by rounding them otherwise.
pub(crate) fn root_rates(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    at: At<'_>,
    relations: &[usize],
) -> Vec<RootRate> {
    let At { t, y, yp } = at;
    let Some((now, flow)) = rates_at(Function::Roots, state, consistent, at) else {
        return vec![RootRate::default(); state.program.relations.len()];
    };
    let Flow { dy, dyp } = flow.clone();
    let (differential, (_, atol)) = (state.differential.clone(), state.tolerances);
    let mut rates_of = |t: f64, y: Vec<f64>| -> Option<Vec<f64>> {
        let yp = yp.to_vec();
        let mut beside = Moment { t, y, yp };
        consistent.solve(state, &mut beside, false).ok()?;
        let (rates, _) = rates_at(Function::Roots, state, consistent, beside.at())?;
        Some(rates)
    };
    let otherwise = rates_of(t, rounded_otherwise(y, &differential, atol));
    let found = now.iter().enumerate().map(|(number, &now)| RootRate {
        now,
        mean: now,
        rounding: otherwise
            .as_ref()
            .map_or(0.0, |rates| (rates[number] - now).abs()),
        ahead_s: reach_s(t),
    });
    let mut found: Vec<RootRate> = found.collect();
    let mut ahead = reach_s(t);
    for _ in 0..MOST_TIMES {
        // To second order: what breaks away may do so where its acceleration is not quite zero yet.
        let y_later = (0..y.len()).map(|i| {
            let bend = if differential[i] { dyp[i] } else { 0.0 };
            y[i] + ahead * (dy[i] + 0.5 * ahead * bend)
        });
        let Some(later) = rates_of(t + ahead, y_later.collect()) else {
            break;
        };
        for (rate, later) in found.iter_mut().zip(later) {
            if rate.ahead_s >= ahead || rate.is_hidden() {
                rate.mean = 0.5 * (rate.now + later);
                rate.ahead_s = ahead;
            }
        }
        let mut asked = relations.iter().map(|&relation| &found[relation]);
        if !asked.any(|rate| rate.rounding > 0.0 && rate.is_hidden()) {
            break;
        }
        ahead *= LONGER;
    }
    found
}

/// States as they might as well be rounded: each by its own number of units in the last place, for what two have in common
/// would cancel where their difference counts. A state near zero has those of its tolerance: what a step leaves of a motion
/// that begins with a high derivative has any sign.
fn rounded_otherwise(y: &[f64], differential: &[bool], atol: f64) -> Vec<f64> {
    let each = y.iter().zip(differential).enumerate();
    each.map(|(number, (value, differential))| {
        let units = match (*differential, number % 4) {
            (false, _) => 0.0,
            (true, 0) => 2.0,
            (true, 1) => -1.0,
            (true, 2) => 1.0,
            (true, _) => -2.0,
        };
        let size = if value.abs() > atol { *value } else { atol };
        value + units * f64::EPSILON * size
    })
    .collect()
}

/// The derivatives of a function along the flow at a point, and those of y and y'.
pub(crate) fn rates_at<'c>(
    function: Function,
    state: &mut State<'_>,
    consistent: &'c mut Consistent,
    at: At<'_>,
) -> Option<(Vec<f64>, &'c Flow)> {
    let program = state.program;
    let mut rates = vec![0.0; program.rows(function)];
    let flow = consistent.flow(state, at)?;
    let partials = state.partials(function, at);
    for (entry, value) in program.partials(function).iter().zip(partials) {
        rates[entry.row] += match entry.wrt {
            Wrt::Unknown(column) => value * flow.dy[column],
            Wrt::Derivative(column) => value * flow.dyp[column],
            Wrt::Delayed(_) | Wrt::Time | Wrt::Parameter(_) | Wrt::Memory(_) => 0.0,
        };
    }
    let by_time = state.by_time(function, at);
    for (rate, by_time) in rates.iter_mut().zip(by_time) {
        *rate += by_time;
    }
    Some((rates, flow))
}
