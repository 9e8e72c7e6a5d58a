//! [`Bench::held`]: an effort made smaller until the model moves within the travel and the speed of the axis.

use super::bench::{Bench, Failed};
use hyde_signal::excite::Design;
use hyde_units::{Agreement, NamedUnit};

/// Runs at most.
const RUNS: usize = 10;
/// A size is large enough that uses this part of a limit.
const ENOUGH: f64 = 0.7;
/// Each run aims so far below the limit, and changes the size by no more than this.
const AIM: f64 = 0.9;
const MOST: f64 = 0.1;

/// A travel or speed of the axis that a model must keep, and the unit of the places that it is for.
#[derive(Clone, Debug)]
pub struct Room {
    /// A unit of the places: a length or an angle.
    pub unit: NamedUnit,
    /// The way from end to end, SI, if it is limited; the axis starts in its middle.
    pub travel: Option<f64>,
    /// The speed, SI, if it is limited.
    pub speed: Option<f64>,
}

impl Bench {
    /// The design with as much of its size as leaves the measured places of the model within their limits, and which part
    /// that is; `None` if no part does.
    ///
    /// # Errors
    /// The model cannot be run.
    pub fn held(&self, design: &Design, room: &Room) -> Result<Option<(Design, f64)>, Failed> {
        // The largest part that is known to fit, and the smallest that is known not to.
        let (mut fits, mut fails): (Option<(Design, f64)>, Option<f64>) = (None, None);
        let mut part = 1.0;
        for _ in 0..RUNS {
            let own = design.scaled(part);
            let load = self.load(&own, room)?;
            if load <= 1.0 {
                fits = Some((own, part));
                if load >= ENOUGH || fails.is_none() {
                    break;
                }
            } else {
                fails = Some(part);
            }
            part = match (&fits, fails) {
                (Some((_, low)), Some(high)) => (low * high).sqrt(),
                _ => part * (AIM / load).max(MOST),
            };
        }
        Ok(fits)
    }

    /// How much of its travel or speed a design uses.
    fn load(&self, design: &Design, room: &Room) -> Result<f64, Failed> {
        let tables = self.tables(&design.values(), design.wish.step_s);
        let motions = self.motions(&tables)?;
        // The axis starts in the middle of its travel.
        let loads = motions.iter().filter_map(|(unit, away, speed)| {
            let (own, known) = (unit.unit().dimension, room.unit.unit().dimension);
            (own.agreement(known) == Agreement::Same).then(|| {
                let load = |limit: Option<f64>, value: f64| limit.map_or(0.0, |l| value / l);
                load(room.travel, 2.0 * away).max(load(room.speed, *speed))
            })
        });
        Ok(loads.fold(0.0, f64::max))
    }
}
