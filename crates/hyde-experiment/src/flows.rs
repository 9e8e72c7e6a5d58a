//! The forces, torques and currents between the components of a run, one line a connection.

use hyde_program::Program;
use hyde_sim::Results;

/// What went through a connection during a run, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct FlowLine {
    /// `motor.shaft to belt.a`, or `into belt.a` where more than two connectors meet.
    pub name: String,
    /// The output that goes into the connector named last.
    pub output: usize,
    /// Its smallest value.
    pub least: f64,
    /// Its largest value.
    pub most: f64,
    /// Its root mean square over time.
    pub rms: f64,
    /// When its magnitude was largest, in s.
    pub at_s: f64,
}

impl FlowLine {
    /// The largest magnitude.
    #[must_use]
    pub fn peak(&self) -> f64 {
        self.least.abs().max(self.most.abs())
    }
}

/// The flows of all connections in the order of the model, those apart through which nothing ever went: of ends that lie
/// free, and of sensors.
#[must_use]
pub fn flows(program: &Program, results: &Results) -> Vec<FlowLine> {
    let line = |flow: &hyde_program::Flow| {
        let values = results.column(flow.output)?;
        let peak =
            (0..values.len()).max_by(|&a, &b| values[a].abs().total_cmp(&values[b].abs()))?;
        Some(FlowLine {
            name: flow.name.clone(),
            output: flow.output,
            least: values.iter().copied().fold(f64::INFINITY, f64::min),
            most: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
            rms: mean(&results.time, &values, |value| value * value).sqrt(),
            at_s: results.time.get(peak).copied().unwrap_or(f64::NAN),
        })
    };
    let lines = program.experiment.flows.iter().filter_map(line);
    lines.filter(|line| line.peak() > 0.0).collect()
}

/// The mean over time of a function of a signal, by the trapezoidal rule. An instant with an event has two rows, so a jump is
/// no ramp.
fn mean(time: &[f64], values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let pairs = time.windows(2).zip(values.windows(2));
    let areas = pairs.map(|(t, v)| 0.5 * (t[1] - t[0]) * (of(v[0]) + of(v[1])));
    let ends = time.last().zip(time.first());
    areas.sum::<f64>() / ends.map_or(0.0, |(last, first)| last - first)
}
