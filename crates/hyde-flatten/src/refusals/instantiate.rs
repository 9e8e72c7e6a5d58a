//! What is said of declarations: components, parameters, variables, arrays, domains, modifications, and FMUs.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

diagnostics! {
    fn no_model(name: &str, (here, what): (Span, &str), models: &[&str]) = error NoExperiment {
        "the file has no model `{name}`"; at here, "{what}";
        match (nearest(name, models.iter().copied())) {
            Some(near) => { help "did you mean `{near}`?"; }
            None if models.is_empty() => { help "it has none"; }
            None => { help "it has {}", listed(models); }
        }
    }
    fn contains_itself(class: &Name) = error Cycle {
        "`{}` contains itself", class.text; at class.span, "contains itself";
        help "a model cannot be a component of itself";
    }
    /// `chain` begins and ends with the class.
    fn extends_itself(class: &Name, chain: &[String]) = error Cycle {
        "`{}` extends itself{}", class.text, match chain {
            [_, _] => String::new(),
            chain => format!(": {}", chain.join(" extends ")),
        };
        at class.span, "declared here";
    }
    fn nested_too_deep(class: Span, most: usize) = error TooDeep {
        "more than {most} components are nested"; at class, "instantiated inside that many others";
        help "put parts beside each other and connect them";
    }
    fn extends_too_much(class: &Name, (in_chain, in_all): (usize, usize)) = error TooDeep {
        "`{}` extends more than {in_chain} classes in a chain, or more than {in_all} in all", class.text;
        at class.span, "its chain of `extends` is too long";
        help "remove classes that add nothing to the class they extend";
    }
    fn clocked_in_clocked(part: Span) = error ClockBorder {
        "a clocked part inside a clocked part"; at part, "move it out of the other";
    }
    fn effect_as_component(effect: &str, here: Span) = error WrongType {
        "`{effect}` is an effect, not a component"; at here, "an effect is added at a site";
        help "write `model New = Old with {effect} on site;`";
    }
    fn component_with_value(component: &str, value: Span) = error WrongType {
        "the component `{component}` cannot equal an expression"; at value, "a value for a component";
        help "modify its parameters: `Mass m(M = 3 [kg]);`";
    }
    fn cannot_redeclare(here: Span, declared: &Name, class: &str) = error FinalModified {
        "`{}` is not replaceable", declared.text; at here, "cannot be redeclared";
        at declared.span, "declared here as not replaceable";
        help "declare it `replaceable {class} {}`", declared.text;
    }
    fn declared_twice(name: &Name, first: Option<Span>) = error Duplicate {
        "`{}` is declared twice", name.text; at name.span, "declared again here";
        if let Some(first) = first { at first, "declared first here"; }
        help "rename one of the two, or remove it";
    }
    fn bad_length(length: i64, here: Span) = error BadShape {
        "an array cannot have {length} elements"; at here, "the number of elements";
    }
    fn second_dimension(here: Span) = error NotYet {
        "arrays have one dimension in this version"; at here, "a second dimension";
    }
    fn not_discretised(domain: &Name) = error FieldUse {
        "the domain `{}` is not discretised", domain.text; at domain.span, "how many cells?";
        help "write `discretize {} by fem(n = 24);`", domain.text;
    }
    fn unknown_discretisation(method: &Name) = error NotYet {
        "this version has no discretisation `{}`", method.text; at method.span, "not known";
        help "write `fem(n = …)` or `fv(n = …)`, or `f_max = …` for `n = …`";
    }
    fn bad_number_of_cells(domain: &str, (count, here): (i64, Span), most: usize) = error BadArguments {
        "`{domain}` cannot have {count} cells";
        at here, "{}", match count < 2 { true => "at least 2".to_owned(), false => format!("at most {most}") };
    }
    fn unknown_option_of_mesh(here: Span) = error BadArguments {
        "a mesh has no such option"; at here, "not known";
        help "options are `n`, the number of cells, and `f_max`, the highest frequency of waves";
    }
    fn no_domain(name: &Name) = error UnknownName {
        "there is no domain `{}` here", name.text; at name.span, "not known";
        help "declare it: `domain bar(x in 0 .. len);`";
    }
    fn field_without_domain(field: &Name) = error FieldUse {
        "on which domain is the field `{}`?", field.text; at field.span, "a field needs a domain";
        help "write `field … {} on bar;`", field.text;
    }
    fn nothing_to_modify(name: &str, here: Span) = error UnknownModification {
        "there is no `{name}` to modify"; at here, "changes nothing";
    }
    /// `way` leads from the element to what is changed inside it, if that is in parentheses.
    fn modifies_one_element((name, here): (&str, Span), way: &[&str]) = error UnknownModification {
        "`{name}` is not an array of components: a modification cannot change one element of it"; at here, "one element";
        match (way) {
            [] => {
                help "give each element its value: `{name} = {{…, …}}`; `--set` and `vary` set one element";
            }
            way => {
                help "give each element its value: `{name}({} = {{…, …}})`; `--set` and `vary` set one element", way.join(".");
            }
        }
    }
    fn element_of_no_array((name, here): (&str, Span), way: &[&str]) = error UnknownModification {
        "`{name}` is not an array"; at here, "has no elements";
        match (way) {
            [] => { help "write `{name} = …`"; }
            way => { help "write `{name}({} = …)`", way.join("."); }
        }
    }
    fn modified_twice(here: &Reference, first: Span) = error Duplicate {
        "`{}` is modified twice", here.dotted(); at here.span, "here again"; at first, "here first";
        help "remove one of the two";
    }
    fn modifies_no_component(count: usize, here: Span) = error UnknownModification {
        "there are components 1 to {count}"; at here, "changes nothing";
    }
    fn component_without_number(here: Span) = error UnknownModification {
        "a component that is modified is named by one number"; at here, "write a number, as in `car[2].M`";
        help "for values that go with the number, give all components a list: `car(M = {{…, …}})`";
    }
    fn chooses_for_one(target: &Reference, chosen: &Reference) = error UnknownModification {
        "a model cannot be chosen for one component of an array"; at target.span, "one component";
        help "choose a model for all of them, `redeclare {} {}`, or declare the components one by one", chosen.dotted(), target.dotted();
    }
    fn no_element_to_modify(name: &str, here: Span, class: &str, known: &[&str]) = error UnknownModification {
        "there is no `{name}` to modify"; at here, "`{class}` has no such element";
        match (near_but_other(name, known)) {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "it has {}", listed(known); }
        }
    }
    /// `instead` is what to write where another language has such an attribute.
    fn no_attribute(
        attribute: &Reference, of: &str, known: &[&str], instead: Option<String>,
    ) = error UnknownModification {
        "a {of} has no attribute `{}`", attribute.dotted(); at attribute.span, "changes nothing";
        match instead {
            Some(instead) => { help "{instead}"; }
            None => { help "attributes are {}", listed(known); }
        }
    }
    fn model_as_parameter(here: Span) = error WrongType {
        "a model cannot be a parameter"; at here, "this is a model";
        help "declare it without `parameter`; exchange it by `replaceable`";
    }
    fn modifies_final(here: Span, declared: &Name) = error FinalModified {
        "`{}` is final", declared.text; at here, "cannot be modified"; at declared.span, "declared final here";
        help "remove `{}`: modify the parameters from which its value is computed", declared.text;
    }
    /// `circle` is each type with what it is said to be.
    fn type_of_itself(name: &str, circle: &[(Span, String)]) = error Cycle {
        "the type `{name}` is defined by itself";
        for (here, base) in circle { at *here, "is a `{base}`"; }
        help "write `type {name} = Real [unit];`";
    }
    fn flow_outside_connector(name: &str, here: Span) = error BadConnection {
        "`flow` on `{name}`, which is not in a connector"; at here, "only variables of a connector can be `flow`";
    }
    fn unknown_choice_of_states(here: Span) = error UnknownModification {
        "no such choice of states"; at here, "not known";
        help "write `state = always`, `prefer`, `avoid`, `never`, or leave it open";
    }
    fn fmu_without_equations(name: &str, file: &str, here: Span, needs: &str) = error FmuOnlyRuns {
        "{} is the FMU `{file}`; {needs} needs equations, and an FMU has none", match name {
            "" => "the model".to_owned(),
            name => format!("`{name}`"),
        };
        at here, "this component";
        note "an FMU gives values at the ticks of its clock: `hyde run`, `sweep` and `test` run it";
        help "replace it by a model written in Hyde, or leave it out and make what it gives an input";
    }
}

/// The nearest of the known names to the last word of a name, unless it is that word.
fn near_but_other<'n>(name: &str, known: &[&'n str]) -> Option<&'n str> {
    let last = name.rsplit('.').next().unwrap_or(name);
    nearest(last, known.iter().copied()).filter(|near| *near != last)
}
