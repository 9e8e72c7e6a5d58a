//! [`FoundCurve`]: an effect that was found, as a curve over the variable of which it is a function, and beside it what the
//! records say at each place without its formula.
//!
//! ```text
//! law       what the equations have by the effect, in units of a force at its site, where the observer takes the model
//! data      the law, and the force there that the innovations still ask for: any piecewise linear function of the variable
//! ```
//! The force is that of the probe ([`super::unknown`]): both change the same equations, and their ratio is the force, whatever the
//! effect is made of. The data are a partial residual (Larsen and McCleary, Technometrics 14, 1972, 781) in the space of innovations,
//! with all parameters where the diagnosis left them: to first order they do not depend on the formula that was found.

use super::answer::Diagnosis;
use super::finding::Finding;
use super::hypothesis::Hypothesis;
use super::inquiry::Inquiry;
use super::projection::dot;
use super::stage::{Ground, flat};
use super::thresholds::Thresholds;
use super::unknown::{Felt, Kind, Point, Site, Variable, probe, probes, sizes_of, strongest};
use crate::fit::inflation;
use crate::observer::{Direction, Forces, Innovations, Own, Place, Track, When};
use crate::records::Recording;
use hyde_ir::LawAxis;
use hyde_program::Program;
use hyde_signal::statistics::distributions::TWO_SIDED;
use nalgebra::{Cholesky, DMatrix, DVector};
use std::f64::consts::TAU;

/// Numerics: knots of the data.
const KNOTS: usize = 25;
/// Numerics: points of the law between each two knots.
const FINE: usize = 8;
/// Numerics: groups of rows by which it is judged of which variable the effect is a function.
const GROUPS: usize = 64;

/// Of what an effect is a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Over {
    /// A variable of its site.
    Variable(Variable),
    /// The place within one of its periods of this length, SI.
    Period(f64),
}

impl Over {
    /// Its name, at a kind of site.
    #[must_use]
    pub fn name(self, kind: &Kind) -> String {
        match self {
            Self::Variable(Variable::Speed) if kind.is_grip() => {
                "magnitude of the speed".to_owned()
            }
            Self::Variable(variable) => variable.name(kind),
            Self::Period(_) if kind.turns() => "angle within a period".to_owned(),
            Self::Period(_) => "place within a period".to_owned(),
        }
    }

    /// Its SI unit, at a kind of site.
    #[must_use]
    pub fn unit(self, kind: &Kind) -> String {
        match self {
            Self::Variable(variable) => variable.unit(kind),
            Self::Period(_) => kind.place_unit(),
        }
    }
}

/// What the records say at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// The variable, SI.
    pub at: f64,
    /// The force there, SI.
    pub force: f64,
    /// Half its 95 % interval, SI.
    pub half: f64,
}

/// An effect as a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundCurve {
    /// The site.
    pub site: Site,
    /// Of what it is drawn as a function.
    pub over: Over,
    /// The part of its variance that is a function of that, 0 to 1.
    pub share: f64,
    /// The variable and the force by the formula, SI.
    pub law: (Vec<f64>, Vec<f64>),
    /// What the records say.
    pub data: Vec<CurvePoint>,
}

impl Diagnosis {
    /// A finding, by its number, as a curve; `None` where no force stands for it at its site, or it depends on its past.
    #[must_use]
    pub fn curve(&self, inquiry: &Inquiry<'_>, number: usize) -> Option<FoundCurve> {
        let finding = self.findings.get(number)?;
        let Some(hypothesis) = inquiry.hypotheses.get(finding.hypothesis) else {
            let law = self.law()?;
            return self.curve_at(inquiry, (number, &law.hypothesis), &law.law.site);
        };
        let at_site =
            |site: &&Site| site.path == hypothesis.site || hypothesis.aliases.contains(&site.path);
        let mut sites = inquiry.sites.iter().filter(at_site);
        sites.find_map(|site| self.curve_at(inquiry, (number, hypothesis), site))
    }

    /// The same at a site.
    fn curve_at(
        &self,
        inquiry: &Inquiry<'_>,
        (number, hypothesis): (usize, &Hypothesis),
        site: &Site,
    ) -> Option<FoundCurve> {
        let finding = self.findings.get(number)?;
        let ground = Ground {
            observer: self.observer.as_ref().unwrap_or(inquiry.observer),
            ..inquiry.ground()
        };
        let runs = self.along(inquiry, &ground, (number, hypothesis), site)?;
        let (over, share) = best(
            &runs,
            &site.kind,
            period(hypothesis, finding),
            ground.thresholds,
        )?;
        let felt = self.felt(inquiry, &ground, site)?;
        let knots = knots(&runs, &site.kind, over)?;
        let fine = finer(&knots);
        let law: Vec<f64> = mean_force(&runs, &site.kind, over, &fine);
        let shown = ground.thresholds.shown;
        let asked = asked(&felt, &runs, &site.kind, over, &knots, shown)?;
        let at_knots = mean_force(&runs, &site.kind, over, &knots);
        let each = knots.iter().zip(&at_knots).zip(asked);
        let data = each.filter_map(|((&at, &force), more)| {
            let (more, half) = more?;
            force.is_finite().then_some(CurvePoint {
                at,
                force: force + more,
                half,
            })
        });
        let drawn = fine.iter().zip(&law).filter(|(_, force)| force.is_finite());
        Some(FoundCurve {
            site: site.clone(),
            over,
            share,
            law: drawn.map(|(at, force)| (*at, *force)).unzip(),
            data: data.collect(),
        })
    }

    /// The probe put on the model that was found.
    fn felt(&self, inquiry: &Inquiry<'_>, ground: &Ground<'_>, site: &Site) -> Option<Felt> {
        let author = |numbers: &[usize], written: &[super::unknown::Written]| {
            self.built(inquiry, numbers, written)
        };
        Felt::new(ground, &self.stage(), site, &author)
    }

    /// Effects, by number, and written ones behind the law that was found.
    fn built(
        &self,
        inquiry: &Inquiry<'_>,
        numbers: &[usize],
        written: &[super::unknown::Written],
    ) -> Option<super::hypothesis::Built> {
        let own = inquiry.hypotheses.len();
        let known: Vec<usize> = numbers.iter().copied().filter(|&one| one != own).collect();
        let law = self.law().filter(|_| known.len() < numbers.len());
        let law = law.map(|law| law.written.clone());
        let written: Vec<super::unknown::Written> =
            law.into_iter().chain(written.iter().cloned()).collect();
        (inquiry.author)(&known, &written)
    }

    /// The site and the force of a finding there, along every record.
    fn along(
        &self,
        inquiry: &Inquiry<'_>,
        ground: &Ground<'_>,
        (number, hypothesis): (usize, &Hypothesis),
        site: &Site,
    ) -> Option<Vec<Along>> {
        let stage = self.stage();
        let (_, path) = stage.effects.get(number)?;
        let sizes = Hypothesis::names(&hypothesis.sizes, path);
        let along = |more: &Vec<LawAxis>| -> Option<Vec<Along>> {
            let probe = probe(site, more);
            let built = self.built(inquiry, &stage.numbers(), &[probe])?;
            let probe = built.paths.last()?;
            let set = ground.set_in(&built.program, &stage.values());
            let program = &built.program;
            let each = ground.recordings.iter();
            each.map(|recording| Along::of(program, recording, ground, &set, (probe, &sizes)))
                .collect()
        };
        probes(&site.kind).iter().find_map(along)
    }
}

/// A record: where its site is, row by row, and the force of the effect there.
struct Along {
    time: Vec<f64>,
    at: Vec<Point>,
    /// NaN in a row where no force acts.
    force: Vec<f64>,
    innovations: Innovations,
}

impl Along {
    fn of(
        program: &Program,
        recording: &Recording,
        ground: &Ground<'_>,
        set: &[(usize, f64)],
        (probe, sizes): (&str, &[String]),
    ) -> Option<Self> {
        let with = |names: &mut dyn Iterator<Item = String>, value: f64| -> Option<Direction> {
            let mut all = set.to_vec();
            for name in names {
                let (parameter, element) = program.parameter(&name)?;
                all.push((parameter.place + element, value));
            }
            Some(Direction {
                p: recording.parameters(program, &all),
                step: 1.0,
            })
        };
        let mut directions = Vec::new();
        let of_probe = sizes_of(program, probe);
        for name in &of_probe {
            directions.push(with(&mut std::iter::once(name.clone()), 1.0)?);
        }
        directions.push(with(&mut sizes.iter().cloned(), 0.0)?);
        let track = Track::new(program, recording, ground.observer, set).ok()?;
        let p = recording.parameters(program, set);
        let mut own = Own::new(program, (&track, p.as_slice()), &directions);
        let mut forces = DMatrix::zeros(own.touched.len(), directions.len());
        let mut by_output = DMatrix::zeros(recording.channels.len(), directions.len());
        let mut found = Self {
            time: Vec::new(),
            at: Vec::new(),
            force: Vec::new(),
            innovations: track.route.innovations.clone(),
        };
        let mut last = Point::default();
        for row in 0..track.route.rows.len() {
            if own.shown {
                own.seen(Place::Row(row, When::Before), &mut by_output);
            }
            own.forces(Place::Row(row, When::After), &mut forces);
            found.time.push(track.route.time(row));
            let shown = strongest(&forces).or_else(|| strongest(&by_output));
            let force = match shown.as_deref() {
                Some([told @ .., without]) => {
                    last = Point::told(&of_probe, told);
                    -without
                }
                _ => f64::NAN,
            };
            found.at.push(last);
            found.force.push(force);
        }
        Some(found)
    }

    /// The variable in a row.
    fn at(&self, row: usize, kind: &Kind, over: Over) -> f64 {
        let at = self.at[row];
        match over {
            Over::Variable(Variable::Speed) if kind.is_grip() => at.speed.abs(),
            Over::Variable(Variable::Speed) => at.speed,
            Over::Variable(Variable::Time | Variable::SpeedByTime) => self.time[row],
            Over::Variable(Variable::Acceleration) => at.acceleration,
            Over::Variable(Variable::Signal) => at.signal,
            Over::Variable(Variable::Turn) => at.place.rem_euclid(TAU),
            Over::Variable(Variable::Place | Variable::SpeedByPlace) => at.place,
            Over::Period(length) => at.place.rem_euclid(length),
        }
    }

    /// The rows in which a force acts.
    fn rows(&self) -> impl Iterator<Item = usize> {
        (0..self.force.len()).filter(|&row| self.force[row].is_finite())
    }
}

/// The length of a period of an effect that has one, SI: of an order of an angle a part of a revolution.
fn period(hypothesis: &Hypothesis, finding: &Finding) -> Option<f64> {
    let shape = finding.shapes.get(hypothesis.periodic?)?;
    let is_order = hypothesis.shapes.get(hypothesis.periodic?)?.is_number();
    let length = match is_order {
        true => TAU / shape.value,
        false => shape.value,
    };
    (length.is_finite() && length > 0.0).then_some(length)
}

/// The variable of which the effect is a function most, and how much; of those that are alike the first.
fn best(
    runs: &[Along],
    kind: &Kind,
    period: Option<f64>,
    thresholds: &Thresholds,
) -> Option<(Over, f64)> {
    let all_points = || runs.iter().flat_map(|run| &run.at);
    let places = || all_points().map(|at| at.place);
    let travel = places().fold(f64::MIN, f64::max) - places().fold(f64::MAX, f64::min);
    let mut all: Vec<Over> = period.map(Over::Period).into_iter().collect();
    if kind.turns() && travel > TAU {
        all.push(Over::Variable(Variable::Turn));
    }
    let others = [Variable::Place, Variable::Speed, Variable::Time];
    all.extend(others.map(Over::Variable));
    if all_points().any(|at| at.acceleration != 0.0) {
        all.push(Over::Variable(Variable::Acceleration));
    }
    if all_points().any(|at| at.signal != 0.0) {
        all.push(Over::Variable(Variable::Signal));
    }
    let mut best: Option<(Over, f64)> = None;
    for over in all {
        let share = share(runs, kind, over);
        if best.is_none_or(|(_, known)| share > known + thresholds.negligible) {
            best = Some((over, share));
        }
    }
    best.filter(|(_, share)| *share >= thresholds.mostly)
}

/// The part of the square of an effect that its mean over a variable has: 1 of a function of it.
fn share(runs: &[Along], kind: &Kind, over: Over) -> f64 {
    let rows = |run| -> Vec<(f64, f64)> {
        let run: &Along = run;
        let each = run.rows();
        each.map(|row| (run.at(row, kind, over), run.force[row]))
            .collect()
    };
    let mut all: Vec<(f64, f64)> = runs.iter().flat_map(rows).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = all.iter().map(|(_, force)| force * force).sum();
    let size = all.len().div_ceil(GROUPS).max(1);
    let within: f64 = all
        .chunks(size)
        .map(|group| {
            let mean = group.iter().map(|(_, force)| force).sum::<f64>() / group.len() as f64;
            group
                .iter()
                .map(|(_, force)| (force - mean).powi(2))
                .sum::<f64>()
        })
        .sum();
    match total > 0.0 {
        true => 1.0 - within / total,
        false => 0.0,
    }
}

/// The knots of the data; denser about rest, where frictions bend.
fn knots(runs: &[Along], kind: &Kind, over: Over) -> Option<Vec<f64>> {
    let values = || {
        let each = runs.iter();
        each.flat_map(|run| run.rows().map(|row| run.at(row, kind, over)))
    };
    let (low, high) = match over {
        Over::Period(length) => (0.0, length),
        Over::Variable(Variable::Turn) => (0.0, TAU),
        Over::Variable(_) => (
            values().fold(f64::INFINITY, f64::min),
            values().fold(f64::NEG_INFINITY, f64::max),
        ),
    };
    if !(high - low).is_finite() || high <= low {
        return None;
    }
    let parts = (0..KNOTS).map(|k| k as f64 / (KNOTS - 1) as f64);
    let knots: Vec<f64> = match over {
        Over::Variable(Variable::Speed) if kind.is_grip() => {
            parts.map(|part| high * part * part).collect()
        }
        Over::Variable(Variable::Speed) => {
            let most = low.abs().max(high.abs());
            let both = parts.map(|part| 2.0 * part - 1.0);
            both.map(|part| most * part * part.abs()).collect()
        }
        Over::Variable(_) | Over::Period(_) => {
            parts.map(|part| low + (high - low) * part).collect()
        }
    };
    Some(knots)
}

/// The knots with points between them.
fn finer(knots: &[f64]) -> Vec<f64> {
    let between = knots.windows(2).flat_map(|pair| {
        let step = (pair[1] - pair[0]) / FINE as f64;
        (0..FINE).map(move |part| pair[0] + step * part as f64)
    });
    between.chain(knots.last().copied()).collect()
}

/// The knot before a value, and the part of the way to the next.
fn between(knots: &[f64], value: f64) -> (usize, f64) {
    let left = knots.partition_point(|&knot| knot <= value);
    let left = left.clamp(1, knots.len() - 1) - 1;
    let part = (value - knots[left]) / (knots[left + 1] - knots[left]);
    (left, part.clamp(0.0, 1.0))
}

/// The force of the effect at each knot: the mean of rows, the nearer the heavier, along a line between their knots. NaN where
/// the records have none.
fn mean_force(runs: &[Along], kind: &Kind, over: Over, knots: &[f64]) -> Vec<f64> {
    // About each knot a line is fitted: a mean alone would round corners of the law.
    let mut sums = vec![[0.0; 5]; knots.len()];
    for run in runs {
        for row in run.rows() {
            let (value, force) = (run.at(row, kind, over), run.force[row]);
            let (left, part) = between(knots, value);
            for (knot, weight) in [(left, 1.0 - part), (left + 1, part)] {
                let x = value - knots[knot];
                let terms = [1.0, x, x * x, force, x * force];
                for (sum, term) in sums[knot].iter_mut().zip(terms) {
                    *sum += weight * term;
                }
            }
        }
    }
    let line = |[n, x, xx, f, xf]: [f64; 5]| {
        let determinant = n * xx - x * x;
        match determinant > 1e-9 * n * xx {
            true => (xx * f - x * xf) / determinant,
            false => f / n,
        }
    };
    sums.into_iter().map(line).collect()
}

/// The force at each knot that the innovations still ask for, with half its 95 % interval; nothing where the records do not
/// show it.
fn asked(
    felt: &Felt,
    runs: &[Along],
    kind: &Kind,
    over: Over,
    knots: &[f64],
    part: f64,
) -> Option<Vec<Option<(f64, f64)>>> {
    let forces = runs.iter().map(|run| {
        let mut lists = vec![vec![0.0; run.time.len()]; knots.len()];
        let parts = (0..run.time.len()).map(|row| between(knots, run.at(row, kind, over)));
        for (row, (left, part)) in parts.enumerate() {
            lists[left][row] = 1.0 - part;
            lists[left + 1][row] = part;
        }
        lists
    });
    let columns = felt.changes(&forces.collect::<Vec<_>>());
    let innovations: Vec<Innovations> = runs.iter().map(|run| run.innovations.clone()).collect();
    let residual = flat(&innovations);
    let squares: Vec<f64> = columns.iter().map(|column| dot(column, column)).collect();
    let most = squares.iter().copied().fold(0.0, f64::max);
    let shown: Vec<usize> = (0..knots.len())
        .filter(|&knot| squares[knot] > part * most)
        .collect();
    let count = shown.len();
    let gram = DMatrix::from_fn(count, count, |i, j| {
        let own = dot(&columns[shown[i]], &columns[shown[j]]);
        own * if i == j { 1.0 + 1e-9 } else { 1.0 }
    });
    let with = shown.iter().map(|&knot| -dot(&columns[knot], &residual));
    let factor = Cholesky::new(gram)?;
    let sizes = factor.solve(&DVector::from_iterator(count, with));
    let covariance = factor.inverse();
    let larger = inflation(&innovations);
    let mut found = vec![None; knots.len()];
    for (number, &knot) in shown.iter().enumerate() {
        let half = TWO_SIDED * (larger * covariance[(number, number)]).sqrt();
        found[knot] = Some((sizes[number], half));
    }
    Some(found)
}
