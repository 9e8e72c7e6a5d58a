//! Files of arrays as MATLAB, Octave, SciPy and NumPy write them.

use super::{ReadError, read};
use crate::mat::Level5;
use crate::{Layout, Table};
use std::io::{Cursor, Write as _};
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// An `.npy` of version 1.
fn npy(descr: &str, fortran: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut header =
        format!("{{'descr': '{descr}', 'fortran_order': {fortran}, 'shape': ({shape}), }}");
    let blanks = (64 - (header.len() + 11) % 64) % 64;
    header.push_str(&" ".repeat(blanks));
    header.push('\n');
    let length = u16::try_from(header.len()).expect("a short header");
    let head = [b"\x93NUMPY\x01\x00".as_slice(), &length.to_le_bytes()].concat();
    [&head, header.as_bytes(), data].concat()
}

fn doubles(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(f64::to_le_bytes).collect()
}

/// A zip archive of files, deflated or stored.
fn archive(files: &[(&str, Vec<u8>)], deflated: bool) -> Vec<u8> {
    let method = match deflated {
        true => CompressionMethod::Deflated,
        false => CompressionMethod::Stored,
    };
    let options = SimpleFileOptions::default().compression_method(method);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, plain) in files {
        archive.start_file(*name, options).expect("in memory");
        archive.write_all(plain).expect("in memory");
    }
    archive.finish().expect("in memory").into_inner()
}

fn sampled(run: Option<usize>) -> Layout {
    Layout {
        every_s: Some(0.5),
        run,
        ..Layout::default()
    }
}

fn column<'a>(table: &'a Table, name: &str) -> &'a [f64] {
    let column = table.columns().iter().find(|column| column.name() == name);
    column.unwrap_or_else(|| panic!("no {name}")).values()
}

#[test]
fn an_array_has_columns_and_runs() {
    // Two samples, three columns, two places along the third axis and one along the fourth.
    let u = npy(
        "<f8",
        "False",
        "2, 3, 2, 1",
        &doubles((0..12).map(f64::from)),
    );
    let gain = npy("<f8", "False", "", &doubles([7.0]));
    for deflated in [false, true] {
        let file = archive(
            &[("u.npy", u.clone()), ("gain.npy", gain.clone())],
            deflated,
        );
        assert_eq!(read(&file, &sampled(None)), Err(ReadError::Which(2)));
        assert_eq!(read(&file, &sampled(Some(3))), Err(ReadError::NoRun(3, 2)));
        let table = read(&file, &sampled(Some(2))).expect("a record");
        assert_eq!(column(&table, "u_1"), [1.0, 7.0]);
        assert_eq!(column(&table, "u_3"), [5.0, 11.0]);
        let notes: Vec<String> = table.notes().iter().map(ToString::to_string).collect();
        assert!(notes[0].contains("`gain`"), "{notes:?}");
    }
}

#[test]
fn whole_numbers_other_orders_and_truncation() {
    let data: Vec<u8> = [1_i16, 2, 3, -4]
        .iter()
        .flat_map(|v| v.to_be_bytes())
        .collect();
    let table = read(&npy(">i2", "True", "2, 2", &data), &sampled(None)).expect("a record");
    assert_eq!(column(&table, "data_1"), [1.0, 2.0]);
    assert_eq!(column(&table, "data_2"), [3.0, -4.0]);
    let cut = npy("<f8", "False", "3,", &doubles([1.0, 2.0]));
    assert!(matches!(
        read(&cut, &sampled(None)),
        Err(ReadError::Damaged(_))
    ));
    let none = npy(
        "<f8",
        "False",
        "2, 0, 4294967296, 4294967296, 4294967296",
        &[],
    );
    assert_eq!(
        read(&none, &sampled(None)),
        Err(ReadError::Empty(Vec::new()))
    );
    let text = npy("<U5", "False", "3,", &[0; 60]);
    let rows = npy("<f8", "False", "2, 90", &doubles([1.0; 180]));
    let lying = ReadError::Lying("data".to_owned(), 2, 90);
    assert_eq!(read(&rows, &sampled(None)), Err(lying));
    let error = read(&text, &sampled(None)).expect_err("no numbers");
    assert!(error.to_string().contains("`data` is a structure, text"));
    assert!(error.repair("log").contains("real numbers"));
}

#[test]
fn a_matlab_file_has_its_vectors_as_columns_and_names_its_time() {
    let file = Level5::new("for a test")
        .numbers("gtau", 1, 1, &[35.0])
        .numbers("qm", 3, 1, &[0.5, 1.5, 2.5])
        .numbers("t", 1, 3, &[0.0, 0.001, 0.002])
        .numbers("pair", 3, 2, &[1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
        .text("note", "made up")
        .into_bytes();
    let table = read(&file, &Layout::default()).map(|_| ());
    assert!(matches!(table, Err(ReadError::Time(_))), "{table:?}");
    let table = read(&file, &sampled(None)).expect("a record");
    assert_eq!(column(&table, "qm"), [0.5, 1.5, 2.5]);
    assert_eq!(column(&table, "pair_2"), [4.0, 5.0, 6.0]);
    let mut damaged = file.clone();
    damaged.truncate(230);
    assert!(matches!(
        read(&damaged, &sampled(None)),
        Err(ReadError::Damaged(_))
    ));
    let newer = b"MATLAB 7.3 MAT-file, written by a newer version";
    assert_eq!(read(newer, &sampled(None)), Err(ReadError::Hdf5));
}

#[test]
fn a_compressed_array_is_unpacked() {
    let plain = Level5::new("").numbers("x", 2, 1, &[3.0, 4.0]).into_bytes();
    let mut packer = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::fast());
    packer.write_all(&plain[128..]).expect("in memory");
    let packed = packer.finish().expect("in memory");
    let length = u32::try_from(packed.len()).expect("short");
    let element = [15_u32.to_le_bytes(), length.to_le_bytes()].concat();
    let file = [&plain[..128], &element, &packed].concat();
    let table = read(&file, &sampled(None)).expect("a record");
    assert_eq!(column(&table, "x"), [3.0, 4.0]);
}
