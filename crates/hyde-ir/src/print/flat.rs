//! Prints a [`FlatModel`].

use super::{Names, comment, counted};
use crate::flat::{
    Action, Equation, FlatModel, Method, Preparation, RecordedResponse, ReductionKind, ScaledColumn,
};

use crate::{Interpolation, Quantity, VariableKind};
use hyde_diag::Sources;
use std::fmt::Write as _;

/// The flat model as text, section by section.
#[must_use]
pub fn print_flat(flat: &FlatModel, sources: &Sources) -> String {
    let mode = |automaton: crate::AutomatonId, mode: u32| {
        let automaton = &flat.automata[automaton];
        let name = automaton
            .modes
            .get(mode as usize)
            .map_or("?", |mode| &mode.name);
        format!("{}.{name}", automaton.name)
    };
    let names = Names {
        exprs: &flat.exprs,
        variables: &flat.variables,
        parameters: &flat.parameters,
        mode: &mode,
        relation: &|_| String::new(),
    };
    let printer = Printer {
        flat,
        names,
        sources,
    };
    let mut out = format!("flat {}\n", flat.name);
    printer.parameters(&mut out);
    printer.variables(&mut out);
    printer.equations(&mut out, "equations", &flat.equations);
    printer.equations(&mut out, "initial equations", &flat.initial_equations);
    printer.modes(&mut out);
    printer.events(&mut out);
    printer.clocks(&mut out);
    printer.experiment(&mut out);
    out
}

struct Printer<'a> {
    flat: &'a FlatModel,
    names: Names<'a>,
    sources: &'a Sources,
}

impl Printer<'_> {
    fn parameters(&self, out: &mut String) {
        heading(out, "parameters", self.flat.parameters.is_empty());
        for parameter in self.flat.parameters.iter() {
            let values: Vec<String> = parameter
                .value
                .iter()
                .map(|&value| self.names.expr(value))
                .collect();
            let value = if values.len() == 1 {
                values.concat()
            } else {
                format!("{{{}}}", values.join(", "))
            };
            let mut notes = String::new();
            if parameter.is_final {
                notes.push_str(" final");
            }
            if parameter.structural {
                notes.push_str(" structural");
            }
            if let Some(prior) = parameter.prior {
                let _ = match prior {
                    crate::Prior::Relative(part) => write!(notes, " ~ ±{}%", part * 100.0),
                    crate::Prior::Absolute(spread) => write!(notes, " ~ ±{spread}"),
                };
            }
            if let Some(source) = &parameter.source {
                let _ = write!(notes, " from {source:?}");
            }
            let unit = unit(&parameter.quantity);
            let origin = comment(&parameter.origin, self.sources);
            let _ = writeln!(out, "  {}{unit} = {value}{notes}{origin}", parameter.name);
        }
    }

    fn variables(&self, out: &mut String) {
        heading(out, "variables", self.flat.variables.is_empty());
        for variable in self.flat.variables.iter() {
            let kind = match variable.kind {
                VariableKind::Continuous if variable.flow => "flow".to_owned(),
                VariableKind::Continuous => "continuous".to_owned(),
                VariableKind::Discrete => "discrete".to_owned(),
                VariableKind::Clocked(clock) => format!("clocked {}", self.flat.clocks[clock].name),
                VariableKind::Held(clock, source) => {
                    format!(
                        "held {} of {}",
                        self.flat.variables[source].name, self.flat.clocks[clock].name
                    )
                }
                VariableKind::Column(column, interpolation) => {
                    let how = if interpolation == Interpolation::Held {
                        "held"
                    } else {
                        "linear"
                    };
                    let column = &self.flat.columns[column];
                    let next = if column.next { ", next row" } else { "" };
                    format!("column {} of {}, {how}{next}", column.column, column.record)
                }
                VariableKind::Delayed(_) => "delayed".to_owned(),
                VariableKind::Reduction(number) => format!("reduction {number}"),
            };
            let dims = variable.len.map_or_else(String::new, |_| {
                let last =
                    i64::from(variable.first) + i64::try_from(variable.size()).unwrap_or(0) - 1;
                format!("[{}..{last}]", variable.first)
            });
            let start = match (variable.start.as_slice(), variable.fixed) {
                ([], _) => String::new(),
                (values, fixed) => {
                    let values: Vec<String> =
                        values.iter().map(|&value| self.names.expr(value)).collect();
                    format!(
                        " start {}{}",
                        values.join(", "),
                        if fixed { " fixed" } else { "" }
                    )
                }
            };
            let unit = unit(&variable.quantity);
            let origin = comment(&variable.origin, self.sources);
            let _ = writeln!(out, "  {kind} {}{dims}{unit}{start}{origin}", variable.name);
        }
    }

    fn equations(&self, out: &mut String, title: &str, equations: &[Equation]) {
        heading(out, title, equations.is_empty());
        for equation in equations {
            let _ = writeln!(out, "  {}", self.equation(equation));
        }
    }

    fn equation(&self, equation: &Equation) -> String {
        let lead = counted(equation.range);
        let (lhs, rhs) = (self.names.expr(equation.lhs), self.names.expr(equation.rhs));
        format!(
            "{lead}{lhs} = {rhs}{}",
            comment(&equation.origin, self.sources)
        )
    }

    fn modes(&self, out: &mut String) {
        for automaton in self.flat.automata.iter() {
            let initial = automaton
                .modes
                .get(automaton.initial)
                .map_or("?", |mode| &mode.name);
            let place = comment(&automaton.origin, self.sources);
            let _ = writeln!(
                out,
                "modes {} initial {initial}{}{place}",
                automaton.name,
                self.actions(&automaton.initial_actions)
            );
            for mode in &automaton.modes {
                let _ = writeln!(out, "  {}", mode.name);
                for equation in &mode.equations {
                    let _ = writeln!(out, "    {}", self.equation(equation));
                }
                for exit in &mode.exits {
                    let target = automaton
                        .modes
                        .get(exit.target)
                        .map_or("?", |mode| &mode.name);
                    let impact = if exit.impact { " impact" } else { "" };
                    let _ = writeln!(
                        out,
                        "    exit {} -> {target}{impact}{}{}",
                        self.names.expr(exit.guard),
                        self.actions(&exit.actions),
                        comment(&exit.origin, self.sources)
                    );
                }
            }
        }
    }

    fn events(&self, out: &mut String) {
        for when in &self.flat.whens {
            for (index, (condition, actions)) in when.branches.iter().enumerate() {
                let word = if index == 0 { "when" } else { "elsewhen" };
                let place = comment(&when.origin, self.sources);
                let _ = writeln!(
                    out,
                    "{word} {}{}{place}",
                    self.names.expr(*condition),
                    self.actions(actions)
                );
            }
        }
        for edge in &self.flat.edges {
            let place = comment(&edge.origin, self.sources);
            let name = &self.flat.variables[edge.var].name;
            let condition = self.names.expr(edge.condition);
            let _ = writeln!(out, "{name}: edge of {condition}{place}");
        }
        for assert in &self.flat.asserts {
            let place = comment(&assert.origin, self.sources);
            let _ = writeln!(
                out,
                "assert {} {:?}{place}",
                self.names.expr(assert.condition),
                assert.message
            );
        }
    }

    fn actions(&self, actions: &[Action]) -> String {
        let mut text = String::new();
        for action in actions {
            let _ = match action {
                Action::Reinit(var, index, value) => {
                    write!(
                        text,
                        " reinit({}, {})",
                        self.names.element(*var, *index),
                        self.names.expr(*value)
                    )
                }
                Action::Assign(var, index, value) => {
                    write!(
                        text,
                        " {} := {}",
                        self.names.element(*var, *index),
                        self.names.expr(*value)
                    )
                }
            };
        }
        text
    }

    fn clocks(&self, out: &mut String) {
        for (id, clock) in self.flat.clocks.enumerate() {
            let _ = writeln!(
                out,
                "clocked {} every {} delay {} phase {}{}",
                clock.name,
                self.names.expr(clock.period),
                self.names.expr(clock.delay),
                self.names.expr(clock.phase),
                comment(&clock.origin, self.sources)
            );
            for item in self
                .flat
                .clocked_equations
                .iter()
                .filter(|item| item.clock == id)
            {
                let _ = writeln!(out, "  {}", self.equation(&item.equation));
            }
        }
    }

    fn recorded(&self, source: &RecordedResponse) -> String {
        match source {
            RecordedResponse::Complex(re, im) => {
                format!("complex({}, {})", self.scaled(re), self.scaled(im))
            }
            RecordedResponse::Polar(gain, phase) => {
                format!("polar({}, {})", self.scaled(gain), self.scaled(phase))
            }
            RecordedResponse::Periodic(input, output, period) => {
                let period = period.map_or_else(String::new, |period| format!(", {period} s"));
                let (input, output) = (self.scaled(input), self.scaled(output));
                format!("response({input}, {output}{period})")
            }
        }
    }

    fn scaled(&self, scaled: &ScaledColumn) -> String {
        let column = &self.flat.columns[scaled.column];
        let factor = match scaled.scale {
            1.0 => String::new(),
            factor => format!("{factor}*"),
        };
        format!("{factor}{}.{}", column.record, column.column)
    }

    fn experiment(&self, out: &mut String) {
        let experiment = &self.flat.experiment;
        if experiment.name.is_empty() {
            return;
        }
        let _ = writeln!(out, "experiment {}", experiment.name);
        for measured in &experiment.measured {
            let column = &self.flat.columns[measured.column];
            let steps: Vec<String> = measured
                .preparation
                .iter()
                .map(|step| match step {
                    Preparation::Lowpass(corner) => format!(", lowpass {corner} Hz"),
                    Preparation::Slope => ", slope".to_owned(),
                    Preparation::Scale(factor) => format!(", times {factor}"),
                })
                .collect();
            let noise = measured.noise.map_or_else(String::new, |noise| {
                format!(" ~ {}", self.names.expr(noise))
            });
            let rounding = measured.rounding.map_or_else(String::new, |width| {
                format!(", rounded within {}", self.names.expr(width))
            });
            let period = measured.period.map_or_else(String::new, |period| {
                format!(", modulo {}", self.names.expr(period))
            });
            let when = if measured.clocked {
                "after the tick"
            } else {
                "before the tick"
            };
            let _ = writeln!(
                out,
                "  measured {}.{}{} = {}{noise}{rounding}{period} {when}{}",
                column.record,
                column.column,
                steps.concat(),
                self.names.expr(measured.value),
                comment(&measured.origin, self.sources)
            );
        }
        for replayed in &experiment.replayed {
            let _ = writeln!(
                out,
                "  {} replayed for {}{}",
                self.names.expr(replayed.recorded),
                self.names.expr(replayed.value),
                comment(&replayed.origin, self.sources)
            );
        }
        for (number, reduction) in experiment.reductions.iter().enumerate() {
            let kind = match reduction.kind {
                ReductionKind::Max => "max",
                ReductionKind::Min => "min",
                ReductionKind::Rms => "rms",
                ReductionKind::Mean => "mean",
                ReductionKind::Integral => "integral",
                ReductionKind::First => "first",
                ReductionKind::Last => "last",
                ReductionKind::Settling => "settling",
                ReductionKind::Resonance => "resonance",
            };
            let _ = writeln!(
                out,
                "  reduction {number} = {kind} of {}{}",
                self.names.expr(reduction.value),
                reduction
                    .condition
                    .map_or(String::new(), |c| format!(" where {}", self.names.expr(c)))
            );
        }
        for measure in &experiment.measures {
            let word = if measure.expectation {
                "expect"
            } else {
                "measure"
            };
            let _ = writeln!(
                out,
                "  {word} {} = {}",
                measure.name,
                self.names.expr(measure.value)
            );
        }
        for bode in &experiment.bodes {
            let outputs: Vec<&str> = bode
                .outputs
                .iter()
                .map(|(name, ..)| name.as_str())
                .collect();
            let input = self.flat.variables[bode.input.0].element_name(bode.input.1);
            let band = bode.band.map_or_else(String::new, |(from, to)| {
                let (from, to) = (self.names.expr(from), self.names.expr(to));
                format!(" over {from} .. {to} Hz")
            });
            let _ = writeln!(out, "  bode from {input} to {}{band}", outputs.join(", "));
        }
        for cut in &experiment.cuts {
            let back = self.names.expr(cut.back);
            let _ = writeln!(out, "  margins of {}: {back} comes back", cut.signal);
        }
        for measured in &experiment.measured_responses {
            let bode = &experiment.bodes[measured.place.0];
            let input = self.flat.variables[bode.input.0].element_name(bode.input.1);
            let output = &bode.outputs[measured.place.1].0;
            let deviation = measured.deviation.as_ref();
            let noise = deviation.map_or_else(String::new, |d| format!(" ~ {}", self.scaled(d)));
            let _ = writeln!(
                out,
                "  measured {} = response({input}, {output}){noise}{}",
                self.recorded(&measured.source),
                comment(&measured.origin, self.sources)
            );
            if let Some(stepped) = &bode.stepped {
                let _ = writeln!(
                    out,
                    "    stepped: {} times {} over {} periods behind {} s",
                    self.names.expr(stepped.points),
                    self.names.expr(stepped.amplitude),
                    self.names.expr(stepped.periods),
                    self.names.expr(stepped.settle),
                );
            }
        }
        for figure in &experiment.figures {
            let curves: Vec<String> = figure
                .curves()
                .map(|curve| self.names.expr(curve.value))
                .collect();
            let _ = writeln!(out, "  figure {} = {}", figure.name, curves.join(", "));
        }
        match experiment.method {
            Method::Ida => out.push_str("  solve ida\n"),
            Method::Esdirk => out.push_str("  solve esdirk\n"),
            Method::Auto => {}
        }
        if experiment.conserve {
            out.push_str("  solve conserve\n");
        }
        for (name, value) in &experiment.solve {
            let _ = writeln!(out, "  solve {name} = {}", self.names.expr(*value));
        }
        if let Some(start) = experiment.start {
            let _ = writeln!(out, "  start {}", self.names.expr(start));
        }
        if let Some(stop) = experiment.stop {
            let _ = writeln!(out, "  stop {}", self.names.expr(stop));
        }
        if let Some(every) = experiment.every {
            let _ = writeln!(out, "  every {}", self.names.expr(every));
        }
    }
}

fn heading(out: &mut String, title: &str, empty: bool) {
    if !empty {
        let _ = writeln!(out, "{title}");
    }
}

/// The unit that the values behind it have: that of SI.
fn unit(quantity: &Quantity) -> String {
    match quantity.unit.si().text() {
        "" | "1" => String::new(),
        text => format!(" [{text}]"),
    }
}
