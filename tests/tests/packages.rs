//! Packages in folders: what is found, what is refused, `hyde check`, `hyde test` and `hyde doc` of a folder, tables from
//! files. The library is that of the book's chapter "Your own library", from nothing to passing tests.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

#[test]
fn the_library_of_the_book_is_checked_and_its_tests_pass() {
    let folder = book_library();
    let output = hyde(folder.path(), &["check", "."]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", errors(&output));
    for file in ["lib/parts.hyde", "press.hyde"] {
        assert!(said.contains(file), "{said}");
    }
    let tests = json(&hyde(folder.path(), &["test", ".", "--json"]));
    assert_eq!(tests["ok"], true, "{tests:#}");
    let verdicts = tests["tests"].as_array().unwrap();
    // The two experiments, and the size of the one effect.
    assert_eq!(verdicts.len(), 3, "{tests:#}");
    assert!(verdicts.iter().all(|test| test["verdict"] == "passed"));
    assert_eq!(verdicts[2]["test"], "dirty: wiper.Chips.dF");
}

#[test]
fn an_expectation_that_does_not_hold_ends_with_status_4() {
    let folder = book_library();
    let press = folder.path().join("press.hyde");
    let text = std::fs::read_to_string(&press).unwrap();
    let stricter = text.replace("> 50 [mm]", "> 500 [mm]");
    assert_ne!(text, stricter);
    std::fs::write(&press, stricter).unwrap();
    let output = hyde(folder.path(), &["test", "."]);
    assert_eq!(output.status.code(), Some(4));
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(
        said.contains("FAILED  clean") && said.contains("does not hold: the stroke is done"),
        "{said}"
    );
}

#[test]
fn an_effect_that_does_not_vanish_with_its_size_fails() {
    let folder = book_library();
    let parts = folder.path().join("lib/parts.hyde");
    let text = std::fs::read_to_string(&parts).unwrap();
    // The root of a size leaves a thirtieth of the effect at a thousandth of the size.
    let rooted = text.replace("Force more = dF*exp", "Force more = sqrt(dF*1 [N])*exp");
    assert_ne!(text, rooted);
    std::fs::write(&parts, rooted).unwrap();
    let output = hyde(folder.path(), &["test", ".", "--json"]);
    let tests = json(&output)["tests"].clone();
    let size = tests
        .as_array()
        .unwrap()
        .iter()
        .find(|test| test["test"] == "dirty: wiper.Chips.dF")
        .unwrap();
    assert_eq!(size["verdict"], "failed", "{tests:#}");
    assert_eq!(output.status.code(), Some(4));
}

#[test]
fn a_file_in_a_folder_of_the_package_finds_the_manifest_above() {
    let folder = book_library();
    std::fs::create_dir(folder.path().join("trials")).unwrap();
    let trial = "package trials.one;\nimport lib.parts.*;\n\nmodel One\n  Wiper wiper(Fs = 70 [N]);\nend One;\n";
    std::fs::write(folder.path().join("trials/one.hyde"), trial).unwrap();
    let output = hyde(&folder.path().join("trials"), &["check", "one.hyde"]);
    assert!(output.status.success(), "{}", errors(&output));
    // Named by its place: the same text elsewhere in the package is refused.
    std::fs::write(folder.path().join("trials/two.hyde"), trial).unwrap();
    let output = hyde(folder.path(), &["check", "trials/two.hyde", "--json"]);
    assert_eq!(json(&output)["diagnostics"][0]["code"], "E0214");
}

#[test]
fn packages_may_import_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write("hyde.toml", "name = \"round\"\nversion = \"0.1.0\"\n");
    write(
        "a.hyde",
        "package a;\nimport b.*;\n\ntype Up = Real [m];\n\nmodel A\n  Down x = 1 [m];\nend A;\n",
    );
    write("b.hyde", "package b;\nimport a.*;\n\ntype Down = Up;\n");
    let output = hyde(folder.path(), &["check", "."]);
    assert!(output.status.success(), "{}", errors(&output));
}

#[test]
#[cfg(unix)]
fn a_record_that_is_a_link_out_of_its_folder_is_refused() {
    let (folder, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let far = outside.path().join("log.csv");
    std::fs::write(&far, "t [s],u [m/s]\n0,0\n1,1\n").unwrap();
    let model = |path: &str| {
        format!(
            "package m;\nimport SI.*;\n\nmodel M\n  input Velocity u;\n  Length x(start = 0, fixed = true);\nequation\n  der(x) = u;\nend M;\n\n\
             experiment e(record log = \"{path}\") of M\n  stimulus u = log.u;\n  solve ida stop log.end;\nend e;\n"
        )
    };
    let link = |target: &Path, name: &str| {
        std::os::unix::fs::symlink(target, folder.path().join(name)).unwrap();
    };
    link(&far, "log.csv");
    link(outside.path(), "logs");
    for path in ["log.csv", "logs/log.csv"] {
        std::fs::write(folder.path().join("m.hyde"), model(path)).unwrap();
        let output = hyde(folder.path(), &["run", "m.hyde", "--json"]);
        assert_eq!(json(&output)["diagnostics"][0]["code"], "E0802", "{path}");
    }
    // As the help says: given on the command line it is read.
    let given = format!("log={}", far.display());
    let output = hyde(folder.path(), &["run", "m.hyde", "--record", &given]);
    assert!(output.status.success(), "{}", errors(&output));
}

/// The patterns of studies, and the alternatives of a sweep, are held to the same border.
#[test]
#[cfg(unix)]
fn a_record_of_a_study_that_is_a_link_out_of_its_folder_is_refused() {
    let (folder, outside) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let far = outside.path().join("fit-1.csv");
    std::fs::write(&far, "t [s],u [m/s],x [m]\n0,0,0\n1,1,0.5\n").unwrap();
    std::os::unix::fs::symlink(&far, folder.path().join("fit-1.csv")).unwrap();
    let model = "package m;\nimport SI.*;\n\nmodel M\n  input Velocity u;\n  parameter Real k = 1 ~ ±10%;\n  \
                 Length x(start = 0, fixed = true);\nequation\n  der(x) = k*u;\nend M;\n\n\
                 experiment e(record log) of M\n  stimulus u = log.u;\n  measured log.x = x ~ 1 [mm];\n  solve ida stop log.end;\nend e;\n\n\
                 calibrate c of M\n  fit e(\"fit-*.csv\");\n  vary uncertain;\nend c;\n\n\
                 sweep s of e\n  vary record log = {\"fit-1.csv\"};\nend s;\n";
    std::fs::write(folder.path().join("m.hyde"), model).unwrap();
    for line in [["fit", "m.hyde", "--json"], ["sweep", "m.hyde", "--json"]] {
        let output = hyde(folder.path(), &line);
        assert_eq!(json(&output)["diagnostics"][0]["code"], "E0802", "{line:?}");
    }
    // As the help says: the folder in which it is.
    let data = outside.path().display().to_string();
    let output = hyde(folder.path(), &["fit", "m.hyde", "--data", &data, "--json"]);
    assert_ne!(json(&output)["diagnostics"][0]["code"], "E0802");
}

#[test]
#[cfg(unix)]
fn links_that_lead_out_of_the_folder_are_refused() {
    let (folder, outside) = (book_library(), tempfile::tempdir().unwrap());
    let link = |target: &Path, name: &str| {
        std::os::unix::fs::symlink(target, folder.path().join(name)).unwrap();
    };
    let (secret, table) = (
        outside.path().join("far.hyde"),
        outside.path().join("t.csv"),
    );
    std::fs::write(&secret, "package far;\n\ntype Far = Real [m];\n").unwrap();
    std::fs::write(&table, "x,y\n0,0\n1,1\n").unwrap();
    link(&secret, "far.hyde");
    link(&table, "t.csv");
    let user = "package user;\nimport far.*;\n\nmodel User\n  Far x = 1 [m];\nend User;\n";
    std::fs::write(folder.path().join("user.hyde"), user).unwrap();
    let output = hyde(folder.path(), &["check", "user.hyde", "--json"]);
    assert_eq!(json(&output)["diagnostics"][0]["code"], "E0216");
    // The manifest refuses it as data, and without a manifest the model's folder is the border.
    let model = "model User\n  Real y = table(time/1, \"t.csv\");\nend User;\n";
    let model = model.replace("time/1", "0.5");
    std::fs::write(
        folder.path().join("user.hyde"),
        format!("package user;\n{model}"),
    )
    .unwrap();
    std::fs::remove_file(folder.path().join("hyde.toml")).unwrap();
    let output = hyde(folder.path(), &["check", "user.hyde", "--json"]);
    assert_eq!(json(&output)["diagnostics"][0]["code"], "E0216");
    std::fs::remove_file(folder.path().join("t.csv")).unwrap();
    std::fs::copy(&table, folder.path().join("t.csv")).unwrap();
    let output = hyde(folder.path(), &["check", "user.hyde"]);
    assert!(output.status.success(), "{}", errors(&output));
}

#[test]
fn a_table_from_a_file_is_the_table_written_out() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    write(
        "hyde.toml",
        "name = \"seals\"\nversion = \"0.1.0\"\ndata = [\"grease.csv\"]\n",
    );
    write(
        "grease.csv",
        "v [mm/s],T [degC],F [N]\n0,20,60\n10,21,45\n100,25,40\n",
    );
    write(
        "seal.hyde",
        "package seal;
import SI.*;

model Seal
  Velocity v = 0.3 [m/s2]*time;
  Force lines[2] = {table(v, \"grease.csv\", \"v\", \"F\"), table(v, {0, 10, 100} [mm/s], {60, 45, 40} [N])};
  Force curves[2] = {smooth_table(v, \"grease.csv\", \"v\", \"F\"), smooth_table(v, {0, 10, 100} [mm/s], {60, 45, 40} [N])};
  Temperature first_two = table(v, \"grease.csv\");
  Real slope = der(lines[1])/1 [N/s];
  Real slope_out = der(lines[2])/1 [N/s];
end Seal;

experiment over of Seal
  expect max(abs(lines[1] - lines[2])) <= 0 [N] \"the same line\";
  expect max(abs(curves[1] - curves[2])) <= 0 [N] \"the same curve\";
  expect max(abs(slope - slope_out)) <= 0 \"the same derivative\";
  // 300 mm/s: on along the last line, 40 N - 200 mm/s * 5 N / 90 mm/s; rounding of a few operations.
  expect abs(last(lines[1]) - (40 - 200*5/90)*1 [N]) < 1e-9 [N] \"on along the last line\";
  expect abs(first(first_two) - 20 [degC]) < 1e-9 [K] \"the first two columns\";
  solve ida(rtol = 1e-6) stop 1 [s];
end over;
",
    );
    let output = hyde(folder.path(), &["run", "seal.hyde", "--out", "out"]);
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{said}{}", errors(&output));
    assert_eq!(said.matches(": holds").count(), 5, "{said}");
    let summary = std::fs::read(folder.path().join("out/summary.json")).unwrap();
    let summary: Value = serde_json::from_slice(&summary).unwrap();
    let table = &summary["tables"][0];
    assert_eq!(
        (&table["path"], &table["rows"]),
        (&Value::from("grease.csv"), &Value::from(3))
    );
    assert_eq!(table["sha256"].as_str().unwrap().len(), 64);
}

#[test]
fn pages_link_to_each_other_and_need_nothing_else() {
    let folder = book_library();
    let output = hyde(folder.path(), &["doc", ".", "--out", "doc"]);
    assert!(output.status.success(), "{}", errors(&output));
    let page = |name: &str| std::fs::read_to_string(folder.path().join("doc").join(name)).unwrap();
    let (index, parts) = (page("index.html"), page("lib.parts.html"));
    assert!(index.contains("href=\"lib.parts.html#Wiper\""), "{index}");
    for shown in [
        "the lip of a seal",
        "<h4>Connectors</h4>\n<p><b>a</b> Rail</p>",
        "<td>Force</td><td>N</td><td><code>40 [N]</code></td>",
        "±20%",
        "spring balance, 2026-03",
        "40 [N]",
        "exit a.f &gt; hold",
        "500 [N]",
        "effects for it: <a href=\"lib.parts.html#Chips\">Chips</a>",
    ] {
        assert!(parts.contains(shown), "`{shown}` is missing:\n{parts}");
    }
    assert!(!parts.contains("<script") && !parts.contains("http"));
}

#[test]
fn a_page_tells_of_what_a_law_of_a_site_may_be_a_function_and_where_the_constants_of_a_shape_lie() {
    let folder = tempfile::tempdir().unwrap();
    let wires = "package wires \"sensors with a wire\";
import SI.*;
model Wire
  input Length pulled;
  parameter Length turn(min = 1 [mm]) = 50 [mm];
  Angle drum = pulled*(1 [rev])/turn;
  output Length s = drum*turn/(1 [rev]) over (place = drum, speed = der(drum));
end Wire;
function bump
  input Length x, x_min, x_max;
  input Length x0 = {x_min} in x_min .. x_max;
  output Real f(cost = 1) = exp(-((x - x0)/(1 [mm]))^2) over (place);
end bump;
";
    std::fs::write(folder.path().join("wires.hyde"), wires).unwrap();
    let output = hyde(folder.path(), &["doc", "wires.hyde"]);
    assert!(output.status.success(), "{}", errors(&output));
    let page = std::fs::read_to_string(folder.path().join("doc/wires.html")).unwrap();
    for shown in [
        "<th>a law is over</th>",
        "<td><code>place = drum</code>, <code>speed = der(drum)</code></td>",
        "<td><code>x_min</code> … <code>x_max</code></td>",
        "<td><code>cost = 1</code></td><td><code>place</code></td>",
        "<td><code>min = 1 [mm]</code></td>",
    ] {
        assert!(page.contains(shown), "`{shown}` is missing:\n{page}");
    }
}

#[test]
fn every_link_of_the_library_s_pages_leads_somewhere() {
    let folder = tempfile::tempdir().unwrap();
    let output = hyde(folder.path(), &["doc", "--library"]);
    assert!(output.status.success(), "{}", errors(&output));
    let (mut found, mut pages) = (0, 0);
    for entry in std::fs::read_dir(folder.path().join("doc")).unwrap() {
        let path = entry.unwrap().path();
        let text = std::fs::read_to_string(&path).unwrap();
        pages += 1;
        for link in text.split("href=\"").skip(1) {
            let link = link.split('"').next().unwrap();
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let other = if file.is_empty() {
                text.clone()
            } else {
                std::fs::read_to_string(path.with_file_name(file)).unwrap()
            };
            assert!(
                place.is_empty() || other.contains(&format!("id=\"{place}\"")),
                "{}: {link}",
                path.display()
            );
            found += 1;
        }
    }
    assert!(pages > 8 && found > 1000, "{pages} pages, {found} links");
}

/// The library that the book's chapter writes, in a folder of its own.
fn book_library() -> tempfile::TempDir {
    let chapter = hyde_tests::root().join("book/src/your-library.md");
    let chapter = std::fs::read_to_string(chapter).unwrap();
    let block = |fence: &str, start: &str| {
        let fence = format!("```{fence}\n");
        let blocks = chapter.split(&fence).skip(1);
        let mut blocks = blocks.filter_map(|rest| rest.split("```").next());
        let found = blocks.find(|block| block.starts_with(start));
        found
            .unwrap_or_else(|| panic!("no block `{start}`"))
            .to_owned()
    };
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("lib")).unwrap();
    for (name, text) in [
        ("hyde.toml", block("toml", "name")),
        ("lib/parts.hyde", block("hyde", "package lib.parts")),
        ("press.hyde", block("hyde", "package press")),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn hyde(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_hyde-tested"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{}", errors(output)))
}

fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}
