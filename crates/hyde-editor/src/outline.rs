//! The structure of a text: its symbols, what can be folded, and what encloses a place.

#![expect(
    clippy::wildcard_enum_match_arm,
    reason = "a grammar has many rules, and an experiment many items"
)]

use crate::position::Encoding;
use hyde_diag::{Diagnostics, Sources};
use hyde_syntax::ast::{
    Class, ClassBody, ClassKind, Declared, Element, ExperimentItem, File, Item, Name, Prefix,
};
use hyde_syntax::{Node, Rule, Written};
use lsp_types::{DocumentSymbol, FoldingRange, FoldingRangeKind, SelectionRange, SymbolKind};
use std::ops::Range;

/// How a text is written.
pub(crate) fn written(text: &str) -> Written {
    let mut sources = Sources::new();
    let file = sources.add("", text);
    hyde_syntax::written(&sources, file, &mut Diagnostics::new())
}

/// The symbols of a file, each with those inside.
pub(crate) fn symbols(tree: &File, text: &str, encoding: Encoding) -> Vec<DocumentSymbol> {
    let outline = Outline { text, encoding };
    tree.items.iter().map(|item| outline.item(item)).collect()
}

struct Outline<'t> {
    text: &'t str,
    encoding: Encoding,
}

impl Outline<'_> {
    fn item(&self, item: &Item) -> DocumentSymbol {
        match item {
            Item::Type(item) => {
                let end = item.base.span.to(item.name.span).end as usize;
                let whole = item.name.span.start as usize..end;
                self.symbol(&item.name, SymbolKind::CLASS, whole, item.base.dotted())
            }
            Item::Class(class) => self.class(class),
            Item::Experiment(experiment) => {
                let span = experiment.span.start as usize..experiment.span.end as usize;
                let detail = format!("of {}", experiment.model.dotted());
                let mut own = self.symbol(&experiment.name, SymbolKind::EVENT, span, detail);
                let measures = experiment.items.iter().filter_map(|item| match item {
                    ExperimentItem::Measure(measure) => {
                        let name = &measure.name;
                        let whole = name.span.start as usize..measure.value.span.end as usize;
                        let detail = measure.type_name.dotted();
                        Some(self.symbol(name, SymbolKind::NUMBER, whole, detail))
                    }
                    _ => None,
                });
                own.children = Some(measures.collect());
                own
            }
            Item::Study(study) => {
                let span = study.span.start as usize..study.span.end as usize;
                let detail = format!("{} {}", study.kind.word(), study.of.dotted());
                self.symbol(&study.name, SymbolKind::EVENT, span, detail)
            }
        }
    }

    fn class(&self, class: &Class) -> DocumentSymbol {
        let kind = match class.kind {
            ClassKind::Model => SymbolKind::CLASS,
            ClassKind::Connector => SymbolKind::INTERFACE,
            ClassKind::Effect => SymbolKind::MODULE,
            ClassKind::Function => SymbolKind::FUNCTION,
        };
        let span = class.span.start as usize..class.span.end as usize;
        let mut own = self.symbol(
            &class.name,
            kind,
            span,
            class.doc.clone().unwrap_or_default(),
        );
        if let ClassBody::Long { elements, .. } = &class.body {
            own.children = Some(self.elements(elements));
        }
        own
    }

    fn elements(&self, elements: &[Element]) -> Vec<DocumentSymbol> {
        let mut list = Vec::new();
        for element in elements {
            if let Element::Modes(modes) = element {
                for mode in &modes.modes {
                    let whole = mode.name.span.start as usize..mode.name.span.end as usize;
                    let detail = "mode".to_owned();
                    list.push(self.symbol(&mode.name, SymbolKind::ENUM_MEMBER, whole, detail));
                }
                continue;
            }
            let declared = element.declared().into_iter();
            list.extend(declared.filter_map(|(name, own)| self.declared(name, own)));
        }
        list
    }

    fn declared(&self, name: &Name, declared: Declared<'_>) -> Option<DocumentSymbol> {
        let own = name.span.start as usize..name.span.end as usize;
        Some(match declared {
            Declared::Variable(declaration, _) => {
                let kind = match declaration.prefixes.contains(&Prefix::Parameter) {
                    true => SymbolKind::CONSTANT,
                    false => SymbolKind::VARIABLE,
                };
                self.symbol(name, kind, own, declaration.type_name.dotted())
            }
            Declared::Clocked(clocked) => {
                let whole = clocked.span.start as usize..clocked.span.end as usize;
                let mut own = self.symbol(name, SymbolKind::MODULE, whole, "clocked".to_owned());
                own.children = Some(self.elements(&clocked.elements));
                own
            }
            Declared::Measure(measure, _) => {
                let whole = own.start..measure.value.span.end as usize;
                let detail = measure.type_name.dotted();
                self.symbol(name, SymbolKind::NUMBER, whole, detail)
            }
            Declared::Domain(_) | Declared::Coordinate(_) | Declared::Modes(_) => return None,
        })
    }

    #[allow(deprecated, reason = "the field must be given a value")]
    fn symbol(
        &self,
        name: &Name,
        kind: SymbolKind,
        whole: Range<usize>,
        detail: String,
    ) -> DocumentSymbol {
        let own = name.span.start as usize..name.span.end as usize;
        let whole = whole.start.min(own.start)..whole.end.max(own.end);
        DocumentSymbol {
            // A client refuses a symbol without a name.
            name: match name.text.is_empty() {
                true => "?".to_owned(),
                false => name.text.clone(),
            },
            detail: (!detail.is_empty()).then_some(detail),
            kind,
            tags: None,
            deprecated: None,
            range: self.encoding.range(self.text, whole),
            selection_range: self.encoding.range(self.text, own),
            children: None,
        }
    }
}

/// Lines that can be folded: items, clocked parts, blocks, and runs of line comments.
pub(crate) fn folds(text: &str, written: &Written) -> Vec<FoldingRange> {
    let line_of = |byte: usize| {
        let before = text.get(..byte).unwrap_or(text);
        u32::try_from(before.matches('\n').count()).unwrap_or(u32::MAX)
    };
    let mut folds: Vec<FoldingRange> = blocks(written)
        .into_iter()
        .map(|block| (line_of(block.start), line_of(block.end)))
        .filter(|(first, last)| last > first)
        .map(|(start_line, end_line)| FoldingRange {
            start_line,
            // The line of the end stays to be seen.
            end_line: end_line - 1,
            ..FoldingRange::default()
        })
        .filter(|fold| fold.end_line > fold.start_line)
        .collect();
    let mut begins: Option<u32> = None;
    for (number, line) in (0_u32..).zip(text.lines().chain([""])) {
        let comment = line.trim_start().starts_with("//");
        match (begins, comment) {
            (None, true) => begins = Some(number),
            (Some(first), false) => {
                begins = None;
                if number > first + 1 {
                    folds.push(FoldingRange {
                        start_line: first,
                        end_line: number - 1,
                        kind: Some(FoldingRangeKind::Comment),
                        ..FoldingRange::default()
                    });
                }
            }
            _ => {}
        }
    }
    folds
}

/// The places of items and of what is a block inside.
fn blocks(written: &Written) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    for part in &written.parts {
        let mut open: Vec<usize> = Vec::new();
        for piece in &part.pieces {
            match piece.rule {
                Rule::class_header
                | Rule::experiment_header
                | Rule::study_header
                | Rule::clocked_header => open.push(piece.start),
                Rule::end_clause => {
                    found.extend(open.pop().map(|start| start..piece.end));
                }
                _ => inner_blocks(piece, &mut found),
            }
        }
    }
    found
}

fn inner_blocks(node: &Node, found: &mut Vec<Range<usize>>) {
    let block = [
        Rule::modes,
        Rule::mode,
        Rule::for_equation,
        Rule::if_equation,
        Rule::when_equation,
    ];
    if block.contains(&node.rule) {
        found.push(node.start..node.end);
    }
    node.children
        .iter()
        .for_each(|own| inner_blocks(own, found));
}

/// The names behind `end`, each with the name that was opened.
pub(crate) fn ends(written: &Written) -> Vec<(Range<usize>, Range<usize>)> {
    let mut found = Vec::new();
    for part in &written.parts {
        let mut open: Vec<Option<Range<usize>>> = Vec::new();
        for piece in &part.pieces {
            let name = || {
                let own = piece.children.iter().find(|own| own.rule == Rule::ident);
                own.map(|own| own.start..own.end)
            };
            match piece.rule {
                Rule::class_header
                | Rule::experiment_header
                | Rule::study_header
                | Rule::clocked_header => open.push(name()),
                Rule::end_clause => {
                    if let (Some(Some(opened)), Some(closed)) = (open.pop(), name()) {
                        found.push((opened, closed));
                    }
                }
                _ => {}
            }
        }
    }
    found
}

/// What encloses a byte, the smallest first: words, constructs, items.
pub(crate) fn selection(
    text: &str,
    written: &Written,
    byte: usize,
    encoding: Encoding,
) -> SelectionRange {
    let mut around: Vec<Range<usize>> = std::iter::once(0..text.len()).collect();
    for part in &written.parts {
        if part.start <= byte && byte <= part.end {
            around.push(part.start..part.end);
            for piece in &part.pieces {
                enclosing(text, piece, byte, &mut around);
            }
        }
    }
    around.extend(
        blocks(written)
            .into_iter()
            .filter(|block| block.start <= byte && byte <= block.end),
    );
    // The largest first, each inside the one before.
    around.sort_by_key(|range| (std::cmp::Reverse(range.len()), range.start));
    around.dedup();
    let mut chain: Option<SelectionRange> = None;
    let mut last = 0..text.len();
    for range in around {
        if range.start < last.start || range.end > last.end {
            continue;
        }
        last = range.clone();
        chain = Some(SelectionRange {
            range: encoding.range(text, range),
            parent: chain.map(Box::new),
        });
    }
    chain.unwrap_or(SelectionRange {
        range: encoding.range(text, 0..text.len()),
        parent: None,
    })
}

fn enclosing(text: &str, node: &Node, byte: usize, around: &mut Vec<Range<usize>>) {
    let end = node.start
        + text
            .get(node.start..node.end)
            .map_or(0, |own| own.trim_end().len());
    if node.start <= byte && byte <= end {
        around.push(node.start..end);
        node.children
            .iter()
            .for_each(|own| enclosing(text, own, byte, around));
    }
}
