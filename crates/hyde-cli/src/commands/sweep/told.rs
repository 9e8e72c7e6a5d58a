//! The summary of a batch, as a file of its folder and on the terminal.

use super::work::Work;
use crate::batch::asked::from_source;
use crate::files;
use crate::project::print_output;
use hyde_experiment::batch::Summary;
use hyde_present::lines::shell_word as word;
use hyde_present::sweep::tell as said;
use hyde_study::sweep::{Order, Took};
use serde_json::json;

/// Writes the summary and prints it, with the command that runs one of the cases again.
pub(super) fn tell(
    work: &Work<'_>,
    order: &Order,
    summary: &Summary,
    took: Took,
) -> Result<(), String> {
    let (args, batch, folder) = (work.args, work.batch, work.folder);
    let rerun = match (&args.out, work.kept) {
        (None, false) => from_source(args, order),
        _ => format!("hyde sweep {}", word(&folder.to_string_lossy())),
    };
    let mut json = said::json(batch, summary, &rerun);
    let text = format!("{json:#}\n");
    files::write(&folder.join("summary.json"), text.as_bytes())?;
    if args.json {
        json["solved"] = json!(took.solved);
        json["wall_s"] = json!(took.wall.as_secs_f64());
        json["solving_s"] = json!(took.solving.as_secs_f64());
        print_output(&json.to_string());
    } else if !args.quiet {
        print_output(&said::text(batch, summary, took, &rerun));
    }
    Ok(())
}
