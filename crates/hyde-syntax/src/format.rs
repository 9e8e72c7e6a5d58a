//! Prints a tree as source text, one element a line; parsing the result gives the same tree.

mod class;
mod declaration;
mod equation;
mod experiment;
mod expression;
mod modes;
mod name;
mod study;

pub use expression::expression;
pub use name::{member, reference};

use crate::ast::{File, Item};
use name::{bracketed, doc};

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
}
