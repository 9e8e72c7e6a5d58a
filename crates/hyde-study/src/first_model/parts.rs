//! Values of the parts of an axis: from what a trace shows, else guessed.
//!
//! A trace of a current and a position shows inertia over torque constant, as a whole. How it is shared out among the parts is
//! a guess, as every stiffness is.

use super::channels::{Channels, Measured};
use super::estimate::Estimate;
use super::{Template, Trace, Wish};
use hyde_signal::{Cursor, Table};
use std::f64::consts::TAU;

/// Values of the parts, SI. Of a rotary axis mass, friction and stiffness are those of turning.
#[derive(Clone, Debug)]
pub(super) struct Parts {
    /// Torque or force per current.
    pub(super) constant: f64,
    pub(super) constant_from: &'static str,
    /// Way per angle of the motor; of a rotary table turns of the motor per turn.
    pub(super) ratio: f64,
    pub(super) ratio_from: &'static str,
    /// Of the rotor with what turns at its speed.
    pub(super) rotor: f64,
    /// Of the load.
    pub(super) mass: f64,
    pub(super) coulomb: f64,
    pub(super) viscous: f64,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    /// Both ends of the stiffness are measured: it can be calibrated.
    pub(super) both_ends: bool,
    /// Of a screw.
    pub(super) length: f64,
    pub(super) diameter: f64,
    pub(super) from: &'static str,
    /// The current acts against the measured direction.
    pub(super) reversed: bool,
    /// The motor is measured against the direction of the load.
    pub(super) motor_reversed: bool,
    /// The inertia of everything at the motor, or the mass that a linear motor moves.
    pub(super) inertia: f64,
}

/// A ratio of motor and load.
#[derive(Clone, Debug)]
pub(super) struct Ratio {
    pub(super) value: f64,
    pub(super) from: &'static str,
    pub(super) reversed: bool,
    pub(super) note: Option<String>,
}

/// The ratio: as given, else as both channels show it, else a usual one.
pub(super) fn ratio(wish: &Wish, trace: &Trace, channels: &Channels) -> Ratio {
    let shown = match (&channels.motor, &channels.load) {
        (Some(motor), Some(load)) if motor.is_speed == load.is_speed => {
            slope(&trace.table, motor, load)
        }
        _ => None,
    };
    // Of a rotary table the ratio counts turns of the motor.
    let shown = shown.filter(|_| wish.template != Template::Bench);
    let shown = shown.map(|slope| match wish.template {
        Template::Table => 1.0 / slope,
        Template::Screw | Template::Belt | Template::Rack | Template::Linear | Template::Bench => {
            slope
        }
    });
    let reversed = shown.is_some_and(|shown| shown < 0.0);
    match (wish.ratio, shown) {
        (Some(value), _) => Ratio {
            value,
            from: "as given",
            reversed,
            note: None,
        },
        (None, Some(shown)) if shown.abs() > 1e-9 && shown.is_finite() => Ratio {
            value: shown.abs(),
            from: "both channels show it",
            reversed,
            note: Some("the ratio of motor and load follows from both channels".to_owned()),
        },
        (None, _) => Ratio {
            value: usual_ratio(wish.template),
            from: "a guess",
            reversed: false,
            note: None,
        },
    }
}

fn usual_ratio(template: Template) -> f64 {
    match template {
        Template::Screw | Template::Rack => 10e-3 / TAU,
        Template::Belt => 40e-3 / TAU,
        Template::Table => 90.0,
        Template::Linear | Template::Bench => 1.0,
    }
}

/// How much the load moves as the motor moves: least squares about their means.
fn slope(table: &Table, motor: &Measured, load: &Measured) -> Option<f64> {
    let part = table.holding(&motor.name);
    let own = part.column(&motor.name)?.values();
    let other = table.signal(&load.name)?;
    let mut cursor = Cursor::default();
    let pairs: Vec<(f64, f64)> = part
        .time()
        .iter()
        .zip(own)
        .map(|(&t, &own)| (own, other.linear(t, &mut cursor)))
        .filter(|(a, b)| a.is_finite() && b.is_finite())
        .collect();
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (a, b) = (mean(|p| p.0), mean(|p| p.1));
    let (sums, squares) = pairs
        .iter()
        .fold((0.0, 0.0), |(sums, squares), (own, other)| {
            (sums + (own - a) * (other - b), squares + (own - a).powi(2))
        });
    (squares > 0.0).then(|| sums / squares)
}

impl Parts {
    /// From a trace.
    pub(super) fn of(
        wish: &Wish,
        channels: &Channels,
        ratio: &Ratio,
        shown: Option<&Estimate>,
    ) -> Self {
        let constant = match channels.drive.is_force {
            true => 1.0,
            false => wish
                .constant
                .unwrap_or_else(|| usual_constant(wish.template)),
        };
        let from = match (channels.drive.is_force, wish.constant) {
            (true, _) => "the trace has a torque or force",
            (false, Some(_)) => "as given",
            (false, None) => "a guess, data sheet of the motor",
        };
        let at_motor = shown.map(|found| At {
            inertia: constant * found.inertia,
            coulomb: constant * found.coulomb,
            viscous: constant * found.viscous,
        });
        let mut parts = Self::shared_out(wish.template, constant, ratio.value, at_motor);
        parts.constant_from = from;
        parts.ratio_from = ratio.from;
        parts.both_ends = channels.motor.is_some() && channels.load.is_some();
        parts.from = if shown.is_some() {
            "the trace"
        } else {
            "guess"
        };
        parts.reversed = shown.is_some_and(|found| found.reversed);
        parts.motor_reversed = ratio.reversed;
        parts
    }

    /// Of an axis that nothing is known of.
    pub(super) fn guessed(wish: &Wish) -> Self {
        let constant = wish
            .constant
            .unwrap_or_else(|| usual_constant(wish.template));
        let ratio = wish.ratio.unwrap_or_else(|| usual_ratio(wish.template));
        let mut parts = Self::shared_out(wish.template, constant, ratio, None);
        let from = |given: Option<f64>| {
            if given.is_some() {
                "as given"
            } else {
                "a guess"
            }
        };
        parts.constant_from = from(wish.constant);
        parts.ratio_from = from(wish.ratio);
        parts
    }

    fn shared_out(template: Template, constant: f64, ratio: f64, at_motor: Option<At>) -> Self {
        let at = at_motor.unwrap_or_else(|| usual(template, constant));
        // Of what moves, these parts are the rotor's and the screw's.
        let (of_rotor, of_screw) = match template {
            Template::Screw => (0.3, 0.2),
            Template::Belt | Template::Rack | Template::Table => (0.4, 0.0),
            Template::Bench => (0.5, 0.0),
            Template::Linear => (0.0, 0.0),
        };
        // Load over motor, in speed: forces go the other way.
        let speed = match template {
            Template::Table => 1.0 / ratio,
            Template::Bench | Template::Linear => 1.0,
            Template::Screw | Template::Belt | Template::Rack => ratio,
        };
        let mass = (1.0 - of_rotor - of_screw) * at.inertia / (speed * speed);
        // The first resonance of the load on its drive, Hz, and its damping ratio.
        let (resonance, damping_ratio) = match template {
            Template::Screw => (150.0, 0.05),
            Template::Belt => (40.0, 0.05),
            Template::Rack | Template::Table => (60.0, 0.05),
            Template::Bench => (30.0, 0.02),
            Template::Linear => (0.0, 0.0),
        };
        // The coupling of a rack is at its motor.
        let sprung = match template {
            Template::Rack => mass * speed * speed,
            Template::Screw
            | Template::Belt
            | Template::Linear
            | Template::Table
            | Template::Bench => mass,
        };
        let stiffness = sprung * (TAU * resonance).powi(2);
        let length = 1.0;
        let density = 7850.0;
        let diameter =
            (of_screw * at.inertia * 32.0 / (std::f64::consts::PI * density * length)).powf(0.25);
        Self {
            constant,
            constant_from: "a guess",
            ratio,
            ratio_from: "a guess",
            rotor: of_rotor * at.inertia,
            mass,
            coulomb: at.coulomb / speed,
            viscous: at.viscous / (speed * speed),
            stiffness,
            damping: 2.0 * damping_ratio * (stiffness * sprung).sqrt(),
            both_ends: false,
            length,
            diameter,
            from: "guess",
            reversed: false,
            motor_reversed: false,
            inertia: at.inertia,
        }
    }
}

/// Inertia and friction of everything, at the motor.
#[derive(Clone, Copy)]
struct At {
    inertia: f64,
    coulomb: f64,
    viscous: f64,
}

fn usual_constant(template: Template) -> f64 {
    match template {
        Template::Linear => 60.0,
        Template::Screw | Template::Belt | Template::Rack | Template::Table | Template::Bench => {
            0.5
        }
    }
}

/// An axis that ten amperes accelerate in 30 ms to its usual speed, with friction of an ampere.
fn usual(template: Template, constant: f64) -> At {
    match template {
        Template::Linear => At {
            inertia: 0.5 * constant,
            coulomb: 0.5 * constant,
            viscous: constant,
        },
        Template::Screw | Template::Belt | Template::Rack | Template::Table | Template::Bench => {
            At {
                inertia: 4e-3 * constant,
                coulomb: constant,
                viscous: 4e-3 * constant,
            }
        }
    }
}
