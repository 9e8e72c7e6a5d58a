//! `two_mass_…`: the two-mass bench with the parameters of a published fit against its measured frequency response.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Backend;
use hyde_experiment::{frequency_response, linearize, measured_curve, parameters};

// The bounds are the errors of the same linear model as its source quotes them, to a digit behind the point.
pub(super) const MOTOR: Figure = Figure {
    name: "two_mass_frf_error_percent",
    unit: "%",
    promise: Promise::AtMost(9.5),
    measure: |session| channel(session, 0),
};

pub(super) const LOAD: Figure = Figure {
    name: "two_mass_load_frf_error_percent",
    unit: "%",
    promise: Promise::Below(22.95),
    measure: |session| channel(session, 1),
};

pub(super) const MOTOR_WITHOUT_DELAY: Figure = Figure {
    name: "two_mass_frf_error_without_delay_percent",
    unit: "%",
    promise: Promise::AtMost(14.1),
    measure: |session| channel(session, 2),
};

pub(super) const LOAD_WITHOUT_DELAY: Figure = Figure {
    name: "two_mass_load_frf_error_without_delay_percent",
    unit: "%",
    promise: Promise::AtMost(24.6),
    measure: |session| channel(session, 3),
};

fn channel(session: &Session, number: usize) -> Result<Measured, String> {
    let all = session.two_mass.get_or_init(|| errors(session)).clone()?;
    let measured = all.get(number).cloned();
    measured.ok_or_else(|| "the experiment measures two responses".to_owned())
}

/// Relative errors in percent, root mean square over the lines: motor and load, then both without the delay.
fn errors(session: &Session) -> Result<Vec<Measured>, String> {
    let record = session.data.join("two_mass_bench/frf_A.csv");
    if !record.is_file() {
        let what = "two_mass_bench/frf_A.csv, of FdiTools (Hori-Fujimoto Laboratory), is not below the data folder";
        return Ok(vec![Measured::Absent(what.to_owned()); 4]);
    }
    let example = Example::load("examples/two_mass/two_mass.hyde", Some("published"))?
        .record("frf", record)
        .free_inputs();
    let mut all = of(&example)?;
    all.extend(of(&example.set("Td", 0.0))?);
    Ok(all)
}

fn of(example: &Example) -> Result<Vec<Measured>, String> {
    let loaded = example.parse()?;
    let program = loaded.compile(example, Backend::Native)?.program;
    let failed = |what: &dyn std::fmt::Debug| format!("{what:?}");
    let p = parameters(&program, &loaded.tables, &[]).map_err(|error| failed(&error))?;
    let input = ["i".to_owned()];
    let linear = linearize(&program, &loaded.tables, &p, &input, &[]);
    let linear = linear.map_err(|error| failed(&error))?;
    let mut found = Vec::new();
    for measured in &program.experiment.measured_responses {
        let curve =
            measured_curve(measured, &loaded.tables, 0.0).map_err(|error| failed(&error))?;
        let bode = &program.experiment.bodes[measured.place.0];
        let output = bode.outputs[measured.place.1].1;
        let model = frequency_response(&linear, 0, &[output], &curve.frequency_hz);
        let model = model.map_err(|error| failed(&error))?;
        found.push(Measured::Value(curve.error_percent(&model[0])));
    }
    Ok(found)
}
