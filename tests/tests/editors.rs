//! What editors have of the language: the grammar of the extension for VS Code and the colours of the book know every word of
//! the language, and the book has the settings of the folder `editors`.

use hyde_tests::root;
use serde_json::Value;
use std::collections::BTreeSet;

fn read(path: &str) -> String {
    let path = root().join(path);
    let text = hyde_study::world::read_text(&hyde_study::world::Disk, &path);
    text.unwrap_or_else(|reason| panic!("{reason}"))
}

fn json(path: &str) -> Value {
    serde_json::from_str(&read(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The words that the grammar of the compiler has a rule for.
fn words() -> BTreeSet<String> {
    let grammar = read("grammar/hyde.pest");
    let rules = grammar.lines().filter_map(|line| line.strip_prefix("kw_"));
    let word = |rule: &str| rule.split([' ', '=']).next().unwrap_or_default().to_owned();
    rules.map(word).collect()
}

/// The alternatives between brackets in every pattern of a value.
fn alternatives(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Array(list) => list.iter().for_each(|own| alternatives(own, found)),
        Value::Object(map) => {
            if let Some(pattern) = map.get("match").and_then(Value::as_str) {
                let list = pattern.split(['(', ')', '|']);
                found.extend(list.map(str::to_owned));
            }
            map.values().for_each(|own| alternatives(own, found));
        }
        Value::Null | Value::Bool(_) | Value::Number(_) | Value::String(_) => {}
    }
}

#[test]
fn the_grammar_of_the_extension_has_every_word_of_the_language() {
    let grammar = json("editors/vscode/syntaxes/hyde.tmLanguage.json");
    let mut known = BTreeSet::new();
    alternatives(&grammar["repository"], &mut known);
    let words = words();
    assert!(words.len() > 70, "{}", words.len());
    let missing: Vec<&String> = words.difference(&known).collect();
    assert!(missing.is_empty(), "not in the grammar: {missing:?}");
}

#[test]
fn the_colours_of_the_book_have_every_word_of_the_language() {
    let book = read("book/book.toml");
    assert!(book.contains("additional-js = [\"hyde.js\"]"), "{book}");
    let script = read("book/hyde.js");
    let known: BTreeSet<&str> = script
        .split(|sign: char| !(sign.is_ascii_alphanumeric() || sign == '_'))
        .collect();
    let words = words();
    let missing: Vec<&String> = words
        .iter()
        .filter(|word| !known.contains(word.as_str()))
        .collect();
    assert!(missing.is_empty(), "not in the colours: {missing:?}");
}

#[test]
fn the_page_on_editors_has_the_settings_of_the_folder() {
    let page = read("book/src/editor.md");
    for file in ["neovim/hyde.lua", "helix/languages.toml", "emacs/init.el"] {
        let settings = read(&format!("editors/{file}"));
        assert!(page.contains(&format!("\n{settings}```")), "{file}");
    }
    let readme = read("editors/README.md");
    let commands = readme.split("```sh\n").nth(1);
    let commands = commands.and_then(|rest| rest.split("```").next());
    assert!(page.contains(commands.unwrap_or("no commands")), "commands");
}

#[test]
fn the_extension_names_files_that_are_there_and_snippets_that_are_of_the_language() {
    let package = json("editors/vscode/package.json");
    assert_eq!(
        package["contributes"]["languages"][0]["extensions"][0],
        ".hyde"
    );
    for file in ["grammars", "snippets"] {
        let path = package["contributes"][file][0]["path"].as_str();
        let path = path.unwrap_or_default().trim_start_matches("./");
        assert!(json(&format!("editors/vscode/{path}")).is_object());
    }
    // The words before the first place to fill in are those of the language.
    let snippets = json("editors/vscode/snippets/hyde.json");
    for (name, snippet) in snippets.as_object().into_iter().flatten() {
        let first = snippet["body"].as_str().or(snippet["body"][0].as_str());
        let word = first
            .unwrap_or_default()
            .split(' ')
            .next()
            .unwrap_or_default();
        assert!(words().contains(word), "{name}: `{word}`");
    }
}
