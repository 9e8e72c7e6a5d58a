//! The `hyde` command. This crate alone reads the arguments, prints, and writes files; what a command computes is a function
//! of `hyde-study`, and the text, the JSON and the pages of it are made by `hyde-present`.
//!
//! Each command is a file in `commands/`: it makes data of its arguments, calls a study, prints what is made of its result, and
//! leaves the files. They share printing what is wrong with a model and its records (`project`, `study`), rendering
//! diagnostics (`render`), and writing files whole or not at all (`files`).

mod args;
mod batch;
mod clock;
mod commands;
mod exit;
mod files;
mod interruption;
mod live;
mod output;
mod project;
mod sandbox;
mod study;
mod watch;

pub use hyde_study::render;

use args::{Arguments, Command};
use clap::{CommandFactory as _, Parser as _};
use exit::Exit;
use hyde_signal::parquet;
use mimalloc::MiMalloc;
use std::ffi::OsString;
use std::process::ExitCode;

/// A diagnosis makes and drops small matrices by the million, on every thread.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// Whether a command has this name.
#[must_use]
pub fn has(name: &str) -> bool {
    Arguments::command()
        .get_subcommands()
        .any(|command| command.get_name() == name)
}

/// Runs a command line.
pub fn main(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    keep_quiet_of_damaged_files();
    let mut arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // `--help` and `--version` come this way too, and are no error.
            let code = if error.use_stderr() {
                Exit::CommandLine
            } else {
                Exit::Done
            };
            output::note(error.print());
            return output::ended(code).into();
        }
    };
    interruption::watch();
    arguments.command.tell_model();
    let code = match &arguments.command {
        Command::Check(args) => commands::check::check(args),
        Command::Run(args) => commands::run::run(args),
        Command::Budget(args) => commands::budget::budget(args),
        Command::Sweep(args) => commands::sweep::sweep(args),
        Command::Emit(args) => commands::emit::emit(args),
        Command::Plot(args) => commands::plot::plot(args),
        Command::Report(args) => commands::report::write(args),
        Command::Bode(args) => commands::bode::bode(args),
        Command::Modes(args) => commands::modes::modes(args),
        Command::Params(args) => commands::params::params(args),
        Command::Effects(args) => commands::effects::effects(args),
        Command::Test(args) => commands::test::test(args),
        Command::Fit(args) => commands::fit::fit(args),
        Command::Diagnose(args) => commands::diagnose::diagnose(args),
        Command::Selftest(args) => commands::selftest::selftest(args),
        Command::Trend(args) => commands::trend::trend(args),
        Command::Look(args) => commands::look::look(args),
        Command::Excite(args) => commands::excite::excite(args),
        Command::New(args) => commands::new::new(args),
        Command::Fmt(args) => commands::fmt::fmt(args),
        Command::Live(args) => commands::live::live(args),
        Command::Lsp(_) => commands::lsp::lsp(),
        Command::Mcp(_) => commands::mcp::mcp(),
        Command::Doc(args) => commands::doc::doc(args),
        Command::Explain(args) => commands::explain::explain(args),
        Command::Export(args) => commands::export::export(args),
        Command::Completions(args) => commands::completions::completions(args),
        Command::Man(args) => commands::man::man(args),
        Command::FmuHost => sandbox::serve(),
    };
    output::ended(code).into()
}

/// What panics in the reader of Parquet files is a damaged file, of which a diagnostic tells: it leaves no trace of its own.
fn keep_quiet_of_damaged_files() {
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if std::thread::current().name() != Some(parquet::READER) {
            usual(panic);
        }
    }));
}
