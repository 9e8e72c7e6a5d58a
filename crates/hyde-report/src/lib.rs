//! Figures and the run report: SVG, PNG and one self-contained HTML page.
//!
//! Plain data in, bytes out. A [`Figure`] is filled by hand or by [`time_plot`], [`bode_plot`], [`nyquist_plot`], [`nichols_plot`], [`xy_plot`] and [`circle_plot`]. It is
//! laid out once, into a list of strokes, areas and texts measured with the font that travels in the binary, and that
//! list is written as SVG ([`to_svg`]) or rasterised ([`to_png`]), so both look the same on every machine.
//!
//! A [`RunReport`] becomes a [`Page`] of sections, and a page becomes one HTML text with its figures inside.
//!
//! ```
//! use hyde_report::{Line, RunReport, time_panel, time_plot, to_png, to_svg};
//!
//! let time: Vec<f64> = (0..1000).map(|k| f64::from(k) * 1e-3).collect();
//! let position = time.iter().map(|t| 0.01 * (6.28 * t).sin()).collect();
//! let panel = time_panel("position", "m", vec![Line::new("table", time, position)]);
//! let figure = time_plot("Sine of 10 mm", vec![panel], None);
//! assert!(to_svg(&figure).contains("position [mm]"));
//! assert!(to_png(&figure, 2.0).starts_with(b"\x89PNG"));
//! let report = RunReport { title: "Sine".to_owned(), figures: vec![figure], ..RunReport::default() };
//! assert!(report.to_html().contains("<svg"));
//! ```
//!
//! Lengths on paper are CSS pixels (1/96 in). Values are SI; an [`Axis`] says by which factor they are shown.

mod axis;
mod batch_report;
mod bode_plot;
mod circle_plot;
mod diagnosis_report;
mod diagram;
mod draw;
mod escape;
mod event_strip;
mod figure;
mod html;
mod number;
mod open_loop_plot;
mod page;
mod png;
mod prefix;
mod run_report;
mod svg;
mod time_plot;
mod xy_plot;

pub use axis::{Axis, Scale};
pub use batch_report::{
    BatchReport, CaseColumn, CaseMeasure, ChoiceColumn, Envelope, FailedCase, WorstCase,
    envelope_panel,
};
pub use bode_plot::{BodeCurve, bode_plot};
pub use circle_plot::circle_plot;
pub use diagnosis_report::{
    ChannelChange, DiagnosisReport, ErrorChange, FoundCurve, MovedParameter, RecordChange,
    ResidualMap, Response, TriedEffect,
};
pub use diagram::{Diagram, DiagramPart};
pub use escape::escape;
pub use event_strip::{EventRow, EventStrip, Span};
pub use figure::{Band, Between, Direction, Figure, Line, LineStyle, Marker, Panel, Reference};
pub use html::{STYLE, to_body, to_html};
pub use open_loop_plot::{OpenLoop, nichols_plot, nyquist_plot};
pub use page::{Align, Block, Column, Outcome, Page, Section, Table, Verdict};
pub use png::to_png;
pub use run_report::{ChannelError, Event, EventTable, KeyFigure, Parameter, RunReport};
pub use svg::to_svg;
pub use time_plot::{time_panel, time_plot};
pub use xy_plot::xy_plot;
