//! [`holding`]: an observer that holds an effect that was found and the declared model alike.
//!
//! All models are compared by one observer, that of the declared model. An effect with modes of its own may bring one in which
//! errors grow by that gain, as an open play does. There the gain is another ([`crate::observer::Observer::gain_in`]), and it
//! is enough to say that the effect is there; but the sum of squares jumps as modes come a row earlier or later, and a fit ends
//! where it happens to. So the search begins again by the observer of the model with the effect: its gain lets go of what
//! the effect does, and holds the declared model too.

use super::hypothesis::brings_modes;
use super::inquiry::Inquiry;
use super::stage::Stage;
use crate::observer::{Observer, Track};
use crate::plant::Unsupported;

/// The observer of a stage, if it has modes that the inquiry's does not hold; `None` where that is as good.
pub(super) fn holding(
    inquiry: &Inquiry<'_>,
    declared: &Stage,
    stage: &Stage,
) -> Result<Option<Observer>, Unsupported> {
    if !brings_modes(&stage.program, &declared.program) {
        return Ok(None);
    }
    let ground = inquiry.ground();
    if stage.tracks(&ground)?.iter().all(is_held) {
        return Ok(None);
    }
    let places = ground.set_in(&stage.program, &stage.values());
    Observer::new(&stage.program, inquiry.recordings, &places).map(Some)
}

/// Whether the observer's own gain holds a track in all its modes but those that fix a state: friction that sticks is left to
/// a gain of its own, for it forgets there what it was.
fn is_held(track: &Track<'_>) -> bool {
    let route = &track.route;
    let free = route.rows.iter().filter(|row| row.fixed.is_empty());
    let mut gains = free.map(|row| &route.configurations[row.modes[0]].gains);
    gains.all(|gains| gains.is_empty() || *gains == route.observer.gains)
}
