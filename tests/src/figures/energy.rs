//! `energy_drift`: does a drive without losses keep its energy?
//!
//! Two drives, the worse counts: one with a bar, whose undamped modes hold the steps of the solver small whatever the
//! tolerance, and one of two inertias and a spring, where the tolerance alone holds them.

use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use hyde_compiler::Compiled;
use hyde_experiment::Run;

pub(super) const FIGURE: Figure = Figure {
    name: "energy_drift",
    unit: "relative",
    promise: Promise::AtMost(1e-6),
    measure,
};

/// Periods that the run must have.
const PERIODS: usize = 100;

/// The largest change of the stored energy in any row, over what was stored at the start.
fn measure(_: &Session) -> Result<Measured, String> {
    Ok(Measured::Value(with_bar()?.max(lumped()?)))
}

/// 100 of the 160 periods of the two inertias.
fn lumped() -> Result<f64, String> {
    let (compiled, run) = Example::load("tests/models/lumped.hyde", Some("free"))?.run()?;
    let energy = compiled
        .program
        .output("e")
        .and_then(|number| run.results.column(number));
    let energy = energy.ok_or("the run has no column `e`")?;
    Ok(drift(&energy[..energy.len() * 100 / 160]))
}

fn with_bar() -> Result<f64, String> {
    let drive = Example::load("tests/models/undamped.hyde", Some("free"))?;
    let (compiled, run) = drive.run()?;
    let drive = Drive::of(&compiled, &run)?;
    let position = drive.column("table.s")?;
    let crossings = position
        .windows(2)
        .filter(|pair| (pair[0] > 0.0) != (pair[1] > 0.0))
        .count();
    if crossings < 2 * PERIODS {
        return Err(format!(
            "{crossings} zero crossings are fewer than {PERIODS} periods"
        ));
    }
    Ok(drift(&drive.energy()?))
}

fn drift(energy: &[f64]) -> f64 {
    let start = energy[0];
    energy
        .iter()
        .fold(0.0_f64, |most, e| most.max((e - start).abs()))
        / start
}

/// A finished run with its parameters.
struct Drive<'a> {
    compiled: &'a Compiled,
    run: &'a Run,
    cells: usize,
}

impl<'a> Drive<'a> {
    fn of(compiled: &'a Compiled, run: &'a Run) -> Result<Self, String> {
        let mut drive = Self {
            compiled,
            run,
            cells: 0,
        };
        while drive
            .column(&format!("screw.th[{}]", drive.cells + 1))
            .is_ok()
        {
            drive.cells += 1;
        }
        if drive.cells < 2 {
            return Err("the screw has no cells".to_owned());
        }
        Ok(drive)
    }

    fn column(&self, name: &str) -> Result<&'a [f64], String> {
        let number = self.compiled.program.output(name);
        number
            .and_then(|number| self.run.results.column(number))
            .ok_or_else(|| format!("the run has no column `{name}`"))
    }

    fn parameter(&self, name: &str) -> Result<f64, String> {
        let found = self.compiled.program.parameter(name);
        found
            .map(|(parameter, _)| self.run.parameters[parameter.place])
            .ok_or_else(|| format!("the model has no parameter `{name}`"))
    }

    /// Kinetic energy of every mass, potential energy of every spring and of the bar, in J, row by row.
    fn energy(&self) -> Result<Vec<f64>, String> {
        let mut energy = vec![0.0; self.run.results.time.len()];
        let mut add = |factor: f64, a: &[f64], b: &[f64]| {
            for ((sum, a), b) in energy.iter_mut().zip(a).zip(b) {
                *sum += 0.5 * factor * a * b;
            }
        };
        for (coefficient, quantity) in [
            ("near.J", "near.w"),
            ("far.J", "far.w"),
            ("table.M", "table.v"),
            ("spring.c", "spring.stretch"),
            ("screw.contact.k", "screw.contact.e"),
        ] {
            let values = self.column(quantity)?;
            add(self.parameter(coefficient)?, values, values);
        }
        let node = |name: &str, number: usize| self.column(&format!("screw.{name}[{number}]"));
        let cell = self.parameter("screw.len")? / self.cells as f64;
        let inertia = self.parameter("screw.rho")? * self.parameter("screw.Ip")? * cell;
        let stiffness = self.parameter("screw.G")? * self.parameter("screw.Ip")? / cell;
        for number in 1..=self.cells {
            let (w, next) = (node("w", number - 1)?, node("w", number)?);
            // The mass matrix of a cell: half of the consistent one of linear elements, half of the lumped one.
            add(inertia * 5.0 / 12.0, w, w);
            add(inertia * 5.0 / 12.0, next, next);
            add(inertia * 2.0 / 12.0, w, next);
            let (th, next) = (node("th", number - 1)?, node("th", number)?);
            let twist: Vec<f64> = next.iter().zip(th).map(|(b, a)| b - a).collect();
            add(stiffness, &twist, &twist);
        }
        Ok(energy)
    }
}
