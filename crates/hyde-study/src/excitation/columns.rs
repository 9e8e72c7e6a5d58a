//! Which columns of its records an experiment reads, and which of them a signal may be designed for.

use hyde_syntax::ast::{Experiment, ExperimentItem, Expr, ExprKind, File};

/// A record and a column of it.
pub(crate) type Source = (String, String);

/// Every column of an experiment's records that the file names.
pub(super) fn all(file: &File, experiment: &Experiment) -> Vec<Source> {
    let mut found = Vec::new();
    file.each_expression(&mut |expr| of_expression(expr, experiment, &mut found));
    found
}

/// The columns that stimuli read and that are neither measured nor replayed, in the order written.
pub(crate) fn driven(experiment: &Experiment) -> Vec<Source> {
    let (mut driven, mut recorded) = (Vec::new(), Vec::new());
    for item in &experiment.items {
        match item {
            ExperimentItem::Stimulus(drives) => drives
                .iter()
                .for_each(|drive| of_expression(&drive.value, experiment, &mut driven)),
            ExperimentItem::Replay(drives) => drives
                .iter()
                .for_each(|drive| of_expression(&drive.value, experiment, &mut recorded)),
            ExperimentItem::Measured(channels) => channels
                .iter()
                .for_each(|channel| of_expression(&channel.signal, experiment, &mut recorded)),
            ExperimentItem::Expect(..)
            | ExperimentItem::Measure(_)
            | ExperimentItem::Solve(..)
            | ExperimentItem::Start(_)
            | ExperimentItem::Stop(_)
            | ExperimentItem::Every(_)
            | ExperimentItem::Skip(_)
            | ExperimentItem::Bode(_)
            | ExperimentItem::Margins(_)
            | ExperimentItem::Figure(_)
            | ExperimentItem::Budget(_) => {}
        }
    }
    driven.retain(|source| !recorded.contains(source));
    driven
}

fn of_expression(expr: &Expr, experiment: &Experiment, found: &mut Vec<Source>) {
    if let ExprKind::Reference(reference) = &expr.kind
        && let [record, column, ..] = reference.parts.as_slice()
    {
        let source = (record.name.text.clone(), column.name.text.clone());
        let mut records = experiment.records.iter();
        let is_column = records.any(|item| item.name.text == source.0)
            && !matches!(source.1.as_str(), "begin" | "end");
        if is_column && !found.contains(&source) {
            found.push(source);
        }
    }
    for child in expr.children() {
        of_expression(child, experiment, found);
    }
}
