//! Components: an instance or an array of them, of the declared or the redeclared model.

use super::modification::Modifier;
use super::{Collected, Place};
use crate::instance::{InstanceId, Member, Position};
use crate::model::Model;
use crate::names::FileIndex;
use hyde_diag::{Code, Diagnostic, InstancePath};
use hyde_syntax::ast::{Class, ClassKind, Declaration, Declarator, Prefix};

impl<'a> Model<'a, '_> {
    pub(super) fn declare_component(
        &mut self,
        id: InstanceId,
        item: &Collected<'a>,
        declaration: &'a Declaration,
        declarator: &'a Declarator,
        file: FileIndex,
        class: &'a Class,
    ) {
        if class.kind == ClassKind::Effect {
            self.report(
                Diagnostic::error(
                    Code::WrongType,
                    format!("`{}` is an effect, not a component", class.name.text),
                )
                .label(declaration.type_name.span, "an effect is added at a site")
                .help(format!(
                    "write `model New = Old with {} on site;`",
                    class.name.text
                )),
            );
            return;
        }
        if let Some(binding) = &declarator.binding {
            self.report(
                Diagnostic::error(
                    Code::WrongType,
                    format!(
                        "the component `{}` cannot equal an expression",
                        declarator.name.text
                    ),
                )
                .label(binding.span, "a value for a component")
                .help("modify its parameters: `Mass m(M = 3 [kg]);`"),
            );
        }
        let count = self.length(id, &declaration.dims, &declarator.dims);
        let name = declarator.name.text.as_str();
        let mut inner = self.modifiers_for(name, &item.modifiers);
        self.modifiers_of(&declarator.changes, id, &mut inner);
        let by_effect = self.replaced(id, declaration, declarator, &mut inner);
        let class = by_effect.unwrap_or((file, class));
        let Some((file, class)) = self.redeclared(declaration, declarator, &inner, class) else {
            self.undeclared.insert(name);
            return;
        };
        let (path, clock) = (self.tree.path(id), self.clock_of(id));
        let place = |path: InstancePath| Place {
            path,
            parent: Some(id),
            clock,
            span: declarator.name.span,
        };
        match count {
            None => {
                let part = self.instantiate(file, class, inner, place(path.child(name)));
                self.tree.name(id, name, Member::Instance(part));
            }
            Some(count) => {
                let mut parts = Vec::new();
                for index in 0..count {
                    let mut own = inner.clone();
                    for modifier in &mut own {
                        match modifier.each {
                            0 => modifier.elements.push(Position {
                                at: index,
                                of: count,
                            }),
                            each => modifier.each = each - 1,
                        }
                    }
                    let child = path.child(&format!("{name}[{}]", index + 1));
                    parts.push(self.instantiate(file, class, own, place(child)));
                }
                self.tree.name(id, name, Member::Instances(parts.into()));
            }
        }
    }

    /// The class of a component: that of the outermost redeclaration, if there is one.
    fn redeclared(
        &mut self,
        declaration: &Declaration,
        declarator: &Declarator,
        modifiers: &[Modifier<'a>],
        declared: (FileIndex, &'a Class),
    ) -> Option<(FileIndex, &'a Class)> {
        let redeclaration = modifiers.iter().find_map(|modifier| {
            let new = modifier.change.redeclare.as_ref()?;
            modifier.target.is_empty().then_some((modifier, new))
        });
        let Some((modifier, new)) = redeclaration else {
            return Some(declared);
        };
        if !declaration.prefixes.contains(&Prefix::Replaceable) {
            let name = &declarator.name.text;
            self.report(
                Diagnostic::error(Code::FinalModified, format!("`{name}` is not replaceable"))
                    .label(modifier.change.target.span, "cannot be redeclared")
                    .label(declarator.name.span, "declared here as not replaceable")
                    .help(format!(
                        "declare it `replaceable {} {name}`",
                        declared.1.name.text
                    )),
            );
            return None;
        }
        let file = self.names.file_of(new.span)?;
        let class = self.names.class(file, new);
        if class.is_none() {
            let diagnostic = self.names.unknown(file, new);
            self.report(diagnostic);
        }
        class
    }
}
