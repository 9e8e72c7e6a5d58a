//! Measured frequency responses against the models that made them up.

use hyde_compiler::Backend;
use hyde_experiment::{
    Linear, MeasuredCurve, Options, curve_of_run, frequency_response, linearize, measured_curve,
    parameters,
};
use hyde_program::{Constant, Program};
use hyde_signal::Table;
use hyde_tests::Example;
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// An experiment compiled with free inputs, and its records.
struct Case {
    program: Program,
    tables: BTreeMap<String, Table>,
    linear: Linear,
}

impl Case {
    fn of(example: &Example) -> Self {
        let free = example.clone().free_inputs();
        let program = free.compile(Backend::Native).unwrap().program;
        let tables = example.parse().unwrap().tables;
        let p = parameters(&program, &tables, &[]).unwrap();
        let input = [program.experiment.bodes[0].input.clone()];
        let linear = linearize(&program, &tables, &p, &input, &[]).unwrap();
        Self {
            program,
            tables,
            linear,
        }
    }

    /// The measured response of that number, and the error of the linearised model in percent.
    fn measured(&self, number: usize) -> (MeasuredCurve, f64) {
        let measured = &self.program.experiment.measured_responses[number];
        let p = parameters(&self.program, &self.tables, &[]).unwrap();
        let skip = self.program.kernels.constant(Constant::Skip, &p);
        let curve = measured_curve(measured, &self.tables, skip.unwrap_or(0.0)).unwrap();
        let bode = &self.program.experiment.bodes[measured.place.0];
        let output = bode.outputs[measured.place.1].1;
        let model = frequency_response(&self.linear, 0, &[output], &curve.frequency_hz).unwrap();
        let error = curve.error_percent(&model[0]);
        (curve, error)
    }
}

fn two_mass(experiment: &str, record: &str) -> Example {
    Example::load("examples/two_mass/two_mass.hyde", Some(experiment))
        .unwrap()
        .record(record, format!("tests/records/two_mass.{record}.csv"))
}

#[test]
fn a_record_over_frequency_is_what_the_model_has() {
    let case = Case::of(&two_mass("published", "frf"));
    for number in 0..2 {
        let (curve, error) = case.measured(number);
        assert_eq!(curve.frequency_hz.len(), 25);
        // Eight digits are in the record.
        assert!(error < 1e-5, "{error}");
        assert!((curve.noise_percent().unwrap() - 1.0).abs() < 1e-5);
        assert_eq!(curve.time_error_percent(&curve.response), None);
    }
}

#[test]
fn a_record_over_time_gives_the_response_at_its_lines() {
    let case = Case::of(&two_mass("multisine", "file"));
    for number in 0..2 {
        let (curve, error) = case.measured(number);
        let (periods, period_s) = curve.periods.unwrap();
        assert_eq!(periods, 3);
        assert!((period_s - 0.2).abs() < 1e-9);
        let lines: Vec<f64> = curve.frequency_hz.iter().map(|f| f.round()).collect();
        let expected: Vec<f64> = (3..18).map(|k| f64::from(5 * k)).collect();
        assert_eq!(lines, expected);
        // Eight digits of an angle are in the record, and the smallest line is a thousandth of it.
        assert!(error < 1e-3, "{error}");
        assert!(curve.time_error_percent(&curve.response).unwrap() < 1e-12);
    }
}

/// Between rows the input is a straight line: at each line the run has sinc^2 of what a sine would have (the spectrum of
/// a first-order hold), and what remains of the transient in the first of three periods.
#[test]
fn the_run_has_the_response_of_its_input_read_linearly() {
    let example = two_mass("multisine", "file");
    let case = Case::of(&example);
    let (compiled, run) = example.run_with(&Options::default()).unwrap();
    for number in 0..2 {
        let (measured, _) = case.measured(number);
        let program = &compiled.program;
        let response = &program.experiment.measured_responses[number];
        let found = curve_of_run(program, response, &case.tables, &run.results, 1.0).unwrap();
        assert_eq!(found.frequency_hz, measured.frequency_hz);
        let peak = measured.response.iter().map(|g| g.norm());
        let peak = peak.fold(0.0, f64::max);
        for (at, f) in found.frequency_hz.iter().enumerate() {
            let turn = PI * f / 500.0;
            let held = (turn.sin() / turn).powi(2);
            let expected = measured.response[at] * held;
            // The vibration of the start at 76 Hz has exp(-9) = 1e-4 of itself left at 1 s.
            let bound = 1e-3 * expected.norm() + 1e-4 * peak;
            let off = (found.response[at] - expected).norm();
            assert!(off < bound, "{f} Hz: {off} of {}", expected.norm());
        }
    }
}

#[test]
fn gain_and_phase_with_units_and_factors_are_a_response_too() {
    let case = Case::of(&Example::load("tests/models/lag.hyde", Some("polar")).unwrap());
    let (curve, error) = case.measured(0);
    // The record is 10 % too large: 1 - 1/1.1.
    assert!((error - 100.0 / 11.0).abs() < 1e-5, "{error}");
    // The first column is in kHz, and half of the spread was taken.
    assert!((curve.frequency_hz[5] - 50.0).abs() < 1e-9);
    assert!((curve.noise_percent().unwrap() - 2.0).abs() < 1e-5);
    let p = parameters(&case.program, &case.tables, &[]).unwrap();
    assert_eq!(
        case.program.kernels.constant(Constant::BandFrom(0), &p),
        None
    );
}

#[test]
fn a_declared_period_may_be_twice_the_shortest() {
    let case = Case::of(&Example::load("tests/models/lag.hyde", Some("declared")).unwrap());
    let (curve, _) = case.measured(0);
    assert_eq!(curve.periods.unwrap().0, 4);
    assert_eq!(curve.frequency_hz.len(), 15);
    for value in &curve.response {
        assert!((value - 2.0).norm() < 1e-9, "{value}"); // rounding of eight digits cancels
    }
    let cut = curve.between(20.0, 60.0);
    assert_eq!(cut.frequency_hz.len(), 9);
    assert_eq!(cut.input.len(), 9);
}
