//! The roles of the variables after `over` of a site: they say what a law of the site is.

use crate::names::nearest;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_syntax::LawForm;
use hyde_syntax::ast::{Argument, Declarator, Expr};

/// The forms, with the roles of their variables.
const FORMS: [(LawForm, [&str; 2]); 4] = [
    (LawForm::Motion, ["place", "speed"]),
    (LawForm::Friction, ["place", "slip"]),
    (LawForm::Elastic, ["stretch", "rate"]),
    (LawForm::Demand, ["demand", "rate"]),
];
/// The role of the site that holds a friction at rest: it takes the same law.
const HOLD: &str = "hold";

/// What is wrong; nothing where that is reported elsewhere.
pub(crate) type Refusal = Option<Box<Diagnostic>>;

/// The form, its two variables, and the site that holds at rest.
pub(crate) type Roles<'a> = (LawForm, [&'a Expr; 2], Option<&'a Expr>);

/// Reads the roles of a site.
pub(crate) fn roles(declarator: &Declarator) -> Result<Roles<'_>, Refusal> {
    let mut given: Vec<(&str, &Argument)> = Vec::new();
    let all = FORMS.iter().flat_map(|(_, roles)| roles).copied();
    for argument in &declarator.over {
        let Some(role) = &argument.name else {
            return Err(wrong(
                "a variable of the law has no role".to_owned(),
                argument.value.span,
                "without a role",
                every_form(),
            ));
        };
        let word = role.text.as_str();
        if word != HOLD && !all.clone().any(|known| known == word) {
            let near = nearest(word, all.clone().chain([HOLD]));
            return Err(wrong(
                format!("`{word}` is not a role of a variable of a law"),
                role.span,
                "not known",
                near.map_or_else(every_form, |near| format!("did you mean `{near}`?")),
            ));
        }
        if given.iter().any(|(known, _)| *known == word) {
            return Err(wrong(
                format!("`{word}` is given twice"),
                role.span,
                "the second time",
                every_form(),
            ));
        }
        given.push((word, argument));
    }
    let of = |role: &str| {
        let found = given.iter().find(|(known, _)| *known == role);
        found.map(|(_, argument)| &argument.value)
    };
    let hold = of(HOLD);
    let count = given.len() - usize::from(hold.is_some());
    let form = FORMS.iter().find_map(|(form, [first, second])| {
        let both = [of(first)?, of(second)?];
        (count == 2).then_some((*form, both))
    });
    let Some((form, both)) = form else {
        return Err(wrong(
            "these variables do not make a law".to_owned(),
            declarator.name.span,
            "its law needs two variables",
            every_form(),
        ));
    };
    if let Some(hold) = hold.filter(|_| form != LawForm::Friction) {
        return Err(wrong(
            "only a friction holds at rest".to_owned(),
            hold.span,
            "the law has no `slip`",
            "remove `hold`, or give the speed the role `slip`".to_owned(),
        ));
    }
    Ok((form, both, hold))
}

/// The pairs of roles that there are.
fn every_form() -> String {
    let pairs = FORMS.map(|(_, [first, second])| format!("`{first}` with `{second}`"));
    format!("the roles are {}", pairs.join(", "))
}

/// A refusal with its place, and what to write instead.
pub(crate) fn wrong(message: String, span: Span, label: &str, help: String) -> Refusal {
    let diagnostic = Diagnostic::error(Code::SiteVariables, message);
    Some(Box::new(diagnostic.label(span, label).help(help)))
}
