//! The forces, torques and currents between components: as a table for people, as JSON for programs, as a section of the
//! report.

use crate::figures::curve;
use crate::panels::quantity;
use hyde_compiler::Compiled;
use hyde_experiment::{FlowLine, Run, flows};
use hyde_program::Program;
use hyde_report::{Block, Panel, Section, Table, time_panel, time_plot};
use hyde_units::{drawn_in, engineering_as, shown, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Curves in a panel of the report: those of the largest rms.
const CURVES: usize = 5;

/// The table; its numbers take 44 columns.
pub fn text(compiled: &Compiled, run: &Run) -> String {
    let lines = flows(&compiled.program, &run.results);
    let widest = lines.iter().map(|line| line.name.len()).max();
    let width = widest.unwrap_or(0).clamp(20, 60);
    let mut out = format!(
        "\n  {:<width$} {:>13} {:>13} {:>13}\n",
        "between components", "least", "most", "rms"
    );
    for line in &lines {
        let unit = &compiled.program.outputs[line.output].unit;
        let number = |value: f64| engineering_as(value, unit);
        let (least, most, rms) = (number(line.least), number(line.most), number(line.rms));
        let _ = writeln!(
            out,
            "  {:<width$} {least:>13} {most:>13} {rms:>13}",
            line.name
        );
    }
    out
}

/// The table as JSON.
pub fn json(compiled: &Compiled, run: &Run) -> Value {
    let lines = flows(&compiled.program, &run.results);
    let lines = lines.iter().map(|line| {
        let output = &compiled.program.outputs[line.output];
        json!({
            "connection": line.name, "column": output.name, "unit": output.dimension.usual_unit(),
            "least": line.least, "most": line.most, "rms": line.rms, "at_s": line.at_s,
        })
    });
    lines.collect()
}

/// The table and the largest of each unit over time; `None` where nothing is connected.
pub fn section(compiled: &Compiled, run: &Run) -> Option<Section> {
    let lines = flows(&compiled.program, &run.results);
    if lines.is_empty() {
        return None;
    }
    let output = |line: &FlowLine| &compiled.program.outputs[line.output];
    let mut table = Table::with_columns(&[
        "between components",
        "unit",
        ">least",
        ">most",
        ">rms",
        ">largest at [s]",
    ]);
    table.rows = lines
        .iter()
        .map(|line| {
            let (unit, of) = drawn_in(&output(line).unit);
            let number = |si: f64| significant(of.from_si(si), 4).replace('-', "−");
            vec![
                line.name.clone(),
                shown(&unit).to_owned(),
                number(line.least),
                number(line.most),
                number(line.rms),
                significant(line.at_s, 5),
            ]
        })
        .collect();
    let panels = panels(&lines, &compiled.program, run);
    let figure = time_plot("", panels, None);
    let figure = hyde_report::Figure {
        title: None,
        ..figure
    }
    .with_caption(format!("The {CURVES} of the largest rms in each unit."));
    Some(Section {
        heading: "Forces between components".to_owned(),
        blocks: vec![Block::Table(table), Block::Figure(figure)],
    })
}

/// A panel a unit.
fn panels(lines: &[FlowLine], program: &Program, run: &Run) -> Vec<Panel> {
    let output = |line: &FlowLine| &program.outputs[line.output];
    let mut units: Vec<String> = Vec::new();
    for (unit, _) in lines.iter().map(|line| drawn_in(&output(line).unit)) {
        if !units.contains(&unit) {
            units.push(unit);
        }
    }
    let panel = |unit: &String| {
        let mut own: Vec<&FlowLine> = lines
            .iter()
            .filter(|line| drawn_in(&output(line).unit).0 == *unit)
            .collect();
        own.sort_by(|a, b| b.rms.total_cmp(&a.rms));
        let line = |line: &&FlowLine| curve(&line.name, line.output, program, run);
        let dimension = own.first().map(|line| output(line).dimension);
        time_panel(
            dimension.map_or("", quantity),
            shown(unit),
            own.iter().take(CURVES).map(line).collect(),
        )
    };
    units.iter().map(panel).collect()
}
