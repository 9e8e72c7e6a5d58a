//! Any text is a unit or not; a unit keeps its text, and its dimension has a usual unit with that dimension.
#![no_main]

use hyde_units::NamedUnit;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| match NamedUnit::parse(text) {
    Ok(named) => {
        let again = NamedUnit::parse(named.text()).expect("its own text");
        assert_eq!(named, again);
        let usual = NamedUnit::usual(named.unit().dimension);
        assert_eq!(usual.unit().dimension, named.unit().dimension, "{usual}");
        let read = NamedUnit::parse(usual.text()).expect("the usual unit");
        assert_eq!(read.unit().dimension, named.unit().dimension, "{usual}");
        let _ = hyde_units::engineering_as(1.5, &named);
    }
    Err(error) => assert!(!error.to_string().is_empty()),
});
