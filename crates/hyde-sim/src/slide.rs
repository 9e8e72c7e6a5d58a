//! [`Slide`]: a switch that is held at its surface.

use hyde_program::Program;

/// Weights are rounding beyond 0 and 1 by this: a force exactly at its limit holds.
pub(crate) const ROUNDING: f64 = 1e-12;

/// The mode that is changed by a switch, on the lower and on the upper side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct ModePair {
    pub(crate) automaton: usize,
    pub(crate) modes: [usize; 2],
}

/// A switch that is held at its surface.
#[derive(Clone, Debug, serde::Serialize, serde::Deserialize)]
pub(crate) struct Slide {
    /// The relation whose root function is held at zero; it is positive on the upper side.
    pub(crate) surface: usize,
    /// Every relation that switches there, with whether it is true on the upper side.
    pub(crate) relations: Vec<(usize, bool)>,
    /// The modes that switch there.
    pub(crate) modes: Option<ModePair>,
    /// Along this direction y is put back on the surface: that in which the rates of the two sides differ, its leading
    /// component 1.
    pub(crate) direction: Vec<f64>,
    /// The row of the residual that is replaced.
    pub(crate) row: usize,
}

impl Slide {
    /// Whether a relation is held at its zero.
    pub(crate) fn holds(&self, relation: usize) -> bool {
        self.relations.iter().any(|(held, _)| *held == relation)
    }

    /// What lies in the memory on a side (0 lower, 1 upper): positions and values.
    pub(crate) fn settings(
        &self,
        program: &Program,
        side: usize,
    ) -> impl Iterator<Item = (usize, f64)> {
        let automata = &program.automata;
        let mode = self
            .modes
            .map(|pair| (automata[pair.automaton].place, pair.modes[side] as f64));
        let truths = self
            .relations
            .iter()
            .map(move |&(relation, upper)| (relation, f64::from(u8::from(upper == (side == 1)))));
        truths.chain(mode)
    }
}

/// Which form the replaced rows have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Surface {
    /// g = 0: for the solver.
    Place,
    /// dg/dt = 0: for consistent values.
    Rate,
}

/// How far a weight is from either end, positive inside.
pub(crate) fn margins(weight: f64) -> [f64; 2] {
    [weight + ROUNDING, 1.0 - weight + ROUNDING]
}
