//! The problems: each as a model of Hyde and as arguments of the peers' programs, with what was promised of it.

/// What two runs of a problem are compared by.
#[derive(Clone, Copy, PartialEq)]
pub enum Compared {
    /// Speeds and twist every 10 ms: the largest error of each over its own maximum.
    Samples,
    /// Times of events, in s; their counts must be equal.
    Events,
    /// End states of many cases in m; counts of events of each case must be equal.
    Cases,
}

/// One problem.
pub struct Problem {
    pub name: &'static str,
    pub about: &'static str,
    /// File of `tests/benches/models`, and its experiment or sweep.
    pub model: &'static str,
    pub experiment: &'static str,
    pub set: &'static [&'static str],
    /// Program and arguments; `RTOL` stands for the relative tolerance.
    pub arguments: &'static [&'static str],
    /// More arguments of the run that the others are compared with.
    pub tight: &'static [&'static str],
    /// Whether diffsol can express it; beyond some thousand states it makes a dense table of n x n on the way.
    pub diffsol: bool,
    pub compared: Compared,
    /// Promised of the time over that of C and IDA.
    pub promised: Option<f64>,
    /// Only on demand.
    pub long: bool,
    pub curve: bool,
}

/// Relative tolerance of the comparison; the absolute tolerance is a hundredth of it.
pub const RTOL: f64 = 1e-6;
/// Promised of every problem that diffsol can express.
pub const OVER_DIFFSOL: f64 = 0.3;
/// Relative tolerance of the runs of C and IDA with which all others are compared.
pub const TIGHT: f64 = 1e-11;

/// At a tight tolerance the sampled loop restarts at each tick.
const RESTARTS: &[&str] = &["1"];

const SHAFT: Problem = Problem {
    name: "",
    about: "a steel shaft, torque step, 1 s",
    model: "shaft.hyde",
    experiment: "step",
    set: &[],
    arguments: &[],
    tight: &[],
    diffsol: true,
    compared: Compared::Samples,
    promised: Some(0.35),
    long: false,
    curve: false,
};

/// All, in the order measured.
pub fn problems() -> Vec<Problem> {
    vec![
        Problem {
            name: "P1_10",
            set: &["n=10"],
            arguments: &["shaft", "10", "RTOL"],
            promised: None,
            ..SHAFT
        },
        Problem {
            name: "P1_100",
            set: &["n=100"],
            arguments: &["shaft", "100", "RTOL"],
            curve: true,
            ..SHAFT
        },
        Problem {
            name: "P1_100_torques",
            about: "the same, torques as an array of unknowns",
            model: "shaft_torques.hyde",
            set: &["n=100"],
            arguments: &["shaft", "100", "RTOL"],
            ..SHAFT
        },
        Problem {
            name: "P1_1000",
            set: &["n=1000"],
            arguments: &["shaft", "1000", "RTOL"],
            ..SHAFT
        },
        Problem {
            name: "P1_10000",
            set: &["n=10000"],
            arguments: &["shaft", "10000", "RTOL"],
            diffsol: false,
            ..SHAFT
        },
        Problem {
            name: "P1_100000",
            set: &["n=100000"],
            arguments: &["shaft", "100000", "RTOL"],
            diffsol: false,
            long: true,
            ..SHAFT
        },
        Problem {
            name: "P2",
            about: "stick-slip, 65 events in 10 s",
            model: "stick_slip.hyde",
            experiment: "drawn",
            arguments: &["stick_slip", "RTOL"],
            compared: Compared::Events,
            promised: Some(0.6),
            curve: true,
            ..SHAFT
        },
        Problem {
            name: "P3",
            about: "backlash, 91 events in 10 s",
            model: "backlash.hyde",
            experiment: "reversing",
            arguments: &["backlash", "RTOL", "20e-6"],
            compared: Compared::Events,
            promised: Some(0.45),
            curve: true,
            ..SHAFT
        },
        Problem {
            name: "P4_10ms",
            about: "the shaft of 100 cells, P-PI loop sampled at 10 ms, 1 s",
            model: "controlled_shaft.hyde",
            experiment: "positioned",
            set: &["Ts=10 [ms]"],
            arguments: &["shaft", "100", "RTOL", "1e-2"],
            tight: RESTARTS,
            promised: Some(0.22),
            curve: true,
            ..SHAFT
        },
        Problem {
            name: "P4_1ms",
            about: "the same, sampled at 1 ms",
            model: "controlled_shaft.hyde",
            experiment: "positioned",
            set: &["Ts=1 [ms]"],
            arguments: &["shaft", "100", "RTOL", "1e-3"],
            tight: RESTARTS,
            promised: Some(0.15),
            curve: true,
            ..SHAFT
        },
        Problem {
            name: "P5",
            about: "P3 for 1000 gaps from 5 to 50 um",
            model: "backlash.hyde",
            experiment: "gaps",
            arguments: &["backlash", "RTOL", "5e-6", "50e-6", "1000"],
            compared: Compared::Cases,
            promised: Some(0.45),
            ..SHAFT
        },
        Problem {
            name: "nonlinear",
            about: "the shaft with cubic stiffening and Stribeck friction",
            model: "stiffening_shaft.hyde",
            arguments: &["nonlinear", "100", "RTOL", "0"],
            curve: true,
            promised: Some(0.6),
            ..SHAFT
        },
        Problem {
            name: "index_1",
            about: "the shaft with an implicit law of every element",
            model: "implicit_shaft.hyde",
            arguments: &["nonlinear", "100", "RTOL", "1"],
            curve: true,
            promised: Some(0.6),
            ..SHAFT
        },
    ]
}

impl Problem {
    /// The program of the peers and its arguments at a relative tolerance.
    pub fn call(&self, rtol: f64) -> (&'static str, Vec<String>) {
        let rest = self.arguments[1..].iter().map(|word| match *word {
            "RTOL" => format!("{rtol:e}"),
            word => word.to_owned(),
        });
        (self.arguments[0], rest.collect())
    }
}
