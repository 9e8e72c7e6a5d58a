//! Domains with their meshes, and the domain of a field.

use crate::instance::{Domain, DomainId, Field, InstanceId, Member};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic};
use hyde_syntax::ast::{self, Declarator};

impl<'a> Model<'a, '_> {
    pub(super) fn declare_domain(
        &mut self,
        id: InstanceId,
        domain: &'a ast::Domain,
        method: Option<&'a ast::Discretize>,
    ) {
        let name = domain.name.text.as_str();
        let span = domain.name.span;
        let Some(method) = method else {
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("the domain `{name}` is not discretised"),
                )
                .label(span, "how many cells?")
                .help(format!("write `discretize {name} by fem(n = 24);`")),
            );
            self.undeclared.insert(name);
            return;
        };
        let averaged = match method.method.text.as_str() {
            "fem" => true,
            "fv" => false,
            other => {
                self.report(
                    Diagnostic::error(
                        Code::NotYet,
                        format!("no discretisation is called `{other}` in this version"),
                    )
                    .label(method.method.span, "not known")
                    .help("write `fem(n = …)` or `fv(n = …)`"),
                );
                self.undeclared.insert(name);
                return;
            }
        };
        let cells = method
            .arguments
            .iter()
            .find(|a| a.name.as_ref().is_some_and(|name| name.text == "n"));
        let Some(cells) = cells else {
            self.report(
                Diagnostic::error(Code::BadArguments, format!("how many cells has `{name}`?"))
                    .label(method.method.span, "no `n` given")
                    .help(format!("write `{}(n = 24)`", method.method.text)),
            );
            self.undeclared.insert(name);
            return;
        };
        let Some(count) = self.structural_integer(id, &cells.value) else {
            self.undeclared.insert(name);
            return;
        };
        let Some(cells) = usize::try_from(count)
            .ok()
            .filter(|&n| (2..=10_000_000).contains(&n))
        else {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` cannot have {count} cells"),
                )
                .label(cells.value.span, "at least 2"),
            );
            self.undeclared.insert(name);
            return;
        };
        let domain = Domain {
            instance: id,
            name,
            coordinate: &domain.coordinate.text,
            from: &domain.range.from,
            to: &domain.range.to,
            cells,
            averaged,
            span,
            mesh: None,
        };
        self.domains.push(domain);
        self.instances[id]
            .members
            .insert(name, Member::Domain(self.domains.len() - 1));
    }

    /// The domain of that name in an instance; reported once if there is none.
    pub(crate) fn domain_named(&mut self, id: InstanceId, name: &'a ast::Name) -> Option<DomainId> {
        if let Some(Member::Domain(domain)) = self.instances[id].members.get(name.text.as_str()) {
            return Some(*domain);
        }
        if self.undeclared.insert(&name.text) {
            self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    format!("no domain is called `{}` here", name.text),
                )
                .label(name.span, "not known")
                .help("declare it: `domain bar(x in 0 .. len);`"),
            );
        }
        None
    }

    /// The domain of a field and whether its values lie between the nodes: those of a flux, whose binding has `pder`.
    pub(super) fn field(&mut self, id: InstanceId, declarator: &'a Declarator) -> Option<Field> {
        let name = &declarator.name;
        let Some(domain) = &declarator.domain else {
            self.report(
                Diagnostic::error(
                    Code::FieldUse,
                    format!("on which domain is the field `{}`?", name.text),
                )
                .label(name.span, "a field needs a domain")
                .help(format!("write `field … {} on bar;`", name.text)),
            );
            return None;
        };
        let domain = self.domain_named(id, domain)?;
        let flux = declarator
            .binding
            .as_ref()
            .is_some_and(|binding| binding.calls("pder"));
        Some(Field {
            domain,
            flux,
            traces: None,
        })
    }
}
