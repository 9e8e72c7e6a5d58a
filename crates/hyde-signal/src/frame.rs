//! [`Frame`]: named columns of numbers, integers or texts, whatever they are over; what a file holds before it is a record.

use hyde_units::NamedUnit;

/// What the values of a column are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Doubles; one that is not there is NaN, and a null in the file.
    Number,
    /// Integers of 64 bits.
    Integer,
    /// UTF-8 texts.
    Text,
}

/// A column without its values.
#[derive(Clone, Debug, PartialEq)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What its values are.
    pub kind: Kind,
    /// The unit that its numbers are in; `None` where none is known.
    pub unit: Option<NamedUnit>,
}

impl Field {
    /// A column of numbers in a unit.
    #[must_use]
    pub fn number(name: impl Into<String>, unit: Option<NamedUnit>) -> Self {
        Self {
            name: name.into(),
            kind: Kind::Number,
            unit,
        }
    }

    /// A column of integers or texts.
    #[must_use]
    pub fn plain(name: impl Into<String>, kind: Kind) -> Self {
        Self {
            name: name.into(),
            kind,
            unit: None,
        }
    }
}

/// The values of a column.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Of [`Kind::Number`], in the unit of the column.
    Numbers(Vec<f64>),
    /// Of [`Kind::Integer`].
    Integers(Vec<i64>),
    /// Of [`Kind::Text`].
    Texts(Vec<String>),
}

impl Values {
    /// No values yet.
    #[must_use]
    pub fn empty(kind: Kind) -> Self {
        match kind {
            Kind::Number => Self::Numbers(Vec::new()),
            Kind::Integer => Self::Integers(Vec::new()),
            Kind::Text => Self::Texts(Vec::new()),
        }
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Integers(values) => values.len(),
            Self::Texts(values) => values.len(),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// What they are.
    #[must_use]
    pub fn kind(&self) -> Kind {
        match self {
            Self::Numbers(_) => Kind::Number,
            Self::Integers(_) => Kind::Integer,
            Self::Texts(_) => Kind::Text,
        }
    }
}

/// Named columns of equal length, with the metadata of their file.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    /// The columns' names, kinds and units.
    pub fields: Vec<Field>,
    /// Their values, one entry a field.
    pub values: Vec<Values>,
    /// Key-value metadata, the units of the columns apart.
    pub metadata: Vec<(String, String)>,
}

impl Frame {
    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Values::len)
    }

    /// The column of that name.
    #[must_use]
    pub fn column(&self, name: &str) -> Option<(&Field, &Values)> {
        let at = self.fields.iter().position(|field| field.name == name)?;
        Some((&self.fields[at], &self.values[at]))
    }

    /// The numbers of the column of that name, in its unit.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.column(name)?.1 {
            Values::Numbers(values) => Some(values),
            Values::Integers(_) | Values::Texts(_) => None,
        }
    }

    /// The integers of the column of that name.
    #[must_use]
    pub fn integers(&self, name: &str) -> Option<&[i64]> {
        match self.column(name)?.1 {
            Values::Integers(values) => Some(values),
            Values::Numbers(_) | Values::Texts(_) => None,
        }
    }

    /// The texts of the column of that name.
    #[must_use]
    pub fn texts(&self, name: &str) -> Option<&[String]> {
        match self.column(name)?.1 {
            Values::Texts(values) => Some(values),
            Values::Numbers(_) | Values::Integers(_) => None,
        }
    }

    /// The metadata of that key.
    #[must_use]
    pub fn note(&self, key: &str) -> Option<&str> {
        let found = self.metadata.iter().find(|(known, _)| known == key);
        found.map(|(_, value)| value.as_str())
    }
}
