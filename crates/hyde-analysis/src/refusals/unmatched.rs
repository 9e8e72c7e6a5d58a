//! What is said of equations and unknowns that do not match.

use super::words::{a_few, parts_as_words, plural, quoted, short};
use super::{Part, Place};
use hyde_diag::{Origin, Span, diagnostics};

diagnostics! {
    fn missing_boundary(end: &str, flux: &str, (part, here): Place, instance: &str) = error MissingBoundary {
        "no boundary condition at `{end}`"; at here, "its flux at `{end}` is not determined";
        if let Some(part) = part { at part, "in `{instance}`"; }
        note "each end needs one condition, and one more for each connector variable set there";
        help "write `{flux} = 0 indomain {end};` for a free end, or give the value of the field there";
    }
    fn unbound_input(input: &str, (part, here): Place) = error UnboundInput {
        "the input `{input}` has no source";
        if let Some(part) = part { at part, "gives no `{}`", short(input); }
        at here, "declared here";
        help "bind it where its component is declared: `({} = …)`, or write an equation: `{input} = …;`", short(input);
    }
    fn undetermined_elements(array: &str, size: usize, (part, here): Place) = error TooFewEquations {
        "the equations do not determine all elements of `{array}`";
        if let Some(part) = part { at part, "in this component"; }
        at here, "an array of {size} elements";
        help "write an equation for each: `for i in 1:{size} loop {}[i] = …; end for;`", short(array);
    }
    /// The equations that contain it, and all unknowns of these.
    fn undetermined(
        unknown: &str, (part, here): Place, equations: &[Origin], unknowns: &[String], repair: &str,
    ) = error TooFewEquations {
        "no equation determines `{unknown}`";
        if let Some(part) = part { at part, "in this component"; }
        at here, "declared here";
        match equations {
            [] => {}
            equations => {
                note "{} for the {} unknowns {}",
                    plural(equations.len(), "equation"), unknowns.len(), a_few(unknowns, 6);
                for origin in (equations.iter().take(3)) {
                    match (origin.instance.as_str()) {
                        "" => { at origin.span, "this equation is among them"; }
                        instance => { at origin.span, "this equation of `{instance}` is among them"; }
                    }
                }
            }
        }
        help "{repair}";
    }
    /// `open` are the unknowns that are open with it, all of them or `more`.
    fn likely_undetermined(
        unknown: &str, (part, here): Place, containing: &[Span], (open, more): (&[String], bool), repair: &str,
    ) = error TooFewEquations {
        "no equation determines `{unknown}`";
        if let Some(part) = part { at part, "in this component"; }
        at here, "declared here";
        for &equation in containing { at equation, "contains it, but is needed for another unknown"; }
        match open {
            [] => {}
            open => {
                note "with it {}{} {} open", quoted(open).join(", "), match more { true => ", …", false => "" },
                    match open { [_] => "is", _ => "are" };
            }
        }
        help "{repair}";
    }
    fn missing_equation() = error TooFewEquations {
        "an equation is missing";
    }
    fn redundant_equation((part, here): Place) = error TooManyEquations {
        "this equation is redundant";
        if let Some(part) = part { at part, "an equation too many in this component"; }
        at here, "other equations determine all its variables";
        help "remove it, or the equations that determine its variables";
    }
    fn constrained(states: &[String], equation: Span) = error Constrained {
        "{} are constrained to each other", quoted(states).join(" and ");
        at equation, "this equation determines one from the others";
        note "each of them is a state with an equation for its derivative: the model needs index reduction";
        help "put a spring between the parts, or describe the joined parts by one of the states";
    }
    fn constrained_arrays(states: &[String], equation: Span) = error Constrained {
        "{} are constrained to each other", quoted(states).join(" and ");
        at equation, "this equation determines one from the others";
        note "a constraint between whole arrays can be differentiated if it is solved for one of them: `x[i] = …`";
        help "solve it for one of the arrays, or put a stiffness between the parts";
    }
    fn too_many_equations(equations: &[Origin], unknowns: &[String]) = error TooManyEquations {
        "{} for {}: {}", plural(equations.len(), "equation"), plural(unknowns.len(), "unknown"), a_few(unknowns, 6);
        for origin in (equations.iter().take(8)) {
            match (origin.instance.as_str()) {
                "" => { at origin.span, "one of the equations"; }
                instance => { at origin.span, "one of the equations, of `{instance}`"; }
            }
        }
        match (instances(equations).as_slice()) {
            [] => {}
            instances => { note "in {}", quoted(instances).join(", "); }
        }
        help "remove one of them, or put a spring between the parts that both of them constrain";
    }
    /// `body` is what is missing.
    fn no_inertia(parts: &[Part], body: &str) = error TooManyEquations {
        "{}", match parts {
            [(only, _)] => format!("on one side of `{only}` no part has inertia"),
            several => format!("the part between {} has no inertia", parts_as_words(several)),
        };
        for (number, (part, here)) in (parts.iter().take(6).enumerate()) {
            match number {
                0 => { at *here, "determines a force in some mode, but no motion"; }
                _ => { at *here, "`{part}` determines the same force"; }
            }
        }
        note "while it slips or is open, no equation determines the motion of the adjacent part without inertia";
        match parts {
            [(only, _)] => { help "put {body} between `{only}` and what it is connected to there"; }
            _ => { help "put {body} between them"; }
        }
    }
    fn array_not_whole(
        array: &str, (declared, size): (Span, usize), most: usize, reading: Option<Span>,
    ) = error ArrayEquation {
        "the equations of `{array}` do not determine it as a whole"; at declared, "an array of {size} elements";
        if let Some(reading) = reading { at reading, "reads it"; }
        note "up to {most} elements would be unrolled one by one";
        help "write one equation for each run of elements: `for i in 2:n-1 loop der(x[i]) = …; end for;` and one for each end";
    }
}

/// The components that have the first of these equations.
fn instances(equations: &[Origin]) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    for origin in equations.iter().take(8) {
        let instance = origin.instance.as_str().to_owned();
        if !instance.is_empty() && !found.contains(&instance) {
            found.push(instance);
        }
    }
    found
}
