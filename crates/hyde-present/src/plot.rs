//! [`figure`]: columns of results or of a record, a frequency response, or a batch, as a figure. The files are read through a
//! [`World`].

mod cases;
mod curves;
mod response;
mod source;
mod strip;

use hyde_report::Figure;
use hyde_study::world::World;
use std::path::PathBuf;
use std::sync::Arc;

/// What is to be plotted.
#[derive(Clone, Debug)]
pub struct Options {
    /// Where files are.
    pub world: Arc<dyn World>,
    /// Results, a record, a response, or a folder of a run or of a batch.
    pub results: PathBuf,
    /// Other results in the same panels, dashed.
    pub with: Vec<PathBuf>,
    /// Columns of each panel, separated by commas; a selection if empty.
    pub panels: Vec<String>,
    /// Pairs of columns, the first of a pair over the second.
    pub xy: bool,
    /// The same scale on both axes.
    pub equal: bool,
    /// Of a batch these cases as lines.
    pub cases: Vec<usize>,
    /// The components whose modes stand below; those that change most if empty.
    pub modes: Vec<String>,
    /// Title of the figure.
    pub title: Option<String>,
    /// Start of the plot in s.
    pub from: Option<f64>,
    /// End of the plot in s.
    pub to: Option<f64>,
    /// Sampling period in s of records without a time column.
    pub every: Option<f64>,
}

/// The figure; `notes` gets what is assumed of its files.
///
/// # Errors
/// A file cannot be read, or has no such column: what to write instead.
pub fn figure(options: &Options, notes: &mut Vec<String>) -> Result<Figure, String> {
    let sources = source::read(options)?;
    let title = options.title.as_deref();
    let responses: Vec<_> = sources.iter().filter_map(response::of).collect();
    let figure = if responses.len() == sources.len() {
        let part = options.from.is_some() || options.to.is_some();
        if options.xy || !options.panels.is_empty() || part {
            return Err(
                "a frequency response is always plotted completely: leave out the columns and times".to_owned(),
            );
        }
        response::figure(title, &responses)
    } else if let [batch] = sources.as_slice()
        && let Some(figure) = cases::envelopes(options, batch)
    {
        figure?
    } else {
        let recorded = source::over_time(options, &sources, notes)?;
        curves::check_window(options, &recorded)?;
        match options.xy {
            true => curves::over_each_other(options, &recorded)?,
            false => curves::over_time(options, &recorded)?,
        }
    };
    Ok(Figure {
        title: title.map(str::to_owned),
        ..figure
    })
}
