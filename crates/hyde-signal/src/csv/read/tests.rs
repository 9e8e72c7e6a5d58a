//! Records in the forms that real files have, and every mistake with its line.

#![allow(clippy::float_cmp, reason = "cells are the nearest doubles")]

use super::*;

fn message(text: &str) -> String {
    read(text.as_bytes(), None).unwrap_err().to_string()
}

#[test]
fn a_record_becomes_si() {
    let table = read(b"t [ms],x [mm],qg_m\n0,350,350\n1,10,1e-3\n", None).unwrap();
    assert_eq!(table.time(), [0.0, 0.001]);
    assert_eq!(table.column("x").unwrap().values(), [0.35, 0.01]);
    assert_eq!(table.column("x").unwrap().unit().unwrap().text(), "mm");
    assert_eq!(table.column("qg_m").unwrap().values(), [350.0, 1e-3]);
    assert_eq!(table.column("qg_m").unwrap().unit(), None);
}

#[test]
fn the_forms_that_real_files_have() {
    let plain = read(b"t [s],x [m]\n0,1\n1,2\n", None).unwrap();
    for text in [
        "t [s];x [m]\n0;1\n1;2\n",
        "t [s]\tx [m]\r\n0\t1\r\n1\t2\r\n",
        "\u{feff}t [s],x [m]\n0,1\n1,2",
        "# bench\n\nt [s], x [m]\n\n0, 1\n# middle\n \n1, 2.0\n\n",
        "\"t [s]\",\"x [m]\"\n0,1\n1,\"2\"\n",
        "t[s],x[m]\n0,+1\n1e0,2e+0\n",
    ] {
        assert_eq!(read(text.as_bytes(), None).unwrap(), plain, "{text:?}");
    }
}

#[test]
fn a_declared_period_leaves_the_first_column_ordinary() {
    let table = read(b"t_s,x\n5,1\n3,2\n", Some(0.5)).unwrap();
    assert_eq!(table.time(), [0.0, 0.5]);
    assert_eq!(table.column("t_s").unwrap().values(), [5.0, 3.0]);
    let error = read(b"x\n1\n", Some(-1.0)).unwrap_err();
    assert_eq!(error.to_string(), "a period of -1 s is not positive");
    assert_eq!(read(b"phi [rad]\n1\n", Some(1.0)).unwrap().rows(), 1);
}

#[test]
fn an_event_has_two_rows() {
    let table = read(b"t,x\n0,0\n1,1\n1,5\n2,6\n", None).unwrap();
    assert_eq!(table.time(), [0.0, 1.0, 1.0, 2.0]);
}

#[test]
fn mistakes_are_told_with_line_and_column() {
    for (text, expected) in [
        ("", "the file is empty"),
        ("\n# only a comment\n", "the file is empty"),
        ("t,x\n", "there is a header but no row"),
        (
            "t,x\n0,1\n\n# note\n1,abc\n",
            "line 5, column 2 (`x`): `abc` is no number",
        ),
        (
            "t;x\n0;0,5\n",
            "line 2, column 2 (`x`): `0,5` is no number: write `0.5`",
        ),
        ("t,x\n0,\n", "line 2, column 2 (`x`): the cell is empty"),
        (
            "t,x\n0,nan\n",
            "line 2, column 2 (`x`): `nan` is not finite",
        ),
        (
            "t,x\n0,-inf\n",
            "line 2, column 2 (`x`): `-inf` is not finite",
        ),
        (
            "t,x\n0,1e999\n",
            "line 2, column 2 (`x`): `1e999` is not finite",
        ),
        ("t,x\n0,1\n1\n", "line 3: 1 cells, the header has 2 columns"),
        ("t,x\n0,1,2\n", "line 2: 3 cells, the header has 2 columns"),
        (
            "t,x\r\n0,1\r\n2,1\r\n1.5,1\r\n",
            "line 4: time runs back from 2 to 1.5",
        ),
        ("t,x,x\n0,1,2\n", "columns 2 and 3 are both named `x`"),
        ("t,x,\n0,1,2\n", "column 3 has no name"),
        ("t,[mm]\n0,1\n", "column 2 has no name"),
        (
            "t,F [Nm]\n0,1\n",
            "column 2 (`F`): unknown unit `Nm`: write `N.m`",
        ),
        (
            "t,F []\n0,1\n",
            "column 2 (`F`): a unit is missing: write `1` for a bare number",
        ),
        (
            "x [m],t [s]\n0,1\n",
            "the first column, `x [m]`, is no time and no period is declared",
        ),
    ] {
        assert_eq!(message(text), expected, "{text:?}");
    }
    let error = read(b"t,\xff\n", None).unwrap_err();
    assert_eq!(error.to_string(), "line 1: not UTF-8 text");
    let error = read(b"t,x\n0,\xff\n", None).unwrap_err();
    assert_eq!(
        error.to_string(),
        "line 2, column 2 (`x`): `\u{fffd}` is no number"
    );
}
