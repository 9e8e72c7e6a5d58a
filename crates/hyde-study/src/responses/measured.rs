//! Measured frequency responses beside those of the model.

use crate::refusals::responses as refused;
use hyde_diag::Diagnostic;
use hyde_experiment::{
    Linear, MeasuredCurve, Run, curve_of_run, frequency_response, measured_curve,
};
use hyde_program::{Constant, MeasuredResponse, Program};
use hyde_signal::Table;
use hyde_signal::spectrum::Complex;
use std::collections::BTreeMap;

/// A measured response, and what the model has at its lines.
pub struct Compared {
    /// Its name.
    pub name: String,
    /// Number of the `bode`, and of its output.
    pub place: (usize, usize),
    /// What was measured.
    pub measured: MeasuredCurve,
    /// The linearised response at its lines.
    pub linear: Vec<Complex<f64>>,
    /// That of the run, if the run was driven by what was measured.
    pub run: Option<MeasuredCurve>,
    /// Its number among the measured responses of the experiment.
    pub number: usize,
}

/// All measured responses of an experiment, those of a `bode` with a band within it.
pub fn curves(
    program: &Program,
    tables: &BTreeMap<String, Table>,
    p: &[f64],
) -> Result<Vec<MeasuredCurve>, Box<Diagnostic>> {
    let skip_s = program.kernels.constant(Constant::Skip, p).unwrap_or(0.0);
    let of = |measured: &MeasuredResponse| {
        let curve = measured_curve(measured, tables, skip_s).map_err(|error| {
            let (why, span) = (error.cause.to_string(), measured.origin.span);
            Box::new(refused::cannot_compare_response(&error.channel, &why, span))
        })?;
        Ok(match super::response::band(program, measured.place.0, p) {
            Some((from, to)) => curve.between(from, to),
            None => curve,
        })
    };
    program
        .experiment
        .measured_responses
        .iter()
        .map(of)
        .collect()
}

/// From the lowest to the highest line measured of a `bode`.
pub fn band(program: &Program, number: usize, curves: &[MeasuredCurve]) -> Option<(f64, f64)> {
    let responses = &program.experiment.measured_responses;
    let own = responses
        .iter()
        .zip(curves)
        .filter(|(m, _)| m.place.0 == number);
    let ends = own
        .filter_map(|(_, curve)| Some((*curve.frequency_hz.first()?, *curve.frequency_hz.last()?)));
    ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        .filter(|(from, to)| from < to)
}

/// What was measured of a `bode` beside its linearised system and the run.
pub fn compared(
    program: &Program,
    number: usize,
    curves: &[MeasuredCurve],
    system: &Linear,
    tables: &BTreeMap<String, Table>,
    run: Option<(&Program, &Run)>,
) -> Vec<Compared> {
    let responses = program.experiment.measured_responses.iter().enumerate();
    let own = responses
        .zip(curves)
        .filter(|((_, m), _)| m.place.0 == number);
    own.filter_map(|((at, response), measured)| {
        let output = program.experiment.bodes[number].outputs[response.place.1].1;
        let linear = frequency_response(system, 0, &[output], &measured.frequency_hz).ok()?;
        let run = run.and_then(|(program, run)| {
            let response = program.experiment.measured_responses.get(at)?;
            let skip = program.kernels.constant(Constant::Skip, &run.parameters);
            let skip_s = skip.unwrap_or(0.0);
            let curve = curve_of_run(program, response, tables, &run.results, skip_s)?;
            let (first, last) = (
                measured.frequency_hz.first()?,
                measured.frequency_hz.last()?,
            );
            let curve = curve.between(*first, *last);
            (curve.frequency_hz == measured.frequency_hz).then_some(curve)
        });
        Some(Compared {
            number: at,
            name: response.name.clone(),
            place: response.place,
            measured: measured.clone(),
            linear: linear.into_iter().next()?,
            run,
        })
    })
    .collect()
}

impl Compared {
    /// The error of the linearised response in percent.
    #[must_use]
    pub fn error_percent(&self) -> f64 {
        self.measured.error_percent(&self.linear)
    }

    /// Whether the run was driven by what was measured.
    pub fn has_run(&self) -> bool {
        self.run.is_some()
    }
}
