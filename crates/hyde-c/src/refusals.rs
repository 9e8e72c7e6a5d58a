//! Every diagnostic of programs that cannot be stepped with a fixed step, as data.

use hyde_diag::{Span, diagnostics};

diagnostics! {
    fn has_delay(delayed: Span) = error CannotExport {
        "C code with a fixed step has no `delay`: it keeps no past values"; at delayed, "delayed here";
        help "put the delay into a `clocked` part as values of earlier ticks, or export with `hyde export fmu`";
    }
    fn chooses_states(candidates: &[String], equation: Option<Span>) = error CannotExport {
        "C code with a fixed step has fixed states; the run of this model chooses its states anew among `{}`",
            candidates.join("`, `");
        if let Some(equation) = equation { at equation, "one of their equations"; }
        help "write the constraint in coordinates that stay independent, or export with `hyde export fmu`";
    }
    fn not_whole_steps((what, time): (&str, &str), (clock, here): (&str, Span), step: &str) = error CannotExport {
        "the {what} of the clock `{clock}`, {time} ms, is not a whole number of steps of {step} ms"; at here, "this clock";
        help "choose a step that divides the periods, delays and first ticks of all clocks: `--step 1e-4`";
    }
    fn no_period(clock: Span) = error CannotExport {
        "the period of a clock is not above 0"; at clock, "this clock";
        help "use a delay of at most one period, or export with `hyde export fmu`";
    }
    fn delay_longer_than_period(clock: Span) = error CannotExport {
        "the held values of a clock change more than a period after their tick"; at clock, "this clock";
        help "use a delay of at most one period, or export with `hyde export fmu`";
    }
}
