//! One response of an experiment: of the linearised model, and as measured on the hybrid one.

use super::measured::Compared;
use crate::refusals::responses as refused;
use hyde_diag::Diagnostic;
use hyde_experiment::{BodeError, Linear, Pole, Poles, SteppedOutput, frequency_response_watched};
use hyde_program::{Bode, Constant, Program};
use hyde_signal::spectrum::FrequencyResponse;
use hyde_sim::Reached;
use hyde_units::{NamedUnit, significant};

/// From an input to one output.
pub struct Response {
    /// The experiment.
    pub experiment: String,
    /// The input.
    pub input: String,
    /// The output, as it is written.
    pub output: String,
    /// The unit of the output, and that of the input if it is known.
    pub units: (NamedUnit, Option<NamedUnit>),
    /// Frequencies of the linearised response in Hz.
    pub frequency: Vec<f64>,
    /// Its real and imaginary parts, SI.
    pub linear: Vec<(f64, f64)>,
    /// Frequencies in Hz and dampings of the modes that swing.
    pub resonances: Vec<(f64, f64)>,
    /// By the sweep of the stimulus.
    pub swept: Option<FrequencyResponse>,
    /// Measured on the machine.
    pub measured: Vec<Compared>,
    /// By stepped sines: frequency, amplitude of the input, what came out.
    pub stepped: Vec<(f64, f64, SteppedOutput)>,
}

/// The band of a response in Hz.
pub fn band(program: &Program, number: usize, p: &[f64]) -> Option<(f64, f64)> {
    let from = program.kernels.constant(Constant::BandFrom(number), p)?;
    let to = program.kernels.constant(Constant::BandTo(number), p)?;
    (from > 0.0 && to > from).then_some((from, to))
}

/// So many frequencies from one end of a band to the other, evenly along their logarithm.
pub fn frequencies(band: (f64, f64), count: usize) -> Vec<f64> {
    let count = count.max(2);
    let at = |k: usize| band.0 * (band.1 / band.0).powf(k as f64 / (count - 1) as f64);
    (0..count).map(at).collect()
}

/// The linearised responses of an experiment's request, one an output; why there are none, where there are not.
pub fn linearised(
    experiment: &str,
    program: &Program,
    (bode, frequency): (&Bode, &[f64]),
    (system, poles): (&Linear, &Poles),
    reached: &Reached,
) -> Result<Vec<Response>, String> {
    let outputs: Vec<usize> = bode.outputs.iter().map(|(_, output)| *output).collect();
    let all = frequency_response_watched(system, 0, &outputs, frequency, reached);
    let all = all.map_err(|error| match error {
        BodeError::AboveNyquist(f, limit) => format!(
            "{} Hz is above half the sampling rate, {} Hz: the sampled loop has no response there",
            significant(f, 3),
            significant(limit, 3)
        ),
        BodeError::Singular(f) => format!("the system is singular at {} Hz", significant(f, 3)),
    })?;
    let resonances = resonances(system, poles, frequency);
    let mut parameters = program.parameters.iter();
    let of_input = parameters.find(|parameter| parameter.name == bode.input);
    let of_input = of_input.map(|parameter| parameter.unit.clone());
    let responses = bode
        .outputs
        .iter()
        .zip(all)
        .map(|((name, output), response)| Response {
            experiment: experiment.to_owned(),
            input: bode.input.clone(),
            output: name.clone(),
            units: (program.outputs[*output].unit.clone(), of_input.clone()),
            frequency: frequency.to_vec(),
            linear: response
                .into_iter()
                .map(|value| (value.re, value.im))
                .collect(),
            resonances: resonances.clone(),
            swept: None,
            measured: Vec::new(),
            stepped: Vec::new(),
        });
    Ok(responses.collect())
}

/// The equations differentiate the input, of which the linearised system knows the value alone.
pub fn no_rate(bode: &Bode) -> Diagnostic {
    refused::response_needs_derivative(&bode.input, bode.origin.span)
}

/// The modes that swing, from an octave below the band to its end: with clocks those of the closed loop.
fn resonances(system: &Linear, poles: &Poles, frequency: &[f64]) -> Vec<(f64, f64)> {
    let (Some(from), Some(to)) = (frequency.first(), frequency.last()) else {
        return Vec::new();
    };
    let swings = |pole: &Pole| {
        let mode = pole.mode();
        mode.damping < 0.3 && (0.5 * from..=*to).contains(&mode.frequency_hz)
    };
    let found = poles.oscillating().into_iter().filter(swings);
    let found = found.filter(|pole| poles.states(system, pole).is_some());
    found
        .map(|pole| (pole.mode().frequency_hz, pole.mode().damping))
        .collect()
}
