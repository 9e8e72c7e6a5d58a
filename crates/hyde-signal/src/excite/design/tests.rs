//! Ten thousand designs: what is written keeps every limit.

use super::*;
use crate::excite::Limits;

/// Numbers that look random, the same every time (Steele, Lea and Flood, OOPSLA 2014).
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.next())
    }

    fn pick<T: Copy>(&mut self, list: &[T]) -> T {
        list[(self.next() * list.len() as f64) as usize]
    }
}

/// Written digits as whole numbers of the finest decimal among them.
fn whole(cells: &[String]) -> (Vec<i128>, i32) {
    let decimals = cells
        .iter()
        .map(|cell| cell.split_once('.').map_or(0, |(_, part)| part.len()))
        .max()
        .unwrap();
    let each = cells.iter().map(|cell| {
        let (whole, part) = cell.split_once('.').unwrap_or((cell, ""));
        format!("{whole}{part:0<decimals$}").parse().unwrap()
    });
    (each.collect(), i32::try_from(decimals).unwrap())
}

/// The largest difference of an order, in whole units; before and behind the cells the axis stands.
fn largest(counts: &[i128], order: usize) -> i128 {
    let (first, last) = (counts[0], *counts.last().unwrap());
    let mut values = [&[first; 3], counts, &[last; 3]].concat();
    for _ in 0..order {
        values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    values.iter().map(|value| value.abs()).max().unwrap()
}

fn wish(numbers: &mut Numbers) -> Wish {
    let step_s = numbers.pick(&[1e-3, 2e-3, 5e-3, 0.01, 0.05]);
    let rows = numbers.between(60.0, 400.0);
    let speed = numbers.between(1e-3, 3.0);
    let acceleration = numbers.between(0.05, 20.0);
    let to_hz = numbers.between(0.5, 0.2 / step_s);
    let shape = numbers.pick(&[
        Shape::Multisine,
        Shape::Chirp,
        Shape::Jogs,
        Shape::Reversals,
    ]);
    let effort = numbers.next() < 0.15 && shape != Shape::Reversals;
    let unit = match effort {
        true => numbers.pick(&["A", "mA", "N.m", "kN"]),
        false => numbers.pick(&["mm", "m", "um", "rad", "deg", "rev"]),
    };
    let travel = numbers.between(1e-3, 2.0);
    let bounds = match effort {
        true => Bounds::Effort(numbers.between(0.01, 100.0)),
        false => Bounds::Motion(Limits {
            travel,
            speed,
            acceleration,
            jerk: acceleration * numbers.between(5.0, 500.0),
        }),
    };
    Wish {
        shape,
        bounds,
        band_hz: (to_hz * numbers.between(0.01, 0.9), to_hz),
        duration_s: rows * step_s,
        step_s,
        start: numbers.pick(&[0.0, 0.137, -1.5]),
        unit: NamedUnit::parse(unit).unwrap(),
        speeds: numbers.pick(&[1, 2, 5]),
        places: numbers.pick(&[1, 3]),
        reversal: travel * numbers.between(1e-3, 0.1),
    }
}

/// The largest part of a limit that a design uses, by its written digits alone. It keeps every limit, and ends where it began.
fn most_of_limits(design: &Design, name: &str) -> f64 {
    let wish = &design.wish;
    let cells: Vec<String> = (0..design.rows()).map(|row| design.cell(row)).collect();
    let (counts, decimals) = whole(&cells);
    let unit = wish.unit.unit().difference_to_si(1.0) * 10.0_f64.powi(-decimals);
    let start = counts[0];
    let moved: Vec<i128> = counts.iter().map(|count| count - start).collect();
    let (limits, end) = match wish.bounds {
        Bounds::Motion(limits) => (
            vec![
                0.5 * limits.travel,
                limits.speed * wish.step_s,
                limits.acceleration * wish.step_s.powi(2),
                limits.jerk * wish.step_s.powi(3),
            ],
            *moved.last().unwrap(),
        ),
        Bounds::Effort(peak) => (vec![peak], 0),
    };
    assert_eq!(end, 0, "{name} ends where it began");
    let parts = limits.iter().enumerate().map(|(order, limit)| {
        let part = largest(&moved, order) as f64 * unit / limit;
        assert!(
            part <= 1.0,
            "{name}: difference {order} is {part} of its limit"
        );
        part
    });
    parts.fold(0.0, f64::max)
}

#[test]
fn no_limit_is_exceeded_in_ten_thousand_designs() {
    let mut numbers = Numbers(36);
    let (mut made, mut full) = (0, 0);
    let mut number = 0;
    while made < 10_000 {
        number += 1;
        let mut wish = wish(&mut numbers);
        let mut found = design(&wish);
        // A record that is too short for its moves or its band is made as long as the refusal says.
        if let Err(
            Impossible::Short { needed_s, .. }
            | Impossible::Low { needed_s, .. }
            | Impossible::Narrow { needed_s },
        ) = found
        {
            wish.duration_s = needed_s * numbers.between(1.001, 2.0) + wish.step_s;
            if wish.duration_s > 2000.0 * wish.step_s {
                continue;
            }
            found = design(&wish);
            assert!(
                found.is_ok(),
                "design {number}: {found:?} in spite of the advice"
            );
        }
        let Ok(design) = found else {
            continue;
        };
        made += 1;
        let most = most_of_limits(&design, &format!("design {number}, {:?}", wish.shape));
        let told = design.binds().unwrap().part();
        assert!((told - most).abs() < 1e-6, "{told} instead of {most}");
        // One after another, as signals for a model are, they keep the limits too.
        if made % 10 == 0 {
            let twice = Design::joined(vec![design.clone(), design]).unwrap();
            most_of_limits(&twice, &format!("design {number} twice"));
        }
        if most > 0.98 {
            full += 1;
        }
    }
    assert!(number < 20_000, "{made} of {number} can be made");
    assert!(full > made / 2, "{full} of {made} use a limit");
}

fn plain(shape: Shape) -> Wish {
    Wish {
        shape,
        bounds: Bounds::Motion(Limits {
            travel: 0.3,
            speed: 0.2,
            acceleration: 1.0,
            jerk: 50.0,
        }),
        band_hz: (1.0, 100.0),
        duration_s: 20.0,
        step_s: 1e-3,
        start: 0.1,
        unit: NamedUnit::parse("mm").unwrap(),
        speeds: 5,
        places: 3,
        reversal: 1e-3,
    }
}

#[test]
fn a_multisine_has_power_at_its_lines_alone() {
    let design = design(&plain(Shape::Multisine)).unwrap();
    let lines = design.lines.unwrap();
    assert!(lines.crest < 1.8, "{lines:?}");
    assert!((lines.first_hz - 1.0).abs() < 2.0 * lines.apart_hz);
    let values = design.values();
    // A period from its middle, where nothing fades: the second differences repeat.
    let period = (1.0 / (lines.apart_hz * 1e-3)).round() as usize;
    let begin = values.len() / 2 - period / 2 - period / 4;
    for row in (begin..begin + period / 2).step_by(37) {
        let (one, other) = (values[row], values[row + period]);
        assert!((one - other).abs() < 2e-9, "{one} and {other}");
    }
}

#[test]
fn jogs_pass_each_place_both_ways_at_each_speed() {
    let design = design(&plain(Shape::Jogs)).unwrap();
    let speeds: Vec<f64> = design.legs.iter().step_by(3).map(|leg| leg.speed).collect();
    assert_eq!(speeds.len(), 5);
    assert!((speeds[0] / speeds[4] - 30.0).abs() < 0.1, "{speeds:?}");
    for three in design.legs.chunks(3) {
        assert!((three[0].to + three[1].to).abs() < 1e-12);
        assert!((three[0].speed - three[1].speed).abs() < 1e-9);
    }
}

#[test]
fn what_cannot_be_is_refused_with_the_limit_that_binds() {
    let refused = |change: &dyn Fn(&mut Wish)| {
        let mut wish = plain(Shape::Jogs);
        change(&mut wish);
        design(&wish).unwrap_err()
    };
    let short = refused(&|wish| wish.duration_s = 2.0);
    let Impossible::Short { needed_s, .. } = short else {
        panic!("{short:?}");
    };
    // The advice is true.
    let mut wish = plain(Shape::Jogs);
    wish.duration_s = 1.01 * needed_s;
    assert!(design(&wish).is_ok());
    wish.duration_s = 0.98 * needed_s;
    assert!(design(&wish).is_err());
    let low = refused(&|wish| {
        wish.shape = Shape::Multisine;
        wish.band_hz = (0.02, 5.0);
    });
    let Impossible::Low { needed_s, .. } = low else {
        panic!("{low:?}");
    };
    let mut wish = plain(Shape::Multisine);
    wish.band_hz = (0.02, 5.0);
    wish.duration_s = needed_s;
    assert!(design(&wish).is_ok());
    let high = refused(&|wish| {
        wish.shape = Shape::Chirp;
        wish.band_hz = (1.0, 400.0);
    });
    assert_eq!(
        high,
        Impossible::High {
            to_hz: 400.0,
            most_hz: 200.0
        }
    );
    let large = refused(&|wish| {
        wish.shape = Shape::Reversals;
        wish.reversal = 0.1;
    });
    assert_eq!(large, Impossible::Reversal);
    let fine = refused(&|wish| {
        wish.shape = Shape::Multisine;
        wish.step_s = 1e-5;
        wish.bounds = Bounds::Motion(Limits {
            travel: 1e3,
            speed: 1.0,
            acceleration: 1e-3,
            jerk: 1e-3,
        });
    });
    assert_eq!(fine, Impossible::Digits(Quantity::Jerk));
    let none = refused(&|wish| wish.bounds = Bounds::Effort(-1.0));
    assert_eq!(none, Impossible::NotPositive(Quantity::Effort));
}
