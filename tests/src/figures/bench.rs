//! `bench0_…`: the bench axis with nominal values against the records of an independent simulator.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;

pub(super) const TABLE: Figure = Figure {
    name: "bench0_table_um",
    unit: "um",
    promise: Promise::AtMost(2.0),
    measure: |session| worst(session, 0),
};

pub(super) const TACHO: Figure = Figure {
    name: "bench0_tacho_mv",
    unit: "mV",
    promise: Promise::AtMost(5.0),
    measure: |session| worst(session, 1),
};

pub(super) const ANGLE: Figure = Figure {
    name: "bench0_angle_mrad",
    unit: "mrad",
    promise: Promise::AtMost(0.7),
    measure: |session| worst(session, 2),
};

/// Name of the channel and the factor from SI to the unit of its figure.
const CHANNELS: [(&str, f64); 3] = [("x", 1e6), ("v_tacho", 1e3), ("phi_m", 1e3)];

const RECORDS: [&str; 6] = [
    "fit-strokes",
    "fit-slow",
    "fit-sweep",
    "validate-strokes",
    "validate-slow",
    "validate-sweep",
];

fn worst(session: &Session, channel: usize) -> Result<Measured, String> {
    let all = session.bench.get_or_init(|| rms(session)).clone()?;
    Ok(all[channel].clone())
}

/// The largest rms over the records, of each channel: raw record minus model, every row.
fn rms(session: &Session) -> Result<Vec<Measured>, String> {
    let axis = Example::load("examples/bench_axis/axis.hyde", Some("bench"))?;
    let folder = session.data.join("bench/bench-0");
    let shipped = !folder.is_dir();
    let runs: Vec<Example> = if shipped {
        vec![axis]
    } else {
        let of = |name| {
            axis.clone()
                .record("file", folder.join(format!("{name}.csv")))
        };
        RECORDS.into_iter().map(of).collect()
    };
    let mut worst = [0.0_f64; CHANNELS.len()];
    for run in runs {
        let (_, run) = run.run()?;
        for ((name, factor), worst) in CHANNELS.iter().zip(&mut worst) {
            let channel = run.channels.iter().find(|channel| channel.name == *name);
            let channel = channel.ok_or_else(|| format!("the experiment measures no `{name}`"))?;
            *worst = worst.max(factor * channel.rms);
        }
    }
    let measured = |value| match shipped {
        true => Measured::Partly(value, "shipped record alone"),
        false => Measured::Value(value),
    };
    Ok(worst.into_iter().map(measured).collect())
}
