//! What is said of frequency responses, margins and state spaces.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn no_response_from(why: &str, here: Span) = error NoResponse {
        "{why}"; at here, "there is no response from here";
    }
    fn response_needs_derivative(input: &str, here: Span) = error NoResponse {
        "the equations need the time derivative of `{input}`, so its response is not defined";
        at here, "differentiated in the model";
        help "use that derivative as the input: for a prescribed motion the acceleration, with speed and position as its integrals";
    }
    fn cannot_compare_response(response: &str, why: &str, measured: Span) = error BadResponse {
        "the response `{response}` cannot be compared: {why}"; at measured, "measured here";
    }
    fn loop_needs_derivative(signal: &str, cut: Span) = error CannotCut {
        "the loop needs the derivative of `{signal}` by the time, which a test signal does not have";
        at cut, "differentiated by what reads it";
        help "open the loop at another signal: at the output of the controller, or before the differentiation";
    }
    fn no_moment(why: &str, cut: Span) = error NoResponse {
        "{why}"; at cut, "linearised there";
    }
    fn loop_without_response(why: &str, cut: Span) = error NoResponse {
        "{why}"; at cut, "the loop has no response here";
    }
    fn sampled_loop(signal: &str, cut: Span) = error CannotCut {
        "`{signal}` is continuous, but clocks close its loop: it has no single open-loop response";
        at cut, "continuous, in a sampled loop";
        help "cut where the loop is sampled: at a clocked variable, or at a signal that is `hold(…)` of one";
    }
    fn slower_clock(signal: &str, cut: Span) = error CannotCut {
        "`{signal}` is in a loop with a slower clock: its response differs from tick to tick";
        at cut, "sampled faster than its loop";
        help "cut at a signal of the slowest clock of the loop, or open the outer loop: set its gain to 0";
    }
    fn no_direction(signal: &str, cut: Span) = error CannotCut {
        "the equation of `{signal}` does not determine it: other equations do, so its direction is not defined";
        at cut, "no signal with a direction";
        help "cut at a signal of the loop: an input, an output or a clocked variable; or let the loop read one: `Angle measured = rotor.phi;`";
    }
    fn nothing_held(signal: &str, cut: Span) = error CannotCut {
        "no clocked part is held: `{signal}` drives nothing"; at cut, "in no loop";
        help "cut at a signal whose value the model reads";
    }
    fn empty_band(cut: Span) = error NoResponse {
        "the band of frequencies is empty"; at cut, "nothing to search";
        help "write `over 1 .. 500 [Hz]`, of a sampled loop below half its rate";
    }
    fn singular_loop(hertz: &str, cut: Span) = error NoResponse {
        "the loop is singular at {hertz} Hz"; at cut, "no response there";
        help "search beside it: `over 1 .. 500 [Hz]`";
    }
    fn state_space_needs_derivative(input: &str, parameter: Option<Span>) = error CannotExport {
        "the equations need the time derivative of `{input}`, so a state space has no such input";
        if let Some(parameter) = parameter { at parameter, "differentiated in the model"; }
        help "name the other inputs with `--input`, or use that derivative as the input: for a prescribed motion the acceleration, with speed and position as its integrals";
    }
    fn delay_in_state_space(delay: Option<Span>) = error CannotExport {
        "a model with a `delay` has infinitely many states, and a state space finitely many";
        if let Some(delay) = delay { at delay, "delayed here"; }
        help "`hyde bode` has the exact response; for a state space write the delay as a rational function, or inside a `clocked` part as values of earlier ticks";
    }
    fn no_common_period(why: &str, clock: Option<Span>) = error CannotExport {
        "{why}";
        if let Some(clock) = clock { at clock, "a clock of the loop"; }
        help "choose periods that are multiples of one another and delays below a period, or export the plant alone with `--open`";
    }
}
