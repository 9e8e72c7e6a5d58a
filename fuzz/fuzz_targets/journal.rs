//! Any bytes are records of a journal up to where they are not; a record that is found is written with the same bytes.
#![no_main]

use hyde_experiment::batch::{Scanned, record, scan};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    // What was written is found.
    let (key, rest) = data.split_at(data.len() / 3);
    if let Ok(key) = std::str::from_utf8(key) {
        let written = record(key, rest);
        let length = written.len();
        let found = Scanned::Record {
            key,
            bytes: rest,
            length,
        };
        assert_eq!(scan(&written), found);
        // Cut off, it is not there.
        assert!(!matches!(
            scan(&written[..length - 1]),
            Scanned::Record { .. }
        ));
    }
    let mut at = 0;
    while let Scanned::Record { key, bytes, length } = scan(&data[at..]) {
        assert_eq!(record(key, bytes), data[at..at + length]);
        at += length;
    }
});
