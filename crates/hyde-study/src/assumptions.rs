//! What was assumed of records, tables and FMUs, each as a sentence.

use crate::Project;
use crate::not_numbers;
use crate::run_failure::instant;
use hyde_experiment::{Run, extent, is_over_frequency};
use hyde_program::{Constant, Method, Program};
use hyde_signal::Table;
use hyde_sim::Contradiction;
use hyde_units::significant;
use std::collections::{BTreeMap, BTreeSet};

/// All of it, record by record, then where the run begins.
pub fn of_run(project: &Project, program: &Program, run: &Run) -> Vec<String> {
    let mut all = all(project, program, &run.start, run.stop_s);
    all.extend(of_method(program, run));
    all.extend(run.results.contradictions.iter().map(of_contradiction));
    all.extend(not_numbers::of_run(program, run));
    all
}

fn of_contradiction(found: &Contradiction) -> String {
    let [first, second] = &found.causes;
    let [before, after] = found.values.map(|value| significant(value, 5));
    format!(
        "at {} s `{first}` and `{second}` set the same variable, to {before} and {after} (SI units): the second one counts. Write \
         both in one `when … elsewhen`, or let one of them set a variable of its own",
        significant(found.t, 6)
    )
}

/// Steps in a period of a source that leave no pulse out.
const STEPS_OF_PULSES: f64 = 200.0;

/// What a run by IDA may have passed over, unless its steps were bounded.
fn of_method(program: &Program, run: &Run) -> Option<String> {
    let statistics = &run.results.statistics;
    let by_ida = statistics.method == Method::Ida && statistics.left_ida.is_none();
    let largest = program.kernels.constant(Constant::MaxStep, &run.parameters);
    if !by_ida || !program.may_pulse() || largest.is_some() {
        return None;
    }
    let step_s = program.shortest_period_s(&run.parameters) / STEPS_OF_PULSES;
    step_s.is_finite().then(|| {
        format!(
            "`ida` evaluates the ends of its steps alone. It may pass over short pulses, which a sine gives where an \
             exponential such as that of a diode switches: write `solve esdirk`, or `solve ida(max_step = {} [s])`",
            significant(step_s, 2)
        )
    })
}

/// The same of a model that is looked at with its records, but not run as the experiment says.
pub fn of_model(project: &Project, program: &Program, parameters: &[f64]) -> Vec<String> {
    let tables = crate::tables(&project.records);
    let (start, stop_s) = extent(program, &tables, parameters);
    all(project, program, &start, stop_s)
}

fn all(
    project: &Project,
    program: &Program,
    start: &(f64, Option<String>),
    stop_s: f64,
) -> Vec<String> {
    let tables = project.records.iter();
    let tables: BTreeMap<&str, &Table> = tables
        .map(|(name, record)| (name.as_str(), &record.table))
        .collect();
    let own = tables.iter().flat_map(|(name, table)| {
        let all = of_record(program, name, table).into_iter();
        all.map(move |text| format!("record `{name}`: {text}"))
    });
    let looked_up = project.tables.iter().flat_map(|table| {
        let name = table.path.display();
        let notes = table.notes.iter();
        notes.map(move |note| format!("table `{name}`: {note}"))
    });
    let mut all: Vec<String> = own.chain(looked_up).collect();
    let beside_time = hyde_compiler::beside_time();
    if program.outputs.iter().any(|own| own.name == beside_time) {
        all.push(format!(
            "the variable `t` of the model is `{beside_time}` in the results, where `t` is the time"
        ));
    }
    all.extend(of_fmus(project, program));
    all.extend(of_start(program, &tables, start, stop_s));
    all
}

/// How the FMUs of a program are run and read.
fn of_fmus(project: &Project, program: &Program) -> Vec<String> {
    let mut all = Vec::new();
    for known in &project.fmus {
        let parts = program.foreign.iter();
        let parts: Vec<String> = parts
            .filter(|part| part.source == known.source)
            .map(|part| match part.name.as_str() {
                "" => "the model".to_owned(),
                name => format!("`{name}`"),
            })
            .collect();
        if parts.is_empty() {
            continue;
        }
        let (file, parts) = (&known.fmu.file, parts.join(", "));
        all.push(match known.in_own_process {
            true => format!("{parts} runs machine code of `{file}` in a process of its own"),
            false => format!(
                "{parts} runs machine code of `{file}` in this process; `--sandbox` runs it in one of its own"
            ),
        });
        let notes = known.fmu.description.notes.iter();
        all.extend(notes.map(|note| format!("FMU `{file}`: {note}")));
        let renamed = known.fmu.interface.renamed.iter().take(6);
        let renamed: Vec<String> = renamed
            .map(|(before, after)| format!("`{before}` is `{after}`"))
            .collect();
        if !renamed.is_empty() {
            let more = match known.fmu.interface.renamed.len() {
                0..=6 => "",
                _ => ", …",
            };
            all.push(format!("FMU `{file}`: {}{more}", renamed.join(", ")));
        }
    }
    all
}

/// What was taken for granted of a record, as far as the program reads it.
pub fn of_record(program: &Program, name: &str, table: &Table) -> Vec<String> {
    let mut all: Vec<String> = table.notes().iter().map(ToString::to_string).collect();
    let known: BTreeSet<&str> = columns(program)
        .filter(|(record, _)| *record == name)
        .map(|(_, column)| column)
        .collect();
    let sparse = known.iter().filter(|column| table.column(column).is_none());
    for column in sparse {
        let missing = table.rows() - table.reading(column).rows();
        all.push(format!(
            "`{column}` has no reading in {missing} of {} samples: it is compared where it has one",
            table.rows()
        ));
    }
    let bare = |column: &&str| {
        let own = table.reading(column).column(column);
        own.is_some_and(|own| own.unit().is_none())
    };
    let without: BTreeSet<&str> = known.into_iter().filter(bare).collect();
    if !without.is_empty() {
        let list: Vec<String> = without.iter().map(|column| format!("`{column}`")).collect();
        let (has, is, them) = match list.len() {
            1 => ("has", "it is", "it"),
            _ => ("have", "they are", "them"),
        };
        all.push(format!(
            "{} {has} no unit: {is} read in the SI unit of the variable that the experiment compares or drives with {them}; \
             if that is wrong, declare the unit: `record {name}(column = {:?} in [mm])`",
            list.join(", "),
            without.first().copied().unwrap_or_default()
        ));
    }
    all
}

/// Where the run begins and how far its records reach.
fn of_start(
    program: &Program,
    tables: &BTreeMap<&str, &Table>,
    (start_s, record): &(f64, Option<String>),
    stop_s: f64,
) -> Vec<String> {
    let mut all = Vec::new();
    if *start_s != 0.0 {
        all.push(match record {
            Some(record) => format!(
                "the run begins at {}, where its record `{record}` begins; `time` is the time of the record",
                instant(*start_s)
            ),
            None => format!("the run begins at {}, as the experiment says", instant(*start_s)),
        });
    }
    let driving: BTreeSet<&str> = program.columns.iter().map(|c| c.record.as_str()).collect();
    let measured = program.experiment.measured.iter();
    let measured: BTreeSet<&str> = measured.map(|m| m.source.0.as_str()).collect();
    let over_time = |name: &str| !is_over_frequency(program, name);
    for (name, table) in tables.iter().filter(|(name, _)| over_time(name)) {
        let (Some(&begin), Some(&end)) = (table.time().first(), table.time().last()) else {
            continue;
        };
        let slack = table.mean_step().unwrap_or(0.0);
        if driving.contains(name) && begin > start_s + slack {
            all.push(format!(
                "record `{name}` begins at {}, later than the run: its first sample is held until then",
                instant(begin)
            ));
        }
        if driving.contains(name) && end < stop_s - slack {
            all.push(format!(
                "record `{name}` ends at {}, before the run: its last sample is held from then on",
                instant(end)
            ));
        }
        if measured.contains(name) && begin < start_s - slack {
            all.push(format!(
                "record `{name}` begins at {}, before the run: its samples before the run are not compared",
                instant(begin)
            ));
        }
    }
    all
}

/// Record and column of everything that a program reads or compares.
fn columns(program: &Program) -> impl Iterator<Item = (&str, &str)> {
    let read = program.columns.iter();
    let read = read.map(|column| (column.record.as_str(), column.column.as_str()));
    let measured = program.experiment.measured.iter();
    read.chain(measured.map(|m| (m.source.0.as_str(), m.source.1.as_str())))
}
