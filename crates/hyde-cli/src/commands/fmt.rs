//! `hyde fmt`: source texts in the layout of the project.

use crate::args::FmtArgs;
use crate::exit::Exit;
use crate::files;
use crate::output::{print_diagnostics, print_error, print_output, write_output};
use hyde_format::Failure;
use similar::TextDiff;
use std::io::Read as _;
use std::path::Path;

/// What became of a file.
enum Outcome {
    /// It is as it should be.
    Unchanged,
    /// It was written, or would be.
    Changed,
    /// It has errors, or cannot be read or written; this is reported.
    Failed(Exit),
}

/// Formats files, the files of folders, or standard input.
pub(crate) fn fmt(args: &FmtArgs) -> Exit {
    let mut exit = Exit::Done;
    let mut paths = Vec::new();
    for path in &args.paths {
        if path == Path::new("-") {
            exit = exit.max(standard_input(args));
        } else if files::is_folder(path) {
            paths.extend(files::below(path, "hyde", ""));
        } else {
            paths.push(path.clone());
        }
    }
    let (mut changed, mut unchanged) = (0, 0);
    for path in &paths {
        let (outcome, own) = file(path, args);
        exit = exit.max(own);
        match outcome {
            Outcome::Unchanged => unchanged += 1,
            Outcome::Changed => {
                changed += 1;
                if args.check && !args.diff {
                    print_output(&path.display().to_string());
                }
            }
            Outcome::Failed(why) => exit = exit.max(why),
        }
    }
    if args.check && changed > 0 {
        exit = exit.max(Exit::Model);
    }
    if !args.quiet && !paths.is_empty() {
        let done = match args.check || args.diff {
            true => "to format",
            false => "formatted",
        };
        print_error(&format!("{changed} {done}, {unchanged} unchanged"));
    }
    exit
}

/// Formats a file. Syntax errors are reported and give an exit status of their own.
fn file(path: &Path, args: &FmtArgs) -> (Outcome, Exit) {
    let name = path.display().to_string();
    let text = match read(path) {
        Ok(text) => text,
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            return (Outcome::Failed(Exit::CommandLine), Exit::Done);
        }
    };
    let Some((new, exit)) = formatted(&name, &text) else {
        return (Outcome::Failed(Exit::Model), Exit::Done);
    };
    if new == text {
        return (Outcome::Unchanged, exit);
    }
    if args.diff {
        print_output(&difference(&name, &text, &new));
    } else if !args.check
        && let Err(reason) = files::rewrite(path, new.as_bytes())
    {
        print_error(&format!("error: {reason}"));
        return (Outcome::Failed(Exit::CommandLine), exit);
    }
    (Outcome::Changed, exit)
}

/// Formats standard input to standard output.
fn standard_input(args: &FmtArgs) -> Exit {
    let mut text = String::new();
    if let Err(error) = std::io::stdin().read_to_string(&mut text) {
        print_error(&format!(
            "error: cannot read standard input: {}",
            files::reason(&error)
        ));
        return Exit::CommandLine;
    }
    let Some((new, exit)) = formatted("standard input", &text) else {
        if !args.check && !args.diff {
            // Who pipes a text through the command gets it back.
            write_output(&text);
        }
        return Exit::Model;
    };
    if args.diff {
        if new != text {
            print_output(&difference("standard input", &text, &new));
        }
    } else if !args.check {
        write_output(&new);
    }
    if args.check && new != text {
        exit.max(Exit::Model)
    } else {
        exit
    }
}

/// The formatted text, with the exit status for its syntax errors, which are reported. Nothing if the text cannot be
/// formatted, which is reported too.
fn formatted(name: &str, text: &str) -> Option<(String, Exit)> {
    match hyde_format::format(name, text) {
        Ok(formatted) => {
            if formatted.errors.is_empty() {
                return Some((formatted.text, Exit::Done));
            }
            let last = format!("{name}: items with syntax errors are left as they are");
            print_diagnostics(&formatted.errors, &formatted.sources, &last);
            Some((formatted.text, Exit::Model))
        }
        Err(failure) => {
            let why = match failure {
                Failure::Changed => "the formatted text would have another meaning",
                Failure::Unsettled => "formatting it again would change it again",
            };
            print_error(&format!(
                "error: `{name}` is left as it is: {why}\n  This is a defect of `hyde fmt`; please report it with the file."
            ));
            None
        }
    }
}

/// A text as it is, with its mark of byte order.
fn read(path: &Path) -> Result<String, String> {
    String::from_utf8(files::read(path)?)
        .map_err(|_| format!("`{}` is not UTF-8 text: save it as UTF-8", path.display()))
}

fn difference(name: &str, old: &str, new: &str) -> String {
    TextDiff::from_lines(old, new)
        .unified_diff()
        .header(name, &format!("{name} (formatted)"))
        .to_string()
}
