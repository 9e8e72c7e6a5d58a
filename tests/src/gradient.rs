//! Derivatives of runs by parameters, against differences of runs: what the tests and the figure share.
//!
//! A difference has two errors, of the step and of the runs' tolerance. So it is made of a central difference with a step
//! and with its half (Richardson), at several steps, and of those the one that agrees best counts. A row that an event
//! passes between the runs compared has no difference and is left out.

use crate::Example;
use hyde_compiler::Backend;
use hyde_experiment::{Options, Run, RunError};
use hyde_program::Program;
use hyde_signal::Table;
use hyde_sim::Results;
use std::collections::BTreeMap;

/// How many times its tolerance a run may be from the solution: steps add up, and a row behind an event is as late as that.
const ERRORS: f64 = 100.0;
/// Relative steps of a parameter.
const STEPS: [f64; 4] = [3e-3, 1e-3, 1e-4, 1e-5];
/// Those for the bench axis, whose runs take long.
const STEPS_OF_BENCH: [f64; 3] = [0.08, 0.02, 0.005];

/// The parameters of the bench axis that are uncertain, and a gain.
pub const BENCH: [&str; 13] = [
    "Tcs",
    "bs",
    "motor.Jm",
    "bearing.T",
    "bearing.b",
    "belt.k",
    "belt.c",
    "screw.contact.k",
    "screw.contact.c",
    "saddle.M",
    "guide.F",
    "guide.b",
    "cnc.control.Kp",
];

/// A model with what it is differentiated by.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The model of `tests/models/gradients.hyde`.
    pub model: &'static str,
    /// The parameters.
    pub parameters: &'static [&'static str],
    /// The outputs compared.
    pub outputs: &'static [&'static str],
    /// End of the run in s.
    pub stop_s: f64,
}

/// Every model of the file that has a gradient to the end.
pub const CASES: &[Case] = &[
    Case {
        model: "Decay",
        parameters: &["a", "b", "x0"],
        outputs: &["x", "y"],
        stop_s: 2.0,
    },
    Case {
        model: "Belt",
        parameters: &["v_belt", "k", "d", "m", "Fs", "Fc"],
        outputs: &["s", "v", "grip"],
        stop_s: 3.0,
    },
    Case {
        model: "Backlash",
        parameters: &["gap", "k", "d", "F", "a.M", "rail.F"],
        outputs: &["a.s", "b.s", "a.v", "contact"],
        stop_s: 0.6,
    },
    Case {
        model: "Bouncing",
        parameters: &["g", "e", "h0", "floor"],
        outputs: &["h", "v", "top"],
        stop_s: 2.0,
    },
    Case {
        model: "Late",
        parameters: &["T", "r", "half", "control.pi.Kp", "control.pi.Ki"],
        outputs: &["x", "u"],
        stop_s: 0.3,
    },
    Case {
        model: "Step",
        parameters: &["begins", "lasts", "m", "k"],
        outputs: &["s", "v", "a"],
        stop_s: 1.0,
    },
    Case {
        model: "Pendulum",
        parameters: &["L", "g"],
        outputs: &["x", "y", "vx", "F"],
        stop_s: 2.0,
    },
    Case {
        model: "Geared",
        parameters: &["n", "c", "motor.J", "bearing.T"],
        outputs: &["table.phi", "motor.w", "gear.a.tau"],
        stop_s: 1.0,
    },
    Case {
        model: "Steady",
        parameters: &["load", "k"],
        outputs: &["x1", "x2", "v2"],
        stop_s: 0.6,
    },
    Case {
        model: "Tank",
        parameters: &["up_to", "down_to", "faster"],
        outputs: &["x", "rate", "entered"],
        stop_s: 4.0,
    },
];

/// A derivative compared.
#[derive(Clone, Debug)]
pub struct Compared {
    /// `d(output)/d(parameter)`.
    pub name: String,
    /// The largest difference of the rows over the largest derivative.
    pub error: f64,
    /// The largest derivative by differences.
    pub largest: f64,
    /// What the tolerance of the runs makes of a difference, as a part of the largest derivative.
    pub noise: f64,
    /// Rows compared, of all.
    pub rows: (usize, usize),
}

impl Case {
    /// Compiles and compares.
    ///
    /// # Errors
    /// The model does not compile or run, or its gradient ends.
    pub fn compare(&self) -> Result<Vec<Compared>, String> {
        let example = Example::load("tests/models/gradients.hyde", None)?.model(self.model);
        let compiled = example.compile(Backend::Native)?;
        let tables = BTreeMap::new();
        let options = Options {
            stop_s: Some(self.stop_s),
            rtol: Some(1e-10),
            atol: Some(1e-13),
            every_s: Some(self.stop_s / 200.0),
            ..Options::default()
        };
        let compared = Compare {
            program: &compiled.program,
            differences_of: &compiled.program,
            tables: &tables,
            options,
            steps: &STEPS,
        };
        compared
            .outputs(self.parameters, self.outputs)
            .map_err(|error| format!("{}: {error}", self.model))
    }
}

/// The same of the bench axis in its closed loop, without the quantisers of its encoder and its scale: position, angle, speed and current
/// by parameters of the axis, over the beginning of the first stroke.
///
/// # Errors
/// As [`Case::compare`].
pub fn compare_bench(parameters: &[&str]) -> Result<Vec<Compared>, String> {
    let example = Example::load("examples/bench_axis/axis.hyde", Some("bench"))?
        .rewritten(
            "floor_to(sample(encoder.phi), 1e-4 [rev])",
            "sample(encoder.phi)",
        )
        .rewritten("floor_to(scale.s, 1 [um])", "scale.s");
    let loaded = example.parse()?;
    let compiled = loaded.compile(&example, Backend::Native)?;
    let options = Options {
        stop_s: Some(0.5),
        rtol: Some(1e-9),
        atol: Some(1e-13),
        ..Options::default()
    };
    let compared = Compare {
        program: &compiled.program,
        differences_of: &compiled.program,
        tables: &loaded.tables,
        options,
        steps: &STEPS_OF_BENCH,
    };
    let outputs = ["saddle.s", "motor.phi", "motor.w", "motor.i"];
    compared.outputs(parameters, &outputs)
}

/// A model to be compared with differences.
pub(crate) struct Compare<'a> {
    pub(crate) program: &'a Program,
    /// The same model with the method whose runs the differences are of.
    pub(crate) differences_of: &'a Program,
    pub(crate) tables: &'a BTreeMap<String, Table>,
    pub(crate) options: Options,
    pub(crate) steps: &'a [f64],
}

impl Compare<'_> {
    fn solve(&self, program: &Program, options: &Options) -> Result<Run, String> {
        let run = hyde_experiment::run(program, self.tables, options);
        run.map_err(|error| {
            // Without the results up to there.
            if let RunError::Failed(failure) = error {
                return format!("{:?} at {} s", failure.kind, failure.t);
            }
            format!("{error:?}")
        })
    }

    /// Every output by every parameter.
    pub(crate) fn outputs(
        &self,
        parameters: &[&str],
        outputs: &[&str],
    ) -> Result<Vec<Compared>, String> {
        let options = Options {
            gradient: parameters.iter().map(|name| (*name).to_owned()).collect(),
            ..self.options.clone()
        };
        let exact = self.solve(self.program, &options)?;
        let gradient = exact.results.gradient.as_ref().ok_or("no gradient")?;
        if let Some(end) = &gradient.end {
            return Err(format!("the gradient ends: {end:?}"));
        }
        let mut found = Vec::new();
        for (number, parameter) in parameters.iter().enumerate() {
            let place = gradient.parameters[number];
            let pairs = self.moved(parameter, exact.parameters[place])?;
            for name in outputs {
                let output = self.program.output(name);
                let output = output.ok_or(format!("no output `{name}`"))?;
                let column = &gradient.columns[number][output];
                let of_step = |(step, runs): &(f64, Vec<Results>)| {
                    let name = format!("d({name})/d({parameter})");
                    self.compare(name, &exact.results, (column, output), runs, *step)
                };
                let all: Vec<Compared> = pairs.iter().map(of_step).collect::<Result<_, _>>()?;
                let best = all.into_iter().min_by(|a, b| a.error.total_cmp(&b.error));
                found.extend(best);
            }
        }
        Ok(found)
    }

    /// Runs with a parameter a step and half a step up and down.
    fn moved(&self, parameter: &str, value: f64) -> Result<Vec<(f64, Vec<Results>)>, String> {
        let run = |by: f64| -> Result<Results, String> {
            let mut options = self.options.clone();
            options.set.push((parameter.to_owned(), value + by));
            Ok(self.solve(self.differences_of, &options)?.results)
        };
        let four = |part: &f64| {
            let step = part * value.abs();
            let runs = [step, -step, 0.5 * step, -0.5 * step].map(run);
            let runs: Result<Vec<Results>, String> = runs.into_iter().collect();
            Ok((step, runs?))
        };
        self.steps.iter().map(four).collect()
    }

    fn compare(
        &self,
        name: String,
        exact: &Results,
        (column, output): (&[f64], usize),
        runs: &[Results],
        step: f64,
    ) -> Result<Compared, String> {
        let (mut worst, mut largest, mut count) = (0.0_f64, 0.0_f64, 0);
        let rows = self.rows(exact);
        for &t in &rows {
            let Some(quotient) = difference(exact, runs, step, output, t) else {
                continue;
            };
            let (left, _) = exact.rows_at(t).ok_or("a row is missing")?;
            worst = worst.max((column[left] - quotient).abs());
            largest = largest.max(quotient.abs());
            count += 1;
        }
        let size = exact.column(output).ok_or("no column")?;
        let size = size
            .iter()
            .fold(0.0_f64, |most, value| most.max(value.abs()));
        let tolerance = self.options.rtol.unwrap_or(1e-6);
        // Not a number is no agreement, and nothing compared neither.
        let finite = column.iter().all(|slope| slope.is_finite()) && largest > 0.0;
        Ok(Compared {
            name,
            error: if finite {
                worst / largest
            } else {
                f64::INFINITY
            },
            largest,
            noise: ERRORS * tolerance * size / step / largest,
            rows: (count, rows.len()),
        })
    }

    /// The instants at which all runs have rows.
    fn rows(&self, exact: &Results) -> Vec<f64> {
        let last = exact.time.last().copied().unwrap_or_default();
        let every = self.options.every_s.unwrap_or(1e-3);
        hyde_sim::Setup::rows_every(0.0, last, every)
    }
}

/// The central difference at a time, extrapolated; none where an event lies at it in one run and before it in another.
fn difference(exact: &Results, runs: &[Results], step: f64, output: usize, t: f64) -> Option<f64> {
    let events = |results: &Results| {
        let near = 1e-9;
        let before = |margin: f64| results.events.iter().filter(|e| e.t < t + margin).count();
        (before(-near) == before(near)).then(|| before(0.0))
    };
    let expected = events(exact)?;
    let mut values = [0.0; 4];
    for (value, run) in values.iter_mut().zip(runs) {
        if events(run)? != expected {
            return None;
        }
        let (left, _) = run.rows_at(t)?;
        *value = run.column(output)?[left];
    }
    let [up, down, half_up, half_down] = values;
    let (wide, close) = ((up - down) / (2.0 * step), (half_up - half_down) / step);
    Some((4.0 * close - wide) / 3.0)
}
