//! Records in the forms that real files have, and every mistake with its line.

#![allow(clippy::float_cmp, reason = "cells are the nearest doubles")]

use super::*;
use crate::{CountUnit, DeclaredColumn};
use hyde_units::NamedUnit;
use proptest::prelude::*;

fn table(text: &str) -> Table {
    read(text.as_bytes(), &Layout::default()).unwrap_or_else(|error| panic!("{text:?}: {error}"))
}

fn message(text: &str) -> String {
    let error = read(text.as_bytes(), &Layout::default()).unwrap_err();
    error.to_string()
}

fn notes(table: &Table) -> String {
    let notes: Vec<String> = table.notes().iter().map(ToString::to_string).collect();
    notes.join("\n")
}

#[test]
fn a_record_becomes_si() {
    let table = table("t [ms],x [mm],qg_m\n0,350,350\n1,10,1e-3\n");
    assert_eq!(table.time(), [0.0, 0.001]);
    assert_eq!(table.column("x").unwrap().values(), [0.35, 0.01]);
    assert_eq!(table.column("x").unwrap().unit().unwrap().text(), "mm");
    assert_eq!(table.column("qg_m").unwrap().values(), [350.0, 1e-3]);
    assert_eq!(table.column("qg_m").unwrap().unit(), None);
    assert_eq!(notes(&table), "");
}

/// Every form gives the same numbers, and tells what is not as Hyde writes it.
#[test]
fn the_forms_that_real_files_have() {
    let plain = table("t [s],x [m]\n0.0,1.5\n0.5,2.5\n");
    for (text, told) in [
        ("t [s];x [m]\n0;1.5\n0.5;2.5\n", ""),
        ("t [s]\tx [m]\r\n0\t1.5\r\n0.5\t2.5\r\n", ""),
        ("\u{feff}t [s],x [m]\n0,1.5\n0.5,2.5", ""),
        (
            "# bench\n\nt [s], x [m]\n\n0, 1.5\n# middle\n \n0.5, 2.5\n\n",
            "",
        ),
        ("\"t [s]\",\"x [m]\"\n0,1.5\n0.5,\"2.5\"\n", ""),
        ("t[s],x[m]\n0,+1.5\n5e-1,2.5e+0\n", ""),
        ("sep=;\nt [s];x [m]\n0;1.5\n0.5;2.5\n", ""),
        ("% octave\nt [s],x [m]\n0,1.5\n% middle\n0.5,2.5\n", ""),
        ("t [s] x [m]\n 0  1.5\n 0.5\t2.5\n", "separated by blanks"),
        (
            "#t [s],x [m]\n0,1.5\n0.5,2.5\n",
            "comment in line 1 is read as the header",
        ),
        (
            "# bench\n# t [s] x [m]\n0 1.5\n0.5 2.5\n",
            "comment in line 2",
        ),
        (
            "t,x\n[s],[m]\n0,1.5\n0.5,2.5\n",
            "line 2 is read as a row of units",
        ),
        (
            "t;x\n(s);(m)\n\n0;1.5\n0.5;2.5\n",
            "line 2 is read as a row of units",
        ),
        (
            "t;x\ns;m\n0;1.5\n0.5;2.5\n",
            "line 2 is read as a row of units",
        ),
        (
            "t (s),x (m)\n0,1.5\n0.5,2.5\n",
            "units in parentheses were read: `t` in s, `x` in m",
        ),
        ("t [s];x [m];\n0;1.5;\n0.5;2.5;\n", "end with a separator"),
        ("t [s];x [m]\n0;1.5;;\n0.5;2.5;;\n;;;\n", ""),
        ("t [s];x [m]\n0,0;1,5\n0,5;2,5\n", "decimal comma"),
        ("t [s]\tx [m]\n0\t1,5\n0,5\t2,5\n", "decimal comma"),
        (
            "\"t [s]\",\"x [m]\"\n\"0\",\"1,5\"\n\"0,5\",\"2,5\"\n",
            "decimal comma",
        ),
        (
            "t [s],x [m]\n0,1.5\n0.5,2.5\n0.7",
            "the file ends within line 4",
        ),
    ] {
        let read = table(text);
        assert_eq!(read.columns(), plain.columns(), "{text:?}");
        assert!(
            notes(&read).contains(told) && notes(&read).is_empty() == told.is_empty(),
            "{text:?}: {}",
            notes(&read)
        );
    }
}

/// What nobody uses may be anything; what is wrong with it is kept for whoever does.
#[test]
fn columns_that_cannot_be_used_are_set_apart() {
    let table =
        table("t [s],x [mm],raw [RAW],note,on,x,y,y\n0,1,2,ok,TRUE,1,2,3\n1,2,3,,false,2,3,4\n");
    let sound: Vec<&str> = table.columns().iter().map(|column| column.name()).collect();
    assert_eq!(sound, ["t", "on"]);
    assert_eq!(table.column("on").unwrap().values(), [1.0, 0.0]);
    assert!(notes(&table).contains("TRUE and FALSE are read as 1 and 0 in `on`"));
    let faults: Vec<String> = table
        .unusable()
        .iter()
        .map(|column| column.fault.to_string())
        .collect();
    assert_eq!(
        faults,
        [
            "column 3 (`raw`): unknown unit `RAW`",
            "line 2, column 4 (`note`): `ok` is not a number",
            "columns 2 and 6 are both named `x`",
            "columns 7 and 8 are both named `y`",
        ]
    );
}

#[test]
fn a_declared_period_leaves_the_first_column_ordinary() {
    let every = |text: &str, period| read(text.as_bytes(), &Layout::every(period));
    let table = every("t_s,x\n5,1\n3,2\n", 0.5).unwrap();
    assert_eq!(table.time(), [0.0, 0.5]);
    assert_eq!(table.column("t_s").unwrap().values(), [5.0, 3.0]);
    let error = every("x\n1\n", -1.0).unwrap_err();
    assert_eq!(error.to_string(), "a period of -1 s is not positive");
    assert_eq!(every("phi [rad]\n1\n", 1.0).unwrap().rows(), 1);
}

#[test]
fn a_declared_column_is_the_time() {
    let unit = |text: &str| Some(NamedUnit::parse(text).unwrap());
    let by = |name: &str, unit| {
        let time = Some(DeclaredColumn {
            unit: Option::<NamedUnit>::map(unit, CountUnit::one),
            ..DeclaredColumn::named(name)
        });
        read(
            b"Sample,Timestamp,Time [us],x [mm]\n0,10,100,1\n1,12,300,2\n2,14,500,3\n",
            &Layout {
                time,
                ..Layout::default()
            },
        )
    };
    let table = by("Timestamp", unit("ms")).unwrap();
    assert_eq!(table.time(), [0.01, 0.012, 0.014]);
    assert_eq!(table.column("Sample").unwrap().values(), [0.0, 1.0, 2.0]);
    let dates = Some(DeclaredColumn::named("Time"));
    let text = b"Date,Time,x\n05.03.2024,14:07:01.0,1\n05.03.2024,14:07:01.5,2\n";
    let dates = read(
        text,
        &Layout {
            time: dates,
            ..Layout::default()
        },
    )
    .unwrap();
    assert_eq!(dates.time(), [0.0, 0.5]);
    for name in ["Time", "Time [us]"] {
        assert_eq!(by(name, None).unwrap().time()[0], 1e-4);
    }
    assert_eq!(by("Time", unit("us")).unwrap().time()[0], 1e-4);
    let wrong = |name, unit| by(name, unit).unwrap_err().to_string();
    assert!(wrong("Time", unit("ms")).contains("in us by the file and in ms by its declaration"));
    assert!(wrong("Timestamp", unit("mm")).contains("not a time"));
    assert!(wrong("Timestamp", None).contains("has no unit and is in whole numbers, rows 2 apart"));
    assert!(wrong("zeit", None).contains("there is no column `zeit`"));
}

#[test]
fn an_event_has_two_rows() {
    let table = table("t,x\n0,0\n1.5,1\n1.5,5\n2,6\n");
    assert_eq!(table.time(), [0.0, 1.5, 1.5, 2.0]);
    assert!(notes(&table).contains("the time `t` has no unit: it is read in s"));
}

#[test]
fn clocks_that_count_from_elsewhere_count_from_the_first_row() {
    for (text, shown) in [
        (
            "t [s],x\n1709647621.250000,1\n1709647621.260000,2\n",
            "2024-03-05 14:07:01.250 UTC",
        ),
        (
            "t [ms],x\n1709647621250,1\n1709647621260,2\n",
            "2024-03-05 14:07:01.250 UTC",
        ),
        (
            "t [us],x\n1709647621250000,1\n1709647621260000,2\n",
            "2024-03-05 14:07:01.250 UTC",
        ),
        (
            "t [ns],x\n1709647621250000000,1\n1709647621260000000,2\n",
            "2024-03-05 14:07:01.250 UTC",
        ),
        (
            "Zeit;x\n05.03.2024 14:07:01,25;1\n05.03.2024 14:07:01,26;2\n",
            "05.03.2024 14:07:01,25",
        ),
        (
            "Datum;x\n2024-03-05 14:07:01.25;1\n2024-03-05 14:07:01.26;2\n",
            "2024-03-05 14:07:01.25",
        ),
    ] {
        let table = table(text);
        assert_eq!(table.time(), [0.0, 0.01], "{text:?}");
        assert!(notes(&table).contains(shown), "{text:?}: {}", notes(&table));
    }
    // Whole numbers without a unit can be Unix time in one unit only.
    let bare = table("Timestamp,x\n1709647621250,1\n1709647621260,2\n1709647621270,3\n");
    assert_eq!(bare.time(), [0.0, 0.01, 0.02]);
    assert!(notes(&bare).contains("it is Unix time in ms"));
    // A clock that has run for less than a day counts on.
    assert_eq!(table("t [s],x\n-0.5,1\n0.5,2\n").time(), [-0.5, 0.5]);
    assert_eq!(table("t [s],x\n86.4,1\n86.5,2\n").time(), [86.4, 86.5]);
}

#[test]
fn records_with_dates_are_aligned() {
    let mut one = table("Zeit,x\n14:07:01.5,1\n14:07:02.5,2\n");
    let mut other = table("Zeit,x\n14:07:02.75,1\n14:07:03.75,2\n");
    crate::align(&mut [("one", &mut one), ("other", &mut other)]);
    assert_eq!(one.time(), [0.0, 1.0]);
    assert_eq!(other.time(), [1.25, 2.25]);
    assert!(notes(&other).contains("begins 1.25 s after the first of the records"));
    let mut plain = table("t [s],x\n0,1\n1,2\n");
    crate::align(&mut [("one", &mut one), ("plain", &mut plain)]);
    assert!(notes(&plain).contains("cannot be compared"));
}

#[test]
fn mistakes_are_told_with_line_and_column() {
    for (text, expected) in [
        ("", "the file is empty"),
        ("\n# only a comment\n", "the file is empty"),
        ("t,x\n", "the file has a header but no samples"),
        (
            "0,1\n1,2\n",
            "line 1: found a row of numbers instead of a header",
        ),
        (
            "t,x\n0,1\n\n# note\nabc,1\n",
            "line 5, time column `t`: `abc` is neither a number nor a date with a time of day",
        ),
        (
            "t,x\n0,1\n,1\n",
            "line 3, time column `t`: the cell is empty",
        ),
        (
            "t,x\n0,1\n1\n2,1\n",
            "line 3: 1 cell, the header has 2 columns",
        ),
        ("t,x\n0,1,2\n", "line 2: 3 cells, the header has 2 columns"),
        (
            "t,x\r\n0,1\r\n2,1\r\n1.5,1\r\n",
            "line 4: time runs back from 2 to 1.5",
        ),
        (
            "t,x\n0.5,1\n1.5,1\n2.5,1\n0.6,1\n",
            "the file contains several runs: the time restarts in line 5, from 2.5 to 0.6",
        ),
        (
            "t,x\n0.5,1\n1.5,1\nt,x\n0.5,1\n",
            "the file contains several runs: the header is repeated in line 4",
        ),
        ("x [m],t [s]\n0,1\n", "the column `x [m]` is not a time"),
        ("t [RAW],x\n0,1\n", "the column `t [RAW]` is not a time"),
        (
            "Sample,x\n0,1\n1,2\n",
            "the first column, `Sample`, may not be the time",
        ),
        (
            ",t [s]\n0,1\n",
            "the first column has no name, so it may not be the time",
        ),
        (
            "time,x\n0,1\n2,1\n4,1\n",
            "the time `time` has no unit and is in whole numbers, rows 2 apart: seconds, milliseconds, or a count?",
        ),
        (
            "t [s],x\n23.4,1\n23.4,2\n",
            "the column `t` is not a time: it does not advance, all rows are at 23.4",
        ),
    ] {
        assert_eq!(message(text), expected, "{text:?}");
    }
}

#[test]
fn repairs_name_the_column_that_may_be_the_time() {
    let repair = |text: &str| {
        read(text.as_bytes(), &Layout::default())
            .unwrap_err()
            .repair("log")
    };
    assert!(
        repair("Sample,Timestamp,x\n0,0,1\n1,2,1\n")
            .contains("`record log(time = \"Timestamp\" in [ms])`")
    );
    assert!(
        repair("temp;x;motor time [ms]\n23;1;0\n23;1;1\n")
            .contains("`record log(time = \"motor time\")`")
    );
    assert!(
        repair("Date,Time,x\n05.03.2024,14:07:01.0,1\n05.03.2024,14:07:01.5,2\n")
            .contains("(time = \"Time\" in [ms])")
    );
    assert!(repair("Index,x\n0,1\n1,2\n").contains("`record log(time = \"Index\" in [s])`"));
}

#[test]
fn one_of_several_runs_is_chosen() {
    let run = |text: &str, run: usize| {
        let layout = Layout {
            run: Some(run),
            ..Layout::default()
        };
        read(text.as_bytes(), &layout)
    };
    let column = |table: &Table| table.column("x").map(|x| x.values().to_vec());
    // The clock returns; what is wrong in another run does not matter, and lines are those of the file.
    let clock = "t [s],x\n0.5,1\n1.5,2\n\n0.5,3\n1.5,4\n2.5,5\n0.6,broken\n1.6,7\n";
    let second = run(clock, 2).unwrap();
    assert_eq!(second.time(), [0.5, 1.5, 2.5]);
    assert_eq!(column(&second), Some(vec![3.0, 4.0, 5.0]));
    assert!(notes(&second).contains("contains 3 runs: run 2 is read, lines 5 to 7"));
    assert!(
        run(clock, 3).unwrap().unusable()[0]
            .fault
            .message
            .contains("line 8")
    );
    assert_eq!(
        run(clock, 4).unwrap_err().to_string(),
        "the file contains 3 runs, and run 4 is asked for"
    );
    // The header is repeated, and the clock counts on.
    let header = run("t [s],x\n0.5,1\n1.5,2\nt [s],x\n2.5,3\n3.5,4\n", 2).unwrap();
    assert_eq!(header.time(), [2.5, 3.5]);
    // Dates, and a time of day that passes midnight, which is one run.
    let dates = "Zeit;x\n05.03.2024 14:00:01;1\n05.03.2024 14:00:02;2\n05.03.2024 14:00:01;3\n05.03.2024 14:00:02;4\n";
    assert_eq!(column(&run(dates, 2).unwrap()), Some(vec![3.0, 4.0]));
    let midnight = "Zeit;x\n23:59:58;1\n23:59:59;2\n00:00:00;3\n00:00:01;4\n";
    assert_eq!(run(midnight, 1).unwrap().rows(), 4);
    // A counter of 16 bits that overflows goes on.
    let counter = "t [us],x\n65000,1\n65200,2\n65400,3\n64,4\n264,5\n";
    assert_eq!(run(counter, 1).unwrap().rows(), 5);
    // Time that runs back a little within a run is a mistake as ever.
    let back = "t [s],x\n0.5,1\n1.5,2\n0.5,3\n1.5,4\n1.25,5\n";
    assert_eq!(
        run(back, 2).unwrap_err().to_string(),
        "line 6: time runs back from 1.5 to 1.25"
    );
}

#[test]
fn a_decimal_comma_stands_in_the_whole_file() {
    let table = table("t [s];x;y\n0,5;1;1.5\n1,5;2;2.5\n");
    assert_eq!(table.time(), [0.5, 1.5]);
    assert_eq!(
        table.unusable()[0].fault.to_string(),
        "line 2, column 3 (`y`): `1.5` has a different decimal sign than the cells before it"
    );
}

const WHOLE: &str =
    "Zeit (ms);x [mm];Freigabe;note\n0,5;1,25;TRUE;ok\n1,5;2,5;FALSE;\"a; b\"\n2,5;3,5;TRUE;\n";

proptest! {
    /// Whatever a file holds, it is read or refused.
    #[test]
    fn garbled_files_are_no_end_of_the_program(
        bytes in prop::collection::vec(any::<u8>(), 0..200),
        cut in 0..WHOLE.len(),
        at in 0..WHOLE.len(),
        with in any::<u8>(),
    ) {
        let layouts = [Layout::default(), Layout::every(1e-3)];
        let mut changed = WHOLE.as_bytes().to_vec();
        changed[at] = with;
        for layout in &layouts {
            for file in [&bytes[..], &WHOLE.as_bytes()[..cut], &changed[..]] {
                if let Ok(table) = crate::read(file, layout) {
                    prop_assert!(table.columns().iter().all(|c| c.values().len() == table.rows()));
                }
                drop(crate::read_frame(file));
            }
        }
    }
}

/// A measurement of LabVIEW: facts, a header with a column for comments, rows with and without a tab for it.
#[test]
fn a_measurement_of_labview() {
    let head = "LabVIEW Measurement\t\r\nSeparator\tTab\r\nTime_Pref\tRelative\r\n***End_of_Header***\t\r\n\t\r\n\
        Channels\t2\t\t\r\nSamples\t4\t4\t\r\nY_Unit_Label\tmm\tA\r\nX_Dimension\tTime\tTime\r\n\
        X0\t0.0\t0.0\r\nDelta_X\t0.002\t0.002\r\n***End_of_Header***\t\t\t\r\n\
        X_Value\tpos\tcur\tComment\r\n";
    for (first, rest) in [("", ""), ("\t", ""), ("\t", "\t")] {
        let rows = format!("0.000\t1\t5{first}\r\n0.002\t2\t6{rest}\r\n0.004\t3\t7{rest}\r\n");
        let table = table(&[head, &rows].concat());
        assert_eq!(table.time(), [0.0, 0.002, 0.004]);
        assert_eq!(table.column("cur").unwrap().values(), [5.0, 6.0, 7.0]);
        let units: Vec<Option<&str>> = ["pos", "cur"]
            .iter()
            .map(|name| table.column(name).unwrap().unit().map(NamedUnit::text))
            .collect();
        assert_eq!(units, [Some("mm"), Some("A")]);
    }
}

#[test]
fn a_rate_in_a_comment_above_a_plain_header() {
    let table = table("# Sample rate: 500 Hz\npos [mm],cur [A]\n1,5\n2,6\n3,7\n");
    assert_eq!(table.time(), [0.0, 0.002, 0.004]);
    assert!(notes(&table).contains("`Sample rate` in line 1"));
}

#[test]
fn signs_between_thousands_are_told() {
    let table = table("t [s];x [mm];y\n0,0;999,5;1\n0,5;1.000,5;2\n1,0;-12.345,25;3\n");
    let x = table.column("x").unwrap().values();
    assert!((x[1] - 1.0005).abs() < 1e-12 && (x[2] + 12.345_25).abs() < 1e-12);
    assert!(notes(&table).contains("`1.000,5` is read as 1000.5"));
}

#[test]
fn units_of_devices_are_told() {
    let table = table("t [s],M [Nm],n [U/min]\n0,1,60\n1,2,120\n");
    assert_eq!(table.column("M").unwrap().unit().unwrap().text(), "N.m");
    let speed = table.column("n").unwrap().values()[0];
    assert!((speed - std::f64::consts::TAU).abs() < 1e-12);
    assert!(notes(&table).contains("of its units, `Nm` is N.m, `U/min` is rpm"));
}

/// A spreadsheet writes 2023-03-15 as 45000: as seconds, rows 10 ms apart would be 0.1 us apart.
#[test]
fn days_of_a_spreadsheet_are_asked_for() {
    let of = |header: &str, row: &str| {
        let rows: String = (0..9)
            .map(|k| format!("45000.{:09}{row}\n", 116 * k))
            .collect();
        format!("{header}\n{rows}")
    };
    let error = message(&of("Timestamp,x [m]", ",1"));
    assert!(
        error.contains("days, as the dates of a spreadsheet do, or seconds"),
        "{error}"
    );
    let table = table(&of("Timestamp [us],x [m]", ",1"));
    assert_eq!(table.time().len(), 9);
}

#[test]
fn another_clock_beside_the_time_is_told() {
    let text = |step: f64| {
        let row = |k: u32| {
            let t = 0.004 * f64::from(k);
            format!("{t:.3},1,{:.5},2\n", 0.0013 + step * f64::from(k))
        };
        let rows: String = (0..9).map(row).collect();
        format!("t_plc [s],x [m],t_scope [s],i [A]\n{rows}")
    };
    let told = notes(&table(&text(0.004)));
    assert!(
        told.contains("`t_scope` runs along with the time `t_plc`"),
        "{told}"
    );
    let duration = notes(&table(&text(0.0001)));
    assert_eq!(duration, "");
}
