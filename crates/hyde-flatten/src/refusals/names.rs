//! What is said of names that are not known where they are used.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::Reference;

diagnostics! {
    fn in_two_packages(name: &Reference, first: &str, second: &str) = error UnknownType {
        "`{}` is in `{first}` and in `{second}`", name.dotted(); at name.span, "which of them?";
        help "write `{first}.{0}` or `{second}.{0}`", name.dotted();
    }
    /// `also` is what the name means here.
    fn not_imported(name: &Reference, packages: &[String], also: Option<&str>) = error UnknownType {
        "`{}` is in {}, {}", name.dotted(), each(packages, |package| format!("`{package}`")).join(", "), match packages {
            [_] => "which is not imported",
            _ => "and none of them is imported",
        };
        at name.span, "not known in this file";
        if let Some(also) = also { note "the `{}` known here is {also}", name.dotted(); }
        help "write {} at the top of the file", each(packages, |package| format!("`import {package}.*;`")).join(" or ");
    }
    /// `what` is looked for, and `declare` says how to declare it.
    fn no_type(name: &Reference, (what, declare): (&str, &str), known: &[&str]) = error UnknownType {
        "there is no {what} `{}` here", name.dotted(); at name.span, "not known in this file";
        match (hyde_syntax::instead_of(&name.dotted())) {
            Some(help) => { help "{help}"; }
            None => {
                match (nearest(&name.dotted(), known.iter().copied())) {
                    Some(near) => { help "did you mean `{near}`?"; }
                    None => { help "{declare}"; }
                }
            }
        }
    }
    /// A word of a longer name, in an instance that is called `place`.
    fn unknown_name((word, here): (&str, Span), place: &str, whole: &Reference, known: &[&str]) = error UnknownName {
        "there is no `{word}` in {place}"; at here, "not known";
        match (nearest(word, known.iter().copied())) {
            _ if word == "Modelica" => { help "{}", hyde_syntax::instead_of(&whole.dotted()).unwrap_or_default(); }
            _ if word == "True" || word == "TRUE" => { help "write `true`"; }
            _ if word == "False" || word == "FALSE" => { help "write `false`"; }
            _ if word == "dt" => { help "the derivative of `x` by the time is `der(x)`"; }
            Some(near) => { help "did you mean `{near}`?"; }
            None if known.is_empty() => {}
            None => { help "known here: {}", listed(known); }
        }
    }
}

fn each(packages: &[String], write: impl Fn(&String) -> String) -> Vec<String> {
    packages.iter().map(write).collect()
}
