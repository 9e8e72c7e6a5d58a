//! Statement after statement, each on a line of its own, with the comments and blank lines between.

use crate::WIDTH;
use crate::layout::{self, STEP};
use crate::words::{Before, Part, Tree, Word, Words};
use hyde_syntax::Rule;

/// Prints a file.
pub(crate) fn print(words: &Words<'_>) -> String {
    let mut printer = Printer {
        words,
        text: String::new(),
        depth: 0,
        begins: true,
    };
    for part in &words.parts {
        printer.depth = 0;
        match part {
            Part::Parsed(pieces) => pieces
                .iter()
                .for_each(|(rule, trees)| printer.piece(*rule, trees)),
            Part::Kept(word) => {
                printer.before_word(*word);
                printer.new_line();
                printer.text.push_str(words.text(*word));
            }
        }
    }
    printer.depth = 0;
    printer.before(&words.rest, false);
    let mut text = printer.text;
    if !text.is_empty() {
        text.push('\n');
    }
    text
}

struct Printer<'w, 'a> {
    words: &'w Words<'a>,
    /// Without the line break of the last line.
    text: String,
    depth: usize,
    /// Whether nothing is printed yet of the block.
    begins: bool,
}

impl Printer<'_, '_> {
    /// A header, an element, a word that begins a section, or an end.
    fn piece(&mut self, rule: Rule, trees: &[Tree]) {
        #[expect(
            clippy::wildcard_enum_match_arm,
            reason = "a grammar has many rules; most of the elements are one line"
        )]
        match rule {
            Rule::class_header
            | Rule::experiment_header
            | Rule::study_header
            | Rule::clocked_header => {
                self.line(rule, trees, "");
                self.depth += 1;
                self.begins = true;
            }
            Rule::end_clause => self.close(rule, trees),
            Rule::section => {
                if let Some(first) = trees.first() {
                    self.before_word(first.first());
                }
                self.depth = self.depth.saturating_sub(1);
                self.rest_of_line(rule, &trees.iter().collect::<Vec<_>>(), "");
                self.depth += 1;
                self.begins = true;
            }
            _ => self.element(rule, trees, ""),
        }
    }

    /// An element. `lead` stands before it on its line.
    fn element(&mut self, rule: Rule, trees: &[Tree], lead: &str) {
        match (rule, trees) {
            (Rule::equation, [Tree::Node(inner, trees)]) => self.element(*inner, trees, lead),
            (Rule::added, [add @ Tree::Word(_), Tree::Node(inner, trees)]) => {
                self.added(add, *inner, trees);
            }
            (Rule::for_equation | Rule::if_equation | Rule::when_equation, _) => {
                self.blocks(rule, trees, lead);
            }
            (Rule::modes | Rule::mode, _) => self.blocks(rule, trees, lead),
            (Rule::enter | Rule::leave | Rule::exit, _) => match self.one_line(rule, trees) {
                Some(line) => {
                    self.before_tree(trees);
                    self.new_line();
                    self.text.push_str(&line);
                }
                None => self.blocks(rule, trees, lead),
            },
            _ => self.line(rule, trees, lead),
        }
    }

    /// `add` and its equation.
    fn added(&mut self, add: &Tree, rule: Rule, trees: &[Tree]) {
        let add = std::slice::from_ref(add);
        let inner = trees.first().map_or(usize::MAX, Tree::first);
        let commented = self.words.words.get(inner);
        if commented.is_some_and(|word| !word.before.comments.is_empty()) {
            self.line(Rule::added, add, "");
            self.element(rule, trees, "");
        } else {
            self.before_tree(add);
            self.element(rule, trees, "add ");
        }
    }

    /// A construct with statements inside: its lines, and its blocks further in.
    fn blocks(&mut self, rule: Rule, trees: &[Tree], lead: &str) {
        // The words of a list of actions stand in the line of their parent.
        let flat = trees.iter().flat_map(|tree| match tree {
            Tree::Node(Rule::exit_actions | Rule::equations, inner) => inner.iter(),
            Tree::Node(..) | Tree::Word(_) => std::slice::from_ref(tree).iter(),
        });
        let mut line: Vec<&Tree> = Vec::new();
        let (mut inside, mut lead) = (false, lead);
        if lead.is_empty() {
            self.before_tree(trees);
        }
        for tree in flat {
            let word = match tree {
                Tree::Word(index) => self.words.text(*index),
                Tree::Node(inner, statement) if inside && is_statement(*inner) => {
                    self.element(*inner, statement, "");
                    continue;
                }
                Tree::Node(..) => "",
            };
            if inside && matches!(word, "elseif" | "elsewhen" | "else" | "end" | "}") {
                self.before_end(tree);
                self.depth = self.depth.saturating_sub(1);
                inside = false;
            }
            line.push(tree);
            if matches!(word, "then" | "loop" | "{" | "else") {
                self.rest_of_line(rule, &line, lead);
                line.clear();
                lead = "";
                self.depth += 1;
                self.begins = true;
                inside = true;
            }
        }
        if !line.is_empty() {
            self.rest_of_line(rule, &line, lead);
        }
    }

    /// The statement on one line, if it is written on one and is short enough.
    fn one_line(&self, rule: Rule, trees: &[Tree]) -> Option<String> {
        let first = trees.first()?.first();
        let last = trees.last()?.last();
        let inner = self.words.words.get(first + 1..=last)?;
        let joined = |word: &Word<'_>| word.before.breaks == 0 && word.before.comments.is_empty();
        if !inner.iter().all(joined) {
            return None;
        }
        let trees: Vec<&Tree> = trees.iter().collect();
        let line = layout::statement(self.words, rule, &trees, self.indent());
        let short = self.indent() + line.chars().count() <= WIDTH;
        (short && !line.contains('\n')).then_some(line)
    }

    /// A statement with what stands before it.
    fn line(&mut self, rule: Rule, trees: &[Tree], lead: &str) {
        if lead.is_empty() {
            self.before_tree(trees);
        }
        self.rest_of_line(rule, &trees.iter().collect::<Vec<_>>(), lead);
    }

    fn rest_of_line(&mut self, rule: Rule, trees: &[&Tree], lead: &str) {
        self.new_line();
        self.text.push_str(lead);
        let indent = self.indent();
        let line = layout::statement(self.words, rule, trees, indent);
        self.text.push_str(&line);
    }

    /// The end of a class, an experiment or a study.
    fn close(&mut self, rule: Rule, trees: &[Tree]) {
        if let Some(first) = trees.first() {
            self.before_end(first);
        }
        self.depth = self.depth.saturating_sub(1);
        self.rest_of_line(rule, &trees.iter().collect::<Vec<_>>(), "");
    }

    fn indent(&self) -> usize {
        self.depth * STEP
    }

    /// Begins a line.
    fn new_line(&mut self) {
        if !self.text.is_empty() {
            self.text.push('\n');
        }
        self.text.push_str(&" ".repeat(self.indent()));
        self.begins = false;
    }

    fn before_tree(&mut self, trees: &[Tree]) {
        if let Some(first) = trees.first() {
            self.before_word(first.first());
        }
    }

    /// What stands before the word that begins a statement.
    fn before_word(&mut self, index: usize) {
        let words = self.words;
        if let Some(word) = words.words.get(index) {
            self.before(&word.before, true);
        }
    }

    /// What stands before the word that ends a block.
    fn before_end(&mut self, tree: &Tree) {
        let words = self.words;
        if let Some(word) = words.words.get(tree.first()) {
            self.before(&word.before, false);
        }
    }

    /// Comments and the blank line that separates.
    fn before(&mut self, before: &Before<'_>, blank: bool) {
        for (index, comment) in before.comments.iter().enumerate() {
            let next = before.comments.get(index + 1);
            let ends_line = next.map_or(before.breaks, |next| next.breaks) > 0;
            let trailing = comment.breaks == 0 && (comment.is_line() || ends_line || !blank);
            if trailing && !self.text.is_empty() {
                self.text.push(' ');
            } else {
                self.separate(comment.breaks);
                self.new_line();
            }
            self.text.push_str(comment.text);
        }
        if blank {
            self.separate(before.breaks);
        }
    }

    /// A blank line, if the text has one or more at this place.
    fn separate(&mut self, breaks: usize) {
        if breaks > 1 && !self.begins && !self.text.is_empty() {
            self.text.push('\n');
        }
    }
}

/// Whether a construct inside of another is a statement of its own.
fn is_statement(rule: Rule) -> bool {
    matches!(
        rule,
        Rule::equation | Rule::mode | Rule::enter | Rule::leave | Rule::exit
    )
}
