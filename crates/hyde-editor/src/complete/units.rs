//! Units in brackets: those of the dimension that is wanted there, where this is known.

use super::Place;
use crate::before::{chain_len, chain_words};
use crate::describe;
use crate::occurrences::{resolve, resolve_parts};
use crate::scope::Definition;
use hyde_syntax::ast::Item;
use hyde_units::{Agreement, Dimension, parse_unit};
use lsp_types::{CompletionItem, CompletionItemKind};
use std::collections::BTreeSet;

impl Place<'_> {
    /// The units that the types and the values of the loaded files have, of the dimension that is wanted in the last bracket
    /// if that is known.
    pub(super) fn units(&self, before: &str, open: &[(usize, char)]) -> Vec<CompletionItem> {
        let known = self.known_units();
        let wanted = self.wanted(before, open);
        let fits = |unit: &&String| {
            let own = parse_unit(unit).map(|own| own.dimension);
            wanted
                .is_some_and(|wanted| own.is_ok_and(|own| own.agreement(wanted) == Agreement::Same))
        };
        let mut units: Vec<&String> = known.iter().filter(fits).collect();
        if units.is_empty() {
            units = known.iter().collect();
        }
        let item = |label: &String| CompletionItem {
            label: label.clone(),
            kind: Some(CompletionItemKind::UNIT),
            ..CompletionItem::default()
        };
        units.into_iter().map(item).collect()
    }

    fn known_units(&self) -> BTreeSet<String> {
        let mut units: BTreeSet<String> = BTreeSet::new();
        for (id, tree) in self.files.files {
            for item in &tree.items {
                if let Item::Type(item) = item {
                    units.extend(item.unit.as_ref().map(|unit| unit.text.clone()));
                }
            }
            let text = &self.analysis.loaded.sources.get(*id).text;
            for part in text.split(|c: char| c.is_ascii_digit()) {
                let unit = part.strip_prefix(" [").and_then(|own| own.split_once(']'));
                units.extend(unit.map(|(unit, _)| unit.trim().to_owned()));
            }
        }
        units.retain(|unit| parse_unit(unit).is_ok());
        units
    }

    /// The dimension of `NAME` in `NAME = 3 [`: a part that is changed, something declared, or a name of an equation.
    fn wanted(&self, before: &str, open: &[(usize, char)]) -> Option<Dimension> {
        let (bracket, outer) = open.split_last()?;
        let value = before.get(..bracket.0)?.trim_end();
        let sign = |c: char| c.is_ascii_alphanumeric() || c == '.' || c == '-' || c == '+';
        let number = value.rfind(|c| !sign(c)).map_or(0, |at| at + 1);
        let left = value[..number].trim_end().strip_suffix('=')?.trim_end();
        let words = chain_words(left);
        let head = left[..left.len() - chain_len(left)].trim_end();
        if let [attribute] = words.as_slice()
            && ["start", "min", "max"].contains(attribute)
            && let Some((at, '(')) = outer.last().copied()
        {
            let owner = before[..at].trim_end();
            let words = chain_words(owner);
            let head = owner[..owner.len() - chain_len(owner)].trim_end();
            return self.dimension(&words, head, before, &outer[..outer.len() - 1]);
        }
        self.dimension(&words, head, before, outer)
    }

    /// The dimension of a name, with what stands before it and the brackets around it.
    fn dimension(
        &self,
        words: &[&str],
        head: &str,
        before: &str,
        open: &[(usize, char)],
    ) -> Option<Dimension> {
        let (first, rest) = words.split_first()?;
        let number = open.len().checked_sub(1);
        let inside = number.and_then(|number| self.modified(before, open, number));
        let definition = match inside {
            Some(inside) => {
                let member = self.files.member(inside, first);
                resolve_parts(self.files, member, rest).0.pop()??
            }
            None => {
                let declared = chain_words(head);
                if !declared.is_empty() && rest.is_empty() {
                    let unit = describe::unit(self.analysis, 0, &self.reference(&declared)?);
                    if let Some(unit) = unit {
                        return parse_unit(&unit).ok().map(|unit| unit.dimension);
                    }
                }
                let meaning = resolve(self.files, &self.frames, first);
                resolve_parts(self.files, meaning, rest).0.pop()??
            }
        };
        self.unit_of(&definition)
    }

    fn unit_of(&self, definition: &Definition<'_>) -> Option<Dimension> {
        let type_name = describe::type_name(definition)?;
        let unit = describe::unit(self.analysis, definition.file, type_name)?;
        parse_unit(&unit).ok().map(|unit| unit.dimension)
    }
}
