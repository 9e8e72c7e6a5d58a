//! From parsed pairs to tree nodes: spans, names, and the few checks that belong to the text.

use crate::ast::{Name, UnitText};
use crate::grammar::Rule;
use crate::matcher::{Pair, Pairs};
use crate::refusals;
use hyde_diag::{Diagnostics, FileId, Span};

pub(super) type Node<'a> = Pair<'a>;

/// Builds nodes from pairs whose places count from `base`.
pub(super) struct Builder<'d> {
    pub(super) file: FileId,
    pub(super) base: usize,
    pub(super) diagnostics: &'d mut Diagnostics,
}

impl Builder<'_> {
    pub(super) fn span(&self, node: &Node<'_>) -> Span {
        let start = self.base + node.start();
        Span::new(self.file, start, start + node.as_str().trim_end().len())
    }

    pub(super) fn name(&self, node: &Node<'_>) -> Name {
        Name {
            text: node.as_str().to_owned(),
            span: self.span(node),
        }
    }

    /// The text of a `string` node without quotes.
    pub(super) fn string(node: &Node<'_>) -> String {
        let inner = node
            .as_str()
            .trim()
            .trim_start_matches('"')
            .trim_end_matches('"');
        inner
            .replace("\\\"", "\"")
            .replace("\\n", "\n")
            .replace("\\\\", "\\")
    }

    /// The text of a `doc` or `source` node.
    pub(super) fn text(node: Node<'_>) -> String {
        parts(node)
            .find(|part| part.as_rule() == Rule::string)
            .map_or_else(String::new, |part| Self::string(&part))
    }

    /// A name in quotes.
    pub(super) fn quoted_name(&self, node: &Node<'_>) -> Name {
        Name {
            text: Self::string(node),
            ..self.name(node)
        }
    }

    pub(super) fn unit(&self, node: Node<'_>) -> UnitText {
        let span = self.span(&node);
        let inner = parts(node).next();
        let text = inner.as_ref().map_or("", Pair::as_str).trim().to_owned();
        UnitText {
            text,
            span: inner.as_ref().map_or(span, |inner| self.span(inner)),
        }
    }

    pub(super) fn number(&mut self, node: &Node<'_>) -> f64 {
        let value: f64 = node.as_str().parse().unwrap_or(f64::NAN);
        if !value.is_finite() {
            let span = self.span(node);
            self.diagnostics
                .push(refusals::number_not_finite(node.as_str(), span));
            return 0.0;
        }
        value
    }
}

/// The children of a node without keywords.
pub(super) fn parts(node: Node<'_>) -> impl Iterator<Item = Node<'_>> {
    significant(node.into_inner())
}

/// The pairs without keywords.
pub(super) fn significant(pairs: Pairs<'_>) -> impl Iterator<Item = Node<'_>> {
    pairs.filter(|pair| !is_keyword(pair.as_rule()))
}

/// Whether a node has the keyword among its children.
pub(super) fn has(node: &Node<'_>, child: Rule) -> bool {
    node.clone()
        .into_inner()
        .any(|pair| pair.as_rule() == child)
}

fn is_keyword(rule: Rule) -> bool {
    use Rule as R;
    matches!(
        rule,
        R::kw_package
            | R::kw_import
            | R::kw_type
            | R::kw_extends
            | R::kw_redeclare
            | R::kw_each
            | R::kw_final
            | R::kw_domain
            | R::kw_discretize
            | R::kw_indomain
            | R::kw_initial
            | R::kw_equation
            | R::kw_connect
            | R::kw_when
            | R::kw_elsewhen
            | R::kw_then
            | R::kw_end
            | R::kw_if
            | R::kw_elseif
            | R::kw_else
            | R::kw_for
            | R::kw_loop
            | R::kw_modes
            | R::kw_mode
            | R::kw_exit
            | R::kw_clocked
            | R::kw_add
            | R::kw_wrap
            | R::kw_replace
            | R::kw_signature
            | R::kw_confounds
            | R::kw_measure
            | R::kw_experiment
            | R::kw_assert
            | R::kw_reinit
            | R::kw_with
            | R::kw_on
            | R::kw_in
            | R::kw_by
            | R::kw_of
            | R::kw_from
            | R::kw_to
            | R::kw_over
            | R::kw_load
            | R::kw_record
            | R::kw_every
            | R::kw_layout
            | R::kw_wraps
            | R::kw_stimulus
            | R::kw_measured
            | R::kw_replay
            | R::kw_expect
            | R::kw_solve
            | R::kw_stop
            | R::kw_bode
            | R::kw_figure
            | R::kw_budget
            | R::kw_vary
            | R::kw_per
            | R::kw_skip
            | R::kw_at
    )
}
