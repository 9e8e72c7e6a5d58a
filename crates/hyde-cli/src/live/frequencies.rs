//! The natural frequencies of the model with what the sliders say, about the point that its experiment names.

use hyde_experiment::{About, linearize_about, mode_shape, poles};
use hyde_present::assumed;
use hyde_program::Program;
use hyde_report::{Block, Page, Section, Table};
use hyde_signal::Table as Record;
use hyde_study::modes::asked_point;
use hyde_study::operating_point;
use hyde_units::significant;
use std::collections::BTreeMap;

/// Frequencies, damping ratios and shares of the energy, as a page with one section.
///
/// # Errors
/// Why the model is not linearised.
pub(super) fn page(
    program: &Program,
    records: &BTreeMap<String, Record>,
    parameters: &[f64],
) -> Result<Page, String> {
    let (modes, moment, time) = asked_point(program, parameters);
    let about = About {
        time: operating_point::moment(None, moment, time)?,
        modes: &modes,
        open: false,
    };
    let linear = linearize_about(program, records, parameters, &[], about).map_err(|error| {
        format!(
            "the model is not linearised: {}",
            operating_point::why_not(&error)
        )
    })?;
    let poles = poles(&linear);
    let row = |pole: &hyde_experiment::Pole| {
        let mode = pole.mode();
        let shape = mode_shape(program, parameters, &linear, (&poles, pole));
        let energy = shape.map_or("clocked parts alone".to_owned(), |own| {
            assumed::shares(&own)
        });
        let damping = significant(mode.damping, 3);
        vec![significant(mode.frequency_hz, 5), damping, energy]
    };
    let table = Table {
        rows: poles.oscillating().iter().map(row).collect(),
        ..Table::with_columns(&[">f [Hz]", ">damping", "energy"])
    };
    Ok(Page {
        sections: vec![Section {
            heading: "Natural frequencies".to_owned(),
            blocks: vec![Block::Table(table)],
        }],
        ..Page::default()
    })
}
