//! Effects that find nothing to act on: the place, the type, the site or the component is not what they need (E1).

use crate::instance::{Instance, InstanceId, Member};
use crate::instantiate::{InstanceTree, host_of, written};
use crate::model::listed;
use crate::names::{FileIndex, Names, nearest};
use hyde_diag::{Code, Diagnostic, Span};
use hyde_syntax::ast::{Class, Declaration, Element, Prefix, Reference};

/// `E on giude`: follows the path as far as it goes, and tells what there is instead.
pub(crate) fn no_place(tree: &InstanceTree<'_>, scope: InstanceId, site: &Reference) -> Diagnostic {
    let diagnostic = Diagnostic::error(
        Code::UnknownName,
        format!("there is no `{}` to put the effect on", written(site)),
    );
    let mut at = scope;
    for part in &site.parts {
        let name = part.name.text.as_str();
        let span = part.name.span;
        let is = |what: String| diagnostic.clone().label(span, what);
        let found = match tree[at].members.get(name) {
            Some(Member::Instance(inner)) if part.subscripts.is_empty() => {
                at = *inner;
                continue;
            }
            Some(Member::Instances(all)) if part.subscripts.is_empty() => {
                is(format!("an array of {}", all.len()))
                    .help(format!("name its elements: `{name}[1]`, …"))
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
                is(format!("an array of {}", all.len()))
            }
            Some(Member::Instance(_)) => is("no array".to_owned()),
            Some(Member::Variable(_)) => is("this is a variable".to_owned())
                .help("effects are put on components and connectors"),
            Some(Member::Parameter(_)) => is("this is a parameter".to_owned())
                .help("effects are put on components and connectors"),
            Some(Member::Domain(_)) => is("this is a domain".to_owned())
                .help("effects are put on components and connectors"),
            None => {
                let members = tree[at].members.iter();
                let parts: Vec<&str> = members
                    .filter(|(_, member)| {
                        matches!(member, Member::Instance(_) | Member::Instances(_))
                    })
                    .map(|(name, _)| *name)
                    .collect();
                let class = &tree[at].class.name.text;
                with_help(
                    is(format!("`{class}` has no such component or connector")),
                    name,
                    &parts,
                    "components and connectors here: ",
                )
            }
        };
        return found;
    }
    diagnostic.label(site.span, "an effect cannot act here")
}

/// `Stribeck on body`, where `body` is no guide.
pub(crate) fn does_not_fit(
    (tree, names): (&InstanceTree<'_>, Names<'_>),
    host: InstanceId,
    (file, effect): (FileIndex, &Class),
    site: &Reference,
) -> Diagnostic {
    let name = &effect.name.text;
    let Some(wanted) = host_of(effect) else {
        return Diagnostic::error(
            Code::WrongType,
            format!("`{name}` does not declare its host"),
        )
        .label(effect.name.span, "no `on TYPE` follows")
        .help(format!(
            "for this site write `effect {name} on {}`",
            tree[host].class.name.text
        ));
    };
    let Some((_, class)) = names.class(file, wanted) else {
        return names.unknown(file, wanted);
    };
    let own = &tree[host].class.name.text;
    let site_name = written(site);
    let parts = names.parts_that_are((tree[host].file, tree[host].class), class);
    let fits = match parts.as_slice() {
        [] => "`hyde effects FILE` lists the sites where each effect fits".to_owned(),
        [part] => format!("`{site_name}.{part}` is such a component"),
        [part, other, ..] => format!("`{site_name}.{part}` and `{site_name}.{other}` are such"),
    };
    Diagnostic::error(
        Code::WrongType,
        format!("`{name}` does not fit on `{site_name}`"),
    )
    .label(site.span, format!("this is a `{own}`"))
    .help(format!("`{name}` is for a `{}`; {fits}", wanted.dotted()))
}

/// `add a.f = e;` of an effect that is not on a connector.
pub(crate) fn nothing_to_join(host: &Instance<'_>, effect: &Class, added: Span) -> Diagnostic {
    let own = &host.class.name.text;
    let diagnostic = Diagnostic::error(
        Code::WrongType,
        format!(
            "`{}` adds to a connector, and is on a model",
            effect.name.text
        ),
    )
    .label(added, "not a connector")
    .help("declare it `on` the type of the connector, or `wrap` a site of the model");
    match host_of(effect) {
        Some(wanted) => diagnostic.label(wanted.span, format!("`{own}` is a model")),
        None => diagnostic,
    }
}

/// `wrap x by e;` of a host in which x is no site; `declared` is where it is something else.
pub(crate) fn no_site(
    tree: &InstanceTree<'_>,
    host: InstanceId,
    site: &Reference,
    declared: Option<Span>,
) -> Diagnostic {
    let class = &tree[host].class.name.text;
    let diagnostic = Diagnostic::error(
        Code::UnknownName,
        format!("`{class}` has no site `{}`", site.dotted()),
    )
    .label(site.span, "only sites, inputs and outputs can be wrapped");
    let sites = declared_with(tree, host, &[Prefix::Site, Prefix::Input, Prefix::Output]);
    match declared {
        Some(span) => diagnostic
            .label(span, "declared here, not as a site")
            .help("declare it `site`"),
        None => with_help(diagnostic, &site.dotted(), &sites, "sites there: "),
    }
}

/// `replace c by M;` of a host without a component c.
pub(crate) fn no_component(
    tree: &InstanceTree<'_>,
    host: InstanceId,
    component: &Reference,
) -> Diagnostic {
    let class = &tree[host].class.name.text;
    let diagnostic = Diagnostic::error(
        Code::UnknownName,
        format!(
            "`{class}` has no component `{}` to replace",
            component.dotted()
        ),
    )
    .label(component.span, "not found in the host");
    let known = declared_with(tree, host, &[Prefix::Replaceable]);
    if known.is_empty() {
        diagnostic.help("it has none that is `replaceable`")
    } else {
        with_help(
            diagnostic,
            &component.dotted(),
            &known,
            "replaceable there: ",
        )
    }
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

/// The nearest of the known names, or all of them.
fn with_help(diagnostic: Diagnostic, name: &str, known: &[&str], all: &str) -> Diagnostic {
    match nearest(name, known.iter().copied()) {
        Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
        None if known.is_empty() => diagnostic,
        None => diagnostic.help(format!("{all}{}", listed(known))),
    }
}
