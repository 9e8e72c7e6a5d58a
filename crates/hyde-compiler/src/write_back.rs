//! [`write_back`]: a model file with what was found: the old text, and behind it a model that has the effects.
//!
//! ```text
//! // Found by `hyde diagnose axis.hyde bench`: …
//! model Axis2 = Axis(saddle.M = 318.2 [kg]) with
//!   Effects.Stribeck(dF = 181 [N], vs = 8 [mm/s]) on guide;
//! experiment bench2(record file every 1 [ms]) of Axis2 …
//! ```

use crate::load::File;
use crate::modifications::{behind, modifications};
use hyde_flatten::{Candidate, Knob};
use hyde_program::Program;
use hyde_syntax::ast;
use hyde_units::{NamedUnit, significant};
use std::fmt::Write as _;

/// An effect that was found: a candidate with the values of its sizes and shapes by name, SI.
#[derive(Clone, Debug)]
pub struct Found<'a> {
    /// The effect and its site.
    pub candidate: &'a Candidate,
    /// Name and value, SI; a shape that is left out keeps its declared value.
    pub values: Vec<(String, f64)>,
}

/// A parameter with the value that a calibration gave it.
#[derive(Clone, Debug)]
pub struct Calibrated {
    /// Its full name.
    pub path: String,
    /// Its value, SI.
    pub value: f64,
    /// The unit it is written in.
    pub unit: NamedUnit,
}

/// A new model file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Written {
    /// Its text: that of the user's file with the new model and its experiment behind.
    pub text: String,
    /// What the new model is called.
    pub model: String,
    /// What its experiment is called, if one was asked for.
    pub experiment: Option<String>,
}

/// Digits of a number that was found: more than it is known to, so that nothing is lost by writing it down.
const DIGITS: usize = 7;

/// Writes down what was found. `at` is the program that was calibrated with its parameter vector, and `about` says where the
/// numbers come from, one line each.
#[must_use]
pub fn write_back(
    file: &File,
    text: &str,
    (model, experiment): (&str, Option<&str>),
    (found, calibrated): (&[Found<'_>], &[Calibrated]),
    at: (&Program, &[f64]),
    about: &[String],
) -> Written {
    let taken = |name: &str| {
        file.models().any(|known| known == name) || file.effects().any(|known| known == name)
    };
    let new_model = fresh(model, &taken);
    let mut out = format!("{}\n\n", text.trim_end());
    for line in about {
        let _ = writeln!(out, "// {line}");
    }
    let mut effects: Vec<String> = Vec::new();
    let mut names: Vec<(String, String)> = Vec::new();
    for one in found {
        let class = one.candidate.name();
        // An effect can be on a site once: the second one, in the model or here, takes a name of its own.
        let again = one.candidate.instance != class
            || names.contains(&(class.to_owned(), one.candidate.site.clone()));
        names.push((class.to_owned(), one.candidate.site.clone()));
        let name = match again {
            false => one.candidate.effect.clone(),
            true => {
                let declared = |name: &str| {
                    let own = |e: &String| e.split(['(', ' ']).next() == Some(name);
                    taken(name) || effects.iter().any(own)
                };
                let name = fresh(class, &declared);
                let last = one.candidate.host.rsplit('.').next().unwrap_or_default();
                let host = match one.candidate.host_package.as_str() {
                    "" => last.to_owned(),
                    package => format!("{package}.{last}"),
                };
                let _ = writeln!(
                    out,
                    "effect {name} on {host}\n  extends {};\nend {name};\n",
                    one.candidate.effect
                );
                name
            }
        };
        let values: Vec<String> = one
            .values
            .iter()
            .map(|(knob, value)| setting(one.candidate, knob, *value))
            .collect();
        let values = match values.as_slice() {
            [] => String::new(),
            list => format!("({})", list.join(", ")),
        };
        effects.push(format!("{name}{values} on {}", one.candidate.site));
    }
    let changes = modifications(calibrated, at, &|value| significant(value, DIGITS));
    let _ = write!(out, "model {new_model} = {model}");
    if !changes.is_empty() {
        let _ = write!(out, "(\n  {})", changes.join(",\n  "));
    }
    if !effects.is_empty() {
        let _ = write!(out, " with\n  {}", effects.join(",\n  "));
    }
    out.push_str(";\n");
    let written = experiment.and_then(|name| {
        let old = file.experiments().find(|old| old.name.text == name)?;
        let mut new = old.clone();
        let named = |wanted: &str| file.experiments().any(|known| known.name.text == wanted);
        new.name.text = fresh(name, &named);
        new.model.parts.truncate(1);
        new.model.parts[0].name.text.clone_from(&new_model);
        Some(new)
    });
    let experiment = written.map(|new| {
        let name = new.name.text.clone();
        let tree = ast::File {
            package: None,
            imports: Vec::new(),
            items: vec![ast::Item::Experiment(new)],
        };
        out.push_str(&hyde_syntax::format(&tree));
        name
    });
    Written {
        text: out,
        model: new_model,
        experiment,
    }
}

/// The name with the first number from 2 on that is not taken: `Axis2`, and `Axis3` from `Axis2`.
fn fresh(name: &str, taken: &dyn Fn(&str) -> bool) -> String {
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let mut names = (2..).map(|number: usize| format!("{stem}{number}"));
    names
        .find(|name| !taken(name))
        .unwrap_or_else(|| name.to_owned())
}

/// `dF = 181 [N]`, in the unit that the effect declares.
fn setting(candidate: &Candidate, name: &str, value: f64) -> String {
    let mut knobs = candidate.sizes.iter().chain(&candidate.shapes);
    match knobs.find(|knob| knob.name == name) {
        Some(Knob { integer: true, .. }) => format!("{name} = {}", value.round()),
        Some(knob) => assigned(name, value, &knob.quantity.unit),
        None => format!("{name} = {value}"),
    }
}

/// `dF = 181 [N]`
fn assigned(name: &str, si: f64, unit: &NamedUnit) -> String {
    let number = significant(unit.unit().from_si(si), DIGITS);
    format!("{name} = {number}{}", behind(unit))
}
