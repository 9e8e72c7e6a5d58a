//! [`Interface`]: the model that stands for an FMU, as text. Its clocked part holds what the FMU is given and gives.
//!
//! ```text
//! model Controller                          parameter T1 Kp = 2;    input T2 u;    output T3 y;
//!   clocked fmu(step)                       Kp_k = Kp;    u_k = sample(u);    y_k = pre(y_k);
//! end Controller;                           y = hold(fmu.y_k);
//! ```
//!
//! The FMU is stepped behind the tick: the run puts its outputs into `y_k`.

use crate::description::{Description, FmuVariable, NumberKind, Role};
use std::collections::BTreeSet;
use std::fmt::Write as _;

/// What an FMU is to a model.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// The source text: a package with one model.
    pub text: String,
    /// The variables of the clocked part that are parameters of the FMU.
    pub parameters: Vec<String>,
    /// Those that are inputs.
    pub inputs: Vec<String>,
    /// Those that are outputs.
    pub outputs: Vec<String>,
    /// The variables of the FMU in the same order: parameters, inputs, outputs, by their number in the description.
    pub variables: [Vec<usize>; 3],
    /// The name of each variable in the model, in the order of the description.
    pub names: Vec<String>,
    /// Names that are written otherwise in the model: in the FMU, in the model.
    pub renamed: Vec<(String, String)>,
}

impl Interface {
    /// The names of its parameters in the model.
    pub fn parameter_names(&self) -> impl Iterator<Item = &str> {
        let [parameters, ..] = &self.variables;
        parameters.iter().map(|&number| self.names[number].as_str())
    }

    /// The interface of a description.
    #[must_use]
    pub fn of(description: &Description, package: &str, model: &str) -> Self {
        let own = description.variables.iter().map(|own| own.name.clone());
        let mut names = Names {
            own: own.collect(),
            ..Names::default()
        };
        let mut found = Self::default();
        let (mut types, mut declared) = (Vec::new(), String::new());
        let (mut clocked, mut ticked) = (String::new(), String::new());
        let mut held = String::new();
        let step = description
            .step
            .map_or_else(String::new, |step| format!(" = {step:?} [s]"));
        let all: Vec<(&FmuVariable, String)> = {
            let variables = description.variables.iter();
            variables.map(|own| (own, names.of(&own.name))).collect()
        };
        for (number, (variable, name)) in all.iter().enumerate() {
            if *name != variable.name {
                found.renamed.push((variable.name.clone(), name.clone()));
            }
            let inside = names.of(&format!("{name}_k"));
            let type_name = type_of(variable, &mut types);
            let dims = variable
                .len
                .map_or_else(String::new, |len| format!("[{len}]"));
            let (start, doc) = (start(variable), doc(variable, name));
            let bound = start
                .as_ref()
                .map_or_else(String::new, |value| format!(" = {value}"));
            let (word, list) = match variable.role {
                Role::Parameter => ("parameter", 0),
                Role::Input => ("input", 1),
                Role::Output => ("output", 2),
            };
            let bound = if variable.role == Role::Parameter {
                bound
            } else {
                String::new()
            };
            let _ = writeln!(declared, "  {word} {type_name} {name}{dims}{bound} {doc};");
            let first = match (variable.role, start) {
                (Role::Output, Some(value)) => {
                    let value = value.replace("true", "1").replace("false", "0");
                    format!("(start = {value})")
                }
                (Role::Output | Role::Parameter | Role::Input, _) => String::new(),
            };
            let kept = match (variable.role, variable.numbers.kind()) {
                (Role::Output, NumberKind::Truth) => "Integer",
                _ => type_name.as_str(),
            };
            let _ = writeln!(clocked, "    {kept} {inside}{dims}{first};");
            let _ = match variable.role {
                Role::Parameter => writeln!(ticked, "    {inside} = {name};"),
                Role::Input => writeln!(ticked, "    {inside} = sample({name});"),
                Role::Output => writeln!(ticked, "    {inside} = pre({inside});"),
            };
            if variable.role == Role::Output {
                // Held are numbers; that of a truth is 0 or 1.
                let truth = if variable.numbers.kind() == NumberKind::Truth {
                    " > 0.5"
                } else {
                    ""
                };
                let _ = writeln!(held, "  {name} = hold(fmu.{inside}){truth};");
            }
            found.variables[list].push(number);
            let lists = [&mut found.parameters, &mut found.inputs, &mut found.outputs];
            lists
                .into_iter()
                .nth(list)
                .into_iter()
                .for_each(|list| list.push(inside.clone()));
        }
        let mut text = format!("package {package};\ntype TStep = Real [s];\n");
        for (number, unit) in types.iter().enumerate() {
            let _ = writeln!(text, "type T{number} = Real [{unit}];");
        }
        let title = quoted(&format!("the FMU of {}", description.model_name));
        let _ = write!(
            text,
            "\nmodel {model} {title}\n  parameter TStep step{step} \"communication step\";\n{declared}  clocked fmu(step)\n{clocked}{ticked}  end fmu;\nequation\n{held}end {model};\n"
        );
        found.text = text;
        found.names = all.into_iter().map(|(_, name)| name).collect();
        found
    }
}

/// The number of the type of a variable; a new one if its unit is new.
fn type_of(variable: &FmuVariable, types: &mut Vec<String>) -> String {
    match variable.numbers.kind() {
        NumberKind::Truth => "Boolean".to_owned(),
        NumberKind::Whole => "Integer".to_owned(),
        NumberKind::Real => {
            let unit = &variable.in_si.unit;
            let known = types.iter().position(|known| known == unit);
            let number = known.unwrap_or_else(|| {
                types.push(unit.clone());
                types.len() - 1
            });
            format!("T{number}")
        }
    }
}

/// The start value in the text of the model.
fn start(variable: &FmuVariable) -> Option<String> {
    let one = |value: f64| -> String {
        match variable.numbers.kind() {
            NumberKind::Truth => if value == 0.0 { "false" } else { "true" }.to_owned(),
            NumberKind::Real => {
                let in_si = &variable.in_si;
                let si = in_si.factor * value + in_si.offset;
                match hyde_units::parse_unit(&in_si.unit) {
                    Ok(unit) if in_si.unit != "1" => {
                        format!("{:?} [{}]", unit.from_si(si), in_si.unit)
                    }
                    Ok(_) | Err(_) => format!("{si:?}"),
                }
            }
            NumberKind::Whole => format!("{value}"),
        }
    };
    match (variable.len, variable.start.as_slice()) {
        (_, []) => None,
        (None, [value, ..]) => Some(one(*value)),
        (Some(len), values) => {
            let values = (0..len).map(|at| one(values[at.min(values.len() - 1)]));
            Some(format!("{{{}}}", values.collect::<Vec<_>>().join(", ")))
        }
    }
}

fn doc(variable: &FmuVariable, name: &str) -> String {
    match (variable.doc.as_str(), name == variable.name) {
        ("", true) => String::new(),
        ("", false) => quoted(&format!("`{}` of the FMU", variable.name)),
        (text, true) => quoted(text),
        (text, false) => quoted(&format!("{text} (`{}` of the FMU)", variable.name)),
    }
}

fn quoted(text: &str) -> String {
    let plain = text.replace(['"', '\\', '\n', '\r'], " ");
    format!("\"{plain}\"")
}

/// Names of a model for those of an FMU, each once. One that is a word of the language keeps it, before others that become
/// this word.
struct Names {
    taken: Vec<String>,
    own: BTreeSet<String>,
}

impl Default for Names {
    fn default() -> Self {
        Self {
            taken: ["step", "fmu", "time", "pi"].map(str::to_owned).to_vec(),
            own: BTreeSet::new(),
        }
    }
}

impl Names {
    fn of(&mut self, name: &str) -> String {
        let mut word = String::new();
        for c in name.chars() {
            match c.is_ascii_alphanumeric() {
                true => word.push(c),
                false if word.ends_with('_') && c != '_' => {}
                false => word.push('_'),
            }
        }
        if !name.ends_with('_') {
            word.truncate(word.trim_end_matches('_').len());
        }
        if word.is_empty() || word.starts_with(|c: char| c.is_ascii_digit()) {
            word.insert(0, 'v');
        }
        if hyde_syntax::is_reserved(&word) {
            word.push('_');
        }
        let mut free = word.clone();
        let mut number = 2;
        while self.taken.contains(&free) || free != name && self.own.contains(&free) {
            free = format!("{word}_{number}");
            number += 1;
        }
        self.taken.push(free.clone());
        free
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words_of_the_language_each_once() {
        let mut names = Names::default();
        let all = [
            ("Kp", "Kp"),
            ("PI.Kp", "PI_Kp"),
            ("PI_Kp", "PI_Kp_2"),
            ("y[1]", "y_1"),
            ("der(x)", "der_x"),
            ("model", "model_"),
            ("1st", "v1st"),
            ("step", "step_2"),
            ("\u{3b1}", "v"),
        ];
        for (name, word) in all {
            assert_eq!(names.of(name), word, "{name}");
        }
        let mut names = Names {
            own: BTreeSet::from(["T.in".to_owned(), "T_in".to_owned()]),
            ..Names::default()
        };
        assert_eq!(
            names.of("T.in"),
            "T_in_2",
            "the word is that of another one"
        );
        assert_eq!(names.of("T_in"), "T_in");
    }
}
