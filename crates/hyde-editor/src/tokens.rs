//! Meanings of names as colours: semantic tokens.

use crate::analysis::Analysis;
use crate::position::Encoding;
use crate::scope::Thing;
use hyde_syntax::ast::{ClassKind, Prefix};
use lsp_types::{SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokensLegend};

/// The names of kinds and of marks, in the order that [`tokens`] counts them.
pub(crate) fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend {
        token_types: vec![
            SemanticTokenType::NAMESPACE,
            SemanticTokenType::TYPE,
            SemanticTokenType::CLASS,
            SemanticTokenType::FUNCTION,
            SemanticTokenType::PARAMETER,
            SemanticTokenType::PROPERTY,
            SemanticTokenType::ENUM_MEMBER,
            SemanticTokenType::VARIABLE,
            SemanticTokenType::EVENT,
        ],
        token_modifiers: vec![
            SemanticTokenModifier::DECLARATION,
            SemanticTokenModifier::READONLY,
        ],
    }
}

/// The names of a text whose meaning is known.
pub(crate) fn tokens(analysis: &Analysis, encoding: Encoding) -> Vec<SemanticToken> {
    let text = analysis.text();
    let mut list: Vec<(u32, u32, u32, u32, u32)> = Vec::new();
    for found in analysis.occurrences() {
        let Some(meaning) = found.meaning else {
            continue;
        };
        let (kind, readonly) = match meaning.thing {
            Thing::Package(_) => (0, false),
            Thing::Type(_) => (1, false),
            Thing::Class(class) if class.kind == ClassKind::Function => (3, false),
            Thing::Class(_) => (2, false),
            Thing::Variable(declaration, _) => {
                let fixed = [
                    Prefix::Parameter,
                    Prefix::Constant,
                    Prefix::Size,
                    Prefix::Shape,
                ];
                match declaration.prefixes.iter().any(|own| fixed.contains(own)) {
                    true => (4, true),
                    false => (5, false),
                }
            }
            Thing::Mode => (6, false),
            Thing::Experiment(_) | Thing::Study(_) => (8, false),
            Thing::Measure(..)
            | Thing::Domain(_)
            | Thing::Coordinate(_)
            | Thing::Clocked(_)
            | Thing::Modes(_)
            | Thing::Counter
            | Thing::ModeParameter(_)
            | Thing::Record(_) => (7, false),
        };
        let bytes = found.span.start as usize..found.span.end as usize;
        let range = encoding.range(text, bytes);
        if range.start.line != range.end.line || range.start == range.end {
            continue;
        }
        let marks = u32::from(found.declares) | u32::from(readonly) << 1;
        let length = range.end.character - range.start.character;
        list.push((range.start.line, range.start.character, length, kind, marks));
    }
    list.sort_unstable();
    list.dedup_by_key(|own| (own.0, own.1));
    let mut last = (0, 0);
    list.into_iter()
        .map(
            |(line, column, length, token_type, token_modifiers_bitset)| {
                let delta_start = match line == last.0 {
                    true => column - last.1,
                    false => column,
                };
                let delta_line = line - last.0;
                last = (line, column);
                SemanticToken {
                    delta_line,
                    delta_start,
                    length,
                    token_type,
                    token_modifiers_bitset,
                }
            },
        )
        .collect()
}
