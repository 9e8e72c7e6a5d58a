//! Any text becomes a tree or errors with a place. A tree that is printed is read as the same tree; a text that is formatted
//! has the same tree, and is formatted already.
#![no_main]

use hyde_diag::{Diagnostics, Sources};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let (printed, errors) = tree(text);
    let formatted = hyde_format::format("fuzz.hyde", text);
    let Ok(formatted) = formatted else { return };
    let again = hyde_format::format("fuzz.hyde", &formatted.text);
    let again = again.expect("a formatted text can be formatted");
    assert_eq!(formatted.text, again.text, "formatting again changes it");
    assert_eq!(
        tree(&formatted.text),
        (printed.clone(), errors),
        "another tree"
    );
    if errors == 0 {
        assert_eq!(tree(&printed), (printed.clone(), 0), "the printed tree");
    }
});

/// The tree as text, and the number of its errors.
fn tree(text: &str) -> (String, usize) {
    let mut sources = Sources::new();
    let file = sources.add("fuzz.hyde", text.trim_start_matches('\u{feff}'));
    let mut diagnostics = Diagnostics::new();
    let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
    for label in diagnostics.iter().flat_map(|diagnostic| &diagnostic.labels) {
        let range = label.span.start as usize..label.span.end as usize;
        let known = &sources.get(label.span.file).text;
        assert!(known.get(range).is_some(), "a place outside the text");
    }
    (hyde_syntax::format(&tree), diagnostics.error_count())
}
