//! [`alternative`]: what a hypothesis is that the records cannot distinguish from the one taken in, and the experiment that
//! would tell the two apart.
//!
//! Two fitted models predict different innovations. Were one of them the axis, the other would be behind it by the sum of
//! squares of the difference, without the part that its own constants and parameters answer to. Where that is below the
//! gate, records of the same motions are asked for as many times as are missing, of the motion that tells most
//! (discrimination of models; Hunter and Reiner, Technometrics 7, 1965, 307).
//!
//! If the sum is no more than noise gives to the constants of the other model, and next to nothing of what the first one
//! explains, both predict the same. With more constants the other one is no other answer: a drag with a power of the speed
//! repeats a viscous one, its exponent being near 1. Nor is the same effect at another place that moves with the first, or one
//! that acts on it through an ideal gear.

use super::alike::act_alike;
use super::evidence::Gates;
use super::hypothesis::Hypothesis;
use super::projection::Projection;
use super::stage::{Ground, flat};
use super::trial::Trial;
use crate::fit::rows_of_a_block;
use hyde_signal::statistics::distributions::chi_squared;
use nalgebra::DVector;

/// A hypothesis that the records cannot tell from the one taken in.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Its number.
    pub hypothesis: usize,
    /// What it is beside the one taken in.
    pub relation: Relation,
    /// What would tell; `None` where no motion of the records does.
    pub experiment: Option<Experiment>,
}

/// How two hypotheses are related that records cannot tell apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// They are different answers.
    Another,
    /// The same effect at places that move together, which predicts the same, or one that acts alike there: one answer.
    Joined,
    /// The other one has more constants and predicts the same: the simpler one is the answer.
    Repeats,
}

/// Motions of which more would tell two effects apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The record whose motion tells most.
    pub record: String,
    /// How many such records it would take.
    pub times: f64,
    /// The second of it in which the two differ most, in s from its start.
    pub second_s: f64,
}

/// What a trial is beside the one taken in.
pub(super) fn alternative(
    ground: &Ground<'_>,
    hypotheses: &[Hypothesis],
    (one, other): (&Trial, &Trial),
    gates: Gates,
) -> Alternative {
    let rest = not_repeated(ground, one, other);
    let gate = one.gate(gates);
    let experiment = telling(ground, one, &rest, gate);
    // What noise gives to its constants.
    let thresholds = ground.thresholds;
    let by_chance = chi_squared(other.freedoms.max(1), thresholds.chance) * one.inflation;
    let same = rest.norm_squared() <= by_chance.min(thresholds.negligible * one.gain);
    let effect = |trial: &Trial| &hypotheses[trial.hypothesis].effect;
    let relation = match same {
        true if other.freedoms > one.freedoms => Relation::Repeats,
        true if effect(one) == effect(other) || act_alike(ground, one, other) => Relation::Joined,
        true | false => Relation::Another,
    };
    Alternative {
        hypothesis: other.hypothesis,
        relation,
        experiment,
    }
}

/// What would tell another trial from one, whose innovations it does not repeat by a rest, for a gain that is to be reached.
fn telling(ground: &Ground<'_>, one: &Trial, rest: &DVector<f64>, gate: f64) -> Option<Experiment> {
    let mut rest = rest.as_slice();
    let records = ground.recordings.iter();
    let each = records.zip(&one.stage.solution.innovations);
    let each = each.map(|(recording, own)| {
        let length = rows_of_a_block(recording);
        let rows = own.channels.first().map_or(0, Vec::len);
        let mut seconds = vec![0.0; rows.div_ceil(length)];
        for channel in &own.channels {
            let (here, behind) = rest.split_at(channel.len());
            rest = behind;
            for (row, own) in here.iter().enumerate() {
                seconds[row / length] += own.powi(2);
            }
        }
        let most = (0..seconds.len()).max_by(|&i, &j| seconds[i].total_cmp(&seconds[j]));
        let first = (recording.first_row + most.unwrap_or(0) * length) as f64 * recording.step_s;
        Experiment {
            record: recording.name.clone(),
            times: gate / seconds.iter().sum::<f64>().max(f64::MIN_POSITIVE),
            second_s: first,
        }
    });
    let best = each.min_by(|a, b| a.times.total_cmp(&b.times));
    best.filter(|best| best.times <= ground.thresholds.more_records)
}

/// The difference of the innovations of two trials without what the constants and parameters of the other answer to.
fn not_repeated(ground: &Ground<'_>, one: &Trial, other: &Trial) -> DVector<f64> {
    let innovations = |trial: &Trial| DVector::from_vec(flat(&trial.stage.solution.innovations));
    let difference = innovations(one) - innovations(other);
    let rest = || {
        let tracks = other.stage.tracks(ground).ok()?;
        let projection = Projection::of(&other.stage, &tracks, ground).ok()??;
        Some(projection.rest(&difference))
    };
    rest().unwrap_or(difference)
}
