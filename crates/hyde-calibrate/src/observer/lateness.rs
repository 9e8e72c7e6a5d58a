//! How innovations change where what drives the axis comes a little later than its record says.
//!
//! A record gives the times of its rows, not the instants at which a drive has put a command through or read its sensors:
//! these are known to a part of a row ([`KNOWN_TO`]), and a diagnosis takes no effect for what such a shift explains.
//!
//! ```text
//! held at a row        error of the states there  -B du tau         du: from one row to the next
//! linear between rows  their rates are off by     -B du/T tau       throughout the row
//! ```

use super::input_noise::rates;
use super::over_record::When;
use super::tangent::Known;
use super::track::{Place, Track, Vectors};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::{Program, Workspace};
use nalgebra::DMatrix;

/// Instants are known to this part of a row.
pub(crate) const KNOWN_TO: f64 = 0.005;

/// How whitened innovations change along a track for each driving column that comes a whole row later, channels below each
/// other.
pub(crate) fn changes_if_late(
    track: &Track<'_>,
    program: &Program,
    recording: &Recording,
    p: &[f64],
) -> Result<DMatrix<f64>, Unsupported> {
    let route = &track.route;
    let (observer, states) = (&route.observer, route.places.states.len());
    let (channels, columns) = (recording.channels.len(), program.columns.len());
    let counted = recording.rows() - recording.first_row;
    let mut found = DMatrix::zeros(counted * channels, columns);
    let mut known = Known::new(track, recording, &[]);
    let mut by_column: Vec<Option<[DMatrix<f64>; 2]>> = vec![None; route.configurations.len()];
    let (mut workspace, mut room) = (Workspace::new(program.n_work), Vectors::default());
    let mut errors = DMatrix::<f64>::zeros(states, columns);
    for (row, passed) in route.rows.iter().enumerate() {
        let [before, after] = passed.modes;
        let seen = known.modes(row, When::Before, before);
        let change = -(&known.modes[seen].outputs * &errors);
        errors += &known.modes[seen].gain * &change;
        passed
            .fixed
            .iter()
            .for_each(|&state| errors.row_mut(state).fill(0.0));
        if let Some(counted_row) = row.checked_sub(recording.first_row) {
            for (channel, deviation) in observer.deviations.iter().enumerate() {
                let into = channel * counted + counted_row;
                found
                    .row_mut(into)
                    .copy_from(&(change.row(channel) / *deviation));
            }
        }
        let own = &route.configurations[after];
        let at = track.point(Place::Row(row, When::After), p, &mut room);
        let [linear, held] = by_column[after]
            .get_or_insert_with(|| rates(program, &route.places, own, at, &mut workspace));
        let step = &own.steps[0];
        let mut growing = DMatrix::zeros(states, columns);
        for (number, column) in recording.columns.iter().enumerate() {
            let value = |row: usize| column[row.min(column.len() - 1)];
            let jump = value(row) - value(row.saturating_sub(1));
            let rise = value(row + 1) - value(row);
            let mut error = errors.column_mut(number);
            error -= held.column(number) * (jump * route.step_s);
            growing
                .column_mut(number)
                .copy_from(&(linear.column(number) * -rise));
        }
        errors = &step.exp * &errors + &step.first * growing;
    }
    Ok(found)
}
