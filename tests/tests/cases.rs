//! Every case of `tests/cases` gets the right answer.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_tests::cases;
use rayon::prelude::*;
use std::path::Path;

#[test]
fn every_case_gets_the_right_answer() {
    let hyde = Path::new(env!("CARGO_BIN_EXE_hyde-tested"));
    let wrong: Vec<String> = cases::folders()
        .unwrap()
        .par_iter()
        .filter_map(|folder| {
            let reason = cases::check(folder, hyde).err()?;
            Some(format!("{}: {reason}", folder.display()))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}
