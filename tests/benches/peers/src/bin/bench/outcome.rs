//! What a run has found: the lines that the peers print, and the tables that Hyde writes.

use crate::command::Tools;
use crate::problem::{Compared, Problem};

/// Samples and events of a run.
#[derive(Default)]
pub struct Outcome {
    /// Of the solve, by the program's own clock; none of Hyde.
    pub cpu_s: Option<f64>,
    /// Time (or gap) and three values.
    pub samples: Vec<[f64; 4]>,
    pub events: Vec<f64>,
}

/// From the lines `cpu`, `steps`, `sample` and `event`.
pub fn of_peer(printed: &str) -> Result<Outcome, String> {
    let mut outcome = Outcome::default();
    for line in printed.lines() {
        let mut words = line.split_whitespace();
        let what = words.next().unwrap_or_default();
        let numbers: Vec<f64> = words.filter_map(|word| word.parse().ok()).collect();
        match (what, numbers.as_slice()) {
            ("cpu", &[seconds]) => outcome.cpu_s = Some(seconds),
            ("sample", &[t, a, b, c]) => outcome.samples.push([t, a, b, c]),
            ("event", &[t]) => outcome.events.push(t),
            ("steps", _) => {}
            _ => return Err(format!("a peer printed `{line}`")),
        }
    }
    Ok(outcome)
}

/// From the folder of a run or a sweep.
pub fn of_hyde(problem: &Problem, tools: &Tools) -> Result<Outcome, String> {
    let folder = tools.folder(problem);
    let table = |file: &str, names: &[&str]| {
        let path = folder.join(file);
        let text = std::fs::read_to_string(&path)
            .map_err(|error| format!("{}: {error}", path.display()))?;
        columns(&text, names).ok_or_else(|| format!("{}: other columns", path.display()))
    };
    let mut outcome = Outcome::default();
    match problem.compared {
        Compared::Samples => {
            let rows = table("results.csv", &["t", "w_motor", "w_load", "twist"])?;
            // The first row of an instant: the peers sample before a tick.
            let mut next = 1u32;
            for row in rows {
                let t = 0.01 * f64::from(next);
                if (row[0] - t).abs() < 1e-9 {
                    outcome.samples.push([row[0], row[1], row[2], row[3]]);
                    next += 1;
                }
            }
        }
        Compared::Events => {
            outcome.events = table("events.csv", &["t"])?
                .iter()
                .map(|row| row[0])
                .collect();
        }
        Compared::Cases => {
            for row in table("cases.csv", &["g", "x2_end", "gap_end", "events"])? {
                outcome
                    .samples
                    .push([1e-6 * row[0], row[1], row[2], row[3]]);
            }
        }
    }
    Ok(outcome)
}

/// The columns of these names, whatever their units; only numbers, and no comma within quotes before them.
fn columns(text: &str, names: &[&str]) -> Option<Vec<Vec<f64>>> {
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next()?.split(',').collect();
    let bare = |title: &str| title.split(" [").next().unwrap_or_default().to_owned();
    let places: Option<Vec<usize>> = names
        .iter()
        .map(|name| head.iter().position(|title| bare(title) == **name))
        .collect();
    let places = places?;
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            places
                .iter()
                .map(|&place| cells.get(place)?.parse().ok())
                .collect()
        })
        .collect()
}
