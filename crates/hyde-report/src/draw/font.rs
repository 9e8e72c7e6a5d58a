//! The one font of all figures: how wide a text is, where it is broken, and its outlines.
//!
//! DejaVu Sans comes as a dependency and travels in the binary, so that a figure needs no fonts of the system.

use ttf_parser::{Face, GlyphId, OutlineBuilder};

/// DejaVu Sans, regular.
pub(crate) struct Font {
    face: Face<'static>,
}

impl Font {
    pub(crate) fn new() -> Self {
        Self {
            face: Face::parse(dejavu::sans::regular(), 0).expect("the font in the binary is whole"),
        }
    }

    /// Width of `text` in px at an em of `size` px: the sum of the advances, no kerning.
    pub(crate) fn width(&self, text: &str, size: f64) -> f64 {
        text.chars()
            .map(|letter| self.advance(self.glyph(letter)))
            .sum::<f64>()
            * self.scale(size)
    }

    /// Height of a capital letter in px at an em of `size` px.
    pub(crate) fn cap_height(&self, size: f64) -> f64 {
        // That of the H: the font does not state one.
        let outline = self.face.glyph_bounding_box(self.glyph('H'));
        f64::from(outline.map_or(self.face.ascender(), |outline| outline.y_max)) * self.scale(size)
    }

    /// The glyphs of `text` at an em of `size` px, and where each begins in px.
    pub(crate) fn glyphs(&self, text: &str, size: f64) -> Vec<(GlyphId, f64)> {
        let scale = self.scale(size);
        let mut x = 0.0;
        let place = |letter| {
            let glyph = self.glyph(letter);
            let begin = x;
            x += self.advance(glyph) * scale;
            (glyph, begin)
        };
        text.chars().map(place).collect()
    }

    /// Draws the outline of a glyph in font units, y upwards; nothing for a space.
    pub(crate) fn outline(&self, glyph: GlyphId, sink: &mut dyn OutlineBuilder) {
        let _ = self.face.outline_glyph(glyph, sink);
    }

    /// Px per font unit at an em of `size` px.
    pub(crate) fn scale(&self, size: f64) -> f64 {
        size / f64::from(self.face.units_per_em())
    }

    /// `text` in lines of at most `width` px, broken at spaces; what does not fit into `lines` lines ends in `…`.
    pub(crate) fn wrap(&self, text: &str, size: f64, width: f64, lines: usize) -> Vec<String> {
        let mut broken: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            let full = broken.len() == lines;
            match broken.last_mut() {
                Some(line) if full || self.width(&format!("{line} {word}"), size) <= width => {
                    line.push(' ');
                    line.push_str(word);
                }
                Some(_) | None => broken.push(word.to_owned()),
            }
        }
        broken
            .iter()
            .map(|line| self.shortened(line, size, width))
            .collect()
    }

    /// `text`, or as much of it as fits into `width` px with an ellipsis.
    pub(crate) fn shortened(&self, text: &str, size: f64, width: f64) -> String {
        if self.width(text, size) <= width {
            return text.to_owned();
        }
        let mut kept: Vec<char> = text.chars().collect();
        loop {
            let shorter: String = kept.iter().collect::<String>().trim_end().to_owned() + "…";
            if kept.is_empty() || self.width(&shorter, size) <= width {
                return shorter;
            }
            kept.pop();
        }
    }

    /// `text`, or as much of its end as fits into `width` px behind an ellipsis: of a path, the end tells.
    pub(crate) fn shortened_ahead(&self, text: &str, size: f64, width: f64) -> String {
        let ends = text.char_indices().map(|(at, _)| &text[at..]);
        let fits = |shorter: &String| self.width(shorter, size) <= width;
        if fits(&text.to_owned()) {
            return text.to_owned();
        }
        let shorter = ends.skip(1).map(|end| format!("…{end}"));
        shorter.into_iter().find(fits).unwrap_or("…".to_owned())
    }

    fn glyph(&self, letter: char) -> GlyphId {
        // Glyph 0 is the box drawn for letters the font does not have.
        self.face.glyph_index(letter).unwrap_or(GlyphId(0))
    }

    fn advance(&self, glyph: GlyphId) -> f64 {
        f64::from(self.face.glyph_hor_advance(glyph).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn width_is_the_sum_of_the_advances_in_the_font_file() {
        // Advances from the hmtx table of DejaVu Sans 2.37, in 1/2048 em: A 1401, V 1401, µ 1303, minus 1716.
        let font = Font::new();
        let em = 2048.0;
        // Exact: sums of small integers over a power of two.
        assert!((font.width("AV", em) - 2802.0).abs() < 1e-9);
        assert!((font.width("−µ", em) - 3019.0).abs() < 1e-9);
        assert!((font.width("AV", 10.0) - 28020.0 / em).abs() < 1e-9);
        assert!(font.width("", 10.0).abs() < 1e-12);
    }

    #[test]
    fn long_texts_are_broken_at_spaces_and_cut_at_the_end() {
        let font = Font::new();
        let size = 10.0;
        let width = font.width("position of the", size) + 0.1;
        assert_eq!(
            font.wrap("position of the table behind", size, width, 3),
            ["position of the", "table behind"]
        );
        let cut = font.wrap("position of the table behind the nut", size, width, 1);
        assert_eq!(cut.len(), 1);
        assert!(
            cut[0].ends_with('…') && font.width(&cut[0], size) <= width,
            "{cut:?}"
        );
        assert_eq!(font.wrap("", size, width, 2), Vec::<String>::new());
        assert_eq!(font.shortened("word", size, 1.0), "…");
        let width = font.width("…bearing", size);
        assert_eq!(font.shortened_ahead("a.b.bearing", size, width), "…bearing");
        assert_eq!(font.shortened_ahead("bearing", size, width), "bearing");
        assert_eq!(font.shortened_ahead("bearing", size, 1.0), "…");
    }

    #[test]
    fn letters_of_engineering_are_in_the_font() {
        let font = Font::new();
        for letter in "−µ·°²³⁻⁰⁹₁₂ΩωφΔαβ…×≤≥±→".chars() {
            assert!(font.face.glyph_index(letter).is_some(), "{letter}");
        }
    }
}
