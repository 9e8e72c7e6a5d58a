//! [`DiagnosisPlan`]: what a `diagnose` block asks for, its words checked.
//!
//! ```text
//! diagnose bench of calibrate bench
//!   candidates Effects.*, Gantry.WornTeeth;      of packages and of those below them, or single ones
//!   max_effects 3;
//!   seed 1;
//! end bench;
//! ```

use crate::load::File;
use crate::refusals::diagnoses as refused;
use hyde_diag::{Diagnostics, Span};
use hyde_flatten::Candidate;
use hyde_syntax::ast::{ExprKind, Name, Reference, SettingValue, Study, StudyItem, StudyKind};

/// `diagnose NAME of calibrate CALIBRATION … end NAME;`
#[derive(Clone, Debug, PartialEq)]
pub struct DiagnosisPlan {
    /// Its name.
    pub name: String,
    /// The calibration that it begins with.
    pub calibration: String,
    /// Which effects may be tried: `Effects.*` of a package and those below it, or a full name.
    pub candidates: Vec<String>,
    /// How many effects it may claim at most.
    pub max_effects: usize,
    /// What its random numbers begin with.
    pub seed: u64,
    /// Where it is written.
    pub span: Span,
}

/// The effects claimed at most where nothing is said.
const MAX_EFFECTS: usize = 3;

impl DiagnosisPlan {
    /// The `diagnose` block of that name in the user's file; what is wrong in it is reported.
    ///
    /// Effects are looked up in the packages that are loaded, so load the whole library before.
    pub fn read(file: &File, name: &str, diagnostics: &mut Diagnostics) -> Option<Self> {
        let study = file
            .studies()
            .find(|study| study.kind == StudyKind::Diagnose && study.name.text == name)?;
        let before = diagnostics.error_count();
        let mut plan = Self {
            name: study.name.text.clone(),
            calibration: study.of.dotted(),
            candidates: Vec::new(),
            max_effects: MAX_EFFECTS,
            seed: 1,
            span: study.name.span,
        };
        check_calibration(file, study, diagnostics);
        if let Some(other) = study.also.first() {
            diagnostics.push(refused::several_calibrations(other.span));
        }
        for item in &study.items {
            let StudyItem::Setting(setting, values, labels) = item else {
                diagnostics.push(refused::varies(study.name.span));
                continue;
            };
            if let Some(label) = labels.first() {
                diagnostics.push(refused::has_labels(label.name.span));
            }
            match setting.text.as_str() {
                "candidates" => {
                    for value in values {
                        plan.candidates
                            .extend(pattern(file, setting, value, diagnostics));
                    }
                }
                "max_effects" => match whole(values) {
                    Some(count @ 1..=20) => plan.max_effects = usize::try_from(count).unwrap_or(1),
                    Some(_) | None => {
                        diagnostics.push(refused::max_effects_not_a_number(setting.span))
                    }
                },
                "seed" => match whole(values) {
                    Some(seed) => plan.seed = seed,
                    None => diagnostics.push(refused::seed_not_a_number(setting.span)),
                },
                other => diagnostics.push(refused::no_such_setting(other, setting.span)),
            }
        }
        if plan.candidates.is_empty() && diagnostics.error_count() == before {
            diagnostics.push(refused::no_candidates(plan.span));
        }
        (diagnostics.error_count() == before).then_some(plan)
    }

    /// Whether an effect may be tried.
    #[must_use]
    pub fn selects(&self, candidate: &Candidate) -> bool {
        let full = format!("{}.{}", candidate.package, candidate.name());
        self.candidates
            .iter()
            .any(|pattern| match pattern.strip_suffix(".*") {
                Some(package) => is_below(&candidate.package, package),
                None => *pattern == full || *pattern == candidate.effect,
            })
    }
}

/// Whether a package is another one or below it.
fn is_below(package: &str, above: &str) -> bool {
    let rest = package.strip_prefix(above);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
}

/// `of calibrate X`: that there is one.
fn check_calibration(file: &File, study: &Study, diagnostics: &mut Diagnostics) {
    let wanted = study.of.dotted();
    let calibrations = file.studies().filter(|s| s.kind == StudyKind::Calibrate);
    let known: Vec<String> = calibrations.map(|s| s.name.text.clone()).collect();
    if known.contains(&wanted) {
        return;
    }
    diagnostics.push(refused::no_calibration((&wanted, study.of.span), &known));
}

/// `Effects.*` or the name of an effect, as far as there are such effects.
fn pattern(
    file: &File,
    setting: &Name,
    value: &SettingValue,
    diagnostics: &mut Diagnostics,
) -> Option<String> {
    let own = file.package().unwrap_or_default();
    let known: Vec<String> = file
        .effects_known()
        .map(|name| match name.contains('.') {
            true => name,
            false => format!("{own}.{name}"),
        })
        .collect();
    let found = |path: &Reference, everything: bool| {
        let path = path.dotted();
        match everything {
            true => known.iter().any(|name| is_below(name, &path)),
            false => known
                .iter()
                .any(|name| *name == path || *name == format!("{own}.{path}")),
        }
    };
    let (path, everything) = match value {
        SettingValue::Everything(path) => (path, true),
        SettingValue::Expr(expr) => match &expr.kind {
            ExprKind::Reference(path) => (path, false),
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => {
                diagnostics.push(refused::candidate_not_an_effect(setting.span, expr.span));
                return None;
            }
        },
    };
    let text = path.dotted();
    if found(path, everything) || (everything && text == own) {
        return Some(match everything {
            true => format!("{text}.*"),
            false => text,
        });
    }
    let (here, packages) = ((text.as_str(), path.span), packages(&known));
    diagnostics.push(match everything {
        true => refused::package_without_effects(here, &packages),
        false => refused::unknown_effect(here, meant(&text, &known), &packages),
    });
    None
}

/// The effect that was misspelt, or named without its package or with another one.
fn meant<'k>(text: &str, known: &'k [String]) -> Option<&'k str> {
    let word = |name: &'k String| name.rsplit('.').next().unwrap_or(name);
    let near = hyde_flatten::nearest(text, known.iter().map(word))?;
    known
        .iter()
        .find(|name| word(name) == near)
        .map(String::as_str)
}

/// The packages of effects, each once.
fn packages(known: &[String]) -> Vec<&str> {
    let split = known.iter().filter_map(|name| name.rsplit_once('.'));
    let mut packages: Vec<&str> = split.map(|(package, _)| package).collect();
    packages.sort_unstable();
    packages.dedup();
    packages
}

/// The one whole number that a setting has.
fn whole(values: &[SettingValue]) -> Option<u64> {
    let [SettingValue::Expr(expr)] = values else {
        return None;
    };
    match expr.kind {
        ExprKind::Number(value, None) if value.fract() == 0.0 && (0.0..=1e15).contains(&value) => {
            Some(value as u64)
        }
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Unary(..)
        | ExprKind::Binary(..)
        | ExprKind::If(..)
        | ExprKind::Array(..)
        | ExprKind::Comprehension(_)
        | ExprKind::Slice(..) => None,
    }
}
