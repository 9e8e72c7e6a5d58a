//! Hyde alone: the Y axis, the start of the command, one step of a calibration, a diagnosis.

use crate::command::{Tools, end};
use crate::promise::print_line;
use std::process::Command;
use std::time::Instant;

const Y_AXIS: &str = "examples/y_axis/axis.hyde";
const BENCH_AXIS: &str = "examples/bench_axis/axis.hyde";
const ROUNDS: usize = 5;

pub fn print(tools: &Tools) -> Result<(), String> {
    println!("\nHyde alone, CPU time (diagnosis: wall time)");
    let least = |arguments: &[&str]| -> Result<f64, String> {
        let mut least = f64::INFINITY;
        for _ in 0..ROUNDS {
            least = least.min(end(Command::new(&tools.hyde).args(arguments))?.cpu_s);
        }
        Ok(least)
    };
    let once = |arguments: &[&str]| end(Command::new(&tools.hyde).args(arguments));
    let start = least(&["run", Y_AXIS, "positioning", "--quiet", "--stop", "1e-9"])?;
    let positioning = least(&["run", Y_AXIS, "positioning", "--quiet"])? - start;
    print_line(
        "command_start",
        1e3 * least(&["--version"])?,
        "ms",
        "<=",
        20.0,
    );
    print_line("y_axis_first_step", 1e3 * start, "ms", "<=", 25.0);
    print_line(
        "y_axis_positioning",
        1.6 / positioning,
        "times_real_time",
        ">=",
        20.0,
    );
    let swept = once(&["run", Y_AXIS, "swept", "--quiet"])?.cpu_s - start;
    println!("y_axis_swept {:.2} times_real_time", 30.0 / swept);
    let (step_s, steps) = calibration_step(tools)?;
    println!("bench_axis_calibration_step {step_s:.3} s CPU, the command over its {steps} steps");
    let begin = Instant::now();
    end(Command::new(&tools.hyde).args([
        "diagnose",
        BENCH_AXIS,
        "bench",
        "--data",
        "examples/bench_axis/cogging",
        "--quiet",
    ]))?;
    print_line(
        "diagnose_cogging",
        begin.elapsed().as_secs_f64() / 60.0,
        "min",
        "<=",
        0.42,
    );
    Ok(())
}

/// CPU time of a whole calibration over its steps, and how many they were.
fn calibration_step(tools: &Tools) -> Result<(f64, u64), String> {
    let ended = end(Command::new(&tools.hyde).args([
        "fit",
        BENCH_AXIS,
        "--data",
        "examples/bench_axis/cogging",
        "--json",
    ]))?;
    let fit: serde_json::Value =
        serde_json::from_str(&ended.printed).map_err(|error| format!("hyde fit: {error}"))?;
    let steps = fit["steps"].as_u64().filter(|steps| *steps > 0);
    let steps = steps.ok_or("hyde fit told no steps")?;
    Ok((ended.cpu_s / steps as f64, steps))
}
