//! What is said of values: their kind, their shape and elements, and when they are known.

use crate::words::{listed, short};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

/// A value as a word: a truth or a number.
fn kind(truth: bool) -> &'static str {
    match truth {
        true => "true or false",
        false => "a number",
    }
}

diagnostics! {
    fn uses_itself(parameter: &str, here: Span) = error Cycle {
        "the value of `{parameter}` uses `{parameter}`"; at here, "in a circle";
    }
    fn no_value_at_top(parameter: &str, declared: Span, unit: &str) = error NoValue {
        "the parameter `{parameter}` has no value"; at declared, "declared without a value";
        help "give it one: `{} = …{unit}`", short(parameter);
    }
    /// `part` is the component that gives none, its class and its name.
    fn no_value_given(
        parameter: &str, declared: Span, unit: &str, (here, class, part): (Span, &str, &str),
    ) = error NoValue {
        "the parameter `{parameter}` has no value"; at here, "gives no `{}`", short(parameter);
        at declared, "declared without a value";
        help "write `{class} {part}({} = …{unit});`", short(parameter);
    }
    fn wrong_kind(truth: bool, (here, found): (Span, bool)) = error WrongType {
        "{} is expected here", match truth { true => "a Boolean", false => "a number" }; at here, "{}", kind(found);
    }
    fn number_for_truth(here: Span, written: &str) = error WrongType {
        "expected Boolean, found number"; at here, "a number";
        help "compare it: `{written} > 0`";
    }
    fn truth_for_number(here: Span) = error WrongType {
        "expected number, found Boolean"; at here, "true or false";
        help "write `if … then 1 else 0`";
    }
    fn kinds_differ((left, a): (Span, bool), (right, b): (Span, bool)) = error WrongType {
        "a Boolean and a number are combined"; at left, "{}", kind(a); at right, "{}", kind(b);
    }
    fn text_as_value(here: Span) = error WrongType {
        "a text is not a value"; at here, "a text";
    }
    fn bad_unit(fact: &str, here: Span, repair: Option<String>) = error BadUnit {
        "{fact}"; at here, "in this unit";
        if let Some(repair) = repair { help "{repair}"; }
    }
    fn not_constant(what: &str, here: Span) = error NotConstant {
        "{what} changes during the run"; at here, "only numbers and parameters are allowed here";
    }
    fn expression_not_constant(here: Span) = error NotConstant {
        "the expression is not constant"; at here, "only numbers and parameters are allowed here";
    }
    fn not_an_integer(value: f64, here: Span) = error NotConstant {
        "{value} is not an integer"; at here, "counts something";
        help "write an integer, or an `Integer` parameter";
    }
    fn found_at_start(parameter: &str, declared: Span) = error NotConstant {
        "`{parameter}` is not constant: it is computed at the start of the run";
        at declared, "`fixed = false`: an initial equation determines it";
        help "give it a value and remove `fixed = false`: a size, a branch or a mesh depends on it";
    }
    fn compared_twice(both: Span, repair: &str) = error WrongType {
        "a number is compared with what is true or false"; at both, "a comparison has two sides";
        help "write `{repair}`";
    }
    fn compared_for_equality(sign: &str, here: Span) = error WrongType {
        "`{sign}` of continuous values: they are hardly ever equal"; at here, "compares values that change continuously";
        help "compare with `<` or `>`; within a distance, `abs(x - y) < 1e-6`";
    }
    fn inexact_power(here: Span) = error UnitMismatch {
        "a dimension to this power is not exact"; at here, "use an exponent such as 1/2 or 2/3";
    }
    fn unknown_part_of_clock(word: &str, here: Span) = error BadArguments {
        "a clock has no `{word}`"; at here, "unknown";
        help "write `clocked name(1 [ms], delay = 0.2 [ms], phase = 0 [s])`, or `clocked name(event = angle > next)`";
    }
    fn no_period(clocked: &Name) = error BadArguments {
        "`{}` has no period", clocked.text; at clocked.span, "how often?";
        help "write `clocked {}(1 [ms])`", clocked.text;
    }
    fn bad_period(shown: &str, here: Span) = error NotAllowed {
        "a clock cannot tick every {shown}"; at here, "the period must be above 0 s";
        help "write the time from tick to tick: `clocked name(1 [ms])`";
    }
    fn bad_delay(shown: &str, here: Span) = error NotAllowed {
        "a clock cannot have a delay of {shown}"; at here, "`delay` must be 0 s or more";
        help "write the time from a tick to what it gives out, `delay = 0.1 [ms]`; a tick that comes earlier has a `phase`";
    }
    /// `class` is that of the connector or component; `variable` one of its own.
    fn part_as_value(
        path: &str, here: Span, (class, connector): (&str, bool), variable: Option<&str>,
    ) = error WrongType {
        "`{path}` is a {} ({class}), not a value", what(connector); at here, "a {}", what(connector);
        help "{}{}", match connector {
            true => format!("connect it, `connect({path}, …);`, or "),
            false => String::new(),
        }, match variable {
            Some(variable) => format!("name one of its variables: `{path}.{variable}`"),
            None => "name a variable of one of its parts".to_owned(),
        };
    }
    fn domain_as_value(domain: &str, here: Span) = error FieldUse {
        "`{domain}` is a domain, not a value"; at here, "a domain";
    }
    fn signal_for_number(name: &str, here: Span) = error BadArguments {
        "`{name}` changes during the run, but one number is needed"; at here, "expected one number, found a signal";
        help "reduce it to one number: `last({name})`, `max({name})`, `rms({name})`, …";
    }
    fn clocked_in_continuous(name: &str, here: Span) = error ClockBorder {
        "`{name}` belongs to a clocked part"; at here, "read by a continuous equation";
        help "hold it between ticks: `hold({name})`";
    }
    fn continuous_in_clocked(name: &str, here: Span) = error ClockBorder {
        "`{name}` is continuous"; at here, "read in a clocked part";
        help "read it at the tick: `sample({name})`";
    }
    fn unknown_in_function(name: &Reference, known: &[&str]) = error UnknownName {
        "there is no `{}` in this function", name.dotted(); at name.span, "not known";
        note "a function can use only its inputs and its earlier declarations";
        help "known here: {}", listed(known);
    }
    fn second_subscript(here: Span) = error BadShape {
        "arrays have one dimension in this version"; at here, "a second subscript";
    }
    fn which_component((array, rest): (&str, &str), count: usize, here: Span) = error BadShape {
        "`{array}` is an array of {count} components"; at here, "which one?";
        help "name one: `{array}[1]{rest}`";
    }
    fn no_component(count: usize, (here, number): (Span, i64)) = error BadShape {
        "there are components 1 to {count}"; at here, "component {number}";
    }
    fn components_out_of_range(count: usize, slice: Span) = error BadShape {
        "there are components 1 to {count}"; at slice, "is out of range";
    }
    fn numbers_of_components(count: usize, expected: usize, here: Span) = error BadShape {
        "{count} components are combined with arrays of {expected}"; at here, "{count} components";
    }
    fn part_of_value(value: &Reference, part: &Name) = error UnknownName {
        "`{}` has no `{}`: it is not a component", value.dotted(), part.text; at part.span, "a value has no elements";
    }
    fn arrays_of_arrays(components: usize, values: usize, here: Span) = error BadShape {
        "{components} components with {values} values each"; at here, "arrays in two directions at once";
        help "name the component, or loop over them: `for i in 1:n loop … end for;`";
    }
    fn no_element(array: &Reference, (first, last): (i32, i64), (here, number): (Span, i32)) = error BadShape {
        "`{}` has elements {first} to {last}", array.dotted(); at here, "element {number}";
    }
    fn slice_out_of_range((first, last): (i32, i64), slice: Span) = error BadShape {
        "the elements are {first} to {last}"; at slice, "is out of range";
    }
    fn lengths_differ(len: usize, expected: usize, here: Span) = error BadShape {
        "an array of {len} is combined with arrays of {expected}"; at here, "has {len} elements";
    }
    fn lengths_of_slice_differ(count: usize, expected: usize, slice: Span) = error BadShape {
        "{count} elements are combined with arrays of {expected}"; at slice, "has {count} elements";
    }
    fn lengths_of_list_differ(len: usize, expected: usize, list: Span) = error BadShape {
        "{len} values are combined with arrays of {expected}"; at list, "{len} values";
    }
    fn array_for_value(len: usize, here: Span) = error BadShape {
        "expected one value, found an array"; at here, "has {len} elements";
        help "name an element, `x[1]`, or sum them, `sum(x)`";
    }
    fn slice_for_value(count: usize, slice: Span) = error BadShape {
        "expected one value, found an array"; at slice, "{count} elements";
        help "name an element, `x[1]`, or sum them, `sum(x[1:2])`";
    }
    fn list_for_value(list: Span) = error BadShape {
        "expected one value, found a list"; at list, "a list";
    }
    fn long_list(len: i64, most: i64, list: Span) = error BadShape {
        "a list of {len} elements"; at list, "at most {most}";
    }
    fn not_as_many(found: usize, len: usize, here: Span) = error BadShape {
        "{found} values for {len} elements"; at here, "{found} values";
        help "give a value for each element, or one value for all without braces";
    }
    fn not_an_array(name: &Reference) = error BadShape {
        "`{}` is not an array", name.dotted(); at name.span, "has no elements";
    }
}

fn what(connector: bool) -> &'static str {
    match connector {
        true => "connector",
        false => "component",
    }
}
