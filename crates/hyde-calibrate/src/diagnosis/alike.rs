//! [`act_alike`]: whether two effects do the same to the axis wherever it is, as a drag of the table and one of the shaft that
//! an ideal pinion turns: then no record tells them apart.
//!
//! What an effect adds to the rates of the states is looked at in many states, each of its own from another row of the
//! records and a few times as large or small: positions, speeds and currents that never come together in them. Of two effects
//! that are one these are multiples of each other.

use super::stage::Ground;
use super::trial::Trial;
use crate::observer::{Place, Track, Vectors, When, state_names};
use crate::plant::{Plant, Unsupported};
use hyde_program::Program;

/// Numerics: states that are looked at.
const LOOKS: usize = 64;
/// Numerics: so many times as large or small as in the records.
const LARGER: f64 = 4.0;

/// Whether two trials act on the same states, and in any states alike.
pub(super) fn act_alike(ground: &Ground<'_>, one: &Trial, other: &Trial) -> bool {
    let acts = || {
        let tracks = one.stage.tracks(ground).ok()?;
        let looks = looks(tracks.first()?, &one.stage.program);
        let one = added(ground, one, &looks).ok()?;
        let other = added(ground, other, &looks).ok()?;
        (one.states == other.states)
            .then(|| across(&one.rates, &other.rates) <= ground.thresholds.negligible.powi(2))
    };
    acts().unwrap_or(false)
}

/// States by name, and the usual sizes of their rates.
struct Looks {
    names: Vec<String>,
    states: Vec<Vec<f64>>,
    rates: Vec<f64>,
}

/// What an effect adds to rates.
struct Added {
    /// The names of the states.
    states: Vec<String>,
    /// Of each look the rates, in their usual sizes.
    rates: Vec<f64>,
}

/// States of a record, mixed.
fn looks(track: &Track<'_>, program: &Program) -> Looks {
    let rows = track.route.rows.len().max(1);
    let places = &track.route.places.states;
    let p = vec![0.0; program.n_parameters];
    let mut room = Vectors::default();
    let mut states = vec![Vec::new(); LOOKS];
    let mut squares = vec![0.0; places.len()];
    for (look, into) in states.iter_mut().enumerate() {
        for (number, &place) in places.iter().enumerate() {
            // Any rows without relation to each other.
            let row = (look * 7919 + number * 104_729) % rows;
            let at = track.point(Place::Row(row, When::After), &p, &mut room);
            let times = LARGER.powf((12.9898 * look as f64 + 78.233 * number as f64).sin());
            into.push(times * at.y[place]);
            squares[number] += at.yp[place].powi(2);
        }
    }
    let rms = squares.iter().map(|sum: &f64| (sum / LOOKS as f64).sqrt());
    Looks {
        names: places
            .iter()
            .map(|&place| program.unknown_name(place))
            .collect(),
        rates: rms.map(|rms| rms.max(f64::MIN_POSITIVE)).collect(),
        states,
    }
}

/// What the effect of a trial adds to the rates of the states, friction slipping.
fn added(ground: &Ground<'_>, trial: &Trial, looks: &Looks) -> Result<Added, Unsupported> {
    let [with, without] = [trial.stage.values(), without(trial)];
    let [with, without] = [with, without].map(|values| rates(ground, trial, &values, looks));
    let ((states, with), (_, without)) = (with?, without?);
    let rates = with
        .iter()
        .zip(without)
        .map(|(with, without)| with - without);
    Ok(Added {
        states,
        rates: rates.collect(),
    })
}

/// Everything that a trial sets, its sizes 0.
fn without(trial: &Trial) -> Vec<(String, f64)> {
    let mut values = trial.stage.values();
    values.extend(trial.sizes().map(|name| (name.to_owned(), 0.0)));
    values
}

/// The names of the states, and their rates in each look.
fn rates(
    ground: &Ground<'_>,
    trial: &Trial,
    values: &[(String, f64)],
    looks: &Looks,
) -> Result<(Vec<String>, Vec<f64>), Unsupported> {
    let program = &trial.stage.program;
    let Some(recording) = ground.recordings.first() else {
        return Ok((Vec::new(), Vec::new()));
    };
    let p = recording.parameters(program, &ground.set_in(program, values));
    let mut plant = Plant::at(program, recording, p, &[])?;
    let names = state_names(&plant);
    let mut found = Vec::new();
    let mut here = vec![0.0; names.len()];
    for states in &looks.states {
        for (place, name) in plant.places.states.iter().zip(&names) {
            if let Some(known) = looks.names.iter().position(|own| own == name) {
                plant.y[*place] = states[known];
            }
        }
        plant.make_consistent();
        plant.rates(&mut here);
        found.extend(
            here.iter()
                .zip(&looks.rates)
                .map(|(rate, usual)| rate / usual),
        );
    }
    Ok((names, found))
}

/// The part of the squares of one vector that is no multiple of another; all of it where one is nothing.
fn across(a: &[f64], b: &[f64]) -> f64 {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let along = dot(a, b).powi(2) / (dot(a, a) * dot(b, b));
    if along.is_finite() { 1.0 - along } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::across;

    #[test]
    fn nothing_of_a_multiple_is_across_and_all_of_what_is_not_there() {
        assert!(across(&[1.0, -2.0, 3.0], &[-2.0, 4.0, -6.0]) < 1e-12);
        assert!((across(&[1.0, 0.0], &[1.0, 1.0]) - 0.5).abs() < 1e-12);
        assert!((across(&[0.0, 0.0], &[0.0, 0.0]) - 1.0).abs() < 1e-12);
        assert!((across(&[1.0, f64::NAN], &[1.0, 2.0]) - 1.0).abs() < 1e-12);
    }
}
