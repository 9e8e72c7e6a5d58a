//! Simulates an FMU by co-simulation with fmi-rs: `hyde-fmi-rs FMU EVENTS START STOP STEPS RESULTS.csv LOG NAMES`.
//!
//! EVENTS is `events` for event mode and early return, else `steps`; NAMES is a file with a name of a variable in each line.
#![allow(clippy::arc_with_non_send_sync, reason = "the interface of fmi-rs asks for it")]

use fmi_rs::fmi3::LibraryKind;
use fmi_rs::model_description::{FMIMajorVersion, fmi2, fmi3, peek_fmi_major_version};
use fmi_rs::sim;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What is asked on the command line.
struct Asked {
    folder: PathBuf,
    events: bool,
    start: f64,
    stop: f64,
    interval: f64,
    results: PathBuf,
    log: PathBuf,
    names: Vec<String>,
}

/// Of the steps of fmi-rs; times that agree so well are the same.
const SAME: f64 = 1e-9;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [fmu, events, start, stop, steps, results, log, names] = words.as_slice() else {
        return Err("FMU EVENTS START STOP STEPS RESULTS.csv LOG NAMES".into());
    };
    let folder = Path::new(results).with_extension("unpacked");
    fmi_rs::zip::extract_zip_archive(fmu, &folder)?;
    let (start, stop): (f64, f64) = (start.parse()?, stop.parse()?);
    let divided = divided(start, stop, steps.parse()?);
    let (stop, interval) = divided.ok_or("fmi-rs cannot divide the time into so many steps")?;
    let asked = Asked {
        events: events == "events",
        start,
        stop,
        interval,
        results: results.into(),
        log: log.into(),
        names: std::fs::read_to_string(names)?
            .lines()
            .map(str::to_owned)
            .collect(),
        folder,
    };
    let description = asked.folder.join("modelDescription.xml");
    match peek_fmi_major_version(&description)? {
        FMIMajorVersion::V2 => two(&asked, &description)?,
        FMIMajorVersion::V3 => three(&asked, &description)?,
    }
    std::fs::remove_dir_all(&asked.folder)?;
    Ok(())
}

/// The stop time, and a step of which the time is a whole multiple to the last bit, which fmi-rs asks for: 20 ms in 1000 steps
/// have none, but 20 ms and a unit in the last place have one.
fn divided(start: f64, stop: f64, steps: u32) -> Option<(f64, f64)> {
    let whole = |stop: f64, interval: f64| (stop - start) / interval == f64::from(steps);
    neighbours(stop).find_map(|stop| {
        let near = (stop - start) / f64::from(steps);
        let interval = neighbours(near).find(|interval| whole(stop, *interval))?;
        Some((stop, interval))
    })
}

/// A positive number and those next to it, the nearest first.
fn neighbours(number: f64) -> impl Iterator<Item = f64> {
    let bits = number.to_bits();
    let near = (1..4).flat_map(move |k| [bits + k, bits - k]);
    std::iter::once(bits).chain(near).map(f64::from_bits)
}

fn three(asked: &Asked, description: &Path) -> Result<(), Box<dyn Error>> {
    let description = Arc::new(fmi3::ModelDescription::from_path(description)?);
    for finding in description.validate() {
        return Err(format!("fmi-rs: {finding:?}").into());
    }
    let numbers = asked.names.iter();
    let numbers = numbers
        .map(|name| description.variable_index_by_name(name))
        .collect::<Result<Vec<usize>, _>>()?;
    let recorded = sim::fmi3::Trajectories::new(description.clone(), numbers);
    let recorder = Arc::new(sim::fmi3::recorder::Recorder::new(recorded));
    let settings = sim::fmi3::SimulationSettings {
        unzipdir: asked.folder.clone(),
        model_description: description,
        library_kind: LibraryKind::Native,
        enable_dae: false,
        start_time: asked.start,
        stop_time: asked.stop,
        visible: false,
        logging_on: true,
        set_stop_time: true,
        output_interval: asked.interval,
        log_time_scale: false,
        tolerance: SAME,
        set_tolerance: false,
        start_values: Vec::new(),
        log_fmi_calls: false,
        intermediate_update: false,
        input_file: None,
        early_return_allowed: asked.events,
        event_mode_used: asked.events,
        log_file: Some(asked.log.clone()),
        initial_fmu_state_file: None,
        final_fmu_state_file: None,
    };
    sim::fmi3::cs::simulate(&settings, None, Arc::clone(&recorder))?;
    sim::fmi3::csv::write_csv(&recorder.trajectories.borrow(), &asked.results)?;
    Ok(())
}

fn two(asked: &Asked, description: &Path) -> Result<(), Box<dyn Error>> {
    let description = Arc::new(fmi2::ModelDescription::from_path(description)?);
    for finding in description.validate() {
        return Err(format!("fmi-rs: {finding:?}").into());
    }
    let named = |name: &String| {
        let mut all = description.modelVariables.iter();
        let number = all.position(|own| own.name == *name);
        number.ok_or_else(|| format!("no variable `{name}`"))
    };
    let numbers = asked.names.iter().map(named);
    let numbers = numbers.collect::<Result<Vec<usize>, _>>()?;
    let recorded = sim::fmi2::Trajectories::new(description.clone(), numbers);
    let recorder = Arc::new(sim::fmi2::recorder::Recorder::new(recorded));
    let settings = sim::fmi2::SimulationSettings {
        unzipdir: asked.folder.clone(),
        model_description: description,
        start_time: asked.start,
        stop_time: asked.stop,
        logging_on: true,
        set_stop_time: true,
        output_interval: asked.interval,
        log_time_scale: false,
        tolerance: SAME,
        set_tolerance: false,
        start_values: Vec::new(),
        log_fmi_calls: false,
        input_file: None,
        early_return_allowed: asked.events,
        event_mode_used: asked.events,
        log_file: Some(asked.log.clone()),
        initial_fmu_state_file: None,
        final_fmu_state_file: None,
    };
    sim::fmi2::cs::simulate(&settings, None, Arc::clone(&recorder))?;
    sim::fmi2::csv::write_csv(&recorder.trajectories.borrow(), &asked.results)?;
    Ok(())
}
