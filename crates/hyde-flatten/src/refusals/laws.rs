//! What is said of laws: of the sites where one may act, and of the shapes that it may have.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

diagnostics! {
    /// `roles` says all pairs of roles.
    fn no_role(variable: Span, roles: &str) = error SiteVariables {
        "a variable of the law has no role"; at variable, "without a role";
        help "{roles}";
    }
    fn unknown_role(role: &Name, near: Option<&str>, roles: &str) = error SiteVariables {
        "`{}` is not a role of a variable of a law", role.text; at role.span, "not known";
        match near {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "{roles}"; }
        }
    }
    fn role_twice(role: &Name, roles: &str) = error SiteVariables {
        "`{}` is given twice", role.text; at role.span, "the second time";
        help "{roles}";
    }
    fn no_pair_of_roles(site: Span, roles: &str) = error SiteVariables {
        "these variables do not make a law"; at site, "its law needs two variables";
        help "{roles}";
    }
    fn hold_without_slip(hold: Span) = error SiteVariables {
        "only a friction holds at rest"; at hold, "the law has no `slip`";
        help "remove `hold`, or give the speed the role `slip`";
    }
    fn no_flow(site: &Name) = error SiteVariables {
        "no law can be added to `{}`", site.text; at site.span, "not a `flow` variable";
        help "write `over` behind the `flow` variable instead of `{}`", site.text;
    }
    fn no_site(site: &Name, type_name: &Reference) = error SiteVariables {
        "no law can be added to `{}`", site.text; at site.span, "neither a site nor an input nor an output";
        help "declare it as a site: `site {} {} = … over (…);`", type_name.dotted(), site.text;
    }
    fn clocked_site(site: &Name) = error SiteVariables {
        "no law can be added to `{}` in a clocked part", site.text; at site.span, "it changes only at ticks";
        help "remove `over`, or declare the site outside of the clocked part";
    }
    fn several_numbers(site: &Name) = error SiteVariables {
        "no law can be added to `{}`, which is not a single number", site.text;
        at site.span, "a law is a single number";
        help "declare a site for the element or the place of the field that a law may change";
    }
    fn unknown_variable(variable: &Name, class: &str, known: &[&str]) = error UnknownName {
        "there is no `{}` in `{class}`", variable.text; at variable.span, "not known";
        match (nearest(&variable.text, known.iter().copied())) {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "known here: {}", listed(known); }
        }
    }
    fn not_a_variable(here: Span) = error SiteVariables {
        "a law is a function of variables"; at here, "not a variable of the class, nor the derivative of one";
        help "declare a variable with this value, and name it here";
    }
    /// `derivative` is what to write if the first variable has one that can be written.
    fn not_a_rate(
        first: &str, (second, unit): (Span, &str), wanted: &str, derivative: Option<&str>,
    ) = error SiteVariables {
        "this is not a rate of `{first}`"; at second, "in {unit}";
        match derivative {
            None => { help "name a variable in {wanted}"; }
            Some(name) => { help "write `der({name})`, or a variable in {wanted}"; }
        }
    }
    fn holds_no_site(hold: Span, sites: &[&str]) = error SiteVariables {
        "`hold` is not another site"; at hold, "not another site of the class";
        match sites {
            [] => { help "declare the force that holds at rest as a site"; }
            sites => { help "name the force that holds at rest: one of {}", listed(sites); }
        }
    }
    fn holds_another_dimension(site: &str, (hold, unit): (Span, &str), wanted: &str) = error SiteVariables {
        "`{site}` cannot take the law of the site"; at hold, "in {unit}";
        help "name a site in {wanted}";
    }
    fn shape_without_role(shape: &Name, roles: &str) = error SiteVariables {
        "the shape `{}` has no role", shape.text; at shape.span, "tried at no site";
        help "write `output Real f = … over (ROLE);`: {roles}";
    }
    fn unknown_role_of_shape(here: Span, near: Option<&str>, roles: &str) = error SiteVariables {
        "this is not a role of a shape"; at here, "not known";
        match near {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "{roles}"; }
        }
    }
    fn several_signatures(shape: &Name) = error SiteVariables {
        "the shape `{}` has several signatures", shape.text; at shape.span, "one is allowed";
        help "leave one of them";
    }
    fn unknown_signature(mark: &Name, known: &[&str]) = error SiteVariables {
        "`{}` is not a signature", mark.text; at mark.span, "not known";
        help "the signatures are {}", listed(known);
    }
    fn signature_of_no_constant(shape: &Name, here: Span) = error SiteVariables {
        "the shape `{}` has no such constant", shape.text; at here, "not a constant of the shape";
        help "name a constant that says where the shape is, or remove the parentheses";
    }
    fn not_in_a_shape(shape: &Name) = error SiteVariables {
        "the shape `{}` has an element that is not allowed", shape.text;
        at shape.span, "allowed are inputs, variables, outputs, filters and a signature";
        help "remove the element, or the signature: a function without one is not a shape";
    }
    fn constant_without_value(constant: &Name) = error SiteVariables {
        "the constant `{}` of a shape has no value to begin with", constant.text;
        at constant.span, "neither a variable of a site nor with a value";
        help "write `{} = {{…}} in … .. …`; the variables are `v`, `x`, `a`, `u`, `t`, `v1`, `x1`, `a1`, `u1`, `t1`, `v_max`, `a_max`, `u_max`, `x_min`, `x_max`, `t_min`, `t_max`", constant.text;
    }
    fn constant_without_range(constant: &Name) = error SiteVariables {
        "the constant `{}` of a shape has no range", constant.text; at constant.span, "no range";
        help "write the values that records determine: `{} = … in 0 .. v_max`", constant.text;
    }
    fn not_a_count(word: &str, here: Span) = error SiteVariables {
        "`{word}` is not a whole number"; at here, "counts something";
        help "write `{word} = 2`";
    }
    fn unknown_attribute(attribute: &Reference, known: &[&str]) = error SiteVariables {
        "`{}` is not an attribute here", attribute.dotted(); at attribute.span, "not known";
        help "write one of {}", listed(known);
    }
    fn not_a_filter(equation: Span) = error SiteVariables {
        "this equation of a shape is not a filter"; at equation, "a shape can only filter one of its values";
        help "write `tau*der(late) = v - late;`";
    }
    fn filters_nothing(name: &str, equation: Span, known: &[&str]) = error UnknownName {
        "there is no `{name}` in this shape that is filtered"; at equation, "not known";
        help "known here: {}", listed(known);
    }
    fn no_value_in_shape(name: &str, shape: Span) = error SiteVariables {
        "`{name}` of a shape has no value"; at shape, "declared without one";
        help "write `{name} = …`, or its filter `tau*der({name}) = … - {name};`";
    }
    fn depends_on_records(expr: Span) = error SiteVariables {
        "a shape depends on what records show"; at expr, "a law holds for other records too";
        help "use a constant of the shape, or a round value: `v1`, `x1`, `t1`";
    }
}
