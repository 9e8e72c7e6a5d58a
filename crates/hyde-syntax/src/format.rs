//! Prints a tree as source text, one element a line; parsing the result gives the same tree.

use crate::ast::{
    Argument, Binary, Change, Class, ClassBody, ClassKind, Declaration, Declarator, Element,
    Equation, EquationKind, Exit, Experiment, ExperimentItem, Expr, ExprKind, File, Item, Measure,
    Mode, Modes, Prefix, Prior, Range, Reference, SettingValue, Study, StudyItem, StudyKind, Unary,
    UnitText,
};
use std::fmt::Write as _;

/// A whole file.
#[must_use]
pub fn file(file: &File) -> String {
    let mut out = Printer::default();
    if let Some((path, text)) = &file.package {
        out.line(&format!(
            "package {}{};",
            reference(path),
            doc(text.as_deref())
        ));
    }
    for import in &file.imports {
        let everything = if import.everything { ".*" } else { "" };
        out.line(&format!("import {}{everything};", reference(&import.path)));
    }
    for item in &file.items {
        out.text.push('\n');
        out.item(item);
    }
    out.text
}

/// An expression.
#[must_use]
pub fn expression(expr: &Expr) -> String {
    match &expr.kind {
        ExprKind::Number(value, unit) => format!("{}{}", number(*value), bracketed(unit.as_ref())),
        ExprKind::String(text) => quoted(text),
        ExprKind::Boolean(value) => value.to_string(),
        ExprKind::Reference(name) => reference(name),
        ExprKind::Call(name, arguments) => {
            format!("{}{}", reference(name), call_arguments(arguments))
        }
        ExprKind::Unary(op, inner) => {
            let text = within(inner, level(expr) + 1);
            match op {
                Unary::Negative => format!("-{text}"),
                Unary::Positive => format!("+{text}"),
                Unary::Not => format!("not {text}"),
            }
        }
        ExprKind::Binary(op, left, right) => {
            let level = level(expr);
            let right_associative = *op == Binary::Pow;
            let left = within(left, if right_associative { level + 1 } else { level });
            let right = within(right, if right_associative { level } else { level + 1 });
            match op {
                Binary::Mul | Binary::Div | Binary::Pow => format!("{left}{}{right}", symbol(*op)),
                Binary::Add
                | Binary::Sub
                | Binary::Lt
                | Binary::Le
                | Binary::Gt
                | Binary::Ge
                | Binary::Eq
                | Binary::Ne
                | Binary::And
                | Binary::Or => format!("{left} {} {right}", symbol(*op)),
            }
        }
        ExprKind::If(branches, otherwise) => {
            let mut text = String::new();
            for (index, (condition, value)) in branches.iter().enumerate() {
                let word = if index == 0 { "if" } else { "elseif" };
                let _ = write!(
                    text,
                    "{word} {} then {} ",
                    expression(condition),
                    expression(value)
                );
            }
            let _ = write!(text, "else {}", expression(otherwise));
            text
        }
        ExprKind::Array(items, unit) => {
            let items: Vec<String> = items.iter().map(expression).collect();
            format!("{{{}}}{}", items.join(", "), bracketed(unit.as_ref()))
        }
    }
}

#[derive(Default)]
struct Printer {
    text: String,
    indent: usize,
}

impl Printer {
    fn line(&mut self, line: &str) {
        for _ in 0..self.indent {
            self.text.push_str("  ");
        }
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn indented(&mut self, body: impl FnOnce(&mut Self)) {
        self.indent += 1;
        body(self);
        self.indent -= 1;
    }

    fn item(&mut self, item: &Item) {
        match item {
            Item::Type(item) => self.line(&format!(
                "type {} = {}{}{};",
                item.name.text,
                reference(&item.base),
                bracketed(item.unit.as_ref()),
                doc(item.doc.as_deref())
            )),
            Item::Class(class) => self.class(class),
            Item::Experiment(experiment) => self.experiment(experiment),
            Item::Study(study) => self.study(study),
        }
    }

    fn class(&mut self, class: &Class) {
        let word = match class.kind {
            ClassKind::Model => "model",
            ClassKind::Connector => "connector",
            ClassKind::Effect => "effect",
        };
        let name = &class.name.text;
        match &class.body {
            ClassBody::Short {
                base,
                changes,
                effects,
            } => {
                let mut text = format!(
                    "{word} {name} = {}{}",
                    reference(base),
                    modification(changes)
                );
                for (index, used) in effects.iter().enumerate() {
                    let sites: Vec<String> = used.sites.iter().map(reference).collect();
                    let lead = if index == 0 { " with " } else { ", " };
                    let effect = reference(&used.effect);
                    let _ = write!(
                        text,
                        "{lead}{effect}{} on {}",
                        modification(&used.changes),
                        sites.join(", ")
                    );
                }
                self.line(&format!("{text}{};", doc(class.doc.as_deref())));
            }
            ClassBody::Long { host, elements } => {
                let host = host
                    .as_ref()
                    .map_or_else(String::new, |host| format!(" on {}", reference(host)));
                self.line(&format!("{word} {name}{host}{}", doc(class.doc.as_deref())));
                self.elements(elements, true);
                self.line(&format!("end {name};"));
            }
        }
    }

    fn elements(&mut self, elements: &[Element], sections: bool) {
        #[derive(PartialEq)]
        enum Section {
            Declarations,
            Equations,
            InitialEquations,
        }
        let mut section = Section::Declarations;
        for element in elements {
            if sections && matches!(element, Element::Equation(_)) && section != Section::Equations
            {
                self.line("equation");
                section = Section::Equations;
            }
            if matches!(element, Element::InitialEquation(_))
                && section != Section::InitialEquations
            {
                self.line("initial equation");
                section = Section::InitialEquations;
            }
            self.indented(|out| out.element(element));
        }
    }

    fn element(&mut self, element: &Element) {
        match element {
            Element::Extends(base, changes) => {
                self.line(&format!(
                    "extends {}{};",
                    reference(base),
                    modification(changes)
                ));
            }
            Element::Declaration(declaration) => self.line(&declaration_text(declaration)),
            Element::Domain(domain) => self.line(&format!(
                "domain {}({} in {});",
                domain.name.text,
                domain.coordinate.text,
                range(&domain.range)
            )),
            Element::Discretize(item) => self.line(&format!(
                "discretize {} by {}{};",
                item.domain.text,
                item.method.text,
                if item.arguments.is_empty() {
                    String::new()
                } else {
                    call_arguments(&item.arguments)
                }
            )),
            Element::Modes(modes) => self.modes(modes),
            Element::Clocked(clocked) => {
                self.line(&format!(
                    "clocked {}{}",
                    clocked.name.text,
                    call_arguments(&clocked.arguments)
                ));
                self.elements(&clocked.elements, false);
                self.line(&format!("end {};", clocked.name.text));
            }
            Element::Equation(equation) | Element::InitialEquation(equation) => {
                self.equation(equation, "")
            }
            Element::Wrap(site, value) => {
                self.line(&format!(
                    "wrap {} by {};",
                    reference(site),
                    expression(value)
                ));
            }
            Element::Add(equation) => self.equation(equation, "add "),
            Element::Replace(component, by, changes) => self.line(&format!(
                "replace {} by {}{};",
                reference(component),
                reference(by),
                modification(changes)
            )),
            Element::Signature(marks) => {
                let marks: Vec<String> = marks
                    .iter()
                    .map(|(name, arguments)| {
                        let arguments = if arguments.is_empty() {
                            String::new()
                        } else {
                            call_arguments(arguments)
                        };
                        format!("{}{arguments}", name.text)
                    })
                    .collect();
                self.line(&format!("signature {};", marks.join(", ")));
            }
            Element::Confounds(names) => {
                let names: Vec<String> = names.iter().map(reference).collect();
                self.line(&format!("confounds {};", names.join(", ")));
            }
            Element::Measure(measure) => self.line(&measure_text(measure)),
        }
    }

    fn modes(&mut self, modes: &Modes) {
        let name = modes
            .name
            .as_ref()
            .map_or_else(String::new, |name| format!("{} ", name.text));
        let arguments = if modes.arguments.is_empty() {
            String::new()
        } else {
            call_arguments(&modes.arguments)
        };
        self.line(&format!(
            "modes {name}initial {}{arguments} {{",
            modes.initial.text
        ));
        for mode in &modes.modes {
            self.indented(|out| out.mode(mode));
        }
        self.line("}");
    }

    fn mode(&mut self, mode: &Mode) {
        let parameters: Vec<String> = mode
            .parameters
            .iter()
            .map(|(kind, name)| format!("{} {}", reference(kind), name.text))
            .collect();
        let parameters = if parameters.is_empty() {
            String::new()
        } else {
            format!("({})", parameters.join(", "))
        };
        self.line(&format!("mode {}{parameters} {{", mode.name.text));
        self.indented(|out| {
            for equation in &mode.equations {
                out.equation(equation, "");
            }
            for exit in &mode.exits {
                out.exit(exit);
            }
        });
        self.line("}");
    }

    fn exit(&mut self, exit: &Exit) {
        let arguments = if exit.arguments.is_empty() {
            String::new()
        } else {
            call_arguments(&exit.arguments)
        };
        let head = format!(
            "exit {} -> {}{arguments}",
            expression(&exit.guard),
            exit.target.text
        );
        if exit.actions.is_empty() {
            self.line(&format!(
                "{head}{};",
                if exit.impact { " impact" } else { "" }
            ));
        } else {
            self.line(&format!("{head} {{"));
            self.indented(|out| {
                exit.actions
                    .iter()
                    .for_each(|action| out.equation(action, ""))
            });
            self.line("};");
        }
    }

    fn equation(&mut self, equation: &Equation, lead: &str) {
        match &equation.kind {
            EquationKind::Equality { lhs, rhs, place } => {
                let mut text = format!("{lead}{} = {}", expression(lhs), expression(rhs));
                if let Some(place) = place {
                    let end = place
                        .end
                        .as_ref()
                        .map_or_else(String::new, |end| format!(".{}", end.text));
                    let _ = write!(text, " indomain {}{end}", place.domain.text);
                    for (at, force) in &place.loads {
                        let _ = write!(text, " load({}, {})", expression(at), expression(force));
                    }
                }
                self.line(&format!("{text};"));
            }
            EquationKind::Connect(sides) => {
                let sides: Vec<String> = sides.iter().map(reference).collect();
                self.line(&format!("connect({});", sides.join(", ")));
            }
            EquationKind::For {
                counter,
                first,
                last,
                equations,
            } => {
                let bounds = format!("{}:{}", expression(first), expression(last));
                self.line(&format!("for {} in {bounds} loop", counter.text));
                self.block(equations);
                self.line("end for;");
            }
            EquationKind::If {
                branches,
                otherwise,
            } => {
                for (index, (condition, equations)) in branches.iter().enumerate() {
                    let word = if index == 0 { "if" } else { "elseif" };
                    self.line(&format!("{word} {} then", expression(condition)));
                    self.block(equations);
                }
                if !otherwise.is_empty() {
                    self.line("else");
                    self.block(otherwise);
                }
                self.line("end if;");
            }
            EquationKind::When(branches) => {
                for (index, (condition, equations)) in branches.iter().enumerate() {
                    let word = if index == 0 { "when" } else { "elsewhen" };
                    self.line(&format!("{word} {} then", expression(condition)));
                    self.block(equations);
                }
                self.line("end when;");
            }
            EquationKind::Assert(condition, message) => {
                self.line(&format!(
                    "assert({}, {});",
                    expression(condition),
                    quoted(message)
                ));
            }
            EquationKind::Reinit(state, value) => {
                self.line(&format!(
                    "reinit({}, {});",
                    reference(state),
                    expression(value)
                ));
            }
        }
    }

    fn block(&mut self, equations: &[Equation]) {
        self.indented(|out| {
            equations
                .iter()
                .for_each(|equation| out.equation(equation, ""))
        });
    }

    fn experiment(&mut self, experiment: &Experiment) {
        let records: Vec<String> = experiment
            .records
            .iter()
            .map(|record| {
                let every = record
                    .every
                    .as_ref()
                    .map_or_else(String::new, |every| format!(" every {}", expression(every)));
                let default = record
                    .default
                    .as_ref()
                    .map_or_else(String::new, |name| format!(" = {}", quoted(&name.text)));
                format!("record {}{every}{default}", record.name.text)
            })
            .collect();
        let records = if records.is_empty() {
            String::new()
        } else {
            format!("({})", records.join(", "))
        };
        let name = &experiment.name.text;
        self.line(&format!(
            "experiment {name}{records} of {}{}{}",
            reference(&experiment.model),
            modification(&experiment.changes),
            doc(experiment.doc.as_deref())
        ));
        self.indented(|out| {
            experiment
                .items
                .iter()
                .for_each(|item| out.experiment_item(item))
        });
        self.line(&format!("end {name};"));
    }

    fn experiment_item(&mut self, item: &ExperimentItem) {
        let drives = |list: &[crate::ast::Drive]| {
            let texts: Vec<String> = list
                .iter()
                .map(|drive| {
                    format!(
                        "{} = {}",
                        reference(&drive.target),
                        expression(&drive.value)
                    )
                })
                .collect();
            texts.join(", ")
        };
        let line = match item {
            ExperimentItem::Stimulus(list) => format!("stimulus {};", drives(list)),
            ExperimentItem::Replay(list) => format!("replay {};", drives(list)),
            ExperimentItem::Measured(channels) => {
                let texts: Vec<String> = channels
                    .iter()
                    .map(|channel| {
                        let noise = channel
                            .noise
                            .as_ref()
                            .map_or_else(String::new, |noise| format!(" ~ {}", expression(noise)));
                        format!(
                            "{} = {}{noise}{}",
                            expression(&channel.signal),
                            expression(&channel.value),
                            doc(channel.doc.as_deref())
                        )
                    })
                    .collect();
                format!("measured {};", texts.join(", "))
            }
            ExperimentItem::Expect(condition, text) => {
                format!("expect {}{};", expression(condition), doc(text.as_deref()))
            }
            ExperimentItem::Measure(measure) => measure_text(measure),
            ExperimentItem::Solve(method, arguments) => {
                let arguments = if arguments.is_empty() {
                    String::new()
                } else {
                    call_arguments(arguments)
                };
                format!("solve {}{arguments};", method.text)
            }
            ExperimentItem::Stop(at) => format!("stop {};", expression(at)),
            ExperimentItem::Every(step) => format!("every {};", expression(step)),
            ExperimentItem::Skip(time) => format!("skip {};", expression(time)),
            ExperimentItem::Bode(bode) => {
                let outputs: Vec<String> = bode.outputs.iter().map(expression).collect();
                let modes: Vec<String> = bode
                    .modes
                    .iter()
                    .map(|(name, mode)| format!("{} = {}", reference(name), mode.text))
                    .collect();
                let modes = if modes.is_empty() {
                    String::new()
                } else {
                    format!(" in {}", modes.join(", "))
                };
                let (input, band) = (reference(&bode.input), range(&bode.band));
                format!(
                    "bode from {input} to {} over {band}{modes};",
                    outputs.join(", ")
                )
            }
        };
        self.line(&line);
    }

    fn study(&mut self, study: &Study) {
        let (word, of) = match study.kind {
            StudyKind::Calibrate => ("calibrate", "of"),
            StudyKind::Diagnose => ("diagnose", "of calibrate"),
            StudyKind::Sweep => ("sweep", "of"),
        };
        let name = &study.name.text;
        self.line(&format!(
            "{word} {name} {of} {}{}",
            reference(&study.of),
            doc(study.doc.as_deref())
        ));
        self.indented(|out| {
            for item in &study.items {
                let line = match item {
                    StudyItem::Vary(list) => {
                        let texts: Vec<String> = list
                            .iter()
                            .map(|variation| {
                                let within = variation
                                    .within
                                    .as_ref()
                                    .map_or_else(String::new, |r| format!(" in {}", range(r)));
                                let values = variation
                                    .values
                                    .as_ref()
                                    .map_or_else(String::new, |e| format!(" = {}", expression(e)));
                                format!("{}{within}{values}", reference(&variation.target))
                            })
                            .collect();
                        format!("vary {};", texts.join(", "))
                    }
                    StudyItem::Setting(name, values) => {
                        let texts: Vec<String> = values
                            .iter()
                            .map(|value| match value {
                                SettingValue::Everything(path) => format!("{}.*", reference(path)),
                                SettingValue::Expr(expr) => expression(expr),
                            })
                            .collect();
                        format!("{} {};", name.text, texts.join(", "))
                    }
                };
                out.line(&line);
            }
        });
        self.line(&format!("end {name};"));
    }
}

fn declaration_text(declaration: &Declaration) -> String {
    let mut text = String::new();
    for prefix in &declaration.prefixes {
        text.push_str(prefix_word(*prefix));
        text.push(' ');
    }
    text.push_str(&reference(&declaration.type_name));
    text.push_str(&subscripts(&declaration.dims));
    let declarators: Vec<String> = declaration
        .declarators
        .iter()
        .map(declarator_text)
        .collect();
    format!("{text} {};", declarators.join(", "))
}

fn declarator_text(item: &Declarator) -> String {
    let mut text = format!(
        "{}{}{}",
        item.name.text,
        subscripts(&item.dims),
        modification(&item.changes)
    );
    if let Some(domain) = &item.domain {
        let _ = write!(text, " on {}", domain.text);
    }
    if let Some(binding) = &item.binding {
        let _ = write!(text, " = {}", expression(binding));
    }
    text.push_str(&prior_text(item.prior.as_ref()));
    text.push_str(&source_text(item.source.as_deref()));
    if let Some(within) = &item.within {
        let _ = write!(text, " in {}", range(within));
    }
    text.push_str(&doc(item.doc.as_deref()));
    text
}

fn measure_text(measure: &Measure) -> String {
    let value = expression(&measure.value);
    let text = doc(measure.doc.as_deref());
    format!(
        "measure {} {} = {value}{text};",
        reference(&measure.type_name),
        measure.name.text
    )
}

fn modification(changes: &[Change]) -> String {
    if changes.is_empty() {
        return String::new();
    }
    let texts: Vec<String> = changes
        .iter()
        .map(|change| {
            let mut text = String::new();
            if change.each {
                text.push_str("each ");
            }
            if change.is_final {
                text.push_str("final ");
            }
            if let Some(model) = &change.redeclare {
                let _ = write!(text, "redeclare {} ", reference(model));
            }
            text.push_str(&reference(&change.target));
            text.push_str(&modification(&change.changes));
            if let Some(value) = &change.value {
                let _ = write!(text, " = {}", expression(value));
            }
            text.push_str(&prior_text(change.prior.as_ref()));
            text.push_str(&source_text(change.source.as_deref()));
            text
        })
        .collect();
    format!("({})", texts.join(", "))
}

fn call_arguments(arguments: &[Argument]) -> String {
    let texts: Vec<String> = arguments
        .iter()
        .map(|argument| match &argument.name {
            Some(name) => format!("{} = {}", name.text, expression(&argument.value)),
            None => expression(&argument.value),
        })
        .collect();
    format!("({})", texts.join(", "))
}

fn reference(name: &Reference) -> String {
    let parts: Vec<String> = name
        .parts
        .iter()
        .map(|part| format!("{}{}", part.name.text, subscripts(&part.subscripts)))
        .collect();
    parts.join(".")
}

fn subscripts(list: &[Expr]) -> String {
    if list.is_empty() {
        return String::new();
    }
    let texts: Vec<String> = list.iter().map(expression).collect();
    format!("[{}]", texts.join(", "))
}

fn range(range: &Range) -> String {
    format!("{} .. {}", expression(&range.from), expression(&range.to))
}

fn prior_text(prior: Option<&Prior>) -> String {
    prior.map_or_else(String::new, |prior| {
        let unit = if prior.percent {
            "%".to_owned()
        } else {
            bracketed(prior.unit.as_ref())
        };
        format!(" ~ ±{}{unit}", prior.value)
    })
}

fn source_text(source: Option<&str>) -> String {
    source.map_or_else(String::new, |text| format!(" from {}", quoted(text)))
}

fn doc(text: Option<&str>) -> String {
    text.map_or_else(String::new, |text| format!(" {}", quoted(text)))
}

fn quoted(text: &str) -> String {
    format!(
        "\"{}\"",
        text.replace('\\', "\\\\")
            .replace('"', "\\\"")
            .replace('\n', "\\n")
    )
}

fn bracketed(unit: Option<&UnitText>) -> String {
    unit.map_or_else(String::new, |unit| format!(" [{}]", unit.text))
}

fn number(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e5).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        value.to_string()
    }
}

fn prefix_word(prefix: Prefix) -> &'static str {
    match prefix {
        Prefix::Parameter => "parameter",
        Prefix::Constant => "constant",
        Prefix::Final => "final",
        Prefix::Flow => "flow",
        Prefix::Input => "input",
        Prefix::Output => "output",
        Prefix::Replaceable => "replaceable",
        Prefix::Site => "site",
        Prefix::Field => "field",
        Prefix::Size => "size",
        Prefix::Shape => "shape",
    }
}

fn symbol(op: Binary) -> &'static str {
    match op {
        Binary::Add => "+",
        Binary::Sub => "-",
        Binary::Mul => "*",
        Binary::Div => "/",
        Binary::Pow => "^",
        Binary::Lt => "<",
        Binary::Le => "<=",
        Binary::Gt => ">",
        Binary::Ge => ">=",
        Binary::Eq => "==",
        Binary::Ne => "<>",
        Binary::And => "and",
        Binary::Or => "or",
    }
}

/// How tightly an expression binds.
fn level(expr: &Expr) -> u8 {
    match &expr.kind {
        ExprKind::If(..) => 0,
        ExprKind::Binary(op, ..) => match op {
            Binary::Or => 1,
            Binary::And => 2,
            Binary::Lt | Binary::Le | Binary::Gt | Binary::Ge | Binary::Eq | Binary::Ne => 4,
            Binary::Add | Binary::Sub => 5,
            Binary::Mul | Binary::Div => 7,
            Binary::Pow => 8,
        },
        ExprKind::Unary(Unary::Not, _) => 3,
        ExprKind::Unary(Unary::Negative | Unary::Positive, _) => 6,
        ExprKind::Number(..)
        | ExprKind::String(_)
        | ExprKind::Boolean(_)
        | ExprKind::Reference(_)
        | ExprKind::Call(..)
        | ExprKind::Array(..) => 9,
    }
}

fn within(expr: &Expr, least: u8) -> String {
    let text = expression(expr);
    if level(expr) < least {
        format!("({text})")
    } else {
        text
    }
}
