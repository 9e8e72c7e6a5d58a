//! The command as a user calls it, in a folder; and the files that it reads there.

use std::path::Path;
use std::process::Command;

/// What `hyde` prints; it has to end well.
pub(crate) fn hyde(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new(env!("CARGO_BIN_EXE_hyde-tested"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap();
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    String::from_utf8(output.stdout).unwrap()
}

/// The same with `--json`, read.
pub(crate) fn report(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let printed = hyde(folder, &[arguments, &["--json"]].concat());
    serde_json::from_str(&printed).unwrap()
}

#[allow(clippy::disallowed_methods, reason = "a record is made in a folder")]
pub(crate) fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap()
}

#[allow(clippy::disallowed_methods, reason = "a record is made in a folder")]
pub(crate) fn write(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap();
}
