//! What a model consists of and how it is connected: the components of its class and of those that it extends, `connect`ed
//! or reading each other. It is read from the trees, before anything is flattened, so that it shows what was written.

use hyde_syntax::ast::{
    self, Change, Class, ClassBody, ClassKind, Declaration, Declarator, Element, Equation,
    EquationKind, Expr, ExprKind, Prefix, Reference,
};
use hyde_syntax::{FileIndex, Lookup};

/// Components and how they hang together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Topology {
    /// In the order in which they are declared; inputs of the model among them.
    pub parts: Vec<Part>,
    /// Connections: the parts that meet at one, each once.
    pub joints: Vec<Vec<usize>>,
    /// Signals: which part is read, and which reads it.
    pub signals: Vec<(usize, usize)>,
}

/// A component, or an input of the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its name, with the number of its elements if it is an array: `D[6]`.
    pub name: String,
    /// Its class; empty for an input.
    pub class: String,
}

/// The topology of a model by its name in the first of some files; empty where there is no such model.
#[must_use]
pub fn topology(lookup: Lookup<'_>, model: &str) -> Topology {
    let mut reader = Reader {
        lookup,
        names: Vec::new(),
        classes: Vec::new(),
        blocks: Vec::new(),
        values: Vec::new(),
        found: Topology::default(),
    };
    let own = lookup.files.first().and_then(|(_, file)| {
        let mut classes = file.items.iter().filter_map(|item| match item {
            hyde_syntax::ast::Item::Class(class) => Some(class),
            hyde_syntax::ast::Item::Type(_)
            | hyde_syntax::ast::Item::Experiment(_)
            | hyde_syntax::ast::Item::Study(_) => None,
        });
        classes.find(|class| class.name.text == model)
    });
    if let Some(class) = own {
        let bodies = reader.bodies(0, class, 0);
        for (file, elements) in &bodies {
            reader.parts(*file, elements);
        }
        for (_, elements) in &bodies {
            reader.values(elements);
        }
        for (_, elements) in &bodies {
            reader.links(elements);
        }
    }
    reader.found
}

/// So deep a model may extend another.
const DEEPEST: usize = 20;

struct Reader<'a> {
    lookup: Lookup<'a>,
    /// Names of the parts without subscripts, and their classes with the files of these.
    names: Vec<&'a str>,
    classes: Vec<Option<(FileIndex, &'a Class)>>,
    /// Names of clocked blocks, which stand before those of what is in them.
    blocks: Vec<&'a str>,
    /// Variables of the model itself, with what they are: whoever reads one reads that.
    values: Vec<(&'a str, &'a Expr)>,
    found: Topology,
}

impl<'a> Reader<'a> {
    /// The elements of a class, those that it extends first.
    fn bodies(
        &self,
        file: FileIndex,
        class: &'a Class,
        depth: usize,
    ) -> Vec<(FileIndex, Vec<&'a Element>)> {
        let base = |name: &Reference| match self.lookup.class(file, name) {
            Some((file, class)) if depth < DEEPEST => self.bodies(file, class, depth + 1),
            _ => Vec::new(),
        };
        match &class.body {
            ClassBody::Short { base: name, .. } => base(name),
            ClassBody::Long { elements, .. } => {
                let all = flat(elements);
                let mut bodies: Vec<_> = all
                    .iter()
                    .filter_map(|element| {
                        let Element::Extends(name, _) = element else {
                            return None;
                        };
                        Some(base(name))
                    })
                    .flatten()
                    .collect();
                bodies.push((file, all));
                bodies
            }
        }
    }

    /// Takes note of components and inputs.
    fn parts(&mut self, file: FileIndex, elements: &[&'a Element]) {
        for element in elements {
            if let Element::Clocked(clocked) = element {
                self.blocks.push(&clocked.name.text);
            }
            let Element::Declaration(declaration) = element else {
                continue;
            };
            let quantity = self.lookup.type_item(file, &declaration.type_name);
            let class = self.lookup.class(file, &declaration.type_name);
            let class = class.filter(|(_, class)| class.kind == ClassKind::Model);
            let is_input = declaration.prefixes.contains(&Prefix::Input);
            for declared in &declaration.declarators {
                // `Force` is a type and a model.
                let is_component = quantity.is_none()
                    || declaration.prefixes.is_empty() && means_component(declared, elements);
                let class = class.filter(|_| is_component);
                if class.is_none() && !is_input {
                    continue;
                }
                let dims = if declared.dims.is_empty() {
                    &declaration.dims
                } else {
                    &declared.dims
                };
                self.names.push(&declared.name.text);
                self.classes.push(class);
                self.found.parts.push(Part {
                    name: format!("{}{}", declared.name.text, subscripts(dims)),
                    class: class.map_or(String::new(), |(_, class)| class.name.text.clone()),
                });
            }
        }
    }

    /// Takes note of the variables that are given a value by an expression.
    fn values(&mut self, elements: &[&'a Element]) {
        for element in elements {
            if let Element::Declaration(declaration) = element {
                for declared in &declaration.declarators {
                    if let Some(value) = &declared.binding {
                        self.value(&declared.name.text, value);
                    }
                }
            }
            if let Element::Equation(equation) = element
                && let EquationKind::Equality { lhs, rhs, .. } = &equation.kind
                && let ExprKind::Reference(name) = &lhs.kind
                && let [only] = self.inner(name)
            {
                self.value(&only.name.text, rhs);
            }
        }
    }

    fn value(&mut self, name: &'a str, value: &'a Expr) {
        if self.part(name).is_none() {
            self.values.push((name, value));
        }
    }

    /// Takes note of connections and of who reads whom.
    fn links(&mut self, elements: &[&'a Element]) {
        for element in elements {
            if let Element::Declaration(declaration) = element {
                self.declared(declaration);
            }
            if let Element::Equation(equation) = element {
                self.equation(equation);
            }
        }
    }

    fn declared(&mut self, declaration: &'a Declaration) {
        for declared in &declaration.declarators {
            let Some(reader) = self.part(&declared.name.text) else {
                continue;
            };
            for change in &declared.changes {
                self.change(change, reader);
            }
        }
    }

    fn change(&mut self, change: &'a Change, reader: usize) {
        for inner in &change.changes {
            self.change(inner, reader);
        }
        if let Some(value) = &change.value {
            self.reads(value, reader);
        }
    }

    fn equation(&mut self, equation: &'a Equation) {
        match &equation.kind {
            EquationKind::Connect(ends) => {
                let mut joint: Vec<usize> = Vec::new();
                for end in ends.iter().filter_map(|end| self.inner(end).first()) {
                    let part = self.part(&end.name.text);
                    joint.extend(part.filter(|part| !joint.contains(part)));
                }
                if joint.len() > 1 && !self.found.joints.contains(&joint) {
                    self.found.joints.push(joint);
                }
            }
            EquationKind::Equality { lhs, rhs, .. } => {
                if let ExprKind::Reference(name) = &lhs.kind
                    && let Some(first) = self.inner(name).first()
                    && let Some(reader) = self.part(&first.name.text)
                {
                    self.reads(rhs, reader);
                }
            }
            EquationKind::For { equations, .. } => {
                equations.iter().for_each(|inner| self.equation(inner));
            }
            EquationKind::If {
                branches,
                otherwise,
            } => {
                let inner = branches.iter().flat_map(|(_, equations)| equations);
                inner.chain(otherwise).for_each(|own| self.equation(own));
            }
            EquationKind::When(_) | EquationKind::Assert(..) | EquationKind::Reinit(..) => {}
        }
    }

    /// Takes note of what an expression reads for a part: variables of other parts, not their parameters.
    fn reads(&mut self, value: &'a Expr, reader: usize) {
        let mut seen: Vec<&str> = Vec::new();
        let mut open = vec![value];
        while let Some(value) = open.pop() {
            let children = value.children();
            open.extend(children.into_iter().rev());
            let ExprKind::Reference(name) = &value.kind else {
                continue;
            };
            let Some(first) = self.inner(name).first() else {
                continue;
            };
            let word = first.name.text.as_str();
            if let Some(read) = self.part(word) {
                let signal = (read, reader);
                let known = self.found.signals.contains(&signal);
                if read != reader && !known && !self.is_parameter(read, name) {
                    self.found.signals.push(signal);
                }
            } else if !seen.contains(&word) {
                seen.push(word);
                let own = self.values.iter().filter(|(name, _)| *name == word);
                open.extend(own.map(|(_, value)| *value));
            }
        }
    }

    /// A name without that of the clocked block in which it is declared.
    fn inner<'n>(&self, name: &'n Reference) -> &'n [ast::Part] {
        match name.parts.as_slice() {
            [first, inner @ ..]
                if !inner.is_empty() && self.blocks.contains(&first.name.text.as_str()) =>
            {
                inner
            }
            all => all,
        }
    }

    /// Whether a name is that of a parameter of a part, or of one in it.
    fn is_parameter(&self, part: usize, name: &Reference) -> bool {
        let (Some((file, class)), [_, own, ..]) = (self.classes[part], self.inner(name)) else {
            return false;
        };
        let bodies = self.bodies(file, class, 0);
        let mut declarations = bodies.iter().flat_map(|(_, elements)| elements);
        declarations.any(|element| {
            let Element::Declaration(declaration) = element else {
                return false;
            };
            let mut constant = [Prefix::Parameter, Prefix::Constant].iter();
            let mut declared = declaration.declarators.iter();
            constant.any(|prefix| declaration.prefixes.contains(prefix))
                && declared.any(|declared| declared.name.text == own.name.text)
        })
    }

    fn part(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| *known == name)
    }
}

/// Whether what is declared with a word that is a type and a model is a component: it is modified as one, or connected.
fn means_component(declared: &Declarator, elements: &[&Element]) -> bool {
    if declared.binding.is_some() || !declared.changes.is_empty() {
        return declared.binding.is_none() && declared.is_modified();
    }
    let is_end = |end: &Reference| {
        let first = end.parts.first();
        first.is_some_and(|first| first.name.text == declared.name.text)
    };
    elements.iter().any(|element| {
        if let Element::Equation(equation) = element
            && let EquationKind::Connect(ends) = &equation.kind
        {
            ends.iter().any(is_end)
        } else {
            false
        }
    })
}

/// The elements, those of clocked blocks behind these.
fn flat(elements: &[Element]) -> Vec<&Element> {
    elements
        .iter()
        .flat_map(|element| {
            let inner = if let Element::Clocked(clocked) = element {
                flat(&clocked.elements)
            } else {
                Vec::new()
            };
            std::iter::once(element).chain(inner)
        })
        .collect()
}

/// The dimensions of an array as text, where they are plain numbers: `[6]`.
fn subscripts(dims: &[Expr]) -> String {
    let dims: Vec<String> = dims
        .iter()
        .map(|dim| {
            if let ExprKind::Number(value, None) = &dim.kind {
                value.to_string()
            } else if let ExprKind::Reference(name) = &dim.kind {
                name.dotted()
            } else {
                "…".to_owned()
            }
        })
        .collect();
    match dims.is_empty() {
        true => String::new(),
        false => format!("[{}]", dims.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_diag::{Diagnostics, Sources};

    /// The topology of the model `Whole` of a text.
    fn found(text: &str) -> Topology {
        let mut sources = Sources::default();
        let file = sources.add("whole.hyde", text);
        let mut diagnostics = Diagnostics::default();
        let tree = hyde_syntax::parse(&sources, file, &mut diagnostics);
        let files = [(file, std::sync::Arc::new(tree))];
        topology(Lookup { files: &files }, "Whole")
    }

    #[test]
    fn a_signal_leads_through_variables_and_clocked_blocks() {
        let found = found(
            "type Force = Real [N];\nmodel Force \"\"\n  Real f;\nend Force;\n\
            model Part\n  Real x, y;\nend Part;\n\
            model Whole\n  input Force F;\n  parameter Force limit = 1 [N];\n  Part motor, sensor;\n  Real half;\n  Force drag = 2*F;\n  \
            Force push(f = limit), pull;\n  \
            clocked cnc(1 [ms])\n    Real count = sample(sensor.y);\n    Part control(x = 2*count);\n  end cnc;\n\
            equation\n  connect(push.a, pull.a);\n  half = F/2;\n  motor.x = hold(cnc.control.y) + half;\n  sensor.x = motor.y;\nend Whole;\n",
        );
        let names: Vec<&str> = found.parts.iter().map(|part| part.name.as_str()).collect();
        // `Force` is a type and a model: the limit and the drag are numbers, what is modified and connected are components.
        assert_eq!(names, ["F", "motor", "sensor", "push", "pull", "control"]);
        let mut signals = found.signals;
        signals.sort_unstable();
        assert_eq!(signals, [(0, 1), (1, 2), (2, 5), (5, 1)]);
    }

    #[test]
    fn components_connections_and_signals_are_those_that_are_written() {
        let text = "model Part \"\"\n  parameter Real k = 1;\n  Real x, y;\nend Part;\n\
            model Base\n  input Real u;\n  Part first(x = u);\nend Base;\n\
            model Whole\n  extends Base;\n  Part second(x = first.y*first.k, y = first.k), third[2];\nequation\n  \
            connect(first.a, second.b, third[1].a);\n  second.y = third[1].y;\nend Whole;\n";
        let found = found(text);
        let names: Vec<&str> = found.parts.iter().map(|part| part.name.as_str()).collect();
        assert_eq!(names, ["u", "first", "second", "third[2]"]);
        assert_eq!(found.parts[0].class, "");
        assert_eq!(found.parts[3].class, "Part");
        assert_eq!(found.joints, [vec![1, 2, 3]]);
        // A parameter is not a signal.
        assert_eq!(found.signals, [(0, 1), (1, 2), (3, 2)]);
        assert_eq!(
            self::found("model Other\nend Other;\n"),
            Topology::default()
        );
    }
}
