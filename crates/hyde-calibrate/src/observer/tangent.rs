//! How innovations change with small changes of parameters, many at once: along one run of the observer.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + forcing        change of innovations    -(C eps + dh)
//! ```
//! A change forces the equations by what it adds to their residual where the plant is, taken linearly over a row, and the
//! channels by dh. Both are differences by the parameter ([`Own`]) or derivatives ([`Slopes`]), of kernels alone. So a
//! direction costs a few evaluations and a column of a product a row, and no run of its own. Guards are taken to act when they do without it: for friction that is
//! right to first order, for its force does not jump where it begins and ends to stick, and what has stuck in between forgets
//! its speed; of contacts it is a part. Modes that begin within a row act from there on, and what bends has the derivatives
//! of where the plant is (`track/splitting.rs`).

mod known;
mod own;
mod passage;
mod slopes;

use super::over_record::When;
use super::track::{Passing, Place, Track};
use crate::linear::{add_low_rank_across, set_product};
use crate::plant::{length, shortest_steps, size_of};
use crate::records::Recording;
pub(crate) use known::{Known, Modes};
use nalgebra::{DMatrix, DMatrixView};
pub(crate) use own::Own;
use passage::Corrected;
pub(crate) use slopes::{Shape, Slopes};

/// A parameter by whose small change innovations are differentiated.
pub(crate) struct Direction {
    /// The whole parameter vector with the parameter changed.
    pub(crate) p: Vec<f64>,
    /// By how much.
    pub(crate) step: f64,
}

/// What directions add to the model along a track, a column each.
pub(crate) trait Forces {
    /// The number of directions.
    fn count(&self) -> usize;
    /// The equations that some direction changes.
    fn touched(&self) -> &[usize];
    /// Whether some direction changes what is measured.
    fn shown(&self) -> bool;
    /// What a unit of each adds to the residual of the equations that are touched.
    fn forces(&mut self, place: Place<'_>, out: &mut DMatrix<f64>);
    /// What it adds to what the channels show.
    fn seen(&mut self, place: Place<'_>, out: &mut DMatrix<f64>);
}

/// A product of matrices is faster than one a column from this many columns on.
const MANY: usize = 8;

/// How whitened innovations change along a track, a column a direction, channels below each other.
pub(crate) fn changes(
    track: &Track<'_>,
    recording: &Recording,
    forces: &mut impl Forces,
) -> DMatrix<f64> {
    let channels = recording.channels.len();
    let rows = recording.rows() - recording.first_row;
    let count = forces.count();
    let mut change = DMatrix::zeros(rows * channels, count);
    let keep = |row: usize, changes: DMatrixView<'_, f64>| {
        for number in 0..count {
            for channel in 0..channels {
                change[(channel * rows + row, number)] = changes[(channel, number)];
            }
        }
    };
    along(track, recording, forces, keep);
    change
}

/// The same, row by row: `each` gets the number of a row that counts, and how its whitened innovations change, a row a
/// channel, a column a direction.
pub(crate) fn along(
    track: &Track<'_>,
    recording: &Recording,
    own: &mut impl Forces,
    mut each: impl FnMut(usize, DMatrixView<'_, f64>),
) {
    let route = &track.route;
    let (states, channels) = (route.places.states.len(), recording.channels.len());
    let (count, touched) = (own.count(), own.touched().len());
    let mut known = Known::new(track, recording, own.touched());
    // A column a direction: errors of the states, forces at the start of a row and at its end, what channels show of it.
    let mut before = DMatrix::<f64>::zeros(states + 2 * touched + channels, count);
    // Errors after it and the answers below them; forces are put over these in the next row.
    let mut after = before.clone();
    let mut now = DMatrix::<f64>::zeros(touched, count);
    let (mut then, mut reached) = (now.clone(), now.clone());
    let mut by_output = DMatrix::<f64>::zeros(channels, count);
    let mut corrected = Corrected::default();
    // The combination of modes in which the last row was left, and what bends there.
    let (mut left, mut bend) = (0, None);
    for (row, passed) in route.rows.iter().enumerate() {
        let [before_it, next] = passed.modes;
        let seen = known.modes(row, When::Before, before_it);
        if own.shown() {
            own.seen(Place::Row(row, When::Before), &mut by_output);
        }
        own.forces(Place::Row(row, When::After), &mut then);
        let bend_next = route.bend(next, Passing::Row(row, When::After));
        // Forces at the end of a row are those at the start of the next, unless the correction has changed modes.
        let same = next == before_it;
        let legs = track.legs(row);
        let within = legs.iter().any(|leg| leg.event.is_some());
        let stepped = (row > 0 && !within).then_some(left);
        let end = if same { &then } else { &now };
        if within {
            // Modes that begin within the row act from there on: the axis may ring several times in a row's time.
            // So do forces, which jump from one mode to the next, and grow evenly in each.
            let (mut configuration, mut number) = (left, passed.legs.start);
            for mode in legs.split_inclusive(|leg| leg.event.is_some()) {
                let event = mode.last().and_then(|leg| leg.event.as_ref());
                known.kick(configuration, bend, length(mode), &now, &mut before);
                number += mode.len();
                if let Some(event) = event {
                    own.forces(Place::Within(row, &event.before), &mut reached);
                    bend = route.bend(configuration, Passing::Leg(number - 1, When::Before));
                } else {
                    reached.copy_from(if same { &then } else { &now });
                    bend = match next == configuration {
                        true => bend_next,
                        false => route.bend(configuration, Passing::Row(row, When::Before)),
                    };
                }
                for (number, leg) in mode.iter().enumerate() {
                    put(&mut before, states, &now);
                    let part = size_of(leg.level) as f64 / length(&mode[number..]) as f64;
                    now.zip_apply(&reached, |now, end| *now += part * (end - *now));
                    put(&mut before, states + touched, &now);
                    let matrix = known.leg(configuration, leg.level);
                    let errors = matrix * before.rows(0, states + 2 * touched);
                    put(&mut before, 0, &errors);
                }
                known.kick(configuration, bend, length(mode), &reached, &mut before);
                if let Some(event) = event {
                    fix(&event.fixed, &mut before);
                    own.forces(Place::Within(row, &event.after), &mut now);
                    configuration = event.configuration;
                    bend = route.bend(configuration, Passing::Leg(number - 1, When::After));
                }
            }
        } else {
            if stepped.is_some() {
                known.kick(left, bend, shortest_steps(), &now, &mut before);
            }
            put(&mut before, states, &now);
            put(&mut before, states + touched, end);
        }
        put(&mut before, states + 2 * touched, &by_output);
        let bent = stepped.and_then(|left| {
            let reached = match next == left {
                true => bend_next,
                false => route.bend(left, Passing::Row(row, When::Before)),
            };
            known.bent_at_end(row, (left, reached), seen)
        });
        let matrix = corrected.of(&mut known, stepped, seen, touched);
        if count < MANY {
            for (mut after, before) in after.column_iter_mut().zip(before.column_iter()) {
                let after = &mut after.as_mut_slice()[..states + channels];
                set_product(matrix, before.as_slice(), after);
            }
        } else {
            let mut after = after.rows_mut(0, states + channels);
            after.gemm(1.0, matrix, &before, 0.0);
        }
        if let Some((answered, by_all)) = bent {
            add_low_rank_across([answered, &by_all], &before, &mut after);
        }
        if let Some(row) = row.checked_sub(recording.first_row) {
            each(row, after.rows(states, channels));
        }
        fix(&passed.fixed, &mut after);
        std::mem::swap(&mut before, &mut after);
        std::mem::swap(&mut now, &mut then);
        (left, bend) = (next, bend_next);
    }
}

/// Copies rows to where one begins.
fn put(into: &mut DMatrix<f64>, row: usize, rows: &DMatrix<f64>) {
    let height = into.nrows();
    let (into, own) = (into.as_mut_slice(), rows.as_slice());
    // By slices: views of matrices are copied number by number. A few rows are copied in place, by no call a column.
    match rows.nrows() {
        0 => {}
        1 => put_few::<1>(into, height, row, own),
        2 => put_few::<2>(into, height, row, own),
        3 => put_few::<3>(into, height, row, own),
        4 => put_few::<4>(into, height, row, own),
        many => {
            let columns = into.chunks_exact_mut(height);
            for (into, column) in columns.zip(own.chunks_exact(many)) {
                into[row..row + many].copy_from_slice(column);
            }
        }
    }
}

fn put_few<const N: usize>(into: &mut [f64], height: usize, row: usize, rows: &[f64]) {
    let (columns, _) = rows.as_chunks::<N>();
    for (into, column) in into.chunks_exact_mut(height).zip(columns) {
        into[row..row + N].copy_from_slice(column);
    }
}

/// States that modes fix have no error, a row a state: what the observer corrects them by is lost.
fn fix(states: &[usize], errors: &mut DMatrix<f64>) {
    for &state in states {
        errors.row_mut(state).fill(0.0);
    }
}
