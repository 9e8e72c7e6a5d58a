//! MAT files, written: level 5 for MATLAB, Octave and SciPy ([`Level5`]), level 4 for trajectories as Modelica tools write
//! them ([`Level4`]).
//!
//! Layouts: The MathWorks, *MAT-File Format*. Crates that write such files write no names (`mat5`), or to paths alone
//! (`matrw`); here a file is bytes, which its user writes whole or not at all.

mod level_4;
mod level_5;

pub use level_4::Level4;
pub use level_5::Level5;
