//! Rasterises a laid-out figure with tiny-skia; texts are filled outlines of the font in the binary.

use crate::Figure;
use crate::draw::{Anchor, Colour, Drawing, Fill, Font, Item, Point, Rect, Stroke, Text, draw};
use tiny_skia::{
    Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, StrokeDash, Transform,
};
use ttf_parser::OutlineBuilder;

/// No picture has more pixels; a larger one is scaled down.
const MOST_PIXELS: f64 = 64e6;

/// CSS pixels to the metre.
const PIXELS_A_METRE: f64 = 96.0 / 0.0254;

/// The figure as a PNG file, on white, `scale` device pixels for a CSS pixel: 2 for a screen, 3 or 4 for print.
#[must_use]
pub fn to_png(figure: &Figure, scale: f64) -> Vec<u8> {
    let drawing = draw(figure);
    let most = (MOST_PIXELS / (drawing.width * drawing.height)).sqrt();
    let scale = if scale.is_finite() {
        scale.clamp(0.1, 10.0).min(most)
    } else {
        2.0
    };
    let pixels = |length: f64| (length * scale).round().max(1.0) as u32;
    let Some(mut pixmap) = Pixmap::new(pixels(drawing.width), pixels(drawing.height)) else {
        return Vec::new();
    };
    pixmap.fill(Color::WHITE);
    let mut canvas = Canvas {
        pixmap,
        scale,
        font: Font::new(),
    };
    canvas.draw(&drawing);
    encoded(canvas.pixmap, scale).unwrap_or_default()
}

/// The picture as a file that knows its size on paper: a text processor places it as wide as the SVG.
fn encoded(pixmap: Pixmap, scale: f64) -> Result<Vec<u8>, png::EncodingError> {
    let (width, height) = (pixmap.width(), pixmap.height());
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width, height);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let a_metre = (scale * PIXELS_A_METRE).round() as u32;
    encoder.set_pixel_dims(Some(png::PixelDimensions {
        xppu: a_metre,
        yppu: a_metre,
        unit: png::Unit::Meter,
    }));
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&pixmap.take_demultiplied())?;
    writer.finish()?;
    Ok(file)
}

struct Canvas {
    pixmap: Pixmap,
    scale: f64,
    font: Font,
}

impl Canvas {
    fn draw(&mut self, drawing: &Drawing) {
        for item in &drawing.items {
            match item {
                Item::Polyline { points, stroke } => self.polyline(points, stroke),
                Item::Rule { from, to, stroke } => self.rule(*from, *to, stroke),
                Item::Polygon { points, fill } => self.polygon(points, fill),
                Item::Area { area, fill } => self.area(area, fill),
                Item::Dots {
                    centres,
                    radius,
                    fill,
                } => self.dots(centres, *radius, fill),
                Item::Text(text) => self.text(text),
            }
        }
    }

    fn polyline(&mut self, points: &[Point], stroke: &Stroke) {
        let Some(path) = through(points).finish() else {
            return;
        };
        let style = tiny_skia::Stroke {
            width: stroke.width as f32,
            line_join: LineJoin::Round,
            line_cap: if stroke.dash.is_empty() {
                LineCap::Round
            } else {
                LineCap::Butt
            },
            dash: StrokeDash::new(
                stroke.dash.iter().map(|length| *length as f32).collect(),
                0.0,
            ),
            ..tiny_skia::Stroke::default()
        };
        self.pixmap
            .stroke_path(&path, &paint(stroke.colour, 1.0), &style, self.zoom(), None);
    }

    /// A level or upright line on whole pixels: sharp, and of one grey from line to line.
    fn rule(&mut self, from: Point, to: Point, stroke: &Stroke) {
        let scale = self.scale;
        let thickness = (stroke.width * scale).round().max(1.0);
        let across = |at: f64| (at * scale - 0.5 * thickness).round();
        let along = |at: f64| (at * scale).round();
        let upright = (to.y - from.y).abs() > (to.x - from.x).abs();
        let (start, end) = if upright {
            (from.y.min(to.y), from.y.max(to.y))
        } else {
            (from.x.min(to.x), from.x.max(to.x))
        };
        for (start, end) in dashes(along(start), along(end), stroke.dash, scale) {
            let bar = if upright {
                Rect::at(across(from.x), start, thickness, end - start)
            } else {
                Rect::at(start, across(from.y), end - start, thickness)
            };
            self.fill(&bar, &paint_sharp(stroke.colour), Transform::identity());
        }
    }

    fn polygon(&mut self, points: &[Point], fill: &Fill) {
        let mut path = through(points);
        path.close();
        if let Some(path) = path.finish() {
            let paint = paint(fill.colour, fill.opacity);
            let (rule, zoom) = (FillRule::Winding, self.zoom());
            self.pixmap.fill_path(&path, &paint, rule, zoom, None);
        }
    }

    fn area(&mut self, area: &Rect, fill: &Fill) {
        self.fill(area, &paint(fill.colour, fill.opacity), self.zoom());
    }

    fn fill(&mut self, area: &Rect, paint: &Paint<'_>, transform: Transform) {
        let (left, top, right, bottom) = (
            area.left as f32,
            area.top as f32,
            area.right as f32,
            area.bottom as f32,
        );
        if let Some(rect) = tiny_skia::Rect::from_ltrb(left, top, right, bottom) {
            self.pixmap.fill_rect(rect, paint, transform, None);
        }
    }

    fn dots(&mut self, centres: &[Point], radius: f64, fill: &Fill) {
        let paint = paint(fill.colour, fill.opacity);
        for centre in centres {
            if let Some(path) =
                PathBuilder::from_circle(centre.x as f32, centre.y as f32, radius as f32)
            {
                self.pixmap
                    .fill_path(&path, &paint, FillRule::Winding, self.zoom(), None);
            }
        }
    }

    fn text(&mut self, text: &Text) {
        let width = self.font.width(&text.text, text.size);
        let start = match text.anchor {
            Anchor::Start => 0.0,
            Anchor::Middle => -0.5 * width,
            Anchor::End => -width,
        };
        let mut outlines = PathBuilder::new();
        for (glyph, x) in self.font.glyphs(&text.text, text.size) {
            let mut pen = Pen {
                path: &mut outlines,
                x: start + x,
                scale: self.font.scale(text.size),
            };
            self.font.outline(glyph, &mut pen);
        }
        let Some(path) = outlines.finish() else {
            return;
        };
        let turn = if text.upright { -90.0 } else { 0.0 };
        let place = self
            .zoom()
            .pre_translate(text.at.x as f32, text.at.y as f32)
            .pre_rotate(turn);
        self.pixmap.fill_path(
            &path,
            &paint(text.colour, 1.0),
            FillRule::Winding,
            place,
            None,
        );
    }

    fn zoom(&self) -> Transform {
        Transform::from_scale(self.scale as f32, self.scale as f32)
    }
}

/// Draws outlines in font units, y upwards, into a path in px, y downwards.
struct Pen<'a> {
    path: &'a mut PathBuilder,
    /// Where the glyph begins, in px.
    x: f64,
    /// Px per font unit.
    scale: f64,
}

impl Pen<'_> {
    fn at(&self, x: f32, y: f32) -> (f32, f32) {
        (
            (self.x + f64::from(x) * self.scale) as f32,
            (-f64::from(y) * self.scale) as f32,
        )
    }
}

impl OutlineBuilder for Pen<'_> {
    fn move_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.move_to(x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        let (x, y) = self.at(x, y);
        self.path.line_to(x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        let ((x1, y1), (x, y)) = (self.at(x1, y1), self.at(x, y));
        self.path.quad_to(x1, y1, x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        let ((x1, y1), (x2, y2), (x, y)) = (self.at(x1, y1), self.at(x2, y2), self.at(x, y));
        self.path.cubic_to(x1, y1, x2, y2, x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}

/// The drawn parts of a dashed line from `start` to `end`, in device pixels.
fn dashes(start: f64, end: f64, pattern: &[f64], scale: f64) -> Vec<(f64, f64)> {
    let period = pattern.iter().sum::<f64>() * scale;
    let Some(drawn) = pattern
        .first()
        .map(|length| length * scale)
        .filter(|_| period >= 1.0)
    else {
        return vec![(start, end)];
    };
    let count = ((end - start) / period).ceil() as usize;
    let begins = (0..count).map(|k| start + (k as f64 * period).round());
    begins
        .map(|begin| (begin, (begin + drawn.round()).min(end)))
        .collect()
}

/// A path from point to point.
fn through(points: &[Point]) -> PathBuilder {
    let mut path = PathBuilder::new();
    for (place, point) in points.iter().enumerate() {
        let (x, y) = (point.x as f32, point.y as f32);
        if place == 0 {
            path.move_to(x, y)
        } else {
            path.line_to(x, y)
        }
    }
    path
}

fn paint(colour: Colour, opacity: f64) -> Paint<'static> {
    let mut paint = Paint::default();
    let alpha = (opacity.clamp(0.0, 1.0) * 255.0).round() as u8;
    paint.set_color_rgba8(colour.0, colour.1, colour.2, alpha);
    paint
}

fn paint_sharp(colour: Colour) -> Paint<'static> {
    Paint {
        anti_alias: false,
        ..paint(colour, 1.0)
    }
}

#[cfg(test)]
mod tests;
