//! Records over one clock: their times count from one instant, where their clocks can be compared.

use crate::calendar::{self, Since, Zone};
use crate::{Note, Table};

/// Makes the times of tables count from one instant, where their clocks can be compared; where not, each of them says so.
pub fn align(tables: &mut [(&str, &mut Table)]) {
    let since: Vec<Option<Since>> = tables
        .iter()
        .map(|(_, table)| Some(table.origin()?.since.clone()))
        .collect();
    if since.iter().all(Option::is_none) {
        return;
    }
    if since.windows(2).any(|pair| pair[0] != pair[1]) {
        let names: Vec<String> = tables.iter().map(|(name, _)| format!("`{name}`")).collect();
        let note = Note::new(format!(
            "the clocks of the records {} cannot be compared: each counts as it stands, or from its own first row",
            names.join(", ")
        ));
        for (_, table) in tables {
            table.tell(note.clone());
        }
        return;
    }
    put_in_zones(tables);
    let origins = tables.iter().filter_map(|(_, table)| table.origin());
    let first = origins.min_by_key(|origin| origin.nanoseconds).cloned();
    let Some(first) = first else {
        return;
    };
    for (_, table) in tables {
        let later = table
            .origin()
            .map_or(0, |origin| origin.nanoseconds - first.nanoseconds);
        if later > 0 {
            table.begin_later(calendar::seconds(later), &first);
        }
    }
}

/// Stamps without an offset from UTC beside others with one are taken for times with that one, and this is told; so are
/// zones of different names.
fn put_in_zones(tables: &mut [(&str, &mut Table)]) {
    let zones: Vec<Zone> = tables
        .iter()
        .filter_map(|(_, table)| Some(table.origin()?.zone.clone()))
        .collect();
    if zones.windows(2).all(|pair| pair[0] == pair[1]) {
        return;
    }
    let offset = zones.iter().find(|zone| matches!(zone, Zone::Offset(_)));
    for (_, table) in tables {
        let Some(origin) = table.origin().cloned() else {
            continue;
        };
        let lacks = match &origin.zone {
            Zone::Offset(_) => continue,
            Zone::Named(name) if name.is_empty() => {
                "its stamps do not say their offset from UTC".to_owned()
            }
            Zone::Named(name) => format!("the offset of its zone `{name}` from UTC is not known"),
        };
        let taken = match offset {
            Some(offset) => format!("{offset}, as those of another file, is taken for it"),
            None => "the other files are taken to have the same".to_owned(),
        };
        table.tell(Note::new(format!("{lacks}: {taken}")));
        if let Some(offset) = offset {
            table.count_from(origin.in_zone(offset));
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::{Layout, Table, align, read};

    /// Two samples, the first of them at a stamp.
    fn at(stamps: [&str; 2]) -> Table {
        let text = format!("time,x [mm]\n{},1\n{},2\n", stamps[0], stamps[1]);
        read(text.as_bytes(), &Layout::default()).unwrap()
    }

    fn aligned(mut first: Table, mut second: Table) -> (f64, f64, Vec<String>) {
        align(&mut [("a", &mut first), ("b", &mut second)]);
        let notes = first.notes().iter().chain(second.notes());
        let notes = notes.map(ToString::to_string).collect();
        (first.time()[0], second.time()[0], notes)
    }

    #[test]
    #[allow(clippy::float_cmp, reason = "whole numbers of seconds")]
    fn offsets_from_utc_are_taken_into_account() {
        let local = || at(["2023-01-02T04:04:05+01:00", "2023-01-02T04:04:06+01:00"]);
        let utc = at(["2023-01-02T03:04:05Z", "2023-01-02T03:04:06Z"]);
        let (a, b, notes) = aligned(local(), utc);
        assert_eq!((a, b), (0.0, 0.0), "{notes:?}");
        let earlier = at(["2023-01-02T04:04:05+02:00", "2023-01-02T04:04:06+02:00"]);
        let (a, b, _) = aligned(local(), earlier);
        assert_eq!((a, b), (3600.0, 0.0));
        // Without an offset: that of the other file, which is told.
        let bare = at(["2023-01-02 04:04:07", "2023-01-02 04:04:08"]);
        let (a, b, notes) = aligned(local(), bare);
        assert_eq!((a, b), (0.0, 2.0));
        let said = "its stamps do not say their offset from UTC: UTC+01:00, as those of another file, is taken for it";
        assert!(notes.iter().any(|note| note == said), "{notes:?}");
    }

    #[test]
    fn days_that_cannot_be_told_from_months_are_not_compared() {
        let at = |date: &str| at([&format!("{date} 10:00:00"), &format!("{date} 10:00:01")]);
        let (_, b, notes) = aligned(at("03/05/2024"), at("03/06/2024"));
        assert!(b.abs() < 1e-9 && notes.iter().any(|note| note.contains("cannot be compared")));
    }
}
