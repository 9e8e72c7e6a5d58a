//! The SVG is well-formed, holds what the figure holds, stays small, and loses no peak.

use super::*;
use crate::{
    Band, Direction, EventRow, EventStrip, Line, LineStyle, Marker, Reference, Span, time_panel,
    time_plot,
};
use roxmltree::{Document, Node};

/// 100 000 samples with a peak of one sample, a stick phase, a limit, a marker, modes and events.
fn full_figure() -> Figure {
    let time: Vec<f64> = (0..100_000).map(|k| f64::from(k) * 1e-5).collect();
    // Values that look random, without a generator.
    let noise = |t: &f64| ((t * 7.919e8).sin() * 43758.5453).fract() * 1e-3;
    let mut velocity: Vec<f64> = time.iter().map(noise).collect();
    velocity[43_210] = 0.9;
    let position: Vec<f64> = time.iter().map(|t| 0.01 * (6.0 * t).sin()).collect();
    let mut upper = time_panel(
        "position",
        "m",
        vec![
            Line::new("commanded & <measured>", time.clone(), position.clone()),
            Line::new("simulated", time.clone(), position).with_style(LineStyle::Dashed),
        ],
    );
    upper.bands.push(Band {
        from: 0.2,
        to: 0.3,
        label: "stick".to_owned(),
    });
    upper.markers.push(Marker {
        x: 0.25,
        y: 0.0,
        label: "peak".to_owned(),
    });
    let at = |direction, at: f64| Reference {
        direction,
        at,
        label: format!("at {at}"),
    };
    upper.references = vec![
        at(Direction::Vertical, 0.4),
        at(Direction::Horizontal, 0.005),
    ];
    let lower = time_panel(
        "velocity",
        "m/s",
        vec![Line::new("velocity", time, velocity)],
    );
    let span = |from, to, label: &str| Span {
        from,
        to,
        label: label.to_owned(),
    };
    let spans = vec![span(0.0, 0.5, "stick"), span(0.5, 1.0, "slip")];
    let row = EventRow {
        label: "guide".to_owned(),
        spans,
        ticks: vec![0.5],
    };
    time_plot(
        "Title & more",
        vec![upper, lower],
        Some(EventStrip { rows: vec![row] }),
    )
    .with_caption("A caption.")
}

fn texts(document: &Document<'_>) -> Vec<String> {
    let texts = document
        .descendants()
        .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")));
    texts
        .filter_map(|node| node.text().map(str::to_owned))
        .collect()
}

/// Absolute points of the first path in a colour, read back from its relative coordinates.
fn points(document: &Document<'_>, colour: &str) -> Vec<(f64, f64)> {
    let of_colour = |node: &Node<'_, '_>| {
        node.attribute("stroke") == Some(colour) && node.attribute("fill").is_some()
    };
    let longest = document
        .descendants()
        .filter(of_colour)
        .max_by_key(|node| node.attribute("d").unwrap().len());
    let path = longest
        .unwrap()
        .attribute("d")
        .unwrap()
        .replace(['M', 'l'], " ")
        .replace('-', " -");
    let numbers: Vec<f64> = path
        .split_whitespace()
        .map(|number| number.parse().unwrap())
        .collect();
    let mut at = (0.0, 0.0);
    let mut sum = |pair: &[f64]| {
        at = (at.0 + pair[0], at.1 + pair[1]);
        at
    };
    numbers.chunks(2).map(&mut sum).collect()
}

#[test]
fn a_full_figure_is_well_formed_and_small() {
    let svg = to_svg(&full_figure());
    let document = Document::parse(&svg).unwrap();
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("640"));
    assert_eq!(root.attribute("aria-label"), Some("Title & more"));
    assert!(svg.len() < 100_000, "{} bytes", svg.len());
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

#[test]
fn everything_named_is_written() {
    let svg = to_svg(&full_figure());
    let texts = texts(&Document::parse(&svg).unwrap());
    let expected = [
        "Title & more",
        "A caption.",
        "time [s]",
        "position [mm]",
        "velocity [mm/s]",
        "commanded & <measured>",
        "simulated",
        "stick",
        "slip",
        "guide",
        "peak",
        "at 0.4",
        "at 0.005",
        "−10",
        "0.0",
        "1.0",
    ];
    for expected in expected {
        assert!(
            texts.iter().any(|text| text == expected),
            "{expected} in {texts:?}"
        );
    }
    // Labels of the shared time axis are written once.
    assert_eq!(texts.iter().filter(|text| *text == "time [s]").count(), 1);
}

#[test]
fn the_peak_of_one_sample_is_at_its_place() {
    let svg = to_svg(&full_figure());
    let document = Document::parse(&svg).unwrap();
    let line = points(&document, "#004488");
    let highest = line
        .iter()
        .copied()
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .unwrap();
    let (left, right) = (line[0].0, line[line.len() - 1].0);
    let across = (highest.0 - left) / (right - left);
    // Half a pixel in 560 at least: the column the sample is in.
    assert!((across - 0.4321).abs() < 2e-3, "{across}");
    // 0.9 m/s at the top, noise around zero near the bottom: the 5 % of room are all that is above it.
    let lowest = line.iter().map(|point| point.1).fold(0.0, f64::max);
    assert!(
        (lowest - highest.1 - 150.0 / 1.1).abs() < 0.5,
        "{}",
        lowest - highest.1
    );
}

#[test]
fn any_figure_is_well_formed() {
    let line = |x: Vec<f64>, y: Vec<f64>| vec![Line::new("a\u{0}<", x, y)];
    let cases = [
        (vec![], vec![]),
        (vec![f64::NAN], vec![f64::NAN]),
        (vec![1.0], vec![2.0]),
        (vec![0.0, 1.0], vec![f64::INFINITY, f64::NEG_INFINITY]),
        (vec![f64::MIN, f64::MAX], vec![f64::MAX, f64::MIN]),
        (vec![1e-310, 2e-310], vec![0.0, 5e-324]),
        (vec![-1.0, 0.0, 5.0], vec![1.0, -1.0]),
    ];
    for (x, y) in cases {
        for style in [
            LineStyle::Solid,
            LineStyle::Dashed,
            LineStyle::Points,
            LineStyle::Steps,
        ] {
            for scale in [
                crate::Scale::Linear,
                crate::Scale::Log,
                crate::Scale::Decibel,
                crate::Scale::Degrees,
            ] {
                let mut panel = time_panel("q", "m", line(x.clone(), y.clone()));
                panel.lines[0].style = style;
                panel.x.scale = scale;
                panel.y.scale = scale;
                panel.equal_scales = true;
                let svg = to_svg(&Figure::new(vec![panel]));
                Document::parse(&svg).unwrap();
                assert!(
                    !svg.contains("NaN") && !svg.contains("inf"),
                    "{x:?} {y:?} {style:?} {scale:?}"
                );
            }
        }
    }
    for (width, height) in [(f64::NAN, f64::NAN), (0.0, -5.0), (1e9, 1e9)] {
        let panel = time_panel("a very long label indeed", "m", Vec::new());
        let figure = Figure {
            width,
            panel_height: height,
            ..Figure::new(vec![panel])
        };
        Document::parse(&to_svg(&figure)).unwrap();
    }
    Document::parse(&to_svg(&Figure::new(Vec::new()))).unwrap();
}

#[test]
fn numbers_are_short_and_exact_to_a_hundredth() {
    let shorts: Vec<String> = [0, 5, 50, -25, 1200, -1234, 1230]
        .iter()
        .map(|value| short(*value))
        .collect();
    assert_eq!(shorts, ["0", ".05", ".5", "-.25", "12", "-12.34", "12.3"]);
    let line = [
        Point::new(1.0, 2.0),
        Point::new(2.004, 1.0),
        Point::new(3.008, 5.555),
    ];
    assert_eq!(path(line.into_iter(), true), "M1 2l1-1 1.01 4.56");
    assert_eq!(path(line.into_iter().take(2), false), "M1 2h0m1-1h0");
}
