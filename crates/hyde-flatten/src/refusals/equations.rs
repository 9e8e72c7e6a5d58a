//! What is said of equations: loops and branches, events, modes, and clocked parts that tick at events.

use crate::words::listed;
use hyde_diag::{Span, diagnostics};
use hyde_syntax::ast::{Name, Reference};

diagnostics! {
    fn reinit_outside_event(state: Span) = error Misplaced {
        "`reinit` outside an event"; at state, "when?";
        help "write it in `when … then`, or after an exit of a mode";
    }
    fn branches_differ(branches: Span, counts: &[String]) = error ModeEquations {
        "the branches have different numbers of equations"; at branches, "{} equations", counts.join(", ");
        help "every branch, `else` too, determines the same variables";
    }
    fn long_loop(here: Span, turns: usize, most: usize) = error ArrayEquation {
        "a loop over components of {turns} turns"; at here, "unrolled at most {most} times";
        help "use arrays of variables in one component: their equations are not unrolled";
    }
    fn no_element((array, element): (&str, i32), len: usize, (equation, counter): (Span, i32)) = error BadShape {
        "`{array}` has no element {element}"; at equation, "reached for a counter of {counter}";
        help "the array has {len} elements: change the bounds of the loop";
    }
    fn clocked_when(here: Span) = error ClockBorder {
        "`when` inside a clocked part"; at here, "everything here happens at the tick";
        help "write `x = if … then … else pre(x);`";
    }
    /// `part` is the clocked part that computes the variable.
    fn computed_in_clocked(name: &Reference, part: &str) = error ClockBorder {
        "`{}` is not a variable of the clocked part `{part}`", name.dotted(); at name.span, "declared outside of it";
        match (name.as_word()) {
            Some(word) => { help "move its declaration into `clocked {part}(…)`; continuous equations read it as `hold({part}.{word})`"; }
            None => {
                help "compute it in a variable that is declared in `clocked {part}(…)`, `Real u = …;`, and write `{} = hold({part}.u);` under `equation`", name.dotted();
            }
        }
    }
    fn not_an_action(equation: Span) = error Misplaced {
        "an event sets variables one by one"; at equation, "neither `reinit(x, e)` nor `d = e`";
    }
    fn sets_no_variable(target: Span) = error WrongType {
        "no variable to set"; at target, "not a variable";
    }
    fn reinit_of_no_state(target: &Reference) = error WrongType {
        "`{}` is not a state", target.dotted(); at target.span, "only a state can be reinitialised";
        help "set a discrete variable with `=`";
    }
    fn sets_continuous(target: &Reference) = error WrongType {
        "`{}` is continuous", target.dotted(); at target.span, "an event cannot equate it";
        help "let a state jump with `reinit(x, e)`";
    }
    fn clocked_modes(here: Span) = error ClockBorder {
        "`modes` inside a clocked part"; at here, "everything here happens at the tick";
        help "write `x = if … then … else pre(x);`";
    }
    fn array_in_mode(equation: Span) = error ArrayEquation {
        "an array equation in a mode"; at equation, "modes have scalar equations";
    }
    fn values_of_mode(mode: &Name, wanted: usize, given: usize) = error BadArguments {
        "the mode `{}` takes {wanted} values, not {given}", mode.text; at mode.span, "entered here";
    }
    fn no_value_of_mode(mode: &str, named: &Name, instead: &str) = error BadArguments {
        "the mode `{mode}` has no `{}`", named.text; at named.span, "unknown";
        help "it has `{instead}`";
    }
    fn unknown_mode(mode: &Name, known: &[&str]) = error UnknownName {
        "there is no mode `{}` here", mode.text; at mode.span, "not known";
        help "the modes are {}", listed(known);
    }
    fn modes_differ((mode, own): (Span, usize), (first, count): (Span, usize)) = error ModeEquations {
        "the modes have different numbers of equations"; at mode, "{} here", equations(own);
        at first, "{} here", equations(count);
        note "the modes replace each other's equations: each must determine the same unknowns";
        help "write an equation for the same variables in every mode: for a force that vanishes, `F = 0`";
    }
    fn event_clock_with_more(clocked: &Name) = error BadArguments {
        "`{}` ticks at an event, and at nothing else", clocked.text;
        at clocked.span, "its other arguments are of a clock in time";
        help "write `clocked name(event = angle > next)`";
    }
    fn sets_nothing_at_event(equation: Span) = error ClockedEquation {
        "an equation of a clocked part that ticks at an event is not `x = …`"; at equation, "sets no variable";
        help "write `x = …` with the old values as `pre(x)`";
    }
    fn input_unset_at_ticks(name: &str, tick: &str, declared: Span) = error UnboundInput {
        "no equation determines `{name}` at the ticks of `{tick}`"; at declared, "declared here";
        help "give it an equation in the clocked part: `{name} = …;`";
    }
    fn unset_at_ticks(name: &str, tick: &str, declared: Span) = error TooFewEquations {
        "no equation determines `{name}` at the ticks of `{tick}`"; at declared, "declared here";
        help "give it an equation in the clocked part: `{name} = …;`";
    }
    fn circle_at_tick(names: &[String], equations: &[Span]) = error ClockedLoop {
        "{} depend on each other in a loop at one tick", names.join(", ");
        for &equation in equations { at equation, "in the circle"; }
        help "read one of them from the tick before: `pre(x)`";
    }
}

fn equations(count: usize) -> String {
    match count {
        1 => "1 equation".to_owned(),
        count => format!("{count} equations"),
    }
}
