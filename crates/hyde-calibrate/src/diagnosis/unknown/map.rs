//! [`Map`]: of what a force at a site would have to be a function: of speed, place, acceleration, the signal of the site, time,
//! or of place or time times speed.
//!
//! For each variable the force is any piecewise linear function of it, and what that gains, with all parameters answering,
//! says how much of the innovations such a law could explain. The same is tried on innovations shifted against the record,
//! which have no law: what they gain at most is the band above which a gain says something.

use super::felt::Felt;
use super::latent::Course;
use super::regression::best_wave;
use super::site::{Kind, Site};
use crate::diagnosis::projection::Projection;
use hyde_ir::LawShape;
use std::sync::Arc;

/// What a force may be a function of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variable {
    /// Speed; for a friction its magnitude.
    Speed,
    /// Place or angle.
    Place,
    /// Acceleration.
    Acceleration,
    /// What the site has beside place and speed.
    Signal,
    /// The angle within a turn.
    Turn,
    /// Time.
    Time,
    /// Speed times any function of place.
    SpeedByPlace,
    /// Speed times any function of time.
    SpeedByTime,
}

impl Variable {
    /// Its name in reports, at a kind of site.
    #[must_use]
    pub fn name(self, kind: &Kind) -> String {
        let [place, speed] = kind.variables();
        match self {
            Self::Speed => speed,
            Self::Place => place,
            Self::Acceleration => "acceleration".to_owned(),
            Self::Signal => kind.signal(),
            Self::Turn => "angle in a revolution".to_owned(),
            Self::Time => "time".to_owned(),
            Self::SpeedByPlace => format!("{speed} times {place}"),
            Self::SpeedByTime => format!("{speed} times time"),
        }
    }

    /// Its SI unit, at a kind of site.
    #[must_use]
    pub fn unit(self, kind: &Kind) -> String {
        match self {
            Self::Speed => kind.speed_unit(),
            Self::Place | Self::Turn | Self::SpeedByPlace => kind.place_unit(),
            Self::Acceleration => kind.acceleration_unit(),
            Self::Signal => kind.signal_unit(),
            Self::Time | Self::SpeedByTime => "s".to_owned(),
        }
    }
}

/// A function of one variable at a site.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The variable.
    pub variable: Variable,
    /// What the best function of it gains.
    pub gain: f64,
    /// What innovations without a law gain at most.
    pub band: f64,
    /// Values of the variable, SI.
    pub knots: Vec<f64>,
    /// The force or torque there, SI; where speed is a factor, at the usual speed.
    pub force: Vec<f64>,
}

/// The panels of a site, the best first.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// The site.
    pub site: Site,
    /// Its panels.
    pub panels: Vec<Panel>,
    /// What the best wave over place gains, by itself or times speed: of a short one panels show nothing.
    pub waves: f64,
}

impl Map {
    /// What a law there can gain: as much as the best panel, or the best wave.
    #[must_use]
    pub fn gain(&self) -> f64 {
        let panel = self.panels.first();
        panel.map_or(0.0, |panel| panel.gain).max(self.waves)
    }
}

/// Numerics: pieces of a function.
const KNOTS: usize = 16;
/// Numerics: shifts of the innovations: the greatest gain of so many is a band of 95 %.
const SHIFTS: usize = 19;

/// The map of a site, without bands.
pub(crate) fn map(shapes: &[Arc<LawShape>], felt: &Felt, projection: &Projection) -> Map {
    let panels = variables(felt).into_iter().map(|variable| {
        let (knots, columns) = columns(felt, variable);
        let answer = projection.answer(&columns);
        Panel {
            variable,
            gain: answer.gain,
            band: f64::NAN,
            knots,
            force: answer.sizes,
        }
    });
    let mut panels: Vec<Panel> = panels.collect();
    panels.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    Map {
        site: felt.site.clone(),
        panels,
        waves: best_wave(shapes, felt, projection),
    }
}

/// Adds the bands of a map.
pub(crate) fn add_bands(map: &mut Map, felt: &Felt, projection: &Projection) {
    let lengths: Vec<usize> = felt
        .carriers
        .iter()
        .flat_map(super::latent::Carrier::lengths)
        .collect();
    for panel in &mut map.panels {
        let (_, columns) = columns(felt, panel.variable);
        let innovations = projection.innovations.as_slice();
        let shifts = (1..=SHIFTS).map(|shift| shifted(innovations, &lengths, shift));
        let gains = projection.by_chance(&columns, shifts).into_iter();
        panel.band = gains.fold(0.0, f64::max);
    }
}

/// Each channel of each record turned round by a part of its length.
fn shifted(innovations: &[f64], lengths: &[usize], shift: usize) -> Vec<f64> {
    let mut out = Vec::with_capacity(innovations.len());
    let mut rest = innovations;
    for &length in lengths {
        let (own, others) = rest.split_at(length.min(rest.len()));
        rest = others;
        let by = own.len() * shift / (SHIFTS + 1);
        out.extend_from_slice(&own[by..]);
        out.extend_from_slice(&own[..by]);
    }
    out
}

fn variables(felt: &Felt) -> Vec<Variable> {
    let mut all = vec![Variable::Speed, Variable::Place, Variable::Time];
    if felt.seen.acceleration > 0.0 {
        all.push(Variable::Acceleration);
    }
    if felt.seen.signal > 0.0 {
        all.push(Variable::Signal);
    }
    if felt.site.kind.turns() && felt.seen.travel() > std::f64::consts::TAU {
        all.push(Variable::Turn);
    }
    // In proportion to speed a friction is a force, and that has a site of its own.
    if !felt.site.kind.is_grip() {
        all.extend([Variable::SpeedByPlace, Variable::SpeedByTime]);
    }
    all
}

/// Knots of a variable, and the changes of innovations by a unit of force about each.
fn columns(felt: &Felt, variable: Variable) -> (Vec<f64>, Vec<Vec<f64>>) {
    let grip = felt.site.kind.is_grip();
    let seen = &felt.seen;
    let even = |(low, high): (f64, f64)| -> Vec<f64> {
        let parts = (0..KNOTS).map(|k| k as f64 / (KNOTS - 1) as f64);
        parts.map(|part| low + (high - low) * part).collect()
    };
    // Denser about rest, where frictions bend.
    let knots: Vec<f64> = match variable {
        Variable::Speed if grip => even((0.0, 1.0))
            .iter()
            .map(|x| seen.speed * x * x)
            .collect(),
        Variable::Speed => even((-1.0, 1.0))
            .iter()
            .map(|x| seen.speed * x * x.abs())
            .collect(),
        Variable::Place | Variable::SpeedByPlace => even(seen.place),
        Variable::Acceleration => even((-seen.acceleration, seen.acceleration)),
        Variable::Signal => even((-seen.signal, seen.signal)),
        Variable::Time | Variable::SpeedByTime => even(seen.time),
        Variable::Turn => even((0.0, std::f64::consts::TAU)),
    };
    let times_speed = matches!(variable, Variable::SpeedByPlace | Variable::SpeedByTime);
    let of = |course: &Course, row: usize| match variable {
        Variable::Speed if grip => course.speed[row].abs(),
        Variable::Speed => course.speed[row],
        Variable::Place | Variable::SpeedByPlace => course.place[row],
        Variable::Acceleration => course.acceleration[row],
        Variable::Signal => course.signal[row],
        Variable::Time | Variable::SpeedByTime => course.time[row],
        Variable::Turn => course.place[row].rem_euclid(std::f64::consts::TAU),
    };
    let forces: Vec<Vec<Vec<f64>>> = felt
        .carriers
        .iter()
        .map(|carrier| {
            let course = &carrier.course;
            let mut lists = vec![vec![0.0; course.time.len()]; knots.len()];
            let parts = (0..course.time.len()).map(|row| {
                let factor = match times_speed {
                    false => 1.0,
                    true => course.speed[row] / felt.scales.speed,
                };
                (between(&knots, of(course, row)), factor)
            });
            for (row, ((left, part), factor)) in parts.enumerate() {
                lists[left][row] += (1.0 - part) * factor;
                lists[left + 1][row] += part * factor;
            }
            lists
        })
        .collect();
    (knots, felt.changes(&forces))
}

/// The knot to the left of a value, and how far it is to the next one.
fn between(knots: &[f64], value: f64) -> (usize, f64) {
    let left = knots
        .partition_point(|&knot| knot <= value)
        .clamp(1, knots.len() - 1)
        - 1;
    let part = (value - knots[left]) / (knots[left + 1] - knots[left]);
    (left, part.clamp(0.0, 1.0))
}
