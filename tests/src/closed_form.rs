//! The undamped reference axis as a continuous system: its natural frequencies without any discretisation.
//!
//! At a frequency w each part is a dynamic stiffness, force over displacement. The screw is two bars, in torsion and
//! along its axis, with lumped ends (Meirovitch, Fundamentals of Vibrations, ch. 8): a bar whose end has the dynamic
//! stiffness D is, seen at the distance x from that end, `Z*(D*cos(bx) - Z*sin(bx))/(Z*cos(bx) + D*sin(bx))` with
//! `b = w*sqrt(rho/G)` and `Z = G*I*b`. Nut, twist, stretch and saddle carry one force, so their receptances add up to
//! nothing in a natural vibration:
//!
//! `1/k_nut + lead^2/S_torsion + 1/S_axial + 1/S_slide = 0`
//!
//! The left side rises between its poles (Foster), so every change from minus to plus is a root and every other a pole.
//! With the nut in the middle the screw has axial vibrations besides that have a node there and move nothing else.

use std::f64::consts::{PI, TAU};

/// The reference axis, SI. No part of it dissipates.
#[derive(Clone, Debug, PartialEq)]
pub struct ContinuousAxis {
    /// Length of the screw.
    pub len: f64,
    /// Diameter of the screw.
    pub diameter: f64,
    /// Where the nut is, from the driven end.
    pub nut: f64,
    /// The table rocks on the saddle; else it is bolted to it.
    pub rocking: bool,
}

const DENSITY: f64 = 7850.0;
const SHEAR: f64 = 79.2e9;
const YOUNG: f64 = 206e9;
const LEAD: f64 = 10e-3 / TAU;
const BEARING: f64 = 3.0e8;
const NUT: f64 = 5.0e8;
const MOTOR: f64 = 0.0100 + 1.44e-4;
const PULLEY: f64 = 6.55e-4;
const BELT: f64 = 1e6;
const RADII: (f64, f64) = (22.0 * 8e-3 / TAU, 32.0 * 8e-3 / TAU);
const SADDLE: f64 = 250.0;
const TABLE: f64 = 350.0;
const TILT: (f64, f64, f64) = (25.0, 0.15, 1.590e6);

impl ContinuousAxis {
    /// The axis of the paper's size with its table in the middle.
    #[must_use]
    pub fn reference() -> Self {
        Self {
            len: 1.0,
            diameter: 36e-3,
            nut: 0.5,
            rocking: true,
        }
    }

    /// The natural frequencies up to a limit, in Hz, rising; the free motion of the whole axis is none of them.
    #[must_use]
    pub fn frequencies_hz(&self, below_hz: f64) -> Vec<f64> {
        let receptance = |f: f64| self.receptance(TAU * f);
        let apart = |f: f64| -self.stretch(TAU * f).held(self.nut, BEARING);
        let symmetric = (self.nut - 0.5 * self.len).abs() < 1e-12;
        let step = 0.01;
        let mut found = Vec::new();
        let mut low = 1.0;
        while low < below_hz {
            let high = low + step;
            if receptance(low) < 0.0 && receptance(high) > 0.0 {
                found.push(bisected(&receptance, low, high));
            }
            if symmetric && apart(low) * apart(high) < 0.0 {
                let sign = apart(high).signum();
                found.push(bisected(&|f| sign * apart(f), low, high));
            }
            low = high;
        }
        found
    }

    /// What vanishes at the natural frequencies, at w in rad/s.
    fn receptance(&self, w: f64) -> f64 {
        let polar = PI * self.diameter.powi(4) / 32.0;
        let twist = Bar {
            stiffness: SHEAR * polar,
            wave: w * (DENSITY / SHEAR).sqrt(),
        };
        let stretch = self.stretch(w);
        let far = self.len - self.nut;
        let torsion = twist.seen(self.nut, driven_end(w)) + twist.seen(far, 0.0);
        let axial = stretch.seen(self.nut, BEARING) + stretch.seen(far, BEARING);
        1.0 / NUT + LEAD * LEAD / torsion + 1.0 / axial + 1.0 / self.slide(w)
    }

    fn stretch(&self, w: f64) -> Bar {
        Bar {
            stiffness: YOUNG * PI * self.diameter.powi(2) / 4.0,
            wave: w * (DENSITY / YOUNG).sqrt(),
        }
    }

    /// Saddle and table: force over displacement of the saddle.
    fn slide(&self, w: f64) -> f64 {
        if !self.rocking {
            return -w * w * (SADDLE + TABLE);
        }
        let (jx, h, k) = TILT;
        let tilt = w * w * TABLE * h / (k - w * w * (jx + TABLE * h * h));
        -w * w * (SADDLE + TABLE * (1.0 + h * tilt))
    }
}

/// Driven pulley, belt and motor: torque over angle of the pulley.
fn driven_end(w: f64) -> f64 {
    let (a, b) = RADII;
    let motor = BELT * a * a - w * w * MOTOR;
    -w * w * PULLEY + BELT * b * b - (BELT * a * b).powi(2) / motor
}

/// A bar: its stiffness times its length, and its wave number.
struct Bar {
    stiffness: f64,
    wave: f64,
}

impl Bar {
    /// Dynamic stiffness at a distance from an end that has one itself.
    fn seen(&self, distance: f64, end: f64) -> f64 {
        let own = self.stiffness * self.wave;
        let (sin, cos) = (self.wave * distance).sin_cos();
        own * (end * cos - own * sin) / self.held(distance, end)
    }

    /// What vanishes where the bar vibrates by itself with that end and the place at a distance from it held.
    fn held(&self, distance: f64, end: f64) -> f64 {
        let own = self.stiffness * self.wave;
        let (sin, cos) = (self.wave * distance).sin_cos();
        own * cos + end * sin
    }
}

/// A root between two places where the sign differs, to rounding.
fn bisected(of: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if of(middle) < 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A bar without anything at its end moves by itself where half waves fit: k*c/(2*len).
    #[test]
    fn a_free_bar_has_the_frequencies_of_textbooks() {
        let len = 2.0;
        for k in 1..5 {
            let bar = Bar {
                stiffness: 3.0,
                wave: PI * f64::from(k) / len,
            };
            assert!(bar.seen(len, 0.0).abs() < 1e-12); // rounding of sin(k*pi)
        }
    }

    /// Of a short stiff screw only belt, nut, bearings and masses are left: two springs in series, as in a lumped model.
    #[test]
    fn slow_waves_are_springs() {
        let bar = Bar {
            stiffness: 7.0,
            wave: 1e-4,
        };
        // held far away: a spring EA/x
        assert!((bar.seen(2.0, 1e12) / 3.5 - 1.0).abs() < 1e-7); // (wave*x)^2/3
        // a mass at the end of nothing: -w^2*m is just passed on
        assert!((bar.seen(1e-6, -2.0) / -2.0 - 1.0).abs() < 1e-6); // x*D/EA
    }
}
