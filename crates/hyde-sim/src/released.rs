//! [`Released`]: the states and the parameters that initial equations determine.

use hyde_program::Firmness;
use std::collections::BTreeSet;

/// What initial equations may determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Column {
    /// The state at this position.
    State(usize),
    /// The parameter at this place.
    Parameter(usize),
}

/// What initial equations determine, each with how firm it was and its start value.
#[derive(Clone, Debug, Default)]
pub(crate) struct Released(pub(crate) Vec<(Column, Firmness, f64)>);

impl Released {
    /// The positions of states.
    pub(crate) fn states(&self) -> BTreeSet<usize> {
        let state = |(column, ..): &(Column, Firmness, f64)| match *column {
            Column::State(position) => Some(position),
            Column::Parameter(_) => None,
        };
        self.0.iter().filter_map(state).collect()
    }

    /// The places of parameters.
    pub(crate) fn parameters(&self) -> Vec<usize> {
        let parameter = |(column, ..): &(Column, Firmness, f64)| match *column {
            Column::Parameter(place) => Some(place),
            Column::State(_) => None,
        };
        self.0.iter().filter_map(parameter).collect()
    }
}
