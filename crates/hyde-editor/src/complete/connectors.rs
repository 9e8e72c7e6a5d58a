//! Connectors in `connect(…)`: those of the kind of the first one, or all of them.

use super::Place;
use crate::before::{chain_words, word_start};
use crate::occurrences::{Frame, resolve, resolve_parts};
use crate::scope::{Definition, Inside, Thing};
use hyde_syntax::ast::{Class, ClassKind};
use lsp_types::{CompletionItem, CompletionItemKind};

/// Two loops deep: a model with more parts than that has its connectors behind a dot alone.
const MOST: usize = 2000;

impl<'a> Place<'a> {
    /// The connectors that fit behind the arguments that are written so far.
    pub(super) fn connectors(&self, list: &str) -> Vec<CompletionItem> {
        let mut arguments: Vec<&str> = list.split(',').collect();
        let last = arguments.pop().unwrap_or_default();
        let first = arguments.first().copied().unwrap_or_default();
        let wanted = self.connector(&self.meaning(&chain_words(first.trim())));
        let used: Vec<&str> = arguments.iter().map(|own| own.trim()).collect();
        let last = last[..word_start(last)].trim_start();
        let mut items = Vec::new();
        if let Some(chain) = last.strip_suffix('.') {
            let words = chain_words(chain);
            let Some((first, rest)) = words.split_first() else {
                return items;
            };
            let meaning = resolve(self.files, &self.frames, first);
            if let (_, Some(inside)) = resolve_parts(self.files, meaning, rest) {
                let ranked = |rank: char, member: &Definition<'_>| CompletionItem {
                    sort_text: Some(format!("{rank}{}", member.name.text)),
                    ..self.item(member)
                };
                self.each_connector(inside, wanted, &mut |member| {
                    items.push(ranked('0', &member));
                });
                // The way to a connector further in goes through a part.
                self.files.each_member(inside, &mut |member| {
                    items.push(ranked('1', &member));
                });
            }
            return super::unique(items);
        }
        let frames = self.frames.iter().filter_map(|frame| match frame {
            Frame::Inside(inside) => Some(*inside),
            Frame::Experiment(..) | Frame::Local(_) => None,
        });
        for inside in frames {
            self.files.each_member(inside, &mut |part| {
                if is_array(&part) || items.len() > MOST {
                    return;
                }
                let mut add = |label: String, member: &Definition<'_>| {
                    if !used.contains(&label.as_str()) {
                        items.push(CompletionItem {
                            label,
                            kind: Some(CompletionItemKind::INTERFACE),
                            ..self.item(member)
                        });
                    }
                };
                if self
                    .connector(&Some(part))
                    .is_some_and(|own| fits(own, wanted))
                {
                    add(part.name.text.clone(), &part);
                } else if let Some(inside) = self.files.inside(part, None) {
                    self.each_connector(inside, wanted, &mut |member| {
                        add(format!("{}.{}", part.name.text, member.name.text), &member);
                    });
                }
            });
        }
        super::unique(items)
    }

    fn each_connector(
        &self,
        inside: Inside<'a>,
        wanted: Option<&'a Class>,
        visit: &mut dyn FnMut(Definition<'a>),
    ) {
        self.files.each_member(inside, &mut |member| {
            let own = self.connector(&Some(member));
            if own.is_some_and(|own| fits(own, wanted)) && !is_array(&member) {
                visit(member);
            }
        });
    }

    fn meaning(&self, words: &[&str]) -> Option<Definition<'a>> {
        let (first, rest) = words.split_first()?;
        let meaning = resolve(self.files, &self.frames, first);
        resolve_parts(self.files, meaning, rest).0.pop()?
    }

    /// The connector that something declared is.
    fn connector(&self, declared: &Option<Definition<'a>>) -> Option<&'a Class> {
        let declared = declared.as_ref()?;
        let Thing::Variable(declaration, _) = declared.thing else {
            return None;
        };
        let (_, class) = self.files.class(declared.file, &declaration.type_name)?;
        (class.kind == ClassKind::Connector).then_some(class)
    }
}

fn fits(own: &Class, wanted: Option<&Class>) -> bool {
    wanted.is_none_or(|wanted| std::ptr::eq(own, wanted))
}

/// Whether a member is an array, whose elements alone can be connected.
fn is_array(member: &Definition<'_>) -> bool {
    let Thing::Variable(declaration, declarator) = member.thing else {
        return false;
    };
    !declaration.dims.is_empty() || !declarator.dims.is_empty()
}
