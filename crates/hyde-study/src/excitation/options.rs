//! [`Options`]: what a user asks of an excitation, in the words of the command line.

use hyde_signal::excite::Shape;

/// How many speeds jogs have where nothing is written.
pub const SPEEDS: usize = 5;
/// How many places reversals have where nothing is written.
pub const PLACES: usize = 3;
/// The size of effects to distinguish, as a part of their range, where nothing is written.
pub const SIZE: f64 = 0.1;

/// What is asked for. Quantities are texts with their unit: `300 [mm]`.
#[derive(Clone, Debug)]
pub struct Options {
    /// A model is given: signals are compared on it.
    pub of_model: bool,
    /// The kinds of signal; with a model those to compare, all if empty.
    pub signal: Vec<Shape>,
    /// What makes a signal the best one for the parameters of a model.
    pub criterion: Criterion,
    /// Effects to distinguish: `Backlash@nut`.
    pub between: Vec<String>,
    /// Their size, as a part of their range.
    pub size: f64,
    /// Limits of a motion: travel, speed, acceleration, jerk.
    pub motion: [Option<String>; 4],
    /// Limit of a current, force, torque or voltage, for a signal that is not a motion.
    pub effort: Option<String>,
    /// Band of a multisine or chirp: `1 .. 100 [Hz]`.
    pub band: Option<String>,
    /// Length of the record.
    pub duration: Option<String>,
    /// Sampling period.
    pub every: Option<String>,
    /// Position of the axis before the record.
    pub start: Option<String>,
    /// Number of speeds of jogs, or of sizes of pulses.
    pub speeds: usize,
    /// Number of places of reversals.
    pub places: usize,
    /// Size of a reversal.
    pub reversal: Option<String>,
    /// Name of the column.
    pub column: Option<String>,
    /// Unit of the column.
    pub unit: Option<String>,
}

/// What makes a signal the best one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The smallest volume of the confidence ellipsoid.
    D,
    /// The smallest mean square of the standard deviations.
    A,
}

impl Default for Options {
    /// As the command line has them where nothing is written.
    fn default() -> Self {
        Self {
            of_model: false,
            signal: Vec::new(),
            criterion: Criterion::D,
            between: Vec::new(),
            size: SIZE,
            motion: [None, None, None, None],
            effort: None,
            band: None,
            duration: None,
            every: None,
            start: None,
            speeds: SPEEDS,
            places: PLACES,
            reversal: None,
            column: None,
            unit: None,
        }
    }
}
