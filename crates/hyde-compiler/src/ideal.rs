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
                let ideal: Vec<&Ideal> = ideal.collect();
                let names: Vec<String> = ideal.iter().flat_map(|ideal| changed(ideal)).collect();
                let mut changes = found.changes.clone();
                keep_others(&mut changes, "", &names);
                changes.extend(ideal.iter().flat_map(|ideal| ideal.changes.clone()));
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
        let name = format!("{above}{}", hyde_syntax::format_reference(&change.target));
        below(&change.changes, &format!("{name}."), names);
        if change.value.is_some() {
            names.push(name);
        }
    }
}

/// Whether a change of what has one name is one of what has the other as well: `car.M` is `car[2].M` too.
#[must_use]
pub fn covers(name: &str, other: &str) -> bool {
    let all = |word: &str, one: &str| {
        word == one || one.split_once('[').is_some_and(|(array, _)| word == array)
    };
    let (words, others) = (name.split('.'), other.split('.'));
    words.clone().count() == others.clone().count()
        && words.zip(others).all(|(word, one)| all(word, one))
}

/// Leaves of some changes those of parameters that are not among the named ones.
fn keep_others(changes: &mut Vec<Change>, above: &str, names: &[String]) {
    changes.retain_mut(|change| {
        let name = format!("{above}{}", hyde_syntax::format_reference(&change.target));
        keep_others(&mut change.changes, &format!("{name}."), names);
        if names.iter().any(|ideal| covers(ideal, &name)) {
            (change.value, change.prior, change.source) = (None, None, None);
        }
        change.value.is_some()
            || change.prior.is_some()
            || change.source.is_some()
            || change.redeclare.is_some()
            || !change.changes.is_empty()
    });
}

#[cfg(test)]
mod tests {
    use super::covers;

    #[test]
    fn a_name_of_an_array_is_of_its_elements_too() {
        assert!(covers("car.M", "car[2].M"));
        assert!(covers("row[1].car.M", "row[1].car[2].M[3]"));
        assert!(!covers("car[2].M", "car.M"));
        assert!(!covers("car[2].M", "car[1].M"));
        assert!(!covers("car", "car.M"));
    }
}
