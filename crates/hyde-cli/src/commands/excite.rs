//! `hyde excite`: what to record next.
//!
//! ```text
//! quantity     a number with a unit, as an option has it            excite/quantity.rs
//! wish         what the options ask for, and what is assumed        excite/wish.rs
//! refused      why there is no such signal, and what to write       excite/refused.rs
//! text         a design on the console and as JSON                  excite/text.rs
//! compared     signals compared on a model                          excite/compared.rs
//! between      effects that a record is to distinguish              excite/between.rs
//! table        the comparison on the console and as JSON            excite/table.rs
//! ```

mod between;
mod compared;
mod quantity;
mod refused;
mod table;
mod text;
mod wish;

use crate::args::{ExciteArgs, SignalFormat};
use crate::exit::Exit;
use crate::files;
use crate::project::print_output;
use hyde_signal::excite::{Bounds, Design, design, g_code, twincat};
use hyde_units::{NamedUnit, significant};
use std::fmt::Write as _;
use std::path::Path;
use wish::Asked;

/// Why there is no signal.
enum Failure {
    /// The options ask for what cannot be.
    Asked(String),
    /// The model is at fault, and that is reported.
    Told(Exit),
}

/// Designs a signal, tells and writes it.
pub(crate) fn excite(args: &ExciteArgs) -> Exit {
    let found = match args.file {
        Some(_) => of_model(args),
        None => designed(args).map_err(Failure::Asked),
    };
    match found {
        Ok(told) => {
            if !told.is_empty() {
                print_output(&told);
            }
            Exit::Done
        }
        Err(Failure::Asked(reason)) => compared::report(args, &reason),
        Err(Failure::Told(exit)) => exit,
    }
}

/// A signal of one kind.
fn designed(args: &ExciteArgs) -> Result<String, String> {
    let asked = wish::of(args)?;
    let design = design(&asked.wish).map_err(|own| refused::reason(&own, &asked.wish))?;
    leave(args, &asked, &design)?;
    Ok(match (args.json, args.quiet) {
        (true, _) => format!("{:#}", text::json(&asked, &design)),
        (false, true) => String::new(),
        (false, false) => text::text(None, &asked, &design, args.out.as_deref()),
    })
}

/// The best signal for a model.
fn of_model(args: &ExciteArgs) -> Result<String, Failure> {
    let mut found = compared::compared(args)?;
    found.asked.column.clone_from(&found.bench.column.1);
    let best = &found.all[found.best];
    leave(args, &found.asked, &best.design).map_err(Failure::Asked)?;
    Ok(match (args.json, args.quiet) {
        (true, _) => format!("{:#}", table::json(&found)),
        (false, true) => String::new(),
        (false, false) => table::text(args, &found),
    })
}

/// Writes the file, if one is asked for.
fn leave(args: &ExciteArgs, asked: &Asked, design: &Design) -> Result<(), String> {
    let Some(path) = &args.out else {
        return Ok(());
    };
    let content = content(args, asked, design, format_of(args, path))?;
    files::write(path, content.as_bytes())
}

fn format_of(args: &ExciteArgs, path: &Path) -> SignalFormat {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let ending = ending.to_string_lossy();
    let by_ending = match ["nc", "ngc", "mpf", "gcode"].contains(&ending.as_ref()) {
        true => SignalFormat::Gcode,
        false => SignalFormat::Csv,
    };
    args.format.unwrap_or(by_ending)
}

/// The content of the file.
fn content(
    args: &ExciteArgs,
    asked: &Asked,
    design: &Design,
    format: SignalFormat,
) -> Result<String, String> {
    if format == SignalFormat::Csv {
        return Ok(csv(&asked.column, design));
    }
    if matches!(design.wish.bounds, Bounds::Effort(_)) {
        return Err(format!(
            "a controller takes positions, and this signal is in {}\n  help: write a CSV file, `--format csv`, or limit a motion with `--travel`",
            design.wish.unit
        ));
    }
    if format == SignalFormat::Twincat {
        return Ok(twincat(design));
    }
    if !args.axis.is_ascii_alphabetic() {
        return Err(format!(
            "`--axis {}` is not a letter\n  help: write the letter of the axis, `--axis X`",
            args.axis
        ));
    }
    let is_turned = design.wish.unit.unit().dimension == hyde_units::Dimension::ANGLE;
    let unit = if is_turned { "deg" } else { "mm" };
    let unit = NamedUnit::parse(unit).map_err(|error| error.to_string())?;
    Ok(g_code(
        design,
        args.axis.to_ascii_uppercase(),
        unit.unit().from_si(1.0),
    ))
}

/// The signal as a record.
fn csv(column: &str, design: &Design) -> String {
    let mut out = format!("t [s],{column} [{}]\n", design.wish.unit);
    for row in 0..design.rows() {
        let time = significant(design.time(row), 12);
        let _ = writeln!(out, "{time},{}", design.cell(row));
    }
    out
}
