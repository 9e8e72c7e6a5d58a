//! `csv_mb_per_s`, `csv_memory_over_kept` and `csv_time_over_polars`: how a long record is read.
//!
//! A CSV of ten million rows and eight columns, 0.8 GB, is read by a process of its own: the file, its columns, and the checks
//! of its time. The rate is that of CPU time, the kernel's included, so that it is one of one core. What is kept is eight
//! doubles a row; the most memory that the process had, with all of the file's text, is compared with it. Polars reads the same
//! file on one thread, in Python.
//!
//! Each reading is repeated by turns and the quickest counts: a virtual machine that was idle gets its memory back from its host
//! at the first touch, which took as long as the reading itself where it was measured.

use super::process::{cpu_s, memory_kb, this_program};
use super::promise::{Figure, Measured, Promise};
use crate::fmu::succeed;
use crate::root;
use std::fmt::Write as _;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;

/// The rate, in MB of text a second of one core.
pub(super) const RATE: Figure = Figure {
    name: "csv_mb_per_s",
    unit: "MB/s",
    promise: Promise::AtLeast(200.0),
    measure: |_| {
        let mut quickest = 0.0_f64;
        for _ in 0..ROUNDS {
            quickest = quickest.max(read()?.mb_per_s);
        }
        Ok(Measured::Value(quickest))
    },
};

/// The CPU time over that of Polars on one thread.
pub(super) const OVER_POLARS: Figure = Figure {
    name: "csv_time_over_polars",
    unit: "ratio",
    promise: Promise::AtMost(1.5),
    measure: |_| {
        let python = root().join("target/python/bin/python");
        if !python.is_file() {
            let reason = "Polars is not installed in target/python: `./dev test` does it";
            return Ok(Measured::Absent(reason.to_owned()));
        }
        let (mut own, mut others) = (0.0_f64, 0.0_f64);
        for _ in 0..ROUNDS {
            own = own.max(read()?.mb_per_s);
            let mut command = Command::new(&python);
            command.env("POLARS_MAX_THREADS", "1");
            command.args(["-c", READ_BY_POLARS]).arg(written()?);
            let said = succeed(&mut command)?;
            let rate = said.trim().parse::<f64>().map_err(|_| said)?;
            others = others.max(rate);
        }
        Ok(Measured::Value(others / own))
    },
};

/// Reads a file and prints the rate.
const READ_BY_POLARS: &str = "
import os, sys, time
import polars
start = time.process_time()
polars.read_csv(sys.argv[1])
print(os.path.getsize(sys.argv[1]) / 1e6 / (time.process_time() - start))
";

/// Each is measured so often.
const ROUNDS: usize = 3;

/// The most memory over that of the doubles that are kept.
pub(super) const MEMORY: Figure = Figure {
    name: "csv_memory_over_kept",
    unit: "ratio",
    promise: Promise::AtMost(3.0),
    measure: |_| Ok(Measured::Value(read()?.over_kept)),
};

const ROWS: u32 = 10_000_000;
const COLUMNS: usize = 8;

/// What one reading took.
struct Reading {
    mb_per_s: f64,
    over_kept: f64,
}

fn read() -> Result<Reading, String> {
    let file = written()?;
    let mut command = Command::new(this_program()?);
    let said = succeed(command.arg("--read-record").arg(file))?;
    let numbers: Vec<f64> = said.split_whitespace().flat_map(str::parse).collect();
    match numbers[..] {
        [mb_per_s, over_kept] => Ok(Reading {
            mb_per_s,
            over_kept,
        }),
        _ => Err(format!("the reader said `{said}`")),
    }
}

/// Reads a record in this process. Returns the rate and the memory over what is kept, as a line.
///
/// # Errors
/// A file that cannot be read, or another number of values in it.
#[allow(
    clippy::disallowed_methods,
    reason = "the reading of a file is measured"
)]
pub fn read_record(file: &Path) -> Result<String, String> {
    let start = cpu_s(false).ok_or("the system does not tell the CPU time")?;
    let bytes = std::fs::read(file).map_err(|error| error.to_string())?;
    let table = hyde_signal::read(&bytes, &hyde_signal::Layout::default());
    let table = table.map_err(|error| error.to_string())?;
    let taken = cpu_s(false).ok_or("the system does not tell the CPU time")? - start;
    // The time is one of the columns.
    let values: usize = (table.columns().iter())
        .map(|column| column.values().len())
        .sum();
    if values != ROWS as usize * COLUMNS {
        return Err(format!("{values} values were read"));
    }
    let memory = memory_kb(std::process::id()).ok_or("the system does not tell the memory")?;
    let over_kept = 1024.0 * memory / (8 * values) as f64;
    Ok(format!("{} {over_kept}", bytes.len() as f64 / 1e6 / taken))
}

/// The file, written if it is not there yet.
#[allow(clippy::disallowed_methods, reason = "a file to be read is written")]
fn written() -> Result<PathBuf, String> {
    let folder = root().join("target/csv");
    let file = folder.join("long.csv");
    if file.exists() {
        return Ok(file);
    }
    let failed = |error: std::io::Error| error.to_string();
    std::fs::create_dir_all(&folder).map_err(failed)?;
    let unfinished = folder.join("unfinished.csv");
    let mut out = BufWriter::new(std::fs::File::create(&unfinished).map_err(failed)?);
    let head = "t [s],x [mm],y [mm],i [A],u [V],f [N],v [mm/s],phi [rad]\n";
    out.write_all(head.as_bytes()).map_err(failed)?;
    let mut line = String::new();
    for row in 0..ROWS {
        let t = f64::from(row) * 1e-3;
        let (sine, cosine) = t.sin_cos();
        let noise = f64::from(row.wrapping_mul(2_654_435_761) >> 8) / 16_777_216.0;
        line.clear();
        writeln!(
            line,
            "{t:.3},{:.6},{:.6},{:.5},{:.5},{:.4},{:.5},{:.6}",
            100.0 * sine,
            100.0 * cosine,
            10.0 * noise,
            48.0 * noise * sine,
            1000.0 * noise,
            100.0 * cosine,
            t % std::f64::consts::TAU
        )
        .map_err(|error| error.to_string())?;
        out.write_all(line.as_bytes()).map_err(failed)?;
    }
    out.into_inner().map_err(|error| error.to_string())?;
    std::fs::rename(unfinished, &file).map_err(failed)?;
    Ok(file)
}
