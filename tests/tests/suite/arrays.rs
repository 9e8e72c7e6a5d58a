//! Arrays of components and of values: what each element gets, and what is joined with what.

use crate::models::{close, solve};

#[test]
fn every_element_gets_its_value_of_a_list_an_array_or_a_comprehension() {
    let pushed = solve("arrays", "pushed");
    let end = |name: &str| *pushed.column(name).last().unwrap();
    // From rest v = F/M*t at 1 s; the rates are constant, so nothing but rounding is left at rtol 1e-9.
    for (element, force, mass) in [(1, 1.0, 2.0), (2, 4.0, 4.0), (3, 9.0, 8.0)] {
        close(end(&format!("listed[{element}].v")), force / mass, 1e-12);
        close(
            end(&format!("each_alike[{element}].v")),
            2.0 * force / 2.0,
            1e-12,
        );
        // F = -i, M = 2*i.
        close(end(&format!("counted[{element}].v")), -0.5, 1e-12);
    }
    close(end("total"), 0.5 + 1.0 + 9.0 / 8.0, 1e-12);
    // Slices of arrays of components: the first two of one against the last two of the other.
    close(end("difference[1]"), 0.5 + 0.5, 1e-12);
    close(end("difference[2]"), 1.0 + 0.5, 1e-12);
}

#[test]
fn nested_arrays_take_nested_lists() {
    let nested = solve("arrays", "nested");
    let value = |name: &str| {
        let program = &nested.compiled.program;
        let (parameter, element) = program.parameter(name).unwrap();
        nested.run.parameters[parameter.place + element]
    };
    let masses = [[1.0, 2.0], [3.0, 4.0]];
    for (wagon, row) in (1..).zip(masses) {
        for (body, mass) in (1..).zip(row) {
            let name = format!("wagon[{wagon}].body[{body}].M");
            close(value(&name), mass, 1e-15);
            let name = format!("same[{wagon}].body[{body}].M");
            close(value(&name), 7.0, 1e-15);
        }
        // `each` gives the whole list to every component.
        close(value(&format!("same[{wagon}].k[1]")), 5.0, 1e-15);
        close(value(&format!("same[{wagon}].k[2]")), 6.0, 1e-15);
    }
    // Joined bodies move as one, each pair at the speed it starts with.
    for wagon in 1..=2 {
        for (body, speed) in [(1, 0.1), (2, 0.2)] {
            let column = nested.column(&format!("wagon[{wagon}].body[{body}].s"));
            close(*column.last().unwrap(), speed, 1e-9);
        }
    }
}

#[test]
fn elements_of_a_clocked_array_are_held_apart() {
    let sampled = solve("arrays", "sampled");
    let end = |name: &str| *sampled.column(name).last().unwrap();
    // 0.1 s of each of the counts 1 to 10; exact but for the steps' errors at rtol 1e-9.
    close(end("x[1]"), 5.5, 1e-9);
    close(end("x[2]"), -11.0, 1e-9);
}

#[test]
fn elements_of_an_array_are_delayed_apart() {
    let late = solve("arrays", "late");
    let end = |name: &str| *late.column(name).last().unwrap();
    // Straight lines half a second ago, read by interpolation of the run's own steps at rtol 1e-9.
    close(end("y[1]"), 1.5, 1e-8);
    close(end("y[2]"), 3.0, 1e-8);
}
