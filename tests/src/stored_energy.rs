//! [`Drive`]: the energy stored in a drive with a ball-screw, from the columns of its run.

use hyde_compiler::Compiled;
use hyde_experiment::Run;

/// The largest change of the stored energy in any row, over what was stored at the start.
#[must_use]
pub fn drift(energy: &[f64]) -> f64 {
    let start = energy[0];
    energy
        .iter()
        .fold(0.0_f64, |most, e| most.max((e - start).abs()))
        / start
}

/// A finished run with its parameters.
pub struct Drive<'a> {
    compiled: &'a Compiled,
    run: &'a Run,
    /// Cells of the screw.
    pub cells: usize,
}

impl<'a> Drive<'a> {
    /// A run of a drive whose ball-screw is called `screw`.
    ///
    /// # Errors
    /// There is no such screw among the columns.
    pub fn of(compiled: &'a Compiled, run: &'a Run) -> Result<Self, String> {
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

    /// A column of the results, in SI.
    ///
    /// # Errors
    /// The run has none of that name.
    pub fn column(&self, name: &str) -> Result<std::borrow::Cow<'a, [f64]>, String> {
        let number = self.compiled.program.output(name);
        number
            .and_then(|number| self.run.results.column(number))
            .ok_or_else(|| format!("the run has no column `{name}`"))
    }

    /// The value of a parameter, in SI.
    ///
    /// # Errors
    /// The model has none of that name.
    pub fn parameter(&self, name: &str) -> Result<f64, String> {
        let found = self.compiled.program.parameter(name);
        found
            .map(|(parameter, _)| self.run.parameters[parameter.place])
            .ok_or_else(|| format!("the model has no parameter `{name}`"))
    }

    /// The energy in J, row by row, of the masses and springs given by coefficient and quantity, and of the screw: its
    /// torsion, and its axial motion where it has one.
    ///
    /// # Errors
    /// A column or a parameter is missing.
    pub fn energy(&self, parts: &[(&str, &str)]) -> Result<Vec<f64>, String> {
        let mut energy = vec![0.0; self.run.results.time.len()];
        let mut add = |factor: f64, a: &[f64], b: &[f64]| {
            for ((sum, a), b) in energy.iter_mut().zip(a).zip(b) {
                *sum += 0.5 * factor * a * b;
            }
        };
        for (coefficient, quantity) in parts {
            let values = self.column(quantity)?;
            add(self.parameter(coefficient)?, &values, &values);
        }
        self.bar(("w", "th"), ("screw.rho", "screw.G", "screw.Ip"), &mut add)?;
        if self.column("screw.u[0]").is_ok() {
            self.bar(("uv", "u"), ("screw.rho", "screw.E", "screw.A"), &mut add)?;
            for end in [0, self.cells] {
                let seat = self.column(&format!("screw.u[{end}]"))?;
                add(self.parameter("screw.kb")?, &seat, &seat);
            }
        }
        Ok(energy)
    }

    /// Velocity and displacement along the bar; density, modulus and section.
    fn bar(
        &self,
        (velocity, displacement): (&str, &str),
        (density, modulus, section): (&str, &str, &str),
        add: &mut impl FnMut(f64, &[f64], &[f64]),
    ) -> Result<(), String> {
        let node = |name: &str, number: usize| self.column(&format!("screw.{name}[{number}]"));
        let cell = self.parameter("screw.len")? / self.cells as f64;
        let mass = self.parameter(density)? * self.parameter(section)? * cell;
        let stiffness = self.parameter(modulus)? * self.parameter(section)? / cell;
        for number in 1..=self.cells {
            let (v, next) = (node(velocity, number - 1)?, node(velocity, number)?);
            // The mass matrix of a cell: half of the consistent one of linear elements, half of the lumped one.
            add(mass * 5.0 / 12.0, &v, &v);
            add(mass * 5.0 / 12.0, &next, &next);
            add(mass * 2.0 / 12.0, &v, &next);
            let (s, next) = (node(displacement, number - 1)?, node(displacement, number)?);
            let strain: Vec<f64> = next.iter().zip(s.iter()).map(|(b, a)| b - a).collect();
            add(stiffness, &strain, &strain);
        }
        Ok(())
    }
}
