//! `hyde plot`: columns of results or of a record, a frequency response, or a batch, as a figure.

mod cases;
mod curves;
mod response;
mod source;
mod strip;

use crate::args::PlotArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
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
        Some("svg") => Ok(to_svg(&sized(args, figure(args)?)).into_bytes()),
        Some("png") => Ok(to_png(
            &sized(args, figure(args)?),
            args.dpi / PIXELS_AN_INCH,
        )),
        Some(_) | None => Err(format!(
            "`{}`: a figure is an .svg or a .png file",
            args.out.display()
        )),
    }
}

fn figure(args: &PlotArgs) -> Result<Figure, String> {
    let sources = source::read(args)?;
    let title = args.title.as_deref();
    let responses: Vec<_> = sources.iter().filter_map(response::of).collect();
    let figure = if responses.len() == sources.len() {
        let part = args.from.is_some() || args.to.is_some();
        if args.xy || !args.panels.is_empty() || part {
            return Err(
                "a frequency response is always plotted completely: leave out the columns and times".to_owned(),
            );
        }
        response::figure(title, &responses)
    } else if let [batch] = sources.as_slice()
        && let Some(figure) = cases::envelopes(args, batch)
    {
        figure?
    } else {
        let recorded = source::over_time(args, &sources)?;
        curves::check_window(args, &recorded)?;
        match args.xy {
            true => curves::over_each_other(args, &recorded)?,
            false => curves::over_time(args, &recorded)?,
        }
    };
    Ok(Figure {
        title: title.map(str::to_owned),
        ..figure
    })
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
