//! The modes of a model at some values of its parameters: paired with measurements, followed from step to step, and what
//! they leave of the measurement with its derivatives.

use super::{Combination, MeasuredMode, ModeFitError, ModeFitRequest};
use crate::linearize::{About, Linear, linearize_about};
use crate::modes::{NaturalMode, modes};
use crate::pencil::{Eigen, Pencil};
use crate::run::parameters;
use nalgebra::{DMatrix, DVector};

/// The model at some values of its parameters.
pub(super) struct Model {
    pub(super) parameters: Vec<f64>,
    linear: Linear,
    modes: Vec<NaturalMode>,
}

impl Model {
    pub(super) fn of(request: &ModeFitRequest<'_>, values: &[f64]) -> Result<Self, ModeFitError> {
        let mut set = request.set.to_vec();
        set.extend(request.vary.iter().cloned().zip(values.iter().copied()));
        let p = parameters(request.program, request.records, &set);
        let p = p.map_err(ModeFitError::Parameter)?;
        let (program, in_modes) = (request.program, request.in_modes);
        let about = About {
            modes: in_modes,
            open: true,
            ..About::default()
        };
        let linear = linearize_about(program, request.records, &p, &[], about);
        let linear = linear.map_err(ModeFitError::Linearize)?;
        Ok(Self {
            modes: modes(&linear),
            parameters: p,
            linear,
        })
    }

    /// The mode of each measurement: as told, else with the least sum of squares of the logarithms of frequencies, none
    /// crossing another.
    pub(super) fn pair(&self, request: &ModeFitRequest<'_>) -> Result<Vec<usize>, ModeFitError> {
        let (measured, count) = (request.measured, self.modes.len());
        if !request.numbers.is_empty() {
            let known = request.numbers.iter().all(|number| *number < count);
            return match known {
                true => Ok(request.numbers.to_vec()),
                false => Err(ModeFitError::TooFewModes(count)),
            };
        }
        if measured.len() > count {
            return Err(ModeFitError::TooFewModes(count));
        }
        // best[k][m]: the least sum with the first k measurements on the first m modes, and whether the last is on the last.
        let mut best = vec![vec![(f64::INFINITY, false); count + 1]; measured.len() + 1];
        best[0].fill((0.0, false));
        for k in 1..=measured.len() {
            for m in k..=count {
                let apart = (self.modes[m - 1].frequency_hz / measured[k - 1].frequency_hz).ln();
                let here = best[k - 1][m - 1].0 + apart * apart;
                let before = best[k][m - 1].0;
                best[k][m] = if here < before {
                    (here, true)
                } else {
                    (before, false)
                };
            }
        }
        let (mut k, mut m) = (measured.len(), count);
        let mut numbers = vec![0; measured.len()];
        while k > 0 {
            if best[k][m].1 {
                numbers[k - 1] = m - 1;
                k -= 1;
            }
            m -= 1;
        }
        Ok(numbers)
    }

    /// These modes with their derivatives.
    pub(super) fn tracked(
        &self,
        request: &ModeFitRequest<'_>,
        places: &[usize],
        numbers: &[usize],
    ) -> Result<Tracked, ModeFitError> {
        let pencil = Pencil::new(request.program, &self.linear);
        let eigen = numbers.iter().enumerate().map(|(at, &number)| {
            let found = pencil.eigen(self.modes[number].eigenvalue);
            found.ok_or(ModeFitError::Lost(at))
        });
        let eigen = eigen.collect::<Result<Vec<Eigen>, _>>()?;
        Ok(Tracked::new(
            self,
            &pencil,
            request.measured,
            places,
            numbers,
            eigen,
        ))
    }

    /// The modes that those of a step before have become.
    pub(super) fn followed(
        &self,
        request: &ModeFitRequest<'_>,
        places: &[usize],
        before: &Tracked,
    ) -> Result<Tracked, ModeFitError> {
        let pencil = Pencil::new(request.program, &self.linear);
        let all: Vec<Option<Eigen>> = self
            .modes
            .iter()
            .map(|mode| {
                let near = |old: &NaturalMode| {
                    (0.3..3.0).contains(&(mode.frequency_hz / old.frequency_hz))
                };
                let wanted = before.modes.iter().any(near);
                wanted.then(|| pencil.eigen(mode.eigenvalue)).flatten()
            })
            .collect();
        let mut numbers = Vec::new();
        let (mut least, mut lost) = (1.0_f64, 0);
        for (at, old) in before.eigen.iter().enumerate() {
            let overlaps = all.iter().enumerate().filter_map(|(number, new)| {
                let new = new.as_ref().filter(|_| !numbers.contains(&number))?;
                Some((number, pencil.overlap(old, new)))
            });
            let best = overlaps.max_by(|a, b| a.1.total_cmp(&b.1));
            let (number, overlap) = best.ok_or(ModeFitError::Lost(at))?;
            if overlap < least {
                (least, lost) = (overlap, at);
            }
            numbers.push(number);
        }
        let mut tracked = self.tracked(request, places, &numbers)?;
        (tracked.least_overlap, tracked.lost) = (least, lost);
        Ok(tracked)
    }
}

/// How far a damping ratio over the measured one is from it, and the slope of that. It is the relative error from half of the
/// measured one on. Far below, where a relative error hardly changes with a damping, it goes on with the logarithm, and next
/// to zero straight on: a model may grow.
fn damping_apart(part: f64) -> (f64, f64) {
    const NEAR: f64 = 0.5;
    const LEAST: f64 = 1e-4;
    if part >= NEAR {
        return (part - 1.0, 1.0);
    }
    let logarithm = |part: f64| NEAR - 1.0 + NEAR * (part / NEAR).ln();
    let slope = NEAR / part.max(LEAST);
    match part >= LEAST {
        true => (logarithm(part), slope),
        false => (logarithm(LEAST) + slope * (part - LEAST), slope),
    }
}

/// The paired modes at some values, what is left of the measurement, and its derivatives.
#[derive(Clone)]
pub(super) struct Tracked {
    pub(super) modes: Vec<NaturalMode>,
    eigen: Vec<Eigen>,
    /// d ln f / d ln p, a row a mode.
    pub(super) frequency_by: DMatrix<f64>,
    /// Model less measured, relative and over spreads: frequencies, then dampings.
    pub(super) rest: DVector<f64>,
    /// Its derivatives by the logarithms of the parameters.
    by: DMatrix<f64>,
    /// With the modes a step before, the least of all, and which measurement that is.
    pub(super) least_overlap: f64,
    pub(super) lost: usize,
}

impl Tracked {
    fn new(
        model: &Model,
        pencil: &Pencil<'_>,
        measured: &[MeasuredMode],
        places: &[usize],
        numbers: &[usize],
        eigen: Vec<Eigen>,
    ) -> Self {
        let modes: Vec<NaturalMode> = numbers.iter().map(|&number| model.modes[number]).collect();
        let mut frequency_by = DMatrix::zeros(modes.len(), places.len());
        let mut rows: Vec<(f64, Vec<f64>)> = Vec::new();
        let mut dampings: Vec<(f64, Vec<f64>)> = Vec::new();
        for (at, ((mode, eigen), measured)) in modes.iter().zip(&eigen).zip(measured).enumerate() {
            let value = mode.eigenvalue;
            // d ln s: its real part is d ln |s|, its imaginary part the turn of s.
            let logarithms = pencil.derivatives(eigen, places).into_iter().zip(places);
            let logarithms = logarithms.map(|(by, &place)| by / value * model.parameters[place]);
            let logarithms: Vec<_> = logarithms.collect();
            for (column, by) in logarithms.iter().enumerate() {
                frequency_by[(at, column)] = by.re;
            }
            let apart = (mode.frequency_hz / measured.frequency_hz).ln();
            let by = logarithms
                .iter()
                .map(|by| by.re / measured.spread)
                .collect();
            rows.push((apart / measured.spread, by));
            if let Some((ratio, spread)) = measured.damping {
                // zeta = -cos(arg s): d zeta = sin(arg s) d arg s.
                let (apart, change) = damping_apart(mode.damping / ratio);
                let slope = change * value.im / value.norm() / (ratio * spread);
                let by = logarithms.iter().map(|by| slope * by.im).collect();
                dampings.push((apart / spread, by));
            }
        }
        rows.extend(dampings);
        let rest = DVector::from_iterator(rows.len(), rows.iter().map(|row| row.0));
        let by = DMatrix::from_fn(rows.len(), places.len(), |row, column| rows[row].1[column]);
        Self {
            modes,
            eigen,
            frequency_by,
            rest,
            by,
            least_overlap: 1.0,
            lost: 0,
        }
    }

    pub(super) fn squares(&self) -> f64 {
        self.rest.norm_squared()
    }

    /// The step of the logarithms that least squares take along the combinations that are determined.
    pub(super) fn step(&self) -> DVector<f64> {
        let mut step = DVector::zeros(self.by.ncols());
        for combination in self.combinations() {
            if combination.spread < 1.0 {
                let direction = DVector::from_vec(combination.exponents);
                let along = (&self.by * &direction).dot(&self.rest);
                step -= direction * (along * combination.spread * combination.spread);
            }
        }
        step
    }

    pub(super) fn combinations(&self) -> Vec<Combination> {
        let count = self.by.ncols();
        // Rows of zeros where fewer were measured than are varied: nalgebra gives no more directions than rows.
        let square = self
            .by
            .clone()
            .resize(self.by.nrows().max(count), count, 0.0);
        let decomposed = square.svd(false, true);
        let Some(directions) = decomposed.v_t else {
            return Vec::new();
        };
        let values = decomposed.singular_values.iter();
        let pairs = values.zip(directions.row_iter()).map(|(value, row)| {
            // Of either sign the one with the largest exponent positive.
            let largest = row
                .iter()
                .copied()
                .fold(0.0_f64, |a, b| if b.abs() > a.abs() { b } else { a });
            Combination {
                spread: 1.0 / value,
                exponents: row.iter().map(|x| x * largest.signum()).collect(),
            }
        });
        pairs.collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_damping_far_below_the_measured_one_is_as_well_seen_as_one_nearby() {
        // The relative error nearby, as ever.
        assert!((damping_apart(1.2).0 - 0.2).abs() < 1e-12);
        assert!((damping_apart(0.5).0 + 0.5).abs() < 1e-12);
        // A tenth more of the damping is worth about as much, however far it is.
        for part in [0.3, 0.03, 0.003] {
            let gain = damping_apart(1.1 * part).0 - damping_apart(part).0;
            assert!((gain - 0.5 * 1.1_f64.ln()).abs() < 1e-12, "{part}");
        }
        // The slope is that of what it belongs to, also of a model that grows.
        for part in [2.0, 0.5, 0.4, 1e-4, 1e-5, -0.3] {
            let step = 1e-6 * f64::max(f64::abs(part), 1e-4);
            let (low, high) = (damping_apart(part - step).0, damping_apart(part + step).0);
            let slope = damping_apart(part).1;
            assert!(
                ((high - low) / (2.0 * step) / slope - 1.0).abs() < 1e-4,
                "{part}"
            );
        }
    }
}
