//! Prints what was promised beside what was measured: NAME VALUE UNIT promised RELATION BOUND ok|short.

use crate::measure::Row;
use crate::problem::OVER_DIFFSOL;

/// One line.
pub fn print_line(name: &str, value: f64, unit: &str, relation: &str, bound: f64) {
    let holds = match relation {
        ">=" => value >= bound,
        _ => value <= bound,
    };
    let verdict = if holds { "ok" } else { "short" };
    let shown = if value.abs() >= 100.0 {
        format!("{value:.0}")
    } else {
        format!("{}", (value * 1000.0).round() / 1000.0)
    };
    println!("{name} {shown} {unit} promised {relation} {bound} {verdict}");
}

pub fn print(rows: &[Row]) {
    println!();
    for row in rows {
        let name = row.problem.name;
        if let Some(most) = row.problem.promised {
            print_line(
                &format!("{name}_over_c"),
                row.hyde.cpu_s / row.c.cpu_s,
                "-",
                "<=",
                most,
            );
        }
        if let Some(diffsol) = row.diffsol {
            let over = row.hyde.cpu_s / diffsol.cpu_s;
            print_line(
                &format!("{name}_over_diffsol"),
                over,
                "-",
                "<=",
                OVER_DIFFSOL,
            );
        }
        let error = row.hyde.error / row.c.error;
        print_line(&format!("{name}_error_over_c"), error, "-", "<=", 1.0);
        if let Some(wrong) = row.hyde.wrong {
            let diffsol = row.diffsol.and_then(|taken| taken.wrong).unwrap_or(0);
            let c = row.c.wrong.unwrap_or(0);
            print_line(
                &format!("{name}_wrong_event_counts"),
                wrong as f64,
                "-",
                "<=",
                0.0,
            );
            println!("{:>4}of the peers: C + IDA {c}, diffsol {diffsol}", "");
        }
        if row.problem.long {
            let over = row.hyde.bytes as f64 / row.c.bytes as f64;
            print_line(&format!("{name}_memory_over_c"), over, "-", "<=", 1.5);
        }
    }
}
