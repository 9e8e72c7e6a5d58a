//! Models, connectors and effects, element by element.

use super::declaration::{declaration_text, measure_text, modification};
use super::expression::{call_arguments, optional_arguments, range};
use super::name::{doc, reference};
use super::{Printer, expression};
use crate::ast::{Class, ClassBody, EffectUse, Element};
use std::fmt::Write as _;

impl Printer {
    pub(super) fn class(&mut self, class: &Class) {
        let word = class.kind.word();
        let name = &class.name.text;
        match &class.body {
            ClassBody::Short {
                base,
                fmu,
                changes,
                effects,
            } => {
                let changed = modification(changes);
                let mut text = match fmu {
                    None => format!("{word} {name} = {}{changed}", reference(base)),
                    Some((file, _)) => {
                        let changed = changed.trim_start_matches('(').trim_end_matches(')');
                        let comma = if changed.is_empty() { "" } else { ", " };
                        format!("{word} {name} = fmu(\"{file}\"{comma}{changed})")
                    }
                };
                for (index, used) in effects.iter().enumerate() {
                    let lead = if index == 0 { " with " } else { ", " };
                    let _ = write!(text, "{lead}{}", effect_use(used));
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
                optional_arguments(&item.arguments)
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
                        let arguments = optional_arguments(arguments);
                        format!("{}{arguments}", name.text)
                    })
                    .collect();
                self.line(&format!("signature {};", marks.join(", ")));
            }
            Element::Confounds(names) => {
                let names: Vec<String> = names.iter().map(reference).collect();
                self.line(&format!("confounds {};", names.join(", ")));
            }
            Element::Measure(measure) => self.line(&measure_text("measure", measure)),
            Element::Account(kind, measure) => {
                self.line(&measure_text(kind.word(), measure));
            }
        }
    }
}

/// `Stribeck(dF = 150 [N]) on guide`
pub(super) fn effect_use(used: &EffectUse) -> String {
    let sites: Vec<String> = used.sites.iter().map(reference).collect();
    let effect = reference(&used.effect);
    format!(
        "{effect}{} on {}",
        modification(&used.changes),
        sites.join(", ")
    )
}
