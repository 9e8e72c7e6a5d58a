//! The variants of a model that a sweep's choices make: the user's file with other words in a few places.

use super::draft::{Choice, ChoiceOf, Draft};
use hyde_compiler::File;
use hyde_syntax::ast::{
    Argument, Change, Class, ClassBody, ClassKind, Drive, Experiment, ExperimentItem, Expr,
    ExprKind, Item, Name, Part, Reference,
};
use std::sync::Arc;

/// The file and the model of a variant: `options` has the number of an alternative for each choice of the draft.
///
/// What is chosen stands where a user would have written it, so that it is compiled, and complained of, like all else.
#[must_use]
pub fn varied(file: &File, draft: &Draft, model: &str, options: &[usize]) -> (File, String) {
    let mut file = file.clone();
    let mut model = model.to_owned();
    let mut used = Vec::new();
    for (choice, &option) in draft.choices().zip(options) {
        match &choice.what {
            ChoiceOf::Model => model.clone_from(&choice.options[option]),
            ChoiceOf::Effect(effect) if option == 1 => used.push(effect.clone()),
            ChoiceOf::Effect(_) | ChoiceOf::Record(_) => {}
            ChoiceOf::Component(target, models) => {
                if let Some(experiment) = experiment_of(&mut file, draft) {
                    redeclare(&mut experiment.changes, &target.parts, &models[option]);
                }
            }
            ChoiceOf::Stimulus(target, values) => {
                if let Some(experiment) = experiment_of(&mut file, draft) {
                    drive(experiment, target, &values[option]);
                }
            }
        }
    }
    if let (Some(first), Some((_, tree))) = (used.first(), file.files.first_mut()) {
        // A name that nobody can have written.
        let span = first.effect.span;
        let name = Name {
            text: format!("{model} with effects"),
            span,
        };
        let base = Reference::of_path(&model, span);
        model.clone_from(&name.text);
        Arc::make_mut(tree).items.push(Item::Class(Class {
            kind: ClassKind::Model,
            name,
            doc: None,
            body: ClassBody::Short {
                base,
                fmu: None,
                changes: Vec::new(),
                effects: used,
            },
            span,
        }));
    }
    (file, model)
}

/// The files of records that a variant reads instead of the experiment's own: record and file.
#[must_use]
pub fn record_files<'d>(draft: &'d Draft, options: &[usize]) -> Vec<(&'d str, &'d str)> {
    let pairs = draft.choices().zip(options);
    let files = pairs.filter_map(|(choice, &option): (&Choice, _)| match &choice.what {
        ChoiceOf::Record(name) => Some((name.as_str(), choice.options[option].as_str())),
        ChoiceOf::Model
        | ChoiceOf::Effect(_)
        | ChoiceOf::Component(..)
        | ChoiceOf::Stimulus(..) => None,
    });
    files.collect()
}

fn experiment_of<'f>(file: &'f mut File, draft: &Draft) -> Option<&'f mut Experiment> {
    let (_, tree) = file.files.first_mut()?;
    Arc::make_mut(tree)
        .items
        .iter_mut()
        .find_map(|item| match item {
            Item::Experiment(experiment) if experiment.name.text == draft.experiment => {
                Some(experiment)
            }
            Item::Experiment(_) | Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        })
}

/// `(screw(redeclare GapContact contact(gap = 20 [um])))` among the changes of an experiment.
fn redeclare(changes: &mut Vec<Change>, path: &[Part], model: &Expr) {
    let [first, below @ ..] = path else { return };
    let target = Reference {
        parts: vec![first.clone()],
        span: first.name.span,
    };
    if below.is_empty() {
        let (class, arguments): (&Reference, &[Argument]) =
            if let ExprKind::Call(class, arguments) = &model.kind {
                (class, arguments)
            } else if let ExprKind::Reference(class) = &model.kind {
                (class, &[])
            } else {
                return;
            };
        changes.retain(|change| {
            change.target.as_word() != Some(&first.name.text) || change.redeclare.is_none()
        });
        let arguments = arguments.iter().filter_map(|argument| {
            let name = argument.name.clone()?;
            let target = Reference {
                span: name.span,
                parts: vec![Part {
                    name,
                    subscripts: Vec::new(),
                }],
            };
            Some(Change {
                value: Some(argument.value.clone()),
                ..change(target)
            })
        });
        changes.push(Change {
            redeclare: Some(class.clone()),
            changes: arguments.collect(),
            ..change(target)
        });
        return;
    }
    let known = changes
        .iter_mut()
        .find(|change| change.target.as_word() == Some(&first.name.text));
    match known {
        Some(known) => redeclare(&mut known.changes, below, model),
        None => {
            let mut new = change(target);
            redeclare(&mut new.changes, below, model);
            changes.push(new);
        }
    }
}

fn change(target: Reference) -> Change {
    Change {
        target,
        redeclare: None,
        each: false,
        is_final: false,
        changes: Vec::new(),
        value: None,
        prior: None,
        source: None,
    }
}

/// Drives an input by this and nothing else.
fn drive(experiment: &mut Experiment, target: &Reference, value: &Expr) {
    let name = hyde_syntax::format_reference(target);
    for item in &mut experiment.items {
        if let ExperimentItem::Stimulus(drives) = item {
            drives.retain(|drive| !drive.drives(&name));
        }
    }
    let drive = Drive {
        target: target.clone(),
        value: value.clone(),
        noise: None,
    };
    experiment.items.push(ExperimentItem::Stimulus(vec![drive]));
}
