//! What is said of values: bounds, integers, asserts of parameters, circles of parameters.

use hyde_diag::{Span, diagnostics};
use hyde_units::Kind;

diagnostics! {
    fn bound_not_a_number(bound: Span) = error NotConstant {
        "a bound is not a number"; at bound, "depends on a parameter";
        help "write a number, or state the condition: `assert(k < k_max, \"…\");`";
    }
    fn value_not_allowed(name: &str, value: &str, refusal: &str, kind: Kind, here: Span) = error NotAllowed {
        "`{name}` cannot be {value}: {refusal}"; at here, "its value is given here";
        match kind {
            Kind::Integer => { help "round it, `integer(x)`, or declare it `Real`"; }
            Kind::Real | Kind::Boolean => {}
        }
    }
    fn assert_false(message: &str, here: Span) = error AssertFailed {
        "{message}"; at here, "false for the values that its parameters have";
        help "give them other values: `hyde params FILE` lists them, with where each comes from";
    }
    fn maybe_no_integer(name: &str, value: Span) = error NotAllowed {
        "`{name}` is an Integer, and its value may not be an integer"; at value, "may have a fraction";
        help "round it where values are sampled or set, `integer(…)`, or declare `{name}` as `Real`";
    }
    /// Parameters whose values use each other, each the next.
    fn circle_of_parameters(names: &[String], places: &[Span]) = error Cycle {
        "{}", match names {
            [only] => format!("the value of {only} uses itself"),
            several => format!("the values of {} use each other", several.join(", ")),
        };
        for (number, &place) in (places.iter().enumerate()) {
            at place, "uses {}", names[(number + 1) % names.len()];
        }
        help "give one of them a number";
    }
}
