//! The page is whole: everything escaped, every link has its target, nothing comes from elsewhere.

use super::*;
use crate::{
    ChannelError, Event, EventTable, KeyFigure, Line, Parameter, RunReport, time_panel, time_plot,
};

const NASTY: &str = "<script>alert(\"x\")</script> & 'y'";

fn nasty_report() -> RunReport {
    let nasty = || NASTY.to_owned();
    let line = Line::new(NASTY, vec![0.0, 1.0], vec![0.0, 1e-3]);
    let other = Line::new("other", vec![0.0, 1.0], vec![1e-3, 0.0]);
    let figure = time_plot(
        NASTY,
        vec![time_panel(NASTY, NASTY, vec![line, other])],
        None,
    )
    .with_caption(NASTY);
    RunReport {
        title: nasty(),
        facts: vec![(nasty(), nasty()), (nasty(), nasty())],
        verdicts: vec![Verdict {
            outcome: Outcome::Failed,
            text: nasty(),
        }],
        key_figures: vec![KeyFigure {
            name: nasty(),
            value: nasty(),
            unit: nasty(),
            note: nasty(),
        }],
        channels: vec![ChannelError {
            channel: nasty(),
            unit: nasty(),
            ..ChannelError::default()
        }],
        figures: vec![figure.clone(), figure],
        events: EventTable {
            rows: vec![Event {
                time: 0.5,
                what: nasty(),
                before: nasty(),
                after: nasty(),
                source: nasty(),
            }],
            total: 7,
        },
        solver: vec![(nasty(), nasty())],
        parameters: vec![Parameter {
            name: nasty(),
            value: nasty(),
            unit: nasty(),
            source: nasty(),
        }],
        footer: nasty(),
    }
}

#[test]
fn everything_is_escaped() {
    let html = nasty_report().to_html();
    assert!(!html.contains("<script"));
    assert!(html.matches("&lt;script&gt;").count() > 20);
    // Written without void elements left open (but for `meta`), the page is XML and can be checked as such.
    let xml = html
        .replace("<!DOCTYPE html>\n", "")
        .replace("<meta charset=\"utf-8\">", "");
    let viewport = "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">";
    let xml = xml.replace(viewport, "");
    roxmltree::Document::parse(&xml).unwrap();
}

#[test]
fn the_contents_lead_to_sections_and_figures() {
    let html = nasty_report().to_html();
    let targets: Vec<&str> = html
        .match_indices("href=\"#")
        .filter_map(|(at, lead)| html[at + lead.len()..].split('"').next())
        .collect();
    assert_eq!(targets.len(), 9); // seven sections, two figures
    for target in targets {
        assert_eq!(
            html.matches(&format!("id=\"{target}\"")).count(),
            1,
            "{target}"
        );
    }
}

#[test]
fn the_page_needs_nothing_from_elsewhere() {
    let html = nasty_report()
        .to_html()
        .replace("http://www.w3.org/2000/svg", "");
    for word in [
        "http:", "https:", "src=", "url(", "@import", "<link", "<iframe",
    ] {
        assert!(!html.contains(word), "{word}");
    }
}

#[test]
fn what_was_left_out_is_said() {
    assert!(
        nasty_report()
            .to_html()
            .contains("6 later events are not shown.")
    );
}

#[test]
fn an_empty_page_is_a_page() {
    let html = to_html(&Page {
        title: "Nothing".to_owned(),
        ..Page::default()
    });
    assert!(
        html.starts_with("<!DOCTYPE html>")
            && html.contains("<h1>Nothing</h1>")
            && !html.contains("<nav")
    );
}
