//! Signals over time, one panel above the other along one time axis.

use crate::{Axis, EventStrip, Figure, Line, Panel};

/// A panel of signals in one SI unit over time in s, both shown with a suitable prefix.
///
/// `label` names the quantity: `position`. Lines with a name each are listed in the legend.
#[must_use]
pub fn time_panel(label: impl Into<String>, si_unit: &str, lines: Vec<Line>) -> Panel {
    let values = lines.iter().flat_map(|line| line.y.iter().copied());
    let y = Axis::scaled_for(label, si_unit, values);
    Panel::new(time_axis(std::slice::from_ref(&lines)), y, lines)
}

/// `panels` along one time axis that spans all of them, with the modes and events below.
#[must_use]
pub fn time_plot(
    title: impl Into<String>,
    mut panels: Vec<Panel>,
    events: Option<EventStrip>,
) -> Figure {
    let lines: Vec<&Vec<Line>> = panels.iter().map(|panel| &panel.lines).collect();
    let x = time_axis(&lines);
    for panel in &mut panels {
        panel.x = x.clone();
    }
    Figure {
        shared_x: true,
        events,
        ..Figure::new(panels).with_title(title)
    }
}

fn time_axis<L: AsRef<[Line]>>(groups: &[L]) -> Axis {
    let times = groups
        .iter()
        .flat_map(|lines| lines.as_ref())
        .flat_map(|line| line.x.iter().copied());
    Axis::scaled_for("time", "s", times)
}
