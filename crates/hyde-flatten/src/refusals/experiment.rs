//! What is said of experiments: solver, stimuli, figures, budgets, frequency responses and open loops.

use crate::words::{listed, short};
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

const TO_CUT: &str = "open the loop at an input, an output, a clocked variable or a variable declared with its value; if there is none, add one to the loop: `Angle measured = rotor.phi;`";

diagnostics! {
    fn no_experiment(name: &str, file: Span) = error NoExperiment {
        "the file has no experiment `{name}`"; at file, "searched in this file";
    }
    fn expects_number(condition: Span) = error WrongType {
        "an expectation is a condition"; at condition, "a number";
        help "compare it: `expect max(abs(e)) < 10 [um]`";
    }
    fn twice_in_budget(name: &Name, first: Span) = error Duplicate {
        "the budget has `{}` twice", name.text; at name.span, "here again"; at first, "here first";
        help "give it another name, or combine all changes in one: `play(a.gap = 0, b.gap = 0)`";
    }
    fn unknown_method(method: &Name) = error BadSolve {
        "there is no method `{}`", method.text; at method.span, "not known";
        help "methods are `ida`, `esdirk` and `auto`: `solve ida(rtol = 1e-6)`";
    }
    fn unknown_option(name: &str, here: Span) = error BadSolve {
        "the solver has no option `{name}`"; at here, "not known";
        help "options are `rtol`, `atol`, `max_step` and `conserve`";
    }
    fn not_positive(name: &str, here: Span) = error BadSolve {
        "`{name}` must be positive"; at here, "zero or less";
        help "write `{}`, for example, or leave it out", match name {
            "rtol" => "rtol = 1e-6",
            "atol" => "atol = 1e-9",
            "max_step" => "max_step = 1 [ms]",
            _ => "every 1 [ms]",
        };
    }
    fn conserve_is_no_truth(value: Span) = error BadSolve {
        "`conserve` is `true` or `false`"; at value, "neither of them";
        help "write `conserve = true` where energy must be kept over a long run, else leave it out";
    }
    fn not_a_free_input(target: &Reference, bound: bool, inputs: &[&str]) = error NotAnInput {
        "`{}` is not a free input of the model", target.dotted(); at target.span, "cannot be driven";
        match inputs {
            _ if bound => { help "it has a value in the model: take that away, and it can be driven"; }
            [] => { help "declare it in the model: `input Length r;`"; }
            inputs => { help "its inputs are {}", listed(inputs); }
        }
    }
    fn drives_no_element(target: &Reference) = error NotAnInput {
        "`{}` has no such element to drive", target.dotted(); at target.span, "one element is driven at a time";
        help "write its number: `stimulus {}[1] = …;`", target.dotted();
    }
    fn noise_without_column(target: &Reference, value: Span) = error NoColumn {
        "`{}` has noise, but its stimulus is not a single column", target.dotted();
        at value, "neither a column of a record nor a column times a number";
        help "only a recorded column has noise: remove `~`, or write `file.i ~ 15 [mA]`";
    }
    fn not_driven(name: &str, declared: Span, experiment: Option<&str>) = error UndrivenInput {
        "the input `{}` is not driven", short(name); at declared, "a free input of the model";
        match experiment {
            Some(experiment) => { help "write in `experiment {experiment}`: `stimulus {name} = …;`"; }
            None => { help "run an experiment that drives it: `stimulus {name} = …;`"; }
        }
    }
    fn figure_twice(name: &Name) = error Duplicate {
        "there is already a figure `{}`", name.text; at name.span, "its files would overwrite those of the first";
        help "give it another name";
    }
    fn circle_among_panels(panel: Span) = error BadArguments {
        "a circle is combined with other panels"; at panel, "its axes are lengths, not times";
        help "use a separate figure: `figure contour = circle(x, y, R);`";
    }
    fn circle_over(over: Span) = error BadArguments {
        "a circle cannot be plotted over another variable"; at over, "x and y are its axes";
        help "leave out `over`";
    }
    fn circle_takes_three(call: Span) = error BadArguments {
        "`circle` takes x, y and the radius"; at call, "x and y are relative to the centre";
        help "write `circle(x, y - 25 [mm], 25 [mm])`";
    }
    fn named_arguments_of_circle(call: Span) = error BadArguments {
        "the arguments of `circle` have no names"; at call, "x and y are relative to the centre";
        help "write `circle(x, y - 25 [mm], 25 [mm])`";
    }
    fn response_of_no_input(input: &str, here: Span) = error NotAnInput {
        "`{input}` is not an input"; at here, "a frequency response starts at an input of the model";
    }
    fn steps_of_an_element(method: Span) = error NotAnInput {
        "stepped sines drive an input that is not an array"; at method, "this input is an element";
        help "declare an input of its own: `input Force F1;`, and `Force F[2] = {{F1, F2}};`";
    }
    fn no_modes(of: &Reference, known: &[&str]) = error UnknownName {
        "`{}` has no modes", of.dotted(); at of.span, "no `modes` block";
        help "modes are in {}", listed(known);
    }
    fn no_mode(path: &str, mode: &Name, known: &[&str]) = error UnknownName {
        "`{path}` has no mode `{}`", mode.text; at mode.span, "not known";
        help "its modes are {}", listed(known);
    }
    fn cuts_no_signal(signal: &Reference) = error CannotCut {
        "`{}` is not a signal: a loop cannot be opened there", signal.dotted();
        at signal.span, "not a variable of the model";
        help "{TO_CUT}";
    }
    fn cuts_array(signal: &Reference) = error CannotCut {
        "`{}` is an array: a loop cannot be opened there", signal.dotted();
        at signal.span, "name one of its elements";
        help "{TO_CUT}";
    }
    fn cuts_no_equation(signal: &Reference) = error CannotCut {
        "`{}` has no equation of its own: a loop cannot be opened there", signal.dotted();
        at signal.span, "no equation of its own: `name = …`";
        help "{TO_CUT}";
    }
    fn unknown_steps(method: &Name) = error BadSolve {
        "no response is measured by `{}`", method.text; at method.span, "not known";
        help "write `by stepped(amplitude = …)`; a swept sine is the stimulus itself";
    }
    fn unknown_option_of_steps(here: Span, known: &[&str]) = error BadSolve {
        "`stepped` has no such option"; at here, "not known";
        help "its options are {}", listed(known);
    }
    fn no_amplitude(method: Span) = error BadSolve {
        "a stepped sine has an amplitude"; at method, "none is given";
        help "write `by stepped(amplitude = 0.25 [V])`, in the unit of the input";
    }
    fn keep_without_level(alone: Span) = error BadSolve {
        "`keep` and `level` go together"; at alone, "alone here";
        help "write `keep = table.acc, level = 1 [m/s2]`";
    }
    fn keeps_no_response(text: &str, here: Span, responses: &[&str]) = error BadSolve {
        "`{text}` is not one of the responses"; at here, "cannot be kept at a level";
        help "the responses are {}", listed(responses);
    }
}
