//! What a channel may show, by its unit, its name, and what it does beside others; always with the reason.

use super::{Channel, Delay, Slope};
use crate::Column;
use hyde_units::{Agreement, Dimension, NamedUnit, unit_in_name};
use std::fmt;

/// What a channel may show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// A position or an angle.
    Position,
    /// A speed.
    Speed,
    /// A current.
    Current,
    /// A force or a torque.
    Force,
    /// A voltage.
    Voltage,
    /// A temperature.
    Temperature,
    /// A truth or a state.
    State,
    /// Nothing tells.
    Unknown,
}

/// A role, whether it is that of a reference, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shown {
    /// What it is.
    pub role: Role,
    /// Whether it is what the channel should be, not what was measured.
    pub reference: bool,
    /// Why.
    pub why: Vec<String>,
}

impl fmt::Display for Role {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Position => "position",
            Self::Speed => "speed",
            Self::Current => "current",
            Self::Force => "force",
            Self::Voltage => "voltage",
            Self::Temperature => "temperature",
            Self::State => "state",
            Self::Unknown => "?",
        })
    }
}

impl fmt::Display for Shown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.reference {
            true => write!(f, "{} reference", self.role),
            false => write!(f, "{}", self.role),
        }
    }
}

/// What words in names mean; a word may be the beginning of a longer one.
const WORDS: [(&str, Role); 25] = [
    ("pos", Role::Position),
    ("lage", Role::Position),
    ("weg", Role::Position),
    ("angle", Role::Position),
    ("winkel", Role::Position),
    ("enc", Role::Position),
    ("vel", Role::Speed),
    ("speed", Role::Speed),
    ("drehzahl", Role::Speed),
    ("geschw", Role::Speed),
    ("rpm", Role::Speed),
    ("omega", Role::Speed),
    ("cur", Role::Current),
    ("strom", Role::Current),
    ("iq", Role::Current),
    ("amp", Role::Current),
    ("torque", Role::Force),
    ("force", Role::Force),
    ("moment", Role::Force),
    ("kraft", Role::Force),
    ("volt", Role::Voltage),
    ("spannung", Role::Voltage),
    ("temp", Role::Temperature),
    ("enable", Role::State),
    ("status", Role::State),
];

const REFERENCES: [&str; 9] = [
    "ref", "soll", "cmd", "command", "set", "target", "demand", "nom", "desired",
];

/// A channel with such a word in its name was measured.
const MEASURED: [&str; 7] = ["ist", "act", "meas", "mot", "enc", "feedback", "fbk"];

/// A channel comes later by more than this part of the time between samples.
const LATER: f64 = 0.5;

const UNITS: [(&str, Role); 9] = [
    ("m", Role::Position),
    ("rad", Role::Position),
    ("m/s", Role::Speed),
    ("rad/s", Role::Speed),
    ("A", Role::Current),
    ("N", Role::Force),
    ("N.m", Role::Force),
    ("V", Role::Voltage),
    ("K", Role::Temperature),
];

/// By unit, then by name.
pub(super) fn of_name(column: &Column) -> Shown {
    let mut why = Vec::new();
    let of_unit = column.unit().and_then(|unit| {
        let role = UNITS
            .iter()
            .find(|(text, _)| of_dimension(text, unit.unit().dimension))?;
        why.push(format!("its unit is {}", unit.text()));
        Some(role.1)
    });
    let names = [Some(column.name()), column.meaning()];
    let words: Vec<String> = names.into_iter().flatten().flat_map(words).collect();
    let of_word = WORDS.iter().find_map(|(word, role)| {
        // An amplitude is one of anything.
        let is =
            |own: &&String| own.starts_with(word) && !(*word == "amp" && own.starts_with("ampl"));
        let found = words.iter().find(is)?;
        Some((found, *role))
    });
    if let Some((word, role)) = of_word
        && of_unit.is_none_or(|own| own == role)
    {
        why.push(format!("its name has `{word}`"));
    }
    let reference = words
        .iter()
        .find(|own| REFERENCES.iter().any(|word| own.starts_with(word)));
    if let Some(word) = reference {
        why.push(format!("its name has `{word}`"));
    }
    Shown {
        role: of_unit
            .or(of_word.map(|(_, role)| role))
            .unwrap_or(Role::Unknown),
        reference: reference.is_some(),
        why,
    }
}

/// A channel that is the slope of a position is a speed, and the other way round; units follow from that.
pub(super) fn by_slopes(channels: &mut [Channel], slopes: &[Slope]) {
    for slope in slopes {
        // Of sines each is the slope of the other: names and units tell, or nothing does.
        let mutual = slopes
            .iter()
            .any(|s| s.of == slope.slope && s.slope == slope.of);
        let place = |channels: &[Channel], name: &str| channels.iter().position(|c| c.name == name);
        let (Some(of), Some(own)) = (place(channels, &slope.of), place(channels, &slope.slope))
        else {
            continue;
        };
        let correlation = format!("(correlation {:.3})", slope.correlation);
        if matches!(channels[own].shown.role, Role::Unknown | Role::Speed)
            && matches!(channels[of].shown.role, Role::Unknown | Role::Position)
            && (!mutual
                || channels[of].shown.role == Role::Position
                || channels[own].shown.role == Role::Speed)
        {
            channels[own].shown.role = Role::Speed;
            let other = &slope.of;
            let why = match times_the_slope(slope, &channels[of], &channels[own]) {
                Times::One => format!("it is the slope of `{other}` {correlation}"),
                Times::MinusOne => {
                    format!("it is the slope of `{other}` with the other sign {correlation}")
                }
                Times::Other(times) => {
                    format!("it is {times} times the slope of `{other}` {correlation}")
                }
            };
            channels[own].shown.why.push(why);
            channels[of].shown.role = Role::Position;
            let other = &slope.slope;
            let why = match times_the_slope(slope, &channels[of], &channels[own]) {
                Times::One => format!("its slope is `{other}` {correlation}"),
                Times::MinusOne => {
                    format!("its slope is `{other}` with the other sign {correlation}")
                }
                Times::Other(times) => {
                    format!("`{other}` is {times} times its slope {correlation}")
                }
            };
            channels[of].shown.why.push(why);
        }
        guess(channels, of, own, slope);
    }
}

/// How many times the slope of a channel another one is, by the units of both.
enum Times {
    /// It is the slope; or a unit is not known, and its factor may be that of the unit.
    One,
    /// The same with the other sign.
    MinusOne,
    /// Another factor, as text.
    Other(String),
}

/// By so much a factor may differ from 1: noise makes it less.
const NEARLY: f64 = 0.03;

fn times_the_slope(slope: &Slope, of: &Channel, own: &Channel) -> Times {
    let si = |channel: &Channel| {
        let unit = NamedUnit::parse(channel.unit.as_deref()?).ok()?.unit();
        Some((unit.difference_to_si(1.0), unit.dimension))
    };
    let times = match (si(of), si(own)) {
        (Some((of_si, dimension)), Some((own_si, speed)))
            if dimension.divide(Dimension::TIME).agreement(speed) == Agreement::Same =>
        {
            slope.factor * own_si / of_si
        }
        (Some(_) | None, _) => slope.factor.signum(),
    };
    if (times - 1.0).abs() < NEARLY {
        Times::One
    } else if (times + 1.0).abs() < NEARLY {
        Times::MinusOne
    } else {
        Times::Other(hyde_units::significant(times, 3))
    }
}

/// The unit with which the name of a channel ends, where it is one of drives.
pub(super) fn by_names(channels: &mut [Channel]) {
    for channel in channels.iter_mut().filter(|channel| channel.unit.is_none()) {
        if let Some(unit) = unit_in_name(&channel.name).filter(is_of_drives) {
            let why = "its name ends with it".to_owned();
            channel.guessed = Some((unit.text().to_owned(), why));
        }
    }
}

/// Whether a unit is one that channels of a drive have; a letter or two may end a name by chance.
fn is_of_drives(unit: &NamedUnit) -> bool {
    let usual = [
        "m", "rad", "m/s", "rad/s", "m/s2", "rad/s2", "A", "V", "N", "N.m", "W", "K", "Hz",
    ];
    let by_chance = unit.text().len() == 1 && !"mAVNW".contains(unit.text()) || unit.text() == "in";
    !by_chance
        && usual
            .iter()
            .any(|usual| of_dimension(usual, unit.unit().dimension))
}

/// The unit of a slope by that of the channel, where the factor is that of a usual unit.
fn guess(channels: &mut [Channel], of: usize, own: usize, slope: &Slope) {
    let known = channels[of].unit.clone();
    let known = known.or_else(|| channels[of].guessed.as_ref().map(|(unit, _)| unit.clone()));
    let none = channels[own].unit.is_none() && channels[own].guessed.is_none();
    let Some(unit) = known.filter(|_| none) else {
        return;
    };
    let candidates = match unit.as_str() {
        "mm" => vec![
            ("mm/s", 1.0),
            ("mm/min", 60.0),
            ("m/s", 1e-3),
            ("m/min", 0.06),
        ],
        "m" => vec![("m/s", 1.0), ("mm/s", 1e3), ("mm/min", 6e4)],
        "um" => vec![("um/s", 1.0), ("mm/s", 1e-3), ("mm/min", 0.06)],
        "rad" => vec![("rad/s", 1.0), ("rpm", 30.0 / std::f64::consts::PI)],
        "deg" => vec![("deg/s", 1.0), ("rpm", 1.0 / 6.0)],
        _ => return,
    };
    let near = |(_, factor): &&(&str, f64)| (slope.factor.abs() / factor - 1.0).abs() < 0.03;
    if let Some((text, _)) = candidates.iter().find(near) {
        let sign = if slope.factor < 0.0 {
            ", with the other sign"
        } else {
            ""
        };
        let why = format!("it is the slope of `{}` in {unit}{sign}", slope.of);
        channels[own].guessed = Some(((*text).to_owned(), why));
    }
}

/// Of two channels that are alike the first one is the reference, if a name says nothing else.
pub(super) fn by_delays(channels: &mut [Channel], delays: &[Delay]) {
    for delay in delays {
        let named = channels
            .iter()
            .any(|c| c.shown.reference && (c.name == delay.leads || c.name == delay.follows));
        // Channels that go equally far have one unit.
        let of = |name: &str| channels.iter().position(|channel| channel.name == name);
        if let (Some(a), Some(b)) = (of(&delay.leads), of(&delay.follows))
            && (delay.ratio - 1.0).abs() < 0.05
        {
            for (own, other) in [(a, b), (b, a)] {
                if let (None, Some(unit)) = (&channels[own].unit, channels[other].unit.clone()) {
                    let why = format!("it goes as `{}` in {unit} does", channels[other].name);
                    channels[own].guessed = Some((unit, why));
                }
            }
        }
        let leads = channels
            .iter_mut()
            .find(|channel| channel.name == delay.leads);
        let later = delay.by_s > LATER * delay.step_s;
        let measured = |channel: &&mut Channel| {
            let mut words = words(&channel.name).into_iter();
            words.any(|own| MEASURED.iter().any(|word| own.starts_with(word)))
        };
        if let Some(channel) = leads.filter(|channel| !named && later && !measured(channel)) {
            channel.shown.reference = true;
            let text = format!(
                "`{}` follows it {} s later",
                delay.follows,
                hyde_units::significant(delay.by_s, 3)
            );
            channel.shown.why.push(text);
        }
    }
}

fn of_dimension(text: &str, dimension: Dimension) -> bool {
    NamedUnit::parse(text)
        .is_ok_and(|unit| unit.unit().dimension.agreement(dimension) == Agreement::Same)
}

/// The small words of a name.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    for c in name.chars() {
        let new = !c.is_alphabetic() || (before.is_lowercase() && c.is_uppercase());
        if new && words.last().is_some_and(|word| !word.is_empty()) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c.is_alphabetic()) {
            word.extend(c.to_lowercase());
        }
        before = c;
    }
    words.retain(|word| !word.is_empty());
    words
}
