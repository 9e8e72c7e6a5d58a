//! [`Measures`]: the error of a model on a record, always the same three measures (L1), each over its noise floor.
//!
//! ```text
//! chi            mean square of whitened innovations of the fixed observer     floor 1
//! windows        rms over 100 ms, open loop, the start fitted                  floor: noise and rounding
//! free run       rms with the loop closed, driven by the reference, low-passed  floor: noise behind the low-pass, and what
//!                                                                              two runs differ by whose encoders are
//!                                                                              shifted by half a count
//! ```

use super::channel_error::{ChannelError, channel_errors};
use super::free_run::{FreeChannel, free_run};
use super::windows::{Windows, windows};
use crate::observer::{Innovations, Observer};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use rayon::prelude::*;

/// A model whose error is measured: its programs with their parameters.
#[derive(Clone, Copy)]
pub struct Model<'a> {
    /// The program in the observed form.
    pub observed: &'a Program,
    /// The program with its loop closed, where it is known.
    pub closed: Option<&'a Program>,
    /// The same with quantisers shifted by half a step: only what is to have a floor needs it.
    pub shifted: Option<&'a Program>,
    /// Values set, by name, SI: later ones count.
    pub set: &'a [(String, f64)],
}

/// The error of a model on a record.
#[derive(Clone, Debug)]
pub struct Measures {
    /// The record.
    pub record: String,
    /// Mean square of whitened innovations over all channels.
    pub chi: f64,
    /// Innovations, channel by channel.
    pub innovations: Vec<ChannelError>,
    /// What innovations are, whitened, row by row.
    pub whitened: Innovations,
    /// Open-loop windows.
    pub windows: Windows,
    /// The free run; why there is none otherwise.
    pub free: Result<Vec<FreeMeasure>, String>,
    /// Standard deviation of noise and rounding, channel by channel, SI.
    pub noise: Vec<f64>,
}

/// A channel of a free run with its floor.
#[derive(Clone, Debug)]
pub struct FreeMeasure {
    /// The channel.
    pub channel: FreeChannel,
    /// What would be left of the error if the model were the axis, SI; `None` where no shifted run says.
    pub floor: Option<f64>,
}

impl Model<'_> {
    /// Its error on each of some records.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn measures(
        &self,
        recordings: &[Recording],
        observer: &Observer,
    ) -> Result<Vec<Measures>, Unsupported> {
        recordings
            .par_iter()
            .map(|recording| self.measure(recording, observer))
            .collect()
    }

    fn measure(&self, recording: &Recording, observer: &Observer) -> Result<Measures, Unsupported> {
        let program = self.observed;
        let places: Vec<(usize, f64)> = self
            .set
            .iter()
            .filter_map(|(name, value)| {
                let (parameter, element) = program.parameter(name)?;
                (!parameter.structural).then_some((parameter.place + element, *value))
            })
            .collect();
        let whitened = Innovations::of(program, recording, observer, &places)?;
        Ok(Measures {
            record: recording.name.clone(),
            chi: whitened.chi(),
            innovations: channel_errors(&whitened, observer),
            windows: windows(program, recording, observer, &places)?,
            free: self.free(recording, observer),
            noise: observer.noise.clone(),
            whitened,
        })
    }

    fn free(&self, recording: &Recording, observer: &Observer) -> Result<Vec<FreeMeasure>, String> {
        let program = self.closed.ok_or("the loop is not known")?;
        let run = |program| free_run(program, recording, self.set).map_err(|error| reason(&error));
        let own = run(program)?;
        let other = self.shifted.map(run).transpose()?;
        let floor = |number: usize, channel: &FreeChannel| {
            let ripple = other.as_ref()?.get(number)?;
            // A record and a model that is right differ as two such runs do, and by the noise of the record.
            Some((observer.noise[number] * channel.passed).hypot(channel.differs(ripple)))
        };
        let each = own.into_iter().enumerate();
        Ok(each
            .map(|(number, channel)| FreeMeasure {
                floor: floor(number, &channel),
                channel,
            })
            .collect())
    }
}

/// Why there is no free run, in a line.
fn reason(error: &hyde_experiment::RunError) -> String {
    use hyde_experiment::RunError;
    match error {
        RunError::Failed(failure) => format!("the run ended at {:.4} s", failure.t),
        RunError::NoParameter(name) => format!("the closed loop has no parameter `{name}`"),
        RunError::CannotSet(name, why) => format!("`{name}` cannot be set: {why}"),
        RunError::NotAllowed(name, why) => format!("the value of `{name}` is not allowed: {why}"),
        RunError::Row(fault) => fault.to_string(),
        RunError::NoGradientBy(name, why) => format!("no gradient by `{name}`: {why}"),
        RunError::TooManyRows { rows, .. } => format!("it has {rows:.1e} rows"),
        RunError::NotANumber { variable, .. } => format!("`{variable}` is not a number"),
        RunError::NoStop => "nothing says when it ends".to_owned(),
        RunError::EndsBeforeStart {
            start_s, stop_s, ..
        } => format!("it ends at {stop_s} s, before it starts at {start_s} s"),
        RunError::Lasts(span_s) => format!("it would last {span_s} s"),
        RunError::NotPositive(what, value) => format!("{what} is {value}"),
        RunError::Compare(error) => format!("the channel `{}`: {}", error.channel, error.cause),
    }
}
