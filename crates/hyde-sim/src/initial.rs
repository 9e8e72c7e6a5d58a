//! The initial system: start values, initial equations, first consistent values (I1 to I3).
//!
//! Where every state starts at its start value only consistent values are left to solve. With initial equations, y and
//! the states' y' are unknown together: F = 0, each fixed start value, each initial equation, by a damped Newton method.
//! So are delayed values, which are at the start what they are the delay of.

use crate::consistent::{Consistent, is_rounding};
use crate::failure::{Failure, FailureKind};
use crate::moment::{At, Moment};
use crate::norms::{largest_of, norm};
use crate::release::{self, by_parameter};
use crate::selection;
use crate::start_branches::other_branch;
use crate::state::State;
use hyde_ida::{LinearMethod, Pattern, SparseSolver};
use hyde_program::{Function, InitialCondition, RelationUse, Wrt};

const MAX_ITERATIONS: usize = 100;
const MAX_HALVINGS: usize = 20;

/// A start value is met to this: authors write some six digits of what a constraint makes of the others.
const START_RTOL: f64 = 1e-5;
const START_ATOL: f64 = 1e-9;

/// Start values of y and the memory, before anything is solved.
pub(crate) fn start(state: &mut State<'_>, t: f64) -> Moment {
    let mut now = Moment::zero(t, state.program.n_unknowns);
    let p = state.p.clone();
    state.program.kernels.start(&p, &mut now.y, &mut state.z);
    state.guess_past(now.at());
    now
}

/// What the initial system is solved from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Round {
    /// From start values: relations of equations as they are at the first guess.
    First,
    /// From the solution before, with relations as they are now.
    Again,
    /// The same with the states as they are.
    StatesKept,
}

/// Solves the initial equations, if there are any; the states then have their values.
pub(crate) fn solve(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    now: &mut Moment,
    round: Round,
) -> Result<(), Box<Failure>> {
    let program = state.program;
    if round != Round::StatesKept {
        selection::choose_at_start(state, now);
    }
    let count = match round {
        Round::First | Round::Again => program.n_initial_equations(),
        Round::StatesKept => 0,
    };
    let delays = program.delays.len();
    if count == 0 && delays == 0 {
        if round == Round::First {
            guess_relations(state, now.at(), Known::Guesses);
        }
        let start = now.clone();
        if let Err(failure) = consistent.solve(state, now, true)
            && !(round == Round::First && other_branch(state, consistent, (now, &start)))
        {
            return Err(failure);
        }
        return check(state, now.at(), round);
    }
    // A first guess for the rest from the states' start values; it need not exist.
    let mut guess = now.clone();
    if consistent.solve(state, &mut guess, true).is_ok() {
        *now = guess;
    }
    if round == Round::First && count > 0 {
        guess_relations(state, now.at(), Known::All);
        release::choose(state, consistent, now.at(), count)?;
    }
    let Shape {
        n,
        states,
        column_of_rate,
        fixed,
        found,
        size,
        pattern,
        positions,
        ..
    } = Shape::new(state, count, now.t)?;
    let targets: Vec<f64> = fixed.iter().map(|&i| now.y[i]).collect();
    let t = now.t;
    let mut past = state.delayed_at(t).to_vec();
    let failed = |singular: Vec<String>| {
        let mut failure = Failure::new(
            FailureKind::Inconsistent {
                singular,
                at_start: true,
            },
            t,
        );
        for condition in &program.initial {
            if let InitialCondition::Equation { origin, .. } = condition {
                failure = failure.at_origin(origin);
            }
        }
        failure
    };
    let mut solver =
        SparseSolver::new(pattern, LinearMethod::Auto).map_err(|_| failed(Vec::new()))?;
    let residual = |state: &mut State<'_>, at: At<'_>, past: &[f64]| {
        let mut out = vec![0.0; size];
        state.delays.set_past(at.t, past);
        state.evaluate(Function::Residual, at, &mut out[..n]);
        let equations = state.values(Function::Initial, at);
        out[n..n + count].copy_from_slice(&equations[..count]);
        for (number, (&i, target)) in fixed.iter().zip(&targets).enumerate() {
            out[n + count + number] = at.y[i] - target;
        }
        let now = state.values(Function::Delayed, at);
        for ((out, past), now) in out[size - delays..].iter_mut().zip(past).zip(now) {
            *out = past - now;
        }
        out
    };
    let mut r = residual(state, now.at(), &past);
    for iteration in 0..MAX_ITERATIONS {
        let mut values_now = values(state, now.at(), &positions, &found, count);
        if solver.factor(&values_now).is_err() && iteration == 0 {
            // A product of unknowns that both start at 0 says nothing there: look from elsewhere once.
            release::move_released(state, &mut now.y);
            r = residual(state, now.at(), &past);
            values_now = values(state, now.at(), &positions, &found, count);
        }
        if let Err(singular) = solver.factor(&values_now) {
            let column = singular.unknown;
            let position = match column.checked_sub(n) {
                None => Some(column),
                Some(rate) => states.get(rate).copied(),
            };
            let open = position.map(|position| program.unknown_name(position));
            return Err(failed(open.into_iter().collect()));
        }
        let mut step = r.clone();
        solver.solve(&mut step);
        let (old, before) = (now.clone(), norm(&r));
        let old_past = past.clone();
        let old_found: Vec<f64> = found.iter().map(|&place| state.p[place]).collect();
        let rates: Vec<f64> = states.iter().map(|&i| old.yp[i]).collect();
        let solved = [&old.y[..], &rates, &old_found, &old_past].concat();
        let rounding = is_rounding(&solved, &step);
        let mut factor = 1.0;
        let mut whole = false;
        for halving in 0..=MAX_HALVINGS {
            for i in 0..n {
                now.y[i] = old.y[i] - factor * step[i];
                if let Some(column) = column_of_rate[i] {
                    now.yp[i] = old.yp[i] - factor * step[column];
                }
            }
            for (number, past) in past.iter_mut().enumerate() {
                *past = old_past[number] - factor * step[size - delays + number];
            }
            let each = found.iter().zip(&old_found).zip(&step[n + states.len()..]);
            let each = each.map(|((&place, old), step)| (place, old - factor * step));
            state.set_parameters(&each.collect::<Vec<_>>());
            r = residual(state, now.at(), &past);
            let after = norm(&r);
            if after.is_finite() && (after <= before || halving == MAX_HALVINGS || rounding) {
                whole = halving == 0;
                break;
            }
            factor *= 0.5;
        }
        let most = largest_of(&solved);
        if whole && largest_of(&step) <= 1e-11 * (1.0 + most) {
            consistent.solve(state, now, true)?;
            return check(state, now.at(), round);
        }
    }
    Err(failed(Vec::new()))
}

/// The linearised initial system: unknown are y, the states' y', and the delayed values. Its rows are the residual, the
/// initial equations, the states with a fixed start value, and what is delayed.
pub(crate) struct Shape {
    pub(crate) n: usize,
    /// Number of initial equations.
    pub(crate) count: usize,
    pub(crate) states: Vec<usize>,
    /// The column of each unknown's derivative.
    pub(crate) column_of_rate: Vec<Option<usize>>,
    /// States with a fixed start value.
    pub(crate) fixed: Vec<usize>,
    /// The places of the parameters that are found; their columns stand behind the rates.
    found: Vec<usize>,
    pub(crate) size: usize,
    pattern: Pattern,
    positions: Vec<Vec<Option<usize>>>,
}

impl Shape {
    /// # Errors
    /// The system is not square.
    pub(crate) fn new(state: &State<'_>, count: usize, t: f64) -> Result<Self, Box<Failure>> {
        let program = state.program;
        let n = program.n_unknowns;
        let delays = program.delays.len();
        let states: Vec<usize> = (0..n).filter(|&i| state.differential[i]).collect();
        let mut column_of_rate = vec![None; n];
        for (number, &i) in states.iter().enumerate() {
            column_of_rate[i] = Some(n + number);
        }
        let found = match count {
            0 => Vec::new(),
            _ => state.released.parameters(),
        };
        let size = n + states.len() + found.len() + delays;
        let mut fixed: Vec<usize> = state.pinned.iter().map(|(position, _)| *position).collect();
        let released = state.released.states();
        for condition in &program.initial {
            if let InitialCondition::Fixed {
                state: first, len, ..
            } = condition
            {
                let holds = |&i: &usize| state.differential[i] && !released.contains(&i);
                fixed.extend((*first..*first + *len).filter(holds));
            }
        }
        if count == 0 {
            fixed.clone_from(&states);
        }
        fixed.sort_unstable();
        fixed.dedup();
        if n + count + fixed.len() + delays != size {
            let kind = FailureKind::Inconsistent {
                singular: Vec::new(),
                at_start: true,
            };
            return Err(Failure::new(kind, t));
        }
        let first_found = n + states.len();
        let columns = (
            column_of_rate.as_slice(),
            first_found..first_found + found.len(),
        );
        let (pattern, positions) = pattern(state, size, n, count, &fixed, columns);
        Ok(Self {
            n,
            count,
            states,
            column_of_rate,
            fixed,
            found,
            size,
            pattern,
            positions,
        })
    }

    /// Solves the linearised system at a point for several right sides, in place. Whether it could be.
    pub(crate) fn solve(self, state: &mut State<'_>, at: At<'_>, rights: &mut [Vec<f64>]) -> bool {
        let values = values(state, at, &self.positions, &self.found, self.count);
        let Ok(mut solver) = SparseSolver::new(self.pattern, LinearMethod::Auto) else {
            return false;
        };
        if solver.factor(&values).is_err() {
            return false;
        }
        rights.iter_mut().for_each(|right| solver.solve(right));
        true
    }
}

/// Start values that the other conditions have to meet; events at the start may have changed them since.
fn check(state: &mut State<'_>, at: At<'_>, round: Round) -> Result<(), Box<Failure>> {
    let program = state.program;
    if program.rows(Function::Initial) == program.n_initial_equations()
        || round == Round::StatesKept
    {
        return Ok(());
    }
    let values = state.values(Function::Initial, at);
    let pairs = values[program.n_initial_equations()..].chunks_exact(2);
    let checks = program
        .initial
        .iter()
        .filter_map(|condition| match condition {
            InitialCondition::Check { name, origin } => Some((name, origin)),
            InitialCondition::Fixed { .. } | InitialCondition::Equation { .. } => None,
        });
    for ((name, origin), pair) in checks.zip(pairs) {
        let (found, wanted) = (pair[0], pair[1]);
        if (found - wanted).abs() > START_RTOL * found.abs().max(wanted.abs()) + START_ATOL {
            let kind = FailureKind::Start(name.clone(), wanted, found);
            let mut failure = Failure::new(kind, at.t).at_origin(origin);
            for condition in &program.initial {
                if let InitialCondition::Equation { origin, .. } = condition {
                    failure = failure.at_origin(origin);
                }
            }
            return Err(failure);
        }
    }
    Ok(())
}

/// What is known where relations are guessed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Known {
    /// States, and algebraic variables that have a guess.
    Guesses,
    /// Everything, from a first solution.
    All,
}

/// The relations of equations as they are at the first guess: of the solutions that an equation with a switch may have it
/// chooses one, and a limiter that is at no limit there must not begin at one, where its input determines nothing. Events
/// at the start then settle them.
fn guess_relations(state: &mut State<'_>, at: At<'_>, known: Known) {
    let program = state.program;
    let relations = &program.relations;
    let roots = state.values(Function::Roots, at);
    let mut open = vec![false; relations.len()];
    if known == Known::Guesses {
        for entry in program.partials(Function::Roots) {
            open[entry.row] |= match entry.wrt {
                Wrt::Unknown(column) => !state.differential[column] && at.y[column] == 0.0,
                Wrt::Derivative(_) => true,
                Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => false,
            };
        }
    }
    for (number, (relation, root)) in relations.iter().zip(roots).enumerate() {
        if relation.used == RelationUse::Equation && root.is_finite() && !open[number] {
            state.z[number] = f64::from(u8::from(relation.truth(root)));
        }
    }
}

/// Sparsity of the initial system, and where each value of the kernels goes: residual, initial equations, ones of fixed
/// states, ones of delayed values, and what these are the delay of.
fn pattern(
    state: &State<'_>,
    size: usize,
    n: usize,
    count: usize,
    fixed: &[usize],
    (column_of_rate, found): (&[Option<usize>], std::ops::Range<usize>),
) -> (Pattern, Vec<Vec<Option<usize>>>) {
    let program = state.program;
    let first_delayed = size - program.delays.len();
    let column = |wrt: Wrt| match wrt {
        Wrt::Unknown(column) => Some(column),
        Wrt::Derivative(column) => column_of_rate[column],
        Wrt::Delayed(number) => Some(first_delayed + number),
        Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => None,
    };
    let lists: Vec<Vec<Option<(usize, usize)>>> = vec![
        program
            .partials(Function::Residual)
            .iter()
            .map(|e| Some((column(e.wrt)?, e.row)))
            .collect(),
        program
            .partials(Function::Initial)
            .iter()
            .map(|e| (e.row < count).then_some((column(e.wrt)?, n + e.row)))
            .collect(),
        fixed
            .iter()
            .zip(n + count..)
            .map(|(&i, row)| Some((i, row)))
            .collect(),
        (first_delayed..size).map(|row| Some((row, row))).collect(),
        program
            .partials(Function::Delayed)
            .iter()
            .map(|e| Some((column(e.wrt)?, first_delayed + e.row)))
            .collect(),
        found
            .flat_map(|column| {
                let rows = (0..n + count).chain(first_delayed..size);
                rows.map(move |row| Some((column, row)))
            })
            .collect(),
    ];
    let mut cells: Vec<(usize, usize)> = lists.iter().flatten().flatten().copied().collect();
    cells.sort_unstable();
    cells.dedup();
    let mut starts = vec![0_i64; size + 1];
    cells
        .iter()
        .for_each(|&(column, _)| starts[column + 1] += 1);
    (0..size).for_each(|column| starts[column + 1] += starts[column]);
    let rows = cells
        .iter()
        .map(|&(_, row)| i64::try_from(row).unwrap_or(i64::MAX))
        .collect();
    let find = |cell: &Option<(usize, usize)>| {
        cell.as_ref()
            .and_then(|cell| cells.binary_search(cell).ok())
    };
    let positions = lists
        .iter()
        .map(|list| list.iter().map(find).collect())
        .collect();
    let pattern = Pattern::new(size, starts, rows).expect("the cells ascend and lie inside");
    (pattern, positions)
}

fn values(
    state: &mut State<'_>,
    at: At<'_>,
    positions: &[Vec<Option<usize>>],
    found: &[usize],
    count: usize,
) -> Vec<f64> {
    let size = positions
        .iter()
        .flatten()
        .flatten()
        .max()
        .map_or(0, |last| last + 1);
    let mut values = vec![0.0; size];
    let residual = state.partials(Function::Residual, at);
    let initial = state.partials(Function::Initial, at);
    let ones = |list: &[Option<usize>]| vec![1.0; list.len()];
    let (fixed, past) = (ones(&positions[2]), ones(&positions[3]));
    let delayed = state.partials(Function::Delayed, at);
    let delayed = delayed.into_iter().map(|value| -value).collect();
    let mut by_found = Vec::new();
    for &place in found {
        by_found.extend(by_parameter(state, place, Function::Residual, at));
        let initial = by_parameter(state, place, Function::Initial, at);
        by_found.extend(initial.into_iter().take(count));
        let delayed = by_parameter(state, place, Function::Delayed, at);
        by_found.extend(delayed.into_iter().map(|value| -value));
    }
    let lists = [residual, initial, fixed, past, delayed, by_found];
    for (list, numbers) in positions.iter().zip(lists) {
        for (position, number) in list.iter().zip(numbers) {
            if let Some(position) = position {
                values[*position] += number;
            }
        }
    }
    values
}
