//! Writes columns as a CSV record, in the form that is read.

use crate::Column;
use std::borrow::Cow;
use std::fmt::Write as _;

/// Writes columns, each in its unit, with commas; the columns of a table are `table.columns()`.
///
/// A value is the shortest decimal that reads back as the same double. In a unit other than SI it is the shortest
/// that converts back to the same SI value; where no double does, it is off by one unit in the last place. Values
/// that are not finite are written as `NaN` and `inf`, which no reader accepts. Rows end with the shortest column.
#[must_use]
pub fn write<'a>(columns: impl IntoIterator<Item = &'a Column>) -> String {
    let columns: Vec<&Column> = columns.into_iter().collect();
    let header: Vec<_> = columns.iter().map(|column| header_cell(column)).collect();
    let mut text = header.join(",");
    text.push('\n');
    let rows = columns
        .iter()
        .map(|column| column.values().len())
        .min()
        .unwrap_or(0);
    text.reserve(rows * columns.len() * 20);
    let cells: Vec<Cow<'_, [f64]>> = columns.iter().map(|column| column.in_unit()).collect();
    for row in 0..rows {
        for (at, values) in cells.iter().enumerate() {
            if at > 0 {
                text.push(',');
            }
            push_number(&mut text, values[row]);
        }
        text.push('\n');
    }
    text
}

fn header_cell(column: &Column) -> String {
    let name = column.name();
    let cell = match column.unit() {
        Some(unit) => Cow::Owned(format!("{name} [{unit}]")),
        None => Cow::Borrowed(name),
    };
    if cell.contains([',', ';', '\t', '"', '\n', '\r']) || cell.starts_with('#') {
        return format!("\"{}\"", cell.replace('"', "\"\""));
    }
    cell.into_owned()
}

/// `{:?}` prints the shortest digits and goes over to powers of ten where they are shorter; `1.0` is cut to `1`.
fn push_number(text: &mut String, value: f64) {
    // Writing to a string cannot fail.
    let _ = write!(text, "{value:?}");
    if text.ends_with(".0") {
        text.truncate(text.len() - 2);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Layout;
    use crate::csv::read;
    use hyde_units::NamedUnit;

    fn unit(text: &str) -> NamedUnit {
        NamedUnit::parse(text).unwrap()
    }

    #[test]
    fn the_form_is_the_one_that_is_read() {
        let columns = [
            Column::new("t", unit("s"), vec![0.0, 1e-3]),
            Column::new("x", unit("mm"), vec![0.35, -2.5e-7]),
            Column::raw("a, b", vec![1e300, 1.0 / 3.0]),
        ];
        let text = write(&columns);
        let expected = "t [s],x [mm],\"a, b\"\n0,350,1e300\n0.001,-0.00025,0.3333333333333333\n";
        assert_eq!(text, expected);
        let table = read(text.as_bytes(), &Layout::default()).unwrap();
        assert_eq!(table.columns(), columns);
    }

    #[test]
    fn odd_names_survive() {
        for name in ["# t", "say \"hi\"", "a;b", "x[1]", "Größe"] {
            let columns = [
                Column::new("t", unit("s"), vec![0.0]),
                Column::raw(name, vec![1.0]),
            ];
            assert_eq!(
                read(write(&columns).as_bytes(), &Layout::default())
                    .unwrap()
                    .columns(),
                columns
            );
            let first = [Column::new(name, unit("s"), vec![0.0])];
            assert_eq!(
                read(write(&first).as_bytes(), &Layout::default())
                    .unwrap()
                    .columns(),
                first
            );
        }
    }

    #[test]
    fn every_si_value_comes_back_to_the_bit() {
        // Bit patterns spread over all finite doubles.
        let values: Vec<f64> = (0..5000_u64)
            .map(|k| f64::from_bits(k.wrapping_mul(0x9e37_79b9_7f4a_7c15)))
            .filter(|value| value.is_finite())
            .collect();
        let columns = [Column::raw("v", values)];
        let back = read(write(&columns).as_bytes(), &Layout::every(1.0)).unwrap();
        assert_eq!(back.columns(), columns);
    }

    #[test]
    fn what_was_read_in_a_unit_is_written_as_it_was() {
        let mut text = "t [ms],n [rpm],x [um],lead [mm/rev],T [degC]\n".to_owned();
        for k in 0..2000 {
            let _ = writeln!(
                text,
                "{k},{}.25,{}.7,{}.5,{}.3",
                3 * k,
                7 * k,
                k,
                20 + k % 50
            );
        }
        let table = read(text.as_bytes(), &Layout::default()).unwrap();
        assert_eq!(write(table.columns()), text);
    }
}
