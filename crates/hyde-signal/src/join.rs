//! Several files as one record: those with the same channels one after another, others side by side.

use crate::gaps::seconds;
use crate::note::listed;
use crate::{Column, Fault, Note, Table, TableError};
use std::fmt;

/// Why files are not one record.
#[derive(Clone, Debug, PartialEq)]
pub enum JoinError {
    /// There are none.
    NoFiles,
    /// Two files with the same channels are about the same time.
    Overlap {
        /// The file that begins first.
        first: String,
        /// When it ends, s.
        ends_s: f64,
        /// The other one.
        second: String,
        /// When that begins, s.
        begins_s: f64,
    },
    /// A file has no times, so that nobody knows which one it continues.
    NoTimes(String),
    /// What one file has in one unit, another has in a unit of another dimension.
    Units {
        /// The channel.
        channel: String,
        /// The file.
        file: String,
    },
    /// The clocks of files cannot be compared.
    Clocks(String, String),
    /// What was joined is no table.
    Table(TableError),
}

/// A file with its name.
type Named = (String, Table);

/// Makes one record of several files. Those with the same channels continue one another in the order of their times; channels
/// of other files keep their own times beside them, as groups of one file do.
///
/// # Errors
/// If files with the same channels overlap in time, or their clocks cannot be compared.
pub fn join(files: Vec<Named>) -> Result<Table, JoinError> {
    if files.len() <= 1 {
        let only = files.into_iter().next();
        return only.map(|(_, table)| table).ok_or(JoinError::NoFiles);
    }
    let files = on_one_clock(files)?;
    let mut groups: Vec<Vec<Named>> = Vec::new();
    for file in files {
        let same = groups.iter_mut().find(|group| alike(&group[0].1, &file.1));
        match same {
            Some(group) => group.push(file),
            None => groups.push(vec![file]),
        }
    }
    let mut notes = Vec::new();
    let mut parts = Vec::new();
    for group in groups {
        let (name, table) = continued(group, &mut notes)?;
        notes.push(Note::new(format!(
            "`{name}` has the channels {}",
            listed(table.parts().flat_map(Table::channels).map(Column::name))
        )));
        parts.extend(table.into_parts());
    }
    if let [_] = parts.as_slice() {
        notes.truncate(notes.len() - 1);
    }
    Table::of_parts(parts, notes).ok_or(JoinError::NoFiles)
}

/// Makes all files count from one instant.
fn on_one_clock(mut files: Vec<Named>) -> Result<Vec<Named>, JoinError> {
    let since = |table: &Table| table.origin().map(|origin| origin.since.clone());
    for pair in files.windows(2) {
        let [(a, first), (b, second)] = pair else {
            continue;
        };
        if since(first) != since(second) {
            return Err(JoinError::Clocks(a.clone(), b.clone()));
        }
    }
    let mut all: Vec<(&str, &mut Table)> = files
        .iter_mut()
        .map(|(name, table)| (name.as_str(), table))
        .collect();
    crate::align(&mut all);
    Ok(files)
}

/// Whether two files have the same channels in whatever order, part by part, but for those that one of them cannot use as a whole.
fn alike(a: &Table, b: &Table) -> bool {
    let lacks = |name: &str| {
        let mut lacking = a.unusable().iter().chain(b.unusable());
        lacking.any(|own| own.name == name)
    };
    let names = |table: &Table| -> Vec<Vec<String>> {
        let of = |part: &Table| {
            let names = part.channels().map(Column::name);
            let names = names.filter(|name| !lacks(name));
            let mut names: Vec<String> = names.map(str::to_owned).collect();
            names.sort();
            names
        };
        table.parts().map(of).collect()
    };
    names(a) == names(b)
}

/// What one file of a group lacks of a channel, all of them lack then; the readings that are there stay.
fn level(group: &mut [Named]) {
    let several = group.len() > 1;
    let mut lacking: Vec<(String, Fault)> = Vec::new();
    for (file, table) in group.iter() {
        for own in table.unusable() {
            if lacking.iter().all(|(known, _)| *known != own.name) {
                let mut fault = own.fault.clone();
                if several {
                    fault.message = format!("`{file}`: {}", fault.message);
                }
                lacking.push((own.name.clone(), fault));
            }
        }
    }
    for (_, table) in group {
        for (name, fault) in &lacking {
            table.set_apart(name, fault);
        }
    }
}

/// Files with the same channels, one after another.
fn continued(mut group: Vec<Named>, notes: &mut Vec<Note>) -> Result<Named, JoinError> {
    let begin = |table: &Table| table.time()[0];
    level(&mut group);
    group.sort_by(|(_, a), (_, b)| begin(a).total_cmp(&begin(b)));
    let mut group = group.into_iter();
    let (mut name, mut whole) = group.next().ok_or(JoinError::NoFiles)?;
    for (next, table) in group {
        if table.period().is_some() {
            return Err(JoinError::NoTimes(next));
        }
        let (ends_s, begins_s) = (whole.time()[whole.rows() - 1], begin(&table));
        if begins_s <= ends_s {
            return Err(JoinError::Overlap {
                first: name,
                ends_s,
                second: next,
                begins_s,
            });
        }
        notes.push(Note::new(format!(
            "`{next}` continues `{name}` after {}",
            seconds(begins_s - ends_s)
        )));
        whole = whole.followed_by(&table).map_err(|error| match error {
            Broken::Units(channel) => JoinError::Units {
                channel,
                file: next.clone(),
            },
            Broken::Table(error) => JoinError::Table(error),
        })?;
        name = next;
    }
    Ok((name, whole))
}

/// Why a table does not continue another.
pub(crate) enum Broken {
    /// A column has another unit.
    Units(String),
    /// The rows are no table.
    Table(TableError),
}

impl JoinError {
    /// What to change.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Overlap { .. } => format!(
                "these are several runs: give one of them, `--record {record}=FILE`, or let a calibration read each as a separate \
                 record: `fit EXPERIMENT(\"PATTERN\");`"
            ),
            Self::NoTimes(_) => "files that continue one another need a column of times".to_owned(),
            Self::Clocks(..) => {
                "give all files stamps of one kind, or declare a record for each of them".to_owned()
            }
            Self::Units { channel, .. } => {
                format!("write the unit: `(column = \"{channel}\" in [mm])`")
            }
            Self::NoFiles | Self::Table(_) => "give a file that has rows".to_owned(),
        }
    }
}

impl fmt::Display for JoinError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoFiles => write!(f, "there is no file of that name"),
            Self::Overlap {
                first,
                ends_s,
                second,
                begins_s,
            } => write!(
                f,
                "`{first}` and `{second}` have the same channels and overlap in time: the first ends at {ends_s} s, the \
                 second begins at {begins_s} s"
            ),
            Self::NoTimes(file) => write!(
                f,
                "`{file}` has the channels of another file and no times of its own"
            ),
            Self::Units { channel, file } => write!(
                f,
                "`{channel}` has another unit in `{file}` than in the file before it"
            ),
            Self::Clocks(first, second) => write!(
                f,
                "the clocks of `{first}` and `{second}` cannot be compared: one counts from another instant"
            ),
            Self::Table(error) => write!(f, "the files make no table: {error}"),
        }
    }
}

impl std::error::Error for JoinError {}

#[cfg(test)]
mod tests {
    use super::{JoinError, join};
    use crate::{Layout, Table, read};

    fn table(text: &str) -> Table {
        read(text.as_bytes(), &Layout::default()).unwrap()
    }

    fn named(files: &[(&str, &str)]) -> Vec<(String, Table)> {
        let files = files.iter();
        files
            .map(|(name, text)| ((*name).to_owned(), table(text)))
            .collect()
    }

    #[test]
    fn parts_of_one_log_continue_in_the_order_of_their_times() {
        let whole = join(named(&[
            ("log_10.csv", "t[s],x[mm]\n0.4,5\n0.5,6\n"),
            ("log_2.csv", "t[s],x[mm]\n0,1\n0.1,2\n"),
        ]))
        .unwrap();
        assert_eq!(whole.time(), [0.0, 0.1, 0.4, 0.5]);
        assert_eq!(
            whole.column("x").unwrap().in_unit().as_ref(),
            [1.0, 2.0, 5.0, 6.0]
        );
        let notes: Vec<String> = whole.notes().iter().map(ToString::to_string).collect();
        assert!(
            notes.contains(&"`log_10.csv` continues `log_2.csv` after 0.3 s".to_owned()),
            "{notes:?}"
        );
    }

    #[test]
    fn parts_may_have_their_columns_in_another_order() {
        let whole = join(named(&[
            ("w_1.csv", "t[s],x[mm],v[mm/s]\n0,1,10\n0.1,2,20\n"),
            (
                "w_2.csv",
                "Time[s],v[mm/s],x[m]\n0.2,30,0.003\n0.3,40,0.004\n",
            ),
        ]))
        .unwrap();
        let column = |name: &str| whole.column(name).unwrap().in_unit().into_owned();
        assert_eq!(whole.time(), [0.0, 0.1, 0.2, 0.3]);
        assert_eq!(column("x"), [1.0, 2.0, 3.0, 4.0]);
        assert_eq!(column("v"), [10.0, 20.0, 30.0, 40.0]);
    }

    #[test]
    fn what_one_part_lacks_of_a_channel_the_others_keep_as_readings() {
        let whole = join(named(&[
            ("a.csv", "t[s],x[mm],T[degC]\n0,1,20\n0.1,2,21\n"),
            ("b.csv", "t[s],x[mm],T[degC]\n0.2,3,\n0.3,4,23\n0.4,5,24\n"),
            ("c.csv", "t[s],x[mm],T[degC]\n0.5,6,25\n0.6,7,26\n"),
        ]))
        .unwrap();
        assert_eq!(whole.column("x").unwrap().values().len(), 7);
        let [lacking] = whole.unusable() else {
            panic!("{:?}", whole.unusable());
        };
        assert!(
            lacking
                .fault
                .message
                .starts_with("`b.csv`: line 2, column 3 (`T`)")
        );
        let readings = whole.reading("T");
        assert_eq!(readings.time(), [0.0, 0.1, 0.3, 0.4, 0.5, 0.6]);
        assert_eq!(
            readings.column("T").unwrap().in_unit().as_ref(),
            [20.0, 21.0, 23.0, 24.0, 25.0, 26.0]
        );
        // A column that no file can use as numbers stays what it is.
        let texts = join(named(&[
            ("a.csv", "t[s],x[mm],note\n0,1,ok\n0.1,2,ok\n"),
            ("b.csv", "t[s],x[mm],note\n0.2,3,1\n0.3,4,2\n"),
        ]))
        .unwrap();
        assert_eq!(texts.rows(), 4);
        assert!(texts.unusable()[0].readings.is_none());
    }

    #[test]
    fn other_channels_keep_their_own_times() {
        let whole = join(named(&[
            ("scope.csv", "t[s],x[mm]\n0,1\n0.1,2\n0.2,3\n"),
            ("plc.csv", "t[s],temperature[degC]\n0,20\n0.2,21\n"),
        ]))
        .unwrap();
        assert_eq!(whole.rows(), 3);
        assert_eq!(whole.holding("temperature").time(), [0.0, 0.2]);
    }

    #[test]
    fn dates_put_files_side_by_side() {
        let whole = join(named(&[
            (
                "a.csv",
                "time,x[mm]\n2026-01-02 10:00:00.5,1\n2026-01-02 10:00:01.5,2\n",
            ),
            (
                "b.csv",
                "time,i[A]\n2026-01-02 10:00:00,3\n2026-01-02 10:00:01,4\n2026-01-02 10:00:02,4\n",
            ),
        ]))
        .unwrap();
        assert_eq!(whole.holding("x").time(), [0.5, 1.5]);
        assert_eq!(whole.holding("i").time(), [0.0, 1.0, 2.0]);
    }

    #[test]
    fn runs_of_the_same_channels_are_not_one_record() {
        let same = "t[s],x[mm]\n0,1\n0.1,2\n";
        let error = join(named(&[("a.csv", same), ("b.csv", same)])).unwrap_err();
        assert!(matches!(error, JoinError::Overlap { .. }), "{error}");
        assert!(error.repair("log").contains("fit EXPERIMENT("));
    }

    #[test]
    fn clocks_that_cannot_be_compared_are_refused() {
        let error = join(named(&[
            (
                "a.csv",
                "time,x[mm]\n2026-01-02 10:00:00,1\n2026-01-02 10:00:01,2\n",
            ),
            ("b.csv", "t[s],i[A]\n0,3\n1,4\n"),
        ]))
        .unwrap_err();
        assert!(matches!(error, JoinError::Clocks(..)), "{error}");
    }
}
