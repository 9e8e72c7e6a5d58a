//! Which states, and which parameters, initial equations determine: as many as there are equations, the loosest first.
//!
//! ```text
//! load.s fixed = false, load.v fixed by its part, initial equation der(load.v) = 0       load.s is determined, load.v stays
//! ```
//! Which can be told by numbers alone: the derivatives of the initial equations by the states, consistent values following
//! them, with what is not fixed moved off its guess, where a derivative may be 0 by chance. Columns are taken in their order
//! (a greedy basis of a matroid is the best one). Where there are no such numbers, the compiler's choice by names stands.

mod table;

use crate::consistent::Consistent;
use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::released::{Column, Released};
use crate::results::Yielded;
use crate::state::{State, places_to_find};
use hyde_diag::Origin;
use hyde_program::{Firmness, Function, InitialCondition};
use std::collections::BTreeSet;
use table::Table;

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
    let table = away_from_guesses(state, consistent, at, &candidates, count);
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

/// The derivatives of the initial equations with what is not fixed moved off its guess. `None` where there are no numbers.
fn away_from_guesses(
    state: &mut State<'_>,
    consistent: &mut Consistent,
    at: At<'_>,
    candidates: &[Candidate],
    count: usize,
) -> Option<Table> {
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
    let columns: Vec<Column> = candidates.iter().map(|c| c.column).collect();
    let table = Table::new(state, consistent, moved.at(), &columns, count);
    state.p = before;
    table
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
    let mut origins = Vec::new();
    let mut read = BTreeSet::new();
    for row in table.open() {
        origins.extend(equation_of(state, row));
        read.extend(table.columns_of(row));
    }
    let mut against = Vec::new();
    for candidate in read.into_iter().map(|number| &candidates[number]) {
        if let Column::State(position) = candidate.column {
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
    let found = state.program.parameter_at(place);
    found.map_or_else(String::new, |(_, name)| name)
}
