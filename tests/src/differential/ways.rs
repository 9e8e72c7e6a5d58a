//! [`Way`]: two ways to one result, and their comparison for a model.

use super::Verdict;
use super::complex_step;
use super::model::Model;
use super::trajectories::{How, first_difference, outside, run};
use crate::Example;
use crate::gradient::Compare;
use crate::last_bit::{Place, Random};
use crate::linear;
use crate::random_ledger;
use hyde_compiler::Backend;
use hyde_diag::{Diagnostics, Sources};
use hyde_experiment::Options;
use hyde_program::{Constant, Method, Program};
use hyde_sim::Results;
use std::cell::OnceCell;
use std::collections::BTreeMap;

/// Two ways to one result.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Way {
    /// IDA, the one-step method and the choice between them, each against a reference at a tight tolerance.
    Methods,
    /// Machine code and the interpreter, to the last bit.
    Backends,
    /// Whole arrays, and every element by itself.
    Arrays,
    /// Derivatives by rules, and by a complex step.
    Derivatives,
    /// The linearised system, and differences of runs.
    Linear,
    /// The energy ledger: the balances close, and the supplied energy is that of the forces.
    Ledger,
    /// Derivatives of a run, and differences of runs.
    Gradient,
    /// The text as it is, formatted, and printed from its tree.
    Layout,
}

impl Way {
    /// All of them.
    pub const ALL: [Self; 8] = [
        Self::Methods,
        Self::Backends,
        Self::Arrays,
        Self::Derivatives,
        Self::Linear,
        Self::Ledger,
        Self::Gradient,
        Self::Layout,
    ];
}

/// Tolerances of the reference, by the one-step method, which takes a step to an event anew.
const TIGHT: (f64, f64) = (1e-10, 1e-13);
/// Tolerances, and how far a state may be from the reference, as a part of its largest value.
const NEAR: (f64, f64, f64) = (1e-8, 1e-11, 5e-5);
const LOOSE: (f64, f64, f64) = (1e-6, 1e-9, 1e-3);
/// How far whole arrays and single elements may be apart: two runs at `TIGHT`.
const UNROLLED: f64 = 1e-6;
/// How far a derivative of a run may be from a difference of runs, as a part of the largest.
const GRADIENT: f64 = 1e-3;
/// The same of runs for a difference: relative steps of the parameter.
const STEPS: [f64; 3] = [1e-3, 1e-4, 1e-5];
/// Points at which kernels are compared.
const POINTS: u64 = 3;

/// A model that compiles.
pub(super) struct Subject<'a> {
    model: &'a Model,
    example: Example,
    program: Program,
    stop_s: f64,
    reference: OnceCell<Result<Results, String>>,
}

impl<'a> Subject<'a> {
    /// Compiles a model.
    ///
    /// # Errors
    /// Its diagnostics.
    pub(super) fn new(model: &'a Model) -> Result<Self, String> {
        let example = of_text(&model.text)?;
        let program = example.compile(Backend::Native)?.program;
        let p = parameters(&program)?;
        let stop_s = program.kernels.constant(Constant::Stop, &p);
        // The models of the linear analysis run on for a second.
        let stop_s = stop_s.unwrap_or(0.3).min(0.5);
        Ok(Self {
            model,
            example,
            program,
            stop_s,
            reference: OnceCell::new(),
        })
    }

    /// Compares two ways to one result.
    pub(super) fn compare(&self, way: Way) -> Verdict {
        let found = match way {
            Way::Methods => self.methods(),
            Way::Backends => self.backends(),
            Way::Arrays => self.arrays(),
            Way::Derivatives => self.derivatives(),
            Way::Linear => self.linear(),
            Way::Ledger => self.ledger(),
            Way::Gradient => self.gradient(),
            Way::Layout => self.layout(),
        };
        found.unwrap_or_else(Verdict::Refused)
    }

    fn run(&self, method: Method, (rtol, atol): (f64, f64)) -> Result<Results, String> {
        let how = How {
            method,
            rtol,
            atol,
            stop_s: self.stop_s,
        };
        run(&self.program, how)
    }

    fn reference(&self) -> Result<&Results, String> {
        let made = || self.run(Method::Esdirk, TIGHT);
        self.reference
            .get_or_init(made)
            .as_ref()
            .map_err(Clone::clone)
    }

    fn methods(&self) -> Result<Verdict, String> {
        let reference = self.reference()?;
        let ways = [
            (Method::Esdirk, NEAR),
            (Method::Ida, NEAR),
            (Method::Esdirk, LOOSE),
            (Method::Ida, LOOSE),
            (Method::Auto, LOOSE),
        ];
        for (method, (rtol, atol, bound)) in ways {
            let other = self
                .run(method, (rtol, atol))
                .map_err(|reason| format!("{method:?} at rtol {rtol:e}: {reason}"))?;
            let program = &self.program;
            if let Some(wrong) = outside((program, reference), (program, &other), bound) {
                return Ok(Verdict::Disagrees(format!(
                    "{method:?} at rtol {rtol:e}: {wrong}"
                )));
            }
        }
        Ok(Verdict::Agrees)
    }

    fn backends(&self) -> Result<Verdict, String> {
        let interpreted = self.example.compile(Backend::Interpreter)?.program;
        for seed in 0..POINTS {
            let place = Place::random(&self.program, &mut Random(seed));
            let apart = place.apart(&self.program, &interpreted)?;
            if apart > 0 {
                return Ok(Verdict::Disagrees(format!("kernels are {apart} ulp apart")));
            }
        }
        let how = How {
            method: Method::Auto,
            rtol: 1e-6,
            atol: 1e-9,
            stop_s: 0.2 * self.stop_s,
        };
        Ok(same(
            &self.program,
            run(&self.program, how),
            run(&interpreted, how),
        ))
    }

    fn arrays(&self) -> Result<Verdict, String> {
        let Some(unrolled) = &self.model.unrolled else {
            return Ok(Verdict::Nothing);
        };
        let other = of_text(unrolled)?.compile(Backend::Native)?.program;
        let how = How {
            method: Method::Esdirk,
            rtol: TIGHT.0,
            atol: TIGHT.1,
            stop_s: self.stop_s,
        };
        let results = run(&other, how)?;
        let reference = (&self.program, self.reference()?);
        let wrong = outside(reference, (&other, &results), UNROLLED);
        Ok(wrong.map_or(Verdict::Agrees, |wrong| {
            Verdict::Disagrees(format!("element by element: {wrong}\n{unrolled}"))
        }))
    }

    fn derivatives(&self) -> Result<Verdict, String> {
        let dae = self.example.analyze()?;
        for seed in 0..POINTS {
            let place = Place::random(&self.program, &mut Random(seed));
            if let Some(wrong) = complex_step::wrong(&dae, &self.program, &place) {
                return Ok(Verdict::Disagrees(wrong));
            }
        }
        Ok(Verdict::Agrees)
    }

    fn linear(&self) -> Result<Verdict, String> {
        let Some((at_s, starts)) = &self.model.point else {
            return Ok(Verdict::Nothing);
        };
        Ok(match linear::compared(&self.example, *at_s, starts)? {
            linear::Verdict::Agrees => Verdict::Agrees,
            linear::Verdict::Told => Verdict::Refused("an assumption".to_owned()),
            linear::Verdict::Nothing => Verdict::Nothing,
            linear::Verdict::Wrong(reason) => Verdict::Disagrees(reason),
        })
    }

    fn ledger(&self) -> Result<Verdict, String> {
        if !self.model.measures_work {
            return Ok(Verdict::Nothing);
        }
        let wrong = random_ledger::open_in(&self.model.text)?;
        Ok(wrong.map_or(Verdict::Agrees, |wrong| {
            Verdict::Disagrees(wrong.replace(&self.model.text, ""))
        }))
    }

    fn gradient(&self) -> Result<Verdict, String> {
        let outputs = self.followed();
        // Differences of the method that takes a step to an event anew: they are less noisy behind many events.
        let reference = self.model.text.replace("solve ida(", "solve esdirk(");
        let reference = of_text(&reference)?.compile(Backend::Native)?.program;
        let compare = Compare {
            program: &self.program,
            differences_of: &reference,
            tables: &BTreeMap::new(),
            options: Options {
                rtol: Some(1e-10),
                atol: Some(1e-13),
                stop_s: Some(self.stop_s),
                every_s: Some(self.stop_s / 20.0),
                ..Options::default()
            },
            steps: &STEPS,
        };
        let parameters: Vec<&str> = self.model.parameters.iter().map(String::as_str).collect();
        // One is enough: which one varies with the model.
        let chosen = self.model.text.len() % parameters.len().max(1);
        let Some(parameter) = parameters.get(chosen) else {
            return Ok(Verdict::Nothing);
        };
        let found = compare.outputs(&[parameter], &outputs)?;
        let wrong = found
            .iter()
            .filter(|one| one.largest > 1e-6 && one.rows.0 > 2 * one.rows.1 / 3)
            .find(|one| one.error.is_nan() || one.error > GRADIENT + one.noise);
        Ok(wrong.map_or(Verdict::Agrees, |wrong| {
            Verdict::Disagrees(format!("{wrong:?}"))
        }))
    }

    /// Some places and speeds.
    fn followed(&self) -> Vec<&str> {
        let ends = [".s", ".v", ".phi", ".w", "x1", "v1", "x[1]", "v[2]"];
        let names = self
            .program
            .outputs
            .iter()
            .map(|output| output.name.as_str());
        let own = names.filter(|name| {
            let body = name.starts_with("body") && !name.contains(".a.") && !name.contains(".b.");
            (body || !name.contains('.')) && ends.iter().any(|end| name.ends_with(end))
        });
        own.take(4).collect()
    }

    fn layout(&self) -> Result<Verdict, String> {
        let formatted = hyde_format::format("random.hyde", &self.model.text)
            .map_err(|failure| format!("{failure:?}"))?;
        let mut sources = Sources::new();
        let file = sources.add("random.hyde", &self.model.text);
        let tree = hyde_syntax::parse(&sources, file, &mut Diagnostics::new());
        let printed = hyde_syntax::format(&tree);
        let how = How {
            method: Method::Auto,
            rtol: 1e-6,
            atol: 1e-9,
            stop_s: self.stop_s,
        };
        let own = run(&self.program, how);
        for (text, what) in [
            (formatted.text, "formatted"),
            (printed, "printed from its tree"),
        ] {
            let other = of_text(&text)?.compile(Backend::Native);
            let other = match other {
                Ok(other) => other.program,
                Err(reason) => {
                    return Ok(Verdict::Disagrees(format!(
                        "{what} it is refused: {reason}"
                    )));
                }
            };
            let verdict = same(&self.program, own.clone(), run(&other, how));
            if let Verdict::Disagrees(reason) = verdict {
                return Ok(Verdict::Disagrees(format!("{what}: {reason}")));
            }
        }
        Ok(Verdict::Agrees)
    }
}

fn of_text(text: &str) -> Result<Example, String> {
    Ok(Example::load("tests/models/ledger.hyde", None)?
        .replaced(text, "run")
        .free_inputs())
}

fn parameters(program: &Program) -> Result<Vec<f64>, String> {
    let found = hyde_experiment::parameters(program, &BTreeMap::new(), &[]);
    found.map_err(|error| format!("{error:?}"))
}

/// Whether two runs are one, to the last bit; two that end alike are too.
fn same(program: &Program, a: Result<Results, String>, b: Result<Results, String>) -> Verdict {
    match (a, b) {
        (Ok(a), Ok(b)) => {
            first_difference(program, &a, &b).map_or(Verdict::Agrees, Verdict::Disagrees)
        }
        (Err(a), Err(b)) if a == b => Verdict::Refused(a),
        (a, b) => {
            let of = |result: Result<Results, String>| result.err().unwrap_or("a run".to_owned());
            Verdict::Disagrees(format!("{} and {}", of(a), of(b)))
        }
    }
}
