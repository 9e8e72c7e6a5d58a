//! Traces and measured responses of a Sinumerik control: XML, numbers as attributes or in a base 85 of its own.
//!
//! A *trace* has `dataSignal` elements that name its signals and `rec` elements with a time and values. A *response* has time
//! series and spectra as arrays of doubles: the excitation and what answered it, in both directions where both were measured.

mod base85;

use crate::assemble::{AssembleError, Cells, Raw, assemble};
use crate::heading::{Heading, Place};
use crate::{Layout, Note, Table, TableError, TimeError, contradicted};
use hyde_units::parse_spelled;
use roxmltree::{Document, Node};
use std::fmt;

/// What is wrong with such a file.
#[derive(Clone, Debug, PartialEq)]
pub enum ReadError {
    /// It is not well-formed.
    Xml(String),
    /// It has neither a trace nor time series.
    Empty,
    /// An array cannot be read: its name and why.
    Array(String, &'static str),
    /// Its time cannot be used.
    Time(TimeError),
    /// Its columns make no table.
    Table(TableError),
}

/// A value beyond it stands for one that is missing.
const MISSING: f64 = 9.218_868_437_227_405e18;

/// Whether a text is such a document.
pub(crate) fn is_of_control(text: &str) -> bool {
    let head = text.trim_start_matches('\u{feff}').trim_start();
    let start: String = head.chars().take(4000).collect();
    head.starts_with("<?xml")
        && [
            "<ResponseTest",
            "satclassid=",
            "<traceData",
            "<dataFrame",
            "<traceCapture",
        ]
        .iter()
        .any(|mark| start.contains(mark))
}

/// Reads a trace or a response.
pub(crate) fn read(text: &str, layout: &Layout) -> Result<Table, ReadError> {
    let document = Document::parse(text).map_err(|error| ReadError::Xml(error.to_string()))?;
    let root = document.root_element();
    let (groups, notes) = match root
        .descendants()
        .find(|node| node.has_tag_name("dataFrame"))
    {
        Some(frame) => trace(frame),
        None => response(root)?,
    };
    let mut tables = Vec::new();
    for group in groups {
        let place = |row: usize| format!("sample {}", row + 1);
        let own = contradicted::noted(&group, layout.every_s, &place);
        tables.push(
            assemble(group, layout, own.into_iter().collect(), &place).map_err(
                |error| match error {
                    AssembleError::Time(error) => ReadError::Time(error),
                    AssembleError::Table(error) => ReadError::Table(error),
                },
            )?,
        );
    }
    Table::of_parts(tables, notes).ok_or(ReadError::Empty)
}

type Groups = (Vec<Vec<Raw>>, Vec<Note>);

/// The signals of a trace; those with missing samples have times of their own.
fn trace(frame: Node<'_, '_>) -> Groups {
    let signals: Vec<(String, Option<String>)> = frame
        .children()
        .filter(|node| node.has_tag_name("dataSignal"))
        .map(|node| {
            let path = node.attribute("name").unwrap_or_default();
            let name = node
                .attribute("description")
                .unwrap_or(path)
                .replace("(64 bit)", "");
            let short = path.rsplit('/').next().filter(|short| !short.is_empty());
            (name.trim().to_owned(), short.map(str::to_owned))
        })
        .collect();
    let mut columns: Vec<(Vec<f64>, Vec<f64>)> = vec![Default::default(); signals.len()];
    let mut missing = 0;
    for record in frame.children().filter(|node| node.has_tag_name("rec")) {
        let Some(time) = record
            .attribute("time")
            .and_then(|time| time.parse::<f64>().ok())
        else {
            continue;
        };
        for attribute in record.attributes() {
            let number = attribute
                .name()
                .strip_prefix('f')
                .and_then(|n| n.parse::<usize>().ok());
            let Some(column) = number.and_then(|n| columns.get_mut(n.wrapping_sub(1))) else {
                continue;
            };
            match attribute.value().parse::<f64>() {
                Ok(value) if value.is_finite() && value < MISSING => {
                    column.0.push(time);
                    column.1.push(value);
                }
                _ => missing += 1,
            }
        }
    }
    let mut groups: Vec<Vec<Raw>> = Vec::new();
    let mut times: Vec<Vec<f64>> = Vec::new();
    for ((name, meaning), (time, values)) in signals.into_iter().zip(columns) {
        if time.is_empty() {
            continue;
        }
        let mut column = raw(&name, None, values);
        column.heading.meaning = meaning.filter(|meaning| *meaning != name);
        match times.iter().position(|known| *known == time) {
            Some(at) => groups[at].push(column),
            None => {
                groups.push(vec![raw("time", Some("s"), time.clone()), column]);
                times.push(time);
            }
        }
    }
    let mut notes = vec![Note::new(
        "a trace of a Sinumerik control; its times are in s",
    )];
    if missing > 0 {
        let values = hyde_units::counted(missing, "value");
        notes.push(Note::new(format!(
            "{values} of its signals stand for nothing and are left out"
        )));
    }
    (groups, notes)
}

/// The time series of a response, and its spectra over the frequency.
fn response(root: Node<'_, '_>) -> Result<Groups, ReadError> {
    let list = named(root, "m_MeasurementSignalNodeList").ok_or(ReadError::Empty)?;
    let nodes: Vec<Node<'_, '_>> = list
        .children()
        .filter(|node| node.has_tag_name("PlatformSignalNode"))
        .collect();
    let mut groups: Vec<Vec<Raw>> = Vec::new();
    let mut times: Vec<Vec<f64>> = Vec::new();
    let last = nodes.len().saturating_sub(1);
    for (number, node) in nodes.iter().enumerate() {
        let role = match number {
            0 => "output".to_owned(),
            _ if number == last => "input".to_owned(),
            _ => format!("signal_{}", number + 1),
        };
        let series = node
            .descendants()
            .filter(|node| node.has_tag_name("TimeSeries"));
        for (direction, series) in series.enumerate() {
            let name = format!("{role}_{}", direction + 1);
            let values = doubles(series, "m_ValueVector", &name)?;
            let bound = |name| named(series, name).and_then(number_in);
            let (Some(start), Some(end)) = (bound("m_TimeVector.start"), bound("m_TimeVector.end"))
            else {
                return Err(ReadError::Array(name, "has no times"));
            };
            let steps = values.len().saturating_sub(1).max(1) as f64;
            let at = |k: usize| start + (end - start) * k as f64 / steps;
            let time: Vec<f64> = (0..values.len()).map(at).collect();
            let column = raw(&name, None, values);
            match times.iter().position(|known| *known == time) {
                Some(at) => groups[at].push(column),
                None => {
                    groups.push(vec![raw("time", Some("s"), time.clone()), column]);
                    times.push(time);
                }
            }
        }
    }
    let spectra = list
        .descendants()
        .filter(|node| node.has_tag_name("SigNodeCrossSpectrumInfo"));
    let response = spectra.filter(|node| node.attribute("name") == Some("m_crossSpecInfoList_el"));
    for (number, spectrum) in response.enumerate() {
        let suffix = if number == 0 {
            String::new()
        } else {
            format!("_{}", number + 1)
        };
        let frequency = doubles(spectrum, "m_FrequencyVector", "frequency")?;
        let values = doubles(spectrum, "m_ValueVector", "response")?;
        if values.len() != 2 * frequency.len() {
            return Err(ReadError::Array(
                "response".to_owned(),
                "has not two numbers a frequency",
            ));
        }
        // The mean at frequency 0 is not part of a response.
        let rows = || (0..frequency.len()).filter(|row| frequency[*row] > 0.0);
        let part = |of: usize| rows().map(|row| values[2 * row + of]).collect();
        groups.push(vec![
            raw("f", Some("Hz"), rows().map(|row| frequency[row]).collect()),
            raw(&format!("re{suffix}"), None, part(0)),
            raw(&format!("im{suffix}"), None, part(1)),
        ]);
    }
    let notes = vec![Note::new(
        "a response measured by a Sinumerik control: `output_1`, `input_1`, … are its time series, one a direction; \
         the first node of the file is taken as the output, the last one as the input",
    )];
    match groups.is_empty() {
        true => Err(ReadError::Empty),
        false => Ok((groups, notes)),
    }
}

fn named<'a, 'i>(node: Node<'a, 'i>, name: &str) -> Option<Node<'a, 'i>> {
    node.descendants()
        .find(|node| node.attribute("name") == Some(name))
}

fn number_in(node: Node<'_, '_>) -> Option<f64> {
    node.text()?.trim().parse().ok()
}

/// The doubles of an array, as many as it says.
fn doubles(node: Node<'_, '_>, array: &str, what: &str) -> Result<Vec<f64>, ReadError> {
    let wrong = |why| ReadError::Array(what.to_owned(), why);
    let array = named(node, array).ok_or(wrong("is missing"))?;
    let raw = named(array, "m_pNumberArray").ok_or(wrong("has no numbers"))?;
    let values = base85::doubles(raw.text().unwrap_or_default())
        .ok_or(wrong("is not base 85 of doubles"))?;
    let declared = named(array, "m_length").and_then(number_in).unwrap_or(0.0);
    let complex = array.attribute("elementtype") == Some("ComplexNumber");
    let expected = if complex { 2.0 * declared } else { declared };
    if (values.len() as f64 - expected).abs() > 0.5 {
        return Err(wrong("has not as many numbers as it says"));
    }
    Ok(values)
}

fn raw(name: &str, unit: Option<&str>, values: Vec<f64>) -> Raw {
    Raw {
        heading: Heading {
            unit: unit.map(parse_spelled),
            place: Place::Usual,
            ..Heading::plain(name)
        },
        cells: Cells::Numbers(values, None),
    }
}

impl ReadError {
    /// What to change.
    #[must_use]
    pub fn repair(&self, record: &str) -> String {
        match self {
            Self::Time(error) => error.repair(record),
            Self::Xml(_) | Self::Empty | Self::Array(..) | Self::Table(_) => {
                "export the trace once more, or as CSV".to_owned()
            }
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Xml(error) => write!(f, "the XML cannot be read: {error}"),
            Self::Empty => write!(f, "the XML document has neither a trace nor time series"),
            Self::Array(name, why) => write!(f, "the array of `{name}` {why}"),
            Self::Time(error) => error.fmt(f),
            Self::Table(error) => error.fmt(f),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_trace_has_its_signals_at_their_times() {
        let text = r#"<?xml version="1.0"?><root><traceData><dataFrame>
            <dataSignal name="/Channel/x/actPos[1]" description="Position (64 bit)"/>
            <dataSignal name="/Channel/x/iq" description="Current"/>
            <rec time="0" f1="1.5" f2="0.25"/><rec time="0.002" f1="2.5"/><rec time="0.004" f1="9223372036854775807" f2="0.5"/>
            </dataFrame></traceData></root>"#;
        assert!(is_of_control(text));
        let table = read(text, &Layout::default()).unwrap();
        assert_eq!(table.column("Position").unwrap().values(), [1.5, 2.5]);
        assert_eq!(table.holding("Position").time(), [0.0, 0.002]);
        assert_eq!(table.holding("Current").time(), [0.0, 0.004]);
        assert_eq!(table.column("iq").unwrap().values(), [0.25, 0.5]);
        let notes: Vec<String> = table.notes().iter().map(ToString::to_string).collect();
        assert!(
            notes
                .iter()
                .any(|note| note.contains("1 value of its signals")),
            "{notes:?}"
        );
    }

    #[test]
    fn what_is_no_trace_is_refused() {
        let message = |text| read(text, &Layout::default()).unwrap_err().to_string();
        assert!(message("<?xml version=\"1.0\"?><a><b></a>").contains("cannot be read"));
        assert!(message("<?xml version=\"1.0\"?><a/>").contains("neither a trace nor time series"));
    }
}
