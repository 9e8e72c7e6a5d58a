//! [`ChannelError`]: how large the innovations of a channel are, and how much alike from row to row.

use crate::observer::{Innovations, Observer};
use hyde_signal::statistics::{autocorrelation, mean_square};

/// Innovations of a channel in a record.
#[derive(Clone, Debug)]
pub struct ChannelError {
    /// Mean square of whitened innovations.
    pub chi: f64,
    /// Root mean square of innovations, SI.
    pub rms: f64,
    /// Correlation of successive innovations.
    pub correlation: f64,
}

/// Those of each channel of a record.
pub(crate) fn channel_errors(innovations: &Innovations, observer: &Observer) -> Vec<ChannelError> {
    let each = innovations.each_of_readings().zip(&observer.deviations);
    each.map(|(list, deviation)| {
        let chi = mean_square(&list);
        ChannelError {
            chi,
            rms: chi.sqrt() * deviation,
            correlation: autocorrelation(&list, 1),
        }
    })
    .collect()
}
