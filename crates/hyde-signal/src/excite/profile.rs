//! [`Profile`]: the fastest motion over a distance from rest to rest within limits of speed, acceleration and jerk.
//!
//! Biagiotti and Melchiorri, Trajectory Planning for Automatic Machines and Robots (2008), section 3.4; the library's
//! `Drives.Control.Stroke` is the same. Each part is computed from its own begin or end, so that long motions are as exact as
//! short ones.

use super::limits::{Limits, Quantity};

/// A motion from rest to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    distance: f64,
    jerk: f64,
    /// How long the jerk acts at each end of speeding up, and how long that takes in all, s.
    t_jerk: f64,
    t_up: f64,
    duration_s: f64,
}

impl Profile {
    /// The motion over a distance (SI, either sign).
    #[must_use]
    pub fn new(distance: f64, limits: &Limits) -> Self {
        let Limits {
            speed,
            acceleration,
            jerk,
            ..
        } = *limits;
        let d = distance.abs();
        if d <= 0.0 {
            return Self {
                distance: 0.0,
                jerk,
                t_jerk: 0.0,
                t_up: 0.0,
                duration_s: 0.0,
            };
        }
        let t_jerk = (acceleration / jerk)
            .min((speed / jerk).sqrt())
            .min((d / (2.0 * jerk)).cbrt());
        let a_top = jerk * t_jerk;
        let by_distance = 0.5 * t_jerk + (0.25 * t_jerk * t_jerk + d / a_top).sqrt();
        let t_up = (speed / a_top + t_jerk).min(by_distance).max(2.0 * t_jerk);
        let v_top = a_top * (t_up - t_jerk);
        Self {
            distance,
            jerk,
            t_jerk,
            t_up,
            duration_s: t_up + d / v_top,
        }
    }

    /// How long it takes, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The speed that it reaches.
    #[must_use]
    pub fn top_speed(&self) -> f64 {
        self.jerk * self.t_jerk * (self.t_up - self.t_jerk)
    }

    /// Where it is a time after its begin.
    #[must_use]
    pub fn at(&self, t: f64) -> f64 {
        let d = self.distance.abs();
        let way = match t {
            t if t <= 0.0 => 0.0,
            t if t >= self.duration_s => d,
            t if t <= 0.5 * self.duration_s => self.up(t),
            t => d - self.up(self.duration_s - t),
        };
        way.copysign(self.distance)
    }

    /// The way since it began to speed up.
    fn up(&self, t: f64) -> f64 {
        let (j, tj, ta) = (self.jerk, self.t_jerk, self.t_up);
        let (a, v) = (j * tj, self.top_speed());
        match t {
            t if t <= tj => j * t.powi(3) / 6.0,
            t if t <= ta - tj => {
                let since = t - tj;
                j * tj.powi(3) / 6.0 + (0.5 * a * tj + 0.5 * a * since) * since
            }
            t if t <= ta => {
                let left = ta - t;
                0.5 * v * ta - v * left + j * left.powi(3) / 6.0
            }
            t => 0.5 * v * ta + v * (t - ta),
        }
    }

    /// The limit that makes it as slow as it is.
    pub(super) fn binds(&self, limits: &Limits) -> Quantity {
        let near = |value: f64, limit: f64| value > 0.999 * limit;
        if near(self.top_speed(), limits.speed) {
            Quantity::Speed
        } else if near(self.jerk * self.t_jerk, limits.acceleration) {
            Quantity::Acceleration
        } else {
            Quantity::Jerk
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits {
        travel: 1.0,
        speed: 0.2,
        acceleration: 1.0,
        jerk: 20.0,
    };

    /// The sum of its parts, by hand: 0.05 s of jerk four times, 0.15 s at 1 m/s2 twice, the rest at 0.2 m/s.
    #[test]
    fn a_long_motion_has_all_seven_parts() {
        let profile = Profile::new(-0.3, &LIMITS);
        // Speeding up takes 0.2/1 + 0.05 s and 0.025 m.
        assert!((profile.duration_s() - (0.25 + 0.3 / 0.2)).abs() < 1e-12);
        assert!((profile.at(0.25) + 0.025).abs() < 1e-15);
        assert!((profile.at(1.0) + 0.025 + 0.75 * 0.2).abs() < 1e-15);
        assert!((profile.at(9.0) + 0.3).abs() < 1e-15);
        assert_eq!(profile.binds(&LIMITS), Quantity::Speed);
    }

    #[test]
    fn a_short_motion_has_jerk_alone() {
        let profile = Profile::new(1e-6, &LIMITS);
        assert!((profile.duration_s() - 4.0 * (1e-6_f64 / 40.0).cbrt()).abs() < 1e-12);
        assert!((profile.at(0.5 * profile.duration_s()) - 0.5e-6).abs() < 1e-18);
        assert_eq!(profile.binds(&LIMITS), Quantity::Jerk);
    }

    #[test]
    fn each_part_goes_on_where_the_one_before_ends() {
        for distance in [1e-5, 1e-3, 2e-2, 0.4] {
            let profile = Profile::new(distance, &LIMITS);
            let corners = [
                profile.t_jerk,
                profile.t_up - profile.t_jerk,
                profile.t_up,
                0.5 * profile.duration_s,
            ];
            for t in corners {
                let (before, after) = (profile.at(t - 1e-9), profile.at(t + 1e-9));
                assert!(
                    (after - before - 2e-9 * profile.top_speed()).abs() < 2e-9 * 0.2,
                    "{distance} m at {t} s"
                );
            }
        }
    }
}
