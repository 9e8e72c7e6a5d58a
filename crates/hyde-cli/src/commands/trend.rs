//! `hyde trend`: how sizes and parameters went from one diagnosis to the next.

use crate::args::TrendArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_present::trend;
use hyde_study::trend::trends;
use serde_json::{Value, json};
use std::path::Path;

/// Reads the reports and tells.
pub(crate) fn trend(args: &TrendArgs) -> Exit {
    match told(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(reason) if args.json => {
            let told = json!({ "ok": false, "error": reason });
            print_output(&format!("{told:#}"));
            Exit::CommandLine
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

fn told(args: &TrendArgs) -> Result<String, String> {
    let reports = args.folders.iter();
    let reports = reports.map(|folder| Ok((label(folder), report(folder)?)));
    let found = trends(&reports.collect::<Result<Vec<_>, String>>()?)?;
    Ok(match args.json {
        true => format!("{:#}", trend::json(&found)),
        false => trend::text(&found),
    })
}

/// The folder's name.
fn label(folder: &Path) -> String {
    let own = if files::is_file(folder) {
        folder.parent()
    } else {
        Some(folder)
    };
    let name = own.and_then(Path::file_name).unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn report(folder: &Path) -> Result<Value, String> {
    let path = match files::is_folder(folder) {
        true => folder.join("report.json"),
        false => folder.to_path_buf(),
    };
    let text = files::read_text(&path)?;
    let report: Value = serde_json::from_str(&text)
        .map_err(|error| format!("`{}` is not valid JSON: {error}", path.display()))?;
    if report["report"] != 1 || !report["effects"].is_array() {
        return Err(format!(
            "`{}` is not a report of this version of `hyde diagnose`",
            path.display()
        ));
    }
    Ok(report)
}
