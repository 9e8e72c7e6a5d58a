//! The PNG has the size asked for and shows lines, areas and text where they belong.

use super::*;
use crate::{Line, time_panel, time_plot, to_svg};

struct Decoded {
    width: usize,
    height: usize,
    rgba: Vec<u8>,
}

impl Decoded {
    fn count(&self, wanted: impl Fn(&[u8]) -> bool) -> usize {
        self.rgba.chunks(4).filter(|pixel| wanted(pixel)).count()
    }
}

fn decode(bytes: &[u8]) -> Decoded {
    let mut reader = png::Decoder::new(std::io::Cursor::new(bytes))
        .read_info()
        .unwrap();
    let mut rgba = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut rgba).unwrap();
    assert_eq!(info.color_type, png::ColorType::Rgba);
    Decoded {
        width: info.width as usize,
        height: info.height as usize,
        rgba,
    }
}

fn figure() -> Figure {
    let line = Line::new("", vec![0.0, 1.0], vec![0.0, 1.0]);
    time_plot("Title", vec![time_panel("position", "m", vec![line])], None)
}

fn svg_height(figure: &Figure) -> usize {
    let svg = to_svg(figure);
    let document = roxmltree::Document::parse(&svg).unwrap();
    document
        .root_element()
        .attribute("height")
        .unwrap()
        .parse()
        .unwrap()
}

#[test]
fn the_size_on_paper_is_that_of_the_svg() {
    // 300 pixels to the inch are 11811 to the metre.
    let bytes = to_png(&figure(), 300.0 / 96.0);
    let reader = png::Decoder::new(std::io::Cursor::new(&bytes[..]))
        .read_info()
        .unwrap();
    let dims = reader.info().pixel_dims.unwrap();
    assert_eq!((dims.xppu, dims.yppu), (11811, 11811));
    assert_eq!(dims.unit, png::Unit::Meter);
}

#[test]
fn the_size_is_that_of_the_svg_times_the_scale() {
    let figure = figure();
    for scale in [1_usize, 2, 3] {
        let picture = decode(&to_png(&figure, scale as f64));
        assert_eq!(
            (picture.width, picture.height),
            (640 * scale, svg_height(&figure) * scale)
        );
    }
}

#[test]
fn it_shows_curve_frame_and_text_on_white() {
    let picture = decode(&to_png(&figure(), 2.0));
    assert_eq!(picture.rgba[..4], [255, 255, 255, 255]);
    // The line runs over some 1200 × 280 device pixels and is 2.5 wide.
    let curve = picture.count(|pixel| pixel[..3] == [0, 68, 136]);
    assert!((1000..4000).contains(&curve), "{curve}");
    let frame = picture.count(|pixel| pixel[..3] == [70, 70, 70]);
    assert!(frame > 2 * 2 * (1100 + 280), "{frame}"); // two pixels wide, four sides, ticks
    let text = picture.count(|pixel| pixel[..3] == [26, 26, 26]);
    assert!(text > 500, "{text}");
}

#[test]
fn frames_are_sharp_at_any_scale() {
    // Without curve or text, nothing is blurred: every pixel has one of the colours drawn.
    let blank = Font::new().width(" ", 10.0);
    assert!(blank > 0.0);
    let drawing = Drawing {
        width: 20.0,
        height: 20.0,
        items: vec![Item::Rule {
            from: Point::new(3.3, 2.0),
            to: Point::new(3.3, 18.0),
            stroke: Stroke {
                colour: Colour(1, 2, 3),
                width: 0.8,
                dash: &[],
            },
        }],
    };
    for scale in [1.0, 1.5, 2.0, 3.7] {
        let size = (20.0 * scale) as u32;
        let mut pixmap = Pixmap::new(size, size).unwrap();
        pixmap.fill(Color::WHITE);
        let mut canvas = Canvas {
            pixmap,
            scale,
            font: Font::new(),
        };
        canvas.draw(&drawing);
        let colours: std::collections::BTreeSet<_> = canvas
            .pixmap
            .pixels()
            .iter()
            .map(|pixel| (pixel.red(), pixel.green(), pixel.blue()))
            .collect();
        assert_eq!(
            colours.into_iter().collect::<Vec<_>>(),
            [(1, 2, 3), (255, 255, 255)]
        );
    }
}

#[test]
fn text_covers_its_measured_width() {
    let (words, size) = ("HILH", 40.0);
    let font = Font::new();
    let text = |anchor| Text {
        at: Point::new(100.0, 60.0),
        text: words.to_owned(),
        size,
        anchor,
        upright: false,
        colour: Colour(0, 0, 0),
    };
    for (anchor, start) in [
        (Anchor::Start, 0.0),
        (Anchor::Middle, -0.5),
        (Anchor::End, -1.0),
    ] {
        let mut pixmap = Pixmap::new(220, 80).unwrap();
        pixmap.fill(Color::WHITE);
        let mut canvas = Canvas {
            pixmap,
            scale: 1.0,
            font: Font::new(),
        };
        canvas.text(&text(anchor));
        let dark = |x: u32| (0..80).any(|y| canvas.pixmap.pixel(x, y).unwrap().red() < 128);
        let left = (0..220).find(|x| dark(*x)).unwrap();
        let right = (0..220).rfind(|x| dark(*x)).unwrap();
        let width = font.width(words, size);
        // H has a bearing of 0.1 em at both sides; a pixel more for rounding.
        let (begin, end) = (100.0 + start * width, 100.0 + (start + 1.0) * width);
        assert!(
            (f64::from(left) - begin - 0.1 * size).abs() < 1.5,
            "{left} {begin}"
        );
        assert!(
            (f64::from(right) - end + 0.1 * size).abs() < 1.5,
            "{right} {end}"
        );
        // From the base line up by the height of a capital.
        let rows: Vec<u32> = (0..80)
            .filter(|y| (0..220).any(|x| canvas.pixmap.pixel(x, *y).unwrap().red() < 128))
            .collect();
        assert_eq!(rows.last(), Some(&59));
        assert!(
            (rows.len() as f64 - font.cap_height(size)).abs() < 1.5,
            "{}",
            rows.len()
        );
    }
}

#[test]
fn odd_scales_and_huge_figures_give_a_picture() {
    for scale in [f64::NAN, -1.0, 0.0, f64::INFINITY] {
        decode(&to_png(&figure(), scale));
    }
    let huge = Figure {
        width: 4000.0,
        panel_height: 4000.0,
        ..figure()
    };
    let picture = decode(&to_png(&huge, 10.0));
    assert!(picture.width * picture.height <= 65_000_000);
}
