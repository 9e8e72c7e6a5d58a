//! Batches: what a case costs beyond its solution, what a second core brings, what is lost when processes are killed, whether
//! a cluster gives the same, and what many cases need of memory. The command is this program itself.

use super::process::{cpu_s, memory_kb, this_program};
use super::promise::{Figure, Measured, Promise, Session};
use crate::Example;
use crate::batches::{Batch, number};
use hyde_compiler::Backend;
use hyde_sim::Setup;
use std::collections::BTreeMap;
use std::io::Read as _;
use std::process::{Child, Stdio};
use std::time::Duration;

pub(super) const OVERHEAD: Figure = Figure {
    name: "case_overhead_percent",
    unit: "%",
    promise: Promise::AtMost(5.0),
    measure: overhead,
};

pub(super) const TWO_CORES: Figure = Figure {
    name: "two_core_gain",
    unit: "times",
    promise: Promise::AtLeast(1.9),
    measure: two_cores,
};

pub(super) const KILLS: Figure = Figure {
    name: "kill_losses",
    unit: "cases",
    promise: Promise::Exactly(0.0),
    measure: kills,
};

pub(super) const SLURM: Figure = Figure {
    name: "slurm_equals_local",
    unit: "(1 if so)",
    promise: Promise::Exactly(1.0),
    measure: slurm,
};

pub(super) const MEMORY: Figure = Figure {
    name: "batch_memory_growth",
    unit: "times",
    promise: Promise::AtMost(1.1),
    measure: memory,
};

/// Processes killed.
const KILLED: u64 = 50;

/// CPU time of a batch over that of its bare solutions, the better of a few: P3 to 10 s, whose cases take some 10 ms. The
/// start of the process, the compiler and the data set count as overhead.
fn overhead(_: &Session) -> Result<Measured, String> {
    const CASES: usize = 300;
    let Some(_) = cpu_s(false) else {
        return Ok(Measured::Absent(
            "CPU times: this system has no /proc".to_owned(),
        ));
    };
    let compiled =
        Example::load("tests/models/p3_batch.hyde", Some("sine"))?.compile(Backend::Native)?;
    let program = &compiled.program;
    let mut keep: Vec<usize> = program
        .experiment
        .reductions
        .iter()
        .map(|r| r.output)
        .collect();
    keep.sort_unstable();
    keep.dedup();
    let records = BTreeMap::new();
    let (mut bare, mut whole) = (f64::INFINITY, f64::INFINITY);
    for round in 0..3 {
        let before = cpu_s(false).unwrap_or(0.0);
        for case in 0..CASES {
            let gap = 5e-6 + 45e-6 * case as f64 / (CASES - 1) as f64;
            let set = [("gap".to_owned(), gap)];
            let parameters = hyde_experiment::parameters(program, &records, &set)
                .map_err(|error| format!("{error:?}"))?;
            let mut setup = Setup::new(parameters, &records, 10.0);
            setup.rows_s = Setup::rows_every(0.0, 10.0, 0.01);
            setup.keep = Some(keep.clone());
            hyde_sim::simulate(program, &setup).map_err(|failure| format!("{:?}", failure.kind))?;
        }
        bare = bare.min(cpu_s(false).unwrap_or(0.0) - before);
        let batch = Batch::backlash(&this_program()?, CASES, 10.0)?;
        let before = cpu_s(true).unwrap_or(0.0);
        batch.run(&format!("out{round}"), &["--jobs", "1"])?;
        whole = whole.min(cpu_s(true).unwrap_or(0.0) - before);
    }
    Ok(Measured::Value(100.0 * (whole / bare - 1.0)))
}

/// Time on the clock with one job over that with two, the least of a few each: what else the machine does only adds. It
/// takes an idle machine all the same.
#[allow(clippy::disallowed_methods, reason = "time is what is measured")]
fn two_cores(_: &Session) -> Result<Measured, String> {
    if std::thread::available_parallelism().map_or(1, usize::from) < 2 {
        return Ok(Measured::Absent(
            "a second core: this machine has one".to_owned(),
        ));
    }
    let batch = Batch::backlash(&this_program()?, 400, 10.0)?;
    let (mut one, mut two) = (f64::INFINITY, f64::INFINITY);
    for round in 0..3 {
        let timed = |jobs: &str| {
            let done = batch.run(&format!("out{round}-{jobs}"), &["--jobs", jobs])?;
            done.number("wall_s")
                .ok_or_else(|| "no time is told".to_owned())
        };
        one = one.min(timed("1")?);
        two = two.min(timed("2")?);
    }
    Ok(Measured::Value(one / two))
}

/// 10 000 cases of P3 by processes of which 50 are killed at moments by chance: cases that were told to be done and are not
/// found by the next process, rows that are there twice or not at all, and 1 if the bytes differ from those of one process.
#[allow(
    clippy::disallowed_methods,
    reason = "processes are killed after a time"
)]
fn kills(_: &Session) -> Result<Measured, String> {
    const CASES: usize = 10_000;
    let batch = Batch::backlash(&this_program()?, CASES, 1.0)?;
    batch.run("whole", &[])?;
    let whole = batch.journal_bytes("whole");
    let mut chance = Chance(7);
    let (mut lost, mut told, mut killed) = (0.0, 0.0_f64, 0);
    while killed < KILLED {
        // So much of what is left that the batch is not done before the last of them, however fast the machine is.
        let before = batch.journal_bytes("killed");
        let share = 2.0 * chance.next() / (KILLED - killed + 1) as f64;
        let until = before as f64 + share.min(0.9) * whole.saturating_sub(before) as f64;
        // Every fourth in its first tenth of a second: as it starts, reads the journals, and writes first records.
        let early = killed.is_multiple_of(4);
        let late = Duration::from_secs_f64(if early { 0.1 } else { 0.01 } * chance.next());
        let mut command = batch.sweep("killed", &[]);
        let mut child = command
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        while !early && (batch.journal_bytes("killed") as f64) < until && runs(&mut child)? {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(late);
        if !runs(&mut child)? {
            return Err(format!("the batch ended after {killed} kills"));
        }
        child.kill().map_err(|error| error.to_string())?;
        killed += 1;
        let mut said = String::new();
        if let Some(mut out) = child.stdout.take() {
            out.read_to_string(&mut said)
                .map_err(|error| error.to_string())?;
        }
        child.wait().map_err(|error| error.to_string())?;
        // The first line tells what was found, later ones what is on the disk.
        let first = said.lines().next().unwrap_or_default();
        if let Some(found) = number(first, "done") {
            lost += (told - found).max(0.0);
            told = number(&said, "done").unwrap_or(found).max(found);
        }
    }
    let rest = batch.run("killed", &[])?;
    lost += (told + rest.number("solved").unwrap_or(0.0) - CASES as f64).max(0.0);
    let frame = hyde_signal::parquet::read_frame(&batch.dataset("killed")?)
        .map_err(|error| error.to_string())?;
    let numbers = frame.integers("case").unwrap_or_default();
    let wrong = numbers
        .iter()
        .zip(1..)
        .filter(|(found, expected)| **found != *expected)
        .count();
    lost += (wrong + numbers.len().abs_diff(CASES)) as f64;
    if batch.dataset("killed")? != batch.dataset("whole")? {
        lost += 1.0;
    }
    Ok(Measured::Value(lost))
}

fn runs(child: &mut Child) -> Result<bool, String> {
    let ended = child.try_wait().map_err(|error| error.to_string())?;
    Ok(ended.is_none())
}

/// Knuth's linear congruential generator: the same numbers each time, but where they meet the process is chance.
struct Chance(u64);

impl Chance {
    /// At least 0, below 1.
    fn next(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

fn slurm(_: &Session) -> Result<Measured, String> {
    let batch = Batch::backlash(&this_program()?, 1000, 10.0)?;
    batch.run("whole", &[])?;
    match batch.on_slurm(&batch.dataset("whole")?)? {
        Some(equal) => Ok(Measured::Value(f64::from(u8::from(equal)))),
        None => Ok(Measured::Absent(
            "Slurm: apt-get install slurmctld slurmd slurm-client".to_owned(),
        )),
    }
}

/// The most memory of a process with 10 000 short cases over that with 1 000.
fn memory(_: &Session) -> Result<Measured, String> {
    let most = |cases: usize| {
        let batch = Batch::backlash(&this_program()?, cases, 0.01)?;
        let mut command = batch.sweep("out", &["--jobs", "2"]);
        let mut child = command
            .stdout(Stdio::null())
            .spawn()
            .map_err(|error| error.to_string())?;
        let mut most = 0.0_f64;
        while child
            .try_wait()
            .map_err(|error| error.to_string())?
            .is_none()
        {
            most = most.max(memory_kb(child.id()).unwrap_or(0.0));
            std::thread::sleep(Duration::from_millis(2));
        }
        Ok::<f64, String>(most)
    };
    let (few, many) = (most(1_000)?, most(10_000)?);
    if few == 0.0 {
        return Ok(Measured::Absent(
            "memory of processes: this system has no /proc".to_owned(),
        ));
    }
    Ok(Measured::Value(many / few))
}
