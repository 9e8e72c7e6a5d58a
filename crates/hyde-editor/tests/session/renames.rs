//! Renames on the Y axis: each part and parameter gets another name, and the model compiles to as many unknowns.

use crate::client::{Client, edited, uri};
use hyde_study::world::{Buffers, Disk};
use hyde_study::{Aim, Asked, Records};
use serde_json::{Value, json};
use std::path::Path;
use std::sync::Arc;

#[test]
fn every_part_of_the_y_axis_can_be_renamed() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/y_axis/axis.hyde");
    let path = path.canonicalize().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let own = path.to_str().unwrap();
    let unknowns = compiled(&path, &text);
    let mut client = Client::new(&["utf-16"]);
    client.open(own, &text);
    let symbols = client.of("textDocument/documentSymbol", own);
    let parts = symbols[0]["children"].as_array().unwrap().clone();
    assert!(parts.len() > 15, "{}", parts.len());
    for part in &parts {
        let name = part["name"].as_str().unwrap();
        let new = format!("{name}_renamed");
        let answer = client.ask(
            "textDocument/rename",
            json!({ "textDocument": { "uri": uri(own) }, "position": part["selectionRange"]["start"],
                "newName": new }),
        );
        let edits = &answer["changes"][uri(own)];
        assert!(matches!(edits, Value::Array(_)), "{name}: {answer}");
        let changed = edited(&text, edits);
        assert!(changed.matches(&new).count() > 0);
        assert_eq!(compiled(&path, &changed), unknowns, "{name}");
        // And back again: the same text.
        assert_eq!(changed.replace(&new, name), text, "{name}");
    }
    client.end();
}

/// The number of unknowns of the first experiment.
fn compiled(path: &Path, text: &str) -> usize {
    let mut world = Buffers::over(Arc::new(Disk));
    world.put(path, text);
    let asked = Asked {
        experiment: Some("swept".to_owned()),
        world: Arc::new(world),
        ..Asked::of_file(path)
    };
    let mut project = hyde_study::load(&asked, Records::Needed).unwrap();
    let wrong: Vec<&str> = project
        .diagnostics
        .iter()
        .map(|own| own.message.as_str())
        .collect();
    assert!(wrong.is_empty(), "{wrong:?}");
    match project.compile(Aim::Run) {
        Ok(compiled) => compiled.program.n_unknowns,
        Err(_) => panic!("{:?}", project.diagnostics),
    }
}
