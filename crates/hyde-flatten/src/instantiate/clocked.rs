//! Clocked parts: instances whose variables belong to a clock.

use super::Collected;
use crate::instance::{Instance, InstanceId, Member};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic};
use hyde_ir::flat;
use hyde_syntax::ast;

impl<'a> Model<'a, '_> {
    pub(super) fn clocked(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        clocked: &'a ast::Clocked,
    ) {
        let name = clocked.name.text.as_str();
        if self.instances[id].clock.is_some() {
            self.report(
                Diagnostic::error(Code::ClockBorder, "a clocked part inside a clocked part")
                    .label(clocked.name.span, "move it out of the other"),
            );
            return;
        }
        let origin = self.origin(id, clocked.name.span);
        let nothing = self.flat.exprs.constant(0.0);
        let path = self.path(id).child(name);
        let clock = self.flat.clocks.push(flat::Clock {
            name: path.as_str().to_owned(),
            period: nothing,
            delay: nothing,
            phase: nothing,
            origin,
        });
        let part = self.instances.len();
        self.instances.push(Instance {
            path,
            file: item.file,
            class: self.instances[id].class,
            parent: Some(id),
            outer: Some(id),
            clock: Some(clock),
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span: clocked.name.span,
        });
        self.instances[id]
            .members
            .insert(name, Member::Instance(part));
        let modifiers = self.modifiers_for(name, &item.modifiers);
        let collected: Vec<Collected<'a>> = clocked
            .elements
            .iter()
            .map(|element| Collected {
                element,
                file: item.file,
                modifiers: modifiers.clone(),
            })
            .collect();
        self.members(part, &collected);
        self.foreign_part(id, part, item.file);
    }
}
