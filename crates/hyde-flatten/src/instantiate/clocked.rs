//! Clocked parts: instances whose variables belong to a clock.

use super::Collected;
use crate::foreign;
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
        if self.clock_of(id).is_some() {
            self.report(
                Diagnostic::error(Code::ClockBorder, "a clocked part inside a clocked part")
                    .label(clocked.name.span, "move it out of the other"),
            );
            return;
        }
        let origin = self.tree.origin(id, clocked.name.span);
        let nothing = self.flat.exprs.constant(0.0);
        let path = self.tree.path(id).child(name);
        let clock = self.flat.clocks.push(flat::Clock {
            name: path.as_str().to_owned(),
            period: nothing,
            delay: nothing,
            phase: nothing,
            origin,
        });
        let part = self.tree.push(Instance {
            path,
            file: item.file,
            class: self.tree[id].class,
            parent: Some(id),
            outer: Some(id),
            clock: Some(clock),
            members: std::collections::BTreeMap::new(),
            elements: Vec::new(),
            span: clocked.name.span,
        });
        self.tree.name(id, name, Member::Instance(part));
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
        foreign::note_part(
            &mut self.flat,
            self.input,
            &self.tree,
            (id, part),
            item.file,
        );
    }
}
