//! [`Released`]: the states and the parameters that initial equations determine.

use hyde_program::Firmness;

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
    pub(crate) fn has_state(&self, position: usize) -> bool {
        let state = Column::State(position);
        self.0.iter().any(|(column, ..)| *column == state)
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
