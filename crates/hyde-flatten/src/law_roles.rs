//! The roles of the variables after `over` of a site: they say what a law of the site is.

use crate::refusals::laws as refused;
use crate::words::nearest;
use hyde_diag::Diagnostic;
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
/// The role of a variable of any dimension with which a law may go as well: a current, a force.
const SIGNAL: &str = "signal";
/// The roles that may stand beside a pair.
const BESIDE: [&str; 2] = [HOLD, SIGNAL];

/// What is wrong; nothing where that is reported elsewhere.
pub(crate) type Refusal = Option<Box<Diagnostic>>;

/// What stands behind `over`.
pub(crate) struct Roles<'a> {
    pub(crate) form: LawForm,
    /// The two variables of the form.
    pub(crate) pair: [&'a Expr; 2],
    /// The site that holds at rest.
    pub(crate) hold: Option<&'a Expr>,
    /// What the site has beside them.
    pub(crate) signal: Option<&'a Expr>,
}

/// Reads the roles of a site.
pub(crate) fn roles(declarator: &Declarator) -> Result<Roles<'_>, Refusal> {
    let mut given: Vec<(&str, &Argument)> = Vec::new();
    let all = FORMS.iter().flat_map(|(_, roles)| roles).copied();
    for argument in &declarator.over {
        let Some(role) = &argument.name else {
            return Err(wrong(refused::no_role(argument.value.span, &every_form())));
        };
        let word = role.text.as_str();
        let mut known = all.clone().chain(BESIDE);
        if !known.any(|known| known == word) {
            let near = nearest(word, all.clone().chain(BESIDE));
            return Err(wrong(refused::unknown_role(role, near, &every_form())));
        }
        if given.iter().any(|(known, _)| *known == word) {
            return Err(wrong(refused::role_twice(role, &every_form())));
        }
        given.push((word, argument));
    }
    let of = |role: &str| {
        let found = given.iter().find(|(known, _)| *known == role);
        found.map(|(_, argument)| &argument.value)
    };
    let beside = BESIDE.map(of);
    let count = given.len() - beside.iter().flatten().count();
    let [hold, signal] = beside;
    let form = FORMS.iter().find_map(|(form, [first, second])| {
        let both = [of(first)?, of(second)?];
        (count == 2).then_some((*form, both))
    });
    let Some((form, pair)) = form else {
        return Err(wrong(refused::no_pair_of_roles(
            declarator.name.span,
            &every_form(),
        )));
    };
    if let Some(hold) = hold.filter(|_| form != LawForm::Friction) {
        return Err(wrong(refused::hold_without_slip(hold.span)));
    }
    Ok(Roles {
        form,
        pair,
        hold,
        signal,
    })
}

/// The pairs of roles that there are.
fn every_form() -> String {
    let pairs = FORMS.map(|(_, [first, second])| format!("`{first}` with `{second}`"));
    format!(
        "the roles are {}; `{HOLD}` and `{SIGNAL}` may follow",
        pairs.join(", ")
    )
}

/// A diagnostic as a refusal.
pub(crate) fn wrong(diagnostic: Diagnostic) -> Refusal {
    Some(Box::new(diagnostic))
}
