//! Problems written by hand: the third implementer of [`hyde_program::Kernels`], beside machine code and the interpreter
//! of the IR. No language, no compiler: equations, derivatives and tables as a person writes them, each problem against
//! its closed form.
#![allow(
    clippy::float_cmp,
    clippy::unwrap_used,
    reason = "tests compare what is exact and unwrap what must be there"
)]

mod bouncing_ball;
mod by_hand;
mod chosen_states;
mod dae;
mod differences;
mod oscillator;
mod sampled;
mod stick_slip;
