//! What is said of calls: of functions, of the words of clocked parts and events, of delays and derivatives, and of tables.

use crate::words::{listed, nearest};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Declarator, Name, Reference};
use hyde_units::significant;

diagnostics! {
    fn named_argument(function: &str, here: Span) = error BadArguments {
        "`{function}` takes no named arguments"; at here, "named";
        help "give the arguments in their order, without names";
    }
    fn number_of_arguments(
        function: &str, (takes, given): (String, usize), here: Span, usage: Option<&str>,
    ) = error BadArguments {
        "`{function}` takes {takes} argument{}, not {given}", match takes.as_str() { "1" => "", _ => "s" }; at here, "called here";
        if let Some(usage) = usage { help "write `{usage}`"; }
    }
    /// `instead` is what to write where it looks like something else.
    fn unknown_function(function: &Reference, instead: Option<String>, known: &[&str]) = error UnknownFunction {
        "there is no function `{}`", function.dotted(); at function.span, "not known";
        match instead {
            Some(instead) => { help "{instead}"; }
            None => {
                match (nearest(&function.dotted(), known.iter().copied())) {
                    Some(near) => { help "did you mean `{near}`?"; }
                    None => {
                        help "import its package, or declare it: `function twice input Real x; output Real y = 2*x; end twice;`";
                    }
                }
            }
        }
    }
    fn unknown_method(function: &Reference, instead: &str) = error UnknownFunction {
        "there is no function `{}`", function.dotted(); at function.span, "not known";
        help "{instead}";
    }
    fn calls_itself(function: &Name) = error Cycle {
        "`{}` calls itself", function.text; at function.span, "calls itself";
        help "a function is an expression: it cannot call itself";
    }
    fn long_chain_of_calls(most: usize, function: Span) = error TooDeep {
        "more than {most} functions call each other in a chain"; at function, "called once more here";
        help "write the expression where it is called, in fewer functions";
    }
    fn too_many_calls(outermost: &str, most: usize, function: Span) = error TooDeep {
        "a call of `{outermost}` leads to more than {most} others"; at function, "called once more here";
        help "give a call that a function uses twice a name: `Real part = f(x);`";
    }
    fn several_outputs(function: &str, here: Span, count: usize, [first, second]: [Span; 2]) = error BadArguments {
        "the function `{function}` has {count} outputs, and a call gives one value"; at here, "called here";
        at first, "one output"; at second, "another one";
        help "write a function for each of them; declare without `output` what only the function needs";
    }
    fn no_such_input(function: &Name, (named, here): (Option<&Name>, Span)) = error BadArguments {
        "`{}` {}", function.text, match named {
            Some(word) => format!("has no input `{}`", word.text),
            None => "takes fewer arguments".to_owned(),
        };
        at here, "not an input"; at function.span, "declared here";
    }
    fn no_output(function: &Name) = error BadArguments {
        "the function `{}` has no output", function.text; at function.span, "gives no value";
        help "declare one: `output Force F = c*v^2;`";
    }
    fn more_than_declarations(function: &Name) = error NotYet {
        "the function `{}` has more than declarations", function.text;
        at function.span, "inputs, variables and an output, each with its value";
        help "give the value where it is declared: `output Force F = c*v^2;`";
    }
    fn input_not_given(function: &str, input: &Declarator, here: Span) = error BadArguments {
        "`{function}` needs its input `{}`", input.name.text; at here, "not given";
        at input.name.span, "declared here";
    }
    fn no_value_in_function(function: &str, variable: &Declarator) = error NoValue {
        "`{}` of `{function}` has no value", variable.name.text; at variable.name.span, "declared without one";
        help "write `{} = …`", variable.name.text;
    }
    fn pre_of_expression(here: Span) = error BadArguments {
        "`pre` takes a variable"; at here, "an expression";
    }
    fn pre_without_meaning(variable: &Reference, here: Span) = error ClockBorder {
        "`pre({})` has no meaning here", variable.dotted(); at here, "there is no value before";
        help "`pre` takes a variable of the same clocked part, or a discrete one at an event";
    }
    fn sample_outside_clocked(here: Span) = error ClockBorder {
        "`sample` outside a clocked part"; at here, "there is no clock here";
        help "`sample` brings a continuous value into `clocked … end`";
    }
    fn sample_of_clocked(part: &str, here: Span) = error ClockBorder {
        "the sampled value belongs to the clocked part `{part}`"; at here, "clocked already";
        help "read it without `sample`";
    }
    fn hold_in_clocked(here: Span) = error ClockBorder {
        "`hold` inside a clocked part"; at here, "nothing to hold here";
        help "read the variable of the other clocked part directly";
    }
    fn hold_of_continuous(name: &Reference) = error ClockBorder {
        "`{}` is continuous, and nothing holds it", name.dotted(); at name.span, "no variable of a clocked part";
        help "read it as it is, `{}`; what a part computes is held by its name, `hold(control.u)`", name.dotted();
    }
    fn hold_of_several(count: usize, here: Span) = error ClockBorder {
        "`hold` takes a value of one clocked part"; at here, "belongs to {count}";
        help "hold each value separately";
    }
    fn held_of_no_column(here: Span) = error BadArguments {
        "`held` takes a column of a record"; at here, "no column";
        help "a clocked value is held with `hold`";
    }
    fn interval_outside_clocked(here: Span) = error ClockBorder {
        "`interval()` outside a clocked part"; at here, "there is no clock here";
    }
    fn delay_in_clocked(here: Span) = error ClockBorder {
        "`delay` inside a clocked part"; at here, "here time advances in ticks";
        help "`pre(x)` is one tick ago; a continuous value is delayed outside: `sample(delay(u, T))`";
    }
    fn delay_without_time(here: Span) = error NotConstant {
        "`delay` has no meaning here"; at here, "there is no time here";
        help "declare a variable `v = delay(u, T)` and use that";
    }
    fn negative_delay(seconds: f64, here: Span) = error BadArguments {
        "a delay of {seconds} s"; at here, "is negative";
        help "a delay must be 0 or more: future values are not known";
    }
    fn delay_of_arrays(here: Span) = error ArrayEquation {
        "an expression of whole arrays cannot be delayed"; at here, "has no name";
        help "give it one: `Real u[n] = …;` and write `delay(u, T)`";
    }
    fn derivative_of_parameter(here: Span) = error ClockBorder {
        "no derivative exists here"; at here, "of a parameter";
    }
    fn derivative_in_clocked(written: &str, here: Span) = error ClockBorder {
        "`{written}` is not a variable of this clocked part";
        at here, "in a clocked part `der` is the difference to the last tick";
        help "declare a variable with its value before the first tick: `Real u(start = …) = {written};`, and write `der(u)`";
    }
    fn second_derivative(here: Span) = error BadArguments {
        "the derivative of a derivative"; at here, "needs a name for the first derivative";
        help "declare it: `Velocity v = der(s);` and write `der(v)`";
    }
    fn derivative_of_delayed(here: Span) = error BadArguments {
        "the derivative of a delayed value"; at here, "is not known here";
        help "delay the derivative: `delay(der(u), T)`";
    }
    /// `found` is what stands in the place of the variable.
    fn partial_by_no_variable(here: Span, found: &str) = error BadArguments {
        "the second argument of `partial` is a variable"; at here, "{found}";
    }
    fn edge_between_events(here: Span) = error BadArguments {
        "an edge has no duration"; at here, "is never true between events";
        help "let an event set a variable: `when b then n = pre(n) + 1; end when;`";
    }
    fn edge_of_expression(here: Span) = error BadArguments {
        "in a clocked part `edge` takes a variable"; at here, "an expression";
        help "give it a name: `Boolean b = …;` and write `edge(b)`";
    }
    fn quantiser_of_continuous(name: &str, here: Span) = error QuantiserOnContinuous {
        "`{name}` on a continuous value"; at here, "every step would be an event, thousands per second";
        help "quantise the sampled value: `{name}(sample(…), …)` in a clocked part, or in `measured`";
    }
    fn reduction_outside_measure(name: &str, here: Span) = error BadArguments {
        "`{name}` of a signal has a meaning over a whole run only"; at here, "not in a measure or expectation";
        help "write it in `measure` or `expect`";
    }
    fn reduction_of_reduction(outer: &str, inner: &str, here: Span) = error BadArguments {
        "`{inner}` inside `{outer}`: a number of the whole run within another one";
        at here, "is known at the end of the run only, and `{outer}` reads a value at each time";
        help "write its value here as a number with its unit: run the experiment with `measure` of it first";
    }
    fn sum_of_one(here: Span) = error BadShape {
        "`sum` takes an array"; at here, "one value";
    }
    fn long_sum(len: usize, here: Span) = error NotYet {
        "`sum` over more than 64 elements in this version"; at here, "has {len} elements";
    }
    fn points_of_table(places: usize, values: usize, here: Span) = error BadShape {
        "{places} places and {values} values"; at here, "a table has a value at each of its places, and two at least";
    }
    fn places_descend(place: f64, next: f64, here: Span) = error BadShape {
        "the places of a table ascend"; at here, "{place} is followed by {next}";
    }
    fn table_of_no_lists(here: Span) = error BadShape {
        "a table is made of two lists"; at here, "no list";
        help "write `table(x, {{0, 1, 2}}, {{0, 1, 4}})`";
    }
    fn columns_of_table(function: &str, here: Span) = error BadArguments {
        "`{function}` of a file takes two columns of it, or none"; at here, "called here";
        help "write `{function}(x, \"grease.csv\", \"v\", \"F\")`";
    }
    fn one_point(file: &str, rows: usize, here: Span) = error BadShape {
        "`{file}` has {rows} row"; at here, "a table has two points at least";
    }
    fn too_many_rows(file: &str, (rows, most): (usize, usize), here: Span) = error BadShape {
        "`{file}` has {rows} rows: a table has {most} at most, for each becomes a branch of the equations";
        at here, "too many rows";
        help "keep one row of {}; what depends on time alone may be a record, which has any number of rows",
            rows.div_ceil(most);
    }
    /// The row below the header has `own`, and the one above it `above`.
    fn rows_descend(
        (column, file): (&str, &str), here: Span, row: usize, (own, above): (f64, f64),
    ) = error BadShape {
        "`{column}` of `{file}` does not ascend";
        at here, "row {row} below the header has {}, the row above it {}", significant(own, 6), significant(above, 6);
        help "sort the rows by the places, each once";
    }
    fn single_column(file: &str, here: Span) = error NoColumn {
        "`{file}` has one column"; at here, "a table has places and values";
    }
    fn column_without_quotes(here: Span) = error BadArguments {
        "a column of a file is named in quotes"; at here, "not the name of a column";
        help "write `table(x, \"grease.csv\", \"v\", \"F\")`";
    }
    fn no_column(file: &str, (column, here): (&str, Span), known: &[&str]) = error NoColumn {
        "`{file}` has no column `{column}`"; at here, "not in its header";
        match (nearest(column, known.iter().copied())) {
            Some(near) => { help "did you mean `{near}`?"; }
            None => { help "it has {}", listed(known); }
        }
    }
}
