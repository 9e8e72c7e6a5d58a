//! Sensitivities of the memory at the tick of a clock: what it writes, and what is held of it later.

use super::{Sensitivities, Slopes};
use crate::moment::At;
use crate::state::State;
use hyde_program::TickWrt;

impl Sensitivities {
    /// The derivatives of everything, to be taken up again.
    pub(crate) fn snapshot(&self) -> Slopes {
        self.now.clone()
    }

    /// The derivatives of what a tick writes, by those before it. `left` are those of the left limit, with the memory as
    /// the clocks that ticked before leave it.
    pub(crate) fn tick(
        &self,
        state: &mut State<'_>,
        clock: usize,
        at: At<'_>,
        delayed: &[f64],
        left: &mut Slopes,
    ) {
        let partials = state.tick_partials(clock, at, delayed);
        let targets = state.program.kernels.tick_targets(clock);
        for (number, direction) in self.directions.iter().enumerate() {
            let mut after = left.z[number].clone();
            targets.iter().for_each(|&target| after[target] = 0.0);
            for &(row, wrt, value) in &partials {
                let slope = match wrt {
                    TickWrt::Memory(column) => left.z[number][column],
                    TickWrt::Unknown(column) => left.y[number][column],
                    TickWrt::Derivative(column) => left.yp[number][column],
                    TickWrt::Parameter(place) => direction[place],
                    // Delays are refused.
                    TickWrt::Delayed(_) => 0.0,
                };
                if slope != 0.0 {
                    after[row] += value * slope;
                }
            }
            left.z[number] = after;
        }
    }

    /// Takes the derivatives of what clocks wrote.
    pub(crate) fn take_written(&mut self, after: &Slopes, written: &[usize]) {
        for (now, after) in self.now.z.iter_mut().zip(&after.z) {
            written.iter().for_each(|&place| now[place] = after[place]);
        }
        self.start_anew();
    }
}
