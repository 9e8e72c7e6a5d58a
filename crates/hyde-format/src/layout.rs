//! Lines of statements: where words are joined, where a space is, and where a line that is too long is broken.
//!
//! A statement is a document of the kind of Wadler: between two words is nothing, a space, or a place where the line may be
//! broken. A line break that is written at such a place is kept, so that what belongs together stays together; one at any
//! other place is not.

use crate::WIDTH;
use crate::words::{Before, Tree, Words};
use hyde_syntax::Rule;
use pretty::RcDoc;

/// Columns of one step of indentation.
pub(crate) const STEP: usize = 2;

/// What is between two words.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Gap {
    /// The construct begins here: what stands before it is printed with what is around it.
    Start,
    /// Nothing.
    None,
    /// One space.
    Space,
    /// One space, or a line break if what follows is too long for the line.
    Break,
    /// Nothing, or a line break if what follows is too long for the line.
    BreakNone,
    /// The same where the line breaks that are written do not count.
    Refill,
    /// One space, or the line break that is written there.
    Kept,
    /// Nothing, or the line break that is written there.
    KeptNone,
}

/// A document, and how many of its line breaks must stay.
struct Piece {
    doc: RcDoc<'static>,
    breaks: usize,
}

/// The statement as text, from column `indent` on; its first line is not indented.
pub(crate) fn statement(words: &Words<'_>, rule: Rule, trees: &[&Tree], indent: usize) -> String {
    let (text, breaks) = filled(words, rule, trees, indent, false);
    if text.matches('\n').count() > breaks {
        // A line became too long: the rest of its list moves with it.
        filled(words, rule, trees, indent, true).0
    } else {
        text
    }
}

/// The statement as text, and the number of its line breaks that must stay.
fn filled(
    words: &Words<'_>,
    rule: Rule,
    trees: &[&Tree],
    indent: usize,
    refill: bool,
) -> (String, usize) {
    let layout = Layout { words, refill };
    let piece = layout.sequence(rule, trees, 0);
    let inner = isize::try_from(indent + STEP).unwrap_or(0);
    // The indentation counts for the width of the line; it is taken away again.
    let lead = " ".repeat(indent);
    let doc = RcDoc::text(lead.clone()).append(piece.doc.nest(inner));
    let text = doc.pretty(WIDTH).to_string();
    let text = text.strip_prefix(&lead).unwrap_or(&text).to_owned();
    (text, piece.breaks)
}

/// How tightly an operator binds.
pub(crate) fn level(rule: Rule) -> Option<u8> {
    #[expect(
        clippy::wildcard_enum_match_arm,
        reason = "a grammar has many rules and few operators"
    )]
    match rule {
        Rule::or => Some(1),
        Rule::and => Some(2),
        Rule::lt | Rule::le | Rule::gt | Rule::ge | Rule::eq | Rule::ne => Some(4),
        Rule::plus | Rule::minus => Some(5),
        Rule::times | Rule::over => Some(7),
        Rule::power => Some(8),
        _ => None,
    }
}

struct Layout<'w, 'a> {
    words: &'w Words<'a>,
    /// Whether the line breaks in lists are made anew.
    refill: bool,
}

impl Layout<'_, '_> {
    fn tree(&self, tree: &Tree, lists: usize) -> Piece {
        match tree {
            Tree::Word(index) => Piece {
                doc: RcDoc::text(self.words.text(*index).to_owned()),
                breaks: self.words.text(*index).matches('\n').count(),
            },
            Tree::Node(Rule::expression, inner) => self.expression(inner, lists),
            Tree::Node(Rule::conditional, inner) => self.conditional(inner, lists),
            Tree::Node(rule, inner) => {
                self.sequence(*rule, &inner.iter().collect::<Vec<_>>(), lists)
            }
        }
    }

    /// What a construct consists of, one after the other. `lists` is the number of lists around it.
    fn sequence(&self, rule: Rule, trees: &[&Tree], lists: usize) -> Piece {
        let is_list = trees.iter().any(|tree| self.word(tree) == Some(","));
        let inner = if is_list { lists + 1 } else { lists };
        let refill = is_list && self.refill && !self.is_column(trees);
        let chunks = trees.iter().enumerate().map(|(index, tree)| {
            let gap = match index.checked_sub(1).and_then(|before| trees.get(before)) {
                Some(before) if refill && self.word(before) == Some(",") => Gap::Refill,
                Some(before) => self.gap(rule, before, tree),
                None => Gap::Start,
            };
            (gap, tree.first(), self.tree(tree, inner))
        });
        let piece = self.fill(chunks.collect());
        if is_list && lists > 0 {
            indented(piece)
        } else {
            piece
        }
    }

    /// Whether each element of a list is written on a line of its own.
    fn is_column(&self, trees: &[&Tree]) -> bool {
        trees.windows(2).all(|pair| {
            let breaks = self.words.words.get(pair[1].first());
            self.word(pair[0]) != Some(",") || breaks.is_some_and(|word| word.before.breaks > 0)
        })
    }

    /// `if a then b elseif c then d else e`: broken before `elseif` and `else` rather than within.
    fn conditional(&self, trees: &[Tree], lists: usize) -> Piece {
        let starts: Vec<usize> = (0..trees.len())
            .filter(|&at| matches!(self.word(&trees[at]), Some("if" | "elseif" | "else")))
            .collect();
        let ends = starts.iter().skip(1).copied().chain([trees.len()]);
        let clauses = starts.iter().zip(ends).map(|(&start, end)| {
            let clause = &trees[start..end];
            let words = clause.iter().enumerate().map(|(index, tree)| {
                let gap = match (index, self.word(tree)) {
                    (0, _) => Gap::Start,
                    (_, Some("then")) => Gap::Break,
                    _ => Gap::Space,
                };
                (gap, tree.first(), self.tree(tree, lists))
            });
            let gap = if start == 0 { Gap::Start } else { Gap::Break };
            (gap, trees[start].first(), self.fill(words.collect()))
        });
        self.fill(clauses.collect())
    }

    /// Operands and operators: broken before the operator that binds least.
    fn expression(&self, trees: &[Tree], lists: usize) -> Piece {
        let level_of = |tree: &Tree| tree.rule().and_then(level);
        let Some(least) = trees.iter().filter_map(level_of).min() else {
            let words = trees.iter().enumerate().map(|(index, tree)| {
                let signed = index > 0 && {
                    let before = &trees[index - 1];
                    matches!(before.rule(), Some(Rule::negative | Rule::positive))
                };
                let gap = match index {
                    0 => Gap::Start,
                    _ if signed => Gap::None,
                    _ => Gap::Space,
                };
                (gap, tree.first(), self.tree(tree, lists))
            });
            return self.fill(words.collect());
        };
        let mut chunks = Vec::new();
        let mut start = 0;
        let mut operator: Option<&Tree> = None;
        let ends = (0..trees.len()).filter(|&at| level_of(&trees[at]) == Some(least));
        for end in ends.chain([trees.len()]) {
            let operand = self.expression(&trees[start..end], lists);
            let first = trees.get(start).map_or(usize::MAX, Tree::first);
            chunks.push(match operator {
                None => (Gap::Start, first, operand),
                Some(sign) => {
                    let (before, behind) = match least {
                        8 => (Gap::None, Gap::None),
                        7 => (Gap::BreakNone, Gap::None),
                        _ => (Gap::Break, Gap::Space),
                    };
                    let both = vec![
                        (Gap::Start, sign.first(), self.tree(sign, lists)),
                        (behind, first, operand),
                    ];
                    (before, sign.first(), self.fill(both))
                }
            });
            operator = trees.get(end);
            start = end + 1;
        }
        self.fill(chunks)
    }

    /// Pieces with the gap before each and the word that each begins with. What is joined by a space is moved to the next
    /// line as a whole.
    fn fill(&self, pieces: Vec<(Gap, usize, Piece)>) -> Piece {
        let mut breaks = 0;
        let mut chunks: Vec<(RcDoc<'static>, usize, Piece)> = Vec::new();
        for (gap, first, piece) in pieces {
            let (lead, forced, may_break) = self.lead(gap, first);
            breaks += forced + piece.breaks;
            match chunks.last_mut() {
                Some((_, _, last)) if !may_break => {
                    last.breaks += forced + piece.breaks;
                    let before = std::mem::replace(&mut last.doc, RcDoc::nil());
                    last.doc = before.append(lead).append(piece.doc);
                }
                _ => chunks.push((lead, forced, piece)),
            }
        }
        let docs = chunks.into_iter().map(|(lead, forced, piece)| {
            if forced + piece.breaks > 0 {
                lead.group().append(piece.doc)
            } else {
                lead.append(piece.doc).group()
            }
        });
        Piece {
            doc: balanced(&docs.collect::<Vec<_>>()),
            breaks,
        }
    }

    /// What stands before a word, how many line breaks in it stay, and whether the line may be broken there.
    fn lead(&self, gap: Gap, first: usize) -> (RcDoc<'static>, usize, bool) {
        let Some(word) = self.words.words.get(first) else {
            return (RcDoc::nil(), 0, false);
        };
        let before = &word.before;
        if gap != Gap::Start && !before.comments.is_empty() {
            return comments(before);
        }
        let written = before.breaks > 0;
        match gap {
            Gap::Start | Gap::None => (RcDoc::nil(), 0, false),
            Gap::Space => (RcDoc::space(), 0, false),
            Gap::Kept | Gap::KeptNone | Gap::Break | Gap::BreakNone if written => {
                (RcDoc::hardline(), 1, true)
            }
            Gap::Kept => (RcDoc::space(), 0, false),
            Gap::KeptNone => (RcDoc::nil(), 0, false),
            Gap::Break | Gap::Refill => (RcDoc::line(), 0, true),
            Gap::BreakNone => (RcDoc::line_(), 0, true),
        }
    }

    fn word(&self, tree: &Tree) -> Option<&str> {
        match tree {
            Tree::Word(index) => Some(self.words.text(*index)),
            Tree::Node(..) => None,
        }
    }

    /// The gap between two neighbours in a construct.
    fn gap(&self, rule: Rule, left: &Tree, right: &Tree) -> Gap {
        let (before, behind) = (self.word(left), self.word(right));
        match (before, behind) {
            (_, Some("," | ";" | ")" | "]" | ".")) | (Some("(" | "[" | "."), _) => {
                return Gap::None;
            }
            (Some(","), _) => return Gap::Break,
            (_, Some("(")) if rule == Rule::over_variables => return Gap::Space,
            (_, Some("(")) => return Gap::None,
            (Some(":"), _) | (_, Some(":")) => return Gap::None,
            (Some("{"), _) if rule == Rule::array => return Gap::KeptNone,
            (_, Some("}")) if rule == Rule::array => return Gap::None,
            (Some("±" | "+/-" | "+-"), _) | (_, Some("%")) => return Gap::None,
            (_, Some("=")) if rule == Rule::equality => return Gap::Kept,
            (_, Some("over" | "by" | "in" | "with"))
                if matches!(rule, Rule::bode | Rule::margins | Rule::figure) =>
            {
                return Gap::Break;
            }
            (Some("budget" | "vary" | "measured" | "stimulus" | "replay"), _) => return Gap::Kept,
            _ => {}
        }
        let quoted = before.is_some_and(|text| text.starts_with('"'));
        let named = before.is_some_and(|text| text != "," && !quoted);
        match right.rule() {
            Some(Rule::arguments | Rule::modification | Rule::subscript | Rule::upper) => Gap::None,
            Some(Rule::records | Rule::mode_parameters) => Gap::None,
            Some(Rule::layout) if named => Gap::None,
            Some(
                Rule::doc
                | Rule::source
                | Rule::within
                | Rule::over_variables
                | Rule::prior
                | Rule::effects
                | Rule::over_what
                | Rule::by_steps
                | Rule::at_point
                | Rule::in_modes
                | Rule::place
                | Rule::load
                | Rule::start
                | Rule::stop
                | Rule::every
                | Rule::skip,
            ) => Gap::Break,
            _ => Gap::Space,
        }
    }
}

/// The comments inside of a statement, before a word.
fn comments(before: &Before<'_>) -> (RcDoc<'static>, usize, bool) {
    let line = |breaks| match breaks {
        true => RcDoc::hardline(),
        false => RcDoc::space(),
    };
    let mut doc = RcDoc::nil();
    let (mut forced, mut after_line) = (0, false);
    for comment in &before.comments {
        let breaks = comment.breaks > 0 || after_line;
        forced += usize::from(breaks) + comment.text.matches('\n').count();
        doc = doc.append(line(breaks)).append(comment.text.to_owned());
        after_line = comment.is_line();
    }
    let breaks = before.breaks > 0 || after_line;
    (doc.append(line(breaks)), forced + usize::from(breaks), true)
}

fn indented(piece: Piece) -> Piece {
    Piece {
        doc: piece.doc.nest(STEP.cast_signed()),
        ..piece
    }
}

/// All documents one after the other, in a tree that is no deeper than necessary.
fn balanced(docs: &[RcDoc<'static>]) -> RcDoc<'static> {
    match docs {
        [] => RcDoc::nil(),
        [one] => one.clone(),
        [..] => {
            let (left, right) = docs.split_at(docs.len() / 2);
            balanced(left).append(balanced(right))
        }
    }
}
