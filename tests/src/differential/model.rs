//! [`Model`]: the text of a random model, and what the comparisons need to know of it.

use super::{arrays, bodies, circuits};
use crate::linear::random as switching;

/// A random model. Its experiment is called `run`.
#[derive(Clone, Debug)]
pub struct Model {
    /// The file.
    pub text: String,
    /// The same model with every array written as scalars, if there are arrays.
    pub unrolled: Option<String>,
    /// Its operating point in s, 0 at the start, and the parameters that are start values.
    pub point: Option<(f64, Vec<String>)>,
    /// Parameters by which its run may be differentiated.
    pub parameters: Vec<String>,
    /// Whether `measure work` is all the energy that is supplied.
    pub measures_work: bool,
}

/// The model of a seed: bodies and joints of the library, circuits, plain equations that switch, or arrays.
#[must_use]
pub fn random(seed: u64) -> Model {
    match seed % 6 {
        0 => switching_model(seed),
        1 => arrays::random(seed),
        2 => circuits::random(seed),
        _ => bodies::random(seed),
    }
}

/// The models of the linear analysis, with an experiment that runs over their operating point.
fn switching_model(seed: u64) -> Model {
    let model = switching(seed);
    Model {
        text: model.text,
        unrolled: None,
        point: Some((model.at_s, model.starts.clone())),
        parameters: model.starts.into_iter().take(2).collect(),
        measures_work: false,
    }
}
