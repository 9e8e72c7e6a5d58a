//! A run as its page and as a figure: those of the command line, drawn when they are asked for.

use crate::model::Model;
use crate::outcome::Outcome;
use crate::refusal;
use hyde_present::{asked_figures, figures, run_page};
use hyde_program::{Curve, Program};
use hyde_report::{Figure, to_html, to_svg};
use hyde_units::shown;
use pyo3::prelude::*;

/// The page of a run, as `hyde run --out` writes it; `made` says when it is made.
#[pyfunction]
pub(crate) fn page(
    py: Python<'_>,
    model: &Model,
    outcome: &Outcome,
    made: &str,
) -> PyResult<String> {
    let run = outcome.run(py)?;
    model.with_project(|project, compiled| to_html(&run_page::page(project, compiled, &run, made)))
}

/// Figures as SVG: of the variables named, a panel for each list, or those that the page of the run has.
#[pyfunction]
pub(crate) fn figures_of(
    py: Python<'_>,
    model: &Model,
    outcome: &Outcome,
    title: &str,
    panels: Vec<Vec<String>>,
) -> PyResult<Vec<String>> {
    let run = outcome.run(py)?;
    let program = model.program();
    let kept = outcome.kept(program);
    let drawn: Vec<Figure> = match (panels.is_empty(), outcome.is_part(program)) {
        (true, false) => figures::of_run(title, program, &run),
        (true, true) => {
            let panels = by_unit(program, &kept);
            vec![asked_figures::over_time(title, program, &run, &panels)]
        }
        (false, _) => {
            let panels = panels.iter().map(|names| panel(program, &kept, names));
            let panels: Vec<Vec<Curve>> = panels.collect::<PyResult<_>>()?;
            vec![asked_figures::over_time(title, program, &run, &panels)]
        }
    };
    Ok(drawn.iter().map(to_svg).collect())
}

/// The curves of a panel: all of one dimension.
fn panel(program: &Program, kept: &[usize], names: &[String]) -> PyResult<Vec<Curve>> {
    let mut curves: Vec<Curve> = Vec::new();
    for name in names {
        let Some(output) = program.output(name).filter(|own| kept.contains(own)) else {
            return Err(refusal::asked(&format!("the run has no column `{name}`")));
        };
        let unit =
            |output: usize| shown(&program.outputs[output].dimension.usual_unit()).to_owned();
        if let Some(first) = curves.first()
            && program.outputs[first.output].dimension != program.outputs[output].dimension
        {
            let reason = format!(
                "`{}` is in {} and `{name}` in {}: give each a panel of its own",
                first.name,
                unit(first.output),
                unit(output)
            );
            return Err(refusal::asked(&reason));
        }
        curves.push(curve(program, output));
    }
    Ok(curves)
}

/// Outputs that have one unit share a panel.
fn by_unit(program: &Program, kept: &[usize]) -> Vec<Vec<Curve>> {
    let mut panels: Vec<Vec<Curve>> = Vec::new();
    for &output in kept {
        let own = program.outputs[output].dimension;
        let known = panels
            .iter_mut()
            .find(|panel| program.outputs[panel[0].output].dimension == own);
        match known {
            Some(panel) => panel.push(curve(program, output)),
            None => panels.push(vec![curve(program, output)]),
        }
    }
    panels
}

fn curve(program: &Program, output: usize) -> Curve {
    Curve {
        name: program.outputs[output].name.clone(),
        output,
    }
}
