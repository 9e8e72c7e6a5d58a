//! A dead time between what a record drives a model with and what it does, calibrated.

use crate::command::{report, write};
use crate::points::Random;
use std::fmt::Write as _;

/// Time between rows, time constant of the lag, and the delay, in s.
const ROW: f64 = 1e-3;
const LAG: f64 = 2e-3;
const LATE: f64 = 1.37e-3;

/// The demand is held from row to row, or goes on a line to the next.
#[derive(Clone, Copy, PartialEq)]
enum Drive {
    Held,
    Linear,
}

impl Drive {
    fn model(self) -> String {
        let (input, held, replay) = match self {
            Self::Linear => ("input Real u;", "u", ""),
            Self::Held => (
                "input Real u;
  clocked c(1 [ms])
    site Real out = sample(u);
  end c;
  site Real demand = hold(c.out);",
                "demand",
                "replay demand = file.u;",
            ),
        };
        format!(
            "package dead;
import SI.*;
model Late
  {input}
  parameter Time T = 1.2 [ms] ~ ±50%;
  Real x(start = 0, fixed = true);
equation
  der(x) = (delay({held}, T) - x)/(2 [ms]);
end Late;
experiment steps(record file every 1 [ms] = \"record.csv\") of Late
  stimulus u = file.u;
  {replay}
  measured file.x = x ~ 1e-3;
  solve ida(rtol = 1e-8) stop file.end every 1 [ms];
end steps;
calibrate late of Late
  fit steps(\"record.csv\");
  vary uncertain;
end late;
"
        )
    }

    /// The record in closed form: over a stretch on which the delayed demand is on a line from a to b,
    /// `x(h) = b - s*L + (x(0) - a + s*L)*exp(-h/L)` with the slope s.
    fn record(self) -> String {
        let mut random = Random(11);
        let mut u: Vec<f64> = Vec::new();
        for row in 0..1500 {
            // Steps of several rows, for a delay of more than a row is to be told from one of less.
            let last = u.last().copied().unwrap_or(0.0);
            u.push(if row % 7 == 3 { random.next() } else { last });
        }
        let at = |row: isize, part: f64| -> f64 {
            let now = u[usize::try_from(row).unwrap_or(0)];
            let then = u[usize::try_from(row + 1).unwrap_or(0).min(u.len() - 1)];
            if self == Self::Linear {
                now + (then - now) * part
            } else {
                now
            }
        };
        let rows_late = LATE / ROW;
        let whole = rows_late.ceil();
        let part = whole - rows_late;
        let mut x = 0.0;
        let mut text = "t [s],u,x\n".to_owned();
        for (row, demand) in u.iter().enumerate() {
            let noise = 1e-3 * random.normal();
            let _ = writeln!(text, "{:.3},{demand:.9},{:.9}", row as f64 * ROW, x + noise);
            let from = row as isize - whole as isize;
            for (row, begin, end) in [(from, part, 1.0), (from + 1, 0.0, part)] {
                let (a, b) = (at(row, begin), at(row, end));
                let h = (end - begin) * ROW;
                let slope = (b - a) / h;
                x = b - slope * LAG + (x - a + slope * LAG) * (-h / LAG).exp();
            }
        }
        text
    }
}

#[test]
fn a_dead_time_is_calibrated_to_what_noise_leaves() {
    for drive in [Drive::Held, Drive::Linear] {
        let folder = tempfile::tempdir().unwrap();
        write(&folder.path().join("dead.hyde"), &drive.model());
        write(&folder.path().join("record.csv"), &drive.record());
        let fit = report(folder.path(), &["fit", "dead.hyde", "late"]);
        let found = &fit["parameters"][0];
        let value = found["value"].as_f64().unwrap();
        let deviation = found["deviation"].as_f64().unwrap();
        assert!(
            (value - LATE).abs() < 4.0 * deviation,
            "{value} {deviation}"
        );
        assert!(deviation < 1e-5, "{deviation}");
        let chi = fit["records"][0]["chi"]["after"].as_f64().unwrap();
        // The observer allows for a part of the rates that no model gets right: here there is none.
        assert!((0.5..1.05).contains(&chi), "{chi}");
    }
}
