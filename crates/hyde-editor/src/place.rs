//! A place in a text with the names that are known there, and what an open bracket there is about.

use crate::analysis::Analysis;
use crate::before::{chain_len, chain_words};
use crate::occurrences::{Frame, resolve_parts};
use crate::scope::{Files, Inside};
use hyde_syntax::ast::{ClassBody, Element, Experiment, Item, Name, Part, Reference};

/// The names that are known at a byte of the file itself.
pub(crate) fn frames(analysis: &Analysis, byte: usize) -> Vec<Frame<'_>> {
    let files = analysis.files();
    let Some(tree) = files.file(0) else {
        return Vec::new();
    };
    let holds = |span: hyde_diag::Span| (span.start as usize) <= byte && byte <= span.end as usize;
    for item in &tree.items {
        match item {
            Item::Class(class) if holds(class.span) => {
                let mut frames = vec![Frame::Inside(Inside::Class(0, class))];
                if let ClassBody::Long { elements, .. } = &class.body {
                    for element in elements {
                        if let Element::Clocked(clocked) = element
                            && holds(clocked.span)
                        {
                            frames.push(Frame::Inside(Inside::Elements(0, &clocked.elements)));
                        }
                    }
                }
                return frames;
            }
            Item::Experiment(experiment) if holds(experiment.span) => {
                return experiment_frames(files, experiment);
            }
            Item::Study(study) if holds(study.span) => {
                let word = study.of.as_word().unwrap_or_default();
                if let Some(experiment) = files.experiment(0, word) {
                    return experiment_frames(files, experiment);
                }
                let class = files.class(0, &study.of);
                let own = class.map(|(file, class)| Frame::Inside(Inside::Class(file, class)));
                return own.into_iter().collect();
            }
            Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => {}
        }
    }
    Vec::new()
}

fn experiment_frames<'a>(files: Files<'a>, experiment: &'a Experiment) -> Vec<Frame<'a>> {
    let model = files.class(0, &experiment.model);
    let model = model.map(|(file, class)| Frame::Inside(Inside::Class(file, class)));
    let mut frames: Vec<Frame<'a>> = model.into_iter().collect();
    frames.push(Frame::Experiment(0, experiment));
    frames
}

/// A place in the file itself.
pub(crate) struct Place<'a> {
    pub(crate) analysis: &'a Analysis,
    pub(crate) files: Files<'a>,
    pub(crate) frames: Vec<Frame<'a>>,
}

impl<'a> Place<'a> {
    pub(crate) fn at(analysis: &'a Analysis, byte: usize) -> Self {
        Self {
            analysis,
            files: analysis.files(),
            frames: frames(analysis, byte),
        }
    }

    /// The class whose parts are changed in the open bracket of that number.
    pub(crate) fn modified(
        &self,
        before: &str,
        open: &[(usize, char)],
        number: usize,
    ) -> Option<Inside<'a>> {
        let (at, _) = *open.get(number).filter(|(_, sign)| *sign == '(')?;
        let head = before.get(..at)?.trim_end();
        let words = chain_words(head);
        let (first, rest) = words.split_first()?;
        let name_start = head.len() - chain_len(head);
        let left = head[..name_start].trim_end();
        // `Type name(`, `extends Type(`, `of Type(`, `model A = Type(`, `by Type(`, `with Type(`
        let keyword = ["extends", "of", "=", "by", "with"];
        let is_class = keyword.iter().any(|word| left.ends_with(word));
        let outer = number.checked_sub(1).filter(|_| !is_class);
        if let Some(outer) = outer
            && let Some(inside) = self.modified(before, open, outer)
        {
            let redeclared = chain_words(left);
            if chain_words(left[..left.len() - chain_len(left)].trim_end()) == ["redeclare"] {
                return self.class_inside(&redeclared);
            }
            let member = self.files.member(inside, first);
            return resolve_parts(self.files, member, rest).1;
        }
        if is_class {
            return self.class_inside(&words);
        }
        let declared = chain_words(left);
        (rest.is_empty() && !declared.is_empty())
            .then(|| self.class_inside(&declared))
            .flatten()
    }

    pub(crate) fn class_inside(&self, words: &[&str]) -> Option<Inside<'a>> {
        let (file, class) = self.files.class(0, &self.reference(words)?)?;
        Some(Inside::Class(file, class))
    }

    /// A name as if it were written in the file.
    pub(crate) fn reference(&self, words: &[&str]) -> Option<Reference> {
        let (id, _) = self.files.files.first()?;
        let span = hyde_diag::Span::new(*id, 0, 0);
        let parts = words.iter().map(|word| Part {
            name: Name {
                text: (*word).to_owned(),
                span,
            },
            subscripts: Vec::new(),
        });
        Some(Reference {
            parts: parts.collect(),
            span,
        })
    }
}
