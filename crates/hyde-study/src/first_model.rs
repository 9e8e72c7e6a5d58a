//! A first model of an axis: parts of the library, with a trace mapped to it, an experiment, a calibration and a diagnosis.
//!
//! ```text
//! channels     which channels of the trace drive and measure the axis      first_model/channels.rs
//! estimate     inertia and friction that the trace shows                   first_model/estimate.rs
//! parts        values of the parts, from those or guessed                  first_model/parts.rs
//! text         the file                                                    first_model/text.rs
//! ```
//! What the trace does not say is a guess. Each line that has one ends with `// confirm`.

mod channels;
mod estimate;
mod parts;
mod text;

use hyde_signal::Table;
use hyde_signal::look::Look;

/// A kind of axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Template {
    /// Motor, ball-screw, table.
    Screw,
    /// Motor, toothed belt, carriage.
    Belt,
    /// Motor, gear, pinion on a rack, table.
    Rack,
    /// Linear motor, slide.
    Linear,
    /// Motor, worm or gear, rotary table.
    Table,
    /// Motor, flexible shaft, load.
    Bench,
}

impl Template {
    /// What it is, in a line.
    #[must_use]
    pub fn about(self) -> &'static str {
        match self {
            Self::Screw => "ball-screw axis",
            Self::Belt => "belt axis",
            Self::Rack => "rack-and-pinion axis",
            Self::Linear => "linear-motor axis",
            Self::Table => "rotary table",
            Self::Bench => "two-mass bench",
        }
    }

    /// Whether its load slides.
    #[must_use]
    pub fn slides(self) -> bool {
        !matches!(self, Self::Table | Self::Bench)
    }

    /// Whether its motor turns.
    #[must_use]
    pub fn turns(self) -> bool {
        self != Self::Linear
    }
}

/// A trace that the model is compared with.
#[derive(Clone, Debug)]
pub struct Trace {
    /// Its file, relative to that of the model.
    pub file: String,
    /// How it is to be read, as it stands behind the file.
    pub settings: String,
    /// Its columns, read so.
    pub table: Table,
    /// What is in it.
    pub look: Look,
}

/// What a first model is made from.
#[derive(Clone, Debug)]
pub struct Wish {
    /// The name of the package.
    pub name: String,
    /// The kind of axis.
    pub template: Template,
    /// Torque or force per current, SI, where it is known.
    pub constant: Option<f64>,
    /// Way per angle of the motor, m/rad; of a rotary table turns of the motor per turn.
    pub ratio: Option<f64>,
    /// Traces; none for a model with a loop of its own.
    pub traces: Vec<Trace>,
}

/// A first model.
#[derive(Clone, Debug)]
pub struct FirstModel {
    /// The text of its file.
    pub text: String,
    /// What was found in the trace and what was assumed.
    pub notes: Vec<String>,
    /// The name of its experiment.
    pub experiment: &'static str,
}

/// Why there is no model: what is wrong, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoModel {
    /// What is wrong.
    pub message: String,
    /// What to write instead.
    pub help: String,
}

/// Writes a first model.
///
/// # Errors
/// The trace has no channel that drives the axis, or none that measures it.
pub fn first_model(wish: &Wish) -> Result<FirstModel, NoModel> {
    let Some(trace) = wish.traces.first() else {
        let parts = parts::Parts::guessed(wish);
        return Ok(text::with_a_loop(wish, &parts));
    };
    let channels = channels::of(trace, wish.template)?;
    let mut notes = channels.notes.clone();
    let ratio = parts::ratio(wish, trace, &channels);
    notes.extend(ratio.note.clone());
    let shown = estimate::of(trace, &channels, wish.template, ratio.value);
    notes.push(match &shown {
        Some(found) => format!(
            "inertia and friction follow from the trace for the torque or force per current in the file: they explain {:.0} % of the current",
            100.0 * found.explained
        ),
        None => "the trace shows neither inertia nor friction: both are guesses".to_owned(),
    });
    let parts = parts::Parts::of(wish, &channels, &ratio, shown.as_ref());
    Ok(text::with_a_trace(wish, &channels, &parts, notes))
}
