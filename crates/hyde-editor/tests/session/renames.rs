//! Renames on the Y axis and on the library's guide: each part and parameter gets another name, and the model flattens to the
//! same program.

use crate::client::{Client, edited, uri};
use hyde_compiler::{Backend, Form, FreeInputs, Request, Stage};
use hyde_diag::Diagnostics;
use hyde_study::world::{Buffers, Disk};
use hyde_study::{Asked, Loaded};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A model of a file whose members are renamed, the model that is flattened with its experiment, and what is added to the file.
struct Case {
    file: &'static str,
    members_of: &'static str,
    model: &'static str,
    experiment: Option<&'static str>,
    added: &'static str,
}

const Y_AXIS: Case = Case {
    file: "examples/y_axis/axis.hyde",
    members_of: "Axis",
    model: "Axis",
    experiment: Some("swept"),
    added: "",
};
const GUIDE: Case = Case {
    file: "crates/hyde-library/models/Translational.hyde",
    members_of: "Guide",
    model: "Sliding",
    experiment: None,
    added: "\nmodel Sliding\n  Mass body(M = 1 [kg]);\n  Guide guide(F = 1 [N], b = 2 [N.s/m]);\n\
            equation\n  connect(body.a, guide.a);\nend Sliding;\n",
};

#[test]
fn parts_of_the_y_axis_and_of_a_guide_can_be_renamed() {
    let (of_axis, of_guide) = match crate::client::is_long() {
        true => (1, 1),
        false => (6, 3),
    };
    assert!(renamed(Y_AXIS, of_axis) > 2);
    assert!(renamed(GUIDE, of_guide) > 2);
}

/// Renames every so many-th member of a model; how many they were.
fn renamed(case: Case, step: usize) -> usize {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut path = top.join(case.file).canonicalize().unwrap();
    let text = std::fs::read_to_string(&path).unwrap() + case.added;
    if !case.added.is_empty() {
        // Beside the other packages of the library it would have each of them twice.
        path = Path::new("/nowhere").join(path.file_name().unwrap());
    }
    let own = path.to_str().unwrap();
    let flat = |text: &str| flattened(&path, text, case.model, case.experiment);
    let before = flat(&text);
    let mut client = Client::new(&["utf-16"]);
    client.open(own, &text);
    let symbols = client.of("textDocument/documentSymbol", own);
    let mut all = symbols.as_array().unwrap().iter();
    let symbol = all.find(|own| own["name"] == case.members_of).unwrap();
    let members = symbol["children"].as_array().unwrap();
    let mut count = 0;
    for member in members.iter().step_by(step) {
        let name = member["name"].as_str().unwrap();
        let new = another(name, &[&text, &before.join("\n")]);
        let answer = client.ask(
            "textDocument/rename",
            json!({ "textDocument": { "uri": uri(own) },
                "position": member["selectionRange"]["start"], "newName": new }),
        );
        let edits = &answer["changes"][uri(own)];
        assert!(matches!(edits, Value::Array(_)), "{name}: {answer}");
        let changed = edited(&text, edits);
        assert!(changed.contains(&new));
        // And back again: the same text, and the same program.
        assert_eq!(changed.replace(&new, name), text, "{name}");
        let mut after: Vec<String> = flat(&changed);
        after
            .iter_mut()
            .for_each(|line| *line = line.replace(&new, name));
        after.sort();
        assert_eq!(after, before, "{name}");
        count += 1;
    }
    client.end();
    count
}

/// A name of the same length that stands in none of the texts.
fn another(name: &str, texts: &[&str]) -> String {
    let letters = ('a'..='z').chain('A'..='Z');
    let mut names = letters.map(|letter| letter.to_string().repeat(name.len().max(3)));
    names
        .find(|new| texts.iter().all(|text| !text.contains(new.as_str())))
        .unwrap()
}

/// The lines of the flat model, sorted: the order of declarations is that of names in some places.
fn flattened(path: &PathBuf, text: &str, model: &str, experiment: Option<&str>) -> Vec<String> {
    let mut world = Buffers::over(Arc::new(Disk));
    world.put(path, text);
    let asked = Asked {
        world: Arc::new(world),
        ..Asked::of_file(path)
    };
    let loaded = Loaded::of(&asked).unwrap();
    let request = Request {
        sources: &loaded.sources,
        file: &loaded.file,
        model,
        experiment,
        settings: &BTreeMap::new(),
        records: &BTreeMap::new(),
        free_inputs: FreeInputs::All,
        ledger: true,
        form: Form::Run,
        backend: Backend::Interpreter,
    };
    let mut diagnostics = Diagnostics::new();
    let flat = hyde_compiler::emit(&request, Stage::Flat, &mut diagnostics);
    let wrong: Vec<&str> = diagnostics.iter().map(|own| own.message.as_str()).collect();
    let flat = flat.unwrap_or_else(|| panic!("{wrong:?}"));
    let mut lines: Vec<String> = flat.lines().map(str::to_owned).collect();
    lines.sort();
    lines
}
