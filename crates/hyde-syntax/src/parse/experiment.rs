//! Experiments and studies, element by element.

use super::Parser;
use super::build::{Builder, Node, has, parts, significant};
use crate::ast::{
    Bode, Channel, Drive, Experiment, ExperimentItem, Expr, Figure, Ideal, Label, LayoutSetting,
    Margins, Name, Part, RecordItem, Reference, SettingValue, Study, StudyItem, StudyKind,
    Variation, Varied,
};
use crate::grammar::Rule;
use crate::{habits, recover};
use hyde_diag::Span;

impl Parser<'_> {
    pub(super) fn experiment(&mut self) -> Option<Experiment> {
        let start = self.at;
        let pairs = self.expect(Rule::experiment_header)?;
        let node = significant(pairs).next()?;
        let mut build = self.build(start);
        let (mut name, mut model, mut doc) = (None, None, None);
        let (mut records, mut changes) = (Vec::new(), Vec::new());
        for part in parts(node) {
            match part.as_rule() {
                Rule::ident => name = Some(build.name(&part)),
                Rule::records => {
                    records = parts(part)
                        .filter_map(|record| build.record(record))
                        .collect()
                }
                Rule::path => model = Some(build.reference(part)),
                Rule::modification => changes = build.changes(part),
                _ => doc = Some(Builder::text(part)),
            }
        }
        let (name, model) = (name?, model?);
        let mut items = Vec::new();
        self.body(&name, Rule::experiment_item, |build, node| {
            build.experiment_item(node, &mut items)
        });
        Some(Experiment {
            name,
            records,
            model,
            changes,
            doc,
            items,
            span: Span::new(self.file, start, self.at),
        })
    }

    pub(super) fn study(&mut self) -> Option<Study> {
        let start = self.at;
        let pairs = self.expect(Rule::study_header)?;
        let node = significant(pairs).next()?;
        let mut build = self.build(start);
        let (mut kind, mut name, mut doc) = (StudyKind::Sweep, None, None);
        let mut models = Vec::new();
        // `of calibrate bench` names a calibration: the keyword is a child of the header, not of its kind.
        for part in parts(node) {
            match part.as_rule() {
                Rule::study_kind => kind = study_kind(&part),
                Rule::ident => name = Some(build.name(&part)),
                Rule::path => models.push(build.reference(part)),
                Rule::doc => doc = Some(Builder::text(part)),
                _ => {}
            }
        }
        let name = name?;
        let mut models = models.into_iter();
        let of = models.next()?;
        let mut items = Vec::new();
        self.body(&name, Rule::study_item, |build, node| {
            build.study_item(node, &mut items)
        });
        Some(Study {
            kind,
            name,
            of,
            also: models.collect(),
            doc,
            items,
            span: Span::new(self.file, start, self.at),
        })
    }

    /// Elements by `rule` up to `end NAME;`.
    fn body(
        &mut self,
        name: &crate::ast::Name,
        rule: Rule,
        mut add: impl FnMut(&mut Builder<'_>, Node<'_>),
    ) {
        while self.more() {
            let start = self.at;
            if self.looking_at("end") {
                self.end(name);
                return;
            }
            if self.refuse_too_deep() {
                continue;
            }
            let Some(pairs) = self.expect(rule) else {
                let comment = habits::behind_comment(self.text, start);
                let behind = comment.unwrap_or_else(|| recover::skip_statement(self.text, start));
                self.at = behind.max(start + 1);
                if self.at_item() {
                    break;
                }
                continue;
            };
            for node in significant(pairs) {
                add(&mut self.build(start), node);
            }
        }
        self.missing_end(name);
    }
}

impl Builder<'_> {
    pub(super) fn record(&mut self, node: Node<'_>) -> Option<RecordItem> {
        let mut inner = parts(node);
        let mut record = RecordItem {
            name: self.name(&inner.next()?),
            layout: Vec::new(),
            kind: None,
            every: None,
            default: None,
        };
        for part in inner {
            match part.as_rule() {
                Rule::string => record.default = Some(self.quoted_name(&part)),
                Rule::layout => {
                    let settings = parts(part);
                    let settings = settings.filter_map(|setting| self.layout_setting(setting));
                    record.layout.extend(settings);
                }
                Rule::layout_kind => {
                    record.kind = parts(part).next().map(|word| self.name(&word));
                }
                _ => record.every = Some(self.expression(part)),
            }
        }
        Some(record)
    }

    fn layout_setting(&mut self, node: Node<'_>) -> Option<LayoutSetting> {
        let mut inner = parts(node);
        let name = self.name(&inner.next()?);
        let value = inner.next()?;
        let number = (value.as_rule() == Rule::number).then(|| self.number(&value));
        let mut setting = LayoutSetting {
            name,
            value: match number {
                Some(_) => self.name(&value),
                None => self.quoted_name(&value),
            },
            number,
            unit: None,
            wraps: None,
        };
        for part in inner {
            match part.as_rule() {
                Rule::layout_wraps => {
                    setting.wraps = parts(part).next().map(|number| self.number(&number));
                }
                Rule::layout_unit => {
                    let mut count = None;
                    for part in parts(part) {
                        match part.as_rule() {
                            Rule::number => count = Some(self.number(&part)),
                            _ => setting.unit = Some((count, self.unit(part))),
                        }
                    }
                }
                _ => {}
            }
        }
        Some(setting)
    }

    fn experiment_item(&mut self, node: Node<'_>, items: &mut Vec<ExperimentItem>) {
        match node.as_rule() {
            Rule::stimulus => items.push(ExperimentItem::Stimulus(self.drives(node))),
            Rule::replay => items.push(ExperimentItem::Replay(self.drives(node))),
            Rule::measured => {
                let channels = parts(node)
                    .filter_map(|channel| self.channel(channel))
                    .collect();
                items.push(ExperimentItem::Measured(channels));
            }
            Rule::expect => {
                let mut inner = parts(node);
                if let Some(condition) = inner.next() {
                    let condition = self.expression(condition);
                    items.push(ExperimentItem::Expect(
                        condition,
                        inner.next().map(Self::text),
                    ));
                }
            }
            Rule::measure => items.extend(self.measure(parts(node)).map(ExperimentItem::Measure)),
            Rule::bode => items.extend(self.bode(node)),
            Rule::margins => items.push(self.margins(node)),
            Rule::figure => items.extend(self.figure(node)),
            Rule::budget => {
                let ideals = parts(node).filter_map(|ideal| self.ideal(ideal)).collect();
                items.push(ExperimentItem::Budget(ideals));
            }
            _ => {
                for part in parts(node) {
                    items.extend(self.run_part(part));
                }
            }
        }
    }

    /// `solve …`, `stop …`, `every …`: any of them in one statement.
    fn run_part(&mut self, node: Node<'_>) -> Option<ExperimentItem> {
        match node.as_rule() {
            Rule::solve => {
                let mut inner = parts(node);
                let method = self.name(&inner.next()?);
                let arguments = inner
                    .next()
                    .map_or_else(Vec::new, |part| self.arguments(part));
                Some(ExperimentItem::Solve(method, arguments))
            }
            Rule::start => self.first_expression(node).map(ExperimentItem::Start),
            Rule::stop => self.first_expression(node).map(ExperimentItem::Stop),
            Rule::skip => self.first_expression(node).map(ExperimentItem::Skip),
            _ => self.first_expression(node).map(ExperimentItem::Every),
        }
    }

    fn drives(&mut self, node: Node<'_>) -> Vec<Drive> {
        parts(node)
            .filter_map(|drive| {
                let mut inner = parts(drive);
                let target = self.reference(inner.next()?);
                Some(Drive {
                    target,
                    value: self.expression(inner.next()?),
                    noise: inner.next().and_then(|noise| self.first_expression(noise)),
                })
            })
            .collect()
    }

    fn channel(&mut self, node: Node<'_>) -> Option<Channel> {
        let mut inner = parts(node);
        let signal = self.expression(inner.next()?);
        let value = self.expression(inner.next()?);
        let mut channel = Channel {
            signal,
            value,
            noise: None,
            doc: None,
        };
        for part in inner {
            if part.as_rule() == Rule::doc {
                channel.doc = Some(Self::text(part));
            } else {
                channel.noise = self.first_expression(part);
            }
        }
        Some(channel)
    }

    fn bode(&mut self, node: Node<'_>) -> Option<ExperimentItem> {
        let mut inner = parts(node);
        let input = self.reference(inner.next()?);
        let (mut outputs, mut band, mut modes) = (Vec::new(), None, Vec::new());
        let (mut steps, mut at) = (None, None);
        for part in inner {
            match part.as_rule() {
                Rule::range => band = self.range(part),
                Rule::by_steps => {
                    let mut words = parts(part);
                    let name = self.name(&words.next()?);
                    let arguments = words.next().map(|list| self.arguments(list));
                    steps = Some((name, arguments.unwrap_or_default()));
                }
                Rule::at_point => at = self.point(part),
                Rule::in_modes => modes = self.in_modes(part),
                _ => outputs.push(self.expression(part)),
            }
        }
        Some(ExperimentItem::Bode(Bode {
            input,
            outputs,
            band: band?,
            steps,
            at,
            modes,
        }))
    }

    fn margins(&mut self, node: Node<'_>) -> ExperimentItem {
        let mut margins = Margins {
            signals: Vec::new(),
            band: None,
            at: None,
            modes: Vec::new(),
        };
        for part in parts(node) {
            match part.as_rule() {
                Rule::range => margins.band = self.range(part),
                Rule::at_point => margins.at = self.point(part),
                Rule::in_modes => margins.modes = self.in_modes(part),
                _ => margins.signals.push(self.reference(part)),
            }
        }
        ExperimentItem::Margins(margins)
    }

    /// `at 0.3 [s]`, `at steady`
    fn point(&mut self, node: Node<'_>) -> Option<Expr> {
        parts(node).next().map(|part| self.expression(part))
    }

    /// `in guide = slip, clutch = locked`
    fn in_modes(&mut self, node: Node<'_>) -> Vec<(Reference, Name)> {
        let pairs = parts(node).filter_map(|mode| {
            let mut words = parts(mode);
            let instance = self.reference(words.next()?);
            Some((instance, self.name(&words.next()?)))
        });
        pairs.collect()
    }

    fn figure(&mut self, node: Node<'_>) -> Option<ExperimentItem> {
        let mut inner = parts(node);
        let mut figure = Figure {
            name: self.name(&inner.next()?),
            panels: Vec::new(),
            over: None,
            within: None,
            doc: None,
        };
        for part in inner {
            match part.as_rule() {
                Rule::over_what => figure.over = self.first_expression(part),
                Rule::within => {
                    figure.within = parts(part).next().and_then(|range| self.range(range))
                }
                Rule::doc => figure.doc = Some(Self::text(part)),
                _ => figure.panels.push(self.expression(part)),
            }
        }
        Some(ExperimentItem::Figure(figure))
    }

    fn ideal(&mut self, node: Node<'_>) -> Option<Ideal> {
        let mut inner = parts(node);
        Some(Ideal {
            name: self.name(&inner.next()?),
            changes: inner
                .next()
                .map_or_else(Vec::new, |part| self.changes(part)),
            doc: inner.next().map(Self::text),
        })
    }

    fn study_item(&mut self, node: Node<'_>, items: &mut Vec<StudyItem>) {
        if node.as_rule() == Rule::vary {
            let (mut variations, mut effects) = (Vec::new(), Vec::new());
            for part in parts(node) {
                if part.as_rule() == Rule::vary_effect {
                    effects.extend(parts(part).filter_map(|part| self.effect_use(part)));
                } else {
                    variations.extend(self.variation(part));
                }
            }
            items.push(match effects.as_slice() {
                [] => StudyItem::Vary(variations),
                [..] => StudyItem::VaryEffects(effects),
            });
            return;
        }
        let mut inner = parts(node);
        let Some(name) = inner.next() else { return };
        let name = self.name(&name);
        let (mut values, mut labels) = (Vec::new(), Vec::new());
        for value in inner {
            if value.as_rule() == Rule::at_labels {
                labels.extend(parts(value).filter_map(|part| self.label(part)));
                continue;
            }
            for part in parts(value) {
                if part.as_rule() == Rule::wildcard {
                    values.extend(
                        parts(part)
                            .next()
                            .map(|path| SettingValue::Everything(self.reference(path))),
                    );
                } else {
                    values.push(SettingValue::Expr(self.expression(part)));
                }
            }
        }
        items.push(StudyItem::Setting(name, values, labels));
    }

    fn label(&mut self, node: Node<'_>) -> Option<Label> {
        let mut inner = parts(node);
        Some(Label {
            name: self.name(&inner.next()?),
            value: self.expression(inner.next()?),
        })
    }

    fn variation(&mut self, node: Node<'_>) -> Option<Variation> {
        let mut inner = parts(node).peekable();
        let mut what = Varied::Part;
        let mut target = None;
        if let Some(word) = inner.next_if(|part| part.as_rule() == Rule::varied_model) {
            what = Varied::Model;
            let name = self.name(&word);
            target = Some(Reference {
                span: name.span,
                parts: vec![Part {
                    name,
                    subscripts: Vec::new(),
                }],
            });
        } else if let Some(word) = inner.next_if(|part| part.as_rule() == Rule::varied) {
            what = if has(&word, Rule::kw_stimulus) {
                Varied::Stimulus
            } else {
                Varied::Record
            };
        }
        let mut variation = Variation {
            what,
            target: match target {
                Some(target) => target,
                None => self.reference(inner.next()?),
            },
            within: None,
            values: None,
            per: None,
        };
        for part in inner {
            if part.as_rule() == Rule::per {
                variation.per = parts(part).next().map(|word| self.name(&word));
            } else if part.as_rule() == Rule::within {
                variation.within = parts(part).next().and_then(|range| self.range(range));
            } else {
                variation.values = self.first_expression(part);
            }
        }
        Some(variation)
    }
}

fn study_kind(node: &Node<'_>) -> StudyKind {
    if has(node, Rule::kw_calibrate) {
        StudyKind::Calibrate
    } else if has(node, Rule::kw_diagnose) {
        StudyKind::Diagnose
    } else {
        StudyKind::Sweep
    }
}
