//! What is said of states: of those that modes fix, that are chosen, differentiated, reinitialised or started twice.

use super::words::{and, plural, quoted};
use super::{Part, Place};
use hyde_diag::{Origin, Span, diagnostics};

/// Why a variable is not a state.
pub(crate) enum NoState {
    /// Its value is constant.
    Constant,
    /// Nothing has its derivative.
    NotDifferentiated,
    /// This equation determines it from variables of which modes fix these.
    OthersAreFixed(Span, Vec<String>),
    /// This equation determines it from others that are chosen too.
    OthersAreChosen(Span),
    /// This equation determines it from others.
    Follows(Span),
}

diagnostics! {
    fn constrained_in_mode(mode: &str, states: &[String], equation: Span, part: Option<Part>) = error Constrained {
        "in the mode `{mode}` {} are constrained to each other", quoted(states).join(" and ");
        at equation, "this equation determines one from the others, but only in this mode";
        if let Some((part, here)) = part { at here, "in `{part}`"; }
        note "Hyde chooses the states for all modes together; a mode may only fix a state to a number";
        help "replace the mode by a stiff spring and a damper, or make the relative motion a state and fix that";
    }
    /// Both are automata with the place of their component.
    fn two_pins(state: &str, second: (&str, Span), first: (&str, Span), equation: Span) = error TwoPins {
        "`{}` and `{}` both fix `{state}`", first.0, second.0;
        for (name, here) in ([second, first]) { at here, "`{name}` fixes it"; }
        at equation, "by this equation of its mode";
        note "two set-valued frictions on one body, or on rigidly joined bodies, have no unique distribution of the force";
        help "make one an effect of the other, or put a spring between them";
    }
    fn no_force(mode: &str, state: &str, (force, here): (&str, Span)) = error BadPin {
        "the mode `{mode}` fixes `{state}`, but no force holds it";
        at here, "`{force}` is free in this mode and does not act on `{state}`";
        help "let the block determine the force in its other modes, and connect it to the body it holds";
    }
    fn idle_start(start: &str, variable: &str, here: Span) = warning BadSet {
        "`{start}` has no effect"; at here, "`{variable}` follows from other variables at every time";
        help "set the start of a state from which it follows";
    }
    fn prescribed((automaton, here): (&str, Span), mode: &str, part: Option<Part>) = warning BadPin {
        "the mode `{mode}` of `{automaton}` cannot hold a motion that is prescribed";
        if let Some((part, here)) = part { at here, "`{part}` acts on a prescribed motion"; }
        at here, "`{mode}` is skipped while the motion is at rest";
        note "at rest its force is not determined by the prescribed motion: Hyde uses the force of the first mode that gives one";
        help "to see it stick, drive the body by a force, or put a `SpringDamper` between the drive and the friction";
    }
    /// So many constraints tie all variables, and `most` of these can be what those listed are to be.
    fn too_many_chosen(
        chosen: &[Part], (what, word): (&str, &str), (constraints, all, most): (usize, usize, usize), places: &[Origin],
    ) = error StateChoice {
        "{} cannot all {what}: {} {} {all} variables",
            chosen.iter().map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", "),
            plural(constraints, "constraint"), match constraints { 1 => "ties", _ => "tie" };
        for (_, here) in chosen { at *here, "`state = {word}`"; }
        for origin in places { at origin.span, "a constraint between them"; }
        help "at most {} of these variables can be states; write `{word}` for at most {most}", all - constraints;
    }
    /// A variable with the word of its choice, and why it is no state.
    fn cannot_be_state((name, word): (&str, &str), (part, here): Place, why: &NoState) = error StateChoice {
        "`{name}` cannot be a state";
        match part {
            Some(part) => { at part, "`state = {word}`"; at here, "declared here"; }
            None => { at here, "`state = {word}`"; }
        }
        match why {
            NoState::Constant => {
                note "its value is known and constant";
                help "remove the choice, or free it";
            }
            NoState::NotDifferentiated => {
                note "no equation has its derivative, and no constraint between states could be solved for another one";
                help "choose a variable that is differentiated, or the derivative of one";
            }
            NoState::OthersAreFixed(equation, fixed) => {
                at *equation, "this equation determines it from other states";
                note "modes fix {}, as a sticking friction does: a variable that a mode fixes has to be a state", and(fixed);
                help "remove `state = {word}`";
            }
            NoState::OthersAreChosen(equation) => {
                at *equation, "this equation determines it from other states";
                help "write `prefer` or `always` only for it among the variables of this constraint";
            }
            NoState::Follows(equation) => {
                at *equation, "this equation determines it from other states";
                help "remove `state = {word}`, or write `avoid` for another variable of this constraint";
            }
        }
    }
    fn must_be_state((name, word): (&str, &str), (part, here): Place) = error StateChoice {
        "`{name}` must be a state: there is no alternative";
        match part {
            Some(part) => { at part, "`state = {word}`"; at here, "declared here"; }
            None => { at here, "`state = {word}`"; }
        }
        note "no constraint determines it from other states, so it has to be integrated";
        help "remove `{word}`";
    }
    fn too_many_conditions(equations: &[Span], free: usize, fixed: &[Part]) = error TooManyConditions {
        "{} for {free} states that are not fixed", plural(equations.len(), "initial equation");
        for &equation in equations { at equation, "an initial equation"; }
        for (name, here) in fixed { at *here, "`{name}` is fixed here"; }
        help "remove `fixed = true` from the states that an initial equation is to determine";
    }
    /// Two variables with their start values and places, and the state that both are.
    fn different_starts(
        (a, value, here): (&str, &str, Span), (b, second, other): (&str, &str, Span), state: &str,
    ) = error ConflictingStarts {
        "`{a}` and `{b}` are rigidly joined and have different start values";
        at here, "`{a}` starts at {value}"; at other, "`{b}` starts at {second}";
        note "both are `{state}`";
        help "give both the same start value, or remove `fixed` from one";
    }
    fn reinit_of_no_state(variable: &str, event: Span, states: &[String]) = error WrongType {
        "`{variable}` is not a state"; at event, "reinitialised here";
        note "it is computed from other variables";
        match states {
            [] => { help "it does not depend on any state: an event cannot set it"; }
            [state] => { help "reinitialise `{state}`, from which it is computed"; }
            states => { help "reinitialise the states that it is computed from: `{}`", states.join("`, `"); }
        }
    }
    fn derivative_of_column(column: &str, equation: Span) = error Constrained {
        "the derivative of the recorded column `{column}` is needed"; at equation, "by this equation";
        help "drive the model by a force or through a spring, or give the velocity as a stimulus too";
    }
    fn derivative_of_delayed(variable: &str, equation: Span, delay: Span) = error Constrained {
        "the derivative of `{variable}` is needed"; at equation, "by this equation"; at delay, "delayed here";
        help "drive the model by a force or through a spring: what is delayed may jump, and has no derivative there";
    }
}
