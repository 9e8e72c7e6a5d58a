//! [`Interface`]: the variables of a model as an FMU shows them, with value references, units, and which is state of which
//! derivative.
//!
//! A value reference is the number of the variable, or of the variable that it is an alias of. The order: time, parameters,
//! inputs, reported quantities, states that are not reported, derivatives of states, guards.

mod aliases;

use hyde_program::{Output, Parameter, Program};
use hyde_study::ports::{chosen_outputs, fixed_places, is_input};
use hyde_units::{Dimension, Kind, NamedUnit};
use std::collections::{BTreeMap, BTreeSet};

/// Where the value of a variable is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The time.
    Time,
    /// The parameter vector.
    Parameter(usize),
    /// An output of the program.
    Output(usize),
    /// The solver's vector.
    State(usize),
    /// The derivative of the solver's vector.
    Derivative(usize),
    /// The root function of a relation.
    Guard(usize),
}

/// What a variable is to the importer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The time.
    Independent,
    /// May be set before the run, or between steps.
    Parameter,
    /// Follows from parameters.
    CalculatedParameter,
    /// Set by the importer.
    Input,
    /// For others to read.
    Output,
    /// Inside.
    Local,
}

/// When its value may change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Variability {
    /// Never.
    Constant,
    /// After the initialisation never.
    Fixed,
    /// Between steps, by the importer.
    Tunable,
    /// At events.
    Discrete,
    /// At any time.
    Continuous,
}

/// A variable.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// What is known of it in words.
    pub description: Option<String>,
    /// What it is to the importer.
    pub causality: Causality,
    /// When it changes.
    pub variability: Variability,
    /// Where its value is.
    pub source: Source,
    /// What kind of values it has.
    pub kind: Kind,
    /// Its unit for people; values are in [`NamedUnit::si`] of it. `None` of a bare number.
    pub unit: Option<NamedUnit>,
    /// The value that it has if the importer sets none.
    pub start: Option<f64>,
    /// The least and the most that it may be.
    pub bounds: (Option<f64>, Option<f64>),
    /// Of a derivative the number of its state.
    pub derivative_of: Option<usize>,
    /// The number of the variable that always has the same value, of which this is another name.
    pub alias_of: Option<usize>,
}

/// The variables of a model.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// All of them; the value reference is the number.
    pub variables: Vec<Variable>,
    /// The states: number of the variable, position in the solver's vector.
    pub states: Vec<(usize, usize)>,
    /// The derivatives of the states, by number of the variable.
    pub derivatives: Vec<usize>,
    /// The guards that an importer watches: number of the variable, relation.
    pub guards: Vec<(usize, usize)>,
    /// Why the importer cannot integrate the model itself, if so.
    pub no_model_exchange: Option<String>,
}

impl Interface {
    /// The variables of a program. Outputs are those named; if none is, the variables of the model itself, or, if it has none,
    /// every reported quantity that is not an element of an array.
    ///
    /// # Errors
    /// A name that is no reported quantity.
    pub fn of(program: &Program, parameters: &[f64], outputs: &[String]) -> Result<Self, String> {
        let chosen = chosen_outputs(program, outputs)?;
        let mut found = Self {
            no_model_exchange: no_model_exchange(program),
            ..Self::default()
        };
        found.variables.push(Variable {
            name: "time".to_owned(),
            causality: Causality::Independent,
            unit: Some(NamedUnit::usual(Dimension::TIME)),
            ..Variable::inside(Source::Time)
        });
        let fixed = fixed_places(program, parameters);
        for parameter in program.parameters.iter().filter(|p| !is_input(program, p)) {
            for element in 0..parameter.len {
                let variable = of_parameter(program, parameter, element, parameters, &fixed);
                found.variables.push(variable);
            }
        }
        for input in program.parameters.iter().filter(|p| is_input(program, p)) {
            found.variables.push(Variable {
                name: input.name.clone(),
                causality: Causality::Input,
                unit: shown_unit(input.dimension, &input.unit),
                start: Some(parameters[input.place]),
                ..Variable::inside(Source::Parameter(input.place))
            });
        }
        let mut names: BTreeMap<String, usize> = BTreeMap::new();
        for (number, variable) in found.variables.iter().enumerate() {
            names.insert(variable.name.clone(), number);
        }
        for (number, output) in program.outputs.iter().enumerate() {
            if output.auxiliary || names.contains_key(&output.name) {
                continue;
            }
            names.insert(output.name.clone(), found.variables.len());
            found.variables.push(of_output(output, number, &chosen));
        }
        if found.no_model_exchange.is_none() {
            found.add_states(program, &names);
        }
        found.find_aliases(program, &names);
        Ok(found)
    }

    /// States, their derivatives and guards.
    fn add_states(&mut self, program: &Program, names: &BTreeMap<String, usize>) {
        for block in program.unknowns.iter().filter(|block| block.differential) {
            for position in block.offset..block.offset + block.len {
                let name = program.unknown_name(position);
                let number = match names.get(&name) {
                    Some(&number) => {
                        self.variables[number].source = Source::State(position);
                        number
                    }
                    None => {
                        self.variables.push(Variable {
                            name: allowed(name),
                            ..Variable::inside(Source::State(position))
                        });
                        self.variables.len() - 1
                    }
                };
                self.states.push((number, position));
            }
        }
        for &(state, position) in &self.states {
            let of = &self.variables[state];
            let unit = of
                .unit
                .as_ref()
                .map_or(Dimension::DIMENSIONLESS, |unit| unit.unit().dimension);
            let unit = NamedUnit::usual(unit.divide(Dimension::TIME));
            let name = derivative_name(&of.name);
            // The model may report the derivative itself.
            let number = match names.get(&name) {
                Some(&number) => number,
                None => {
                    self.variables.push(Variable {
                        name,
                        unit: shown_unit(unit.unit().dimension, &unit),
                        ..Variable::inside(Source::Derivative(position))
                    });
                    self.variables.len() - 1
                }
            };
            self.variables[number].source = Source::Derivative(position);
            self.variables[number].derivative_of = Some(state);
            self.derivatives.push(number);
        }
        let relations = program.relations.iter().enumerate();
        for (number, relation) in relations.filter(|(_, relation)| !relation.scheduled) {
            self.guards.push((self.variables.len(), number));
            self.variables.push(Variable {
                name: format!("hyde.guard[{}]", self.guards.len()),
                description: Some(format!("`{}`", relation.text)),
                ..Variable::inside(Source::Guard(number))
            });
        }
    }

    /// The variables that an importer may ask for before the run has begun, as the standard lists them.
    #[must_use]
    pub fn initial_unknowns(&self) -> Vec<usize> {
        let mut found: BTreeSet<usize> = self.states.iter().map(|(number, _)| *number).collect();
        found.extend(&self.derivatives);
        for (number, variable) in self.variables.iter().enumerate() {
            let asked = match variable.causality {
                Causality::Output => true,
                Causality::CalculatedParameter => true,
                Causality::Independent
                | Causality::Parameter
                | Causality::Input
                | Causality::Local => false,
            };
            if asked {
                found.insert(number);
            }
        }
        found.into_iter().collect()
    }

    /// The numbers of the variables of a causality.
    pub fn with(&self, causality: Causality) -> impl Iterator<Item = usize> + '_ {
        let all = self.variables.iter().enumerate();
        all.filter(move |(_, variable)| variable.causality == causality)
            .map(|(number, _)| number)
    }
}

impl Variable {
    fn inside(source: Source) -> Self {
        Self {
            name: String::new(),
            description: None,
            causality: Causality::Local,
            variability: Variability::Continuous,
            source,
            kind: Kind::Real,
            unit: None,
            start: None,
            bounds: (None, None),
            derivative_of: None,
            alias_of: None,
        }
    }
}

/// The number of the output of a program that an FMU calls so.
pub(crate) fn reported(program: &Program, name: &str) -> Option<usize> {
    let quoted = |output: &Output| allowed(output.name.clone()) == name;
    let found = program.output(name);
    found.or_else(|| program.outputs.iter().position(quoted))
}

/// A name that the standard allows: that of an unknown which the compiler made, as `c.(c.u[i])[5]`, is quoted up to its index.
fn allowed(name: String) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '.' | '[' | ']' | ',');
    let derivative = name.strip_prefix("der(");
    let inner = derivative.and_then(|inner| inner.strip_suffix(')'));
    if inner.unwrap_or(&name).chars().all(plain) {
        return name;
    }
    let (quoted, index) = match name.rfind('[') {
        Some(at) if name.ends_with(']') => name.split_at(at),
        Some(_) | None => (name.as_str(), ""),
    };
    format!("'{}'{index}", quoted.replace(['\'', '\\', '"'], "_"))
}

/// The name of the derivative of a variable, as the standard writes it.
fn derivative_name(of: &str) -> String {
    match of.strip_prefix("der(").and_then(|of| of.strip_suffix(')')) {
        Some(of) => format!("der({of},2)"),
        None => format!("der({of})"),
    }
}

/// Why an importer cannot integrate a program itself.
fn no_model_exchange(program: &Program) -> Option<String> {
    if let Some(selection) = program.selections.first() {
        let names: Vec<String> = selection
            .candidates
            .iter()
            .map(|&position| program.unknown_name(position))
            .collect();
        return Some(format!(
            "the run chooses its states anew among `{}`",
            names.join("`, `")
        ));
    }
    (!program.delays.is_empty())
        .then(|| "the model reads quantities as they were some time ago".to_owned())
}

fn of_output(output: &Output, number: usize, chosen: &BTreeSet<usize>) -> Variable {
    Variable {
        name: allowed(output.name.clone()),
        causality: match chosen.contains(&number) {
            true => Causality::Output,
            false => Causality::Local,
        },
        variability: match output.discrete {
            true => Variability::Discrete,
            false => Variability::Continuous,
        },
        unit: shown_unit(output.dimension, &output.unit),
        ..Variable::inside(Source::Output(number))
    }
}

fn of_parameter(
    program: &Program,
    parameter: &Parameter,
    element: usize,
    parameters: &[f64],
    fixed: &BTreeSet<usize>,
) -> Variable {
    let place = parameter.place + element;
    let from_record = program
        .record_values
        .iter()
        .any(|known| known.place == place);
    let (causality, variability) = if parameter.found || from_record {
        (Causality::CalculatedParameter, Variability::Fixed)
    } else if parameter.structural {
        (Causality::Local, Variability::Constant)
    } else if parameter.is_final {
        (Causality::CalculatedParameter, Variability::Tunable)
    } else if fixed.contains(&place) {
        (Causality::Parameter, Variability::Fixed)
    } else {
        (Causality::Parameter, Variability::Tunable)
    };
    let set = matches!(causality, Causality::Parameter | Causality::Local);
    Variable {
        name: parameter.element_name(element),
        description: parameter.source.clone(),
        causality,
        variability,
        kind: parameter.allowed.kind,
        unit: shown_unit(parameter.dimension, &parameter.unit),
        start: set.then(|| parameters[place]),
        bounds: (parameter.allowed.min, parameter.allowed.max),
        ..Variable::inside(Source::Parameter(place))
    }
}

/// The unit that is told; a bare number has none.
fn shown_unit(dimension: Dimension, unit: &NamedUnit) -> Option<NamedUnit> {
    let bare = dimension.is_dimensionless() && unit.unit().is_si();
    let bare = bare && dimension.si_exponents().is_none_or(|all| all == [0; 8]);
    (!bare).then(|| unit.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_the_compiler_makes_are_quoted() {
        for (name, told) in [
            ("table.a.s", "table.a.s"),
            ("field.u[12]", "field.u[12]"),
            ("der(x)", "der(x)"),
            ("c.(c.u[i])[5]", "'c.(c.u[i])'[5]"),
            ("c.(x*y)", "'c.(x*y)'"),
        ] {
            assert_eq!(allowed(name.to_owned()), told);
        }
        assert_eq!(derivative_name("'c.(c.u[i])'[5]"), "der('c.(c.u[i])'[5])");
    }
}
