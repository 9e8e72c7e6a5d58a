//! Arguments that are refused before anything is computed.

use hyde_ida::{Error, Ida, Options, Pattern, PatternError};

use crate::robertson::Robertson;

type Change = fn(&mut Options);

fn options() -> Options {
    Options::new(1e-4, vec![1e-6; 3], vec![true, true, false])
}

fn refusal(options: Options, y0: &[f64], yp0: &[f64]) -> Error {
    match Ida::new(Robertson, Pattern::dense(3).unwrap(), options, 0.0, y0, yp0) {
        Ok(_) => panic!("this should be refused"),
        Err(error) => error,
    }
}

#[test]
fn no_unknowns() {
    let error = Pattern::new(0, vec![0], vec![]).unwrap_err();
    assert_eq!(error, PatternError::NoUnknowns);
    assert_eq!(
        Error::from(error).to_string(),
        "the system has no unknowns: there is nothing for IDA to solve"
    );
}

#[test]
fn wrong_lengths() {
    let error = refusal(options(), &[1.0, 0.0], &[0.0; 3]);
    assert_eq!(
        error,
        Error::Length {
            what: "y",
            expected: 3,
            found: 2
        }
    );
    let error = refusal(options(), &[0.0; 3], &[]);
    assert_eq!(
        error,
        Error::Length {
            what: "yp",
            expected: 3,
            found: 0
        }
    );
    let error = refusal(
        Options {
            atol: vec![1e-6],
            ..options()
        },
        &[0.0; 3],
        &[0.0; 3],
    );
    assert_eq!(
        error,
        Error::Length {
            what: "atol",
            expected: 3,
            found: 1
        }
    );
    let error = refusal(
        Options {
            differential: vec![],
            ..options()
        },
        &[0.0; 3],
        &[0.0; 3],
    );
    assert_eq!(
        error,
        Error::Length {
            what: "differential",
            expected: 3,
            found: 0
        }
    );
}

#[test]
fn numbers_that_are_none() {
    let error = refusal(options(), &[1.0, f64::NAN, 0.0], &[0.0; 3]);
    assert_eq!(
        error,
        Error::NotFinite {
            what: "y",
            index: 1
        }
    );
    let error = refusal(options(), &[1.0, 0.0, 0.0], &[0.0, 0.0, f64::INFINITY]);
    assert_eq!(
        error,
        Error::NotFinite {
            what: "yp",
            index: 2
        }
    );
}

#[test]
fn options_out_of_range() {
    let changes: [(&str, Change); 6] = [
        ("rtol", |options| options.rtol = -1e-4),
        ("atol", |options| options.atol[1] = 0.0),
        ("max_order", |options| options.max_order = 6),
        ("max_step_s", |options| options.max_step_s = 0.0),
        ("first_step_s", |options| {
            options.first_step_s = Some(f64::INFINITY)
        }),
        ("first_step_s", |options| options.first_step_s = Some(-1.0)),
    ];
    for (name, change) in changes {
        let mut options = options();
        change(&mut options);
        match refusal(options, &[1.0, 0.0, 0.0], &[0.0; 3]) {
            Error::Option { what, .. } => assert_eq!(what, name),
            error => panic!("{error}"),
        }
    }
}
