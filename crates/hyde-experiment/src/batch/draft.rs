//! [`Draft`]: what a `sweep` block says, read as literals: nothing here knows the model.

use super::sample::Sampling;
use super::vary::{effect, varying};
use crate::refusals::sweeps as refused;
use hyde_diag::{Diagnostic, Span};
use hyde_syntax::ast::{EffectUse, Expr, ExprKind, Reference, SettingValue, Study, StudyItem};
use hyde_units::NamedUnit;

/// A number as written: SI where it has a unit.
#[derive(Clone, Debug)]
pub(super) struct Written {
    pub(super) value: f64,
    /// `None` where no unit was written.
    pub(super) unit: Option<NamedUnit>,
    /// Written as `true` or `false`.
    pub(super) truth: bool,
    pub(super) span: Span,
}

/// Alternatives that change the equations.
#[derive(Clone, Debug)]
pub struct Choice {
    /// What is chosen, as its column is called: `model`, `screw.contact`, `stimulus r`, `effect Stribeck on guide`.
    pub name: String,
    /// The alternatives as their cells say.
    pub options: Vec<String>,
    pub(super) what: ChoiceOf,
}

#[derive(Clone, Debug)]
pub(super) enum ChoiceOf {
    Model,
    Component(Reference, Vec<Expr>),
    Stimulus(Reference, Vec<Expr>),
    Record(String),
    Effect(EffectUse),
}

/// One thing that varies, in the order written.
#[derive(Clone, Debug)]
pub(super) enum Varying {
    Choice(Choice),
    List(Reference, Vec<Written>),
    Range(Reference, Written, Written),
    Uncertain(Span),
    Cases(Span),
}

/// How ranges become points.
#[derive(Clone, Debug)]
pub(super) enum Fill {
    Grid(Vec<usize>),
    Sampled(Sampling, usize),
}

/// A `sweep` block as written.
#[derive(Clone, Debug)]
pub struct Draft {
    /// Its name.
    pub name: String,
    /// The experiment it is of.
    pub experiment: String,
    /// The file of its cases, as written.
    pub cases: Option<String>,
    /// What it keeps over time: names of variables, `guide.*` for all below one.
    pub keep: Vec<String>,
    pub(super) seed: u64,
    pub(super) varying: Vec<Varying>,
    pub(super) fill: Option<(Fill, Span)>,
    pub(super) span: Span,
}

impl Draft {
    /// Reads a block.
    ///
    /// # Errors
    /// A diagnostic at what is no sweep.
    pub fn read(study: &Study) -> Result<Self, Diagnostic> {
        let mut draft = Self {
            name: study.name.text.clone(),
            experiment: study.of.dotted(),
            cases: None,
            keep: Vec::new(),
            seed: 1,
            varying: Vec::new(),
            fill: None,
            span: study.name.span,
        };
        if let Some(other) = study.also.first() {
            return Err(refused::second_experiment(other.span));
        }
        for item in &study.items {
            match item {
                StudyItem::Vary(list) => {
                    for variation in list {
                        draft.varying.push(varying(variation)?);
                    }
                }
                StudyItem::VaryEffects(list) => {
                    draft
                        .varying
                        .extend(list.iter().map(|used| Varying::Choice(effect(used))));
                }
                StudyItem::Setting(name, values, labels) => {
                    if let Some(label) = labels.first() {
                        return Err(refused::label(label.name.span));
                    }
                    draft.setting(&name.text, name.span, values)?;
                }
            }
        }
        if draft.varying.is_empty() {
            return Err(refused::varies_nothing(draft.span));
        }
        Ok(draft)
    }

    /// The alternatives that change the equations, in the order written.
    pub fn choices(&self) -> impl Iterator<Item = &Choice> {
        self.varying.iter().filter_map(|varying| match varying {
            Varying::Choice(choice) => Some(choice),
            Varying::List(..) | Varying::Range(..) | Varying::Uncertain(_) | Varying::Cases(_) => {
                None
            }
        })
    }

    /// The start values that vary, as parameters are called: the compiler makes parameters of them.
    pub fn starts(&self) -> impl Iterator<Item = String> {
        self.varying.iter().filter_map(|varying| match varying {
            Varying::List(target, _) | Varying::Range(target, ..) => {
                let name = path(target);
                name.ends_with(".start").then_some(name)
            }
            Varying::Choice(_) | Varying::Uncertain(_) | Varying::Cases(_) => None,
        })
    }

    fn setting(
        &mut self,
        word: &str,
        span: Span,
        values: &[SettingValue],
    ) -> Result<(), Diagnostic> {
        match word {
            "grid" => {
                let counts: Result<Vec<usize>, Diagnostic> =
                    values.iter().map(|v| count(v, span)).collect();
                self.filled(Fill::Grid(counts?), span)
            }
            "random" | "latin" | "sobol" => {
                let how = match word {
                    "random" => Sampling::Random,
                    "latin" => Sampling::Latin,
                    _ => Sampling::Sobol,
                };
                let [value] = values else {
                    return Err(refused::not_one_number(word, span));
                };
                self.filled(Fill::Sampled(how, count(value, span)?), span)
            }
            "seed" => {
                let [value] = values else {
                    return Err(refused::not_one_seed(span));
                };
                self.seed = count(value, span)? as u64;
                Ok(())
            }
            "cases" => match values {
                [
                    SettingValue::Expr(Expr {
                        kind: ExprKind::String(file),
                        ..
                    }),
                ] if self.cases.is_none() => {
                    self.cases = Some(file.clone());
                    self.varying.push(Varying::Cases(span));
                    Ok(())
                }
                _ => Err(refused::not_one_table(span)),
            },
            "keep" => {
                self.keep.extend(values.iter().map(|value| match value {
                    SettingValue::Everything(reference) => format!("{}.*", path(reference)),
                    SettingValue::Expr(expr) => hyde_syntax::format_expression(expr),
                }));
                Ok(())
            }
            "vary" => {
                let all = values.iter().find_map(|value| match value {
                    SettingValue::Everything(part) => Some(path(part)),
                    SettingValue::Expr(_) => None,
                });
                Err(refused::varies_all_of(&all.unwrap_or_default(), span))
            }
            _ => Err(refused::unknown_setting(word, span)),
        }
    }

    fn filled(&mut self, fill: Fill, span: Span) -> Result<(), Diagnostic> {
        if let Some((_, before)) = self.fill {
            return Err(refused::two_plans(before, span));
        }
        self.fill = Some((fill, span));
        Ok(())
    }
}

/// A name with its subscripts, as parameters are called.
pub(super) fn path(reference: &Reference) -> String {
    let kind = ExprKind::Reference(reference.clone());
    hyde_syntax::format_expression(&Expr {
        kind,
        span: reference.span,
    })
}

fn count(value: &SettingValue, span: Span) -> Result<usize, Diagnostic> {
    if let SettingValue::Expr(Expr {
        kind: ExprKind::Number(number, None),
        ..
    }) = value
        && number.fract() == 0.0
        && (1.0..=1e9).contains(number)
    {
        return Ok(*number as usize);
    }
    Err(refused::not_a_count(span))
}
