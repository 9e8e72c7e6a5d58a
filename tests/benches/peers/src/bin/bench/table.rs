//! Prints the times, their ratios and the errors, on at most 80 columns.

use crate::measure::{Row, Taken};

pub fn print_head() {
    println!(
        "CPU time of the solve in ms                     Hyde over       error\n\
         {:<15}{:>8}{:>9}{:>8}{:>8}{:>9}{:>8}{:>8}{:>7}",
        "", "C+IDA", "diffsol", "Hyde", "C+IDA", "diffsol", "C", "diffsol", "Hyde"
    );
}

pub fn print_row(row: &Row) {
    let diffsol = |shown: fn(&Taken) -> String| row.diffsol.as_ref().map_or("-".to_owned(), shown);
    let over = row
        .diffsol
        .map_or("-".to_owned(), |d| ratio(row.hyde.cpu_s / d.cpu_s));
    println!(
        "{:<15}{:>8}{:>9}{:>8}{:>8}{:>9}{:>8}{:>8}{:>7}",
        row.problem.name,
        time(&row.c),
        diffsol(time),
        time(&row.hyde),
        ratio(row.hyde.cpu_s / row.c.cpu_s),
        over,
        error(&row.c),
        diffsol(error),
        error(&row.hyde),
    );
}

pub fn print_legend() {
    println!(
        "\nLeast of 2 to 11 rounds at rtol 1e-6, atol 1e-8, in each of which every program\n\
         ran once. Hyde: the whole command less the same command with a stop at 1 ns.\n\
         Errors against C + IDA at rtol 1e-11 (P1_100000: 1e-8). P2, P3: of event times\n\
         in s. P5: of end positions in m. All others: of speeds and twist, relative."
    );
}

fn time(taken: &Taken) -> String {
    let ms = 1e3 * taken.cpu_s;
    if ms < 10.0 {
        format!("{ms:.2}")
    } else if ms < 1000.0 {
        format!("{ms:.1}")
    } else {
        format!("{ms:.0}")
    }
}

fn ratio(value: f64) -> String {
    format!("{value:.2}")
}

fn error(taken: &Taken) -> String {
    if taken.error.is_finite() {
        format!("{:.0e}", taken.error)
    } else {
        "events".to_owned()
    }
}
