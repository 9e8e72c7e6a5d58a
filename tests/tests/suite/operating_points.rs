//! What a model is linearised about: that of its run, and what is assumed there is told.

use hyde_tests::linear::{Verdict, compare, wrong_poles};

#[test]
fn linearised_models_do_what_their_runs_do_or_say_what_they_assume() {
    let mut agree = 0;
    for seed in 0..24 {
        match compare(seed).unwrap() {
            Verdict::Agrees => agree += 1,
            Verdict::Told | Verdict::Nothing => {}
            Verdict::Wrong(reason) => panic!("seed {seed}: {reason}"),
        }
    }
    assert!(agree >= 12, "{agree} of 24 could be followed");
}

#[test]
fn sampled_loops_have_the_poles_of_their_runs() {
    for seed in 0..8 {
        assert_eq!(wrong_poles(seed).unwrap(), None, "seed {seed}");
    }
}
