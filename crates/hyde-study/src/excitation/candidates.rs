//! Signals within the limits, to be compared: multisines of several bands, a chirp, moves, and moves before a multisine.

use hyde_signal::excite::{Bounds, Design, Impossible, Shape, Wish, design};
use hyde_units::significant;

/// A signal with its name in tables.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// Its name.
    pub name: String,
    /// The signal.
    pub design: Design,
}

/// A signal that cannot be made.
#[derive(Clone, Debug)]
pub struct Unmade {
    /// Its name.
    pub name: String,
    /// What was asked for: of one after another the one that cannot be.
    pub wish: Wish,
    /// Why it cannot be.
    pub reason: Impossible,
}

/// Bands, from where to where on a scale of ratios: all, the lower part, the upper part.
const BANDS: [(Option<f64>, Option<f64>); 3] = [(None, None), (None, Some(0.6)), (Some(0.4), None)];

/// All signals for a wish, those that cannot be made apart. Kinds are those named, or all.
#[must_use]
pub fn candidates(wish: &Wish, kinds: &[Shape]) -> (Vec<Candidate>, Vec<Unmade>) {
    let wanted = |shape: Shape| kinds.is_empty() || kinds.contains(&shape);
    let (from, to) = wish.band_hz;
    let at = |part: f64| rounded(from * (to / from).powf(part));
    let band =
        |(low, high): (Option<f64>, Option<f64>)| (low.map_or(from, at), high.map_or(to, at));
    let named = |shape: Shape, (low, high): (f64, f64)| {
        format!(
            "{shape} {} .. {} Hz",
            significant(low, 3),
            significant(high, 3)
        )
    };
    let mut wishes: Vec<(String, Vec<Wish>)> = Vec::new();
    for part in BANDS {
        let own = Wish {
            shape: Shape::Multisine,
            band_hz: band(part),
            ..wish.clone()
        };
        if wanted(Shape::Multisine) {
            wishes.push((named(Shape::Multisine, own.band_hz), vec![own]));
        }
    }
    if wanted(Shape::Chirp) {
        let own = Wish {
            shape: Shape::Chirp,
            ..wish.clone()
        };
        wishes.push((named(Shape::Chirp, wish.band_hz), vec![own]));
    }
    let is_motion = matches!(wish.bounds, Bounds::Motion(_));
    let moves: &[Shape] = match is_motion {
        true => &[Shape::Jogs, Shape::Reversals],
        false => &[Shape::Jogs],
    };
    for &shape in moves.iter().filter(|shape| wanted(**shape)) {
        let name = if is_motion {
            shape.to_string()
        } else {
            "pulses".to_owned()
        };
        let own = Wish {
            shape,
            ..wish.clone()
        };
        wishes.push((name.clone(), vec![own.clone()]));
        if wanted(Shape::Multisine) {
            let half = |own: Wish| Wish {
                duration_s: rows(0.5 * wish.duration_s - 3.0 * wish.step_s, wish.step_s),
                ..own
            };
            let sines = half(Wish {
                shape: Shape::Multisine,
                ..wish.clone()
            });
            wishes.push((format!("{name}, then multisine"), vec![half(own), sines]));
        }
    }
    let (mut made, mut unmade) = (Vec::new(), Vec::new());
    for (name, parts) in wishes {
        let each = parts.into_iter().map(|wish| match design(&wish) {
            Ok(design) => Ok(design),
            Err(reason) => Err(Box::new(Unmade {
                name: name.clone(),
                wish,
                reason,
            })),
        });
        match each.collect::<Result<Vec<Design>, Box<Unmade>>>() {
            Ok(parts) => {
                let joined = Design::joined(parts);
                made.extend(joined.map(|design| Candidate { name, design }));
            }
            Err(own) => unmade.push(*own),
        }
    }
    (made, unmade)
}

/// A time of whole samples. Between two signals the axis stands for a few.
fn rows(time_s: f64, step_s: f64) -> f64 {
    (time_s / step_s).floor() * step_s
}

/// Two digits.
fn rounded(value: f64) -> f64 {
    let unit = 10.0_f64.powf(value.log10().floor() - 1.0);
    (value / unit).round() * unit
}
