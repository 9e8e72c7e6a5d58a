//! What is said of equations that conflict, in the words of a drive.

use super::Part;
use super::words::{a_few, parts_as_words, plural, quoted, some_of};
use hyde_diag::{Origin, Span, diagnostics};

diagnostics! {
    fn determines_parameter(parameter: &str, equation: Span, declared: Span) = error TooManyEquations {
        "`{parameter}` is a parameter: this equation cannot determine it";
        at equation, "other equations determine all its variables"; at declared, "its value is given here";
        help "if the equation should determine `{parameter}`, declare it without `parameter` and without a value";
    }
    /// `open` is an unknown that has no equation for that.
    fn loose((part, here): (&str, Span), ends: &[String], open: Option<&str>) = error TooManyEquations {
        "{} {} connected to nothing", quoted(ends).join(" and "), match ends { [_] => "is", _ => "are" };
        at here, "`{part}` is not connected at this end";
        if let Some(open) = open {
            note "the flow at an unconnected connector is 0, so no equation determines `{open}`";
        }
        help "connect {}, or remove `{part}`", match ends { [_] => "it", _ => "one of them" };
    }
    fn floating(what: &str, parts: &[Part]) = error TooFewEquations {
        "no equation fixes the {what} of {}", parts_as_words(parts);
        for (number, (part, here)) in (parts.iter().take(4).enumerate()) {
            match number {
                0 => { at *here, "the {what} of `{part}` is defined only relative to the others"; }
                _ => { at *here, "and that of `{part}`"; }
            }
        }
        note "their flows already sum to 0 in each of these connections";
        match what {
            "voltage" => { help "connect a `Ground` to one node of the circuit"; }
            "angle" | "place" => {
                help "connect one of them to a body with mass or to a `Fixed`; springs alone do not define a position";
            }
            _ => { help "connect a component that defines its {what}"; }
        }
    }
    /// `place` is where the parts fix `what`; `open` is what is not determined for that, and at which connector.
    fn held_twice(
        (what, place): (&str, &str), parts: &[Part], joined: Span, equations: &[Origin], open: Option<(&str, &str)>,
    ) = error TooManyEquations {
        "{} {}", parts_as_words(parts), match parts {
            [_, _] => format!("both fix {place}"),
            _ => format!("fix {place} once too often"),
        };
        for (number, (part, here)) in (parts.iter().take(6).enumerate()) {
            match number {
                0 => { at *here, "one part that fixes it"; }
                _ => { at *here, "`{part}` fixes it too"; }
            }
        }
        at joined, "they are joined here";
        for origin in equations { at origin.span, "an equation of `{}`", origin.instance; }
        if let Some((flow, connector)) = open {
            note "the distribution of the {flow} at `{connector}` is not determined";
        }
        match what {
            "voltage" => { help "remove one, or put a resistance between them"; }
            "current" => { help "remove one, or give the current at the node another path"; }
            "temperature" => { help "remove one, or put a thermal resistance between them"; }
            "angle" | "place" | "speed" => { help "remove one, or put a spring between them"; }
            _ => { help "remove one of them"; }
        }
    }
    fn equation_of_assigned(name: &str, equation: Span, when: Span) = error TooManyEquations {
        "`{name}` has an equation, and a `when` sets it"; at equation, "its equation"; at when, "set here";
        note "what a `when` sets keeps its value between events: no equation determines it";
        help "write one of the two: leave the equation out, or set another variable in the `when`";
    }
    /// So many equations for so many unknowns, of which some have names; parts, connections and open ends that take part in it;
    /// unknowns that are open for it, and one that is set for all times.
    fn conflicting(
        (count, unknowns, names): (usize, usize, &[String]), own: &[Origin], parts: &[Part], connections: &[Span],
        ends: &[(String, &str, Span)], open: &[String], set: Option<&str>,
    ) = error TooManyEquations {
        "{}", match (count, unknowns) {
            (1, 0) => "this equation determines no variable".to_owned(),
            _ if count > unknowns => format!(
                "{} for {}: {}", plural(count, "equation"), plural(unknowns, "unknown"), some_of(names, unknowns)
            ),
            _ => format!("one of the {count} equations of {} is redundant", some_of(names, unknowns)),
        };
        for (number, origin) in (own.iter().take(4).enumerate()) {
            at origin.span, "{}", match number { 0 => "one of these is redundant", _ => "one of them" };
        }
        for (part, here) in (parts.iter().take(4)) { at *here, "the equations of `{part}` are among them"; }
        for &connection in connections { at connection, "this connection is among them"; }
        for (end, what, here) in ends { at *here, "`{end}` is not connected: its {what} is already 0"; }
        match open {
            [] => {}
            open => { note "no equation determines {}", a_few(open, 4); }
        }
        match (set, parts, open) {
            (Some(name), ..) => {
                help "remove one of them; the declaration of `{name}` holds at every time: write `{name}(start = …)` where only its start is meant";
            }
            (None, [], []) => { help "remove one of them"; }
            (None, [], _) => { help "remove one of them, or rewrite it so that it determines the open unknown"; }
            (None, ..) => { help "remove one of them, or put a spring between the parts that both fix a motion"; }
        }
    }
    /// `place` is what the parts fix, and `speed` what they force to be 0.
    fn jammed(place: &str, speed: &str, parts: &[Part], equations: &[Span]) = error Jammed {
        "{} {} {place} in contradictory ways: nothing can move", parts_as_words(parts),
            match parts { [_, _] => "both fix", _ => "fix" };
        for (number, (part, here)) in (parts.iter().take(6).enumerate()) {
            match number {
                0 => { at *here, "one rigid part"; }
                _ => { at *here, "`{part}` is rigid too, with another ratio"; }
            }
        }
        for &equation in equations { at equation, "holds its ends in one ratio"; }
        note "together they force `{speed}` to be 0";
        help "remove one, give it the ratio of the others, or put a spring between them";
    }
    fn closed_once_more(own: &[Span], parts: &[Part]) = error TooManyEquations {
        "{} constrain each other redundantly", match parts {
            [] | [_] => "constraints".to_owned(),
            several => parts_as_words(several),
        };
        for &constraint in (own.iter().take(4)) { at constraint, "a constraint among them"; }
        for (number, (part, here)) in (parts.iter().take(8).enumerate()) {
            match number {
                0 => { at *here, "one of the rigid parts that close a loop"; }
                _ => { at *here, "`{part}` is another"; }
            }
        }
        note "with these dimensions the loop can move, but one of its parts is redundant: the distribution of the force is not determined";
        help "remove one, or replace one strut and its joints by a `SpringDamper`";
    }
}
