//! Which channels of a trace drive an axis and measure it.

use super::{NoModel, Template, Trace};
use hyde_signal::look::{Channel, Role};
use hyde_units::NamedUnit;

/// The channels that a model is mapped to.
#[derive(Clone, Debug)]
pub(super) struct Channels {
    /// What drives the motor.
    pub(super) drive: Drive,
    /// What shows the motor, and what shows the load.
    pub(super) motor: Option<Measured>,
    pub(super) load: Option<Measured>,
    /// Which were chosen, and which are left out, with the reason.
    pub(super) notes: Vec<String>,
}

/// The channel that drives the motor.
#[derive(Clone, Debug)]
pub(super) struct Drive {
    pub(super) name: String,
    /// A torque or a force instead of a current.
    pub(super) is_force: bool,
    /// Standard deviation of its noise, in its unit.
    pub(super) noise: f64,
    pub(super) unit: String,
}

/// A channel that shows where a part is, or how fast.
#[derive(Clone, Debug)]
pub(super) struct Measured {
    pub(super) name: String,
    pub(super) is_speed: bool,
    /// The step of its quantisation, in its unit.
    pub(super) step: Option<f64>,
    /// Standard deviation of its noise, in its unit.
    pub(super) noise: f64,
    pub(super) unit: String,
}

impl Measured {
    /// Whether a channel of the motor gives its position or speed as a way of the load.
    pub(super) fn is_way(&self, template: Template) -> bool {
        let dimension = |text: &str| {
            NamedUnit::parse(text)
                .ok()
                .map(|unit| unit.unit().dimension)
        };
        let own = dimension(&self.unit);
        template.slides() && (own == dimension("m") || own == dimension("m/s"))
    }
}

/// Chooses the channels.
pub(super) fn of(trace: &Trace, template: Template) -> Result<Channels, NoModel> {
    let all = &trace.look.channels;
    let drive = drive(all).ok_or_else(|| no_drive(trace))?;
    let mut notes = vec![format!("`{}` drives the model", drive.name)];
    let (mut motor, mut load) = (None, None);
    for is_speed in [false, true] {
        let role = if is_speed {
            Role::Speed
        } else {
            Role::Position
        };
        let mut turning = of_unit(all, role, if is_speed { "rad/s" } else { "rad" });
        let mut sliding = of_unit(all, role, if is_speed { "m/s" } else { "m" });
        // What names the motor is the motor's, whatever its unit; of two alike the first is.
        let (of_motor, of_load) = match template {
            Template::Linear => (Vec::new(), sliding),
            Template::Table | Template::Bench => split(&mut turning),
            Template::Screw | Template::Belt | Template::Rack => {
                let own = take(&mut sliding, is_of_motor);
                (turning.into_iter().chain(own).collect(), sliding)
            }
        };
        let measured = |channel: &&Channel| measured(channel, is_speed);
        motor = motor.or_else(|| of_motor.first().map(measured));
        load = load.or_else(|| of_load.first().map(measured));
    }
    let chosen: Vec<&Measured> = motor.iter().chain(&load).collect();
    if chosen.is_empty() {
        return Err(nothing_measured(trace, template));
    }
    for (part, found) in [("motor", &motor), ("load", &load)] {
        if let Some(found) = found {
            let what = if found.is_speed { "speed" } else { "position" };
            notes.push(format!(
                "`{}` is compared with the {what} of the {part}",
                found.name
            ));
        }
    }
    let used = |channel: &Channel| {
        channel.name == drive.name || chosen.iter().any(|own| own.name == channel.name)
    };
    for channel in all.iter().filter(|channel| !used(channel)) {
        let why = match channel.shown.role {
            _ if channel.shown.reference => "a reference",
            Role::Speed => {
                "a drive computes a speed from a position, behind a filter that is not known"
            }
            Role::Unknown => "nothing tells what it shows",
            Role::Position
            | Role::Current
            | Role::Force
            | Role::Voltage
            | Role::Temperature
            | Role::State => "the model has no part for it",
        };
        notes.push(format!("`{}` is not used: {why}", channel.name));
    }
    Ok(Channels {
        drive,
        motor,
        load,
        notes,
    })
}

/// A measured current, else a demanded one, else a torque or a force.
fn drive(all: &[Channel]) -> Option<Drive> {
    let of = |role: Role, reference: bool| {
        let mut own = all.iter().filter(|channel| {
            channel.shown.role == role
                && channel.shown.reference == reference
                && channel.unit.is_some()
        });
        own.next().map(|channel| Drive {
            name: channel.name.clone(),
            is_force: role == Role::Force,
            noise: channel.sampled.noise,
            unit: channel.unit.clone().unwrap_or_default(),
        })
    };
    of(Role::Current, false)
        .or_else(|| of(Role::Current, true))
        .or_else(|| of(Role::Force, false))
        .or_else(|| of(Role::Force, true))
}

fn of_unit<'c>(all: &'c [Channel], role: Role, unit: &str) -> Vec<&'c Channel> {
    let wanted = NamedUnit::parse(unit).map(|unit| unit.unit().dimension);
    let fits = |channel: &&Channel| {
        let own = channel.unit.as_deref().map(NamedUnit::parse);
        let own = own.and_then(Result::ok).map(|unit| unit.unit().dimension);
        let is_measured = channel.shown.role == role && !channel.shown.reference;
        is_measured && own.is_some() && own == wanted.as_ref().ok().copied()
    };
    all.iter().filter(fits).collect()
}

/// The motor's and the load's of channels in one unit: by their names, else in their order.
fn split<'c>(all: &mut Vec<&'c Channel>) -> (Vec<&'c Channel>, Vec<&'c Channel>) {
    let load = take(all, |channel| {
        words(channel)
            .any(|word| ["load", "table", "last", "tisch"].contains(&word.as_str()) || word == "l")
    });
    let mut motor = take(all, is_of_motor);
    let rest = std::mem::take(all);
    let mut load = load;
    for channel in rest {
        match motor.is_empty() {
            true => motor.push(channel),
            false => load.push(channel),
        }
    }
    (motor, load)
}

fn take<'c>(all: &mut Vec<&'c Channel>, own: impl Fn(&Channel) -> bool) -> Vec<&'c Channel> {
    let (taken, left) = all.drain(..).partition(|channel| own(channel));
    *all = left;
    taken
}

fn is_of_motor(channel: &Channel) -> bool {
    words(channel).any(|word| word.starts_with("mot") || word == "m" || word == "enc1")
}

fn words(channel: &Channel) -> impl Iterator<Item = String> + '_ {
    let names = [Some(channel.name.as_str()), channel.meaning.as_deref()];
    names.into_iter().flatten().flat_map(|name| {
        let parts = name.split(|c: char| !c.is_alphanumeric());
        parts.map(str::to_lowercase)
    })
}

fn measured(channel: &Channel, is_speed: bool) -> Measured {
    Measured {
        name: channel.name.clone(),
        is_speed,
        step: channel.sampled.step,
        noise: channel.sampled.noise,
        unit: channel.unit.clone().unwrap_or_default(),
    }
}

fn no_drive(trace: &Trace) -> NoModel {
    NoModel {
        message: format!(
            "`{}` has no channel of a current, a torque or a force that drives the axis; {}",
            trace.file,
            listed(trace)
        ),
        help: said(trace, "A"),
    }
}

fn nothing_measured(trace: &Trace, template: Template) -> NoModel {
    let unit = if template.slides() { "mm" } else { "deg" };
    NoModel {
        message: format!(
            "`{}` has no channel that shows a position or a speed of a {}; {}",
            trace.file,
            template.about(),
            listed(trace)
        ),
        help: said(trace, unit),
    }
}

fn listed(trace: &Trace) -> String {
    let each = trace
        .look
        .channels
        .iter()
        .map(|channel| match &channel.unit {
            Some(unit) => format!("`{}` [{unit}]", channel.name),
            None => format!("`{}` without a unit", channel.name),
        });
    let all: Vec<String> = each.collect();
    format!("it has {}", all.join(", "))
}

fn said(trace: &Trace, unit: &str) -> String {
    let bare = trace.look.channels.iter().find(|c| c.unit.is_none());
    let name = bare.or(trace.look.channels.first());
    let name = name.map_or("COLUMN", |channel| channel.name.as_str());
    format!(
        "say which column it is by its unit: `--from '{} (column = {name:?} in [{unit}])'`",
        trace.file
    )
}
