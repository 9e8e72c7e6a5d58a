//! Colours: few, safe for the colour-blind, and apart in lightness where only a few lines are drawn.
//!
//! Picked from M. Okabe and K. Ito, "Color Universal Design" (2008), and P. Tol, "Colour schemes", SRON/EPS/TN/09-002
//! (2021), some a little darker; the first three also differ when printed in grey.

/// An sRGB colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Colour(pub(crate) u8, pub(crate) u8, pub(crate) u8);

pub(crate) const WHITE: Colour = Colour(255, 255, 255);
/// Text, and the dots of markers.
pub(crate) const INK: Colour = Colour(26, 26, 26);
/// Frames and ticks.
pub(crate) const AXIS: Colour = Colour(70, 70, 70);
/// Reference lines.
pub(crate) const REFERENCE: Colour = Colour(95, 95, 95);
/// Grid lines at labelled ticks.
pub(crate) const GRID: Colour = Colour(222, 222, 222);
/// Grid lines at the others.
pub(crate) const FINE_GRID: Colour = Colour(240, 240, 240);
/// Modes that follow each other too fast to be told apart.
pub(crate) const BLURRED: Colour = Colour(150, 150, 150);

/// The colour of a line.
pub(crate) fn line_colour(index: usize) -> Colour {
    LINES[index % LINES.len()]
}

/// The dashes of a line that is not dashed by itself: lines past the end of the palette take its colours dashed.
pub(crate) fn line_dash(index: usize) -> &'static [f64] {
    const ROUNDS: [&[f64]; 4] = [&[], &[8.0, 3.0], &[2.0, 2.0], &[8.0, 3.0, 2.0, 3.0]];
    ROUNDS[(index / LINES.len()) % ROUNDS.len()]
}

/// The light colour of a band or a mode; dark text reads well on it.
pub(crate) fn tint(index: usize) -> Colour {
    TINTS[index % TINTS.len()]
}

const LINES: [Colour; 8] = [
    Colour(0, 68, 136),    // dark blue
    Colour(213, 94, 0),    // vermilion
    Colour(86, 180, 233),  // sky blue
    Colour(0, 128, 70),    // green
    Colour(136, 34, 85),   // wine
    Colour(235, 185, 40),  // yellow
    Colour(20, 20, 20),    // black
    Colour(140, 140, 140), // grey
];

const TINTS: [Colour; 6] = [
    Colour(198, 216, 236), // blue
    Colour(250, 226, 198), // orange
    Colour(206, 232, 216), // green
    Colour(226, 206, 226), // purple
    Colour(244, 238, 196), // yellow
    Colour(222, 222, 222), // grey
];

#[cfg(test)]
mod tests {
    use super::*;

    /// Luma of Rec. 601, what a grey printer makes of a colour, 0 to 255.
    fn grey(colour: Colour) -> f64 {
        0.299 * f64::from(colour.0) + 0.587 * f64::from(colour.1) + 0.114 * f64::from(colour.2)
    }

    #[test]
    fn the_first_three_lines_differ_in_grey() {
        let greys = [grey(LINES[0]), grey(LINES[1]), grey(LINES[2])];
        // 35 of 255 is told apart at a glance on a laser print.
        assert!(
            greys[1] - greys[0] > 35.0 && greys[2] - greys[1] > 35.0,
            "{greys:?}"
        );
    }

    /// What a dichromat sees of linear RGB (protan, deutan, tritan), from G. M. Machado et al., IEEE Trans. Vis. Comput.
    /// Graph. 15 (2009) 1291–1298, severity 1.0.
    const DICHROMATS: [[[f64; 3]; 3]; 3] = [
        [
            [0.152286, 1.052583, -0.204868],
            [0.114503, 0.786281, 0.099216],
            [-0.003882, -0.048116, 1.051998],
        ],
        [
            [0.367322, 0.860646, -0.227968],
            [0.280085, 0.672501, 0.047413],
            [-0.011820, 0.042940, 0.968881],
        ],
        [
            [1.255528, -0.076749, -0.178779],
            [-0.078411, 0.930809, 0.147602],
            [0.004733, 0.691367, 0.303900],
        ],
    ];

    /// CIE L*a*b* (D65) of what the matrix makes of a colour.
    fn lab(colour: Colour, sight: &[[f64; 3]; 3]) -> [f64; 3] {
        let linear = [colour.0, colour.1, colour.2].map(|byte| {
            let part = f64::from(byte) / 255.0;
            if part <= 0.04045 {
                part / 12.92
            } else {
                ((part + 0.055) / 1.055).powf(2.4)
            }
        });
        let mix =
            |row: &[f64; 3], of: &[f64; 3]| row.iter().zip(of).map(|(a, b)| a * b).sum::<f64>();
        let seen = sight.map(|row| mix(&row, &linear).clamp(0.0, 1.0));
        let xyz = [
            [0.4339, 0.3763, 0.1899],
            [0.2126, 0.7152, 0.0722],
            [0.0177, 0.1095, 0.8730],
        ]
        .map(|row| mix(&row, &seen));
        let [x, y, z] = xyz.map(|t| {
            if t > 0.008856 {
                t.cbrt()
            } else {
                7.787 * t + 16.0 / 116.0
            }
        });
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    #[test]
    fn lines_differ_for_the_colour_blind() {
        for sight in &DICHROMATS {
            for (place, a) in LINES.iter().enumerate() {
                for b in &LINES[..place] {
                    let (a, b) = (lab(*a, sight), lab(*b, sight));
                    let apart = a
                        .iter()
                        .zip(b)
                        .map(|(a, b)| (a - b).powi(2))
                        .sum::<f64>()
                        .sqrt();
                    // The palette of Okabe and Ito has 16 at least by this measure.
                    assert!(apart > 20.0, "{a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn sixteen_lines_are_distinct() {
        for a in 0..16 {
            for b in 0..a {
                assert!(line_colour(a) != line_colour(b) || line_dash(a) != line_dash(b));
            }
        }
    }
}
