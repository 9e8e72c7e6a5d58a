//! [`act_alike`]: whether two effects do the same to the axis wherever it is, as a drag of the table and one of the shaft that
//! an ideal pinion turns: then no record tells them apart.
//!
//! What an effect adds to the rates of the states is looked at in many states, each of its own from another row of the
//! records: positions, speeds and currents that never come together in them. Of two effects that are one these are multiples
//! of each other.

use super::stage::Ground;
use super::trial::Trial;
use crate::observer::{Track, Vectors, When, state_names};
use crate::plant::{Plant, Unsupported};
use hyde_program::Program;

/// States that are looked at.
const LOOKS: usize = 64;
/// The part by which what two effects add may differ: fitted shapes are not known better.
const DIFFERENT: f64 = 1e-2;

/// Whether two trials act on the same states, and in any states alike.
pub(super) fn act_alike(ground: &Ground<'_>, one: &Trial, other: &Trial) -> bool {
    let acts = || {
        let tracks = one.stage.tracks(ground).ok()?;
        let looks = looks(tracks.first()?, &one.stage.program);
        let one = added(ground, one, &looks).ok()?;
        let other = added(ground, other, &looks).ok()?;
        (one.states == other.states).then(|| parallel(&one.rates, &other.rates))
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
    let places = &track.places.states;
    let p = vec![0.0; program.n_parameters];
    let mut room = Vectors::default();
    let mut states = vec![Vec::new(); LOOKS];
    let mut squares = vec![0.0; places.len()];
    for (look, into) in states.iter_mut().enumerate() {
        for (number, &place) in places.iter().enumerate() {
            // Any rows without relation to each other.
            let row = (look * 7919 + number * 104_729) % rows;
            let at = track.point(row, When::After, &p, &mut room);
            into.push(at.y[place]);
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

/// Whether two vectors are multiples of each other, neither nothing.
fn parallel(a: &[f64], b: &[f64]) -> bool {
    let dot = |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| a * b).sum() };
    let (aa, bb, ab) = (dot(a, a), dot(b, b), dot(a, b));
    // The part of one that is across the other.
    let across = 1.0 - ab * ab / (aa * bb);
    aa > 0.0 && bb > 0.0 && across <= DIFFERENT * DIFFERENT
}

#[cfg(test)]
mod tests {
    use super::parallel;

    #[test]
    fn multiples_are_alike_and_nothing_is_like_nothing() {
        assert!(parallel(&[1.0, -2.0, 3.0], &[-2.0, 4.0, -6.01]));
        assert!(!parallel(&[1.0, -2.0, 3.0], &[1.0, -2.0, 2.0]));
        assert!(!parallel(&[0.0, 0.0], &[0.0, 0.0]));
        assert!(!parallel(&[1.0, f64::NAN], &[1.0, 2.0]));
    }
}
