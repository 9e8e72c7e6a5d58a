//! Every diagnostic code has a fixture that shows it, and a page whose examples are true.
//!
//! A fixture is `tests/fixtures/errors/EXXXX_name.hyde`, the smallest model that one might write wrongly. It is checked,
//! or, if its first line says `// hyde run FILE …`, run; what the command prints is a snapshot. A page is
//! `book/src/errors/EXXXX.md`; its blocks marked `hyde wrong` give that code and no other, those marked `hyde right`
//! nothing at all. Review a changed message with `cargo insta review`.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_diag::Code;
use serde_json::Value;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

#[test]
fn every_fixture_says_what_its_snapshot_shows() {
    for path in fixtures() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let output = hyde(&text, &path, &folder(), false);
        let shown = format!(
            "{}{}--> exit status {}\n",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr),
            output.status.code().unwrap()
        );
        let shown = shown.replace(&*folder().to_string_lossy(), "FOLDER");
        insta::assert_snapshot!(name, without_rounding(&shown));
    }
}

#[test]
fn every_fixture_shows_its_code_and_no_other() {
    for path in fixtures() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        let output = hyde(&text, &path, &folder(), true);
        assert_eq!(codes(&output), [&name[..5]], "{name}");
    }
}

#[test]
fn every_code_has_a_fixture() {
    let shown: BTreeSet<String> = fixtures()
        .iter()
        .map(|path| path.file_name().unwrap().to_string_lossy()[..5].to_owned())
        .collect();
    let codes: BTreeSet<String> = Code::ALL.iter().map(ToString::to_string).collect();
    assert_eq!(shown, codes);
}

#[test]
fn every_page_explains_its_code_with_examples_that_are_true() {
    let scratch = tempfile::tempdir().unwrap();
    copy(&folder().join("packages"), &scratch.path().join("packages"));
    for fmu in ["controller.fmu", "windows.fmu"] {
        std::fs::copy(folder().join(fmu), scratch.path().join(fmu)).unwrap();
    }
    for code in Code::ALL {
        let page = page(*code);
        let title = format!("# {code}: {}", code.title());
        assert_eq!(page.lines().next(), Some(title.as_str()), "{code}");
        let long = page.lines().find(|line| line.chars().count() > 80);
        assert_eq!(long, None, "{code}: the page is 80 columns wide");
        let (wrong, right) = (blocks(&page, "hyde wrong"), blocks(&page, "hyde right"));
        assert!(
            !wrong.is_empty() && !right.is_empty(),
            "{code}: two examples"
        );
        for text in &wrong {
            let output = written(text, scratch.path());
            assert_eq!(codes(&output), [code.as_str()], "{code}, as wrong:\n{text}");
        }
        for text in &right {
            let output = written(text, scratch.path());
            let printed = String::from_utf8_lossy(&output.stdout);
            assert!(
                output.status.success(),
                "{code}, as right:\n{text}\n{printed}"
            );
            let quiet: &[String] = &[];
            assert_eq!(codes(&output), quiet, "{code}, as right:\n{text}");
        }
    }
}

#[test]
fn a_failed_assert_tells_the_value_that_broke_it() {
    let path = folder().join("E0704_over_the_end.hyde");
    let text = std::fs::read_to_string(&path).unwrap();
    let output = hyde(&text, &path, &folder(), false);
    let said = String::from_utf8_lossy(&output.stderr);
    // At the crossing, not at the last row before it: 0.5 m/s for 1.2 s.
    assert!(said.contains("`s` is 0.6 m there"), "{said}");
}

#[test]
fn a_solver_that_gives_up_tells_the_terms_of_its_equation() {
    let path = folder().join("E0701_runs_away.hyde");
    let text = std::fs::read_to_string(&path).unwrap();
    let output = hyde(&text, &path, &folder(), false);
    let said = String::from_utf8_lossy(&output.stderr);
    // der(v) = v^2: the value of `name`, and its term of the left side minus the right side.
    let told = |name: &str| {
        let line = said
            .lines()
            .find(|line| line.contains(&format!("note: `{name}` is ")));
        let line = line.unwrap_or_else(|| panic!("{name}: {said}"));
        let mut numbers = line.split(' ').filter_map(|word| word.parse::<f64>().ok());
        (numbers.next().unwrap(), numbers.next().unwrap())
    };
    let ((v, square), (rate, own)) = (told("v"), told("der(v)"));
    assert!((square + v * v).abs() < 1e-2 * v * v, "{said}");
    assert!((own - rate).abs() < 1e-2 * rate, "{said}");
    assert!((rate - v * v).abs() < 1e-2 * rate, "{said}");
}

#[test]
fn a_singular_start_tells_the_null_space_of_its_equations() {
    let path = folder().join("E0603_force_on_a_massless_rail.hyde");
    let text = std::fs::read_to_string(&path).unwrap();
    let output = hyde(&text, &path, &folder(), false);
    let said = String::from_utf8_lossy(&output.stderr);
    // A rail without a mass may have any velocity, which is the rate of its place.
    let told =
        "a change of `der(motor.a.s)` by 1, `guide.v` by 1 leaves these equations as they are";
    assert!(said.contains(told), "{said}");
}

/// A run that fails near a singularity ends where rounding lets it: what it says of that place is left out.
fn without_rounding(shown: &str) -> String {
    let line = |line: &str| match (line.find("` is "), line.split_once(" there")) {
        (Some(at), Some((_, ""))) => format!("{}` is … there\n", &line[..at]),
        (Some(at), Some((_, rest))) if rest.starts_with(", a term of ") => {
            format!("{}` is … there, a term of …\n", &line[..at])
        }
        _ => {
            let figure = [
                "even with a step of ",
                "advanced it by only ",
                "sides of this equation differ by ",
            ]
            .into_iter()
            .find_map(|before| Some((line.split_once(before)?.0, before)));
            match figure {
                Some((start, before)) => format!("{start}{before}…\n"),
                None => format!("{line}\n"),
            }
        }
    };
    shown.lines().map(line).collect()
}

/// Every fixture, in the order of its name.
fn fixtures() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder()).unwrap();
    let mut found: Vec<PathBuf> = entries
        .map(|entry| entry.unwrap().path())
        .filter(|path| {
            path.extension()
                .is_some_and(|extension| extension == "hyde")
        })
        .collect();
    found.sort();
    found
}

/// Copies the packages of the fixtures beside an example of a page.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let place = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy(&path, &place);
        } else {
            std::fs::copy(&path, &place).unwrap();
        }
    }
}

/// The page of a code, as the book has it.
fn page(code: Code) -> String {
    let book = Path::new(env!("CARGO_MANIFEST_DIR")).join("../book/src/errors");
    std::fs::read_to_string(book.join(format!("{code}.md"))).unwrap()
}

/// The code blocks of a page that are marked so.
fn blocks(page: &str, mark: &str) -> Vec<String> {
    let fence = format!("```{mark}\n");
    page.split(&fence)
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .map(str::to_owned)
        .collect()
}

/// Writes an example of a page beside the fixtures' records and takes it as its first line says.
fn written(text: &str, scratch: &Path) -> Output {
    let path = scratch.join("example.hyde");
    std::fs::write(&path, text).unwrap();
    hyde(text, &path, &folder(), true)
}

/// What the command says of a file: checked, or as its first line says.
fn hyde(text: &str, path: &Path, data: &Path, json: bool) -> Output {
    let first = text.lines().next().unwrap_or_default();
    let line = first.strip_prefix("// hyde ").unwrap_or("check FILE");
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyde-tested"));
    command.current_dir(path.parent().unwrap());
    for word in line.split_whitespace() {
        match word {
            "FILE" => command.arg(path.file_name().unwrap()),
            word => command.arg(word),
        };
    }
    command.arg("--data").arg(data);
    if json {
        command.arg("--json");
    }
    command.output().unwrap()
}

/// The codes of what a command reported, each once, in their order.
fn codes(output: &Output) -> Vec<String> {
    let printed: Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
    let listed = printed["diagnostics"].as_array();
    let found: BTreeSet<String> = listed
        .into_iter()
        .flatten()
        .filter_map(|diagnostic| diagnostic["code"].as_str().map(str::to_owned))
        .collect();
    found.into_iter().collect()
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/errors")
}
