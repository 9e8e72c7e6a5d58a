//! Matches a text by a rule of the grammar: the same constructs at the same places as pest's own parser, many times
//! faster. The functions of the rules are written by `build.rs`; a text that does not match is given to pest, whose
//! message says what was expected ([`crate::grammar`]).

use crate::grammar::Rule;
use std::rc::Rc;

/// A construct that matched: its place and where the constructs behind it begin.
#[derive(Clone, Copy, Debug)]
struct Token {
    rule: Rule,
    start: usize,
    end: usize,
    /// Index of the first token that is not inside of this one.
    next: usize,
}

/// The constructs at the start of a text that match a rule; `None` where it does not match.
pub(crate) fn parse(rule: Rule, text: &str) -> Option<Pairs<'_>> {
    let mut matcher = Matcher {
        bytes: text.as_bytes(),
        at: 0,
        tokens: Vec::new(),
    };
    if !start(rule)(&mut matcher) {
        return None;
    }
    let tokens: Rc<[Token]> = matcher.tokens.into();
    Some(Pairs {
        text,
        from: 0,
        to: tokens.len(),
        tokens,
    })
}

/// Constructs that follow each other in the text.
#[derive(Clone, Debug)]
pub(crate) struct Pairs<'t> {
    text: &'t str,
    tokens: Rc<[Token]>,
    from: usize,
    to: usize,
}

/// A construct of a text.
#[derive(Clone, Debug)]
pub(crate) struct Pair<'t> {
    text: &'t str,
    tokens: Rc<[Token]>,
    at: usize,
}

impl<'t> Iterator for Pairs<'t> {
    type Item = Pair<'t>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.from >= self.to {
            return None;
        }
        let at = self.from;
        self.from = self.tokens[at].next;
        Some(Pair {
            text: self.text,
            tokens: Rc::clone(&self.tokens),
            at,
        })
    }
}

impl<'t> Pair<'t> {
    /// Which construct it is.
    pub(crate) fn as_rule(&self) -> Rule {
        self.tokens[self.at].rule
    }

    /// Its first byte.
    pub(crate) fn start(&self) -> usize {
        self.tokens[self.at].start
    }

    /// The byte behind it. White space and comments may precede it, if the construct could have gone on.
    pub(crate) fn end(&self) -> usize {
        self.tokens[self.at].end
    }

    /// Its text.
    pub(crate) fn as_str(&self) -> &'t str {
        &self.text[self.start()..self.end()]
    }

    /// The constructs that it consists of.
    pub(crate) fn into_inner(self) -> Pairs<'t> {
        Pairs {
            from: self.at + 1,
            to: self.tokens[self.at].next,
            text: self.text,
            tokens: self.tokens,
        }
    }
}

/// How far a text was matched, and the constructs so far.
struct Matcher<'t> {
    bytes: &'t [u8],
    at: usize,
    tokens: Vec<Token>,
}

impl Matcher<'_> {
    /// The next byte; 0 at the end.
    fn peek(&self) -> u8 {
        self.bytes.get(self.at).copied().unwrap_or(0)
    }

    /// A construct: recorded if it matches.
    fn rule(&mut self, rule: Rule, matches: impl FnOnce(&mut Self) -> bool) -> bool {
        let (index, start) = (self.tokens.len(), self.at);
        self.tokens.push(Token {
            rule,
            start,
            end: start,
            next: index,
        });
        if !matches(self) {
            self.tokens.truncate(index);
            return false;
        }
        let next = self.tokens.len();
        self.tokens[index].end = self.at;
        self.tokens[index].next = next;
        true
    }

    /// Parts that follow each other: all of them or none.
    fn sequence(&mut self, matches: impl FnOnce(&mut Self) -> bool) -> bool {
        let (at, tokens) = (self.at, self.tokens.len());
        let matched = matches(self);
        if !matched {
            self.at = at;
            self.tokens.truncate(tokens);
        }
        matched
    }

    /// Once or not at all.
    fn optional(&mut self, matches: impl FnOnce(&mut Self) -> bool) -> bool {
        matches(self);
        true
    }

    /// Any number of times.
    fn repeat(&mut self, matches: impl Fn(&mut Self) -> bool) -> bool {
        while matches(self) {}
        true
    }

    /// Any number of times, with white space and comments between.
    fn repeat_spaced(&mut self, matches: impl Fn(&mut Self) -> bool) -> bool {
        if !matches(self) {
            return true;
        }
        loop {
            let behind = self.at;
            self.blank();
            if !matches(self) {
                self.at = behind;
                return true;
            }
        }
    }

    /// Whether it matches here; nothing is moved or recorded.
    fn ahead(&mut self, matches: impl FnOnce(&mut Self) -> bool) -> bool {
        let (at, tokens) = (self.at, self.tokens.len());
        let matched = matches(self);
        self.at = at;
        self.tokens.truncate(tokens);
        matched
    }

    /// White space and comments, if there are any.
    fn blank(&mut self) -> bool {
        loop {
            while match_whitespace(self) {}
            if !match_comment(self) {
                return true;
            }
        }
    }

    fn literal(&mut self, text: &[u8]) -> bool {
        let here = self.bytes[self.at..].starts_with(text);
        if here {
            self.at += text.len();
        }
        here
    }

    /// A text in small or capital letters.
    fn letters(&mut self, text: &[u8]) -> bool {
        let end = self.at + text.len();
        let here = self.bytes.get(self.at..end);
        let here = here.is_some_and(|here| here.eq_ignore_ascii_case(text));
        if here {
            self.at = end;
        }
        here
    }

    /// A byte of a class.
    fn one(&mut self, of_class: impl FnOnce(u8) -> bool) -> bool {
        let here = self.bytes.get(self.at).is_some_and(|&byte| of_class(byte));
        self.at += usize::from(here);
        here
    }

    /// Any character.
    fn any(&mut self) -> bool {
        let Some(&byte) = self.bytes.get(self.at) else {
            return false;
        };
        self.at += match byte {
            0..0xc0 => 1,
            0xc0..0xe0 => 2,
            0xe0..0xf0 => 3,
            _ => 4,
        };
        true
    }

    /// Up to the first of some texts, or to the end.
    fn skip_until(&mut self, ends: &[&[u8]]) -> bool {
        while self.at < self.bytes.len()
            && !ends
                .iter()
                .any(|end| self.bytes[self.at..].starts_with(end))
        {
            self.at += 1;
        }
        true
    }
}

include!(concat!(env!("OUT_DIR"), "/rules.rs"));

#[cfg(test)]
mod tests;
