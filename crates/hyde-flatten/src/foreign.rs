//! Components that something outside the equations computes: `model C = fmu("c.fmu");`.
//!
//! The interface of an FMU is a model with one clocked part. Its variables are given to and taken from the FMU at each tick.

use crate::Form;
use crate::instance::{InstanceId, Member};
use crate::model::Model;
use crate::names::FileIndex;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::{VarId, flat};

impl Model<'_, '_> {
    /// Notes the clocked part of a component whose file stands for an FMU.
    pub(crate) fn foreign_part(
        &mut self,
        component: InstanceId,
        part: InstanceId,
        file: FileIndex,
    ) {
        let Some((id, _)) = self.input.files.get(file) else {
            return;
        };
        let (Some(interface), Some(clock)) = (self.input.fmus.get(id), self.instances[part].clock)
        else {
            return;
        };
        let members = &self.instances[part].members;
        let variables = |names: &[String]| -> Vec<VarId> {
            let known = names.iter().map(|name| match members.get(name.as_str()) {
                Some(Member::Variable(var)) => Some(*var),
                Some(
                    Member::Parameter(_)
                    | Member::Instance(_)
                    | Member::Instances(_)
                    | Member::Domain(_),
                )
                | None => None,
            });
            known.flatten().collect()
        };
        let (parameters, inputs, outputs) = (
            variables(&interface.parameters),
            variables(&interface.inputs),
            variables(&interface.outputs),
        );
        let origin = self.origin(component, self.instances[component].span);
        self.flat.foreign.push(flat::Foreign {
            name: self.path(component).as_str().to_owned(),
            file: interface.file.clone(),
            source: *id,
            clock,
            parameters,
            inputs,
            outputs,
            origin,
        });
    }

    /// An FMU has values and no derivatives: an observer, which needs those of the whole model, is refused.
    pub(crate) fn check_foreign(&mut self) {
        if self.input.form == Form::Run || self.offering || self.lowered.is_some() {
            return;
        }
        if let Some(part) = self.flat.foreign.first() {
            let place = (part.name.as_str(), part.file.as_str(), part.origin.span);
            let diagnostic = fmu_has_no_equations(place, "an observer");
            self.report(diagnostic);
        }
    }
}

/// Refuses the FMU of a component, by its name, its file and where it is declared, to what would need its equations.
#[must_use]
pub fn fmu_has_no_equations((name, file, span): (&str, &str, Span), needs: &str) -> Diagnostic {
    let name = match name {
        "" => "the model".to_owned(),
        name => format!("`{name}`"),
    };
    let diagnostic = Diagnostic::error(
        Code::FmuOnlyRuns,
        format!("{name} is the FMU `{file}`; {needs} needs equations, and an FMU has none"),
    );
    diagnostic
        .label(span, "this component")
        .note("an FMU gives values at the ticks of its clock: `hyde run`, `sweep` and `test` run it")
        .help("replace it by a model written in Hyde, or leave it out and make what it gives an input")
}
