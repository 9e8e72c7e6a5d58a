//! Set points of a controller: a table that a PLC feeds cycle by cycle, or blocks of G-code.

use super::design::Design;
use super::written::digits;
use hyde_units::significant;
use std::fmt::Write as _;

/// Blocks of G-code follow each other at this distance at least, s: controllers do not read shorter ones.
const BLOCK_S: f64 = 0.01;

/// A table of position, velocity, acceleration and direction for each cycle, as TwinCAT's `MC_ExtSetPointGenFeed` takes
/// them, separated by semicolons. Velocity and acceleration are the backward differences of the written positions.
#[must_use]
pub fn twincat(design: &Design) -> String {
    let unit = design.wish.unit.text();
    let mut out = format!(
        "Time [ms];Position [{unit}];Velocity [{unit}/s];Acceleration [{unit}/s2];Direction\n"
    );
    let (counts, decimals) = design.counts();
    let rate = 1.0 / design.wish.step_s;
    let last = 10.0_f64.powi(-decimals);
    let before = |row: usize, back: usize| counts[row.saturating_sub(back)] as f64;
    for (row, &count) in counts.iter().enumerate() {
        let one = count as f64 - before(row, 1);
        let two = one - (before(row, 1) - before(row, 2));
        // Cut towards zero: no digit exceeds a limit.
        let cut = |value: f64| {
            let digits = (12.0 - value.abs().max(1e-300).log10().ceil()).clamp(0.0, 15.0);
            let unit = 10.0_f64.powi(digits as i32);
            plain((value * unit).trunc() / unit, 12)
        };
        let _ = writeln!(
            out,
            "{};{};{};{};{}",
            plain(design.time(row) * 1e3, 12),
            digits(count, decimals),
            cut(one * last * rate),
            cut(two * last * rate * rate),
            one.partial_cmp(&0.0).map_or(0, |order| order as i32),
        );
    }
    out
}

/// Blocks of G-code for one axis (`X`): the moves of jogs and reversals with their speed, other signals as points at inverse
/// time. Comments say what the controller changes.
#[must_use]
pub fn g_code(design: &Design, axis: char, per_unit: f64) -> String {
    let shape = design.wish.shape;
    let mut out = format!(
        "; {shape}, {} s. The axis stands at {axis}{} before the first block.\n",
        significant(design.wish.duration_s, 6),
        position(design, 0, per_unit)
    );
    out.push_str(
        "; Hyde has checked the positions and speeds of these blocks. Acceleration and jerk\n\
         ; are those of the controller: set its limits to the limits of the design.\n",
    );
    match design.legs.is_empty() {
        false => moves(&mut out, design, axis, per_unit),
        true => points(&mut out, design, axis, per_unit),
    }
    out.push_str("M30\n");
    out
}

fn moves(out: &mut String, design: &Design, axis: char, per_unit: f64) {
    out.push_str(
        "; The controller plans each move anew. Its ramps differ from those of the CSV file:\n\
         ; record the reference, and use the recorded one.\nG90 G94\nG61 ; exact stop\n",
    );
    for leg in &design.legs {
        let to = (design.wish.start + leg.to) * per_unit;
        // Per minute, cut.
        let feed = (leg.speed * per_unit * 60.0 * 1e3).floor() / 1e3;
        let _ = writeln!(
            out,
            "G1 {axis}{} F{}",
            plain(rounded(to), 9),
            plain(feed, 9)
        );
        if leg.dwell_s > 0.0 {
            let _ = writeln!(out, "G4 P{}", plain(rounded(leg.dwell_s), 6));
        }
    }
    out.push_str("; G4 P is in seconds here; some controllers read milliseconds.\n");
}

fn points(out: &mut String, design: &Design, axis: char, per_unit: f64) {
    let every = (BLOCK_S / design.wish.step_s).ceil().max(1.0) as usize;
    let block_s = every as f64 * design.wish.step_s;
    let _ = write!(
        out,
        "; One block every {} ms. The controller joins the points by lines or by its own spline\n\
         ; and smooths them: above {} Hz the axis gets less than the CSV file has. Record\n\
         ; the reference, and use the recorded one.\nG90 G93\nG64 ; no stop between blocks\n",
        significant(block_s * 1e3, 6),
        significant(0.1 / block_s, 3)
    );
    // The controller shall take a little longer rather than be faster than the limit.
    let rate = (60.0 / block_s * 1e3).floor() / 1e3;
    let last = design.rows() - 1;
    for row in (every..last).step_by(every).chain([last]) {
        let _ = writeln!(
            out,
            "G1 {axis}{} F{}",
            position(design, row, per_unit),
            plain(rate, 9)
        );
    }
}

/// The position of a sample, in the unit of the controller.
fn position(design: &Design, row: usize, per_unit: f64) -> String {
    let (counts, decimals) = design.counts();
    let si = design
        .wish
        .unit
        .unit()
        .difference_to_si(counts[row] as f64 / 10.0_f64.powi(decimals));
    plain(rounded(si * per_unit), 9)
}

/// To a tenth of a micrometre, of mm.
fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}

/// A number as controllers read it, with so many digits: in `X7e-4` the `E` would be another address.
fn plain(value: f64, digits: usize) -> String {
    let rounded = significant(value, digits);
    rounded
        .parse::<f64>()
        .map_or(rounded, |value| value.to_string())
}

#[cfg(test)]
mod tests {
    use super::plain;

    #[test]
    fn numbers_of_machine_code_have_no_exponent() {
        for (value, expected) in [
            (7e-4, "0.0007"),
            (-1.25e-9, "-0.00000000125"),
            (12_345_678.5, "12345678.5"),
            (-0.0, "0"),
            (100.0, "100"),
        ] {
            assert_eq!(plain(value, 9), expected);
        }
    }
}
