//! Measured beside simulated: the channels of a record in its free run, before and after, below each the errors.

use hyde_program::Measured;
use hyde_report::{Figure, Line, LineStyle, time_panel, time_plot};
use hyde_study::comparison::RecordErrors;
use hyde_units::{difference_in, drawn_in, error_in, shown};

/// Channels in the figure.
const MOST: usize = 4;
/// Colours of what was measured, of what was before and of what is after.
const MEASURED: usize = 7;
const BEFORE: usize = 1;
const AFTER: usize = 0;

/// The record that judges: the first one held out, if there is one.
pub(crate) fn judge(records: &[RecordErrors]) -> Option<&RecordErrors> {
    let held_out = records.iter().find(|record| record.holdout);
    held_out.or(records.first())
}

/// Its channels; nothing where there is no free run.
pub(crate) fn figure(records: &[RecordErrors], measured: &[Measured]) -> Option<Figure> {
    let record = judge(records)?;
    let (before, after) = (
        record.before.free.as_ref().ok()?,
        record.after.free.as_ref().ok()?,
    );
    let each = measured.iter().zip(before.iter().zip(after)).take(MOST);
    let panels = each.flat_map(|(channel, (before, after))| {
        let (unit, of) = drawn_in(&channel.unit);
        let (old, new) = (&before.channel, &after.channel);
        let values = |si: &[f64]| si.iter().map(|&si| of.from_si(si)).collect();
        let sum = new.error.iter().zip(&new.model);
        let sum: Vec<f64> = sum.map(|(error, model)| error + model).collect();
        let line = |label: &str, si: &[f64]| Line::new(label, new.time_s.clone(), values(si));
        // Without an effect the model is the same before and after.
        let changed = old.model != new.model;
        let mut lines = vec![line("measured", &sum).with_colour(MEASURED)];
        if changed {
            lines.push(line("before", &old.model).with_colour(BEFORE));
        }
        let label = if changed { "after" } else { "simulated" };
        let dashed = line(label, &new.model).with_style(LineStyle::Dashed);
        lines.push(dashed.with_colour(AFTER));
        let most = old.error.iter().chain(&new.error).copied();
        let most = most.fold(0.0, |most: f64, own| most.max(own.abs()));
        let (error_unit, of) = match most > 0.0 {
            true => error_in(&channel.unit, most),
            false => difference_in(&channel.unit),
        };
        let error = |label: &str, si: &[f64], colour| {
            let values = si.iter().map(|&si| of.scale.remove(si)).collect();
            Line::new(label, new.time_s.clone(), values).with_colour(colour)
        };
        let errors = match changed {
            true => vec![
                error("before", &old.error, BEFORE),
                error("after", &new.error, AFTER),
            ],
            false => vec![error("", &new.error, AFTER)],
        };
        [
            time_panel(channel.name.clone(), shown(&unit), lines),
            time_panel("residual", shown(&error_unit), errors),
        ]
    });
    let held_out = if record.holdout { " (held out)" } else { "" };
    let mut caption = "The free run with the model before and after: the reference alone drives the loop, nothing holds the model to the \
                       record. Both are low-passed at 100 Hz. Below each channel the residual, measured − simulated."
        .to_owned();
    let more = measured.len().saturating_sub(MOST);
    if more > 0 {
        caption += &format!(" {more} more channels are in the table.");
    }
    let mut figure = time_plot(
        format!("{}{held_out}", record.after.record),
        panels.collect(),
        None,
    );
    figure.panel_height = 110.0;
    Some(figure.with_caption(caption))
}
