//! The bytes that an expression of the grammar can begin with, by which a choice goes straight to what can match.

use pest_meta::ast::RuleType;
use pest_meta::optimizer::{OptimizedExpr, OptimizedRule};
use std::collections::BTreeMap;

/// A set of first bytes, and whether the expression may match nothing at all.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) struct First {
    bytes: [bool; 256],
    pub(crate) empty: bool,
}

impl First {
    const NONE: Self = Self {
        bytes: [false; 256],
        empty: false,
    };

    fn of(member: impl Fn(u8) -> bool) -> Self {
        let mut first = Self::NONE;
        for byte in 0..=u8::MAX {
            first.bytes[usize::from(byte)] = member(byte);
        }
        first
    }

    /// Whether what begins with that byte can match.
    pub(crate) fn admits(&self, byte: u8) -> bool {
        self.empty || self.bytes[usize::from(byte)]
    }

    fn or(mut self, other: Self) -> Self {
        for (mine, theirs) in self.bytes.iter_mut().zip(other.bytes) {
            *mine |= theirs;
        }
        self.empty |= other.empty;
        self
    }
}

/// The first bytes of every rule.
pub(crate) struct Firsts<'g> {
    rules: &'g [OptimizedRule],
    found: BTreeMap<&'g str, First>,
}

impl<'g> Firsts<'g> {
    /// The least sets that agree with each other.
    pub(crate) fn of(rules: &'g [OptimizedRule]) -> Self {
        let found = rules
            .iter()
            .map(|rule| (rule.name.as_str(), First::NONE))
            .collect();
        let mut firsts = Self { rules, found };
        loop {
            let mut changed = false;
            for rule in rules {
                let first = firsts.expression(&rule.expr, is_atomic(rule));
                changed |= firsts.found.insert(&rule.name, first) != Some(first);
            }
            if !changed {
                return firsts;
            }
        }
    }

    /// The first bytes of an expression; `atomic`: no white space is skipped between its parts.
    pub(crate) fn expression(&self, expr: &OptimizedExpr, atomic: bool) -> First {
        match expr {
            OptimizedExpr::Str(text) => match text.as_bytes().first() {
                Some(&first) => First::of(|byte| byte == first),
                None => First {
                    empty: true,
                    ..First::NONE
                },
            },
            OptimizedExpr::Insens(text) => match text.as_bytes().first() {
                Some(first) => First::of(|byte| byte.eq_ignore_ascii_case(first)),
                None => First {
                    empty: true,
                    ..First::NONE
                },
            },
            OptimizedExpr::Ident(name) => self.named(name),
            OptimizedExpr::Seq(left, right) => {
                let mut first = self.expression(left, atomic);
                if !first.empty {
                    return first;
                }
                first.empty = false;
                if !atomic {
                    first = first.or(First::of(|byte| {
                        self.named("WHITESPACE").admits(byte) || self.named("COMMENT").admits(byte)
                    }));
                }
                first.or(self.expression(right, atomic))
            }
            OptimizedExpr::Choice(left, right) => self
                .expression(left, atomic)
                .or(self.expression(right, atomic)),
            OptimizedExpr::Opt(inner) | OptimizedExpr::Rep(inner) => First {
                empty: true,
                ..self.expression(inner, atomic)
            },
            OptimizedExpr::RestoreOnErr(inner) => self.expression(inner, atomic),
            // What looks ahead or skips may match nothing; the rest is not written.
            OptimizedExpr::PosPred(_)
            | OptimizedExpr::NegPred(_)
            | OptimizedExpr::Skip(_)
            | OptimizedExpr::Range(..)
            | OptimizedExpr::PeekSlice(..)
            | OptimizedExpr::Push(_) => First {
                empty: true,
                ..First::NONE
            },
        }
    }

    fn named(&self, name: &str) -> First {
        match name {
            "ANY" => First::of(|_| true),
            "ASCII_DIGIT" => First::of(|byte| byte.is_ascii_digit()),
            "ASCII_ALPHA" => First::of(|byte| byte.is_ascii_alphabetic()),
            "ASCII_ALPHA_LOWER" => First::of(|byte| byte.is_ascii_lowercase()),
            "ASCII_ALPHA_UPPER" => First::of(|byte| byte.is_ascii_uppercase()),
            "ASCII_ALPHANUMERIC" => First::of(|byte| byte.is_ascii_alphanumeric()),
            _ => self.found.get(name).copied().unwrap_or(First::NONE),
        }
    }

    /// The rule of that name.
    pub(crate) fn rule(&self, name: &str) -> Option<&'g OptimizedRule> {
        self.rules.iter().find(|rule| rule.name == name)
    }
}

/// Whether a rule skips no white space in itself, whoever asks for it. White space and comments do not.
pub(crate) fn is_atomic(rule: &OptimizedRule) -> bool {
    matches!(rule.ty, RuleType::Atomic | RuleType::CompoundAtomic)
        || matches!(rule.name.as_str(), "WHITESPACE" | "COMMENT")
}
