//! Functions and types of other languages and tools that Hyde calls otherwise, each with what to write.

use crate::habits::CHOICE;

/// What to write for a function of another language, by its name without a package: `ln`, `pow`, `diff`.
#[must_use]
pub fn instead_of_function(name: &str) -> Option<&'static str> {
    let (_, help) = FUNCTIONS.iter().find(|(names, _)| names.contains(&name))?;
    Some(help)
}

/// What to write for a type of another language: `double`.
pub(crate) fn instead_of_type(name: &str) -> Option<&'static str> {
    let (_, help) = TYPES.iter().find(|(names, _)| names.contains(&name))?;
    Some(help)
}

const FUNCTIONS: [(&[&str], &str); 11] = [
    (&["ln"], "the natural logarithm is `log(x)`"),
    (&["pow", "power"], "a power is written `x^2`"),
    (
        &["diff", "derivative", "ddt", "gradient"],
        "the derivative by the time is `der(x)`",
    ),
    (&["fabs"], "the magnitude is `abs(x)`"),
    (
        &["round"],
        "a value is rounded to a step by `round_to(x, 1)`, in a clocked part or in `measured`",
    ),
    (&["fmod", "rem"], "the remainder is `mod(x, 1)`"),
    (&["step", "heaviside", "ifelse", "where"], CHOICE),
    (
        &["interp1", "interp", "lookup"],
        "a curve through points is `table(x, {0, 1, 2}, {0, 1, 4})`",
    ),
    (
        &["clock", "Clock", "sampled", "previous"],
        "what a clock computes is written `clocked control(1 [ms]) … end control;`, the value at the last tick `pre(x)`",
    ),
    (&["arcsin"], "the function is called `asin`"),
    (&["arccos"], "the function is called `acos`"),
];

const TYPES: [(&[&str], &str); 5] = [
    (
        &["double", "float", "number", "real"],
        "write `Real`, or the quantity that it is: `Length`",
    ),
    (&["int", "integer"], "write `Integer`"),
    (&["bool", "boolean"], "write `Boolean`"),
    (
        &["wrap"],
        "an effect changes what a variable is by `wrap F by F + dF;`",
    ),
    (
        &["replace"],
        "an effect puts another part in the place of one by `replace link by SoftLink;`",
    ),
];
