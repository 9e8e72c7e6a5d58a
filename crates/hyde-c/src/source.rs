//! The source: tables of the model, its kernels, and the runtime that steps them.

use crate::elimination::{Elimination, differential, places};
use crate::factors::Factors;
use crate::fixed_step::FixedStep;
use crate::names::Names;
use hyde_program::{Coefficients, Function, Program, ReactionKind, RelationUse, Target, Wrt};
use hyde_units::{Allowed, Kind};
use std::fmt::{Display, Write as _};

/// The solution of linear equations and the step, the same for every model; `@NAME@` is the name of the model.
const RUNTIME: [&str; 2] = [include_str!("elimination.c"), include_str!("runtime.c")];

/// The text of `NAME.c`.
pub(crate) fn text(
    model: &FixedStep<'_>,
    names: &Names,
    (order, factors, coefficients): (&Elimination, &Factors, &Coefficients),
    kernels: &str,
) -> String {
    let (program, name) = (model.program, &model.name);
    let mut text = format!(
        "/* The model {} with a fixed step, written by Hyde {}: see {name}.h. */\n\n\
         #include \"{name}.h\"\n\n#include <math.h>\n#include <string.h>\n\n",
        program.name,
        env!("CARGO_PKG_VERSION")
    );
    let scheduled = program.relations.iter().any(|relation| relation.scheduled);
    for (size, value) in [
        ("N", program.n_unknowns),
        ("MEMORY", program.n_memory),
        ("RELATIONS", program.relations.len()),
        ("REACTIONS", program.reactions.len()),
        ("ASSIGNMENTS", program.assignments.len()),
        ("PINS", program.pins.len()),
        ("CLOCKS", program.clocks.len()),
        ("PARAMETERS", program.n_parameters),
        ("HOLDS", program.holds.iter().map(|hold| hold.len).sum()),
        ("PARTIALS", program.partials(Function::Residual).len()),
        ("SCHEDULED", usize::from(scheduled)),
        ("MODES", coefficients.modes.len()),
        ("CURVED", coefficients.curved.len()),
        ("RUNS", runs(program).len()),
    ] {
        let _ = writeln!(text, "#define HY_{size} {value}");
    }
    let _ = writeln!(text, "#define HY_START {:?}\n", model.start_s);
    text.push_str("/* ---- The equations ---- */\n\n");
    text.push_str(kernels);
    ticks(&mut text, program);
    text.push_str("\n/* ---- What the numbers mean ---- */\n\n");
    start(&mut text, model);
    structure(&mut text, program, order);
    table(&mut text, "int", "mode_place", coefficients.modes.iter());
    events(&mut text, program);
    clocks(&mut text, model);
    interface(&mut text, model, names);
    bounds(&mut text, program);
    let coefficient = model
        .inputs
        .iter()
        .map(|input| u8::from(!input.column && is_coefficient(model, input.place, coefficients)));
    table(&mut text, "unsigned char", "input_coefficient", coefficient);
    text.push('\n');
    text.push_str(&factors.text());
    text.push_str(&RUNTIME.join("\n").replace("@NAME@", name));
    text
}

/// Number of `when` clauses.
pub(crate) fn clauses(program: &Program) -> usize {
    let all = program
        .reactions
        .iter()
        .filter_map(|reaction| match reaction.kind {
            ReactionKind::When { clause } => Some(clause + 1),
            ReactionKind::Transition { .. } | ReactionKind::Edge(_) | ReactionKind::Assert(_) => {
                None
            }
        });
    all.max().unwrap_or(0)
}

/// A function that chooses the tick of a clock.
fn ticks(text: &mut String, program: &Program) {
    text.push_str(
        "\nstatic void hy_ticks(int clock, double t, const double *y, const double *yp, const double *z, const double *u,\n    \
         const double *p, double *w, double *out)\n{\n    switch (clock) {\n",
    );
    for clock in 0..program.clocks.len() {
        let _ = writeln!(
            text,
            "    case {clock}:\n        hy_tick_{clock}(t, y, yp, z, u, p, w, out);\n        break;"
        );
    }
    text.push_str(
        "    default:\n        (void)t; (void)y; (void)yp; (void)z; (void)u; (void)p; (void)w; (void)out;\n        break;\n    }\n}\n",
    );
}

fn start(text: &mut String, model: &FixedStep<'_>) {
    let start = &model.start;
    numbers(text, "start_y", &start.y);
    numbers(text, "start_yp", &start.yp);
    numbers(text, "start_z", &start.z);
    numbers(text, "start_p", model.parameters);
    let given = (0..model.program.n_parameters).map(|place| u8::from(model.given.contains(&place)));
    table(text, "unsigned char", "given", given);
}

/// Successive unknowns that are all states or all others: the first, the end, and which.
fn runs(program: &Program) -> Vec<(usize, usize, bool)> {
    let mut found: Vec<(usize, usize, bool)> = Vec::new();
    for (place, own) in differential(program).into_iter().enumerate() {
        match found.last_mut() {
            Some((_, end, differential)) if *differential == own => *end = place + 1,
            _ => found.push((place, place + 1, own)),
        }
    }
    found
}

/// Whether the matrix changes with an input, itself or by parameters that follow from it.
fn is_coefficient(model: &FixedStep<'_>, place: usize, coefficients: &Coefficients) -> bool {
    let used = &coefficients.parameters;
    used.contains(&place) || {
        let kernels = &model.program.kernels;
        let directions = kernels.parameter_directions(&[place], model.parameters);
        let mut along = directions.iter();
        along.any(|along| used.iter().any(|&own| along[own] != 0.0))
    }
}

fn structure(text: &mut String, program: &Program, order: &Elimination) {
    let differential = differential(program);
    let runs = runs(program);
    table(text, "int", "run_first", runs.iter().map(|own| own.0));
    table(text, "int", "run_end", runs.iter().map(|own| own.1));
    let states = runs.iter().map(|own| u8::from(own.2));
    table(text, "unsigned char", "run_differential", states);
    let [row_at, column_at] = [places(&order.equations), places(&order.unknowns)];
    let entries = program.partials(Function::Residual);
    // 0 by an unknown, 1 by a rate, 2 by neither, 3 by a state, which its rate changes.
    let place = |wrt: Wrt| match wrt {
        Wrt::Unknown(column) if differential[column] => (3, column_at[column]),
        Wrt::Unknown(column) => (0, column_at[column]),
        Wrt::Derivative(column) => (1, column_at[column]),
        Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => (2, 0),
    };
    let rows = entries.iter().map(|entry| row_at[entry.row]);
    table(text, "int", "partial_row", rows);
    table(
        text,
        "int",
        "partial_column",
        entries.iter().map(|entry| place(entry.wrt).1),
    );
    table(
        text,
        "unsigned char",
        "partial_kind",
        entries.iter().map(|entry| place(entry.wrt).0),
    );
    table(text, "int", "equation_at", order.equations.iter());
    table(text, "int", "unknown_at", order.unknowns.iter());
}

fn events(text: &mut String, program: &Program) {
    let relations = &program.relations;
    let of_mode = |used: RelationUse| match used {
        RelationUse::Exit(automaton, mode) => (whole(automaton), whole(mode)),
        RelationUse::Equation | RelationUse::When | RelationUse::Assert => (-1, 0),
    };
    table(
        text,
        "int",
        "relation_automaton",
        relations.iter().map(|own| of_mode(own.used).0),
    );
    table(
        text,
        "int",
        "relation_mode",
        relations.iter().map(|own| of_mode(own.used).1),
    );
    table(
        text,
        "unsigned char",
        "relation_equation",
        relations
            .iter()
            .map(|own| u8::from(own.used == RelationUse::Equation)),
    );
    table(
        text,
        "unsigned char",
        "relation_inclusive",
        relations.iter().map(|own| u8::from(own.inclusive)),
    );
    table(
        text,
        "unsigned char",
        "relation_scheduled",
        relations.iter().map(|own| u8::from(own.scheduled)),
    );
    table(
        text,
        "int",
        "automaton_place",
        program.automata.iter().map(|own| own.place),
    );
    let reactions = &program.reactions;
    let numbers = |kind: &ReactionKind| match kind {
        ReactionKind::Transition {
            automaton,
            from,
            to,
            ..
        } => [0, whole(*automaton), whole(*from), whole(*to)],
        ReactionKind::When { clause } => [1, whole(*clause), 0, 0],
        ReactionKind::Edge(place) => [2, whole(*place), 0, 0],
        ReactionKind::Assert(_) => [3, 0, 0, 0],
    };
    for (column, name) in ["kind", "a", "from", "to"].into_iter().enumerate() {
        let values = reactions.iter().map(|own| numbers(&own.kind)[column]);
        table(text, "int", &format!("reaction_{name}"), values);
    }
    table(
        text,
        "int",
        "reaction_first",
        reactions.iter().map(|own| own.assignments.start),
    );
    table(
        text,
        "int",
        "reaction_end",
        reactions.iter().map(|own| own.assignments.end),
    );
    let texts = reactions.iter().map(|own| match &own.kind {
        ReactionKind::Assert(message) => quoted(&format!("{message}: {}", own.text)),
        ReactionKind::Transition { .. } | ReactionKind::When { .. } | ReactionKind::Edge(_) => {
            "\"\"".to_owned()
        }
    });
    strings(text, "reaction_text", texts);
    let target = |target: Target| match target {
        Target::State(place) => (0, place),
        Target::Memory(place) => (1, place),
    };
    let assignments = &program.assignments;
    table(
        text,
        "unsigned char",
        "assignment_memory",
        assignments.iter().map(|own| target(own.target).0),
    );
    table(
        text,
        "int",
        "assignment_place",
        assignments.iter().map(|own| target(own.target).1),
    );
    table(
        text,
        "int",
        "pin_automaton",
        program.pins.iter().map(|own| own.automaton),
    );
    table(
        text,
        "int",
        "pin_mode",
        program.pins.iter().map(|own| own.mode),
    );
    table(
        text,
        "int",
        "pin_state",
        program.pins.iter().map(|own| own.state),
    );
}

fn clocks(text: &mut String, model: &FixedStep<'_>) {
    let program = model.program;
    table(
        text,
        "long long",
        "clock_period",
        model.clocks.iter().map(|own| own.period.max(1)),
    );
    table(
        text,
        "long long",
        "clock_phase",
        model.clocks.iter().map(|own| own.phase),
    );
    table(
        text,
        "long long",
        "clock_delay",
        model.clocks.iter().map(|own| own.delay),
    );
    table(text, "int", "clock_order", program.clock_order.iter());
    let holds = program.holds.iter();
    let each = holds.flat_map(|hold| (0..hold.len).map(move |k| (hold, k)));
    let each: Vec<_> = each.collect();
    table(
        text,
        "int",
        "hold_clock",
        each.iter().map(|(hold, _)| hold.clock),
    );
    table(
        text,
        "int",
        "hold_source",
        each.iter().map(|(hold, k)| hold.source + k),
    );
    table(
        text,
        "int",
        "hold_target",
        each.iter().map(|(hold, k)| hold.target + k),
    );
    table(
        text,
        "unsigned char",
        "hold_read",
        each.iter().map(|(hold, _)| u8::from(hold.read)),
    );
}

fn interface(text: &mut String, model: &FixedStep<'_>, names: &Names) {
    let _ = writeln!(
        text,
        "/* {} inputs, {} parameters, {} outputs. */",
        names.inputs.len(),
        names.parameters.len(),
        names.outputs.len()
    );
    table(
        text,
        "int",
        "input_place",
        model.inputs.iter().map(|own| own.place),
    );
    table(
        text,
        "unsigned char",
        "input_column",
        model.inputs.iter().map(|own| u8::from(own.column)),
    );
    table(
        text,
        "int",
        "parameter_place",
        model.settable.iter().map(|own| own.place),
    );
}

/// The values that the places of the parameters may have.
fn bounds(text: &mut String, program: &Program) {
    let n = program.n_parameters;
    let (mut low, mut high) = (vec![f64::NEG_INFINITY; n], vec![f64::INFINITY; n]);
    let mut is_whole = vec![0_u8; n];
    for parameter in &program.parameters {
        let Allowed { kind, min, max } = parameter.allowed;
        let (least, most) = match kind {
            Kind::Boolean => (0.0, 1.0),
            Kind::Real | Kind::Integer => (f64::NEG_INFINITY, f64::INFINITY),
        };
        for place in parameter.place..parameter.place + parameter.len {
            low[place] = min.unwrap_or(least);
            high[place] = max.unwrap_or(most);
            is_whole[place] = u8::from(kind != Kind::Real);
        }
    }
    numbers(text, "low", &low);
    numbers(text, "high", &high);
    table(text, "unsigned char", "whole", is_whole.iter());
}

fn whole(number: usize) -> i64 {
    i64::try_from(number).unwrap_or(i64::MAX)
}

fn numbers(text: &mut String, name: &str, values: &[f64]) {
    let digits = |value: &f64| match value.is_finite() {
        true => format!("{value:?}"),
        false if value.is_nan() => "NAN".to_owned(),
        false if *value < 0.0 => "-INFINITY".to_owned(),
        false => "INFINITY".to_owned(),
    };
    table(text, "double", name, values.iter().map(digits));
}

/// `static const KIND hy_NAME[] = {…};`, of one element at least.
fn table<T: Display>(text: &mut String, kind: &str, name: &str, values: impl Iterator<Item = T>) {
    let mut values: Vec<String> = values.map(|value| value.to_string()).collect();
    if values.is_empty() {
        values.push("0".to_owned());
    }
    let _ = writeln!(text, "static const {kind} hy_{name}[] = {{");
    for line in values.chunks(12) {
        let _ = writeln!(text, "    {},", line.join(", "));
    }
    text.push_str("};\n");
}

fn strings(text: &mut String, name: &str, values: impl Iterator<Item = String>) {
    let mut values: Vec<String> = values.collect();
    if values.is_empty() {
        values.push("\"\"".to_owned());
    }
    let _ = writeln!(text, "static const char *const hy_{name}[] = {{");
    for value in values {
        let _ = writeln!(text, "    {value},");
    }
    text.push_str("};\n");
}

/// A string of C: ASCII as it is, anything else as `?`.
fn quoted(value: &str) -> String {
    let mut text = "\"".to_owned();
    for letter in value.chars() {
        match letter {
            '"' => text.push_str("\\\""),
            '\\' => text.push_str("\\\\"),
            '?' => text.push_str("\\?"),
            ' '..='~' => text.push(letter),
            _ => text.push('?'),
        }
    }
    text + "\""
}
