//! Layouts with their truth: twelve of one motion, exports of TwinCAT's scope, a response of a Sinumerik control.

use hyde_signal::{CountUnit, DeclaredColumn, Layout, Table};
use hyde_units::NamedUnit;
use serde_json::Value;
use std::path::Path;

/// What is wrong with each file of a folder of traces, by its name; nothing where it is read as it should be.
///
/// # Errors
/// A file cannot be read.
#[allow(clippy::disallowed_methods, reason = "tests read their data")]
pub fn layouts(folder: &Path) -> Result<Vec<(String, Option<String>)>, String> {
    let read = |name: &str| {
        let path = folder.join(name);
        std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let truth: Value =
        serde_json::from_slice(&read("layouts/truth.json")?).map_err(|error| error.to_string())?;
    let column = |name: &str| -> Vec<f64> {
        let values = truth[name].as_array().into_iter().flatten();
        values.filter_map(Value::as_f64).collect()
    };
    let motion = Motion {
        time: column("t_s"),
        position: column("pos_mm"),
        speed: column("vel_mm_s"),
        current: column("cur_A"),
    };
    let mut found = Vec::new();
    for (name, check) in LAYOUTS {
        let bytes = read(&format!("layouts/{name}"))?;
        found.push((name.to_owned(), check(&bytes, &motion).err()));
    }
    for name in TWINCAT {
        let bytes = read(&format!("twincat/tc3_scope_3_4_3145_3-{name}.csv"))?;
        found.push((format!("TwinCAT {name}"), twincat(&bytes).err()));
    }
    let bytes = read("sinumerik/freq_trace.XML")?;
    found.push(("Sinumerik response".to_owned(), sinumerik(&bytes).err()));
    let bytes = read("twincat/tc3_scope_3_4_3145_3-Seperator_1.csv")?;
    let told = refused(&bytes, &["27 names", "24 columns", "columns = "]);
    found.push(("TwinCAT Seperator_1".to_owned(), told.err()));
    Ok(found)
}

/// What all the layouts show.
struct Motion {
    time: Vec<f64>,
    position: Vec<f64>,
    speed: Vec<f64>,
    current: Vec<f64>,
}

type Check = fn(&[u8], &Motion) -> Result<(), String>;

const LAYOUTS: [(&str, Check); 12] = [
    ("german.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "PosActual", "mm", &motion.position)?;
        column(&table, "VeloActual", "mm/s", &motion.speed)?;
        column(&table, "Current", "A", &motion.current)
    }),
    ("scopeview.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        bare(&table, "PosActual", &motion.position)?;
        let declared = Layout {
            columns: vec![in_unit("PosActual", 1.0, "mm")],
            ..Layout::default()
        };
        column(
            &with(bytes, &declared)?,
            "PosActual",
            "mm",
            &motion.position,
        )
    }),
    ("two_rates.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "PosActual", "mm", &motion.position)?;
        column(&table, "VeloActual", "mm/s", &motion.speed)?;
        let fifth: Vec<f64> = motion.current.iter().copied().step_by(5).collect();
        column(&table, "Current", "A", &fifth)?;
        let times: Vec<f64> = motion.time.iter().copied().step_by(5).collect();
        near("its time", table.holding("Current").time(), &times, 1e-9)
    }),
    ("halscope.log", |bytes, motion| {
        let table = plain(bytes)?;
        near("time", table.time(), &motion.time, 1e-9)?;
        told(&table, "Sampling period")?;
        bare(&table, "joint.0.motor-pos-fb", &motion.position)?;
        bare(&table, "joint.0.vel-cmd", &motion.speed)
    }),
    ("halsampler.txt", |bytes, motion| {
        refused(bytes, &["columns = ", "every 1 [ms]"])?;
        let headings = ["pos [mm]", "vel [mm/s]", "cur [A]", "on"];
        let declared = Layout {
            every_s: Some(0.001),
            headings: Some(headings.map(str::to_owned).to_vec()),
            ..Layout::default()
        };
        let table = with(bytes, &declared)?;
        near("time", table.time(), &motion.time, 1e-9)?;
        column(&table, "pos", "mm", &motion.position)?;
        column(&table, "cur", "A", &motion.current)
    }),
    ("daq.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "PosActual", "mm", &motion.position)?;
        column(&table, "Current", "A", &motion.current)
    }),
    ("drive_tool.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "Analog 1", "mm", &motion.position)?;
        column(&table, "Servo motor speed", "mm/s", &motion.speed)?;
        column(&table, "Analog 3", "A", &motion.current)
    }),
    ("controller_us.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "s actual X", "mm", &motion.position)?;
        column(&table, "v act. X", "mm/s", &motion.speed)
    }),
    ("clock.csv", |bytes, motion| {
        let table = plain(bytes)?;
        told(&table, "samples are missing between 0.149 s and 0.17 s")?;
        told(
            &table,
            "1 sample has the time of the sample before it, at 0.09 s",
        )?;
        let kept = |row: &usize| !(150..170).contains(row);
        let mut rows: Vec<usize> = (0..motion.time.len()).filter(kept).collect();
        rows.insert(91, 90);
        let of = |all: &[f64]| rows.iter().map(|row| all[*row]).collect::<Vec<f64>>();
        near("time", table.time(), &of(&motion.time), 1e-9)?;
        bare(&table, "position_mm", &of(&motion.position))
    }),
    ("holes.csv", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        column(&table, "i", "A", &motion.current)?;
        let hole = table.unusable().iter().find(|column| column.name == "x");
        match hole {
            Some(hole)
                if ["line 42", "82, 122"]
                    .iter()
                    .all(|line| hole.fault.message.contains(line)) =>
            {
                Ok(())
            }
            _ => Err("the holes of `x` are not told with their line".to_owned()),
        }
    }),
    ("unicode.txt", |bytes, motion| {
        let table = plain(bytes)?;
        whole(&table, motion)?;
        told(&table, "UTF-16")?;
        column(&table, "x", "mm", &motion.position)
    }),
    ("counts.csv", |bytes, motion| {
        refused(bytes, &["cycle", "in 125 [us]"])?;
        let counts = DeclaredColumn {
            wraps: Some(65_536.0),
            ..in_unit("enc_counts", 1.0, "um")
        };
        let declared = Layout {
            time: Some(in_unit("cycle", 125.0, "us")),
            columns: vec![counts, in_unit("iq_raw", 1.0, "mA")],
            ..Layout::default()
        };
        let table = with(bytes, &declared)?;
        whole(&table, motion)?;
        // Whole counts.
        let position = table.column("enc_counts").ok_or("no counts")?.in_unit();
        let um: Vec<f64> = motion.position.iter().map(|mm| 1000.0 * mm).collect();
        near("counts", &position, &um, 0.51)
    }),
];

const TWINCAT: [&str; 3] = [
    "default",
    "DecimalMark_,",
    "ExcludeDoubleTimestamp_true-SortChannels_false",
];

/// Every channel counts the samples of its own rate.
fn twincat(bytes: &[u8]) -> Result<(), String> {
    let table = plain(bytes)?;
    for (name, rows, first_s, step_s) in [
        ("func_OS", 4996, 0.0, 2e-4),
        ("var_REAL64", 1000, 0.0, 1e-3),
        ("func_timeshift", 1000, 0.0, 1e-3),
        ("test_special([{äöü!?ß$²}])", 1000, 0.0, 1e-3),
        ("func_freesample", 201, -3e-3, 5e-3),
    ] {
        let part = table.holding(name);
        let times: Vec<f64> = (0..rows).map(|k| first_s + step_s * f64::from(k)).collect();
        near(name, part.time(), &times, 1e-9)?;
        let values = part.column(name).ok_or(name)?.values();
        let last = f64::from(rows - 1);
        if name == "var_REAL64" && (values.len(), values[values.len() - 1]) != (1000, last) {
            return Err(format!("`{name}` ends with {:?}", values.last()));
        }
    }
    let unit = table.column("func_units_unscaled").and_then(|c| c.unit());
    if unit.is_none_or(|unit| unit.text() != "V") {
        return Err("`func_units_unscaled` is not in V".to_owned());
    }
    told(&table, "scale factors or offsets of")?;
    told(&table, "`SampleTime[ms]` in line 10")
}

/// The excitation is a binary sequence in both directions, one the negative of the other; the response goes to 4 kHz.
fn sinumerik(bytes: &[u8]) -> Result<(), String> {
    let table = plain(bytes)?;
    let times: Vec<f64> = (0..2047).map(|k| 1.25e-4 * f64::from(k)).collect();
    near("time", table.time(), &times, 1e-9)?;
    let values = |name: &str| {
        let column = table.column(name).ok_or(format!("no `{name}`"))?;
        Ok::<_, String>(column.values().to_vec())
    };
    let (forward, backward) = (values("input_1")?, values("input_2")?);
    let negative: Vec<f64> = backward.iter().map(|value| -value).collect();
    near("input", &forward, &negative, 1e-9)?;
    near("input", &forward[..1], &[0.628_316_408_511_465], 1e-12)?;
    let output = [0.324_882_743_562_5, 0.282_563_443_123_7];
    near("output", &values("output_1")?[..2], &output, 1e-9)?;
    let response = table.holding("re");
    let frequency: Vec<f64> = (1..1023).map(|k| f64::from(k) * 4000.0 / 1022.0).collect();
    near("frequency", response.time(), &frequency, 1e-6)
}

fn plain(bytes: &[u8]) -> Result<Table, String> {
    with(bytes, &Layout::default())
}

fn with(bytes: &[u8], layout: &Layout) -> Result<Table, String> {
    hyde_signal::read(bytes, layout).map_err(|error| error.to_string())
}

fn refused(bytes: &[u8], words: &[&str]) -> Result<(), String> {
    match hyde_signal::read(bytes, &Layout::default()) {
        Ok(_) => Err("it is read, though it does not say what is what".to_owned()),
        Err(error) => {
            let text = format!("{error}: {}", error.repair("log"));
            let missing = words.iter().find(|word| !text.contains(**word));
            missing.map_or(Ok(()), |word| Err(format!("{text} does not say `{word}`")))
        }
    }
}

fn in_unit(name: &str, factor: f64, unit: &str) -> DeclaredColumn {
    DeclaredColumn {
        unit: NamedUnit::parse(unit)
            .ok()
            .map(|unit| CountUnit { factor, unit }),
        ..DeclaredColumn::named(name)
    }
}

fn whole(table: &Table, motion: &Motion) -> Result<(), String> {
    near("time", table.time(), &motion.time, 1e-9)
}

/// A column in a unit: the truth is rounded to six places in the files.
fn column(table: &Table, name: &str, unit: &str, truth: &[f64]) -> Result<(), String> {
    let column = table.column(name).ok_or(format!("no `{name}`"))?;
    let wanted = NamedUnit::parse(unit).map_err(|error| error.to_string())?;
    let own = column.dimension();
    if own != Some(wanted.unit().dimension) {
        return Err(format!(
            "`{name}` is in {:?}",
            column.unit().map(NamedUnit::text)
        ));
    }
    let values: Vec<f64> = column
        .values()
        .iter()
        .map(|si| wanted.unit().from_si(*si))
        .collect();
    near(name, &values, truth, 2e-6)
}

/// A column without a unit keeps its numbers.
fn bare(table: &Table, name: &str, truth: &[f64]) -> Result<(), String> {
    let column = table.column(name).ok_or(format!("no `{name}`"))?;
    if let Some(unit) = column.unit() {
        return Err(format!(
            "`{name}` is taken in {unit}, which the file does not say"
        ));
    }
    near(name, column.values(), truth, 2e-6)
}

fn near(what: &str, values: &[f64], truth: &[f64], within: f64) -> Result<(), String> {
    if values.len() != truth.len() {
        return Err(format!(
            "{what}: {} values, not {}",
            values.len(),
            truth.len()
        ));
    }
    let mut pairs = values.iter().zip(truth).enumerate();
    match pairs.find(|(_, (value, truth))| (*value - *truth).abs() > within) {
        Some((row, (value, truth))) => Err(format!("{what}, row {row}: {value}, not {truth}")),
        None => Ok(()),
    }
}

fn told(table: &Table, words: &str) -> Result<(), String> {
    let told = table
        .notes()
        .iter()
        .any(|note| note.to_string().contains(words));
    if told {
        Ok(())
    } else {
        Err(format!("not told: {words}"))
    }
}
