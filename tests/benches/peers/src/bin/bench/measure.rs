//! Takes the times of one problem: all programs in turn, round by round, and the least of each.

use crate::command::{Extent, Tools};
use crate::error::{error, wrong_cases};
use crate::outcome::{Outcome, of_hyde, of_peer};
use crate::problem::{Problem, RTOL, TIGHT};
use std::time::SystemTime;

/// Of one program on one problem.
#[derive(Clone, Copy)]
pub struct Taken {
    /// User and system time of the solve in s.
    pub cpu_s: f64,
    pub error: f64,
    /// Cases with a wrong number of events, of many.
    pub wrong: Option<usize>,
    pub bytes: u64,
}

/// One line of the table.
pub struct Row<'a> {
    pub problem: &'a Problem,
    pub c: Taken,
    pub diffsol: Option<Taken>,
    pub hyde: Taken,
}

/// CPU time in s that the rounds of a problem may take; at least two and at most eleven rounds.
const BUDGET_S: f64 = 8.0;

pub fn row<'a>(problem: &'a Problem, tools: &Tools) -> Result<Row<'a>, String> {
    let tight = reference(problem, tools)?;
    let first = at(problem, tools, RTOL, &tight, 1)?;
    let once = first.c.cpu_s + first.hyde.cpu_s + first.diffsol.map_or(0.0, |taken| taken.cpu_s);
    let rounds = (BUDGET_S / once).clamp(2.0, 11.0) as usize;
    at(problem, tools, RTOL, &tight, rounds)
}

/// At a tolerance: the least of so many rounds, in each of which every program runs once.
pub fn at<'a>(
    problem: &'a Problem,
    tools: &Tools,
    rtol: f64,
    tight: &Outcome,
    rounds: usize,
) -> Result<Row<'a>, String> {
    let written = tools.hyde(problem, rtol, Extent::Written)?;
    let taken = |found: &Outcome, bytes| Taken {
        cpu_s: f64::INFINITY,
        error: error(problem, found, tight),
        wrong: wrong_cases(problem, found, tight),
        bytes,
    };
    let mut hyde = taken(&of_hyde(problem, tools)?, written.bytes);
    let (mut c, mut diffsol) = (None, None);
    let (mut whole, mut start) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..rounds {
        let ended = tools.c(problem, rtol)?;
        keep_least(&mut c, &of_peer(&ended.printed)?, ended.bytes, &taken);
        let ended = tools.hyde(problem, rtol, Extent::Whole)?;
        whole = whole.min(ended.cpu_s);
        hyde.bytes = hyde.bytes.min(ended.bytes);
        // A peer that gives up at a tolerance has no time there.
        if problem.diffsol
            && let Ok(ended) = tools.diffsol(problem, rtol)
        {
            keep_least(&mut diffsol, &of_peer(&ended.printed)?, ended.bytes, &taken);
        }
        start = start.min(tools.hyde(problem, rtol, Extent::Start)?.cpu_s);
    }
    hyde.cpu_s = whole - start;
    let c = c.ok_or("no round was run")?;
    Ok(Row {
        problem,
        c,
        diffsol,
        hyde,
    })
}

fn keep_least(
    least: &mut Option<Taken>,
    found: &Outcome,
    bytes: u64,
    taken: &impl Fn(&Outcome, u64) -> Taken,
) {
    let least = least.get_or_insert_with(|| taken(found, bytes));
    least.cpu_s = least.cpu_s.min(found.cpu_s.unwrap_or(f64::INFINITY));
}

/// The run of C and IDA at [`TIGHT`], kept in the folder of results until the program changes. At 100 000 cells it is one
/// at a hundredth of the tolerance compared.
pub fn reference(problem: &Problem, tools: &Tools) -> Result<Outcome, String> {
    let rtol = if problem.long { 1e-2 * RTOL } else { TIGHT };
    let path = tools.out.join(format!("reference-{}.txt", problem.name));
    let time = |path: &std::path::Path| -> Option<SystemTime> {
        std::fs::metadata(path)
            .and_then(|meta| meta.modified())
            .ok()
    };
    let program = time(&tools.reference.join(problem.arguments[0]));
    if time(&path) > program
        && let Ok(printed) = std::fs::read_to_string(&path)
    {
        return of_peer(&printed);
    }
    let printed = tools.tight(problem, rtol)?.printed;
    std::fs::write(&path, &printed).map_err(|error| format!("{}: {error}", path.display()))?;
    of_peer(&printed)
}
