//! `hyde fmt` on files, folders and standard input.

use crate::command::{Folder, command, errors, hyde, read, status, text};
use std::io::Write as _;
use std::process::{Output, Stdio};

const ROUGH: &str = "model  A\nReal x;\nequation\nx=1; // one\nend A;\n";
const SMOOTH: &str = "model A\n  Real x;\nequation\n  x = 1; // one\nend A;\n";

#[test]
fn files_and_the_files_of_folders_are_formatted() {
    let folder = Folder::new();
    let one = folder.file("one.hyde", ROUGH);
    let two = folder.file("deep/two.hyde", ROUGH);
    let smooth = folder.file("smooth.hyde", SMOOTH);
    let checked = hyde(&["fmt", "--check", &folder.path(""), &smooth]);
    assert_eq!(status(&checked), 1);
    assert_eq!(text(&checked).lines().count(), 2, "{}", text(&checked));
    assert_eq!(read(&one), ROUGH, "`--check` writes nothing");

    let differs = hyde(&["fmt", "--diff", &one]);
    assert_eq!(status(&differs), 0);
    assert!(text(&differs).contains("+  x = 1; // one"));
    assert_eq!(read(&one), ROUGH, "`--diff` writes nothing");

    let formatted = hyde(&["fmt", &folder.path("")]);
    assert_eq!(status(&formatted), 0, "{}", errors(&formatted));
    assert_eq!(errors(&formatted), "2 formatted, 1 unchanged\n");
    assert_eq!((read(&one).as_str(), read(&two).as_str()), (SMOOTH, SMOOTH));
    assert_eq!(status(&hyde(&["fmt", "--check", &folder.path("")])), 0);
}

#[test]
fn an_item_with_an_error_is_left_and_reported() {
    let folder = Folder::new();
    let broken = "model  B\n  Real x := 1;\nend B;\n";
    let file = folder.file("mixed.hyde", &format!("{ROUGH}{broken}"));
    let output = hyde(&["fmt", &file]);
    assert_eq!(status(&output), 1);
    let said = errors(&output);
    assert!(
        said.contains("E0101") && said.contains("mixed.hyde:7:"),
        "{said}"
    );
    assert_eq!(read(&file), format!("{SMOOTH}{broken}"));
}

#[test]
fn standard_input_goes_to_standard_output() {
    let output = piped(&["fmt", "-"], ROUGH);
    assert_eq!((status(&output), text(&output).as_str()), (0, SMOOTH));
    let checked = piped(&["fmt", "--check", "-"], ROUGH);
    assert_eq!((status(&checked), text(&checked).as_str()), (1, ""));
    assert_eq!(status(&piped(&["fmt", "--check", "-"], SMOOTH)), 0);
}

#[test]
fn what_cannot_be_read_is_an_error_of_the_command_line() {
    let output = hyde(&["fmt", "/nowhere/a.hyde"]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("/nowhere/a.hyde"),
        "{}",
        errors(&output)
    );
    assert_eq!(status(&hyde(&["fmt"])), 2);
}

fn piped(arguments: &[&str], input: &str) -> Output {
    let mut child = command(arguments)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(input.as_bytes())
        .unwrap();
    child.wait_with_output().unwrap()
}
