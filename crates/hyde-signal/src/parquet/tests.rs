//! Frames and records through the bytes of a file and back.

use super::*;
use crate::{Column, Layout, Table, csv};
use hyde_units::NamedUnit;

fn unit(text: &str) -> NamedUnit {
    NamedUnit::parse(text).unwrap()
}

fn example() -> Vec<Column> {
    vec![
        Column::new("t", unit("s"), vec![0.0, 1e-3, 1e-3]),
        Column::new("axis.x", unit("mm"), vec![0.35, -2.5e-7, 0.1 * 3.0]),
        Column::raw("odd [name], ü", vec![1e300, 1.0 / 3.0, -0.0]),
    ]
}

#[test]
fn a_record_comes_back_with_its_units_to_the_bit() {
    let bytes = write(&example()).unwrap();
    assert!(is_parquet(&bytes));
    let table = read(&bytes, &Layout::default()).unwrap();
    assert_eq!(table.columns(), example());
    // Whichever form a file has, it holds the same numbers.
    let text = csv::write(&example()[..2]);
    assert_eq!(
        crate::read(text.as_bytes(), &Layout::default())
            .unwrap()
            .columns(),
        &table.columns()[..2]
    );
    assert_eq!(
        crate::read(&bytes, &Layout::every(0.5)).unwrap().period(),
        Some(0.5)
    );
}

#[test]
fn the_file_holds_numbers_in_the_unit_that_its_metadata_tells() {
    let frame = read_frame(&write(&example()).unwrap()).unwrap();
    assert_eq!(frame.fields[1], Field::number("axis.x", Some(unit("mm"))));
    // 0.35 m is 350 mm.
    assert_eq!(
        frame.numbers("axis.x").unwrap()[0].to_bits(),
        350.0_f64.to_bits()
    );
}

#[test]
fn groups_of_rows_with_texts_integers_and_what_is_not_there() {
    let fields = [
        Field::plain("case", Kind::Integer),
        Field::plain("why", Kind::Text),
        Field::number("peak", Some(unit("um"))),
    ];
    let notes = [("hyde.seed".to_owned(), "7".to_owned())];
    let mut writer = Writer::new(Vec::new(), &fields, &notes).unwrap();
    let groups = [
        (vec![1, i64::MAX], ["", "größer"], vec![f64::NAN, 2.5]),
        (
            vec![-3, 4],
            ["a\nb", "\"c\""],
            vec![f64::INFINITY, f64::NAN],
        ),
    ];
    for (case, why, peak) in &groups {
        let why = why.iter().map(|&text| text.to_owned()).collect();
        let values = [
            Values::Integers(case.clone()),
            Values::Texts(why),
            Values::Numbers(peak.clone()),
        ];
        writer.rows(&values).unwrap();
    }
    let bytes = writer.finish().unwrap();
    let frame = read_frame(&bytes).unwrap();
    assert_eq!(frame.fields, fields);
    assert_eq!(frame.metadata, notes);
    assert_eq!(frame.note("hyde.seed"), Some("7"));
    assert_eq!(frame.rows(), 4);
    assert_eq!(frame.integers("case").unwrap(), [1, i64::MAX, -3, 4]);
    assert_eq!(frame.texts("why").unwrap(), ["", "größer", "a\nb", "\"c\""]);
    let bits: Vec<u64> = frame
        .numbers("peak")
        .unwrap()
        .iter()
        .map(|v| v.to_bits())
        .collect();
    assert_eq!(
        bits,
        [f64::NAN, 2.5, f64::INFINITY, f64::NAN].map(f64::to_bits)
    );
}

/// It is part of a value, of its place, of the length of something, or of a note.
#[test]
fn a_bit_that_has_flipped_is_found() {
    let numbers: Vec<f64> = (0..200).map(|row| f64::from(row) * 0.1).collect();
    let bytes = write(&[Column::raw("t", numbers.clone()), Column::raw("x", numbers)]).unwrap();
    let told = read_frame(&bytes).unwrap();
    let end = bytes.len();
    let mut found = 0;
    for at in (4..end).step_by(7) {
        let mut flipped = bytes.clone();
        flipped[at] ^= 1 << (at % 8);
        // What a flipped bit does not change is no harm.
        if let Ok(frame) = read_frame(&flipped) {
            let same = frame.fields != told.fields || frame.values == told.values;
            assert!(same, "byte {at}");
        } else {
            found += 1;
        }
    }
    assert!(found > 100, "{found}");
}

#[test]
fn a_frame_without_rows_keeps_its_columns() {
    let fields = [
        Field::plain("n", Kind::Integer),
        Field::plain("why", Kind::Text),
    ];
    let bytes = Writer::new(Vec::new(), &fields, &[])
        .unwrap()
        .finish()
        .unwrap();
    let frame = read_frame(&bytes).unwrap();
    assert_eq!((frame.fields.as_slice(), frame.rows()), (&fields[..], 0));
}

#[test]
fn what_is_no_record_is_told() {
    let told = |columns: &[Column]| {
        read(&write(columns).unwrap(), &Layout::default())
            .unwrap_err()
            .to_string()
    };
    let x = Column::new("x", unit("mm"), vec![0.0]);
    assert_eq!(told(&[x]), "the column `x [mm]` is not a time");
    let gap = Column::new("t", unit("s"), vec![0.0, f64::NAN]);
    assert_eq!(told(&[gap]), "row 2, time column `t`: the cell is empty");
    let back = Column::new("t", unit("s"), vec![1.0, 0.0]);
    assert!(told(&[back]).contains("row 2"));
    let mut writer = Writer::new(Vec::new(), &[Field::plain("why", Kind::Text)], &[]).unwrap();
    writer
        .rows(&[Values::Texts(vec!["no".to_owned()])])
        .unwrap();
    let error = read(&writer.finish().unwrap(), &Layout::every(1.0)).unwrap_err();
    assert_eq!(
        error.to_string(),
        "none of its columns can be used: column `why` holds no numbers"
    );
}

#[test]
fn columns_that_are_not_as_announced_are_refused() {
    let mut writer = Writer::new(Vec::new(), &[Field::plain("n", Kind::Integer)], &[]).unwrap();
    assert!(writer.rows(&[Values::Numbers(vec![1.0])]).is_err());
    assert!(writer.rows(&[]).is_err());
}

#[test]
fn a_damaged_file_is_an_error_and_no_panic() {
    let bytes = write(&example()).unwrap();
    for end in 0..bytes.len() {
        assert!(
            read(&bytes[..end], &Layout::default()).is_err(),
            "cut at {end}"
        );
    }
    for at in 0..bytes.len() {
        for flip in [0x01, 0x80, 0xff] {
            let mut broken = bytes.clone();
            broken[at] ^= flip;
            // A changed digit is a changed number; all else is refused.
            drop::<Result<Table, _>>(read(&broken, &Layout::default()));
        }
    }
}
