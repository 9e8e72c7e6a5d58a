//! What is said of the equations of clocked parts.

use super::words::quoted;
use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn not_explicit(variable: &str, equation: Span) = error ClockedEquation {
        "`{variable}` is not given explicitly"; at equation, "cannot be solved for it";
        help "write `x = …` with the old values as `pre(x)`";
    }
    fn loop_at_tick(variables: &[String], equations: &[Span]) = error ClockedLoop {
        "{} depend on each other in a loop at one tick", quoted(variables).join(", ");
        for &equation in equations { at equation, "in the circle"; }
        help "read one of them from the tick before: `pre(x)`";
    }
    fn redundant_at_tick(equation: Span) = error TooManyEquations {
        "this equation is redundant at the tick"; at equation, "other equations determine all its variables";
        help "remove it";
    }
    fn input_unset_at_ticks(name: &str, tick: &str, declared: Span) = error UnboundInput {
        "no equation determines `{name}` at the ticks of `{tick}`"; at declared, "declared here";
        help "give it an equation in the clocked part: `{name} = …;`";
    }
    fn unset_at_ticks(name: &str, tick: &str, declared: Span) = error TooFewEquations {
        "no equation determines `{name}` at the ticks of `{tick}`"; at declared, "declared here";
        help "give it an equation in the clocked part: `{name} = …;`";
    }
    fn loop_of_clocks(parts: &[Span]) = error ClockedLoop {
        "clocked parts read each other at one instant";
        for &part in parts { at part, "in the circle"; }
        help "let one of them sample the held output of the other: `sample(hold(…))` is the previous value";
    }
}
