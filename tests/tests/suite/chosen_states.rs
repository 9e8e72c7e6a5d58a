//! States where the author wants them: the same motion, and what `hyde check` tells of the choice.

use crate::models::{close, solve};

#[test]
fn a_gear_is_integrated_at_the_end_that_its_author_chose() {
    for (experiment, state, other) in [
        ("motor", "motor.phi", "table.phi"),
        ("table", "table.phi", "motor.phi"),
    ] {
        let solved = solve("chosen", experiment);
        let states = &solved.compiled.states;
        assert!(states.states.iter().any(|name| name == state), "{states:?}");
        let given = states.dependent.iter().find(|(name, _)| name == other);
        assert_eq!(given.unwrap().1.instance.as_str(), "gear");
        // J + J2/9 = 4e-3 kg.m2 at the motor: 1 rad/s2, so 2 rad after 2 s; rtol 1e-9.
        let last = solved.time().len() - 1;
        close(solved.column("motor.phi")[last], 2.0, 1e-8);
        close(solved.column("table.phi")[last], 2.0 / 3.0, 1e-8);
    }
}

#[test]
fn the_stretch_of_a_spring_can_be_a_state() {
    let solved = solve("chosen", "stretch");
    let states = &solved.compiled.states.states;
    assert!(
        states.iter().any(|name| name == "spring.s_rel"),
        "{states:?}"
    );
    assert!(
        states.iter().any(|name| name == "spring.v_rel"),
        "{states:?}"
    );
    // Two masses of 1 kg at 50 N/m: the stretch is -sin(10 t)/10 m, the middle goes at 0.5 m/s; rtol 1e-9.
    let last = solved.time().len() - 1;
    close(
        solved.column("spring.s_rel")[last],
        -0.1 * 10.0_f64.sin(),
        1e-7,
    );
    let middle = solved.column("left.s")[last] + solved.column("right.s")[last];
    close(middle / 2.0, 0.5, 1e-7);
}

#[test]
fn a_state_that_must_be_one_is_never_chosen_away() {
    let solved = solve("chosen", "swing");
    let program = &solved.compiled.program;
    let states = &solved.compiled.states;
    let chosen = &states.chosen[0];
    assert_eq!(
        (chosen.states, chosen.candidates.join(" ")),
        (1, "x y".to_owned())
    );
    let selection = &program.selections[0];
    let y = chosen
        .candidates
        .iter()
        .position(|name| name == "y")
        .unwrap();
    let memory = &solved.run.results;
    close(selection.weights[y], 0.0, 0.0);
    // The rod keeps its length, and its energy 9.81*0.6: rtol 1e-9.
    let last = memory.time.len() - 1;
    let at = |name: &str| solved.column(name)[last];
    close(at("x").powi(2) + at("y").powi(2), 1.0, 1e-8);
    let energy = (at("vx").powi(2) + at("vy").powi(2)) / 2.0 + 9.81 * at("y");
    close(energy, -9.81 * 0.6, 1e-6);
}
