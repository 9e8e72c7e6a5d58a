//! A long curve with fewer points, for a plot that shows no more of them.

/// The least and the greatest value of each of so many stretches, in their order, with the first and the last point of all;
/// every point of a shorter curve.
pub fn thinned(time: &[f64], values: &[f64], stretches: usize) -> (Vec<f64>, Vec<f64>) {
    let rows = time.len().min(values.len());
    let each = rows.div_ceil(stretches.max(1));
    if each <= 2 {
        return (time.to_vec(), values.to_vec());
    }
    let mut kept: Vec<usize> = Vec::new();
    for first in (0..rows).step_by(each) {
        let stretch = first..(first + each).min(rows);
        let by_value = |a: &usize, b: &usize| values[*a].total_cmp(&values[*b]);
        kept.extend(stretch.clone().min_by(by_value));
        kept.extend(stretch.max_by(by_value));
    }
    kept.extend([0, rows - 1]);
    kept.sort_unstable();
    kept.dedup();
    let of = |list: &[f64]| kept.iter().map(|&row| list[row]).collect();
    (of(time), of(values))
}

#[cfg(test)]
mod tests {
    use super::thinned;

    #[test]
    fn ends_and_extremes_of_a_long_curve_stay() {
        let time: Vec<f64> = (0..1000).map(f64::from).collect();
        let mut values: Vec<f64> = time.iter().map(|t| t % 7.0).collect();
        values[501] = 50.0;
        values[777] = -50.0;
        let (x, y) = thinned(&time, &values, 20);
        assert!(x.len() <= 42, "{}", x.len());
        let points: Vec<[u64; 2]> = x
            .iter()
            .zip(&y)
            .map(|(x, y)| [x.to_bits(), y.to_bits()])
            .collect();
        for (t, extreme) in [(501.0_f64, 50.0_f64), (777.0, -50.0)] {
            assert!(points.contains(&[t.to_bits(), extreme.to_bits()]), "{t}");
        }
        assert_eq!(x.first().zip(x.last()), time.first().zip(time.last()));
        assert_eq!(thinned(&time, &values, 500).0, time);
    }
}
