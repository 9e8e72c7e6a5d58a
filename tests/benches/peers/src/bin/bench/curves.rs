//! Work-precision curves: time over error from rtol 1e-3 to 1e-8, of every program, as one figure.

use crate::command::Tools;
use crate::measure::{Taken, at, reference};
use crate::problem::{Compared, Problem};
use hyde_report::{Axis, Figure, Line, LineStyle, Panel, Scale, to_svg};
use std::path::PathBuf;

const TOLERANCES: [f64; 6] = [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8];
const ROUNDS: usize = 3;

/// Takes the curves and writes the figure, whose path it returns.
pub fn draw(problems: &[&Problem], tools: &Tools) -> Result<PathBuf, String> {
    let panels: Result<Vec<Panel>, String> = problems
        .iter()
        .map(|problem| panel(problem, tools))
        .collect();
    let figure = Figure::new(panels?)
        .with_title("Work and precision, rtol 1e-3 to 1e-8")
        .with_caption(
            "A point for each relative tolerance; the absolute tolerance is a hundredth of it. Runs with a wrong number of events are left out.",
        );
    let path = tools.out.join("work-precision.svg");
    std::fs::write(&path, to_svg(&figure))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

fn panel(problem: &Problem, tools: &Tools) -> Result<Panel, String> {
    let tight = reference(problem, tools)?;
    let mut curves: [Vec<Taken>; 3] = Default::default();
    for rtol in TOLERANCES {
        let row = at(problem, tools, rtol, &tight, ROUNDS)?;
        curves[0].push(row.c);
        curves[1].extend(row.diffsol);
        curves[2].push(row.hyde);
    }
    let mut lines = Vec::new();
    for (colour, (name, curve)) in ["C + IDA", "diffsol", "Hyde"]
        .into_iter()
        .zip(&curves)
        .enumerate()
    {
        // A run with a wrong number of events has no place on the axis.
        let right = || curve.iter().filter(|taken| taken.error.is_finite());
        let (x, y): (Vec<f64>, Vec<f64>) = right().map(|taken| (taken.error, taken.cpu_s)).unzip();
        lines.push(Line {
            colour: Some(colour),
            ..Line::new(name, x.clone(), y.clone())
        });
        lines.push(Line {
            colour: Some(colour),
            style: LineStyle::Points,
            ..Line::new("", x, y)
        });
    }
    let unit = if problem.compared == Compared::Events {
        "s"
    } else {
        "1"
    };
    let x = Axis::new(format!("{}: error", problem.name), unit).with_scale(Scale::Log);
    let y = Axis {
        factor: 1e3,
        ..Axis::new("CPU time", "ms")
    }
    .with_scale(Scale::Log);
    Ok(Panel::new(x, y, lines))
}
