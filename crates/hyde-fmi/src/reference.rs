//! [`Reference`]: what an FMU is expected to compute, as files in its archive: the run of its experiment, the inputs that drove
//! it, and what the experiment expects of it.
//!
//! The files are in the form of the layered standard FMI-LS-REF 1.0.0-alpha.1 (<https://github.com/modelica/fmi-ls-ref>), a
//! draft for FMI 2.0 and 3.0; the description of the experiment is in that of
//! <https://github.com/modelica/ma-hs-experiments>, also a draft.

use crate::description::Described;
use crate::interface::{Causality, reported};
use crate::xml::{Xml, number, some};
use hyde_experiment::Run;
use hyde_program::Program;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The folder of the files in the archive.
const FOLDER: &str = "extra/org.fmi-standard.fmi-ls-ref";

/// Files of an FMU that say what it is expected to compute.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Each with its place in the archive.
    pub(crate) files: Vec<(String, String)>,
    /// Where the run ended, in s, if that is before the stop of the experiment. There are no expectations then.
    pub until_s: Option<f64>,
}

impl Reference {
    /// The files for a run of an experiment. `program` is what was run: that of the FMU, or, if the importer sets inputs that
    /// the experiment drives, the one with these stimuli.
    #[must_use]
    pub fn of(described: &Described<'_>, experiment: &str, program: &Program, run: &Run) -> Self {
        let mut related = Vec::new();
        let mut files = Vec::new();
        let of = |causality| {
            let numbers = described.interface.with(causality);
            let all = &described.interface.variables;
            let known = numbers.map(|number| all[number].name.as_str());
            known.collect::<Vec<&str>>()
        };
        let inputs = table(program, run, &of(Causality::Input));
        let stimuli = inputs.map(|text| {
            let name = format!("{experiment}_in.csv");
            files.push((name.clone(), text));
            name
        });
        let outputs = table(program, run, &of(Causality::Output));
        let references = outputs.map(|text| {
            let name = format!("{experiment}_out.csv");
            files.push((name.clone(), text));
            related.push(("text/csv", name.clone(), "result", "results of `hyde run`"));
            name
        });
        let name = format!("{experiment}.exp");
        let text = written(described, experiment, run, [stimuli, references]);
        files.push((name.clone(), text));
        let about = "the experiment: times, inputs and results";
        related.push((
            "application/x-ma-hs-experiments",
            name,
            "experiment/smoke-test",
            about,
        ));
        let until_s = (run.stop_s < described.times.1).then_some(run.stop_s);
        let expected = expectations(program, run, experiment).filter(|_| until_s.is_none());
        if let Some(text) = expected {
            let name = format!("{experiment}_expect.json");
            files.push((name.clone(), text));
            let about = "expectations and measures of the experiment";
            related.push(("application/json", name, "testcase", about));
        }
        files.push(("fmi-ls-manifest.xml".to_owned(), manifest(&related)));
        let placed = files.into_iter();
        let placed = placed.map(|(name, text)| (format!("{FOLDER}/{name}"), text));
        Self {
            files: placed.collect(),
            until_s,
        }
    }
}

/// Variables over the time as the CSV of the Modelica Association: `time` first, values in SI, two rows at an event. `None` if
/// there is no variable.
fn table(program: &Program, run: &Run, names: &[&str]) -> Option<String> {
    let columns: Vec<_> = names
        .iter()
        .filter_map(|name| Some((*name, run.results.column(reported(program, name)?)?)))
        .collect();
    if columns.is_empty() {
        return None;
    }
    let mut text = "time".to_owned();
    for (name, _) in &columns {
        let plain = !name.contains([',', '"']);
        let _ = match plain {
            true => write!(text, ",{name}"),
            false => write!(text, ",\"{}\"", name.replace('"', "\"\"")),
        };
    }
    text.push('\n');
    for (row, t) in run.results.time.iter().enumerate() {
        text.push_str(&value(*t));
        for (_, column) in &columns {
            text.push(',');
            text.push_str(&value(column[row]));
        }
        text.push('\n');
    }
    Some(text)
}

/// A number that is read back to the same bits.
fn value(value: f64) -> String {
    match value.is_finite() && (value == 0.0 || (1e-4..1e9).contains(&value.abs())) {
        true => value.to_string(),
        false => number(value),
    }
}

/// The description of the experiment.
fn written(
    described: &Described<'_>,
    experiment: &str,
    run: &Run,
    [stimuli, references]: [Option<String>; 2],
) -> String {
    let mut xml = Xml::new();
    xml.open("Experiments", &[("name", some(&described.name))]);
    let description = described.description.clone();
    xml.open(
        "Experiment",
        &[
            ("name", some(experiment)),
            ("description", description),
            ("tolerance", some(number(run.tolerances.0))),
        ],
    );
    xml.leaf(
        "TransientSimulation",
        &[
            ("startTime", some(number(run.start.0))),
            ("stopTime", some(number(run.stop_s))),
            ("stepSize", described.every_s.map(number)),
        ],
    );
    for (element, source) in [("Stimuli", stimuli), ("References", references)] {
        if let Some(source) = source {
            xml.leaf(
                element,
                &[("type", some("text/csv")), ("source", Some(source))],
            );
        }
    }
    xml.finish()
}

/// What the experiment expects of the run and measures in it; `None` if it does neither.
fn expectations(program: &Program, run: &Run, experiment: &str) -> Option<String> {
    if run.measures.is_empty() {
        return None;
    }
    let known = program.experiment.measures.iter().zip(&run.measures);
    let of = |expectation: bool| -> Vec<Value> {
        let own = known.clone().filter(|(_, m)| m.expectation == expectation);
        let told = own.map(|(known, measure)| match expectation {
            true => json!({ "text": measure.name, "holds": measure.holds }),
            false => json!({
                "name": measure.name,
                "value": measure.value.is_finite().then_some(measure.value),
                "unit": known.unit.si().text(),
            }),
        });
        told.collect()
    };
    let told = json!({
        "experiment": experiment,
        "expectations": of(true),
        "measures": of(false),
    });
    Some(format!("{told:#}\n"))
}

/// The manifest: which files there are, and what each is for.
fn manifest(related: &[(&str, String, &str, &str)]) -> String {
    let mut xml = Xml::new();
    xml.open(
        "fmiReferences",
        &[
            (
                "xmlns:fmi-ls",
                some("http://fmi-standard.org/fmi-ls-manifest"),
            ),
            ("fmi-ls:fmi-ls-name", some("org.fmi-standard.fmi-ls-ref")),
            ("fmi-ls:fmi-ls-version", some("1.0.0-alpha.1")),
            (
                "fmi-ls:fmi-ls-description",
                some("Layered Standard providing information on related files included in an FMU."),
            ),
        ],
    );
    for (kind, source, role, description) in related {
        xml.leaf(
            "Related",
            &[
                ("type", some(kind)),
                ("source", some(source)),
                ("role", some(role)),
                ("description", some(description)),
            ],
        );
    }
    xml.finish()
}
