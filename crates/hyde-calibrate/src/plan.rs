//! [`CalibrationPlan`]: what a `calibrate` block asks for, its words checked; and [`Label`]: a fact about records that it names.

mod label;

use crate::refusals;
use hyde_diag::{Diagnostics, Span};
use hyde_syntax::ast::{
    self, Expr, ExprKind, Name, Range, Reference, SettingValue, Study, StudyItem, Unary, Varied,
};
use hyde_units::NamedUnit;
pub use label::{Label, LabelValue};

/// Records of an experiment: `bench("fit-*.csv")`.
#[derive(Clone, Debug)]
pub struct Source {
    /// The experiment.
    pub experiment: String,
    /// Patterns of files, each with the record it is for where that is said; none stands for the experiment's own.
    pub patterns: Vec<(Option<String>, Name)>,
    /// Facts about these records: `at load = 200 [kg]`.
    pub labels: Vec<Label>,
    /// Where it is written.
    pub span: Span,
}

/// Of what a parameter has a value each.
#[derive(Clone, Debug)]
pub struct Per {
    /// `experiment`, `record`, or a label.
    pub label: String,
    /// Where it is written.
    pub span: Span,
}

/// What is varied.
#[derive(Clone, Debug)]
pub enum Vary {
    /// Every parameter with a prior.
    Uncertain(Span),
    /// A parameter by name, with bounds in SI where they are given.
    Parameter {
        /// Its full name.
        name: String,
        /// Least and largest value, and the unit they are written in.
        bounds: Option<(f64, f64, NamedUnit)>,
        /// Of what it has a value each; one for all records where nothing is said.
        per: Option<Per>,
        /// Where it is written.
        span: Span,
    },
}

/// `calibrate NAME of MODEL … end NAME;`
#[derive(Clone, Debug)]
pub struct CalibrationPlan {
    /// Its name.
    pub name: String,
    /// The model.
    pub model: String,
    /// All models, that one first.
    pub models: Vec<String>,
    /// Records to calibrate on.
    pub fit: Vec<Source>,
    /// Records that only the report reads.
    pub holdout: Vec<Source>,
    /// What is varied.
    pub vary: Vec<Vary>,
    /// Number of starts: the declared values, then others within the priors.
    pub starts: usize,
    /// Where it is written.
    pub span: Span,
}

impl CalibrationPlan {
    /// Reads a block; what is wrong in it is reported.
    pub fn read(study: &Study, diagnostics: &mut Diagnostics) -> Option<Self> {
        let before = diagnostics.error_count();
        let mut plan = Self {
            name: study.name.text.clone(),
            model: study.of.dotted(),
            models: std::iter::once(&study.of)
                .chain(&study.also)
                .map(Reference::dotted)
                .collect(),
            fit: Vec::new(),
            holdout: Vec::new(),
            vary: Vec::new(),
            starts: 1,
            span: study.name.span,
        };
        let mut varies = false;
        for item in &study.items {
            match item {
                StudyItem::Vary(list) => {
                    for variation in list {
                        if let Some(values) = &variation.values {
                            diagnostics.push(refusals::gives_values(values.span));
                        }
                        if variation.what != Varied::Part {
                            diagnostics.push(refusals::varies_no_parameter(variation.target.span));
                        }
                        let name = hyde_syntax::format_reference(&variation.target);
                        let per = variation.per.as_ref().map(|per| Per {
                            label: per.text.clone(),
                            span: per.span,
                        });
                        if let Some(per) = per.as_ref().filter(|_| name == "uncertain") {
                            diagnostics.push(refusals::uncertain_per(&per.label, per.span));
                        }
                        plan.vary.push(match (&variation.within, name.as_str()) {
                            (None, "uncertain") => Vary::Uncertain(variation.target.span),
                            (within, _) => Vary::Parameter {
                                bounds: within
                                    .as_ref()
                                    .and_then(|range| bounds(range, diagnostics)),
                                span: variation.target.span,
                                per,
                                name,
                            },
                        });
                    }
                }
                StudyItem::VaryEffects(_) => diagnostics.push(refusals::varies_effects(plan.span)),
                StudyItem::Setting(name, _, labels)
                    if !labels.is_empty() && !["fit", "holdout"].contains(&name.text.as_str()) =>
                {
                    diagnostics.push(refusals::setting_with_labels(&name.text, name.span));
                }
                StudyItem::Setting(name, values, labels) => match name.text.as_str() {
                    "fit" => plan.fit.extend(sources(name, values, labels, diagnostics)),
                    "holdout" => {
                        plan.holdout
                            .extend(sources(name, values, labels, diagnostics));
                    }
                    "starts" => match whole(values) {
                        Some(count @ 1..=100) => plan.starts = count,
                        Some(_) | None => {
                            diagnostics.push(refusals::starts_not_a_number(name.span))
                        }
                    },
                    "vary" => {
                        let all = values.iter().find_map(|value| match value {
                            SettingValue::Everything(part) => Some(part.dotted()),
                            SettingValue::Expr(_) => None,
                        });
                        let part = all.unwrap_or_default();
                        diagnostics.push(refusals::varies_all_of(&part, name.span));
                        varies = true;
                    }
                    other => diagnostics.push(refusals::no_such_setting(other, name.span)),
                },
            }
        }
        if plan.fit.is_empty() {
            diagnostics.push(refusals::no_fit(plan.span));
        }
        if plan.vary.is_empty() && !varies {
            diagnostics.push(refusals::no_vary(plan.span));
        }
        plan.check_labels(diagnostics);
        (diagnostics.error_count() == before).then_some(plan)
    }

    /// The labels by which parameters have a value each.
    pub fn labels(&self) -> impl Iterator<Item = &Per> {
        self.vary.iter().filter_map(|vary| match vary {
            Vary::Parameter { per, .. } => per.as_ref(),
            Vary::Uncertain(_) => None,
        })
    }

    /// Values of one label are of one kind, and no label is without use by mistake: the record of an experiment has its
    /// pattern in the brackets.
    fn check_labels(&self, diagnostics: &mut Diagnostics) {
        let mut first: Vec<&Label> = Vec::new();
        for source in self.fit.iter().chain(&self.holdout) {
            let mut own: Vec<&str> = Vec::new();
            for label in &source.labels {
                if own.contains(&label.name.as_str()) {
                    diagnostics.push(refusals::label_twice(&label.name, label.span));
                }
                own.push(&label.name);
                match first.iter().find(|known| known.name == label.name) {
                    Some(known) if !known.value.comparable(&label.value) => {
                        diagnostics.push(refusals::label_not_comparable(
                            &label.name,
                            (&label.shown, label.span),
                            (&known.shown, known.span),
                        ))
                    }
                    Some(_) => {}
                    None => first.push(label),
                }
            }
        }
        for per in self.labels() {
            let of_all = ["record", "experiment"].contains(&per.label.as_str());
            if of_all || first.iter().any(|own| own.name == per.label) {
                continue;
            }
            let known = first.iter().map(|own| format!("`per {}`", own.name));
            let known = known.chain(["`per record`".to_owned(), "`per experiment`".to_owned()]);
            diagnostics.push(refusals::no_such_label(
                &per.label,
                per.span,
                &known.collect::<Vec<_>>(),
            ));
        }
    }
}

/// `bench("fit-*.csv")`, `bench(file = "a.csv", other = "b.csv")`, `bench`.
fn sources(
    setting: &Name,
    values: &[SettingValue],
    labels: &[ast::Label],
    diagnostics: &mut Diagnostics,
) -> Vec<Source> {
    let mut found = Vec::new();
    let labels = labels
        .iter()
        .filter_map(|own| Label::read(own, diagnostics));
    let labels: Vec<Label> = labels.collect();
    for value in values {
        let SettingValue::Expr(expr) = value else {
            diagnostics.push(refusals::not_a_source(&setting.text, setting.span));
            continue;
        };
        match &expr.kind {
            ExprKind::Reference(experiment) => found.push(Source {
                experiment: experiment.dotted(),
                patterns: Vec::new(),
                labels: labels.clone(),
                span: expr.span,
            }),
            ExprKind::Call(experiment, arguments) => {
                let mut patterns = Vec::new();
                for argument in arguments {
                    let ExprKind::String(text) = &argument.value.kind else {
                        diagnostics
                            .push(refusals::not_a_source(&setting.text, argument.value.span));
                        continue;
                    };
                    let record = argument.name.as_ref().map(|name| name.text.clone());
                    let pattern = Name {
                        text: text.clone(),
                        span: argument.value.span,
                    };
                    patterns.push((record, pattern));
                }
                found.push(Source {
                    experiment: experiment.dotted(),
                    patterns,
                    labels: labels.clone(),
                    span: expr.span,
                });
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => {
                diagnostics.push(refusals::not_a_source(&setting.text, expr.span))
            }
        }
    }
    if values.is_empty() {
        diagnostics.push(refusals::not_a_source(&setting.text, setting.span));
    }
    found
}

fn whole(values: &[SettingValue]) -> Option<usize> {
    let [SettingValue::Expr(expr)] = values else {
        return None;
    };
    let (number, unit) = number(expr)?;
    let whole =
        unit.is_none() && number.fract().abs() < f64::EPSILON && (0.0..1e6).contains(&number);
    whole.then_some(number as usize)
}

/// The bounds of a range of numbers, SI; the unit behind the upper one is that of both (U2).
fn bounds(range: &Range, diagnostics: &mut Diagnostics) -> Option<(f64, f64, NamedUnit)> {
    let found = || {
        let (from, own) = number(&range.from)?;
        let (to, unit) = number(&range.to)?;
        let unit = NamedUnit::parse(unit.as_deref().unwrap_or("1")).ok()?;
        let lower = match own {
            Some(own) => NamedUnit::parse(&own).ok()?,
            None => unit.clone(),
        };
        let (from, to) = (lower.unit().to_si(from), unit.unit().to_si(to));
        (lower.unit().dimension == unit.unit().dimension && from < to).then_some((from, to, unit))
    };
    let bounds = found();
    if bounds.is_none() {
        diagnostics.push(refusals::bounds_not_ascending(range.from.span));
    }
    bounds
}

/// A number as written, with its unit.
fn number(expr: &Expr) -> Option<(f64, Option<String>)> {
    match &expr.kind {
        ExprKind::Number(value, unit) => {
            Some((*value, unit.as_ref().map(|unit| unit.text.clone())))
        }
        ExprKind::Unary(Unary::Negative, inner) => {
            number(inner).map(|(value, unit)| (-value, unit))
        }
        ExprKind::Unary(Unary::Positive, inner) => number(inner),
        ExprKind::Unary(Unary::Not, _)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    }
}
