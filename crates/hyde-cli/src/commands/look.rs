//! `hyde look`: what is in a trace, before any model reads it.

use crate::args::LookArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_present::look::{json, page, screen};
use hyde_report::to_html;
use hyde_study::traces::{Seen, Unread, seen as seen_of};
use hyde_study::world::Disk;
use std::path::Path;

/// Looks at every file.
pub(crate) fn look(args: &LookArgs) -> Exit {
    let (mut seen, mut failed) = (Vec::new(), Vec::new());
    for file in &args.files {
        match seen_of(&Disk, file) {
            Ok(found) => seen.push(found),
            Err(reason) => failed.push(reason),
        }
    }
    let left = args.out.as_ref().map(|folder| leave(folder, &seen));
    if args.json {
        let all = json(&seen, &failed);
        print_output(&format!("{all:#}"));
    } else {
        let texts: Vec<String> = seen.iter().map(screen).collect();
        print_output(texts.join("\n").trim_end());
        failed.iter().for_each(print_unread);
    }
    match left.transpose() {
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            return Exit::CommandLine;
        }
        Ok(Some(path)) if !args.json => print_output(&path),
        Ok(_) => {}
    }
    if failed.is_empty() {
        Exit::Done
    } else {
        Exit::Model
    }
}

/// Says why a file cannot be read.
pub(super) fn print_unread(unread: &Unread) {
    let Unread {
        file,
        message,
        help,
    } = unread;
    let help = help.as_ref();
    let help = help.map_or_else(String::new, |help| format!("\n  help: {help}"));
    let message = message
        .strip_prefix(&format!("`{file}`: "))
        .unwrap_or(message);
    print_error(&format!("error: {file}: {message}{help}"));
}

/// Leaves `look.html`; gives back its path.
fn leave(folder: &Path, all: &[Seen]) -> Result<String, String> {
    files::make_folder(folder)?;
    let path = folder.join("look.html");
    files::write(&path, to_html(&page(all)).as_bytes())?;
    Ok(path.display().to_string())
}
