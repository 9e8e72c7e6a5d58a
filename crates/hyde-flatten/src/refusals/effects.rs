//! What is said of effects: of the words about themselves, of the places they are put on, of what they wrap and replace.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

diagnostics! {
    fn no_signature(mark: &Name, known: &[&str]) = error UnknownName {
        "`{}` is not a signature of an effect", mark.text; at mark.span, "not known";
        match (nearest(&mark.text, known.iter().copied())) {
            Some(near) => {
                help "did you mean `{near}`?";
                note "the signatures are `{}`", known.join("`, `");
            }
            None => { help "the signatures are `{}`", known.join("`, `"); }
        }
    }
    fn signature_takes_no_shape(mark: &Name) = error BadArguments {
        "`{}` takes no shape", mark.text; at mark.span, "the shape that defines this signature";
        help "write `{}` alone", mark.text;
    }
    fn signature_takes_one_shape(mark: &Name, of: &str) = error BadArguments {
        "`{}` takes one shape", mark.text; at mark.span, "the shape that defines this signature";
        help "write {of}: `{}(…)`", mark.text;
    }
    fn no_such_shape((effect, mark): (&str, &str), here: Span, of: &str, shapes: &[&str]) = error BadArguments {
        "`{effect}` has no such shape for its signature `{mark}`"; at here, "the shape that defines this signature";
        match shapes {
            [] => { help "declare {of} as a `shape`"; }
            shapes => { help "its shapes are {}", listed(shapes); }
        }
    }
    fn confused_with_itself(name: Span) = error WrongType {
        "an effect cannot be confused with itself"; at name, "this is the effect itself";
        help "name other effects with the same signature, or remove the line";
    }
    fn confused_with_no_effect(class: &str, here: Span) = error WrongType {
        "`{class}` is not an effect"; at here, "only effects can be confused with each other";
    }
    fn with_no_effect(class: &str, here: Span) = error WrongType {
        "`{class}` is not an effect"; at here, "only effects may follow `with`";
    }
    fn twice_on_a_site(name: &str, site: &str, here: Span) = error Duplicate {
        "`{name}` is on `{site}` twice"; at here, "the second time";
        help "give the second another name: `effect Other on … extends …`";
    }
    fn whole_array(site: &str, (name, here): (&str, Span), count: usize) = error UnknownName {
        "there is no `{site}` to put the effect on"; at here, "an array of {count}";
        help "name its elements: `{name}[1]`, …";
    }
    fn no_element(site: &str, here: Span, count: usize) = error UnknownName {
        "there is no `{site}` to put the effect on"; at here, "an array of {count}";
    }
    fn no_array(site: &str, here: Span) = error UnknownName {
        "there is no `{site}` to put the effect on"; at here, "no array";
    }
    fn on_no_component(site: &str, here: Span, kind: &str) = error UnknownName {
        "there is no `{site}` to put the effect on"; at here, "this is a {kind}";
        help "effects are put on components and connectors";
    }
    fn no_such_part(site: &str, name: &Name, class: &str, parts: &[&str]) = error UnknownName {
        "there is no `{site}` to put the effect on"; at name.span, "`{class}` has no such component or connector";
        match (nearest(&name.text, parts.iter().copied())) {
            Some(near) => { help "did you mean `{near}`?"; }
            None if parts.is_empty() => {}
            None => { help "components and connectors here: {}", listed(parts); }
        }
    }
    fn cannot_act(site: &str, here: Span) = error UnknownName {
        "there is no `{site}` to put the effect on"; at here, "an effect cannot act here";
    }
    fn no_host(effect: &Name, of_site: &str) = error WrongType {
        "`{}` does not declare its host", effect.text; at effect.span, "no `on TYPE` follows";
        help "for this site write `effect {} on {of_site}`", effect.text;
    }
    /// `parts` are those of the site on which the effect would fit.
    fn does_not_fit(
        effect: &str, wanted: &Reference, (site, own, here): (&str, &str, Span), parts: &[&str],
    ) = error WrongType {
        "`{effect}` does not fit on `{site}`"; at here, "this is a `{own}`";
        help "`{effect}` is for a `{}`; {}", wanted.dotted(), match parts {
            [] => "`hyde effects FILE` lists the sites where each effect fits".to_owned(),
            [part] => format!("`{site}.{part}` is such a component"),
            [part, other, ..] => format!("`{site}.{part}` and `{site}.{other}` are such"),
        };
    }
    fn adds_to_a_model(effect: &str, added: Span, (host, wanted): (&str, Option<Span>)) = error WrongType {
        "`{effect}` adds to a connector, and is on a model"; at added, "not a connector";
        if let Some(wanted) = wanted { at wanted, "`{host}` is a model"; }
        help "declare it `on` the type of the connector, or `wrap` a site of the model";
    }
    fn not_a_site(class: &str, site: &Reference, declared: Span) = error UnknownName {
        "`{class}` has no site `{}`", site.dotted(); at site.span, "only sites, inputs and outputs can be wrapped";
        at declared, "declared here, not as a site";
        help "declare it `site`";
    }
    fn no_site(class: &str, site: &Reference, sites: &[&str]) = error UnknownName {
        "`{class}` has no site `{}`", site.dotted(); at site.span, "only sites, inputs and outputs can be wrapped";
        match (nearest(&site.dotted(), sites.iter().copied())) {
            Some(near) => { help "did you mean `{near}`?"; }
            None if sites.is_empty() => {}
            None => { help "sites there: {}", listed(sites); }
        }
    }
    fn nothing_to_replace(class: &str, component: &Reference, known: &[&str]) = error UnknownName {
        "`{class}` has no component `{}` to replace", component.dotted();
        at component.span, "not found in the host";
        match (nearest(&component.dotted(), known.iter().copied())) {
            _ if known.is_empty() => { help "it has none that is `replaceable`"; }
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "replaceable there: {}", listed(known); }
        }
    }
    fn not_replaceable(component: Span, declared: &Name, type_name: &str) = error FinalModified {
        "`{}` is not replaceable", declared.text; at component, "cannot be replaced";
        at declared.span, "declared here as not replaceable";
        help "declare it `replaceable {type_name} {}`", declared.text;
    }
    fn no_equation_to_wrap(site: &Reference) = error NotYet {
        "no single equation `{} = …` defines this site", site.dotted(); at site.span, "cannot be wrapped";
        help "give the site its value in one equation, its name on the left";
    }
}
