//! [`Found`]: what a check found in order, file by file, and as one object.

use crate::args::ModelArgs;
use crate::project::Project;
use hyde_compiler::{Alone, Compiled};
use hyde_present::{assumptions, states};
use hyde_program::Program;
use hyde_units::counted;
use serde_json::{Value, json};

/// What was in order.
#[derive(Default)]
pub(super) struct Found {
    pub(super) names: Vec<String>,
    /// The models whose states were looked at.
    models: Vec<String>,
    /// Lines on the states of each model.
    choices: Vec<String>,
    /// The states of each model as JSON.
    states: Vec<Value>,
    /// Warnings as JSON.
    pub(super) warnings: Vec<Value>,
    /// What was taken for granted of records and tables.
    notes: Vec<String>,
    /// The classes that were looked at by themselves.
    pub(super) alone: Alone,
}

impl Found {
    /// Adds what compiled: its name, its states, and what was assumed of its records.
    pub(super) fn add(&mut self, project: &Project, compiled: &Compiled) {
        let what = project.experiment.as_ref().map_or_else(
            || format!("model {}", project.model),
            |experiment| format!("experiment {experiment}"),
        );
        self.note(project, &compiled.program);
        let unknowns = counted(compiled.program.n_unknowns, "unknown");
        self.names.push(format!("{what} ({unknowns})"));
        if !self.models.contains(&project.model) {
            let (model, known) = (&project.model, &compiled.states);
            self.choices.extend(states::text(model, known, project));
            self.states.push(states::json(model, known, project));
            self.models.push(model.clone());
        }
    }

    /// Adds what was found in another file.
    pub(super) fn append(&mut self, other: Self) {
        self.names.extend(other.names);
        self.choices.extend(other.choices);
        self.states.extend(other.states);
        self.warnings.extend(other.warnings);
        self.notes.extend(other.notes);
        self.alone.classes.extend(other.alone.classes);
        self.alone.left_out.extend(other.alone.left_out);
    }

    /// All of it as one object.
    pub(super) fn json(&self) -> Value {
        json!({
            "ok": true, "checked": self.names, "states": self.states, "diagnostics": self.warnings,
            "notes": self.notes, "by_themselves": named(&self.alone.classes), "not_checked": named(&self.alone.left_out)
        })
    }

    /// Notes what is taken for granted of the records of an experiment, once for all experiments that read them.
    fn note(&mut self, project: &Project, program: &Program) {
        let tables = hyde_study::tables(&project.records);
        let parameters = hyde_experiment::parameters(program, &tables, &project.set());
        for note in parameters.map_or_else(
            |_| Vec::new(),
            |parameters| hyde_study::assumptions::of_model(project, program, &parameters),
        ) {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    /// All of it as lines.
    pub(super) fn text(&self, args: &ModelArgs) -> String {
        let alone = numbers(&self.alone.classes);
        let names = match (self.names.as_slice(), alone.as_str()) {
            ([], "") => "nothing to compile".to_owned(),
            ([], alone) => alone.to_owned(),
            (names, _) => names.join(", "),
        };
        let mut lines = vec![format!("{}: {names} in order", args.file.display())];
        if !self.names.is_empty() && !alone.is_empty() {
            lines.push(format!("  {alone}: names and units in order"));
        }
        if !self.alone.left_out.is_empty() {
            let list = named(&self.alone.left_out).join(", ");
            lines.push(format!("  not checked: {list}"));
        }
        lines.extend(self.choices.iter().cloned());
        let notes = assumptions::text(&self.notes);
        lines.extend(notes.lines().map(str::to_owned));
        lines.join("\n")
    }
}

/// `model Press`, for each class.
fn named(classes: &[(&str, String)]) -> Vec<String> {
    let each = classes.iter();
    each.map(|(kind, name)| format!("{kind} {name}")).collect()
}

/// `2 models, 1 effect`, in the order of the file.
fn numbers(classes: &[(&str, String)]) -> String {
    let mut numbers: Vec<(&str, usize)> = Vec::new();
    for (kind, _) in classes {
        match numbers.iter_mut().find(|known| known.0 == *kind) {
            Some((_, number)) => *number += 1,
            None => numbers.push((kind, 1)),
        }
    }
    let each = numbers.into_iter();
    let each: Vec<String> = each.map(|(kind, number)| counted(number, kind)).collect();
    each.join(", ")
}
