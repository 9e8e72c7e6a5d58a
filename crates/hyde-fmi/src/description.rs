//! [`Described`]: a model with what its description says beside the variables. [`crate::fmi_3_0`] and [`crate::fmi_2_0`] write it in
//! the form of their version.

use crate::interface::{Causality, Interface, Variability, Variable};
use crate::xml::{Xml, number, some};
use hyde_units::{Dimension, NamedUnit};
use std::collections::BTreeMap;

/// What a model description says.
pub struct Described<'a> {
    /// The variables.
    pub interface: &'a Interface,
    /// Name of the model.
    pub name: String,
    /// Its name as C writes names: that of the library in the archive.
    pub identifier: String,
    /// What the model is, in the words of its author.
    pub description: Option<String>,
    /// What the library asks for to be sure that the description is its own.
    pub token: String,
    /// Start and stop in s.
    pub times: (f64, f64),
    /// Relative and absolute tolerance.
    pub tolerances: (f64, f64),
    /// Time between samples in s.
    pub every_s: Option<f64>,
}

/// What an importer may have logged, with what it is.
pub(crate) const LOG_CATEGORIES: [(&str, &str); 2] = [
    ("logEvents", "every event: time, component, condition, line"),
    (
        "logStatusError",
        "errors: code, fact, component, equation, line, time",
    ),
];

impl Causality {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Independent => "independent",
            Self::Parameter => "parameter",
            Self::CalculatedParameter => "calculatedParameter",
            Self::Input => "input",
            Self::Output => "output",
            Self::Local => "local",
        }
    }
}

impl Variability {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Constant => "constant",
            Self::Fixed => "fixed",
            Self::Tunable => "tunable",
            Self::Discrete => "discrete",
            Self::Continuous => "continuous",
        }
    }
}

impl Described<'_> {
    /// The nominal value of a state: an importer whose absolute tolerance is this times its relative one asks for as much as
    /// the experiment.
    pub(crate) fn nominal(&self) -> f64 {
        self.tolerances.1 / self.tolerances.0
    }

    /// The units that variables have, each with those that people read it in.
    fn units(&self) -> BTreeMap<String, (Dimension, Vec<NamedUnit>)> {
        let mut found: BTreeMap<String, (Dimension, Vec<NamedUnit>)> = BTreeMap::new();
        for unit in self
            .interface
            .variables
            .iter()
            .filter_map(|v| v.unit.as_ref())
        {
            let si = unit.si();
            let dimension = si.unit().dimension;
            let entry = found.entry(si.text().to_owned());
            let (_, shown) = entry.or_insert_with(|| (dimension, Vec::new()));
            let known = shown.iter().any(|known| known.text() == unit.text());
            if si.text() != unit.text() && !known {
                shown.push(unit.clone());
            }
        }
        found
    }

    /// The definitions of units, which both versions write alike.
    pub(crate) fn write_units(&self, xml: &mut Xml) {
        let units = self.units();
        if units.is_empty() {
            return;
        }
        xml.open("UnitDefinitions", &[]);
        for (name, (dimension, shown)) in units {
            xml.open("Unit", &[("name", some(&name))]);
            if let Some(exponents) = dimension.si_exponents() {
                let names = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];
                let pairs = names.into_iter().zip(exponents);
                let base: Vec<(&str, Option<String>)> = pairs
                    .map(|(name, exponent)| (name, (exponent != 0).then(|| exponent.to_string())))
                    .collect();
                xml.leaf("BaseUnit", &base);
            }
            for unit in shown {
                // A value in the display unit is the factor times the value plus the offset.
                let offset = unit.unit().from_si(0.0);
                let factor = unit.unit().from_si(1.0) - offset;
                xml.leaf(
                    "DisplayUnit",
                    &[
                        ("name", some(unit.text())),
                        ("factor", some(number(factor))),
                        ("offset", (offset != 0.0).then(|| number(offset))),
                    ],
                );
            }
            xml.close();
        }
        xml.close();
    }

    /// The types of numbers: one for every unit that people read, with its name.
    pub(crate) fn types(&self) -> Vec<(String, NamedUnit)> {
        let mut found: BTreeMap<String, NamedUnit> = BTreeMap::new();
        for unit in self
            .interface
            .variables
            .iter()
            .filter_map(|v| v.unit.as_ref())
        {
            found.insert(type_name(unit), unit.clone());
        }
        found.into_iter().collect()
    }

    /// What both versions say of an experiment.
    pub(crate) fn write_experiment(&self, xml: &mut Xml) {
        xml.leaf(
            "DefaultExperiment",
            &[
                ("startTime", some(number(self.times.0))),
                ("stopTime", some(number(self.times.1))),
                ("tolerance", some(number(self.tolerances.0))),
                ("stepSize", self.every_s.map(number)),
            ],
        );
    }

    /// The categories of messages.
    pub(crate) fn write_categories(&self, xml: &mut Xml) {
        xml.open("LogCategories", &[]);
        for (name, description) in LOG_CATEGORIES {
            xml.leaf(
                "Category",
                &[("name", some(name)), ("description", some(description))],
            );
        }
        xml.close();
    }
}

/// The name of the type of numbers in a unit; no variable can have it.
pub(crate) fn type_name(unit: &NamedUnit) -> String {
    match unit.unit().is_si() {
        true => format!("Number in {}", unit.text()),
        false => format!("Number in {}, shown in {}", unit.si().text(), unit.text()),
    }
}

/// The start value as text, as a variable of its kind has it.
pub(crate) fn start(variable: &Variable) -> Option<String> {
    let start = variable.start?;
    Some(match variable.kind {
        hyde_units::Kind::Real => number(start),
        hyde_units::Kind::Integer => format!("{start:.0}"),
        hyde_units::Kind::Boolean => (start != 0.0).to_string(),
    })
}

/// A bound as text, as a variable of its kind has it.
pub(crate) fn bound(variable: &Variable, bound: Option<f64>) -> Option<String> {
    match variable.kind {
        hyde_units::Kind::Real => bound.map(number),
        hyde_units::Kind::Integer => bound.map(|bound| format!("{bound:.0}")),
        hyde_units::Kind::Boolean => None,
    }
}
