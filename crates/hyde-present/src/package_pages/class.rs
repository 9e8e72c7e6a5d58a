//! What stands on a page of a model, connector, effect or function; of the types and the experiments of a package.

use super::Library;
use super::html::{code, documentation, escaped, table};
use super::inherited::{Changed, Inherited, texts};
use super::links::Links;
use hyde_diag::Span;
use hyde_syntax::ast::{
    self, Argument, Class, ClassBody, ClassKind, Declaration, Declarator, Declared, Element, Item,
    Prefix,
};

/// The section of a class.
pub(super) fn class(class: &Class, number: usize, library: &Library, links: &Links<'_>) -> String {
    let name = &class.name.text;
    let word = class.kind.word();
    let mut html = format!("<section id=\"{name}\">\n<h3>{name} <small>{word}</small></h3>\n");
    html += &documentation(class.doc.as_deref().unwrap_or_default());
    match &class.body {
        ClassBody::Short { base, .. } => {
            html += &format!(
                "<p class=\"note\">a short form of {}</p>\n",
                links.to_class(number, base)
            );
            html += &written(&[library.sources.text(class.span)]);
        }
        ClassBody::Long { host, elements } => {
            if let Some(host) = host {
                let host = links.to_class(number, host);
                html += &format!("<p class=\"note\">on {host}</p>\n");
            }
            let mut members = Members {
                library,
                links,
                tables: Default::default(),
            };
            html += &members.extended(elements, number);
            members.of_elements(elements, number, &Inherited::default());
            html += &members.html();
            html += &written(&equations(elements, library));
            html += &initial(elements, library);
            html += &marks(elements);
            html += &fits_on(class, number, library, links);
        }
    }
    html + "</section>\n"
}

/// The table of a package's types.
pub(super) fn types(file: &ast::File) -> String {
    let rows: Vec<Vec<String>> = file
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Type(item) => Some(vec![
                format!("<span id=\"type-{0}\">{0}</span>", item.name.text),
                item.unit
                    .as_ref()
                    .map_or_else(|| item.base.dotted(), |unit| escaped(&unit.text)),
                code(item.doc.as_deref().unwrap_or_default()),
            ]),
            Item::Class(_) | Item::Experiment(_) | Item::Study(_) => None,
        })
        .collect();
    table(&["type", "unit", ""], &rows)
}

/// The table of a package's experiments.
pub(super) fn experiments(file: &ast::File, number: usize, links: &Links<'_>) -> String {
    let rows: Vec<Vec<String>> = file
        .items
        .iter()
        .filter_map(|item| match item {
            Item::Experiment(item) => Some(vec![
                item.name.text.clone(),
                links.to_class(number, &item.model),
                code(item.doc.as_deref().unwrap_or_default()),
            ]),
            Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        })
        .collect();
    table(&["experiment", "of", ""], &rows)
}

/// The kinds of members in the order of a page: heading, and what the columns of types, of values and of changes are there.
const TABLES: [(&str, [&str; 3]); 6] = [
    ("Connectors", ["", "", ""]),
    ("Inputs and outputs", ["type", "value", "attributes"]),
    ("Sizes and shapes", ["type", "value", "attributes"]),
    ("Parameters", ["type", "default", "attributes"]),
    ("Parts", ["model", "", "modified"]),
    ("Variables and sites", ["type", "value", "attributes"]),
];

struct Members<'l> {
    library: &'l Library,
    links: &'l Links<'l>,
    tables: [Vec<Vec<String>>; 6],
}

impl<'l> Members<'l> {
    fn of_elements(&mut self, elements: &'l [Element], number: usize, inherited: &Inherited<'l>) {
        for element in elements {
            if let Element::Extends(base, changes) = element
                && let Some((number, class)) = self.links.class(number, base)
                && let ClassBody::Long { elements, .. } = &class.body
                && let Some(inherited) = inherited.through(class, changes)
            {
                self.of_elements(elements, number, &inherited);
            }
            for (name, declared) in element.declared() {
                match declared {
                    Declared::Variable(declaration, item) => {
                        self.variable((declaration, item), number, inherited);
                    }
                    Declared::Clocked(clocked) => {
                        let inherited = inherited.in_part(&name.text);
                        self.of_elements(&clocked.elements, number, &inherited);
                    }
                    Declared::Domain(_)
                    | Declared::Coordinate(_)
                    | Declared::Modes(_)
                    | Declared::Measure(..) => {}
                }
            }
        }
    }

    /// What a class extends, with the changes written there.
    fn extended(&self, elements: &[Element], number: usize) -> String {
        let mut html = String::new();
        for element in elements {
            let Element::Extends(base, changes) = element else {
                continue;
            };
            let name = self.links.to_class(number, base);
            let changes = texts(&self.library.sources, changes);
            let with = match changes.is_empty() {
                true => String::new(),
                false => format!(" with <code>{}</code>", escaped(&changes)),
            };
            let unknown = match self.links.class(number, base) {
                Some(_) => "",
                None => "; its members are not shown",
            };
            html += &format!("<p class=\"note\">extends {name}{with}{unknown}</p>\n");
        }
        html
    }

    fn variable(
        &mut self,
        (declaration, item): (&'l Declaration, &'l Declarator),
        number: usize,
        inherited: &Inherited<'l>,
    ) {
        let changed = inherited.changed(&self.library.sources, &item.name.text);
        let has = |prefix| declaration.prefixes.contains(&prefix);
        let class = self.links.class(number, &declaration.type_name);
        let quantity = [Prefix::Flow, Prefix::Site, Prefix::Field];
        let part = class.filter(|_| item.binding.is_none() && !quantity.into_iter().any(has));
        let kind = match part {
            _ if has(Prefix::Size) || has(Prefix::Shape) => 2,
            _ if has(Prefix::Parameter) || has(Prefix::Constant) => 3,
            _ if has(Prefix::Input) || has(Prefix::Output) => 1,
            Some((_, class)) if class.kind == ClassKind::Connector => 0,
            Some(_) => 4,
            None => 5,
        };
        let of = match kind {
            0 | 4 if let Some(model) = changed.model => escaped(&model.dotted()),
            0 | 4 => self.links.to_class(number, &declaration.type_name),
            _ => self.links.to_quantity(number, &declaration.type_name),
        };
        let unit = self.links.unit(number, &declaration.type_name);
        let from = inherited.from(&changed);
        let row = self.row(declaration, item, (of, unit), (changed, from));
        self.tables[kind].push(row);
    }

    /// The cells of a member, those of [`Self::heads`]; `of` is its type or model.
    fn row(
        &self,
        declaration: &Declaration,
        item: &Declarator,
        (of, unit): (String, String),
        (changed, from): (Changed<'_>, Option<String>),
    ) -> Vec<String> {
        let text =
            |span: Span| format!("<code>{}</code>", escaped(self.library.sources.text(span)));
        let expr = |expr: Option<&ast::Expr>| expr.map_or_else(String::new, |e| text(e.span));
        let dims: Vec<&str> = item
            .dims
            .iter()
            .chain(&declaration.dims)
            .map(|dim| self.library.sources.text(dim.span))
            .collect();
        let dims = if dims.is_empty() {
            String::new()
        } else {
            format!("[{}]", escaped(&dims.join(", ")))
        };
        let words = declaration.prefixes.iter();
        let words = words.filter(|prefix| **prefix != Prefix::Parameter);
        let words: Vec<&str> = words.map(|prefix| prefix.word()).collect();
        let name = format!(
            "<b>{}</b>{dims}{}",
            item.name.text,
            words
                .iter()
                .map(|word| format!(" <i>{word}</i>"))
                .collect::<String>()
        );
        let inherited = from.map_or_else(String::new, |from| format!(" <i>{}</i>", code(&from)));
        let doc = code(item.doc.as_deref().unwrap_or_default()) + &inherited;
        let range = item.within.as_ref().map(|range| {
            let (from, to) = (text(range.from.span), text(range.to.span));
            format!("{from} … {to}")
        });
        // The spread and the source of the declared value are not those of another one.
        let (value, prior, source) = match changed.value {
            Some(value) => (Some(value), changed.prior, changed.source),
            None => (
                item.binding.as_ref(),
                item.prior.as_ref(),
                item.source.as_deref(),
            ),
        };
        let spread = prior.map(|prior| {
            let spread = self.library.sources.text(prior.span);
            escaped(spread.trim_start_matches(['~', ' ']))
        });
        let over: Vec<String> = item.over.iter().map(|own| self.over(own)).collect();
        vec![
            name,
            of,
            unit,
            expr(value),
            range.unwrap_or_default(),
            spread.unwrap_or_default(),
            changed
                .with(&self.library.sources, &item.changes)
                .join(", "),
            over.join(", "),
            code(source.unwrap_or_default()),
            doc,
        ]
    }

    /// `place = a.s`, or of a shape the `place` alone.
    fn over(&self, own: &Argument) -> String {
        let value = self.library.sources.text(own.value.span);
        let name = own.name.as_ref().map(|name| format!("{} = ", name.text));
        format!(
            "<code>{}</code>",
            escaped(&(name.unwrap_or_default() + value))
        )
    }

    /// The heads of columns.
    fn heads([of, value, changes]: [&str; 3]) -> [&str; 10] {
        [
            "name",
            of,
            "unit",
            value,
            "range",
            "spread",
            changes,
            "a law is over",
            "source",
            "",
        ]
    }

    fn html(&self) -> String {
        TABLES
            .iter()
            .zip(&self.tables)
            .filter(|(_, rows)| !rows.is_empty())
            .map(|((heading, heads), rows)| {
                let list = match *heading {
                    "Connectors" => format!("<p>{}</p>\n", inline(rows)),
                    _ => table(&Self::heads(*heads), rows),
                };
                format!("<h4>{heading}</h4>\n{list}")
            })
            .collect()
    }
}

/// `a` Rail (what it is), `b` Rail
fn inline(rows: &[Vec<String>]) -> String {
    let texts: Vec<String> = rows
        .iter()
        .map(|row| match (row.first(), row.get(1), row.last()) {
            (Some(name), Some(kind), Some(doc)) if !doc.is_empty() => {
                format!("{name} {kind} ({})", doc.trim())
            }
            (Some(name), Some(kind), _) => format!("{name} {kind}"),
            _ => String::new(),
        })
        .collect();
    texts.join(", ")
}

/// What an effect leaves in a record, and what it is easily taken for.
fn marks(elements: &[Element]) -> String {
    let mut html = String::new();
    for element in elements {
        let text = match element {
            Element::Signature(marks) => {
                let names: Vec<&str> = marks.iter().map(|(name, _)| name.text.as_str()).collect();
                format!("leaves a mark over {}", names.join(", "))
            }
            Element::Confounds(names) => {
                let names: Vec<String> = names.iter().map(ast::Reference::dotted).collect();
                format!("easily taken for {}", names.join(", "))
            }
            Element::Extends(..)
            | Element::Declaration(_)
            | Element::Domain(_)
            | Element::Discretize(_)
            | Element::Modes(_)
            | Element::Clocked(_)
            | Element::Equation(_)
            | Element::InitialEquation(_)
            | Element::Wrap(..)
            | Element::Add(_)
            | Element::Replace(..)
            | Element::Measure(_)
            | Element::Account(..) => continue,
        };
        html += &format!("<p class=\"note\">{}</p>\n", escaped(&text));
    }
    html
}

/// Equations, modes and what an effect does, as written.
fn equations<'l>(elements: &'l [Element], library: &'l Library) -> Vec<&'l str> {
    let mut found = Vec::new();
    for element in elements {
        let span = match element {
            Element::Equation(equation) | Element::Add(equation) => equation.span,
            Element::Modes(modes) => modes.span,
            Element::Clocked(clocked) => clocked.span,
            Element::Wrap(site, value) => site.span.to(value.span),
            Element::Replace(component, by, _) => component.span.to(by.span),
            Element::Domain(domain) => domain.name.span.to(domain.range.to.span),
            Element::Account(_, entry) => entry.type_name.span.to(entry.value.span),
            Element::Signature(_)
            | Element::Confounds(_)
            | Element::Discretize(_)
            | Element::Extends(..)
            | Element::Declaration(_)
            | Element::InitialEquation(_)
            | Element::Measure(_) => continue,
        };
        found.push(library.sources.lines(span));
    }
    found
}

/// The initial equations, which hold at the start alone.
fn initial(elements: &[Element], library: &Library) -> String {
    let equations = elements.iter().filter_map(|element| match element {
        Element::InitialEquation(equation) => Some(library.sources.lines(equation.span)),
        Element::Equation(_)
        | Element::Add(_)
        | Element::Modes(_)
        | Element::Clocked(_)
        | Element::Wrap(..)
        | Element::Replace(..)
        | Element::Domain(_)
        | Element::Account(..)
        | Element::Signature(_)
        | Element::Confounds(_)
        | Element::Discretize(_)
        | Element::Extends(..)
        | Element::Declaration(_)
        | Element::Measure(_) => None,
    });
    match written(&equations.collect::<Vec<_>>()) {
        none if none.is_empty() => none,
        text => format!("<h4>Initial equations</h4>\n{text}"),
    }
}

fn written(texts: &[&str]) -> String {
    if texts.is_empty() {
        return String::new();
    }
    let lines: Vec<String> = texts.iter().map(|text| outdented(text)).collect();
    format!("<pre>{}</pre>\n", escaped(&lines.join("\n")))
}

/// Lines without the blanks that all of them begin with.
fn outdented(text: &str) -> String {
    let blanks = |line: &str| line.len() - line.trim_start().len();
    let lines = || text.lines().filter(|line| !line.trim().is_empty());
    let least = lines().map(blanks).min().unwrap_or(0);
    let cut: Vec<&str> = text
        .lines()
        .map(|line| line.get(least..).unwrap_or(""))
        .collect();
    cut.join("\n").trim_end().to_owned()
}

/// The effects that are for a class.
fn fits_on(class: &Class, number: usize, library: &Library, links: &Links<'_>) -> String {
    let mut found = Vec::new();
    for (of, (_, file)) in library.files[..library.documented].iter().enumerate() {
        for item in &file.items {
            let Item::Class(effect) = item else { continue };
            if let ClassBody::Long {
                host: Some(host), ..
            } = &effect.body
                && links
                    .class(of, host)
                    .is_some_and(|(of, known)| of == number && std::ptr::eq(known, class))
            {
                let (page, name) = (library.name(of), &effect.name.text);
                found.push(format!("<a href=\"{page}.html#{name}\">{name}</a>"));
            }
        }
    }
    if found.is_empty() {
        String::new()
    } else {
        format!(
            "<p class=\"note\">effects for it: {}</p>\n",
            found.join(", ")
        )
    }
}
