//! Which states, and which parameters, initial equations determine: as many as there are equations, the loosest first.
//!
//! ```text
//! load.s fixed = false, load.v fixed by its part, initial equation der(load.v) = 0       load.s is determined, load.v stays
//! ```
//! Which can be told by numbers alone: the derivatives of the initial equations by the states, consistent values following
//! them, with what is not fixed moved off its guess, where a derivative may be 0 by chance. Columns are taken in their order
//! (a greedy basis of a matroid is the best one). Where there are no such numbers, the compiler's choice by names stands.

use crate::consistent::Consistent;
use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::released::{Column, Released};
use crate::results::Yielded;
use crate::state::{State, places_to_find};
use hyde_diag::Origin;
use hyde_program::{Firmness, Function, InitialCondition, Wrt};

/// A derivative is 0 below this part of what its terms amount to.
const ZERO: f64 = 1e-9;

/// How far what is not fixed is moved off its guess: relative, and absolute.
const MOVED: f64 = 1e-2;
const MOVED_AT_LEAST: f64 = 1e-3;

/// The step of a difference by a parameter, relative.
const DIFFERENCE: f64 = 1e-6;

/// What became of each that initial equations determine, and of parameters that no equation determines.
pub(crate) fn told(state: &State<'_>, y: &[f64]) -> Vec<Yielded> {
    let program = state.program;
    let told = state.released.0.iter().map(|&(column, firmness, start)| {
        let (name, value) = match column {
            Column::State(position) => (program.unknown_name(position), y[position]),
            Column::Parameter(place) => (parameter_name(state, place), state.p[place]),
        };
        Yielded {
            name,
            firmness,
            start,
            value,
            determined: true,
        }
    });
    let known = state.released.parameters();
    let open = places_to_find(state);
    let open = open.into_iter().filter(|place| !known.contains(place));
    let open = open.map(|place| Yielded {
        name: parameter_name(state, place),
        firmness: Firmness::Free,
        start: state.p[place],
        value: state.p[place],
        determined: false,
    });
    told.chain(open).collect()
}

/// A candidate with how firm it is, and where its start is declared.
struct Candidate {
    column: Column,
    firmness: Firmness,
    origin: Option<Origin>,
}

/// Chooses what `count` initial equations determine, at a first guess of consistent values.
pub(crate) fn choose(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    at: At<'_>,
    count: usize,
) -> Result<(), Box<Failure>> {
    let At { t, y, .. } = at;
    let candidates = candidates(state);
    let may_yield = candidates.partition_point(|c| c.firmness < Firmness::Given);
    let table = Table::new(state, consistent, at, &candidates, count);
    let chosen = match table {
        Some(mut table) => {
            let chosen = table.basis(may_yield);
            if chosen.len() < count {
                return Err(conflict(state, &table, &candidates, t));
            }
            chosen
        }
        None => by_names(state, &candidates[..may_yield], count),
    };
    let released = chosen.into_iter().map(|number| {
        let Candidate {
            column, firmness, ..
        } = candidates[number];
        let start = match column {
            Column::State(position) => y[position],
            Column::Parameter(place) => state.p[place],
        };
        (column, firmness, start)
    });
    state.released = Released(released.collect());
    Ok(())
}

/// Parameters to be found and states that are not fixed by modes, the loosest first.
fn candidates(state: &State<'_>) -> Vec<Candidate> {
    let parameters = places_to_find(state).into_iter().map(|place| Candidate {
        column: Column::Parameter(place),
        firmness: Firmness::Free,
        origin: None,
    });
    let mut found: Vec<Candidate> = parameters.collect();
    for condition in &state.program.initial {
        if let InitialCondition::Fixed {
            state: first,
            len,
            firmness,
            origin,
            ..
        } = condition
        {
            let positions = (*first..*first + *len).filter(|&position| {
                let pinned = state.pinned.iter().any(|(pinned, _)| *pinned == position);
                state.differential[position] && !pinned
            });
            found.extend(positions.map(|position| Candidate {
                column: Column::State(position),
                firmness: *firmness,
                origin: Some(origin.clone()),
            }));
        }
    }
    found.sort_by_key(|candidate| candidate.firmness);
    found
}

/// The choice by the names that equations read.
fn by_names(state: &State<'_>, candidates: &[Candidate], count: usize) -> Vec<usize> {
    let yields = |candidate: &Candidate| match candidate.column {
        Column::Parameter(_) => true,
        Column::State(position) => state.program.initial.iter().any(|condition| {
            matches!(condition, InitialCondition::Fixed { state, len, yields: true, .. }
                if (*state..*state + *len).contains(&position))
        }),
    };
    let (first, then): (Vec<usize>, Vec<usize>) =
        (0..candidates.len()).partition(|&number| yields(&candidates[number]));
    first.into_iter().chain(then).take(count).collect()
}

/// Initial equations that nothing which may yield can meet, and the fixed starts that stand against them.
fn conflict(state: &State<'_>, table: &Table, candidates: &[Candidate], t: f64) -> Box<Failure> {
    let mut against = Vec::new();
    let mut origins = Vec::new();
    for &row in &table.open_rows() {
        origins.extend(equation_of(state, row));
    }
    for (number, candidate) in candidates.iter().enumerate() {
        let reads = table
            .open_rows()
            .iter()
            .any(|&row| table.counts(row, number));
        if let (true, Column::State(position)) = (reads, candidate.column) {
            against.push(state.program.unknown_name(position));
            origins.extend(candidate.origin.clone());
        }
    }
    let failure = Failure::new(FailureKind::Overdetermined(against), t);
    let origins = origins.iter();
    origins.fold(failure, |failure, origin| failure.at_origin(origin))
}

/// Where the initial equation of a row is written.
fn equation_of(state: &State<'_>, row: usize) -> Option<Origin> {
    let mut first = 0;
    for condition in &state.program.initial {
        if let InitialCondition::Equation { len, origin } = condition {
            if (first..first + len).contains(&row) {
                return Some(origin.clone());
            }
            first += len;
        }
    }
    None
}

/// The derivatives of the initial equations by candidates, with what their terms amount to.
struct Table {
    rows: Vec<Vec<f64>>,
    terms: Vec<Vec<f64>>,
    /// Rows that a chosen column was taken for.
    used: Vec<bool>,
}

impl Table {
    /// `None` where consistent values do not follow the states.
    fn new(
        state: &mut State<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
        candidates: &[Candidate],
        count: usize,
    ) -> Option<Self> {
        // Delayed values are unknowns of the start as well, and follow the states.
        if !state.program.delays.is_empty() {
            return None;
        }
        let before = state.p.clone();
        let mut moved = at.to_moment();
        move_off(state, candidates, &mut moved.y);
        if consistent.solve(state, &mut moved, true).is_err() {
            state.p.clone_from(&before);
            moved = at.to_moment();
        }
        let table = Self::at(state, consistent, moved.at(), candidates, count);
        state.p = before;
        table
    }

    fn at(
        state: &mut State<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
        candidates: &[Candidate],
        count: usize,
    ) -> Option<Self> {
        let program = state.program;
        let residual = state.partials(Function::Residual, at);
        let initial = state.partials(Function::Initial, at);
        let mut follow: Vec<Vec<f64>> = Vec::new();
        let mut direct: Vec<Vec<f64>> = Vec::new();
        for candidate in candidates {
            let (mut of_residual, mut of_initial) = (vec![0.0; at.y.len()], vec![0.0; count]);
            match candidate.column {
                Column::State(position) => {
                    let wrt = Wrt::Unknown(position);
                    let entries = program.partials(Function::Residual).iter().zip(&residual);
                    for (entry, value) in entries.filter(|(entry, _)| entry.wrt == wrt) {
                        of_residual[entry.row] += value;
                    }
                    let entries = program.partials(Function::Initial).iter().zip(&initial);
                    let entries = entries.filter(|(e, _)| e.wrt == wrt && e.row < count);
                    entries.for_each(|(entry, value)| of_initial[entry.row] += value);
                }
                Column::Parameter(place) => {
                    of_residual = by_parameter(state, place, Function::Residual, at);
                    of_initial = by_parameter(state, place, Function::Initial, at);
                }
            }
            follow.push(of_residual);
            direct.push(of_initial);
        }
        if !consistent.correct(state, at, &mut follow) {
            return None;
        }
        let width = candidates.len();
        let mut rows = vec![vec![0.0; width]; count];
        for (column, values) in direct.iter().enumerate() {
            for (row, value) in rows.iter_mut().zip(values) {
                row[column] = *value;
            }
        }
        let mut terms: Vec<Vec<f64>> = rows
            .iter()
            .map(|row| row.iter().map(|value: &f64| value.abs()).collect())
            .collect();
        for (entry, value) in program.partials(Function::Initial).iter().zip(&initial) {
            let followed = match entry.wrt {
                Wrt::Unknown(unknown) if !state.differential[unknown] => unknown,
                Wrt::Derivative(unknown) => unknown,
                Wrt::Unknown(_)
                | Wrt::Parameter(_)
                | Wrt::Memory(_)
                | Wrt::Delayed(_)
                | Wrt::Time => continue,
            };
            if entry.row < count {
                for (column, follow) in follow.iter().enumerate() {
                    let term = value * follow[followed];
                    rows[entry.row][column] -= term;
                    terms[entry.row][column] += term.abs();
                }
            }
        }
        let finite = rows.iter().flatten().all(|value| value.is_finite());
        finite.then(|| Self {
            used: vec![false; rows.len()],
            rows,
            terms,
        })
    }

    fn counts(&self, row: usize, column: usize) -> bool {
        self.rows[row][column].abs() > ZERO * self.terms[row][column]
    }

    fn open_rows(&self) -> Vec<usize> {
        (0..self.rows.len())
            .filter(|&row| !self.used[row])
            .collect()
    }

    /// The first independent columns of those below `end`, by elimination.
    fn basis(&mut self, end: usize) -> Vec<usize> {
        let mut found = Vec::new();
        for column in 0..end {
            let clear = |row: usize| self.rows[row][column].abs() / self.terms[row][column];
            let open = self.open_rows();
            let open = open.into_iter().filter(|&row| self.counts(row, column));
            let Some(pivot) = open.max_by(|&a, &b| clear(a).total_cmp(&clear(b))) else {
                continue;
            };
            found.push(column);
            self.used[pivot] = true;
            let (of_pivot, size) = (self.rows[pivot].clone(), self.terms[pivot].clone());
            for row in self.open_rows() {
                let factor = self.rows[row][column] / of_pivot[column];
                for place in 0..of_pivot.len() {
                    self.rows[row][place] -= factor * of_pivot[place];
                    self.terms[row][place] += factor.abs() * size[place];
                }
            }
        }
        found
    }
}

/// Moves what is not declared fixed off its guess, each by another part.
fn move_off(state: &mut State<'_>, candidates: &[Candidate], y: &mut [f64]) {
    let mut parameters = Vec::new();
    let loose = candidates.iter().filter(|c| c.firmness < Firmness::Default);
    for (number, candidate) in loose.enumerate() {
        // Multiples of the golden section fill an interval evenly.
        let part = 0.5 + 0.5 * ((number + 1) as f64 * 0.618_033_988_749_894_9).fract();
        let moved = |value: f64| value + part * (MOVED * value.abs() + MOVED_AT_LEAST);
        match candidate.column {
            Column::State(position) => y[position] = moved(y[position]),
            Column::Parameter(place) => parameters.push((place, moved(state.p[place]))),
        }
    }
    state.set_parameters(&parameters);
}

/// Moves what initial equations determine off its guess.
pub(crate) fn move_released(state: &mut State<'_>, y: &mut [f64]) {
    let released = state.released.0.iter();
    let released = released.map(|&(column, ..)| Candidate {
        column,
        firmness: Firmness::Free,
        origin: None,
    });
    let released: Vec<Candidate> = released.collect();
    move_off(state, &released, y);
}

/// The derivatives of a function by a parameter and all that follows from it, by a difference.
pub(crate) fn by_parameter(
    state: &mut State<'_>,
    place: usize,
    function: Function,
    at: At<'_>,
) -> Vec<f64> {
    let here = state.values(function, at);
    let (p, value) = (state.p.clone(), state.p[place]);
    let step = DIFFERENCE * if value == 0.0 { 1.0 } else { value.abs() };
    state.set_parameters(&[(place, value + step)]);
    let step = state.p[place] - value;
    let there = state.values(function, at);
    state.p = p;
    let pairs = there.into_iter().zip(here);
    pairs.map(|(there, here)| (there - here) / step).collect()
}

fn parameter_name(state: &State<'_>, place: usize) -> String {
    let parameters = &state.program.parameters;
    let inside = parameters
        .iter()
        .find(|p| (p.place..p.place + p.len).contains(&place));
    inside.map_or_else(String::new, |p| match p.len {
        1 => p.name.clone(),
        _ => format!("{}[{}]", p.name, place - p.place + 1),
    })
}
