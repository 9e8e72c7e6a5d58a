//! A frequency response from its table: what `hyde bode --out` leaves, or a measured one in the same columns.

use super::source::Source;
use hyde_report::{BodeCurve, Figure, LineStyle, bode_plot};
use hyde_signal::{Frame, Values};
use hyde_units::shown;
use hyde_units::{Agreement, Dimension};

/// A response in a file: its curves, and what is said about it.
pub(super) struct Responses {
    name: String,
    file: String,
    unit: String,
    curves: Vec<BodeCurve>,
}

/// The responses of a file, if it is a table of them: `f [Hz]`, `re`, `im`, and `coherence` if there is one. Rows that
/// differ in the texts before the frequency are curves of their own.
pub(super) fn of(source: &Source) -> Option<Responses> {
    let frame = source.frame()?;
    let (place, scale) = frequency(&frame)?;
    let numbers = frame.numbers(&frame.fields[place].name)?;
    let (re, im) = (frame.numbers("re")?, frame.numbers("im")?);
    let labels = labels(&frame, place);
    let measured = frame.numbers("coherence");
    let mut curves: Vec<BodeCurve> = Vec::new();
    for row in 0..frame.rows() {
        let known = curves.iter().position(|curve| curve.label == labels[row]);
        let known = known.unwrap_or_else(|| {
            curves.push(BodeCurve {
                label: labels[row].clone(),
                frequency: Vec::new(),
                response: Vec::new(),
                style: LineStyle::Solid,
                coherence: measured.map(|_| Vec::new()),
                deviation: None,
                colour: None,
            });
            curves.len() - 1
        });
        let curve = &mut curves[known];
        curve.frequency.push(numbers[row] * scale);
        curve.response.push((re[row], im[row]));
        if let (Some(all), Some(own)) = (measured, &mut curve.coherence) {
            let coherence = all[row];
            own.push(if coherence.is_nan() { 1.0 } else { coherence });
            // What was measured is points, each as strong as it is certain.
            if coherence < 1.0 {
                curve.style = LineStyle::Points;
            }
        }
    }
    let unit = frame.column("re")?.0.unit.as_ref();
    let unit = unit.map(|unit| shown(&unit.unit().dimension.usual_unit()).to_owned());
    // `hyde bode` calls the file of one response among several after its output.
    let stem = source.path.file_stem()?.to_string_lossy().into_owned();
    let name = stem.strip_prefix("bode-").unwrap_or("response").to_owned();
    Some(Responses {
        name,
        file: source.name.clone(),
        unit: unit.unwrap_or_default(),
        curves,
    })
}

/// All responses in one figure.
pub(super) fn figure(title: Option<&str>, responses: &[Responses]) -> Figure {
    let several = responses.len() > 1;
    let curves: Vec<BodeCurve> = responses
        .iter()
        .flat_map(|response| {
            response.curves.iter().map(move |curve| {
                let label = match (several, curve.label.is_empty()) {
                    (false, _) => curve.label.clone(),
                    (true, true) => response.file.clone(),
                    (true, false) => format!("{}, {}", curve.label, response.file),
                };
                BodeCurve {
                    label,
                    ..curve.clone()
                }
            })
        })
        .collect();
    let first = responses.first();
    let name = first.map_or("response", |response| response.name.as_str());
    let unit = first.map_or("", |response| response.unit.as_str());
    bode_plot(title.unwrap_or_default(), (name, unit), &curves, &[])
}

/// The column of frequencies, and the factor that makes them Hz.
fn frequency(frame: &Frame) -> Option<(usize, f64)> {
    let named = |name: &str| matches!(name, "f" | "frequency");
    let place = frame.fields.iter().position(|field| named(&field.name))?;
    let Some(unit) = &frame.fields[place].unit else {
        return Some((place, 1.0));
    };
    let hertz = Dimension::DIMENSIONLESS.divide(Dimension::TIME);
    let is_frequency = unit.unit().dimension.agreement(hertz) == Agreement::Same;
    is_frequency.then(|| (place, unit.unit().to_si(1.0)))
}

/// What each row is of: its texts before the frequency, those apart that are the same in all rows.
fn labels(frame: &Frame, frequency: usize) -> Vec<String> {
    let columns = frame.values[..frequency]
        .iter()
        .filter_map(|values| match values {
            Values::Texts(texts) => Some(texts),
            Values::Numbers(_) | Values::Integers(_) => None,
        });
    let telling: Vec<_> = columns
        .filter(|texts| texts.windows(2).any(|pair| pair[0] != pair[1]))
        .collect();
    let label = |row: usize| {
        let texts: Vec<&str> = telling.iter().map(|texts| texts[row].as_str()).collect();
        texts.join(", ")
    };
    (0..frame.rows()).map(label).collect()
}
