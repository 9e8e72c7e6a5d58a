//! Files that are neither CSV nor Parquet, known by how they begin.

use std::fmt;

/// The kind of a file that is no record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Foreign {
    /// A MATLAB file.
    Matlab,
    /// An Excel workbook, or another zip archive.
    Workbook,
    /// HDF5.
    Hdf5,
    /// LabVIEW TDMS.
    Tdms,
    /// ASAM MDF.
    Mdf,
    /// A compressed file.
    Compressed,
    /// A page or another document of marks.
    Markup,
    /// Bytes that are no text.
    Binary,
}

/// What a file is by its first bytes, unless it may be a record.
pub(crate) fn foreign(bytes: &[u8]) -> Option<Foreign> {
    let known: [(&[u8], Foreign); 13] = [
        (b"MATLAB", Foreign::Matlab),
        (b"PK\x03\x04", Foreign::Workbook),
        (b"\xd0\xcf\x11\xe0", Foreign::Workbook),
        (b"\x89HDF", Foreign::Hdf5),
        (b"TDSm", Foreign::Tdms),
        (b"MDF  ", Foreign::Mdf),
        (b"\x1f\x8b", Foreign::Compressed),
        (b"\x28\xb5\x2f\xfd", Foreign::Compressed),
        (b"\xfd7zXZ", Foreign::Compressed),
        (b"<?xml", Foreign::Markup),
        (b"<!DOCTYPE", Foreign::Markup),
        (b"<html", Foreign::Markup),
        (b"\x93NUMPY", Foreign::Binary),
    ];
    let found = known.iter().find(|(mark, _)| bytes.starts_with(mark));
    found.map(|(_, kind)| *kind)
}

impl Foreign {
    /// What to do with it.
    pub(crate) fn repair(self) -> &'static str {
        match self {
            Self::Matlab => {
                "export it from MATLAB: `writetable(T, \"log.csv\")`, or `parquetwrite(\"log.parquet\", T)`"
            }
            Self::Workbook => "save the sheet as CSV",
            Self::Hdf5 | Self::Tdms | Self::Mdf | Self::Binary => {
                "export its channels as CSV or Parquet"
            }
            Self::Compressed => "unpack it",
            Self::Markup => "save the table in it as CSV",
        }
    }
}

impl fmt::Display for Foreign {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self {
            Self::Matlab => "a MATLAB file",
            Self::Workbook => "an Excel workbook or another zip archive",
            Self::Hdf5 => "an HDF5 file",
            Self::Tdms => "a TDMS file of LabVIEW",
            Self::Mdf => "an ASAM MDF file",
            Self::Compressed => "a compressed file",
            Self::Markup => "an XML or HTML document",
            Self::Binary => "a binary file",
        };
        write!(f, "this is {what}, and a record is CSV or Parquet")
    }
}
