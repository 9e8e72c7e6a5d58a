//! Variables, parameters and record columns, as both stages hold them.

use crate::expr::{ExprArena, Index, Range};
use crate::id::{ClockId, ColumnId, DelayId, ExprId, VarId};
use hyde_diag::{Origin, Span};
use hyde_units::{Allowed, Dimension, Kind, NamedUnit};
use std::collections::BTreeMap;

/// What a value means: its dimension, and the unit in which people read it.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// For checking.
    pub dimension: Dimension,
    /// For printing; values are kept in SI.
    pub unit: NamedUnit,
}

impl Quantity {
    /// The quantity of a dimension in its usual unit.
    #[must_use]
    pub fn usual(dimension: Dimension) -> Self {
        Self {
            dimension,
            unit: NamedUnit::usual(dimension),
        }
    }

    /// A pure number.
    #[must_use]
    pub fn number() -> Self {
        Self::usual(Dimension::DIMENSIONLESS)
    }
}

/// How a record column is read between its rows (C4).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the last row, right-continuous.
    Held,
    /// Linear between rows.
    Linear,
}

/// What determines a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    /// The continuous equations.
    Continuous,
    /// `when` clauses and transitions: constant between events.
    Discrete,
    /// The equations of a clocked part: constant between its ticks.
    Clocked(ClockId),
    /// `hold(source)`: the clocked variable, after the clock's delay.
    Held(ClockId, VarId),
    /// A column of a record.
    Column(ColumnId, Interpolation),
    /// `delay(u, T)`: a continuous quantity as it was earlier.
    Delayed(DelayId),
    /// A number known after the run: the reduction of that number.
    Reduction(usize),
}

/// What the author says of a variable as a state, where equations leave the choice (`state = prefer`).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum StateChoice {
    /// It must not be one.
    Never,
    /// Only where there is no other.
    Avoid,
    /// As the compiler finds best.
    #[default]
    Open,
    /// Rather than others.
    Prefer,
    /// It must be one.
    Always,
}

impl StateChoice {
    /// The word for it.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Never => "never",
            Self::Avoid => "avoid",
            Self::Open => "open",
            Self::Prefer => "prefer",
            Self::Always => "always",
        }
    }

    /// The choice of a word.
    #[must_use]
    pub fn of(word: &str) -> Option<Self> {
        let all = [
            Self::Never,
            Self::Avoid,
            Self::Open,
            Self::Prefer,
            Self::Always,
        ];
        all.into_iter().find(|choice| choice.word() == word)
    }
}

/// A scalar variable, or an array whose elements share everything but their value.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Full dotted name.
    pub name: String,
    /// Number of elements of an array; `None` for a scalar.
    pub len: Option<usize>,
    /// What the first element is called: 1 for arrays, 0 for the nodes of a field.
    pub first: i32,
    /// What determines it.
    pub kind: VariableKind,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// Start value, of parameters alone: none, one for all elements (it may use the counter, from 0), or one each.
    pub start: Vec<ExprId>,
    /// Whether the start value is a condition rather than a guess.
    pub fixed: bool,
    /// Whether the start value, or whether it is fixed, is given for this model, not in the declaration of a part.
    pub start_given: bool,
    /// Whether `fixed = false` is said: it is the first to yield to an initial equation.
    pub freed: bool,
    /// Whether it is to be a state.
    pub state: StateChoice,
    /// Whether it is the flow of a connector.
    pub flow: bool,
    /// Truth-valued (1 or 0).
    pub boolean: bool,
    /// An `input`: something outside its component must determine it.
    pub input: bool,
    /// For the boundary flux of a field: `left end of bar`, said when its boundary condition is missing (F2).
    pub trace: Option<String>,
    /// Where it is declared.
    pub origin: Origin,
}

impl Variable {
    /// A scalar that nothing is said of but this.
    #[must_use]
    pub const fn new(name: String, kind: VariableKind, quantity: Quantity, origin: Origin) -> Self {
        Self {
            name,
            len: None,
            first: 1,
            kind,
            quantity,
            start: Vec::new(),
            fixed: false,
            start_given: false,
            freed: false,
            state: StateChoice::Open,
            flow: false,
            boolean: false,
            input: false,
            trace: None,
            origin,
        }
    }

    /// Number of elements; 1 for a scalar.
    #[must_use]
    pub fn size(&self) -> usize {
        self.len.unwrap_or(1)
    }

    /// The name of an element (counted from 0): `th[3]`, or the plain name of a scalar.
    #[must_use]
    pub fn element_name(&self, element: usize) -> String {
        match self.len {
            None => self.name.clone(),
            Some(_) => format!(
                "{}[{}]",
                self.name,
                i64::from(self.first) + i64::try_from(element).unwrap_or(0)
            ),
        }
    }
}

/// The spread of an uncertain number around its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prior {
    /// Uniform in value times (1 ± this).
    Relative(f64),
    /// Uniform in value ± this, SI.
    Absolute(f64),
}

/// What a parameter is to an effect.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Of a model: none.
    #[default]
    Plain,
    /// `size`: where all are 0 the effect vanishes (E3).
    Size,
    /// `shape`: means nothing where the effect has vanished.
    Shape,
}

/// A parameter: constant during a run.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Full dotted name.
    pub name: String,
    /// Number of elements of an array; `None` for a scalar.
    pub len: Option<usize>,
    /// Its value, of numbers and other parameters: one for all elements (it may use the counter, from 0), or one each.
    pub value: Vec<ExprId>,
    /// Dimension and printed unit.
    pub quantity: Quantity,
    /// The values it may have.
    pub allowed: Allowed,
    /// A change of it changes the equations and compiles anew.
    pub structural: bool,
    /// May not be set.
    pub is_final: bool,
    /// `fixed = false`: its value is a guess, an initial equation finds it.
    pub found: bool,
    /// Made by the compiler from other parameters; not shown and not set.
    pub derived: bool,
    /// Its spread, if it is uncertain.
    pub prior: Option<Prior>,
    /// What it is to its effect.
    pub role: Role,
    /// `in a .. b`: the values it may have, SI.
    pub range: Option<(f64, f64)>,
    /// Where the number comes from, in the author's words.
    pub source: Option<String>,
    /// Where it is declared or last modified.
    pub origin: Origin,
}

impl Parameter {
    /// A number that may be set, and that nothing is said of but this.
    #[must_use]
    pub fn new(name: String, value: ExprId, quantity: Quantity, origin: Origin) -> Self {
        Self {
            name,
            len: None,
            value: vec![value],
            quantity,
            allowed: Allowed::default(),
            structural: false,
            is_final: false,
            found: false,
            derived: false,
            prior: None,
            role: Role::Plain,
            range: None,
            source: None,
            origin,
        }
    }

    /// The name of an element (counted from 0): `k[3]`, or the plain name of a scalar.
    #[must_use]
    pub fn element_name(&self, element: usize) -> String {
        match self.len {
            None => self.name.clone(),
            Some(_) => format!("{}[{}]", self.name, element + 1),
        }
    }

    /// What an element (counted from 0) is set to from outside, if it is.
    #[must_use]
    pub fn setting(&self, element: usize, settings: &BTreeMap<String, f64>) -> Option<f64> {
        let own = settings.get(&self.element_name(element));
        // The only element of an array is named without its number too.
        let only = || settings.get(&self.name).filter(|_| self.size() == 1);
        own.or_else(only).copied()
    }

    /// Gives an element (counted from 0) another value; the others keep theirs.
    pub fn set(&mut self, element: usize, value: ExprId, exprs: &mut ExprArena) {
        if let [all] = self.value[..] {
            let counters = (0_i32..).take(self.size());
            self.value = counters
                .map(|counter| exprs.at_counter(all, counter))
                .collect();
        }
        self.value[element] = value;
    }

    /// Number of elements; 1 for a scalar.
    #[must_use]
    pub fn size(&self) -> usize {
        self.len.unwrap_or(1)
    }

    /// What gives its elements, whose first lies at a place: one value serves all of them, and an array may have none.
    #[must_use]
    pub fn rows(&self, place: i32) -> Vec<(Range, Index, ExprId)> {
        let size = i32::try_from(self.size()).unwrap_or(0);
        match self.value.as_slice() {
            [value] if size > 1 => {
                let all = Range {
                    first: 0,
                    last: size - 1,
                };
                let index = Index {
                    stride: 1,
                    offset: place,
                };
                vec![(all, index, *value)]
            }
            values => (place..place + size)
                .zip(values)
                .map(|(at, &value)| (Range::SCALAR, Index::fixed(at), value))
                .collect(),
        }
    }
}

/// A column of a record, or the same one row ahead.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// The record as the experiment calls it.
    pub record: String,
    /// The name in the header.
    pub column: String,
    /// `file.col.next`: the value one row ahead.
    pub next: bool,
    /// SI value = raw value * scale + offset where the header has no unit; (1, 0) where it has one.
    pub scale: (f64, f64),
    /// Standard deviation of what its values are not known to, SI; 0 if nothing is said.
    pub noise: f64,
    /// The period in s of a clock that gave it, if that ticks several times between two rows.
    pub ticks_s: Option<f64>,
    /// The Integer or Boolean that it drives: its kind, its name, and where that is said. Every row must have such a value.
    pub drives: Option<(Kind, String, Span)>,
}

#[cfg(test)]
mod tests {
    use super::{Parameter, Quantity};
    use crate::expr::{ExprArena, Index, Range};
    use hyde_diag::{InstancePath, Origin, Sources, Span};

    #[test]
    fn one_value_serves_all_elements_also_where_there_are_none() {
        let mut exprs = ExprArena::new();
        let value = exprs.constant(3.0);
        let here = Span::new(Sources::new().add("chain.hyde", "k"), 0, 1);
        let origin = Origin::source(here, &InstancePath::root());
        let mut parameter = Parameter::new("k".to_owned(), value, Quantity::number(), origin);
        assert_eq!(parameter.rows(5), [(Range::SCALAR, Index::fixed(5), value)]);
        parameter.len = Some(0);
        assert_eq!(parameter.rows(5), []);
        parameter.len = Some(1);
        assert_eq!(parameter.rows(5), [(Range::SCALAR, Index::fixed(5), value)]);
        parameter.len = Some(2);
        let both = Range { first: 0, last: 1 };
        let along = Index {
            stride: 1,
            offset: 5,
        };
        assert_eq!(parameter.rows(5), [(both, along, value)]);
    }
}
