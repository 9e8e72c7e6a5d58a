//! The limit test of an effect: what it does at a thousandth of its size is a thousandth of what it does (E3).

use hyde_program::Program;
use hyde_sim::Results;

/// The part of its typical size at which an effect is to be almost gone.
pub const LIMIT_PART: f64 = 1e-3;
/// How much of the typical difference may be left there: twice the part.
pub const LIMIT_LEFT: f64 = 2.0 * LIMIT_PART;

/// How far a state is from that of the plain model, at most, over the times compared.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The state.
    pub state: String,
    /// Its largest magnitude in the plain model, SI.
    pub scale: f64,
    /// Its largest difference at the typical size, SI.
    pub typical: f64,
    /// Its largest difference at [`LIMIT_PART`] of that, SI.
    pub small: f64,
}

impl Answer {
    /// Whether the effect is seen in this state: a thousandth of the difference is above the error of runs at this
    /// relative tolerance, taken as a hundred times the tolerance.
    #[must_use]
    pub fn is_seen(&self, rtol: f64) -> bool {
        LIMIT_PART * self.typical > 100.0 * rtol * self.scale
    }

    /// The part of the difference that is left at the small size; at most [`LIMIT_LEFT`] of an effect that vanishes.
    #[must_use]
    pub fn left(&self) -> f64 {
        self.small / self.typical
    }
}

/// Compares the states of a plain model with those under an effect of [`LIMIT_PART`] its typical size and of all of it, at
/// the rows common to the three runs that are further than `away_s` seconds from any event.
#[must_use]
pub fn limit(
    plain: (&Program, &Results),
    small: (&Program, &Results),
    typical: (&Program, &Results),
    away_s: f64,
) -> Vec<Answer> {
    let runs = [plain, small, typical];
    let times = quiet_times(runs.map(|(_, results)| results), away_s);
    let mut answers = Vec::new();
    for block in plain.0.unknowns.iter().filter(|block| block.differential) {
        for position in block.offset..block.offset + block.len {
            let state = plain.0.unknown_name(position);
            let columns = runs.map(|(program, results)| results.column(program.output(&state)?));
            let [Some(plain), Some(small), Some(typical)] = columns else {
                continue;
            };
            let largest = |of: &dyn Fn(&[usize; 3]) -> f64| {
                times.iter().map(|rows| of(rows).abs()).fold(0.0, f64::max)
            };
            answers.push(Answer {
                scale: largest(&|rows| plain[rows[0]]),
                small: largest(&|rows| small[rows[1]] - plain[rows[0]]),
                typical: largest(&|rows| typical[rows[2]] - plain[rows[0]]),
                state,
            });
        }
    }
    answers
}

/// The rows of each run at the instants that all have and where nothing happens in any, soon before or after.
fn quiet_times(runs: [&Results; 3], away_s: f64) -> Vec<[usize; 3]> {
    let mut events: Vec<f64> = runs
        .iter()
        .flat_map(|results| results.events.iter().map(|event| event.t))
        .collect();
    events.sort_by(f64::total_cmp);
    let quiet = |t: f64| {
        let next = events.partition_point(|&event| event < t - away_s);
        events.get(next).is_none_or(|&event| event > t + away_s)
    };
    let row = |results: &Results, t| {
        let (first, last) = results.rows_at(t)?;
        (first == last).then_some(first)
    };
    let [plain, small, typical] = runs;
    let common = plain.time.iter().filter(|&&t| quiet(t));
    common
        .filter_map(|&t| Some([row(plain, t)?, row(small, t)?, row(typical, t)?]))
        .collect()
}
