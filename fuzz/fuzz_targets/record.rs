//! Any bytes become a record that can be looked at, or are refused; with nothing declared of their layout, or with one of the
//! kinds.
#![no_main]

use hyde_signal::{Layout, LayoutKind, parquet};
use libfuzzer_sys::fuzz_target;
use std::panic;

fuzz_target!(
    init: {
        // A damaged Parquet file may panic in its reader, which is a thread for that reason.
        let usual = panic::take_hook();
        panic::set_hook(Box::new(move |told| {
            if std::thread::current().name() != Some(parquet::READER) {
                usual(told);
            }
        }));
    },
    |data: &[u8]| {
        let Some((&first, bytes)) = data.split_first() else {
            return;
        };
        let words: Vec<&str> = LayoutKind::words().collect();
        let kind = words.get(usize::from(first) % 32);
        let layout = Layout {
            kind: kind.and_then(|word| LayoutKind::of_word(word)),
            every_s: (first & 32 != 0).then_some(1e-3),
            header: (first & 64 != 0).then_some(2),
            decimal: (first & 128 != 0).then_some(','),
            ..Layout::default()
        };
        match hyde_signal::read(bytes, &layout) {
            Ok(table) => {
                assert!(table.columns().iter().all(|column| column.in_unit().len() == column.values().len()));
                let _ = hyde_signal::look::look(&table);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
        let _ = hyde_signal::read_frame(bytes);
    }
);
