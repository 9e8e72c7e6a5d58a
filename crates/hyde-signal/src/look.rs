//! What is in a record, before any model reads it: rates and gaps, how each channel was sampled, and what it may show.
//!
//! Functions from a [`Table`] to plain data; nothing here changes the record. Values are in the units of the file.

mod channel;
mod clock;
mod pairs;
mod role;

pub use channel::{Held, Limit, Sampled, Wrap};
pub use clock::Clock;
pub use pairs::{Delay, Slope};
pub use role::{Role, Shown};

use crate::{Note, Table, Unusable};

/// What is in a record.
#[derive(Clone, Debug)]
pub struct Look {
    /// The rates, one a part of the record.
    pub clocks: Vec<Clock>,
    /// The channels that can be used, in the order of the file.
    pub channels: Vec<Channel>,
    /// The columns that cannot.
    pub unusable: Vec<Unusable>,
    /// Channels that follow others.
    pub delays: Vec<Delay>,
    /// Channels that are the slope of others.
    pub slopes: Vec<Slope>,
    /// What the reader assumed.
    pub notes: Vec<Note>,
}

/// A channel of a record.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// What the file says in another row that it shows.
    pub meaning: Option<String>,
    /// The unit that the file says.
    pub unit: Option<String>,
    /// The number of its clock.
    pub clock: usize,
    /// How it was sampled.
    pub sampled: Sampled,
    /// What it may show.
    pub shown: Shown,
    /// A unit that it may have, with the reason, where the file does not say one.
    pub guessed: Option<(String, String)>,
}

/// Looks at a record.
#[must_use]
pub fn look(table: &Table) -> Look {
    let parts: Vec<&Table> = table.parts().collect();
    let mut channels = Vec::new();
    for (clock, part) in parts.iter().enumerate() {
        for column in part.channels() {
            let values = column.in_unit();
            channels.push(Channel {
                name: column.name().to_owned(),
                meaning: column.meaning().map(str::to_owned),
                unit: column.unit().map(|unit| unit.text().to_owned()),
                clock,
                sampled: channel::sampled(part.time(), &values),
                shown: role::of_name(column),
                guessed: None,
            });
        }
    }
    let (slopes, delays) = pairs::of(&parts);
    role::by_names(&mut channels);
    role::by_delays(&mut channels, &delays);
    role::by_slopes(&mut channels, &slopes);
    Look {
        clocks: parts.iter().map(|part| clock::of(part.time())).collect(),
        channels,
        unusable: table.unusable().to_vec(),
        delays,
        slopes,
        notes: table.notes().to_vec(),
    }
}
