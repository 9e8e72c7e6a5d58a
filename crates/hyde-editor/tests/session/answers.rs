//! What the server answers, on a small model.

use crate::client::{Client, edited, find};
use serde_json::{Value, json};

const PATH: &str = "/nowhere/slide.hyde";
const TEXT: &str = r#"package slide "a mass with µ friction";
import SI.*;
import Translational.*;

model Slide "a mass on a guide"
  parameter Force F0 = 3 [N] "that pushes";
  Drive push(F = F0);
  Mass body(M = 2 [kg], s(start = 0));
  Guide guide(F = 1 [N]);
equation
  connect(push.a, body.a, guide.a);
end Slide;

experiment shove of Slide(F0 = 4 [N])
  measure Length way = max(body.s);
  expect way > 0 [m];
  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];
end shove;
"#;

#[test]
fn a_right_model_has_no_diagnostics_and_a_wrong_one_has_those_of_the_compiler() {
    let mut client = Client::with(PATH, TEXT);
    assert!(client.diagnostics(PATH, |_| true).is_empty());
    // Syntax errors come at once, the others after a pause.
    let (line, character) = find(TEXT, "way > 0 [m]", ";");
    let range = json!({ "start": { "line": line, "character": character },
        "end": { "line": line, "character": character + 1 } });
    client.change(PATH, 2, json!([{ "range": range, "text": "" }]));
    let found = client.diagnostics(PATH, |list| !list.is_empty());
    assert_eq!(found[0]["code"], "E0101", "{found:?}");
    client.change(
        PATH,
        3,
        json!([{ "text": TEXT.replace("M = 2 [kg]", "M = 2 [N]") }]),
    );
    let found = client.diagnostics(PATH, |list| !list.is_empty());
    assert_eq!(found[0]["code"], "E0301", "{found:?}");
    assert_eq!(found[0]["range"]["start"]["line"], 7);
    let about = client.at("textDocument/hover", PATH, find(TEXT, "body(", "M"));
    assert!(about.to_string().contains("E0301: two sides"), "{about}");
    client.end();
}

#[test]
fn a_hover_has_declaration_type_unit_value_and_documentation() {
    let mut client = Client::with(PATH, TEXT);
    let parameter = client.hover((PATH, TEXT), "push(F = ", "F0");
    assert_eq!(
        parameter,
        "```hyde\nparameter Force F0 = 3 [N]\n```\n\nthat pushes\n\nunit `N`  \n`F0` = 3 N"
    );
    let member = client.hover((PATH, TEXT), "body(", "M");
    assert!(member.contains("parameter Mass M"), "{member}");
    assert!(member.contains("unit `kg`"), "{member}");
    assert!(member.contains("Translational.hyde:"), "{member}");
    let class = client.hover((PATH, TEXT), "F0);\n  ", "Mass");
    assert!(
        class.contains("model Mass\n```\n\na body that slides"),
        "{class}"
    );
    assert!(
        client
            .hover((PATH, TEXT), "connect(push.", "a")
            .contains("Rail a")
    );
    assert!(
        client
            .hover((PATH, TEXT), "max(", "body")
            .contains("Mass body")
    );
    assert!(
        client
            .hover((PATH, TEXT), "expect ", "way")
            .contains("measure Length way")
    );
    assert_eq!(client.hover((PATH, TEXT), "sol", "ve"), "");
    client.end();
}

#[test]
fn a_definition_is_in_the_file_or_in_the_library() {
    let mut client = Client::with(PATH, TEXT);
    let own = client.at(
        "textDocument/definition",
        PATH,
        find(TEXT, "push(F = ", "F0"),
    );
    assert_eq!(own["uri"], "file:///nowhere/slide.hyde");
    assert_eq!(own["range"]["start"], json!({ "line": 5, "character": 18 }));
    let library = client.at(
        "textDocument/definition",
        PATH,
        find(TEXT, "connect(push.", "a"),
    );
    assert_eq!(library["uri"], "file:///library/Translational.hyde");
    client.end();
}

#[test]
fn completion_knows_members_parameters_units_and_keywords() {
    let mut client = Client::with(PATH, TEXT);
    let mut labels = |after: &str, new: &str| -> Vec<String> {
        let at = TEXT.find(after).unwrap() + after.len();
        let text = format!("{}{new}{}", &TEXT[..at], &TEXT[at..]);
        client.change(PATH, 9, json!([{ "text": text }]));
        let list = client.at(
            "textDocument/completion",
            PATH,
            crate::client::place(&text, at + new.len()),
        );
        let list = list.as_array().unwrap().iter();
        list.map(|own| own["label"].as_str().unwrap().to_owned())
            .collect()
    };
    let members = labels("connect(", "guide.");
    assert!(
        members.contains(&"grip".to_owned()) && members.contains(&"a".to_owned()),
        "{members:?}"
    );
    let parameters = labels("Guide guide(F = 1 [N]", ", ");
    assert!(parameters.contains(&"b".to_owned()), "{parameters:?}");
    assert!(
        !parameters.contains(&"F".to_owned()),
        "it is set: {parameters:?}"
    );
    let nested = labels("s(start = 0), ".trim_end_matches(", "), "");
    assert!(!nested.is_empty());
    let units = labels("equation\n", "  push.F = 3 [");
    assert!(
        units.contains(&"N".to_owned()) && !units.contains(&"kg".to_owned()),
        "{units:?}"
    );
    let inside = labels("equation\n", "  ");
    assert!(inside.contains(&"connect".to_owned()) && inside.contains(&"body".to_owned()));
    let items = labels("shove of Slide(F0 = 4 [N])\n", "  ");
    assert!(items.contains(&"stimulus".to_owned()), "{items:?}");
    assert!(labels("\"that ", "x").is_empty(), "in a text");
    client.end();
}

#[test]
fn uses_are_found_by_scope_and_not_by_text() {
    let mut client = Client::with(PATH, TEXT);
    let found = client.at("textDocument/references", PATH, find(TEXT, "Force ", "F0"));
    assert_eq!(found.as_array().unwrap().len(), 3, "{found}");
    let model = client.at(
        "textDocument/documentHighlight",
        PATH,
        find(TEXT, "model ", "Slide"),
    );
    assert_eq!(
        model.as_array().unwrap().len(),
        3,
        "the name behind `end` too: {model}"
    );
    client.end();
}

#[test]
fn a_name_is_changed_where_it_is_meant_or_not_at_all() {
    let mut client = Client::with(PATH, TEXT);
    let mut rename = |(line, character): (usize, usize), new: &str| {
        client.ask(
            "textDocument/rename",
            json!({ "textDocument": { "uri": format!("file://{PATH}") },
                "position": { "line": line, "character": character }, "newName": new }),
        )
    };
    let edit = rename(find(TEXT, "push(F = ", "F0"), "F_push");
    let text = edited(TEXT, &edit["changes"][format!("file://{PATH}")]);
    assert_eq!(text, TEXT.replace("F0", "F_push"));
    let refused = |answer: Value| answer["error"]["message"].as_str().unwrap().to_owned();
    assert!(refused(rename(find(TEXT, "push(F = ", "F0"), "body")).contains("already"));
    assert!(refused(rename(find(TEXT, "push(F = ", "F0"), "2x")).contains("not a name"));
    assert!(refused(rename(find(TEXT, "push(F = ", "F0"), "model")).contains("keyword"));
    assert!(refused(rename(find(TEXT, "connect(push.", "a"), "b")).contains("library"));
    client.end();
}

#[test]
fn advice_becomes_a_quick_fix() {
    let mut client = Client::new(&[]);
    let text =
        "package x;\nimport SI.*;\nmodel A\n  Length s = 3 [m];\n  Mas m(M = 2 [kg]);\nend A;\n";
    client.open(PATH, text);
    let found = client.diagnostics(PATH, |list| !list.is_empty());
    let range = found[0]["range"].clone();
    let actions = client.ask(
        "textDocument/codeAction",
        json!({ "textDocument": { "uri": format!("file://{PATH}") }, "range": range,
            "context": { "diagnostics": found } }),
    );
    let edits = &actions[0]["edit"]["changes"][format!("file://{PATH}")];
    assert!(edited(text, edits).contains("  Mass m("), "{actions}");
    client.end();
}

#[test]
fn a_text_has_symbols_folds_tokens_and_a_layout() {
    let mut client = Client::with(PATH, TEXT);
    let symbols = client.of("textDocument/documentSymbol", PATH);
    assert_eq!(symbols[0]["name"], "Slide");
    assert_eq!(symbols[0]["children"].as_array().unwrap().len(), 4);
    let folds = client.of("textDocument/foldingRange", PATH);
    assert_eq!(folds[0], json!({ "startLine": 4, "endLine": 10 }));
    let tokens = client.of("textDocument/semanticTokens/full", PATH);
    assert!(tokens["data"].as_array().unwrap().len() > 100);
    assert_eq!(client.of("textDocument/formatting", PATH), json!([]));
    let rough = TEXT.replace("  Guide guide(F = 1 [N]);", "Guide guide( F=1[N] );");
    client.change(PATH, 2, json!([{ "text": rough }]));
    let edits = client.of("textDocument/formatting", PATH);
    assert_eq!(edited(&rough, &edits), TEXT);
    assert_eq!(
        edits[0]["range"]["start"]["line"], 8,
        "only the line that differs"
    );
    let position = json!({ "line": 5, "character": 18 });
    let chain = client.ask(
        "textDocument/selectionRange",
        json!({ "textDocument": { "uri": format!("file://{PATH}") }, "positions": [position] }),
    );
    assert_eq!(chain[0]["range"]["start"], position, "{chain}");
    assert!(!chain[0]["parent"]["parent"].is_null());
    let all = client.ask("workspace/symbol", json!({ "query": "slid" }));
    assert_eq!(all.as_array().unwrap().len(), 1);
    client.end();
}

#[test]
fn columns_are_counted_as_agreed() {
    for (known, column) in [(vec!["utf-8", "utf-16"], 26), (vec!["utf-16"], 25)] {
        let mut client = Client::new(&known);
        let text = "model A \"µ\" Real x; Real y; end A;\nexperiment e of B stop 1 [s]; end e;\n";
        client.open(PATH, text);
        let symbols = client.of("textDocument/documentSymbol", PATH);
        let y = &symbols[0]["children"][1]["selectionRange"]["start"];
        assert_eq!(y["character"], column, "{y}");
        client.end();
    }
}
