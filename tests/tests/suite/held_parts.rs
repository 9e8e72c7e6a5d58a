//! What modes hold: a blow frees it, and friction between two bodies holds their relative speed.

use crate::models::close;
use hyde_experiment::Options;
use hyde_sim::EventKind;
use hyde_tests::Example;

/// The times of the changes of modes with the mode entered; some speeds; the times of the rows.
type Changes = (Vec<(f64, usize)>, Vec<Vec<f64>>, Vec<f64>);

fn changes(file: &str, experiment: &str) -> Changes {
    let example = Example::load(format!("tests/cases/{file}"), Some(experiment)).unwrap();
    let (compiled, run) = example.run_with(&Options::default()).unwrap();
    let events = run.results.events.iter();
    let changes = events.filter_map(|event| match event.kind {
        EventKind::Transition { to, .. } => Some((event.t, to)),
        EventKind::When | EventKind::Relation(_) | EventKind::Slide { .. } => None,
    });
    let wanted = ["target.v", "table.v", "load.v"];
    let columns = wanted
        .iter()
        .filter_map(|name| compiled.program.output(name));
    let columns = columns.map(|output| run.results.column(output).unwrap().to_vec());
    (changes.collect(), columns.collect(), run.results.time)
}

#[test]
fn a_blow_frees_what_friction_holds_and_it_comes_to_rest_again() {
    let (changes, columns, time) = changes("blow_on_a_held_mass/hit.hyde", "hit");
    // 2 m/s over 1 m; then 2 m/s fall by 10 N on 1 kg.
    let [(struck, slip), (rests, stuck)] = changes[..] else {
        panic!("{changes:?}");
    };
    assert_eq!((slip, stuck), (1, 0));
    close(struck, 0.5, 1e-9);
    close(rests, 0.7, 1e-9);
    let still = time.iter().zip(&columns[0]);
    let mut still = still.filter(|(t, _)| **t < struck || **t > rests);
    assert!(still.all(|(_, &v)| v == 0.0));
}

#[test]
fn bodies_that_friction_joins_move_as_one_until_it_slips() {
    let (changes, columns, time) = changes("friction_by_a_rate/rel.hyde", "run");
    // 2 N on 2 kg are 1 m/s2, and 12 N on both: 30 N*sin(2 pi t) = 12 N.
    close(changes[0].0, 0.4_f64.asin() / std::f64::consts::TAU, 1e-7);
    let speeds = columns[0].iter().zip(&columns[1]);
    let together = time.iter().zip(speeds).filter(|(t, _)| **t < changes[0].0);
    for (_, (table, load)) in together {
        close(*table, *load, 1e-15);
    }
}
