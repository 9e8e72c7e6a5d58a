//! The path of the public benchmarks: without their records it says so, and with made-up ones of the official layout it has the
//! error that the test computes itself.

#![allow(clippy::unwrap_used, clippy::disallowed_methods, reason = "tests")]

use hyde_signal::mat::Level5;
use hyde_tests::benchmarks::{BENCHMARKS, Benchmark, Reason, words};
use hyde_tests::root;
use serde_json::Value;
use std::fmt::Write as _;
use std::io::{Cursor, Write as _};
use std::path::Path;
use std::process::Command;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

fn program() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_hyde-tested"))
}

fn benchmark(name: &str) -> &'static Benchmark {
    let mut all = BENCHMARKS.iter();
    all.find(|benchmark| benchmark.name == name).unwrap()
}

#[test]
fn absent_records_are_told_and_no_number_is_made_up() {
    let folder = tempfile::tempdir().unwrap();
    for benchmark in &BENCHMARKS {
        let rows = (benchmark.measure)(program(), folder.path()).unwrap();
        let absent = |value| matches!(value, &Err(Reason::Absent(_)));
        assert!(rows.iter().all(|row| absent(&row.value)), "{rows:?}");
        let text = words(benchmark, &rows, folder.path());
        let own = text
            .lines()
            .find(|line| line.trim_start().starts_with("Hyde"));
        let figures = own.unwrap().chars().filter(char::is_ascii_digit).count();
        assert_eq!(figures, 0, "{text}");
        assert!(text.contains("not measured: "), "{text}");
        let readme = format!("examples/{}/README.md", benchmark.name);
        assert!(
            text.contains(&readme) && root().join(&readme).is_file(),
            "{text}"
        );
        for published in benchmark.published {
            assert!(
                text.contains(published.method) && text.contains(published.source),
                "{text}"
            );
            let known = |record| rows.iter().any(|row| row.record == record);
            assert!(
                published.figures.iter().all(|(record, _)| known(*record)),
                "{text}"
            );
        }
    }
}

#[test]
fn every_model_has_fewer_than_thirty_named_parameters() {
    for (file, fitted) in [
        ("examples/ced/ced.hyde", 9),
        ("examples/emps/emps.hyde", 10),
        ("examples/steering_mirror/steering_mirror.hyde", 29),
    ] {
        let text = std::fs::read_to_string(root().join(file)).unwrap();
        let (_, vary) = text.rsplit_once("vary ").unwrap();
        let (vary, _) = vary.split_once(';').unwrap();
        assert_eq!(vary.matches(" in ").count(), fitted, "{file}");
        assert!(fitted < 30);
    }
}

/// Coupled drives as the example has them, by small steps of Euler: the speed that the counter shows at each sample.
fn drives(voltages: &[f64]) -> Vec<f64> {
    const STEP: f64 = 2e-5;
    const STEPS: usize = 1000;
    let (kt, u0, friction, gained, w1, damping) = (7.0, -0.05, 1.5, 9.0, 0.6, 1.8);
    let (w0, d, wf) = (25.0, 0.22, 54.0);
    let (mut rotor, mut pulley, mut swing, mut shown, mut rate) = (0.0_f64, 0.0_f64, 0.0, 0.0, 0.0);
    let mut speeds = Vec::new();
    for voltage in voltages {
        speeds.push(shown);
        for _ in 0..STEPS {
            let torque: f64 = kt * (voltage - u0);
            if rotor.abs() > 0.0 || torque.abs() > friction {
                let way = if rotor.abs() > 0.0 {
                    rotor.signum()
                } else {
                    torque.signum()
                };
                let rubs = friction + gained * (1.0 - (-rotor.abs() / w1).exp());
                let next = rotor + STEP * (torque - damping * rotor - way * rubs);
                rotor = if next * way < 0.0 { 0.0 } else { next };
            }
            swing += STEP * w0 * (w0 * (rotor - pulley) - 2.0 * d * swing);
            pulley += STEP * swing;
            rate += STEP * wf * (wf * (pulley.abs() - shown) - 2.0 * 0.5_f64.sqrt() * rate);
            shown += STEP * rate;
        }
    }
    speeds
}

/// Uniformly distributed voltages that change every five samples.
fn voltages(seed: u64, low: f64, high: f64) -> Vec<f64> {
    let mut state = seed;
    let mut uniform = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 40) as f64 / 16_777_216.0
    };
    let mut out = Vec::new();
    while out.len() < 500 {
        let side = if uniform() < 0.5 { low } else { high };
        out.extend([side * uniform(); 5]);
    }
    out
}

#[test]
fn coupled_drives_of_the_official_layout_have_their_error() {
    let inputs = [voltages(3, -1.5, 2.5), voltages(8, -1.0, 3.0)];
    // Errors that no model can follow, in what counts; and larger ones in what must not count.
    let errors = [0.06, 0.03];
    let outputs: Vec<Vec<f64>> = (0..2)
        .map(|set| {
            let exact = drives(&inputs[set]).into_iter().enumerate();
            let wrong = exact.map(|(at, speed)| match at {
                0..400 => speed,
                400..410 => speed + 5.0,
                _ => {
                    speed
                        + if at % 2 == 0 {
                            errors[set]
                        } else {
                            -errors[set]
                        }
                }
            });
            wrong.collect()
        })
        .collect();
    let mut text = String::from("\"u11\",\"u12\",\"z11\",\"z12\",\n");
    for at in 0..500 {
        let row = [inputs[0][at], inputs[1][at], outputs[0][at], outputs[1][at]];
        writeln!(text, "{},{},{},{},", row[0], row[1], row[2], row[3]).unwrap();
    }
    text.push('\n');
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("DATAUNIF.csv"), text).unwrap();
    let rows = (benchmark("ced").measure)(program(), folder.path()).unwrap();
    for (row, error) in rows.iter().zip(errors) {
        let value = row.value.clone().unwrap();
        assert!(
            (value - error).abs() < 0.1 * error,
            "{value} is not {error}: {rows:?}"
        );
        assert_eq!((row.unit, row.fitted), ("ticks/s", 9));
    }
}

/// The root mean square of measured minus simulated of each channel of a run.
fn rms(file: &str, experiment: &str, record: &str) -> Vec<f64> {
    let output = Command::new(program())
        .args(["run", file, experiment, "--json", "--record", record])
        .current_dir(root())
        .output()
        .unwrap();
    let run: Value = serde_json::from_slice(&output.stdout)
        .unwrap_or_else(|_| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    let channels = run["channels"].as_array().unwrap().iter();
    channels
        .map(|channel| channel["rms"].as_f64().unwrap())
        .collect()
}

/// An axis at rest, whose encoder counts wrongly: what is before the twentieth sample does not count.
#[test]
fn emps_of_the_official_layout_has_its_error() {
    let samples = 400;
    let position: Vec<f64> = (0..samples)
        .map(|at| match at {
            0 => 0.1,
            1..20 => 0.2,
            _ => 0.1 + 2e-3 * f64::from(at % 3 - 1),
        })
        .collect();
    let none = vec![0.0; position.len()];
    let file = Level5::new("for a test")
        .numbers("gtau", 1, 1, &[35.15])
        .numbers("qg", position.len(), 1, &none)
        .numbers("qm", position.len(), 1, &position)
        .numbers("vir", position.len(), 1, &none)
        .numbers("pulses_N", position.len(), 1, &none);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("DATA_EMPS_PULSES.mat");
    std::fs::write(&path, file.into_bytes()).unwrap();
    let counted = &position[20..];
    let squares = counted.iter().map(|position| (position - 0.1).powi(2));
    let expected = (squares.sum::<f64>() / counted.len() as f64).sqrt();
    let record = format!("official={} every 1 [ms]", path.display());
    for experiment in ["open", "open_pulses"] {
        let found = rms("examples/emps/emps.hyde", experiment, &record);
        assert!(
            (found[0] - expected).abs() < 1e-9,
            "{found:?} is not {expected}"
        );
    }
}

/// A mirror without voltages, whose sensors show other displacements in every run: the run that is asked for counts, from its
/// hundredth sample on.
#[test]
fn the_mirror_of_the_official_layout_has_its_error() {
    let (samples, runs) = (160, [3, 2]);
    let shown = |at: usize, sensor: usize, run: usize| match at {
        0..100 => 1.0,
        _ => 1e-6 * (at % 7) as f64 * (sensor + 1) as f64 * (run + 1) as f64,
    };
    let cells = |value: &dyn Fn(usize, usize, usize) -> f64| -> Vec<u8> {
        let places = (0..samples * 3 * 6).map(|cell| value(cell / 18, cell / 6 % 3, cell % 6));
        places.flat_map(f64::to_le_bytes).collect()
    };
    let shape = format!("{samples}, 3, {}, {}", runs[0], runs[1]);
    let array = |data: Vec<u8>| {
        let header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({shape}), }}\n");
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        [
            b"\x93NUMPY\x01\x00".as_slice(),
            &length,
            header.as_bytes(),
            &data,
        ]
        .concat()
    };
    let mut files = vec![("y_100mV_test.npy", array(cells(&shown)))];
    files.push(("u_100mV_test.npy", array(cells(&|_, _, _| 0.0))));
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("combined_data.npz");
    std::fs::write(&path, stored(&files)).unwrap();
    let file = "examples/steering_mirror/steering_mirror.hyde";
    for run in 0..6 {
        let record = format!(
            "file={} (run = {}) every 156.25 [us]",
            path.display(),
            run + 1
        );
        let found = rms(file, "test_100", &record);
        for (sensor, found) in found.into_iter().enumerate() {
            let squares = (100..samples).map(|at| shown(at, sensor, run).powi(2));
            let expected = (squares.sum::<f64>() / (samples - 100) as f64).sqrt();
            assert!(
                (found - expected).abs() < 1e-6 * expected,
                "{found} is not {expected}"
            );
        }
    }
}

/// A zip archive of files as `numpy.savez` stores them.
fn stored(files: &[(&str, Vec<u8>)]) -> Vec<u8> {
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, data) in files {
        archive.start_file(*name, options).unwrap();
        archive.write_all(data).unwrap();
    }
    archive.finish().unwrap().into_inner()
}
