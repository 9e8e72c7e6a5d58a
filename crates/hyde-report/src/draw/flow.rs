//! Sets things side by side, in as many rows as they need.

/// For each width the row it goes to and its left end, `between` px after the one before; and the number of rows.
pub(crate) fn flow(
    widths: impl Iterator<Item = f64>,
    between: f64,
    room: f64,
) -> (Vec<(f64, f64)>, f64) {
    let (mut row, mut right) = (0.0, 0.0);
    let mut places = Vec::new();
    for width in widths {
        if right > 0.0 && right + width > room {
            row += 1.0;
            right = 0.0;
        }
        places.push((row, right));
        right += width + between;
    }
    let rows = if places.is_empty() { 0.0 } else { row + 1.0 };
    (places, rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_fill_from_the_left_and_what_is_too_wide_has_a_row_of_its_own() {
        let (places, rows) = flow([40.0, 40.0, 200.0, 30.0].into_iter(), 10.0, 100.0);
        assert_eq!(places, [(0.0, 0.0), (0.0, 50.0), (1.0, 0.0), (2.0, 0.0)]);
        assert!((rows - 3.0).abs() < 1e-12); // a count
    }
}
