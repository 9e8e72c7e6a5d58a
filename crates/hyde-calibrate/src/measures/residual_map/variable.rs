//! What innovations may depend on: time, what was measured, speeds, reversals, places in a turn.

use crate::records::{Recording, filled};
use hyde_program::Program;
use hyde_units::{Dimension, NamedUnit};
use std::f64::consts::TAU;

/// Half the time over which a speed is taken, in s: an encoder's steps are finer than the speeds of a drive by then.
const SPEED_S: f64 = 0.005;
/// A reversal is remembered so long, in s.
const REVERSAL_S: f64 = 0.2;

/// Something that innovations may depend on, at the rows that count, record by record; NaN where it is not known.
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) unit: NamedUnit,
    pub(super) values: Vec<Vec<f64>>,
}

/// Time, what was measured, speeds, reversals, places in a turn.
pub(super) fn variables(program: &Program, recordings: &[Recording]) -> Vec<Variable> {
    let each = |of: &dyn Fn(&Recording) -> Vec<f64>| -> Vec<Vec<f64>> {
        let counted = |recording: &Recording| of(recording).split_off(recording.first_row);
        recordings.iter().map(counted).collect()
    };
    let time = |recording: &Recording| -> Vec<f64> {
        let rows = 0..recording.rows();
        rows.map(|row| recording.start_s + recording.step_s * row as f64)
            .collect()
    };
    let mut found = vec![Variable {
        name: "time".to_owned(),
        unit: NamedUnit::usual(Dimension::TIME),
        values: each(&time),
    }];
    let mut reversals = false;
    for (number, measured) in program.experiment.measured.iter().enumerate() {
        let dimension = measured.unit.unit().dimension;
        let name = &measured.name;
        found.push(Variable {
            name: name.clone(),
            unit: measured.unit.clone(),
            values: each(&|recording| filled(&recording.channels[number])),
        });
        let place = dimension == Dimension::LENGTH || dimension == Dimension::ANGLE;
        if !place {
            continue;
        }
        let speed = |recording: &Recording| {
            let places = filled(&recording.channels[number]);
            speed(&places, recording.step_s)
        };
        found.push(Variable {
            name: format!("speed of {name}"),
            unit: NamedUnit::usual(dimension.divide(Dimension::TIME)),
            values: each(&speed),
        });
        if dimension == Dimension::ANGLE {
            found.push(Variable {
                name: format!("{name} in its revolution"),
                unit: measured.unit.clone(),
                values: each(&|recording| {
                    let angles = filled(&recording.channels[number]).into_iter();
                    angles.map(|angle| angle.rem_euclid(TAU)).collect()
                }),
            });
        }
        if !reversals {
            reversals = true;
            found.push(Variable {
                name: format!("time since a reversal of {name}"),
                unit: NamedUnit::usual(Dimension::TIME),
                values: each(&|recording| since_reversal(&speed(recording), recording.step_s)),
            });
        }
    }
    found
}

fn speed(place: &[f64], step_s: f64) -> Vec<f64> {
    let reach = ((SPEED_S / step_s).round() as usize).max(1);
    let last = place.len().saturating_sub(1);
    (0..place.len())
        .map(|row| {
            let (from, to) = (row.saturating_sub(reach), (row + reach).min(last));
            (place[to] - place[from]) / (step_s * (to - from).max(1) as f64)
        })
        .collect()
}

/// Time since the speed last changed its sign; NaN later than [`REVERSAL_S`].
fn since_reversal(speed: &[f64], step_s: f64) -> Vec<f64> {
    let still = 1e-3 * speed.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let (mut sign, mut since) = (0.0, f64::NAN);
    let mut found = Vec::with_capacity(speed.len());
    for &v in speed {
        since += step_s;
        if v.abs() > still {
            if sign != 0.0 && v.signum() * sign < 0.0 {
                since = 0.0;
            }
            sign = v.signum();
        }
        found.push(if since <= REVERSAL_S { since } else { f64::NAN });
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reversal_is_forgotten() {
        let speed: Vec<f64> = (0..1000)
            .map(|k| if k < 300 { 1.0 } else { -1.0 })
            .collect();
        let since = since_reversal(&speed, 1e-3);
        assert!(since[299].is_nan());
        assert!(since[300].abs() < 1e-12);
        assert!((since[400] - 0.1).abs() < 1e-9);
        assert!(since[600].is_nan());
    }
}
