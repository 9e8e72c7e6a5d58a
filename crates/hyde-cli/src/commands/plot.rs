//! `hyde plot`: columns of results or of a record, a frequency response, or a batch, as a figure.

use crate::args::PlotArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_present::plot::{Options, figure};
use hyde_report::{Figure, to_png, to_svg};

/// CSS pixels to the millimetre, and to the inch.
const PIXELS_A_MM: f64 = 96.0 / 25.4;
const PIXELS_AN_INCH: f64 = 96.0;

/// Plots columns into a file.
pub(crate) fn plot(args: &PlotArgs) -> Exit {
    let left = content(args).and_then(|content| files::write(&args.out, &content));
    match left {
        Ok(()) => {
            print_output(&format!("{}", args.out.display()));
            Exit::Done
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

/// The bytes of the file asked for.
fn content(args: &PlotArgs) -> Result<Vec<u8>, String> {
    let ending = args.out.extension().and_then(|ending| ending.to_str());
    for (option, value) in [
        ("width", args.width),
        ("height", args.height),
        ("dpi", Some(args.dpi)),
    ] {
        if value.is_some_and(|value| value.is_nan() || value <= 0.0) {
            return Err(format!("`--{option}` must be positive"));
        }
    }
    match ending {
        Some("svg") => Ok(to_svg(&sized(args, drawn(args)?)).into_bytes()),
        Some("png") => Ok(to_png(
            &sized(args, drawn(args)?),
            args.dpi / PIXELS_AN_INCH,
        )),
        Some(_) | None => Err(format!(
            "`{}`: a figure is an .svg or a .png file",
            args.out.display()
        )),
    }
}

/// The figure in the size asked for.
fn sized(args: &PlotArgs, mut figure: Figure) -> Figure {
    if let Some(width) = args.width {
        figure.width = width * PIXELS_A_MM;
    }
    if let Some(height) = args.height {
        figure.panel_height = height * PIXELS_A_MM;
        for panel in &mut figure.panels {
            panel.height = None;
        }
    }
    figure
}

/// The figure; what is assumed of its files is printed.
fn drawn(args: &PlotArgs) -> Result<Figure, String> {
    let mut notes = Vec::new();
    let figure = figure(&options(args), &mut notes);
    notes.iter().for_each(|note| print_error(note));
    figure
}

fn options(args: &PlotArgs) -> Options {
    Options {
        world: files::disk(),
        results: args.results.clone(),
        with: args.with.clone(),
        panels: args.panels.clone(),
        xy: args.xy,
        equal: args.equal,
        cases: args.cases.clone(),
        modes: args.modes.clone(),
        title: args.title.clone(),
        from: args.from,
        to: args.to,
        every: args.every,
    }
}
