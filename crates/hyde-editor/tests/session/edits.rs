//! Random edits: the server answers as one that opens the result, and never fails.

use crate::client::{Client, place};
use crate::pieces::PIECES;
use serde_json::{Value, json};

const PATH: &str = "/nowhere/edited.hyde";

/// The next number of a sequence that looks random.
fn next(state: &mut u64) -> usize {
    *state = state
        .wrapping_mul(6_364_136_223_846_793_005)
        .wrapping_add(1_442_695_040_888_963_407);
    (*state >> 33) as usize
}

fn answers(client: &mut Client, text: &str, seed: u64) -> Vec<Value> {
    let mut state = seed;
    let mut list = vec![
        client.of("textDocument/documentSymbol", PATH),
        client.of("textDocument/foldingRange", PATH),
        client.of("textDocument/semanticTokens/full", PATH),
        client.of("textDocument/formatting", PATH),
        client.of("textDocument/inlayHint", PATH),
        client.of("textDocument/codeLens", PATH),
    ];
    for _ in 0..3 {
        let mut byte = next(&mut state) % (text.len() + 1);
        while !text.is_char_boundary(byte) {
            byte -= 1;
        }
        let at = place(text, byte);
        for method in [
            "textDocument/hover",
            "textDocument/definition",
            "textDocument/completion",
            "textDocument/documentHighlight",
            "textDocument/signatureHelp",
        ] {
            list.push(client.at(method, PATH, at));
        }
    }
    list
}

#[test]
fn after_any_edits_the_answers_are_those_of_a_new_server() {
    match crate::client::is_long() {
        true => edit(100_000, 50),
        false => edit(400, 20),
    }
}

/// So many random edits; now and then the answers are compared.
fn edit(count: i32, compared: i32) {
    let first = include_str!("../../../../examples/first/first.hyde");
    let mut state = 7;
    let mut client = Client::new(&["utf-16"]);
    let mut text = first.to_owned();
    client.open(PATH, &text);
    for version in 2..count + 2 {
        let mut cut = [0_usize; 2];
        for own in &mut cut {
            *own = next(&mut state) % (text.len() + 1);
            while !text.is_char_boundary(*own) {
                *own -= 1;
            }
        }
        let (start, end) = (cut[0], cut[1].clamp(cut[0], cut[0] + 12).min(text.len()));
        let end = (end..=text.len())
            .find(|at| text.is_char_boundary(*at))
            .unwrap();
        let new = PIECES[next(&mut state) % PIECES.len()];
        let range = [start, end].map(|byte| {
            let (line, character) = place(&text, byte);
            json!({ "line": line, "character": character })
        });
        let change = json!([{ "range": { "start": range[0], "end": range[1] }, "text": new }]);
        client.change(PATH, version, change);
        text.replace_range(start..end, new);
        if version % compared == 0 {
            let seed = state;
            let own = answers(&mut client, &text, seed);
            let mut fresh = Client::new(&["utf-16"]);
            fresh.open(PATH, &text);
            assert_eq!(own, answers(&mut fresh, &text, seed), "{text}");
            fresh.end();
            for answer in own {
                assert_ne!(answer["error"]["code"], -32603, "{answer}\n{text}");
            }
        }
        if version % 25 == 0 {
            text = first.to_owned();
            client.change(PATH, version, json!([{ "text": text }]));
        }
    }
    client.end();
}
