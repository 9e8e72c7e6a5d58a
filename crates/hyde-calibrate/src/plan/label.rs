//! [`Label`]: a fact about the records of a `fit` or `holdout`, `load = 200 [kg]`, its value read and comparable.

use super::number;
use crate::refusals;
use hyde_diag::{Diagnostics, Span};
use hyde_syntax::ast::{self, ExprKind};
use hyde_units::{Dimension, NamedUnit};

/// The value of a label.
#[derive(Clone, Debug, PartialEq)]
pub enum LabelValue {
    /// A number, SI, with its dimension.
    Number(f64, Dimension),
    /// A text or a name.
    Text(String),
}

/// A fact about records.
#[derive(Clone, Debug)]
pub struct Label {
    /// What it is about.
    pub name: String,
    /// Its value.
    pub value: LabelValue,
    /// The value as it was written, without brackets and quotes.
    pub shown: String,
    /// Where it is written.
    pub span: Span,
}

/// Names that every record has a value of.
const TAKEN: [&str; 2] = ["record", "experiment"];

impl Label {
    /// Reads a label; what is wrong is reported.
    pub(crate) fn read(label: &ast::Label, diagnostics: &mut Diagnostics) -> Option<Self> {
        let name = label.name.text.clone();
        if TAKEN.contains(&name.as_str()) {
            diagnostics.push(refusals::label_of_every_record(&name, label.name.span));
            return None;
        }
        let read = match &label.value.kind {
            ExprKind::String(text) => Some((LabelValue::Text(text.clone()), text.clone())),
            ExprKind::Reference(word) => {
                let text = word.dotted();
                Some((LabelValue::Text(text.clone()), text))
            }
            ExprKind::Number(..)
            | ExprKind::Boolean(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => number(&label.value).and_then(|(value, unit)| {
                let text = unit.clone().unwrap_or_else(|| "1".to_owned());
                let own = NamedUnit::parse(&text).ok()?;
                let shown = match unit {
                    Some(unit) => format!("{value} {unit}"),
                    None => value.to_string(),
                };
                let si = own.unit().to_si(value);
                Some((LabelValue::Number(si, own.unit().dimension), shown))
            }),
        };
        let Some((value, shown)) = read else {
            diagnostics.push(refusals::value_of_label(&name, label.value.span));
            return None;
        };
        Some(Self {
            name,
            value,
            shown,
            span: label.value.span,
        })
    }
}

impl LabelValue {
    /// Whether both are texts, or numbers of one dimension.
    #[must_use]
    pub fn comparable(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(_, own), Self::Number(_, other)) => own == other,
            (Self::Text(_), Self::Text(_)) => true,
            (Self::Number(..), Self::Text(_)) | (Self::Text(_), Self::Number(..)) => false,
        }
    }

    /// Whether both are the same value: numbers but for the rounding of their units.
    #[must_use]
    pub fn same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(own, _), Self::Number(other, _)) => {
                (own - other).abs() <= 1e-12 * own.abs().max(other.abs())
            }
            (Self::Text(own), Self::Text(other)) => own == other,
            (Self::Number(..), Self::Text(_)) | (Self::Text(_), Self::Number(..)) => false,
        }
    }
}
