//! Values, spreads, dimensions, hints, brackets that are open, and commands: what needs more than the text.

use crate::client::{Client, place};
use serde_json::{Value, json};

const PATH: &str = "/nowhere/numbers.hyde";
const TEXT: &str = r#"package numbers;
import SI.*;
import Translational.*;

model Slide "a mass on a guide"
  input Force F;
  parameter Mass M0 = 2 [kg] ~ ±10% from "data sheet";
  parameter Real k = 3*M0*(2 [1/s2]);
  Real strain;
  Drive push(F = F);
  Translational.Mass body(M = 2*M0, s(start = 0)), other(M = 1 [kg]);
  Guide guide(F = 1 [N]);
equation
  strain = k*body.s;
  connect(push.a, body.a, guide.a, other.a);
end Slide;

model Worn = Slide with Effects.Stribeck(dF = 1 [N]) on guide;

experiment shove of Slide(M0 = 4 [kg])
  stimulus F = min(10 [N], 3 [N]*(time/(1 [s])));
  measure Length way = max(body.s);
  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];
end shove;
"#;

#[test]
fn a_hover_shows_values_with_their_spread_and_source() {
    let mut client = Client::with(PATH, TEXT);
    let declared = client.hover((PATH, TEXT), "parameter Mass ", "M0");
    assert!(
        declared.contains("`M0` = 2 kg ±10%, from data sheet"),
        "{declared}"
    );
    let used = client.hover((PATH, TEXT), "M = 2*", "M0");
    assert!(used.contains("`M0` = 2 kg ±10%, from data sheet"), "{used}");
    let modified = client.hover((PATH, TEXT), "body(", "M");
    assert!(modified.contains("`body.M` = 4 kg"), "{modified}");
    let set = client.hover((PATH, TEXT), "shove of Slide(", "M0");
    assert!(set.contains("`M0` = 4 kg"), "the experiment's: {set}");
    client.end();
}

#[test]
fn a_hover_shows_the_dimension_of_what_stands_there() {
    let mut client = Client::with(PATH, TEXT);
    let found = client.hover((PATH, TEXT), "strain = ", "k");
    assert!(found.contains("`k` = 12 N/m"), "{found}");
    let sum = client.hover((PATH, TEXT), "strain = k", "*");
    assert!(sum.contains("`k*body.s`  \nunit `N` (kg.m/s2)"), "{sum}");
    let real = client.hover((PATH, TEXT), "Real ", "strain");
    assert!(
        real.contains("unit found from the equations: `N`"),
        "{real}"
    );
    let call = client.hover((PATH, TEXT), "stimulus F = ", "min");
    assert!(call.contains("min(a, b)"), "{call}");
    assert!(call.contains("unit `N`"), "{call}");
    let literal = client.hover((PATH, TEXT), "Guide guide(F = ", "1");
    assert!(literal.contains("`1 [N]`  \nunit `N`"), "{literal}");
    client.end();
}

#[test]
fn hints_show_units_that_are_found_and_values_of_constants() {
    let mut client = Client::with(PATH, TEXT);
    let hints = client.of("textDocument/inlayHint", PATH);
    let mut shown: Vec<(u64, String)> = hints
        .as_array()
        .unwrap()
        .iter()
        .map(|own| {
            let label = own["label"].as_str().unwrap().to_owned();
            (own["position"]["line"].as_u64().unwrap(), label)
        })
        .collect();
    shown.sort();
    let has = |line: u64, label: &str| {
        assert!(
            shown.contains(&(line, label.to_owned())),
            "{line} {label}: {shown:?}"
        );
    };
    has(7, "[N/m]");
    has(7, "= 12 N/m");
    has(8, "[N]");
    has(10, "= 4 kg");
    assert!(!shown.iter().any(|(line, _)| *line == 11), "{shown:?}");
    client.end();
}

/// Labels of completions, or the signature, with `new` written behind `after`.
fn written(client: &mut Client, method: &str, after: &str, new: &str) -> Value {
    let at = TEXT.find(after).unwrap() + after.len();
    let text = format!("{}{new}{}", &TEXT[..at], &TEXT[at..]);
    client.change(PATH, 9, json!([{ "text": text }]));
    client.at(method, PATH, place(&text, at + new.len()))
}

fn labels(client: &mut Client, after: &str, new: &str) -> Vec<String> {
    let list = written(client, "textDocument/completion", after, new);
    let list = list.as_array().unwrap().iter();
    list.map(|own| own["label"].as_str().unwrap().to_owned())
        .collect()
}

#[test]
fn completion_offers_what_fits() {
    let mut client = Client::with(PATH, TEXT);
    let all = labels(&mut client, "equation\n", "  connect(");
    for own in ["push.a", "body.a", "guide.a"] {
        assert!(all.contains(&own.to_owned()), "{own}: {all:?}");
    }
    // The input is a quantity, though there is a component `Force`.
    assert!(!all.iter().any(|own| own.starts_with("F.")), "{all:?}");
    let classes = labels(&mut client, "end Slide;\n", "model More\n  extends ");
    assert!(classes.contains(&"Guide".to_owned()) && !classes.contains(&"sqrt".to_owned()));
    let others = labels(&mut client, "equation\n", "  connect(body.a, ");
    assert!(
        others.contains(&"guide.a".to_owned()) && !others.contains(&"body.a".to_owned()),
        "{others:?}"
    );
    let behind = labels(&mut client, "equation\n", "  connect(body.a, guide.");
    assert_eq!(behind[0], "a", "the connector that fits is first");
    for (after, new) in [
        ("Guide guide(F = 1 [N]", ", b = 3 ["),
        (
            "equation\n",
            "  push.F = 1 [N]; Guide more(F = 2 [N], b = 3 [",
        ),
    ] {
        let units = labels(&mut client, after, new);
        assert!(
            units.contains(&"N.s/m".to_owned()) && !units.contains(&"kg".to_owned()),
            "{units:?}"
        );
    }
    let units = labels(
        &mut client,
        "input Force F;\n",
        "  parameter Length x = 3 [",
    );
    assert!(units.contains(&"mm".to_owned()) && !units.contains(&"N".to_owned()));
    let effects = labels(&mut client, "end Slide;\n", "model More = Slide with ");
    assert!(
        effects.contains(&"Effects.Stribeck".to_owned()),
        "{effects:?}"
    );
    assert!(
        !effects.iter().any(|own| own.contains("Cogging")),
        "no motor"
    );
    let sites = labels(
        &mut client,
        "end Slide;\n",
        "model More = Slide with Effects.Stribeck(dF = 1 [N]) on ",
    );
    assert_eq!(sites, ["guide"]);
    let functions = labels(&mut client, "equation\n", "  strain = cl");
    assert!(functions.contains(&"clamp".to_owned()));
    client.end();
}

#[test]
fn completion_knows_the_columns_of_a_record() {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let path = path.join("../../examples/bench_axis/axis.hyde");
    let path = path.canonicalize().unwrap();
    let text = std::fs::read_to_string(&path).unwrap();
    let own = path.to_str().unwrap();
    let mut client = Client::new(&["utf-16"]);
    let at = text.find("stimulus").unwrap();
    let text = format!("{}measured file. {}", &text[..at], &text[at..]);
    client.open(own, &text);
    let found = client.at(
        "textDocument/completion",
        own,
        place(&text, at + "measured file.".len()),
    );
    let labels: Vec<&str> = found
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|own| own["label"].as_str())
        .collect();
    assert!(
        labels.contains(&"i") && labels.contains(&"phi_m"),
        "{labels:?}"
    );
    client.end();
}

#[test]
fn an_open_bracket_says_what_goes_into_it() {
    let mut client = Client::with(PATH, TEXT);
    let method = "textDocument/signatureHelp";
    let part = written(&mut client, method, "Guide guide(F = 1 [N]", ", b = ");
    let label = part["signatures"][0]["label"].as_str().unwrap();
    assert!(label.starts_with("Guide(") && label.contains("b"), "{part}");
    let active = part["activeParameter"].as_u64().unwrap() as usize;
    let range = &part["signatures"][0]["parameters"][active]["label"];
    let (from, to) = (range[0].as_u64().unwrap(), range[1].as_u64().unwrap());
    assert_eq!(&label[from as usize..to as usize], "b");
    let function = written(&mut client, method, "equation\n", "  strain = clamp(1, ");
    assert_eq!(function["signatures"][0]["label"], "clamp(x, low, high)");
    assert_eq!(function["activeParameter"], 1);
    let none = written(&mut client, method, "equation\n", "  strain = (");
    assert!(none.is_null(), "{none}");
    client.end();
}

#[test]
fn a_lens_runs_a_command_and_its_page_is_shown() {
    let folder = std::env::temp_dir().join(format!("hyde-lens-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let file = folder.join("numbers.hyde");
    std::fs::write(&file, TEXT).unwrap();
    let own = file.to_str().unwrap();
    let mut client = Client::new(&["utf-16"]);
    client.open(own, TEXT);
    let lenses = client.of("textDocument/codeLens", own);
    let titles: Vec<&str> = lenses
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|own| own["command"]["title"].as_str())
        .collect();
    assert_eq!(titles, ["Run", "Modes"]);
    let command = &lenses[0]["command"];
    let params = json!({ "command": command["command"], "arguments": command["arguments"] });
    let done = client.ask("workspace/executeCommand", params.clone());
    assert!(done.is_null(), "{done}");
    let shown = client.request();
    assert_eq!(shown.method, "window/showDocument");
    assert_eq!(shown.params["uri"], "file:///pages/Run-shove.html");
    // The command reads the disk.
    client.change(own, 2, json!([{ "text": format!("{TEXT}// more\n") }]));
    let refused = client.ask("workspace/executeCommand", params);
    let reason = refused["error"]["message"].as_str().unwrap();
    assert!(reason.contains("save the file first"), "{refused}");
    client.end();
    std::fs::remove_dir_all(&folder).unwrap();
}
