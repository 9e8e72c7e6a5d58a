//! [`Path`]: moves one after the other with dwells between them, as samples.

use super::profile::Profile;

/// A straight move, and the dwell behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// Where it ends, SI, from where the axis stands at first.
    pub to: f64,
    /// The speed that it reaches, SI.
    pub speed: f64,
    /// When it begins, s.
    pub begin_s: f64,
    /// How long it takes, s.
    pub move_s: f64,
    /// How long the axis stands afterwards, s.
    pub dwell_s: f64,
}

/// Moves one after the other.
#[derive(Clone, Debug, Default)]
pub(super) struct Path {
    profiles: Vec<Profile>,
    pub(super) legs: Vec<Leg>,
}

impl Path {
    /// Where it ends.
    pub(super) fn end(&self) -> f64 {
        self.legs.last().map_or(0.0, |leg| leg.to)
    }

    /// How long it takes, s.
    pub(super) fn duration_s(&self) -> f64 {
        let last = self.legs.last();
        last.map_or(0.0, |leg| leg.begin_s + leg.move_s + leg.dwell_s)
    }

    /// Stands for a time at its end.
    pub(super) fn wait(&mut self, dwell_s: f64) {
        if let Some(leg) = self.legs.last_mut() {
            leg.dwell_s += dwell_s;
        }
    }

    /// Goes on to a place.
    pub(super) fn go(&mut self, to: f64, limits: &super::Limits, dwell_s: f64) {
        let profile = Profile::new(to - self.end(), limits);
        self.legs.push(Leg {
            to,
            speed: profile.top_speed(),
            begin_s: self.duration_s(),
            move_s: profile.duration_s(),
            dwell_s,
        });
        self.profiles.push(profile);
    }

    /// The place at so many instants a period apart.
    pub(super) fn samples(&self, rows: usize, step_s: f64) -> Vec<f64> {
        let mut own = 0;
        let at = |row: usize| {
            let t = row as f64 * step_s;
            while own + 1 < self.legs.len() && self.legs[own + 1].begin_s <= t {
                own += 1;
            }
            let from = if own == 0 { 0.0 } else { self.legs[own - 1].to };
            let (leg, profile) = (self.legs.get(own), self.profiles.get(own));
            leg.zip(profile)
                .map_or(0.0, |(leg, profile)| from + profile.at(t - leg.begin_s))
        };
        (0..rows).map(at).collect()
    }
}
