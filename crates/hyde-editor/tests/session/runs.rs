//! Values of a run in hovers, at an instant that is chosen, in every instance; and the equation at which a run failed.

use crate::client::{Client, find, uri};
use serde_json::{Value, json};

const TEXT: &str = r#"package twin "two lags";
import SI.*;
import Translational.*;
model Lag
  parameter Time T = 1 [s];
  Length x(start = 1, fixed = true);
equation
  T*der(x) = -x;
end Lag;

model Twin
  Lag one, two(T = 2 [s], x(start = -2));
  Mass body(M = 1 [kg]);
end Twin;

experiment fade of Twin
  measure Length last = max(one.x);
  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];
end fade;

experiment break of Twin
  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];
end break;
"#;

/// A file on the disk, open in a session: a run reads the disk.
fn session() -> (tempfile::TempDir, String, Client) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("twin.hyde").to_str().unwrap().to_owned();
    std::fs::write(&path, TEXT).unwrap();
    let client = Client::with(&path, TEXT);
    (folder, path, client)
}

fn run(client: &mut Client, path: &str, experiment: &str) {
    let command = json!({ "command": "hyde.run", "arguments": [uri(path), experiment] });
    let answer = client.ask("workspace/executeCommand", command);
    assert!(answer.get("error").is_none(), "{answer}");
    // The page is shown when the values are there.
    assert_eq!(client.request().method, "window/showDocument");
}

#[test]
fn a_hover_shows_the_values_of_the_last_run_in_every_instance() {
    let (_folder, path, mut client) = session();
    let before = client.hover((&path, TEXT), "Length ", "x");
    assert!(!before.contains("run"), "{before}");
    run(&mut client, &path, "fade");
    let both = client.hover((&path, TEXT), "Length ", "x");
    let values = both.split_once("run ").unwrap().1;
    assert_eq!(
        values,
        "`fade` at 1 s, its end:  \n\
         `one.x` = 0.5 m, from 0.5 m to 1 m  \n`███▇▇▇▇▆▆▅▅▅▄▄▄▃▃▃▂▂▂▁▁▁`  \n\
         `two.x` = -1.5 m, from -2 m to -1.5 m  \n`▁▁▁▂▂▂▃▃▃▄▄▄▅▅▅▆▆▆▇▇▇███`"
    );
    // A path means one of them.
    let one = client.hover((&path, TEXT), "max(one.", "x");
    assert!(one.contains("`one.x`") && !one.contains("two.x"), "{one}");
    // Another name of the file has none.
    let parameter = client.hover((&path, TEXT), "parameter Time ", "T");
    assert!(!parameter.contains("run"), "{parameter}");
    client.end();
}

#[test]
fn a_hover_in_the_library_shows_the_values_of_the_last_run() {
    let (_folder, path, mut client) = session();
    run(&mut client, &path, "fade");
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../hyde-library/models/Translational.hyde"
    );
    let text = std::fs::read_to_string(file).unwrap();
    let open = "/cache/library/Translational.hyde";
    client.open(open, &text);
    let value = client.hover((open, &text), "model Mass", "s(");
    assert!(value.contains("`body.s` = 3 m, constant"), "{value}");
    client.end();
}

#[test]
fn an_instant_is_chosen_by_a_lens_and_a_change_of_the_text_is_said() {
    let (_folder, path, mut client) = session();
    run(&mut client, &path, "fade");
    let lenses = client.of("textDocument/codeLens", &path);
    let titled = |title: &str| -> Value {
        let list = lenses.as_array().unwrap();
        let found = list.iter().find(|own| own["command"]["title"] == title);
        found.unwrap_or_else(|| panic!("{title}: {lenses}"))["command"].clone()
    };
    assert_eq!(titled("Values at 1 s")["arguments"][2], Value::Null);
    let earlier = titled("Earlier");
    client.ask("workspace/executeCommand", earlier);
    let then = client.hover((&path, TEXT), "max(one.", "x");
    assert!(
        then.contains("run `fade` at 0.95 s:  \n`one.x` = 0.525 m"),
        "{then}"
    );
    // Any other instant, too.
    let command = json!({ "command": "hyde.at", "arguments": [uri(&path), "fade", 0.2] });
    client.ask("workspace/executeCommand", command);
    let then = client.hover((&path, TEXT), "max(one.", "x");
    assert!(then.contains("`one.x` = 0.9 m"), "{then}");
    let command = json!({ "command": "hyde.at", "arguments": [uri(&path), "break", 0.2] });
    let answer = client.ask("workspace/executeCommand", command);
    assert!(
        answer["error"]["message"]
            .to_string()
            .contains("was not run"),
        "{answer}"
    );
    let changed = TEXT.replace("two lags", "a pair of lags");
    client.change(&path, 2, json!([{ "text": changed }]));
    let then = client.hover((&path, &changed), "max(one.", "x");
    assert!(
        then.contains("run `fade` of the text before its last change at 0.2 s:"),
        "{then}"
    );
    client.end();
}

#[test]
fn a_failed_run_marks_its_equation_until_the_text_changes() {
    let (_folder, path, mut client) = session();
    assert!(client.diagnostics(&path, |_| true).is_empty());
    run(&mut client, &path, "break");
    let found = client.diagnostics(&path, |list| !list.is_empty());
    let (line, column) = find(TEXT, "equation", "T*der");
    assert_eq!(found[0]["code"], "E0701");
    assert_eq!(
        found[0]["range"]["start"],
        json!({ "line": line, "character": column })
    );
    let message = found[0]["message"].as_str().unwrap();
    assert!(
        message.contains("in `one`") && message.contains("`one.x` is 0.75 m there"),
        "{message}"
    );
    let value = client.hover((&path, TEXT), "Length ", "x");
    assert!(
        value.contains("run `break` at 0.5 s, where it failed:"),
        "{value}"
    );
    assert!(value.contains("`one.x` = 0.75 m"), "{value}");
    let changed = TEXT.replace("two lags", "a pair of lags");
    client.change(&path, 2, json!([{ "text": changed }]));
    assert!(client.diagnostics(&path, |_| true).is_empty());
    client.end();
}
