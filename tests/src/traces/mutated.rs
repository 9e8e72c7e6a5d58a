//! Traces of a known motion in layouts drawn by a seed, with what may be odd about them.

use super::written::{Encoding, Form, Head, Style, Units};
use crate::numbers::Numbers;
use hyde_signal::{Layout, Table};
use std::f64::consts::TAU;

/// A column as it is written: the numbers in its unit.
#[derive(Clone, Debug)]
pub(super) struct Channel {
    pub(super) name: &'static str,
    /// The unit that the file says.
    pub(super) unit: Option<&'static str>,
    pub(super) written: Vec<f64>,
    /// What they are in SI.
    si: Vec<f64>,
}

/// A motion: the time and three channels.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) clock: Channel,
    pub(super) time: Vec<f64>,
    pub(super) channels: Vec<Channel>,
    /// Whether the file has a column of the time.
    timed: bool,
    /// The time between rows, with the unit of the time.
    step: (f64, &'static str),
}

impl Motion {
    /// The columns in their order.
    pub(super) fn columns(&self) -> impl Iterator<Item = &Channel> {
        self.timed
            .then_some(&self.clock)
            .into_iter()
            .chain(&self.channels)
    }

    pub(super) fn step(&self) -> (f64, &'static str) {
        self.step
    }
}

/// A trace and what it shows.
#[derive(Clone, Debug)]
pub struct Mutated {
    bytes: Vec<u8>,
    motion: Motion,
    style: Style,
    spoiled: Spoiled,
}

/// What a reader made of a trace.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// What it shows.
    Right,
    /// Nothing: the file is refused.
    Refused(String),
    /// Something else, without a word.
    Misread(String),
}

/// What is wrong with a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Spoiled {
    No,
    CutOff,
    CellMissing,
    CellOfText,
    OtherDecimal,
    OtherMinus,
    CellTooMany,
    CellTooFew,
    RunsAgain,
    HeaderAgain,
    UnknownUnit,
    CommaUnquoted,
}

const NAMES: [[&str; 3]; 5] = [
    ["PosActual", "VeloActual", "Current"],
    ["s actual X", "v act. X", "i ist X"],
    ["Lage", "Drehzahl geglättet", "Strom"],
    ["joint.0.motor-pos-fb", "joint.0.vel-cmd", "joint.0.iq"],
    ["Axis[1].Pos", "Axis[1].Vel", "Axis[1].Cur"],
];
const TIMES: [&str; 4] = ["Time", "t", "Zeit", "timestamp"];
/// Units with what one is in SI.
const CLOCKS: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6)];
const LENGTHS: [(&str, f64); 3] = [("mm", 1e-3), ("um", 1e-6), ("m", 1.0)];
const SPEEDS: [(&str, f64); 3] = [("mm/s", 1e-3), ("mm/min", 1e-3 / 60.0), ("m/s", 1.0)];
const CURRENTS: [(&str, f64); 2] = [("A", 1.0), ("mA", 1e-3)];
const STEPS_S: [f64; 6] = [1.25e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3];

impl Mutated {
    /// The trace of a seed.
    #[must_use]
    pub fn of(seed: u64) -> Self {
        let mut draw = Numbers::of(seed);
        let style = style(&mut draw);
        let motion = motion(&mut draw, &style);
        let mut lines = style.lines(&motion);
        let spoiled = spoil(&mut draw, &style, &motion, &mut lines);
        let mut bytes = style.bytes(&lines);
        if spoiled == Spoiled::CutOff {
            let part = draw.between(0.05, 1.0);
            #[allow(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a length"
            )]
            bytes.truncate((part * bytes.len() as f64) as usize);
        }
        Self {
            bytes,
            motion,
            style,
            spoiled,
        }
    }

    /// How it was drawn, and its first bytes.
    #[must_use]
    pub fn describe(&self) -> String {
        let start = String::from_utf8_lossy(&self.bytes[..self.bytes.len().min(300)]).into_owned();
        format!("{:?} {:?}\n{start}", self.style, self.spoiled)
    }

    /// Reads it and compares.
    #[must_use]
    pub fn outcome(&self) -> Outcome {
        let table = match hyde_signal::read(&self.bytes, &Layout::default()) {
            Ok(table) => table,
            Err(error) => return Outcome::Refused(error.to_string()),
        };
        match self.compare(&table) {
            Ok(()) => Outcome::Right,
            Err(reason) => Outcome::Misread(reason),
        }
    }

    fn compare(&self, table: &Table) -> Result<(), String> {
        let told = |words: &str| {
            table
                .notes()
                .iter()
                .any(|note| note.to_string().contains(words))
        };
        let motion = &self.motion;
        let (time, truth) = (table.time(), &motion.time);
        if time.len() > truth.len() {
            return Err(format!("{} rows of {}", time.len(), truth.len()));
        }
        let places = if self.style.form == Form::Thousands {
            1e-3
        } else {
            2e-6
        };
        let rounding = of(motion.step.1).1 * places;
        let shift = if table.origin().is_some() {
            truth[0]
        } else {
            0.0
        };
        let early = motion.timed || shift > 0.0;
        let off = |row: usize| {
            let truth = if early {
                truth[row] - shift
            } else {
                truth[row] - truth[0]
            };
            (time[row] - truth).abs() > rounding + 1e-6 * motion.time[motion.time.len() - 1].abs()
        };
        if let Some(row) = (0..time.len()).find(|row| off(*row))
            && !told("has no unit")
        {
            return Err(format!(
                "time in row {row}: {} for {}",
                time[row], truth[row]
            ));
        }
        for channel in &motion.channels {
            let Some(column) = table.column(channel.name) else {
                continue;
            };
            let truth = match (column.unit(), channel.unit) {
                (Some(_), Some(_)) => &channel.si,
                (Some(unit), None) => return Err(format!("`{}` is in {unit}", channel.name)),
                (None, Some(unit)) if self.says_units() => {
                    return Err(format!("`{}` lost its unit {unit}", channel.name));
                }
                (None, _) => &channel.written,
            };
            let most = truth
                .iter()
                .fold(0.0_f64, |most, value| most.max(value.abs()));
            let factor = channel.si[1].abs() / channel.written[1].abs().max(1e-300);
            let digits = if column.unit().is_some() {
                1e-3 * factor
            } else {
                1e-3
            };
            let near = |(value, truth): (&f64, &f64)| {
                (value - truth).abs()
                    <= 1e-6 * most
                        + match self.style.form {
                            Form::Thousands => digits,
                            Form::Fixed => 1e-3 * digits,
                            Form::Shortest | Form::Exponent => 0.0,
                        }
            };
            let mut rows = column.values().iter().zip(truth).enumerate();
            if let Some((row, (value, truth))) = rows.find(|(_, pair)| !near(*pair)) {
                return Err(format!(
                    "`{}` in row {row}: {value} for {truth}",
                    channel.name
                ));
            }
        }
        Ok(())
    }

    /// Whether the file says the units of its channels in a way that is documented.
    fn says_units(&self) -> bool {
        match self.style.head {
            Head::Plain | Head::Preamble => self.style.units != Units::Nowhere,
            Head::Comment => matches!(self.style.units, Units::Brackets | Units::Parentheses),
            Head::Groups => true,
            Head::Pairs | Head::Nothing => false,
        }
    }
}

fn of(unit: &str) -> (&'static str, f64) {
    let known = CLOCKS.iter().find(|(known, _)| *known == unit);
    known.copied().unwrap_or(("s", 1.0))
}

fn style(draw: &mut Numbers) -> Style {
    let mut one = |count: u64| draw.one_of(count);
    let heads = [
        Head::Plain,
        Head::Plain,
        Head::Comment,
        Head::Preamble,
        Head::Groups,
        Head::Pairs,
        Head::Nothing,
    ];
    let units = [
        Units::Brackets,
        Units::Brackets,
        Units::Parentheses,
        Units::Row,
        Units::Meanings,
        Units::Nowhere,
    ];
    let forms = [
        Form::Fixed,
        Form::Fixed,
        Form::Shortest,
        Form::Exponent,
        Form::Thousands,
    ];
    let encodings = [
        Encoding::Utf8,
        Encoding::Utf8,
        Encoding::Marked,
        Encoding::Utf16Le,
        Encoding::Utf16Be,
        Encoding::Unmarked16,
        Encoding::Latin1,
    ];
    let separators = [',', ';', '\t', '|', ' '];
    let pick = |all: usize, at: u64| usize::try_from(at).unwrap_or(0) % all;
    let head = heads[pick(heads.len(), one(7))];
    let separator = if head == Head::Pairs {
        ' '
    } else {
        separators[pick(5, one(5))]
    };
    Style {
        head,
        units: units[pick(units.len(), one(6))],
        form: forms[pick(forms.len(), one(5))],
        encoding: encodings[pick(encodings.len(), one(7))],
        separator,
        comma: one(2) == 0,
        crlf: one(3) == 0,
        trailing: separator != ' ' && one(5) == 0,
    }
}

fn motion(draw: &mut Numbers, style: &Style) -> Motion {
    let mut pick = |all: usize| {
        let at = draw.one_of(all as u64);
        usize::try_from(at).unwrap_or(0)
    };
    // Names without blanks for rows of pairs.
    let names = if style.head == Head::Pairs {
        NAMES[3 + pick(2)]
    } else {
        NAMES[pick(NAMES.len())]
    };
    let step_s = STEPS_S[pick(STEPS_S.len())];
    let clock = CLOCKS[pick(CLOCKS.len())];
    let units = [LENGTHS[pick(3)], SPEEDS[pick(3)], CURRENTS[pick(2)]];
    let time_name = TIMES[pick(TIMES.len())];
    let rows = 12 + pick(60);
    let (start_s, amplitude, frequency) = (
        if pick(3) == 0 {
            draw.between(0.0, 50.0)
        } else {
            0.0
        },
        draw.between(0.001, 1.5),
        draw.between(0.5, 4.0),
    );
    let time: Vec<f64> = (0..rows).map(|k| start_s + step_s * k as f64).collect();
    let wave = |factor: f64, phase: f64, scale: f64| -> Vec<f64> {
        let of = |t: &f64| scale * (TAU * frequency * t + phase).sin() / factor;
        time.iter().map(of).collect()
    };
    let channel = |at: usize, phase: f64, scale: f64| {
        let (unit, factor) = units[at];
        let written = wave(factor, phase, scale);
        Channel {
            name: names[at],
            unit: (style.units != Units::Nowhere || style.head == Head::Groups).then_some(unit),
            si: written.iter().map(|value| value * factor).collect(),
            written,
        }
    };
    let channels = vec![
        channel(0, 0.0, amplitude),
        channel(1, 1.5, TAU * frequency * amplitude),
        channel(2, 0.7, 3.0),
    ];
    let timed = style.head != Head::Pairs;
    let (unit, factor) = clock;
    let told = match style.head {
        Head::Pairs => true,
        Head::Nothing => false,
        Head::Comment => matches!(style.units, Units::Brackets | Units::Parentheses),
        Head::Groups => true,
        Head::Plain | Head::Preamble => style.units != Units::Nowhere,
    };
    Motion {
        clock: Channel {
            name: time_name,
            unit: Some(unit).filter(|_| told),
            written: time.iter().map(|t| t / factor).collect(),
            si: time.clone(),
        },
        step: (step_s / factor, unit),
        time,
        channels,
        timed,
    }
}

fn spoil(draw: &mut Numbers, style: &Style, motion: &Motion, lines: &mut Vec<String>) -> Spoiled {
    let kinds = [
        Spoiled::No,
        Spoiled::No,
        Spoiled::No,
        Spoiled::CutOff,
        Spoiled::CutOff,
        Spoiled::CellMissing,
        Spoiled::CellOfText,
        Spoiled::OtherDecimal,
        Spoiled::OtherMinus,
        Spoiled::CellTooMany,
        Spoiled::CellTooFew,
        Spoiled::RunsAgain,
        Spoiled::HeaderAgain,
        Spoiled::UnknownUnit,
        Spoiled::CommaUnquoted,
    ];
    let mut kind = kinds[usize::try_from(draw.one_of(kinds.len() as u64)).unwrap_or(0)];
    if kind == Spoiled::RunsAgain && !motion.timed {
        // Without a time nothing tells that a run begins again.
        kind = Spoiled::No;
    }
    let rows = motion.time.len();
    let first = lines.len() - rows;
    let at = first + usize::try_from(draw.one_of(rows as u64)).unwrap_or(0);
    let separator = style.separator.to_string();
    let cells: Vec<String> = lines[at]
        .split(style.separator)
        .map(str::to_owned)
        .collect();
    let cell = usize::try_from(draw.one_of(cells.len() as u64)).unwrap_or(0);
    let with = |text: &str| {
        let mut cells = cells.clone();
        text.clone_into(&mut cells[cell]);
        cells.join(&separator)
    };
    match kind {
        Spoiled::CellMissing => lines[at] = with(""),
        Spoiled::CellOfText => lines[at] = with("Fehler"),
        Spoiled::OtherDecimal => {
            let other = match style.comma {
                true => cells[cell].replace(',', "."),
                false => cells[cell].replace('.', ","),
            };
            lines[at] = with(&other);
        }
        Spoiled::OtherMinus => lines[at] = lines[at].replace('-', "−"),
        Spoiled::CellTooMany => lines[at] = with(&format!("{}{separator}7", cells[cell])),
        Spoiled::CellTooFew => {
            let mut cells = cells.clone();
            cells.remove(cell);
            lines[at] = cells.join(&separator);
        }
        Spoiled::RunsAgain => lines.extend_from_within(first..),
        Spoiled::HeaderAgain if first > 0 => {
            let header = lines[first - 1].clone();
            lines.insert(at, header);
        }
        Spoiled::UnknownUnit => {
            if let Some(head) = lines[..first].last_mut() {
                *head = head.replace("mm", "Ink").replace("um", "Ink");
            }
        }
        Spoiled::CommaUnquoted => lines
            .iter_mut()
            .for_each(|line| *line = line.replace('"', "")),
        Spoiled::No | Spoiled::CutOff | Spoiled::HeaderAgain => {}
    }
    kind
}
