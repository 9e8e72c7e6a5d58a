//! `hyde report`: the page of a batch from the files in its folder.

use crate::args::ReportArgs;
use crate::batch::report;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};

/// Writes the page.
pub(crate) fn report(args: &ReportArgs) -> Exit {
    let out = args
        .out
        .clone()
        .unwrap_or_else(|| args.folder.join("report.html"));
    let written = report::of_folder(&args.folder)
        .and_then(|page| files::write(&out, page.to_html().as_bytes()));
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
