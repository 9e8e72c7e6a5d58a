//! [`simulate`]: runs a [`hyde_program::Program`] to [`Results`].
//!
//! ```text
//! initial      start values, initial equations, first modes                         initial.rs
//! loop         one step, never past the next instant known beforehand               integrator.rs
//!              of IDA, or of a method that starts anew at no cost                   solver.rs, runge_kutta.rs
//!              states chosen anew where constraints tie them                     selection.rs
//!              guards checked on the step's interpolant; the first crossing located guards.rs
//!              events: reactions, ticks, held values, until nothing fires           events.rs, clocks.rs
//!              what both sides lead back to is slid on                              events/slides.rs, state/sliding.rs
//!              consistent values again, then on                                     consistent.rs
//!              rows, energies, reductions and derivatives follow at the same hooks simulation/followers.rs
//!              derivatives by parameters carried along, if they are asked for      sensitivity.rs
//!              what is delayed kept as polynomials, jumps with their arrivals       past.rs, delays.rs, history.rs
//! or           the same piece by piece, for a caller with a clock of its own        session.rs
//! ```
//! The language is unknown here: a program could as well be written by hand, and the tests of this crate do that. What
//! fails is a [`Failure`] with the time and the origin of the equation.

mod active;
mod clocks;
mod consistent;
mod creeping;
mod delays;
mod events;
mod failed_equation;
mod failure;
mod first_step;
mod foreign;
mod guards;
mod history;
mod hurry;
mod initial;
mod inputs;
mod integrator;
mod known_start;
mod lobatto;
mod meter;
mod moment;
mod norms;
mod operating_point;
mod past;
mod reached;
mod reductions;
mod release;
mod released;
mod residual_partials;
mod results;
mod root_rates;
mod runge_kutta;
mod selection;
mod sensitivity;
mod session;
mod setup;
mod simulation;
mod singular;
mod slide;
mod solver;
mod start_branches;
mod start_modes;
mod state;
mod time_spent;
mod zero;

pub use failure::{Failure, FailureKind, Reading};
pub use inputs::InputError;
pub use known_start::{KnownStart, MovedAtStart, known_start, moved_at_start};
pub use operating_point::{OperatingPoint, PointModes, PointTime, TakenMode, operating_point};
pub use reached::Reached;
pub use results::{
    Contradiction, Energies, Event, EventKind, Gradient, GradientEnd, GradientEndKind, LeftIda,
    Reduced, Results, Statistics, WhyLeft, Yielded,
};
pub use session::{Session, Variation};
pub use setup::Setup;
pub use simulation::{Advance, Advanced, Snapshot};

use hyde_program::Program;

/// Runs a program.
///
/// # Errors
/// A [`Failure`] with the results up to it.
pub fn simulate(program: &Program, setup: &Setup<'_>) -> Result<Results, Box<Failure>> {
    simulation::Simulation::new(program, setup)?.run()
}
