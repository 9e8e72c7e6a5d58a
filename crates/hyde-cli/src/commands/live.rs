//! `hyde live`: a page on this machine that runs an experiment again at every change.

use crate::args::LiveArgs;
use crate::exit::Exit;
use crate::live::{Session, serve};
use crate::project::{asked, complain, print_output};

/// Serves the page until the command is interrupted.
pub(crate) fn live(args: &LiveArgs) -> Exit {
    let asked = match asked(&args.model) {
        Ok(asked) => asked,
        Err(exit) => return exit,
    };
    let served = Session::new(asked).and_then(|session| {
        serve(session, args.port, |address| {
            print_output(&format!(
                "{address}\nopen this page in a browser; Ctrl-C ends"
            ));
        })
    });
    match served {
        Ok(()) => Exit::Done,
        Err(reason) => complain(&args.model, Exit::CommandLine, &reason),
    }
}
