//! A measured channel that begins again, as an encoder does each turn, beside a model that goes on.

/// Changes of this part of a channel's range from row to row are jumps; all others are below the other part.
const JUMP: f64 = 0.7;
const STEP: f64 = 0.45;
/// So many jumps at least.
const JUMPS: usize = 2;
/// In between it goes this part of the way back, or more: what only switches to and fro does not.
const BACK: f64 = 0.6;

/// How often a channel begins again, and what it jumps by; `None` of one that does not.
pub(crate) fn begins_again(values: &[f64]) -> Option<(usize, f64)> {
    let known = values.iter().copied().filter(|value| value.is_finite());
    let known: Vec<f64> = known.collect();
    let low = known.iter().copied().fold(f64::INFINITY, f64::min);
    let range = known.iter().copied().fold(f64::NEG_INFINITY, f64::max) - low;
    if !(range > 0.0 && range.is_finite()) {
        return None;
    }
    let (mut jumps, mut jumped, mut back) = (0, 0.0, 0.0);
    for pair in known.windows(2) {
        let change = pair[1] - pair[0];
        if change.abs() > JUMP * range {
            jumps += 1;
            jumped += change;
        } else if change.abs() > STEP * range {
            return None;
        } else {
            back -= change;
        }
    }
    // Jumps all in one direction, and the way back between them in the other.
    let one_way = jumped.abs() > (jumps as f64 - 1.0) * JUMP * range;
    let found = jumps >= JUMPS && one_way && back / jumped > BACK;
    found.then(|| (jumps, jumped.abs() / jumps as f64))
}

#[cfg(test)]
mod tests {
    use super::begins_again;

    #[test]
    fn an_angle_within_its_turn_does() {
        let angle = (0..500).map(|row| (0.13 * f64::from(row)).rem_euclid(std::f64::consts::TAU));
        let (times, by) = begins_again(&angle.collect::<Vec<f64>>()).unwrap();
        assert_eq!(times, 10);
        assert!((by - 6.15).abs() < 0.1, "{by}");
    }

    #[test]
    fn what_goes_on_swings_or_switches_does_not() {
        let of = |law: &dyn Fn(f64) -> f64| {
            let values: Vec<f64> = (0..500).map(|row| law(f64::from(row))).collect();
            begins_again(&values)
        };
        assert_eq!(of(&|t| 0.13 * t), None);
        assert_eq!(of(&|t| (0.1 * t).sin()), None);
        assert_eq!(of(&|t| f64::from((t / 50.0) as i32 % 2)), None);
        // A demand that is held, with one step back at its end.
        assert_eq!(of(&|t| if t < 480.0 { t } else { 0.0 }), None);
        assert_eq!(of(&|_| 3.0), None);
    }
}
