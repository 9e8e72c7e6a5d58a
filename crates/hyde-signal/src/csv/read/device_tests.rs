//! Records as single devices write them.

use super::*;

fn with(text: &str, layout: &Layout) -> Table {
    read(text.as_bytes(), layout).unwrap()
}

fn table(text: &str) -> Table {
    with(text, &Layout::default())
}

#[test]
fn a_scope_numbers_its_columns_above_their_units() {
    let table = table(
        "x-axis,1,2\nsecond,Volt,Volt\n0.0,+3.0,+1.1\n1.0E-03,+3.1,+1.2\n2.0E-03,+3.2,+1.3\n",
    );
    assert_eq!(table.time(), [0.0, 0.001, 0.002]);
    let one = table.column("1").unwrap();
    assert_eq!(one.unit().unwrap().text(), "V");
    assert_eq!(one.values(), [3.0, 3.1, 3.2]);
}

#[test]
fn labview_gives_the_step_where_it_writes_no_times() {
    let table = table(
        "LabVIEW Measurement\t\nX_Columns\tNo\n***End_of_Header***\t\n\t\nChannels\t2\t\t\n\
         Y_Unit_Label\tmm\tmm/s\t\nX_Dimension\tTime\tTime\t\nDelta_X\t0,001000\t0,001000\t\n\
         ***End_of_Header***\t\t\t\nX_Value\tpos\tvel\tComment\n\t3,0001\t111,5001\n\t3,1001\t111,6001\n\t3,2001\t111,7001\n",
    );
    assert_eq!(table.time(), [0.0, 0.001, 0.002]);
    let pos = table.column("pos").unwrap();
    assert_eq!(pos.in_unit().as_ref(), [3.0001, 3.1001, 3.2001]);
    assert_eq!(pos.unit().unwrap().text(), "mm");
}

#[test]
fn a_declared_decimal_sign_leaves_the_other_for_thousands() {
    let layout = Layout {
        decimal: Some(','),
        ..Layout::default()
    };
    let text =
        "t [ms];x [nm];v [um/s]\n0;3.000.000;111.814\n1.000;3.111.812;999\n2.000;3.223.612;1.108\n";
    let table = with(text, &layout);
    assert_eq!(table.time(), [0.0, 1.0, 2.0]);
    let column = |name: &str| table.column(name).unwrap().in_unit().into_owned();
    assert_eq!(column("x"), [3_000_000.0, 3_111_812.0, 3_223_612.0]);
    assert_eq!(column("v"), [111_814.0, 999.0, 1108.0]);
    assert!(
        (table.notes().iter()).any(|note| note.to_string().contains("is read as")),
        "{:?}",
        table.notes()
    );
}

#[test]
fn a_column_that_is_not_there_is_not_taken_for_the_time() {
    let layout = Layout {
        columns: vec![crate::DeclaredColumn::named("y")],
        ..Layout::default()
    };
    let error = read(b"t [s],x\n0,1\n1,2\n", &layout).unwrap_err();
    assert_eq!(error.to_string(), "there is no column `y`");
    assert!(error.repair("log").contains("`t`, `x`"));
}

#[test]
fn quotes_of_a_control_do_not_belong_to_names() {
    let table = table("'Time(msec)','POSF(mm)'\n0,1\n1,2\n2,3\n");
    assert_eq!(table.time(), [0.0, 0.001, 0.002]);
    assert_eq!(table.column("POSF").unwrap().unit().unwrap().text(), "mm");
}

#[test]
fn a_number_of_the_row_is_not_proposed_as_the_time() {
    let help = |text: &str| {
        let error = read(text.as_bytes(), &Layout::default()).unwrap_err();
        error.repair("log")
    };
    let counted = help("1,0.5,3\n2,0.6,4\n3,0.7,5\n");
    assert!(
        counted.contains("columns = \"number, NAME1 [mm], NAME2 [mm/s]\") every 1 [ms]")
            && !counted.contains("t [s]"),
        "{counted}"
    );
    assert!(help("0.1,0.5\n0.2,0.6\n0.3,0.7\n").contains("t [s]"));
}
