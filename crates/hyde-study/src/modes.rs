//! Natural frequencies and damping ratios of the linearised model, over a parameter too, and parameters from measured ones.
//!
//! ```text
//! point      an experiment with its operating point          modes/point.rs
//! inverse    parameters from measured frequencies            modes/inverse.rs
//! ```

mod inverse;
mod point;

pub use inverse::{Found, Measured, fitted};
pub use point::{Point, Prepared, asked_point};

use crate::settings::{self, Setting};
use crate::{Refused, assumptions, operating_point};
use hyde_experiment::{
    About, Linear, LinearizeError, ModeShape, NaturalMode, Pole, Poles, linearize_about,
    mode_shape, poles,
};
use hyde_sim::Reached;
use std::sync::Arc;

/// The modes of one experiment.
pub struct Modes {
    /// Its name, else that of the model.
    pub name: String,
    /// The model, and about what it is linearised.
    pub prepared: Prepared,
    /// The linearised model.
    pub linear: Linear,
    /// Its poles.
    pub poles: Poles,
    /// The modes that oscillate.
    pub modes: Vec<NaturalMode>,
    /// Their shapes; of what is in clocked parts alone there is none.
    pub shapes: Vec<Option<ModeShape>>,
    /// The poles that do not oscillate.
    pub real: Vec<Pole>,
    /// What was assumed of records and tables.
    pub notes: Vec<String>,
}

/// Finds the modes; `open` of the plant alone, `below` those below a frequency in Hz. `reached` hears how far the run to the
/// operating point is.
///
/// # Errors
/// The model cannot be linearised.
pub fn modes(
    prepared: Prepared,
    open: bool,
    below: Option<f64>,
    reached: &Arc<Reached>,
) -> Result<Modes, Refused> {
    let program = &prepared.compiled.program;
    let p = &prepared.parameters;
    let about = About {
        time: prepared.time,
        modes: &prepared.chosen,
        open,
        reached: Some(reached),
    };
    let linear = match linearize_about(program, &prepared.tables, p, &[], about) {
        Ok(linear) => linear,
        Err(LinearizeError::Failed(failure)) => return Err(prepared.no_point(failure)),
        Err(error) => {
            let why = operating_point::why_not(&error);
            return Err(Refused::Asked(format!(
                "the model is not linearised: {why}"
            )));
        }
    };
    let poles = poles(&linear);
    let (mut modes, mut shapes) = (Vec::new(), Vec::new());
    for pole in poles.oscillating() {
        let mode = pole.mode();
        if below.is_none_or(|limit| mode.frequency_hz < limit) {
            modes.push(mode);
            shapes.push(mode_shape(program, &linear, (&poles, &pole)));
        }
    }
    let notes = assumptions::of_model(&prepared.project, program, p);
    let name = prepared.project.experiment.clone();
    Ok(Modes {
        name: name.unwrap_or(program.name.clone()),
        real: poles.real(),
        prepared,
        linear,
        poles,
        modes,
        shapes,
        notes,
    })
}

/// Values of a parameter from one end to the other of `path=from..to [unit]`, evenly.
///
/// # Errors
/// The text is no range: what to write.
pub fn over(text: &str, count: usize) -> Result<Vec<Setting>, String> {
    let (from, to) = ends(text)?;
    let count = count.max(2);
    let values = (0..count).map(|k| {
        let part = k as f64 / (count - 1) as f64;
        Setting {
            value: from.value + part * (to.value - from.value),
            ..from.clone()
        }
    });
    Ok(values.collect())
}

/// Both ends of `path=from..to [unit]`.
fn ends(text: &str) -> Result<(Setting, Setting), String> {
    let bad = || format!("`--over {text}`: write `path=from..to [unit]`");
    let (path, range) = text.split_once('=').ok_or_else(bad)?;
    let (from, rest) = range.split_once("..").ok_or_else(bad)?;
    let unit = rest.find('[').map_or("", |at| &rest[at..]);
    let from = settings::parse(&format!("{path}={} {unit}", from.trim()))?;
    let to = settings::parse(&format!("{path}={}", rest.trim()))?;
    Ok((from, to))
}
