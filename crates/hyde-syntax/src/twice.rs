//! What a file says twice where it counts once: names of models, experiments and studies, of modes, clocks and measures, `stop` and
//! the like, and arguments. One of the two would be without effect.
//!
//! Variables of a class are told apart where bases and effects are known too, when the model is instantiated.

use crate::ast::{
    Argument, Class, ClassBody, Declared, Element, Experiment, ExperimentItem, Expr, ExprKind,
    File, Item, Name, Study, StudyItem, StudyKind, Varied,
};
use crate::refusals;
use hyde_diag::{Diagnostics, Span};
use std::collections::BTreeMap;

/// Reports what is said twice.
pub(crate) fn refuse_twice(file: &File, diagnostics: &mut Diagnostics) {
    let (mut classes, mut experiments) = (Vec::new(), Vec::new());
    // A calibration and the diagnosis of it may have one name.
    let mut studies: BTreeMap<&str, Vec<&Name>> = BTreeMap::new();
    for item in &file.items {
        match item {
            Item::Type(own) => classes.push(&own.name),
            Item::Class(own) => {
                classes.push(&own.name);
                class(own, diagnostics);
            }
            Item::Experiment(own) => {
                experiments.push(&own.name);
                experiment(own, diagnostics);
            }
            Item::Study(own) => {
                studies.entry(own.kind.word()).or_default().push(&own.name);
                study(own, diagnostics);
            }
        }
    }
    let all = [classes, experiments]
        .into_iter()
        .chain(studies.into_values());
    all.for_each(|names| each_once(&names, diagnostics));
    file.each_expression(&mut |expr| calls(expr, diagnostics));
}

fn class(class: &Class, diagnostics: &mut Diagnostics) {
    if let ClassBody::Long { elements, .. } = &class.body {
        members(elements, diagnostics);
    }
}

fn members(elements: &[Element], diagnostics: &mut Diagnostics) {
    let mut known: BTreeMap<&str, (Span, bool)> = BTreeMap::new();
    for (name, declared) in elements.iter().flat_map(Element::declared) {
        let variable = matches!(declared, Declared::Variable(..));
        let first = known.entry(&name.text).or_insert((name.span, variable));
        if first.0 != name.span && !(first.1 && variable) {
            diagnostics.push(refusals::declared_twice(name, first.0));
        }
    }
    for element in elements {
        match element {
            Element::Modes(modes) => {
                let names: Vec<&Name> = modes.modes.iter().map(|mode| &mode.name).collect();
                each_once(&names, diagnostics);
                arguments(&modes.arguments, diagnostics);
                let exits = modes.modes.iter().flat_map(|mode| &mode.exits);
                exits.for_each(|exit| arguments(&exit.arguments, diagnostics));
            }
            Element::Clocked(clocked) => {
                arguments(&clocked.arguments, diagnostics);
                members(&clocked.elements, diagnostics);
            }
            Element::Discretize(method) => arguments(&method.arguments, diagnostics),
            Element::Extends(..)
            | Element::Declaration(_)
            | Element::Domain(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Replace(..)
            | Element::Signature(_)
            | Element::Confounds(_)
            | Element::Measure(_)
            | Element::Account(..) => {}
        }
    }
}

fn experiment(experiment: &Experiment, diagnostics: &mut Diagnostics) {
    let records: Vec<&Name> = experiment.records.iter().map(|own| &own.name).collect();
    each_once(&records, diagnostics);
    let mut measures = Vec::new();
    let mut said: Vec<(&str, Span)> = Vec::new();
    for item in &experiment.items {
        let one = match item {
            ExperimentItem::Measure(measure) => {
                measures.push(&measure.name);
                continue;
            }
            ExperimentItem::Solve(method, own) => {
                arguments(own, diagnostics);
                ("solve", method.span)
            }
            ExperimentItem::Start(time) => ("start", time.span),
            ExperimentItem::Stop(time) => ("stop", time.span),
            ExperimentItem::Every(time) => ("every", time.span),
            ExperimentItem::Skip(time) => ("skip", time.span),
            ExperimentItem::Stimulus(_)
            | ExperimentItem::Measured(_)
            | ExperimentItem::Replay(_)
            | ExperimentItem::Expect(..)
            | ExperimentItem::Bode(_)
            | ExperimentItem::Margins(_)
            | ExperimentItem::Figure(_)
            | ExperimentItem::Budget(_) => continue,
        };
        said.push(one);
    }
    each_once(&measures, diagnostics);
    each_said_once(&said, diagnostics);
}

/// Settings that a list of them may be parts of.
const SEVERAL: [&str; 4] = ["fit", "holdout", "keep", "candidates"];

fn study(study: &Study, diagnostics: &mut Diagnostics) {
    let (mut said, mut varied) = (Vec::new(), Vec::new());
    for item in &study.items {
        match item {
            StudyItem::Setting(name, ..) if !SEVERAL.contains(&name.text.as_str()) => {
                said.push((name.text.as_str(), name.span));
            }
            // A sweep tells it too of what its table of cases varies.
            StudyItem::Vary(list) if study.kind == StudyKind::Calibrate => {
                let parts = list.iter().filter(|one| one.what == Varied::Part);
                varied.extend(parts.map(|one| (&one.target, one.target.span)));
            }
            StudyItem::Setting(..) | StudyItem::Vary(_) | StudyItem::VaryEffects(_) => {}
        }
    }
    each_said_once(&said, diagnostics);
    let varied: Vec<(String, Span)> = varied
        .into_iter()
        .map(|(target, span)| (format!("vary {}", crate::format_reference(target)), span))
        .collect();
    let varied: Vec<(&str, Span)> = varied.iter().map(|(text, span)| (&**text, *span)).collect();
    each_said_once(&varied, diagnostics);
}

fn calls(expr: &Expr, diagnostics: &mut Diagnostics) {
    if let ExprKind::Call(_, own) = &expr.kind {
        arguments(own, diagnostics);
    }
    for child in expr.children() {
        calls(child, diagnostics);
    }
}

fn arguments(list: &[Argument], diagnostics: &mut Diagnostics) {
    let named = list.iter().filter_map(|argument| argument.name.as_ref());
    let named: Vec<(&str, Span)> = named.map(|name| (&*name.text, name.span)).collect();
    each_said_once(&named, diagnostics);
}

fn each_once(names: &[&Name], diagnostics: &mut Diagnostics) {
    let mut known: BTreeMap<&str, Span> = BTreeMap::new();
    for name in names {
        if let Some(first) = known.get(&*name.text) {
            diagnostics.push(refusals::declared_twice(name, *first));
        } else {
            known.insert(&name.text, name.span);
        }
    }
}

fn each_said_once(words: &[(&str, Span)], diagnostics: &mut Diagnostics) {
    let mut known: BTreeMap<&str, Span> = BTreeMap::new();
    for (word, here) in words {
        if let Some(first) = known.get(word) {
            diagnostics.push(refusals::said_twice(word, *here, *first));
        } else {
            known.insert(word, *here);
        }
    }
}
