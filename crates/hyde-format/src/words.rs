//! The words of a text in a tree: the constructs of the parser with the signs between them, and the comments before each.

use hyde_syntax::{Node, Rule, Written, comment_end};

/// The words of a file.
pub(crate) struct Words<'a> {
    pub(crate) words: Vec<Word<'a>>,
    pub(crate) parts: Vec<Part>,
    /// What stands behind the last word.
    pub(crate) rest: Before<'a>,
}

/// A word or a sign, or a part of the file that is kept as it is.
pub(crate) struct Word<'a> {
    pub(crate) text: &'a str,
    pub(crate) before: Before<'a>,
}

/// What stands before a word.
#[derive(Default)]
pub(crate) struct Before<'a> {
    pub(crate) comments: Vec<Comment<'a>>,
    /// Line breaks between the last comment, or the word before, and this word.
    pub(crate) breaks: usize,
}

/// A comment.
pub(crate) struct Comment<'a> {
    pub(crate) text: &'a str,
    /// Line breaks between what stands before it and the comment.
    pub(crate) breaks: usize,
}

impl Comment<'_> {
    /// Whether it reaches to the end of its line.
    pub(crate) fn is_line(&self) -> bool {
        self.text.starts_with("//")
    }
}

/// A part of the file.
pub(crate) enum Part {
    /// Its pieces: headers, elements, sections and ends.
    Parsed(Vec<(Rule, Vec<Tree>)>),
    /// A part with an error: the word that holds all of it.
    Kept(usize),
}

/// A construct or a word.
pub(crate) enum Tree {
    /// The index of a word.
    Word(usize),
    /// A construct with what it consists of; never empty.
    Node(Rule, Vec<Tree>),
}

impl Tree {
    /// The index of the first word.
    pub(crate) fn first(&self) -> usize {
        match self {
            Self::Word(index) => *index,
            Self::Node(_, inner) => inner.first().map_or(usize::MAX, Self::first),
        }
    }

    /// The index of the last word.
    pub(crate) fn last(&self) -> usize {
        match self {
            Self::Word(index) => *index,
            Self::Node(_, inner) => inner.last().map_or(usize::MAX, Self::last),
        }
    }

    /// Which construct, if it is one.
    pub(crate) fn rule(&self) -> Option<Rule> {
        match self {
            Self::Word(_) => None,
            Self::Node(rule, _) => Some(*rule),
        }
    }
}

impl<'a> Words<'a> {
    pub(crate) fn of(text: &'a str, written: &Written) -> Self {
        let mut reader = Reader {
            text,
            at: 0,
            words: Vec::new(),
        };
        let mut parts = Vec::new();
        for part in &written.parts {
            let count = reader.words.len();
            let parsed = (!part.broken && !part.pieces.is_empty())
                .then(|| reader.part(&part.pieces))
                .flatten();
            if let Some(pieces) = parsed {
                parts.push(Part::Parsed(pieces));
                continue;
            }
            reader.words.truncate(count);
            // Where one error ends and the next begins depends on line breaks: such neighbours stay together.
            if let Some(Part::Kept(_)) = parts.last() {
                reader.keep_more(part.end);
            } else {
                reader.keep(part.start, part.end);
                parts.push(Part::Kept(count));
            }
        }
        let rest = reader.before().unwrap_or_default();
        Self {
            words: reader.words,
            parts,
            rest,
        }
    }

    /// The text of a word.
    pub(crate) fn text(&self, index: usize) -> &'a str {
        self.words.get(index).map_or("", |word| word.text)
    }
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    words: Vec<Word<'a>>,
}

impl<'a> Reader<'a> {
    /// The pieces of a part; nothing if they are not the whole text of it.
    fn part(&mut self, pieces: &[Node]) -> Option<Vec<(Rule, Vec<Tree>)>> {
        let start = self.at;
        let trees = pieces
            .iter()
            .map(|piece| Some((piece.rule, self.inside(piece)?)))
            .collect::<Option<Vec<_>>>();
        if trees.is_none() {
            self.at = start;
        }
        trees
    }

    /// What a construct consists of.
    fn inside(&mut self, node: &Node) -> Option<Vec<Tree>> {
        let mut trees = Vec::new();
        for child in &node.children {
            self.signs(child.start, &mut trees)?;
            if is_word(child) {
                // The parser looks behind a minus, past white space and comments.
                let end = if child.rule == Rule::minus {
                    child.start + 1
                } else {
                    child.end
                };
                let index = self.word(child.start, end)?;
                trees.push(if is_operator(child.rule) {
                    Tree::Node(child.rule, vec![Tree::Word(index)])
                } else {
                    Tree::Word(index)
                });
            } else {
                let inner = self.inside(child)?;
                if !inner.is_empty() {
                    trees.push(Tree::Node(child.rule, inner));
                }
            }
        }
        self.signs(node.end, &mut trees)?;
        Some(trees)
    }

    /// The signs up to a place.
    fn signs(&mut self, end: usize, trees: &mut Vec<Tree>) -> Option<()> {
        loop {
            let (_, at) = self.look()?;
            if at >= end {
                return Some(());
            }
            let rest = &self.text[at..];
            let len = ["->", ".."]
                .iter()
                .find(|sign| rest.starts_with(**sign))
                .map(|sign| sign.len());
            let len = len.or_else(|| {
                let len = rest
                    .find(|c: char| !c.is_ascii_alphanumeric() && c != '_')
                    .unwrap_or(rest.len());
                (len > 0).then_some(len)
            });
            let len = len.or_else(|| ";,(){}[]=.:~*".contains(rest.chars().next()?).then_some(1));
            trees.push(Tree::Word(self.word(at, at + len?)?));
        }
    }

    /// A word at a place behind white space and comments only.
    fn word(&mut self, start: usize, end: usize) -> Option<usize> {
        let before = self.before()?;
        if self.at != start {
            return None;
        }
        self.at = end;
        self.words.push(Word {
            text: self.text.get(start..end)?,
            before,
        });
        Some(self.words.len() - 1)
    }

    /// A part that stays as it is.
    fn keep(&mut self, start: usize, end: usize) {
        // The parser begins a part behind white space and comments, and may end it behind them too.
        let before = self.before().unwrap_or_default();
        let start = start.max(self.at);
        let start = start + self.text[start..].len() - self.text[start..].trim_start().len();
        let end = start + self.text[start..end.max(start)].trim_end().len();
        self.at = end;
        self.words.push(Word {
            text: &self.text[start..end],
            before,
        });
    }

    /// The last word, which is a part that stays as it is, reaches further.
    fn keep_more(&mut self, end: usize) {
        if let Some(word) = self.words.last_mut() {
            let start = self.at - word.text.len();
            word.text = self.text[start..end.max(self.at)].trim_end();
            self.at = start + word.text.len();
        }
    }

    /// Moves past white space and comments.
    fn before(&mut self) -> Option<Before<'a>> {
        let (before, at) = self.look()?;
        self.at = at;
        Some(before)
    }

    /// White space and comments from here on, and where they end.
    fn look(&self) -> Option<(Before<'a>, usize)> {
        let mut before = Before::default();
        let mut at = self.at;
        loop {
            let rest = self.text.get(at..)?;
            let trimmed = rest.trim_start();
            let blank = &rest[..rest.len() - trimmed.len()];
            at += blank.len();
            before.breaks += blank.matches('\n').count();
            let len = if trimmed.starts_with("//") {
                trimmed.find('\n').or(Some(trimmed.len()))
            } else if trimmed.starts_with("/*") {
                // One without end is part of what is kept.
                comment_end(trimmed)
            } else {
                None
            };
            let Some(len) = len else {
                return Some((before, at));
            };
            before.comments.push(Comment {
                text: trimmed[..len].trim_end(),
                breaks: before.breaks,
            });
            before.breaks = 0;
            at += len;
        }
    }
}

/// Whether a construct is one word. What has no inner construct is, but for what may be empty between two signs.
fn is_word(node: &Node) -> bool {
    let empty = [
        Rule::arguments,
        Rule::modification,
        Rule::equations,
        Rule::enter,
        Rule::leave,
        Rule::exit_actions,
    ];
    node.rule == Rule::unit || node.children.is_empty() && !empty.contains(&node.rule)
}

/// Whether it stands between two operands or before one.
fn is_operator(rule: Rule) -> bool {
    let before = [Rule::negative, Rule::positive, Rule::not];
    before.contains(&rule) || crate::layout::level(rule).is_some()
}
