//! `hyde report`: the page of a batch from the files in its folder.

use crate::args::ReportArgs;
use crate::clock;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_present::lines::shell_word;
use hyde_present::sweep::page::report;
use hyde_report::BatchReport;
use hyde_study::sweep::{Finished, Unfinished};
use std::path::Path;

/// Writes the page.
pub(crate) fn write(args: &ReportArgs) -> Exit {
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| args.folder.join("report.html"));
    let written = page(&args.folder).and_then(|page| files::write(&out, page.to_html().as_bytes()));
    match written {
        Ok(()) => {
            print_output(&format!("{}", out.display()));
            Exit::Done
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

/// The report of the batch in a folder.
fn page(folder: &Path) -> Result<BatchReport, String> {
    let shown = folder.display();
    let finished = Finished::read(&files::disk(), folder);
    let finished = finished.map_err(|own| match own {
        Unfinished::NoBatch => format!(
            "`{shown}` contains no batch: `hyde sweep FILE --out DIR` writes one; the page of a run is `report.html`"
        ),
        Unfinished::CasesMissing => format!(
            "the batch in `{shown}` is not finished: `hyde sweep {}` solves the missing cases",
            shell_word(&folder.to_string_lossy())
        ),
        Unfinished::Unreadable(reason) => reason,
    })?;
    report(&finished, &folder.to_string_lossy(), &clock::now())
}
