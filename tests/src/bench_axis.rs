//! The bench axis as tests and figures vary it.

use crate::Example;

/// The axis as it is declared, with its experiment and its calibration.
///
/// # Errors
/// The file cannot be read.
pub fn declared() -> Result<Example, String> {
    Example::load("examples/bench_axis/axis.hyde", Some("bench"))
}

/// The axis with an effect in experiment and calibration: `Effects.NutBacklash(gap = 12 [um]) on screw`.
///
/// # Errors
/// The file cannot be read.
pub fn with(effect: &str) -> Result<Example, String> {
    let truth = format!("model Truth = Axis with {effect};\n\nexperiment bench");
    Ok(declared()?
        .rewritten("calibrate bench of Axis", "calibrate bench of Truth")
        .rewritten(") of Axis \"a record", ") of Truth \"a record")
        .rewritten("experiment bench", &truth))
}
