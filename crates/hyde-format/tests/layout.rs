//! The layout of every construct, comments at every place, texts with errors, and line breaks.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_diag::{Diagnostics, Sources};

/// Every construct of the language, many on one line.
const EVERYTHING: &str = include_str!("everything.txt");

fn format(text: &str) -> String {
    let formatted = hyde_format::format("test.hyde", text);
    formatted
        .unwrap_or_else(|failure| panic!("{failure:?}:\n{text}"))
        .text
}

/// The tree as text: equal for equal trees.
fn tree(text: &str) -> String {
    let mut sources = Sources::new();
    let file = sources.add("test.hyde", text);
    let tree = hyde_syntax::parse(&sources, file, &mut Diagnostics::new());
    hyde_syntax::format(&tree)
}

#[test]
fn every_construct_has_its_layout() {
    let formatted = format(EVERYTHING);
    assert_eq!(tree(&formatted), tree(EVERYTHING));
    assert_eq!(format(&formatted), formatted);
    insta::assert_snapshot!(formatted);
}

#[test]
fn a_comment_at_any_place_survives() {
    let mut places = 0;
    // Item by item: a whole file takes longer.
    let (head, items) = EVERYTHING.split_once("type Lead").unwrap();
    let items = format!("type Lead{items}").replace("\nmodel ", "\0model ");
    for item in items
        .replace("\neffect ", "\0effect ")
        .split('\0')
        .chain([head])
    {
        let before = tree(item);
        for end in word_ends(item) {
            places += 1;
            let comments = [
                "/* here */",
                "// here\n",
                "\n// here\n",
                "\n\n/* here\n   too */\n",
            ];
            for comment in [comments[places % 2], comments[2 + places / 2 % 2]] {
                let text = format!("{} {comment}{}", &item[..end], &item[end..]);
                let formatted = format(&text);
                let kept = formatted.matches(comment.trim()).count();
                assert_eq!(kept, 1, "`{comment}` behind byte {end}:\n{formatted}");
                assert_eq!(tree(&formatted), before, "`{comment}` behind byte {end}");
            }
        }
    }
    assert!(places > 1000, "{places}");
}

/// Where the words and signs of a text end that stand outside of texts and units.
fn word_ends(text: &str) -> Vec<usize> {
    let mut ends = Vec::new();
    let (mut quoted, mut unit) = (false, false);
    let chars: Vec<(usize, char)> = text.char_indices().collect();
    for pair in chars.windows(2) {
        let ((_, here), (at, next)) = (pair[0], pair[1]);
        quoted ^= here == '"';
        unit = !quoted && (here == '[' || unit) && here != ']';
        let inside = |c: char| c.is_alphanumeric() || "_.+-*<>=±~%/\\".contains(c);
        if !(quoted || unit || inside(here) && inside(next)) {
            ends.push(at);
        }
    }
    ends
}

#[test]
fn blank_lines_separate_and_several_become_one() {
    let text = "\n\nmodel A\n\n  Real x;\n\n\n  Real y; // last\n\nequation\n\n  x = 1;\n\n  y = 2;\n\n\nend A;\n\n\n\nmodel B end B;";
    let expected = "model A\n  Real x;\n\n  Real y; // last\n\nequation\n  x = 1;\n\n  y = 2;\nend A;\n\nmodel B\nend B;\n";
    assert_eq!(format(text), expected);
}

#[test]
fn an_item_with_an_error_stays_as_it_is() {
    let text = "model  A\nReal x;\nend A;\n// of B\nmodel  B\n  Real   x := 1;\nend B;\nmodel  C\nReal x;\nend C;\n";
    let formatted = hyde_format::format("test.hyde", text).unwrap();
    assert_eq!(
        formatted.text,
        "model A\n  Real x;\nend A;\n// of B\nmodel  B\n  Real   x := 1;\nend B;\nmodel C\n  Real x;\nend C;\n"
    );
    let errors: Vec<_> = formatted.errors.iter().collect();
    let place = formatted.sources.place(errors[0].labels[0].span);
    assert_eq!((errors.len(), place.as_str()), (1, "test.hyde:6"));
}

#[test]
fn what_stands_before_a_comment_without_end_is_formatted() {
    let text = "model A\nReal   x;\nend A;\n\n// of B\nmodel B\nReal   y; /* the rest\nend B;\nmodel  C\nend C;\n";
    let expected = text.replacen("Real   x", "  Real x", 1);
    assert_eq!(format(text), expected);
    assert_eq!(format(&expected), expected);
    let formatted = hyde_format::format("test.hyde", text).unwrap();
    assert_eq!(formatted.errors.iter().count(), 1);
    // Between items, and where a file has nothing else.
    let text = "model A\nReal   x;\nend A;\n\n/* model B\n   Real y;\n";
    assert_eq!(format(text), text.replacen("Real   x", "  Real x", 1));
    assert_eq!(format("/* all\n  of it\n"), "/* all\n  of it\n");
    // Before a text without end everything may be the inside of another.
    let text = "model A \"one\nReal   x;\nend A;\nmodel B \"two\"\nend B;\n";
    assert_eq!(format(text), text);
}

#[test]
fn a_line_is_broken_at_120_columns_and_not_before() {
    let (one, two) = ("x".repeat(52), "y".repeat(43));
    let fits = format!("model A\n  Part part(aa = {one}, b = {two});\nend A;\n");
    assert_eq!(fits.lines().nth(1).unwrap().len(), 120);
    assert_eq!(format(&fits), fits);
    let long = fits.replace("aa", "aaa");
    let broken = long.replace(", b", ",\n    b");
    assert_eq!(format(&long), broken);
}

#[test]
fn a_written_line_break_stays_unless_a_line_before_it_is_too_long() {
    let kept =
        "model A\n  Part part(a = 1, b = 2,\n    c = 3, d = 4);\n  Real x = 1\n    + 2;\nend A;\n";
    assert_eq!(format(kept), kept);
    let name = "n".repeat(100);
    let long = format!("model A\n  Part part({name} = 1, b = 2,\n    c = 3, d = 4);\nend A;\n");
    let moved = format!("model A\n  Part part({name} = 1,\n    b = 2, c = 3, d = 4);\nend A;\n");
    assert_eq!(format(&long), moved);
}

#[test]
fn line_breaks_and_the_mark_of_byte_order_are_those_of_the_text() {
    assert_eq!(
        format("\u{feff}model A \"two\r\nlines\"\r\nReal x; // c\r\nend A;\r\n"),
        "\u{feff}model A \"two\r\nlines\"\r\n  Real x; // c\r\nend A;\r\n"
    );
    assert_eq!(format(""), "");
    assert_eq!(format("\n // only\n"), "// only\n");
}

#[test]
fn texts_that_are_no_model_do_not_panic() {
    for text in [
        "model",
        "end;",
        "\"",
        "/*",
        "\u{1F600}",
        "}}}}",
        "model A modes initial x {",
        "type",
        "[[[",
        "//",
        ";",
        "model A Real x\u{a0}; end A;",
        "\u{a0}// c\u{a0}\nmodel A end A;",
        "experiment e of",
        "model A equation x = - /* c */ 1; end A;",
        "/*//\n*/model//modelmodel",
        "\"//\"end=//\"}\"",
        "model//\nA(end end*/\n",
    ] {
        let formatted = format(text);
        assert_eq!(format(&formatted), formatted);
    }
}
