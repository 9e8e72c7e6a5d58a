//! [`try_case`]: simulates a case, diagnoses it, and says what was found for what was planted.

use super::case::{Case, Planting, Size};
use super::designed::{Designed, Designer, ambiguous, designed};
use super::expected::{Reference, shows, size_of};
use super::separation::Point;
use super::simulated::{Faulty, Simulated, simulated};
use crate::diagnosis::{
    Author, Built, Hypothesis, Inquiry, Relation, Site, Thresholds, Verdict, Written, diagnose,
};
use crate::fit::Varied;
use crate::observer::Observer;
use crate::plant::Unsupported;
use crate::records::{RecordError, Recording};
use hyde_experiment::Options;
use hyde_ir::LawShape;
use hyde_program::Program;
use hyde_signal::Table;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The records of one run, by the name that the experiment gives each.
pub(super) type Records = BTreeMap<String, Table>;
/// A table for each of the records to fit, and which of them is to be replaced.
type Simulate<'a> = dyn Fn(&[usize], &[f64], &[f64]) -> Option<Built> + Sync + 'a;

/// An axis with its records, its diagnosis, and how programs of it are made.
pub struct Axis<'a> {
    /// The observed form of the model as declared.
    pub program: &'a Program,
    /// The records to fit: stimuli are taken from them.
    pub records: &'a [Records],
    /// What calibration varies.
    pub varied: &'a [Varied],
    /// Values set from outside, by name, SI.
    pub set: &'a [(String, f64)],
    /// Every effect at every site.
    pub hypotheses: &'a [Hypothesis],
    /// Where a law that no effect is may act.
    pub sites: &'a [Site],
    /// The shapes that a law may be made of.
    pub shapes: &'a [Arc<LawShape>],
    /// Puts hypotheses and written effects on the observed form.
    pub author: &'a Author<'a>,
    /// Puts hypotheses on the recorded form; sizes and shapes of the last of them may shape the equations.
    pub simulate: &'a Simulate<'a>,
    /// How many effects a diagnosis claims at most.
    pub max_effects: usize,
    /// What decides in a diagnosis: those of the method as long as none are set.
    pub thresholds: Thresholds,
    /// Designs a record for what a verdict `one of` cannot distinguish, if that is wanted.
    pub designer: Option<&'a Designer<'a>>,
    /// What random numbers begin with.
    pub seed: u64,
    /// Set from outside to end the work.
    pub interrupted: Arc<AtomicBool>,
    reference: Reference,
}

/// Why a case has no outcome.
#[derive(Clone, Debug)]
pub enum SelftestError {
    /// Somebody asked to stop.
    Interrupted,
    /// The axis cannot be simulated.
    Simulation(Simulated),
    /// The model with the effect cannot be made, or cannot be observed.
    Model,
    /// What was simulated cannot be observed.
    Record(RecordError),
    /// The model has no fixed-step form.
    Unsupported(Unsupported),
}

/// An effect that a diagnosis claims, and those that it cannot tell from it; hypotheses by number.
#[derive(Clone, Debug, PartialEq)]
pub struct Claim {
    /// The hypothesis; `None` where a law is claimed that no known effect is.
    pub hypothesis: Option<usize>,
    /// Those that the records cannot tell from it, and what each is beside it.
    pub alternatives: Vec<(usize, Relation)>,
    /// Its size, SI, and the 95 % interval.
    pub size: f64,
    /// Its 95 % interval.
    pub interval: (f64, f64),
}

/// What was planted, what it should gain, what was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// Sizes and shapes planted, SI.
    pub planted: (Vec<f64>, Vec<f64>),
    /// The planted size as reports tell it: of a sine and a cosine their amplitude.
    pub size: f64,
    /// The size at which the effect begins to show on this axis, where all of its range shows.
    pub detectable: Option<f64>,
    /// What the planted effect gains at best, on average, and the gate of a claim.
    pub expected: Option<(f64, f64)>,
    /// The verdict.
    pub verdict: Verdict,
    /// What is claimed, in the order found.
    pub claims: Vec<Claim>,
    /// Something is left that no effect explains.
    pub unexplained: bool,
    /// What became of a verdict `one of` of a planted effect with a designed record, if that was wanted.
    pub designed: Option<Designed>,
    /// The search did not know the effect, and claims one that records cannot tell from it, nor would more of them.
    pub equivalent: bool,
}

impl Outcome {
    /// Whether the planted effect should be found: it shows.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        self.expected.is_some_and(|(gain, gate)| shows(gain, gate))
    }

    /// Whether it is the right answer: the effect planted where one was, with another one at most as its equal; no effect that
    /// is known where the search did not know it, or that something is left beside it; else nothing. A law of one's own is
    /// what an unknown effect asks for.
    #[must_use]
    pub fn is_right(&self, planted: &Planting) -> bool {
        match *planted {
            Planting::Planted(number, _) => self.names(number),
            Planting::Empty | Planting::Parameter(_) => self.verdict == Verdict::None,
            Planting::Sensor(..) => self.claims.is_empty(),
            Planting::OpenSet(..) => {
                let mut claims = self.claims.iter();
                let claims_known = claims.any(|claim| claim.hypothesis.is_some());
                !claims_known || self.unexplained || self.equivalent
            }
        }
    }

    /// Whether the first claim is the hypothesis, or one of those it cannot be told from.
    #[must_use]
    pub fn names(&self, hypothesis: usize) -> bool {
        let first = self.claims.first();
        first.is_some_and(|claim| {
            let mut others = claim.alternatives.iter();
            claim.hypothesis == Some(hypothesis) || others.any(|(own, _)| *own == hypothesis)
        })
    }
}

impl Claim {
    /// Those that the records cannot tell from it and that are in a relation to it.
    pub fn related(&self, relation: Relation) -> impl Iterator<Item = usize> {
        let all = self.alternatives.iter();
        all.filter(move |(_, own)| *own == relation)
            .map(|(own, _)| *own)
    }

    /// Whether it names a hypothesis and no other answer.
    #[must_use]
    pub fn is_alone(&self, hypothesis: usize) -> bool {
        let is_it = self.hypothesis == Some(hypothesis);
        let no_other = self.related(Relation::Another).next().is_none();
        no_other && (is_it || self.related(Relation::Joined).any(|own| own == hypothesis))
    }
}

impl<'a> Axis<'a> {
    /// An axis; records with nothing planted in them are simulated and linearised.
    ///
    /// # Errors
    /// The axis cannot be simulated or observed.
    #[allow(clippy::too_many_arguments, reason = "an axis is all of these")]
    pub fn new(
        program: &'a Program,
        records: &'a [Records],
        varied: &'a [Varied],
        set: &'a [(String, f64)],
        hypotheses: &'a [Hypothesis],
        laws: (&'a [Site], &'a [Arc<LawShape>], &'a Author<'a>),
        simulate: &'a Simulate<'a>,
        max_effects: usize,
        seed: u64,
        interrupted: Arc<AtomicBool>,
    ) -> Result<Self, SelftestError> {
        let built = simulate(&[], &[], &[]).ok_or(SelftestError::Model)?;
        let options = Options {
            set: set.to_vec(),
            interrupted: Arc::clone(&interrupted),
            ..Options::default()
        };
        let recordings = recordings(program, records, &places(program, set), |tables, number| {
            let purpose = format!("reference {number}");
            simulated(&built.program, tables, &options, None, seed, &purpose)
        });
        let recordings = recordings.map_err(|error| stopped(error, &interrupted))?;
        let reference =
            Reference::new(program, recordings, varied, set).map_err(SelftestError::Unsupported)?;
        Ok(Self {
            program,
            records,
            varied,
            set,
            hypotheses,
            sites: laws.0,
            shapes: laws.1,
            author: laws.2,
            simulate,
            max_effects,
            thresholds: Thresholds::default(),
            designer: None,
            seed,
            interrupted,
            reference,
        })
    }
}

/// Simulates and diagnoses a case.
///
/// # Errors
/// See [`SelftestError`].
pub fn try_case(axis: &Axis<'_>, case: &Case) -> Result<Outcome, SelftestError> {
    if axis.interrupted.load(Ordering::Relaxed) {
        return Err(SelftestError::Interrupted);
    }
    let planted = planted(axis, case)?;
    let made = tables(axis, case, &planted, axis.records, 0)?;
    let found = judged(axis, case, &made)?;
    let equivalent = match case.kind {
        Planting::OpenSet(number, size) => {
            is_equivalent(axis, case, (number, size), &made, &found)?
        }
        Planting::Planted(..) | Planting::Empty | Planting::Parameter(_) | Planting::Sensor(..) => {
            false
        }
    };
    let is_planted = matches!(case.kind, Planting::Planted(..));
    let designer = axis.designer;
    let designer = designer.filter(|_| is_planted && found.verdict == Verdict::OneOf);
    let designed = designer
        .map(|designer| designed(axis, designer, case, &planted, made, &found.ambiguous))
        .transpose()?;
    Ok(Outcome {
        size: planted.size,
        detectable: planted.detectable,
        expected: planted.expected,
        planted: (planted.sizes, planted.shapes),
        verdict: found.verdict,
        claims: found.claims,
        unexplained: found.unexplained,
        designed,
        equivalent,
    })
}

/// Whether a search that knows all effects names the one withheld, and says that the one claimed without it is no other
/// answer: it repeats it with more constants, or its place moves with it.
fn is_equivalent(
    axis: &Axis<'_>,
    case: &Case,
    (number, size): (usize, Size),
    made: &[Records],
    found: &Judged,
) -> Result<bool, SelftestError> {
    let [
        Claim {
            hypothesis: Some(claimed),
            ..
        },
    ] = found.claims.as_slice()
    else {
        return Ok(false);
    };
    if found.unexplained {
        return Ok(false);
    }
    let known = Case {
        kind: Planting::Planted(number, size),
        ..case.clone()
    };
    let full = judged(axis, &known, made)?;
    let first = full
        .claims
        .first()
        .filter(|own| own.hypothesis == Some(number));
    let mut others = first.into_iter().flat_map(|own| &own.alternatives);
    Ok(others.any(|(other, relation)| other == claimed && *relation != Relation::Another))
}

/// What a diagnosis of a case found.
pub(super) struct Judged {
    pub(super) verdict: Verdict,
    pub(super) claims: Vec<Claim>,
    unexplained: bool,
    /// What the records cannot distinguish.
    ambiguous: Vec<Point>,
}

/// Diagnoses the records of a case.
pub(super) fn judged(
    axis: &Axis<'_>,
    case: &Case,
    made: &[Records],
) -> Result<Judged, SelftestError> {
    let places = places(axis.program, axis.set);
    let recordings = recordings(axis.program, made, &places, |tables, _| Ok(tables.clone()))?;
    let observer =
        Observer::new(axis.program, &recordings, &places).map_err(SelftestError::Unsupported)?;
    // An effect that the search does not know takes all its sites with it.
    let withheld = match case.kind {
        Planting::OpenSet(number, _) => Some(axis.hypotheses[number].effect.as_str()),
        Planting::Planted(..) | Planting::Empty | Planting::Parameter(_) | Planting::Sensor(..) => {
            None
        }
    };
    let known: Vec<usize> = (0..axis.hypotheses.len())
        .filter(|&number| withheld != Some(axis.hypotheses[number].effect.as_str()))
        .collect();
    let hypotheses: Vec<Hypothesis> = known
        .iter()
        .map(|&number| axis.hypotheses[number].clone())
        .collect();
    let author = |numbers: &[usize], written: &[Written]| {
        let numbers: Vec<usize> = numbers.iter().map(|&number| known[number]).collect();
        (axis.author)(&numbers, written)
    };
    let inquiry = Inquiry {
        recordings: &recordings,
        observer: &observer,
        varied: axis.varied,
        set: axis.set,
        hypotheses: &hypotheses,
        sites: axis.sites,
        shapes: axis.shapes,
        author: &author,
        max_effects: axis.max_effects,
        barred: &[],
        thresholds: &axis.thresholds,
    };
    let found = diagnose(&inquiry).map_err(SelftestError::Unsupported)?;
    if axis.interrupted.load(Ordering::Relaxed) {
        return Err(SelftestError::Interrupted);
    }
    let claims = found.findings.iter().map(|finding| Claim {
        hypothesis: known.get(finding.hypothesis).copied(),
        alternatives: finding
            .alternatives
            .iter()
            .filter_map(|other| Some((*known.get(other.hypothesis)?, other.relation)))
            .collect(),
        size: finding.size.value,
        interval: finding.size.interval,
    });
    let ambiguous = ambiguous(&found, &hypotheses).into_iter().map(|own| Point {
        hypothesis: known[own.hypothesis],
        ..own
    });
    Ok(Judged {
        verdict: found.verdict,
        claims: claims.collect(),
        ambiguous: ambiguous.collect(),
        unexplained: found.unexplained,
    })
}

/// What records become where a case is planted: those to fit first, as its diagnosis reads them.
///
/// # Errors
/// See [`SelftestError`].
pub fn tables_of(
    axis: &Axis<'_>,
    case: &Case,
    records: &[Records],
) -> Result<Vec<Records>, SelftestError> {
    let planted = planted(axis, case)?;
    tables(axis, case, &planted, records, 0)
}

/// An effect as a case plants it.
#[derive(Default)]
pub(super) struct Planted {
    number: Option<usize>,
    sizes: Vec<f64>,
    shapes: Vec<f64>,
    size: f64,
    detectable: Option<f64>,
    expected: Option<(f64, f64)>,
}

fn planted(axis: &Axis<'_>, case: &Case) -> Result<Planted, SelftestError> {
    let (number, size) = match case.kind {
        Planting::Planted(number, size) | Planting::OpenSet(number, size) => (number, size),
        Planting::Empty | Planting::Parameter(_) | Planting::Sensor(..) => {
            return Ok(Planted::default());
        }
    };
    let hypothesis = &axis.hypotheses[number];
    let (whole, shapes) = case.direction(axis.seed, hypothesis);
    let reference = &axis.reference;
    let effect = reference
        .effect(hypothesis, number, &shapes, axis.author)
        .ok_or(SelftestError::Model)?;
    let detectable = effect.detectable(&whole);
    let part = match size {
        Size::Part(part) => part,
        // What never shows is planted as large as it gets.
        Size::Detectable(times) => (times * detectable.unwrap_or(1.0)).min(1.0),
    };
    let sizes: Vec<f64> = whole.iter().map(|size| part * size).collect();
    let expected = effect
        .gain(&sizes)
        .map(|gain| (gain, reference.gate(hypothesis)));
    Ok(Planted {
        number: Some(number),
        size: size_of(hypothesis, &sizes),
        detectable: detectable.map(|part| part * size_of(hypothesis, &whole).abs()),
        sizes,
        shapes,
        expected,
    })
}

/// What records become on the axis of a case; the first has the number `first`, which decides its noise.
pub(super) fn tables(
    axis: &Axis<'_>,
    case: &Case,
    planted: &Planted,
    records: &[Records],
    first: usize,
) -> Result<Vec<Records>, SelftestError> {
    let list: Vec<usize> = planted.number.into_iter().collect();
    let Built { program, paths } =
        (axis.simulate)(&list, &planted.sizes, &planted.shapes).ok_or(SelftestError::Model)?;
    let mut set = axis.set.to_vec();
    set.extend(case.parameters(axis.seed, axis.varied));
    if let (Some(number), Some(path)) = (planted.number, paths.last()) {
        let hypothesis = &axis.hypotheses[number];
        let sizes = Hypothesis::names(&hypothesis.sizes, path);
        let shapes = Hypothesis::names(&hypothesis.shapes, path);
        set.extend(sizes.into_iter().zip(planted.sizes.iter().copied()));
        set.extend(shapes.into_iter().zip(planted.shapes.iter().copied()));
    }
    let options = Options {
        set,
        interrupted: Arc::clone(&axis.interrupted),
        ..Options::default()
    };
    let faulty = match case.kind {
        Planting::Sensor(channel, fault) => Some(Faulty {
            channel,
            fault,
            deviation: axis.reference.noise(channel),
        }),
        Planting::Planted(..)
        | Planting::Empty
        | Planting::Parameter(_)
        | Planting::OpenSet(..) => None,
    };
    let made = records.iter().enumerate().map(|(number, tables)| {
        let purpose = format!("{} / record {}", case.key, first + number);
        simulated(&program, tables, &options, faulty, axis.seed, &purpose)
            .map_err(|error| stopped(SelftestError::Simulation(error), &axis.interrupted))
    });
    made.collect()
}

/// The places of what is set from outside in a program, with its values.
fn places(program: &Program, set: &[(String, f64)]) -> Vec<(usize, f64)> {
    let place = |(name, value): &(String, f64)| {
        let (parameter, element) = program.parameter(name)?;
        (!parameter.structural).then_some((parameter.place + element, *value))
    };
    set.iter().filter_map(place).collect()
}

fn recordings(
    program: &Program,
    records: &[Records],
    set: &[(usize, f64)],
    mut make: impl FnMut(&Records, usize) -> Result<Records, Simulated>,
) -> Result<Vec<Recording>, SelftestError> {
    let each = records.iter().enumerate().map(|(number, tables)| {
        let made = make(tables, number).map_err(SelftestError::Simulation)?;
        Recording::new(&format!("record {}", number + 1), program, made, set)
            .map_err(SelftestError::Record)
    });
    each.collect()
}

/// A run that was told to end is no failure of the axis.
fn stopped(error: SelftestError, interrupted: &AtomicBool) -> SelftestError {
    match error {
        SelftestError::Simulation(_) if interrupted.load(Ordering::Relaxed) => {
            SelftestError::Interrupted
        }
        SelftestError::Simulation(_)
        | SelftestError::Interrupted
        | SelftestError::Model
        | SelftestError::Record(_)
        | SelftestError::Unsupported(_) => error,
    }
}
