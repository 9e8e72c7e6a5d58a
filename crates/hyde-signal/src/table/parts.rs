//! The parts of a record: channels of one file with times of their own.

use super::{Table, TableError, Time};
use crate::gaps::seconds;
use crate::heading::is_time_unit;
use crate::join::Broken;
use crate::note::listed;
use crate::{Column, Fault, Note, Unusable};
use std::collections::BTreeMap;

impl Table {
    /// The table with the most rows, the first of several, with the others beside it; nothing if there is none.
    pub(crate) fn of_parts(mut parts: Vec<Self>, notes: Vec<Note>) -> Option<Self> {
        let most = (0..parts.len()).rev().max_by_key(|at| parts[*at].rows())?;
        if parts.len() > 1 {
            let mut all: Vec<(&str, &mut Self)> = parts.iter_mut().map(|part| ("", part)).collect();
            crate::align(&mut all);
        }
        let mut main = parts.remove(most);
        let own = std::mem::replace(&mut main.notes, notes);
        main.notes.extend(own);
        for part in &mut parts {
            let name = part.channels().next().map_or("", Column::name).to_owned();
            let notes = std::mem::take(&mut part.notes).into_iter();
            main.notes
                .extend(notes.map(|note| Note::new(format!("group of `{name}`: {note}"))));
            main.unusable.append(&mut part.unusable);
            let over_time = match part.time {
                Time::Column(at) => part.columns[at].unit().is_none_or(is_time_unit),
                Time::Every(..) => true,
            };
            let step = match part.usual_step().filter(|_| over_time) {
                Some(step) => format!(", {} apart", seconds(step)),
                None => String::new(),
            };
            main.notes.push(Note::new(format!(
                "{} rows of their own{step}: {}",
                part.rows(),
                listed(part.channels().map(Column::name))
            )));
        }
        main.others = parts;
        main.set_doubled_apart();
        Some(main)
    }

    /// A name that columns over different times have means none of them.
    fn set_doubled_apart(&mut self) {
        let mut seen: BTreeMap<String, usize> = BTreeMap::new();
        for column in self.parts().flat_map(Self::channels) {
            *seen.entry(column.name().to_owned()).or_default() += 1;
        }
        for (name, times) in seen.into_iter().filter(|(_, times)| *times > 1) {
            let time = match self.time {
                Time::Column(at) => Some(self.columns[at].name().to_owned()),
                Time::Every(..) => None,
            };
            let keep =
                |column: &Column| column.name() != name || Some(column.name()) == time.as_deref();
            self.columns.retain(keep);
            for part in &mut self.others {
                part.columns.retain(keep);
            }
            self.unusable.push(Unusable {
                fault: Fault {
                    message: format!("{times} columns over different times are named `{name}`"),
                    repair: "give every column a name of its own".to_owned(),
                },
                readings: None,
                name,
            });
        }
    }

    /// The names by which its columns can be had: their own, and what they show where that is clear.
    #[must_use]
    pub fn names(&self) -> Vec<(&str, &Column)> {
        let others = self.others.iter().flat_map(Self::channels);
        let all: Vec<&Column> = self.columns.iter().chain(others).collect();
        let shown = all
            .iter()
            .filter_map(|column| Some((column.meaning()?, *column)));
        let clear = |(name, _): &(&str, &Column)| {
            self.column(name)
                .is_some_and(|own| own.meaning() == Some(*name))
        };
        let mut names: Vec<(&str, &Column)> =
            all.iter().map(|column| (column.name(), *column)).collect();
        names.extend(shown.filter(clear));
        names
    }

    /// The parts of the record that have times of their own.
    #[must_use]
    pub fn others(&self) -> &[Self] {
        &self.others
    }

    /// The record itself and its other parts.
    pub fn parts(&self) -> impl Iterator<Item = &Self> {
        std::iter::once(self).chain(&self.others)
    }

    /// The part that has the column of that name; the record itself where none has.
    #[must_use]
    pub fn holding(&self, column: &str) -> &Self {
        let has = |part: &&Self| part.own(column).is_some();
        self.parts().find(has).unwrap_or(self)
    }

    /// The part with the readings of a column, some of which may be missing; the record itself where there is no such column.
    #[must_use]
    pub fn reading(&self, column: &str) -> &Self {
        let mut sparse = self.unusable.iter();
        let own = sparse.find(|own| own.name == column);
        match own.and_then(|own| own.readings.as_deref()) {
            Some(readings) => readings,
            None => self.holding(column),
        }
    }

    /// The readings of a column over the time of the table, NaN where one is missing, as a record of their own; none of less
    /// than two.
    pub(crate) fn readings_of(&self, column: &Column) -> Option<Self> {
        let there: Vec<bool> = column.values().iter().map(|v| v.is_finite()).collect();
        if there.iter().filter(|there| **there).count() < 2 {
            return None;
        }
        let time = match self.time {
            Time::Column(at) => self.columns[at].rows_with(&there),
            Time::Every(..) => Column::raw("time", self.time().to_vec()).rows_with(&there),
        };
        Self::with_time(vec![time, column.rows_with(&there)], 0).ok()
    }

    /// The columns that are not the time.
    pub fn channels(&self) -> impl Iterator<Item = &Column> {
        let time = match self.time {
            Time::Column(at) => Some(at),
            Time::Every(..) => None,
        };
        let all = self.columns.iter().enumerate();
        all.filter(move |(at, _)| Some(*at) != time)
            .map(|(_, column)| column)
    }

    /// The tables of its parts, each for itself; what is known of the file stays with the first.
    pub(crate) fn into_parts(mut self) -> Vec<Self> {
        let others = std::mem::take(&mut self.others);
        std::iter::once(self).chain(others).collect()
    }

    /// The rows of this record and behind them those of another with the same channels, part by part.
    pub(crate) fn followed_by(self, later: &Self) -> Result<Self, Broken> {
        let own = self.into_parts().into_iter();
        let mut parts = own
            .zip(later.parts())
            .map(|(own, later)| own.appended(later));
        let mut first = parts.next().ok_or(Broken::Table(TableError::Empty))??;
        first.others = parts.collect::<Result<_, _>>()?;
        for note in &later.notes {
            if !first.notes.contains(note) {
                first.notes.push(note.clone());
            }
        }
        for own in &mut first.unusable {
            let same = later.unusable.iter().find(|later| later.name == own.name);
            let later = same.and_then(|later| later.readings.as_deref());
            own.readings = match (own.readings.take(), later) {
                (Some(readings), Some(later)) => Some(Box::new(readings.appended(later)?)),
                (Some(_) | None, _) => None,
            };
        }
        Ok(first)
    }

    /// Makes a channel one that lacks readings, as another file of the record lacks some: `fault` says which. Those that it has
    /// stay.
    pub(crate) fn set_apart(&mut self, name: &str, fault: &Fault) {
        if let Some(own) = self.unusable.iter_mut().find(|own| own.name == name) {
            own.fault = fault.clone();
            return;
        }
        let own = self.taken(name);
        let of_part = || self.others.iter_mut().find_map(|part| part.taken(name));
        let readings = own.or_else(of_part).flatten();
        self.unusable.push(Unusable {
            name: name.to_owned(),
            fault: fault.clone(),
            readings: readings.map(Box::new),
        });
    }

    /// Takes a channel out of this part, if it has it: its readings, where there are enough for a record of their own.
    fn taken(&mut self, name: &str) -> Option<Option<Self>> {
        let time = match self.time {
            Time::Column(at) => Some(at),
            Time::Every(..) => None,
        };
        let mut columns = (0..self.columns.len()).filter(|at| Some(*at) != time);
        let at = columns.find(|at| self.columns[*at].name() == name)?;
        let readings = self.readings_of(&self.columns[at]);
        self.columns.remove(at);
        if let Time::Column(time) = &mut self.time {
            *time -= usize::from(*time > at);
        }
        Some(readings)
    }

    fn appended(self, later: &Self) -> Result<Self, Broken> {
        let columns = self.columns.iter().enumerate().map(|(at, own)| {
            // The other file may have its columns in another order, and call its time otherwise.
            let same = match (&self.time, &later.time) {
                (Time::Column(time), Time::Column(other)) if *time == at => {
                    later.columns.get(*other)
                }
                (Time::Column(_) | Time::Every(..), _) => {
                    later.channels().find(|column| column.name() == own.name())
                }
            };
            let whole = same.and_then(|later| own.followed_by(later));
            whole.ok_or_else(|| Broken::Units(own.name().to_owned()))
        });
        let columns: Result<Vec<Column>, Broken> = columns.collect();
        let rows = self.with_columns(columns?).map_err(Broken::Table)?;
        Ok(Self {
            columns: rows.columns,
            time: rows.time,
            ..self
        })
    }

    /// The same record with other columns: each made of a column and the part that it stands in.
    ///
    /// # Errors
    /// If they do not make a table.
    pub fn mapped(
        &self,
        mut map: impl FnMut(&Self, &Column) -> Column,
    ) -> Result<Self, TableError> {
        let mut part = |part: &Self| {
            let columns = part
                .columns
                .iter()
                .map(|column| map(part, column))
                .collect();
            part.with_columns(columns)
        };
        let mut found = part(self)?;
        found.others = self
            .others
            .iter()
            .map(&mut part)
            .collect::<Result<_, _>>()?;
        for own in &self.unusable {
            let readings = own.readings.as_ref().map(|readings| part(readings));
            found.unusable.push(Unusable {
                readings: readings.transpose()?.map(Box::new),
                ..own.clone()
            });
        }
        Ok(found)
    }
}
