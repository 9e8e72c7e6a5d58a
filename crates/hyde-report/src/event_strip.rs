//! The strip under a time plot: the mode of each automaton over time, and ticks at events.

/// Rows of modes and events along the time axis of the last panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventStrip {
    /// From top to bottom.
    pub rows: Vec<EventRow>,
}

/// One automaton, or one kind of event.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct EventRow {
    /// Printed at the left.
    pub label: String,
    /// The modes it was in, in the order of time.
    pub spans: Vec<Span>,
    /// Instants at which something happened, in s.
    pub ticks: Vec<f64>,
}

/// A time during which one mode held.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// Where it begins, in s.
    pub from: f64,
    /// Where it ends, in s.
    pub to: f64,
    /// The mode; spans of one label have one colour.
    pub label: String,
}
