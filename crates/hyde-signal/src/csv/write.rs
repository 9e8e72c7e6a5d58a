//! Writes columns as a CSV record, in the form that is read.

use crate::column::Values;
use crate::{Column, Written, in_unit, series};
use hyde_units::Unit;
use std::borrow::Cow;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::io;

/// So many bytes of text go to a file at once.
const AT_ONCE: usize = 1 << 16;

/// Writes columns, each in its unit, with commas; the columns of a table are `table.columns()`.
///
/// A value is the shortest decimal that reads back as the same double. In a unit other than SI it is the shortest
/// that converts back to the same SI value; where no double does, it is off by one unit in the last place. Values
/// that are not finite are written as `NaN` and `inf`, which no reader accepts. Rows end with the shortest column.
#[must_use]
pub fn write<'a>(columns: impl IntoIterator<Item = &'a Column>) -> String {
    let columns: Vec<Written<'_>> = columns.into_iter().map(Column::written).collect();
    let mut text = Vec::new();
    // Writing to memory cannot fail, and all of it is text.
    let _ = write_to(&mut text, &columns);
    String::from_utf8(text).unwrap_or_default()
}

/// The same to a file, a row at a time: nothing of it is kept but the row before, whose cells are copied where they stay.
///
/// # Errors
/// What the file reports.
pub fn write_to(out: &mut impl io::Write, columns: &[Written<'_>]) -> io::Result<()> {
    let header: Vec<_> = columns.iter().map(header_cell).collect();
    let rows = columns.iter().map(|column| column.values.len());
    let first_of = first_of(columns);
    let mut cells: Vec<_> = columns.iter().map(Cells::of).collect();
    let mut text = header.join(",");
    // Where in the text each cell of the row before stands.
    let mut places = vec![0..0; columns.len()];
    // So much of the text is in the file.
    let mut written = 0;
    for _ in 0..rows.min().unwrap_or(0) {
        let row = text.len();
        for (at, (cells, &first)) in cells.iter_mut().zip(&first_of).enumerate() {
            text.push(if at == 0 { '\n' } else { ',' });
            let start = text.len();
            match first < at {
                true => text.extend_from_within(places[first].clone()),
                false => match cells.step() {
                    Some(value) => push_number(&mut text, value),
                    None => text.extend_from_within(places[at].clone()),
                },
            }
            places[at] = start..text.len();
        }
        if text.len() >= AT_ONCE {
            out.write_all(&text.as_bytes()[written..])?;
            text.drain(..row);
            written = text.len();
            for place in &mut places {
                *place = place.start - row..place.end - row;
            }
        }
    }
    text.push('\n');
    out.write_all(&text.as_bytes()[written..])
}

/// Of each column the first with the same text: of the same values in memory, in the same unit.
fn first_of(columns: &[Written<'_>]) -> Vec<usize> {
    let mut at_address: HashMap<*const (), Vec<usize>> = HashMap::new();
    let first = |(at, column): (usize, &Written<'_>)| {
        let known = at_address.entry(column.values.address()).or_default();
        let same = known
            .iter()
            .copied()
            .find(|&other| columns[other].reads_as(column));
        same.unwrap_or_else(|| {
            known.push(at);
            at
        })
    };
    columns.iter().enumerate().map(first).collect()
}

/// The cells of a column from the first row to the last.
struct Cells<'a> {
    values: Steps<'a>,
    /// The unit they are written in, if that is not the one of the values.
    unit: Option<Unit>,
}

enum Steps<'a> {
    Each(std::slice::Iter<'a, f64>),
    Series(series::Steps<'a>),
}

impl<'a> Cells<'a> {
    fn of(column: &'a Written<'_>) -> Self {
        let unit = column.unit.as_ref().map(|unit| unit.unit());
        Self {
            values: match column.values {
                Values::Each(values) => Steps::Each(values.iter()),
                Values::Series(series) => Steps::Series(series.steps()),
            },
            unit: unit.filter(|unit| !unit.is_si()),
        }
    }

    /// The number of the next row; `None` where its text is that of the row before.
    fn step(&mut self) -> Option<f64> {
        let value = match &mut self.values {
            Steps::Each(values) => values.next().copied(),
            Steps::Series(steps) => steps.step(),
        }?;
        Some(self.unit.map_or(value, |unit| in_unit(value, unit)))
    }
}

fn header_cell(column: &Written<'_>) -> String {
    let name = column.name.as_ref();
    let cell = match &column.unit {
        Some(unit) => Cow::Owned(format!("{name} [{unit}]")),
        None => Cow::Borrowed(name),
    };
    if cell.contains([',', ';', '\t', '"', '\n', '\r']) || cell.starts_with('#') {
        return format!("\"{}\"", cell.replace('"', "\"\""));
    }
    cell.into_owned()
}

/// The shortest digits, as `{:?}` has them; `1.0` is cut to `1`.
fn push_number(text: &mut String, value: f64) {
    let mut buffer = zmij::Buffer::new();
    let number = buffer.format(value);
    let size = value.abs();
    if (1e-4..1e16).contains(&size) || size == 0.0 {
        text.push_str(number.strip_suffix(".0").unwrap_or(number));
    } else if let Some((digits, power)) = number.split_once('e') {
        // `1e+16`, `1e-07`
        text.push_str(digits.strip_suffix(".0").unwrap_or(digits));
        text.push_str(if power.starts_with('-') { "e-" } else { "e" });
        text.push_str(power.trim_start_matches(['+', '-', '0']));
    } else if let Some((sign, decimals)) = number.split_once("0.") {
        // `0.000012`: written without a power of ten.
        let digits = decimals.trim_start_matches('0');
        let (first, others) = digits.split_at(digits.len().min(1));
        let point = if others.is_empty() { "" } else { "." };
        let power = decimals.len() - digits.len() + 1;
        // Writing to a string cannot fail.
        let _ = write!(text, "{sign}{first}{point}{others}e-{power}");
    } else {
        // `NaN`, `inf`
        text.push_str(number);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_the_shortest_text_that_reads_back() {
        let mut bits = 0x1234_5678_9abc_def0_u64;
        let mut values = vec![
            0.0,
            -0.0,
            1.0,
            1e15,
            1e16,
            1e17,
            1e-4,
            1e-5,
            -1.25e-5,
            3.000_000_1e-6,
            0.1,
            f64::MAX,
            f64::NAN,
            f64::INFINITY,
        ];
        for exponent in -40..40 {
            bits = bits.wrapping_mul(0x5851_f42d_4c95_7f2d).wrapping_add(1);
            let mantissa = f64::from_bits(0x3ff0_0000_0000_0000 | bits >> 12);
            values.extend([mantissa, -1.5].map(|m| m * 10_f64.powi(exponent / 2)));
        }
        for value in values {
            let mut text = String::new();
            push_number(&mut text, value);
            // Of two shortest texts in the same distance either will do.
            let expected = format!("{value:?}");
            let expected = expected.strip_suffix(".0").unwrap_or(&expected);
            assert_eq!(text.len(), expected.len(), "{text} for {expected}");
            assert_eq!(text.parse::<f64>().map(f64::to_bits), Ok(value.to_bits()));
        }
    }
    use crate::csv::read;
    use crate::{Layout, Series};
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
    fn what_stays_is_written_in_every_row_of_a_long_file() {
        let rows = 20_000;
        let each = |every: u32| (0..rows).map(move |row| f64::from(row / every) * 0.37);
        let series = [each(1), each(5), each(rows), each(3000)].map(|v| v.collect::<Series>());
        let time: Vec<f64> = each(1).collect();
        let of = |name: &'static str, in_unit: &str, values| Written {
            name: name.into(),
            unit: Some(Cow::Owned(unit(in_unit))),
            values,
        };
        let series_of = |number: usize| Values::Series(&series[number]);
        let columns = [
            of("t", "s", Values::Each(&time)),
            of("a", "mm", series_of(1)),
            of("b", "m", series_of(2)),
            of("b2", "m", series_of(2)),
            of("c", "m", series_of(0)),
            of("d", "degC", series_of(3)),
            of("a2", "mm", series_of(1)),
        ];
        let mut text = Vec::new();
        write_to(&mut text, &columns).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.len() > 10 * AT_ONCE);
        let plain: Vec<Column> = columns.iter().map(own).collect();
        assert!(text == write(&plain), "what stays is written otherwise");
    }

    /// A column with values of its own.
    fn own(column: &Written<'_>) -> Column {
        let unit = column.unit.as_ref().unwrap();
        Column::new(
            column.name.as_ref(),
            unit.as_ref().clone(),
            column.values().into_owned(),
        )
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
