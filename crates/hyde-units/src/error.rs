//! What can be wrong with the text of a unit, where, and what to write instead.

use std::fmt;
use std::ops::Range;

/// A mistake in the text of a unit.
///
/// `Display` gives the fact and the help in one line; [`fact`](Self::fact) and [`help`](Self::help) give them apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    /// The bytes of the text that are wrong; empty at the end of the text if something is missing there.
    pub at: Range<usize>,
    /// What is wrong.
    pub kind: UnitErrorKind,
}

/// The kinds of mistakes in the text of a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitErrorKind {
    /// There is no text.
    Empty,
    /// A symbol that is in no table.
    Unknown {
        /// The symbol as written.
        symbol: String,
        /// What may have been meant, the likeliest first; often empty.
        candidates: Vec<String>,
    },
    /// Two symbols without a dot between them, as in `Nm`.
    Joined {
        /// The symbols as written.
        symbol: String,
        /// The product they mean, `N.m`.
        product: String,
    },
    /// A prefix on a symbol that does not take it, as in `kmin`.
    Prefix {
        /// The prefix.
        prefix: char,
        /// The symbol without it.
        symbol: String,
    },
    /// Something else than the grammar asks for.
    Unexpected {
        /// What should be there.
        expected: &'static str,
        /// What is there; empty at the end of the text.
        found: String,
    },
    /// A number other than 1.
    Factor {
        /// The number as written.
        number: String,
    },
    /// A symbol that data sheets use for more than one quantity, or for what is not a unit, as `oz`.
    Ambiguous {
        /// The symbol as written.
        symbol: String,
        /// What to write instead.
        advice: &'static str,
    },
    /// A product after a division, as in `J/kg.K`.
    TwoReadings {
        /// What probably was to be divided by, `kg.K`.
        divisor: String,
    },
    /// A temperature with a zero point of its own in a product or power, as in `W/degC`.
    Offset {
        /// The symbol.
        symbol: String,
    },
    /// An exponent that is too large or no exact ratio.
    Exponent {
        /// The exponent as written.
        exponent: String,
    },
    /// Too many parentheses in each other.
    TooDeep,
    /// A factor to SI that no double can hold.
    OutOfRange,
}

impl UnitError {
    /// What is wrong, without what to do about it.
    #[must_use]
    pub fn fact(&self) -> String {
        match &self.kind {
            UnitErrorKind::Empty => "a unit is missing".to_owned(),
            UnitErrorKind::Unknown { symbol, .. }
            | UnitErrorKind::Joined { symbol, .. }
            | UnitErrorKind::Ambiguous { symbol, .. } => {
                format!("unknown unit `{symbol}`")
            }
            UnitErrorKind::Prefix { prefix, symbol } => {
                format!("`{symbol}` does not take the prefix `{prefix}`")
            }
            UnitErrorKind::Unexpected { expected, found } if found.is_empty() => {
                format!("expected {expected}, found the end")
            }
            UnitErrorKind::Unexpected { expected, found } => {
                format!("expected {expected}, found `{found}`")
            }
            UnitErrorKind::Factor { number } => {
                format!("a unit cannot contain a factor such as `{number}`")
            }
            UnitErrorKind::TwoReadings { .. } => "a product after `/` is ambiguous".to_owned(),
            UnitErrorKind::Offset { symbol } => {
                format!("`{symbol}` has an offset zero point and cannot be part of a product")
            }
            UnitErrorKind::Exponent { exponent } => {
                format!("the exponent `{exponent}` is too large or not exact")
            }
            UnitErrorKind::TooDeep => "too many nested parentheses".to_owned(),
            UnitErrorKind::OutOfRange => "the factor to SI is out of range".to_owned(),
        }
    }

    /// What to write instead, where that can be said.
    #[must_use]
    pub fn help(&self) -> Option<String> {
        match &self.kind {
            UnitErrorKind::Empty => Some("write `1` for a bare number".to_owned()),
            UnitErrorKind::Unknown { candidates, .. } => {
                let quoted: Vec<_> = candidates.iter().map(|text| format!("`{text}`")).collect();
                (!quoted.is_empty()).then(|| format!("did you mean {}?", quoted.join(" or ")))
            }
            UnitErrorKind::Joined { product, .. } => Some(format!("write `{product}`")),
            UnitErrorKind::Unexpected { found, .. } if found == "-" => {
                Some("write `1` for a bare number".to_owned())
            }
            UnitErrorKind::Factor { .. } => Some("multiply the value by it instead".to_owned()),
            UnitErrorKind::Ambiguous { advice, .. } => Some((*advice).to_owned()),
            UnitErrorKind::TwoReadings { divisor } => Some(format!("write `/({divisor})`")),
            UnitErrorKind::Offset { .. } => Some("write `K`".to_owned()),
            UnitErrorKind::Prefix { symbol, .. } => Some(format!(
                "write `{symbol}`, and the power of ten in the number"
            )),
            UnitErrorKind::Unexpected { .. }
            | UnitErrorKind::Exponent { .. }
            | UnitErrorKind::TooDeep
            | UnitErrorKind::OutOfRange => None,
        }
    }
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.fact())?;
        match self.help() {
            Some(help) => write!(f, ": {help}"),
            None => Ok(()),
        }
    }
}

impl std::error::Error for UnitError {}
