//! Parameters, inputs and variables, with units and start values; and the reported quantities that have no variable of their
//! own.

use crate::expression::{is_state, literal};
use crate::names::{Names, column_name, mode_name, quoted};
use crate::{Begun, late, mode_number};
use hyde_ir::dae::{Dae, InitialCondition, Space};
use hyde_ir::{Interpolation, ParamId, Quantity};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// Writes all declarations.
pub(crate) fn write(text: &mut String, dae: &Dae, names: &Names<'_>, begun: &Begun) {
    parameters(text, dae, names);
    for column in 0..dae.columns.len() {
        for interpolation in [Interpolation::Linear, Interpolation::Held] {
            let name = column_name(dae, column, interpolation);
            let _ = writeln!(text, "  input Real {name};");
        }
    }
    let starts = starts(dae);
    let fixed = fixed(dae);
    for unknown in dae.unknowns.iter() {
        let variable = &dae.variables[unknown.var];
        for position in unknown.offset..unknown.offset + unknown.len {
            let mut parts = unit(&variable.quantity);
            let fixed = fixed.contains(&position);
            let jumped = begun.states.get(&position).filter(|_| fixed);
            let declared = starts.get(&(Space::Unknown, position));
            let start = match (jumped, declared) {
                (Some(value), _) => Some(literal(*value)),
                (None, Some((value, counter))) => Some(names.number(*value, *counter)),
                (None, None) => None,
            };
            parts.extend(start.map(|value| format!("start = {value}")));
            if fixed {
                parts.push("fixed = true".to_owned());
            }
            if is_state(dae, position) {
                parts.push("stateSelect = StateSelect.always".to_owned());
            }
            declare(text, "Real", &names.unknown(position), &parts);
        }
    }
    for definition in dae.definitions.iter().filter(|own| !own.slope) {
        let variable = &dae.variables[definition.var];
        for counter in definition.range.iter() {
            let name = names.variable(definition.var, definition.index.at(counter));
            if !names.is_input(&name) {
                declare(text, "Real", &name, &unit(&variable.quantity));
            }
        }
    }
    for delay in dae.delays.iter() {
        let variable = &dae.variables[delay.var];
        for element in 0..i32::try_from(delay.range.len()).unwrap_or(0) {
            let name = names.variable(delay.var, element);
            declare(text, "Real", &name, &unit(&variable.quantity));
        }
    }
    for (var, variable) in dae.variables.enumerate() {
        let Some(place) = dae.place(var).filter(|own| own.space == Space::Memory) else {
            continue;
        };
        for element in 0..variable.size() {
            let name = names.variable(var, i32::try_from(element).unwrap_or(0));
            let mut parts = unit(&variable.quantity);
            let position = place.base + element;
            let declared = starts.get(&(Space::Memory, position));
            let start = match (begun.memory.get(&position), declared) {
                (Some(value), _) => literal(*value),
                (None, Some((value, counter))) => names.number(*value, *counter),
                (None, None) => "0".to_owned(),
            };
            parts.push(format!("start = {start}"));
            parts.push("fixed = true".to_owned());
            declare(text, "discrete Real", &name, &parts);
        }
    }
    late::declare(text, dae, names, begun);
    for automaton in dae.automata.iter() {
        let modes: Vec<String> = automaton
            .modes
            .iter()
            .enumerate()
            .map(|(number, name)| format!("{} {name}", mode_number(number)))
            .collect();
        let left = begun.memory.get(&automaton.place);
        let first = left.map_or(automaton.initial, |mode| *mode as usize);
        let _ = writeln!(
            text,
            "  Integer {}(start = {}, fixed = true) \"{}\";",
            mode_name(&automaton.name),
            mode_number(first),
            comment(&modes.join(", "))
        );
    }
}

/// Reported quantities that are no variables: aliases and expressions. They are declared and defined behind the equations'
/// own variables, so their declarations stand in front of the section.
pub(crate) fn reported(text: &mut String, dae: &Dae, names: &Names<'_>) {
    let known = declared(dae, names);
    let mut own = String::new();
    let mut equations = String::new();
    let mut seen = BTreeSet::new();
    for output in &dae.outputs {
        for (name, counter) in output.names.iter().zip(output.range.iter()) {
            let name = quoted(name);
            if known.contains(&name) || !seen.insert(name.clone()) {
                continue;
            }
            declare(&mut own, "Real", &name, &unit(&output.quantity));
            let value = names.number(output.value, counter);
            let _ = writeln!(equations, "  {name} = {value};");
        }
    }
    if let Some(at) = text
        .find("initial equation\n")
        .or_else(|| text.find("equation\n"))
    {
        text.insert_str(at, &own);
    }
    text.push_str(&equations);
}

fn parameters(text: &mut String, dae: &Dae, names: &Names<'_>) {
    let (found_ones, inputs) = (found_ones(dae), inputs(dae));
    for &param in &dae.parameter_order {
        let parameter = &dae.parameters[param];
        let input = dae.experiment.free.contains(&param);
        for element in 0..parameter.size() {
            let at = i32::try_from(element).unwrap_or(0);
            let name = names.parameter(param, at);
            let value = value_of(dae, names, param, at);
            let mut parts = unit(&parameter.quantity);
            if input {
                parts.push(format!("start = {value}"));
                declare(text, "input Real", &name, &parts);
                continue;
            }
            let found = found_ones.contains(&param) && !inputs.contains(&param);
            if parameter.found {
                parts.push(format!("start = {value}"));
            }
            if found {
                parts.push("fixed = false".to_owned());
            }
            // What the compiler made of others stands for itself, and an input may be in it. The numbers in the class are
            // made with the value of a structural parameter.
            let made = parameter.derived || parameter.is_final || parameter.structural;
            let kind = match (inputs.contains(&param), made && !found) {
                (true, _) => "Real",
                (false, true) => "final parameter Real",
                (false, false) => "parameter Real",
            };
            let about = parameter.source.as_deref().unwrap_or_default();
            let about = match about.is_empty() {
                true => String::new(),
                false => format!(" \"{}\"", comment(about)),
            };
            let parts = match parts.is_empty() {
                true => String::new(),
                false => format!("({})", parts.join(", ")),
            };
            let binding = match found {
                true => String::new(),
                false => format!(" = {value}"),
            };
            let _ = writeln!(text, "  {kind} {name}{parts}{binding}{about};");
        }
    }
}

/// The value of an element of a parameter.
fn value_of(dae: &Dae, names: &Names<'_>, param: ParamId, element: i32) -> String {
    match dae.parameters[param].value.as_slice() {
        [one] => names.number(*one, element),
        each => usize::try_from(element)
            .ok()
            .and_then(|at| each.get(at))
            .map_or_else(|| literal(0.0), |own| names.number(*own, element)),
    }
}

/// The parameters that initial equations find, and those that are made of them.
fn found_ones(dae: &Dae) -> BTreeSet<ParamId> {
    with_what_follows(dae, |param| dae.parameters[param].found)
}

/// The inputs, and the parameters that are made of them.
fn inputs(dae: &Dae) -> BTreeSet<ParamId> {
    with_what_follows(dae, |param| dae.experiment.free.contains(&param))
}

/// Some parameters, and those that are made of them.
fn with_what_follows(dae: &Dae, first: impl Fn(ParamId) -> bool) -> BTreeSet<ParamId> {
    let mut all = BTreeSet::new();
    if dae.parameter_order.iter().any(|&param| first(param)) {
        // Others come behind those that they are made of.
        for &param in &dae.parameter_order {
            if first(param)
                || others_in(dae, param)
                    .iter()
                    .any(|other| all.contains(other))
            {
                all.insert(param);
            }
        }
    }
    all
}

/// The other parameters that the value of a parameter is made of.
fn others_in(dae: &Dae, param: ParamId) -> Vec<ParamId> {
    let below = dae.exprs.below(&dae.parameters[param].value).into_iter();
    let read = below.filter_map(|id| {
        let hyde_ir::Expr::Param(other, _) = dae.exprs[id] else {
            return None;
        };
        (other != param).then_some(other)
    });
    read.collect()
}

/// Names and values of the parameters that follow from those which initial equations find: no binding of Modelica may read
/// these, an initial equation may.
pub(crate) fn found_with_others(dae: &Dae, names: &Names<'_>) -> Vec<(String, String)> {
    let (found, inputs) = (found_ones(dae), inputs(dae));
    let follows = |param: &&ParamId| !dae.parameters[**param].found && !inputs.contains(*param);
    let order = dae.parameter_order.iter();
    let following = order.filter(|param| found.contains(param)).filter(follows);
    let elements = following.flat_map(|&param| {
        let size = i32::try_from(dae.parameters[param].size()).unwrap_or(0);
        (0..size).map(move |element| (param, element))
    });
    elements
        .map(|(param, element)| {
            let name = names.parameter(param, element);
            (name, value_of(dae, names, param, element))
        })
        .collect()
}

fn declare(text: &mut String, kind: &str, name: &str, parts: &[String]) {
    let parts = match parts.is_empty() {
        true => String::new(),
        false => format!("({})", parts.join(", ")),
    };
    let _ = writeln!(text, "  {kind} {name}{parts};");
}

fn unit(quantity: &Quantity) -> Vec<String> {
    match quantity.dimension.usual_unit().as_str() {
        "1" => Vec::new(),
        unit => vec![format!("unit = \"{unit}\"")],
    }
}

fn comment(text: &str) -> String {
    text.replace('\\', "/").replace('"', "'")
}

/// The start values by place, with the value of the counter there.
fn starts(dae: &Dae) -> BTreeMap<(Space, usize), (hyde_ir::ExprId, i32)> {
    let mut found = BTreeMap::new();
    for start in &dae.starts {
        for counter in start.range.iter() {
            let element = usize::try_from(start.index.at(counter)).unwrap_or(0);
            let place = (start.place.space, start.place.base + element);
            found.insert(place, (start.value, counter));
        }
    }
    found
}

/// The states that keep their start values.
fn fixed(dae: &Dae) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for condition in &dae.initial {
        if let InitialCondition::Fixed {
            state,
            len,
            yields: false,
            ..
        } = condition
        {
            found.extend(*state..state + len);
        }
    }
    found
}

/// Every name that has a declaration.
fn declared(dae: &Dae, names: &Names<'_>) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (param, parameter) in dae.parameters.enumerate() {
        for element in 0..parameter.size() {
            found.insert(names.parameter(param, i32::try_from(element).unwrap_or(0)));
        }
    }
    found.extend((0..dae.n_unknowns).map(|position| names.unknown(position)));
    for definition in dae.definitions.iter().filter(|own| !own.slope) {
        let elements = definition.range.iter().map(|c| definition.index.at(c));
        found.extend(elements.map(|element| names.variable(definition.var, element)));
    }
    for (var, variable) in dae.variables.enumerate() {
        let stands = dae.place(var).is_some_and(|own| match own.space {
            Space::Memory | Space::Input => true,
            Space::Unknown | Space::Work | Space::Parameter => false,
        });
        if stands {
            let elements = 0..i32::try_from(variable.size()).unwrap_or(0);
            found.extend(elements.map(|element| names.variable(var, element)));
        }
    }
    for column in 0..dae.columns.len() {
        found.insert(column_name(dae, column, Interpolation::Linear));
    }
    found
}
