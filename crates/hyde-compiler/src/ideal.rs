//! The variants of an experiment that its `budget` asks for: the model with parts of it made ideal.

use crate::load::File;
use hyde_syntax::ast::{Change, Experiment, ExperimentItem, Ideal, Item};
use std::sync::Arc;

/// What the experiment's budget makes ideal, in the order written.
pub fn ideals(experiment: &Experiment) -> impl Iterator<Item = &Ideal> {
    let budgets = experiment.items.iter().filter_map(|item| match item {
        ExperimentItem::Budget(ideals) => Some(ideals),
        ExperimentItem::Stimulus(_)
        | ExperimentItem::Measured(_)
        | ExperimentItem::Replay(_)
        | ExperimentItem::Expect(..)
        | ExperimentItem::Measure(_)
        | ExperimentItem::Solve(..)
        | ExperimentItem::Start(_)
        | ExperimentItem::Stop(_)
        | ExperimentItem::Every(_)
        | ExperimentItem::Skip(_)
        | ExperimentItem::Bode(_)
        | ExperimentItem::Margins(_)
        | ExperimentItem::Figure(_) => None,
    });
    budgets.flatten()
}

impl File {
    /// The same files; the experiment's model with some of what its budget makes ideal.
    #[must_use]
    pub fn idealised(&self, experiment: &str, chosen: impl Fn(&Ideal) -> bool) -> Self {
        let mut file = self.clone();
        let own = file.files.iter_mut().take(1);
        for item in own.flat_map(|(_, tree)| &mut Arc::make_mut(tree).items) {
            if let Item::Experiment(found) = item
                && found.name.text == experiment
            {
                let ideal = ideals(found).filter(|ideal| chosen(ideal));
                let mut changes: Vec<Change> =
                    ideal.flat_map(|ideal| ideal.changes.clone()).collect();
                // Of changes of one parameter the first one counts.
                changes.append(&mut found.changes);
                found.changes = changes;
            }
        }
        file
    }
}

/// The parameters that an ideal changes, by their full names.
#[must_use]
pub fn changed(ideal: &Ideal) -> Vec<String> {
    let mut names = Vec::new();
    below(&ideal.changes, "", &mut names);
    names
}

fn below(changes: &[Change], above: &str, names: &mut Vec<String>) {
    for change in changes {
        let name = format!("{above}{}", change.target.dotted());
        below(&change.changes, &format!("{name}."), names);
        if change.value.is_some() {
            names.push(name);
        }
    }
}
