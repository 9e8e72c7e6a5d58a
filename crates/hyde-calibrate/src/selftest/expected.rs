//! What a planted effect gains at best: the part of the innovations that it makes and no parameter answers to.
//!
//! Innovations of the nominal model with the effect differ by d from those without; of d'd the parameters answer to a part
//! ([`Projection`]), and the rest is the noncentrality G of the gain: a search that tried the very effect at its very size
//! would gain G on average, with the deviation 2*sqrt(G) (noncentral chi squared; Johnson, Kotz and Balakrishnan,
//! Continuous Univariate Distributions 2, 1995, ch. 29). An effect is said to show where that passes the gate in 39 of 40
//! sets of noise: `G - 4*sqrt(G) >= gate`.

use crate::diagnosis::{
    Author, Built, Gates, Ground, Hypothesis, Projection, Stage, Thresholds, flat,
};
use crate::fit::{Objective, Slopes, Varied};
use crate::observer::{Innovations, Observer};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use nalgebra::DVector;

/// Halvings of a range of sizes in which the size that shows is looked for, and steps of bisection then.
const HALVINGS: i32 = 24;
const BISECTIONS: usize = 6;
/// Nodes that a search tries, about: for gates before there was one.
const NODES: usize = 2000;

/// An axis without any effect, linearised at its nominal values.
pub(super) struct Reference {
    recordings: Vec<Recording>,
    observer: Observer,
    projection: Projection,
    set: Vec<(String, f64)>,
    gates: Gates,
}

impl Reference {
    /// Of recordings with nothing planted in them.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub(super) fn new(
        program: &Program,
        recordings: Vec<Recording>,
        varied: &[Varied],
        set: &[(String, f64)],
    ) -> Result<Self, Unsupported> {
        let places: Vec<(usize, f64)> = set
            .iter()
            .filter_map(|(name, value)| {
                let (parameter, element) = program.parameter(name)?;
                (!parameter.structural).then_some((parameter.place + element, *value))
            })
            .collect();
        let observer = Observer::new(program, &recordings, &places)?;
        let thresholds = Thresholds::default();
        let ground = Ground {
            recordings: &recordings,
            observer: &observer,
            set,
            thresholds: &thresholds,
        };
        let start: Vec<f64> = varied.iter().map(|varied| varied.nominal).collect();
        let solution =
            ground
                .problem(program, varied, &places, None)
                .solve_in(&start, 0, Slopes::Tangents)?;
        let stage = Stage {
            program: program.clone(),
            effects: Vec::new(),
            varied: varied.to_vec(),
            kept: Vec::new(),
            solution,
        };
        let tracks = stage.tracks(&ground)?;
        let projection = Projection::of(&stage, &tracks, &ground)?;
        let projection = projection.ok_or_else(Unsupported::singular)?;
        drop(tracks);
        let innovations = projection.innovations.len();
        Ok(Self {
            gates: Gates {
                tried: NODES,
                innovations,
                left: 0.0,
                thresholds,
            },
            recordings,
            observer,
            projection,
            set: set.to_vec(),
        })
    }

    /// An effect on the model, to ask what it gains; `None` where the model with it cannot be observed.
    pub(super) fn effect<'r>(
        &'r self,
        hypothesis: &'r Hypothesis,
        number: usize,
        shapes: &'r [f64],
        author: &Author<'_>,
    ) -> Option<Effect<'r>> {
        let Built { program, paths } = author(&[number], &[])?;
        let path = paths.last()?;
        let effect = Effect {
            sizes: Hypothesis::names(&hypothesis.sizes, path),
            shapes: Hypothesis::names(&hypothesis.shapes, path)
                .into_iter()
                .zip(shapes.iter().copied())
                .collect(),
            plain: Vec::new(),
            program,
            reference: self,
            hypothesis,
        };
        let plain = effect.innovations(&vec![0.0; hypothesis.sizes.len()])?;
        Some(Effect { plain, ..effect })
    }

    pub(super) fn projection(&self) -> &Projection {
        &self.projection
    }

    /// The deviation of a channel's noise and rounding, SI.
    pub(super) fn noise(&self, channel: usize) -> f64 {
        self.observer.noise.get(channel).copied().unwrap_or(0.0)
    }

    /// What a gain has to reach for the effect to be claimed.
    pub(super) fn gate(&self, hypothesis: &Hypothesis) -> f64 {
        let freedoms = hypothesis.sizes.len() + hypothesis.shapes.len();
        self.gates.gain(freedoms).max(self.gates.material())
    }
}

/// Whether an expected gain passes a gate in 39 of 40 sets of noise.
pub(super) fn shows(gain: f64, gate: f64) -> bool {
    gain - 4.0 * gain.max(0.0).sqrt() >= gate
}

/// An effect with its shapes on the reference.
pub(super) struct Effect<'r> {
    program: Program,
    reference: &'r Reference,
    hypothesis: &'r Hypothesis,
    sizes: Vec<String>,
    shapes: Vec<(String, f64)>,
    plain: Vec<f64>,
}

impl Effect<'_> {
    /// The change of innovations by some sizes.
    pub(super) fn change(&self, sizes: &[f64]) -> Option<DVector<f64>> {
        let with = self.innovations(sizes)?;
        let differences = with.iter().zip(&self.plain).map(|(a, b)| a - b);
        Some(DVector::from_iterator(with.len(), differences))
    }

    /// What it gains at some sizes.
    pub(super) fn gain(&self, sizes: &[f64]) -> Option<f64> {
        let change = self.change(sizes)?;
        let back = -&change;
        let projection = &self.reference.projection;
        // Put on and taken off the innovations the noise counts with either sign.
        let gain = |change| projection.answered(change).0;
        Some(-0.5 * (gain(&change) + gain(&back)))
    }

    /// The part of sizes at which they begin to show, at most 1; `None` if all of them does not.
    pub(super) fn detectable(&self, sizes: &[f64]) -> Option<f64> {
        let gate = self.reference.gate(self.hypothesis);
        let seen = |part: f64| {
            let sizes: Vec<f64> = sizes.iter().map(|size| part * size).collect();
            self.gain(&sizes).is_some_and(|gain| shows(gain, gate))
        };
        if !seen(1.0) {
            return None;
        }
        let hidden = (1..HALVINGS).find(|&k| !seen(0.5_f64.powi(k)))?;
        let (mut low, mut high) = (0.5_f64.powi(hidden), 0.5_f64.powi(hidden - 1));
        for _ in 0..BISECTIONS {
            let middle = (low * high).sqrt();
            if seen(middle) {
                high = middle
            } else {
                low = middle
            }
        }
        Some(high)
    }

    fn innovations(&self, sizes: &[f64]) -> Option<Vec<f64>> {
        let reference = self.reference;
        let own = self.sizes.iter().cloned().zip(sizes.iter().copied());
        let values: Vec<(String, f64)> = own.chain(self.shapes.iter().cloned()).collect();
        let ground = Ground {
            recordings: &reference.recordings,
            observer: &reference.observer,
            set: &reference.set,
            thresholds: &reference.gates.thresholds,
        };
        let set = ground.set_in(&self.program, &values);
        let of =
            |recording| Innovations::of(&self.program, recording, &reference.observer, &set).ok();
        let each: Option<Vec<Innovations>> = reference.recordings.iter().map(of).collect();
        Some(flat(&each?))
    }
}

/// The largest of a pair's or a list's sizes, as reports tell it: of a sine and a cosine their amplitude.
pub(super) fn size_of(hypothesis: &Hypothesis, sizes: &[f64]) -> f64 {
    match sizes {
        [sine, cosine] if hypothesis.is_pair() => sine.hypot(*cosine),
        [first, ..] => *first,
        [] => 0.0,
    }
}
