//! Hard events, each with a known answer.

use hyde_tests::events::CASES;

#[test]
fn hard_events_come_out_as_known() {
    let wrong: Vec<String> = CASES
        .iter()
        .filter_map(|case| {
            let outcome = (case.check)();
            outcome.err().map(|told| format!("{}: {told}", case.name))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
