//! Effects that find nothing to act on: the place, the type, the site or the component is not what they need (E1).

use crate::instance::{Instance, InstanceId, Member};
use crate::instantiate::{InstanceTree, host_of, written};
use crate::names::{FileIndex, Names};
use crate::refusals::effects as refused;
use hyde_diag::{Diagnostic, Span};
use hyde_syntax::ast::{Class, Declaration, Element, Prefix, Reference};

/// `E on giude`: follows the path as far as it goes, and tells what there is instead.
pub(crate) fn no_place(tree: &InstanceTree<'_>, scope: InstanceId, site: &Reference) -> Diagnostic {
    let whole = written(site);
    let mut at = scope;
    for part in &site.parts {
        let name = part.name.text.as_str();
        let span = part.name.span;
        let found = match tree[at].members.get(name) {
            Some(Member::Instance(inner)) if part.subscripts.is_empty() => {
                at = *inner;
                continue;
            }
            Some(Member::Instances(all)) if part.subscripts.is_empty() => {
                refused::whole_array(&whole, (name, span), all.len())
            }
            Some(Member::Instances(all)) => {
                let inside = all.iter().copied().find(|&id| {
                    let path = tree[id].path.as_str();
                    path.ends_with(&written(&Reference {
                        parts: vec![part.clone()],
                        span,
                    }))
                });
                if let Some(inner) = inside {
                    at = inner;
                    continue;
                }
                refused::no_element(&whole, span, all.len())
            }
            Some(Member::Instance(_)) => refused::no_array(&whole, span),
            Some(Member::Variable(_)) => refused::on_no_component(&whole, span, "variable"),
            Some(Member::Parameter(_)) => refused::on_no_component(&whole, span, "parameter"),
            Some(Member::Domain(_)) => refused::on_no_component(&whole, span, "domain"),
            None => {
                let members = tree[at].members.iter();
                let parts: Vec<&str> = members
                    .filter(|(_, member)| {
                        matches!(member, Member::Instance(_) | Member::Instances(_))
                    })
                    .map(|(name, _)| *name)
                    .collect();
                let class = &tree[at].class.name.text;
                refused::no_such_part(&whole, &part.name, class, &parts)
            }
        };
        return found;
    }
    refused::cannot_act(&whole, site.span)
}

/// `Stribeck on body`, where `body` is no guide.
pub(crate) fn does_not_fit(
    (tree, names): (&InstanceTree<'_>, Names<'_>),
    host: InstanceId,
    (file, effect): (FileIndex, &Class),
    site: &Reference,
) -> Diagnostic {
    let Some(wanted) = host_of(effect) else {
        return refused::no_host(&effect.name, &tree[host].class.name.text);
    };
    let Some((_, class)) = names.class(file, wanted) else {
        return names.unknown(file, wanted);
    };
    let own = &tree[host].class.name.text;
    let parts = names.parts_that_are((tree[host].file, tree[host].class), class);
    let (path, name) = (written(site), &effect.name.text);
    refused::does_not_fit(name, wanted, (&path, own, site.span), &parts)
}

/// `add a.f = e;` of an effect that is not on a connector.
pub(crate) fn nothing_to_join(host: &Instance<'_>, effect: &Class, added: Span) -> Diagnostic {
    let wanted = host_of(effect).map(|wanted| wanted.span);
    let host = (host.class.name.text.as_str(), wanted);
    refused::adds_to_a_model(&effect.name.text, added, host)
}

/// `wrap x by e;` of a host in which x is no site; `declared` is where it is something else.
pub(crate) fn no_site(
    tree: &InstanceTree<'_>,
    host: InstanceId,
    site: &Reference,
    declared: Option<Span>,
) -> Diagnostic {
    let class = &tree[host].class.name.text;
    let sites = declared_with(tree, host, &[Prefix::Site, Prefix::Input, Prefix::Output]);
    match declared {
        Some(span) => refused::not_a_site(class, site, span),
        None => refused::no_site(class, site, &sites),
    }
}

/// `replace c by M;` of a host without a component c.
pub(crate) fn no_component(
    tree: &InstanceTree<'_>,
    host: InstanceId,
    component: &Reference,
) -> Diagnostic {
    let known = declared_with(tree, host, &[Prefix::Replaceable]);
    refused::nothing_to_replace(&tree[host].class.name.text, component, &known)
}

/// What an instance declares with one of these prefixes.
pub(crate) fn declared_with<'t>(
    tree: &'t InstanceTree<'_>,
    instance: InstanceId,
    prefixes: &[Prefix],
) -> Vec<&'t str> {
    let mut found = Vec::new();
    for (_, element) in &tree[instance].elements {
        if let Element::Declaration(declaration) = element
            && has_one_of(declaration, prefixes)
        {
            let names = declaration.declarators.iter();
            found.extend(names.map(|declarator| declarator.name.text.as_str()));
        }
    }
    found
}

fn has_one_of(declaration: &Declaration, prefixes: &[Prefix]) -> bool {
    let mut own = declaration.prefixes.iter();
    own.any(|prefix| prefixes.contains(prefix))
}
