//! Modes and their exits.

use super::expression::optional_arguments;
use super::name::reference;
use super::{Printer, expression};
use crate::ast::{Equation, Exit, Mode, Modes};

impl Printer {
    pub(super) fn modes(&mut self, modes: &Modes) {
        let name = modes
            .name
            .as_ref()
            .map_or_else(String::new, |name| format!("{} ", name.text));
        let arguments = optional_arguments(&modes.arguments);
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
            for (word, actions) in [("enter", &mode.enter), ("leave", &mode.leave)] {
                out.actions(word, actions);
            }
            for exit in &mode.exits {
                out.exit(exit);
            }
        });
        self.line("}");
    }

    fn actions(&mut self, word: &str, actions: &[Equation]) {
        if !actions.is_empty() {
            self.line(&format!("{word} {{"));
            self.indented(|out| actions.iter().for_each(|action| out.equation(action, "")));
            self.line("}");
        }
    }

    fn exit(&mut self, exit: &Exit) {
        let arguments = optional_arguments(&exit.arguments);
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
}
