//! The names in experiments and studies.

use super::{Frame, Walk};
use crate::scope::{Definition, Inside, Thing};
use hyde_syntax::ast::{
    Experiment, ExperimentItem, Expr, ExprKind, Name, Reference, SettingValue, Study, StudyItem,
    StudyKind, Varied,
};

impl<'a> Walk<'a> {
    pub(super) fn experiment(&mut self, experiment: &'a Experiment) {
        let file = self.file;
        self.declare(Definition {
            file,
            name: &experiment.name,
            thing: Thing::Experiment(experiment),
        });
        for record in &experiment.records {
            self.declare(Definition {
                file,
                name: &record.name,
                thing: Thing::Record(record),
            });
            record.every.iter().for_each(|every| self.expression(every));
        }
        self.class_name(&experiment.model);
        self.in_experiment(experiment, |walk| {
            walk.changes_of_class(&experiment.model, &experiment.changes);
            for item in &experiment.items {
                walk.experiment_item(item, experiment);
            }
        });
    }

    /// Walks with the names of an experiment: its own before those of its model.
    fn in_experiment(&mut self, experiment: &'a Experiment, inner: impl FnOnce(&mut Self)) {
        let file = self.file;
        self.in_model(&experiment.model, |walk| {
            walk.within(Frame::Experiment(file, experiment), inner);
        });
    }

    fn in_model(&mut self, model: &Reference, inner: impl FnOnce(&mut Self)) {
        match self.files.class(self.file, model) {
            Some((file, class)) => self.within(Frame::Inside(Inside::Class(file, class)), inner),
            None => inner(self),
        }
    }

    fn experiment_item(&mut self, item: &'a ExperimentItem, experiment: &'a Experiment) {
        match item {
            ExperimentItem::Stimulus(drives) | ExperimentItem::Replay(drives) => {
                for drive in drives {
                    self.reference(&drive.target);
                    self.expression(&drive.value);
                    drive.noise.iter().for_each(|noise| self.expression(noise));
                }
            }
            ExperimentItem::Measured(channels) => {
                for channel in channels {
                    self.expression(&channel.signal);
                    self.expression(&channel.value);
                    channel
                        .noise
                        .iter()
                        .for_each(|noise| self.expression(noise));
                }
            }
            ExperimentItem::Expect(value, _)
            | ExperimentItem::Start(value)
            | ExperimentItem::Stop(value)
            | ExperimentItem::Every(value)
            | ExperimentItem::Skip(value) => self.expression(value),
            ExperimentItem::Measure(measure) => self.measure(measure, None),
            ExperimentItem::Solve(_, arguments) => self.arguments(arguments),
            ExperimentItem::Bode(bode) => {
                self.reference(&bode.input);
                self.expressions(&bode.outputs);
                self.range(&bode.band);
                if let Some((_, arguments)) = &bode.steps {
                    self.arguments(arguments);
                }
                self.point(bode.at.as_ref());
                self.in_modes(&bode.modes);
            }
            ExperimentItem::Margins(margins) => {
                margins.signals.iter().for_each(|own| self.reference(own));
                margins.band.iter().for_each(|range| self.range(range));
                self.point(margins.at.as_ref());
                self.in_modes(&margins.modes);
            }
            ExperimentItem::Figure(figure) => {
                self.expressions(&figure.panels);
                figure.over.iter().for_each(|over| self.expression(over));
                figure.within.iter().for_each(|range| self.range(range));
            }
            ExperimentItem::Budget(ideals) => {
                for ideal in ideals {
                    self.changes_of_class(&experiment.model, &ideal.changes);
                }
            }
        }
    }

    /// `at 0.3 [s]`; `start` and `steady` are words of the language.
    fn point(&mut self, at: Option<&'a Expr>) {
        let word = |expr: &Expr| {
            matches!(&expr.kind, ExprKind::Reference(name)
                if matches!(name.as_word(), Some("start" | "steady")))
        };
        at.filter(|at| !word(at))
            .into_iter()
            .for_each(|at| self.expression(at));
    }

    /// `in guide = slip`
    fn in_modes(&mut self, modes: &'a [(Reference, Name)]) {
        for (instance, mode) in modes {
            let before = self.found.len();
            self.reference(instance);
            let own = &self.found[before..];
            let last = own.iter().rfind(|found| {
                let part = instance.parts.last();
                part.is_some_and(|part| part.name.span == found.span)
            });
            let meaning = last.and_then(|last| last.meaning);
            let meaning = meaning.and_then(|own| self.files.mode(own, &mode.text));
            self.add(mode, meaning);
        }
    }

    pub(super) fn study(&mut self, study: &'a Study) {
        let file = self.file;
        self.declare(Definition {
            file,
            name: &study.name,
            thing: Thing::Study(study),
        });
        let word = study.of.as_word().unwrap_or_default();
        let experiment = self.files.experiment(file, word);
        match study.kind {
            StudyKind::Calibrate => {
                self.class_name(&study.of);
                study.also.iter().for_each(|other| self.class_name(other));
                self.in_model(&study.of, |walk| walk.study_items(study));
            }
            StudyKind::Sweep => {
                if let (Some(experiment), Some(part)) = (experiment, study.of.parts.first()) {
                    self.add(&part.name, Some(experiment_definition(file, experiment)));
                    self.in_experiment(experiment, |walk| walk.study_items(study));
                } else {
                    self.study_items(study);
                }
            }
            StudyKind::Diagnose => {
                let calibration = self.files.study(file, word);
                let meaning = calibration.map(|own| Definition {
                    file,
                    name: &own.name,
                    thing: Thing::Study(own),
                });
                if let Some(part) = study.of.parts.first() {
                    self.add(&part.name, meaning);
                }
                match calibration {
                    Some(own) => self.in_model(&own.of, |walk| walk.study_items(study)),
                    None => self.study_items(study),
                }
            }
        }
    }

    fn study_items(&mut self, study: &'a Study) {
        for item in &study.items {
            match item {
                StudyItem::Vary(variations) => {
                    for variation in variations {
                        if variation.what != Varied::Model {
                            self.reference(&variation.target);
                        }
                        variation.within.iter().for_each(|range| self.range(range));
                        variation.values.iter().for_each(|own| self.setting(own));
                    }
                }
                StudyItem::VaryEffects(effects) => {
                    effects.iter().for_each(|used| self.effect_use(used));
                }
                StudyItem::Setting(_, values, _) => {
                    for value in values {
                        match value {
                            SettingValue::Everything(path) => {
                                let index = self.files.package(&path.dotted());
                                let meaning =
                                    index.and_then(|own| self.files.package_definition(own));
                                if let Some(last) = path.parts.last() {
                                    self.add(&last.name, meaning);
                                }
                            }
                            SettingValue::Expr(expr) => self.setting(expr),
                        }
                    }
                }
            }
        }
    }

    /// A value of a setting: `bench("fit-*.csv")`, an effect, a parameter, a word.
    fn setting(&mut self, expr: &'a Expr) {
        if let ExprKind::Array(items, _) = &expr.kind {
            items.iter().for_each(|item| self.setting(item));
            return;
        }
        let (name, arguments) = if let ExprKind::Reference(name) = &expr.kind {
            (name, [].as_slice())
        } else if let ExprKind::Call(name, arguments) = &expr.kind {
            (name, arguments.as_slice())
        } else {
            return self.expression(expr);
        };
        let file = self.file;
        let word = name.as_word().unwrap_or_default();
        if let (Some(experiment), Some(part)) =
            (self.files.experiment(file, word), name.parts.first())
        {
            self.add(&part.name, Some(experiment_definition(file, experiment)));
        } else if self.files.item(file, name).is_some() {
            self.type_name(name);
        } else if !["uncertain", "all"].contains(&word) {
            self.reference(name);
        }
        self.arguments(arguments);
    }
}

fn experiment_definition(file: usize, experiment: &Experiment) -> Definition<'_> {
    Definition {
        file,
        name: &experiment.name,
        thing: Thing::Experiment(experiment),
    }
}
