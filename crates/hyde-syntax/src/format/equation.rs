//! Equations, and what stands among them.

use super::name::{quoted, reference};
use super::{Printer, expression};
use crate::ast::{Equation, EquationKind};
use std::fmt::Write as _;

impl Printer {
    pub(super) fn equation(&mut self, equation: &Equation, lead: &str) {
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
}
