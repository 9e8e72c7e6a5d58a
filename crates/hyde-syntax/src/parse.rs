//! Parses a file: package and imports, then item after item, each element by element.
//!
//! A broken element is reported and skipped ([`crate::recover`]); what follows is parsed as if it were not there.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "one enum has all rules of the grammar; under each node only a few of them can stand"
)]

mod build;
mod declaration;
mod equation;
mod experiment;
mod expression;
mod item;

use crate::ast;
use crate::grammar::{self, Rule};
use crate::matcher::Pairs;
use crate::written::{Node, Part, Written};
use crate::{forms, habits, matcher, nesting, recover, refusals, slips, twice, words};
use hyde_diag::{Diagnostic, Diagnostics, FileId, Sources, Span};

/// What is found where nothing else is.
const END: &str = "the end of the file";

/// Parses one source file. What cannot be parsed is missing in the tree and told in `diagnostics`.
pub fn parse(sources: &Sources, file: FileId, diagnostics: &mut Diagnostics) -> ast::File {
    let text = &sources.get(file).text;
    if let Some(diagnostic) = without_end(text, file) {
        // Whatever stands behind it is not read: nothing else is known of the file.
        diagnostics.push(diagnostic);
        return ast::File::default();
    }
    let tree = Parser::new(text, file, diagnostics).file();
    twice::refuse_twice(&tree, diagnostics);
    tree
}

/// Parses one source file and records each construct that is accepted.
pub(crate) fn written(sources: &Sources, file: FileId, diagnostics: &mut Diagnostics) -> Written {
    let text = &sources.get(file).text;
    let Some(diagnostic) = without_end(text, file) else {
        return recorded(text, file, diagnostics);
    };
    diagnostics.push(diagnostic);
    // What stands before a comment is as if the file ended there. Before a text it may be the inside of another: one that has
    // no end begins there, and this is its end.
    let read = match recover::without_end(text) {
        Some((at, "/*")) => at,
        Some(_) | None => 0,
    };
    let mut written = recorded(&text[..read], file, &mut Diagnostics::new());
    written.parts.push(Part {
        start: read,
        end: text.len(),
        broken: true,
        pieces: Vec::new(),
    });
    written
}

/// What the parser accepts of a text.
fn recorded(text: &str, file: FileId, diagnostics: &mut Diagnostics) -> Written {
    let mut record = Record::default();
    let mut parser = Parser::new(text, file, diagnostics);
    parser.record = Some(&mut record);
    parser.file();
    record.written
}

/// Parses a text that declares a record and nothing else: `record log(time = "t" in [ms])`.
pub fn parse_record(
    sources: &Sources,
    file: FileId,
    diagnostics: &mut Diagnostics,
) -> Option<ast::RecordItem> {
    let text = &sources.get(file).text;
    let mut parser = Parser::new(text, file, diagnostics);
    if !parser.too_deep.is_empty() {
        parser.refuse_too_deep();
        return None;
    }
    let pairs = parser.expect(Rule::record)?;
    if parser.more() {
        let span = Span::new(file, parser.at, text.trim_end().len());
        parser.diagnostics.push(refusals::more_behind_record(span));
        return None;
    }
    let node = pairs.into_iter().next()?;
    parser.build(0).record(node)
}

/// A comment or a text that goes on to the end of the file.
fn without_end(text: &str, file: FileId) -> Option<Diagnostic> {
    let (at, opened) = recover::without_end(text)?;
    let span = Span::new(file, at, at + opened.len());
    Some(match opened {
        "\"" => refusals::text_without_end(span),
        _ => refusals::comment_without_end(span),
    })
}

/// The state of parsing one file: how far it got.
struct Parser<'a> {
    text: &'a str,
    file: FileId,
    at: usize,
    too_deep: Vec<usize>,
    diagnostics: &'a mut Diagnostics,
    /// What is accepted, where that is asked for.
    record: Option<&'a mut Record>,
}

/// What the parser accepted so far.
#[derive(Default)]
struct Record {
    written: Written,
    /// Of the part that is being parsed.
    pieces: Vec<Node>,
}

impl<'a> Parser<'a> {
    fn new(text: &'a str, file: FileId, diagnostics: &'a mut Diagnostics) -> Self {
        Self {
            text,
            file,
            at: 0,
            too_deep: nesting::too_deep(text),
            diagnostics,
            record: None,
        }
    }

    /// Records that a part of the file reaches from `start` to here.
    fn end_part(&mut self, start: usize, broken: bool) {
        let end = self.at;
        if let Some(record) = &mut self.record {
            let pieces = std::mem::take(&mut record.pieces);
            record.written.parts.push(Part {
                start,
                end,
                broken,
                pieces,
            });
        }
    }

    /// Moves past white space and comments; whether something is left.
    fn more(&mut self) -> bool {
        self.at = recover::skip_blank(self.text, self.at);
        self.at < self.text.len()
    }

    /// Whether the next word is the one given.
    fn looking_at(&self, word: &str) -> bool {
        self.nth_word(0) == Some(word)
    }

    /// The word or sign that stands so many behind the next one.
    fn nth_word(&self, behind: usize) -> Option<&'a str> {
        let mut words = recover::Scanner::new(self.text, self.at);
        words.nth(behind).map(|(_, token)| token)
    }

    /// Parses `rule` here or reports why not.
    fn expect(&mut self, rule: Rule) -> Option<Pairs<'a>> {
        let start = self.at;
        let pairs = self.accept(rule);
        if pairs.is_none() {
            let diagnostic = self.syntax_error(start, rule);
            self.diagnostics.push(diagnostic);
        }
        pairs
    }

    /// Parses `rule` here; on success moves past it.
    fn accept(&mut self, rule: Rule) -> Option<Pairs<'a>> {
        let pairs = matcher::parse(rule, &self.text[self.at..])?;
        let len = pairs.clone().map(|pair| pair.end()).max().unwrap_or(0);
        if let Some(record) = &mut self.record {
            let base = self.at;
            record
                .pieces
                .extend(pairs.clone().map(|pair| Node::of(pair, base)));
        }
        self.at += len;
        Some(pairs)
    }

    /// Reports and skips a statement that is nested too deeply; whether it was.
    fn refuse_too_deep(&mut self) -> bool {
        let Some(&place) = self.too_deep.iter().find(|&&place| place >= self.at) else {
            return false;
        };
        let end = recover::skip_statement(self.text, self.at);
        if place >= end {
            return false;
        }
        let span = Span::new(self.file, place, place + 1);
        self.diagnostics.push(refusals::too_deep(span));
        self.at = end;
        true
    }

    /// A node builder for pairs that were parsed from `base` on.
    fn build(&mut self, base: usize) -> build::Builder<'_> {
        build::Builder {
            file: self.file,
            base,
            diagnostics: self.diagnostics,
        }
    }

    /// Why the text from `start` on is not a `rule`.
    fn syntax_error(&self, start: usize, rule: Rule) -> Diagnostic {
        let (offset, expected) = grammar::expected(rule, &self.text[start..]);
        let at = start + offset;
        let found = recover::Scanner::new(self.text, at).next();
        let (begin, end) = found.map_or((at, at), |(begin, token)| (begin, begin + token.len()));
        let span = Span::new(
            self.file,
            begin.min(self.text.len()),
            end.min(self.text.len()),
        );
        let first = self.text[start..]
            .split(|c: char| !c.is_alphanumeric())
            .next();
        if let Some(word) = first.filter(|word| recover::BLOCKS.contains(word))
            && expected == format!("`{word}`")
        {
            let opened = Span::new(self.file, start, start + word.len());
            return refusals::block_without_end(word, opened, span);
        }
        let found = found.map_or(END.to_owned(), |(_, token)| format!("`{token}`"));
        if let Some(found) = habits::find(self.text, start, begin) {
            let span = Span::new(self.file, found.begin, found.end);
            return refusals::habit_of_another_language(found.habit, span);
        }
        let slip = slips::find(self.text, start, begin, &expected);
        // What is missing belongs behind the word before, not in front of the next line.
        let missing = slip
            .as_ref()
            .and_then(|slip| Some((slip.missing?, slip.behind?)));
        let (span, found) = match missing {
            Some((_, behind)) => {
                let next = recover::Scanner::new(self.text, behind).next();
                let found = next.map_or(END.to_owned(), |(_, token)| format!("`{token}`"));
                (Span::new(self.file, behind, behind), found)
            }
            None => (span, found),
        };
        let expected = slip
            .as_ref()
            .and_then(|slip| slip.missing)
            .unwrap_or(&expected);
        if slip.is_none() && expected.contains("a name") && words::is_reserved(&found) {
            return refusals::keyword_as_name(&found, span);
        }
        let missing = missing.map(|(sign, _)| sign);
        let repair = slip.as_ref().map(|slip| slip.help);
        let repair = repair.or_else(|| forms::of(&self.text[start..]));
        refusals::not_expected((expected, &found), missing, span, repair)
    }
}
