//! `hyde bode`: the frequency responses an experiment asks for, linearised and as swept on the full hybrid model.

use crate::args::{BodeArgs, RunArgs};
use crate::commands::run;
use crate::exit::Exit;
use crate::figures::shown;
use crate::files;
use crate::project::{self, Aim, Records, complain, print_output};
use crate::records;
use crate::summary;
use hyde_experiment::{
    BodeError, LinearizeError, Swept, frequency_response, linearize, parameters, swept_response,
};
use hyde_program::{Bode, Constant, Program};
use hyde_report::{BodeCurve, Figure, LineStyle, bode_plot, to_png, to_svg};
use hyde_units::significant;
use serde_json::json;
use std::fmt::Write as _;
use std::path::Path;

/// A linearised response: frequencies in Hz, and real and imaginary part of each output.
struct LinearResponse {
    frequency: Vec<f64>,
    outputs: Vec<(String, Vec<(f64, f64)>)>,
    resonances: Vec<(f64, f64)>,
}

/// Prints and plots the frequency responses of an experiment.
pub(crate) fn bode(args: &BodeArgs) -> Exit {
    match responses(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn responses(args: &BodeArgs) -> Result<String, Exit> {
    let mut project = project::load(&args.model, Records::Needed)?;
    let compiled = project.compile(&args.model, Aim::Linearize)?;
    project.print_warnings(&args.model);
    let program = &compiled.program;
    let wrong = |reason: String| complain(&args.model, Exit::CommandLine, &reason);
    if program.experiment.bodes.is_empty() {
        return Err(wrong(
            "the experiment asks for no response: write `bode from u to y over 1 .. 50 [Hz];`"
                .to_owned(),
        ));
    }
    let tables = records::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|_| wrong("a parameter cannot be set".to_owned()))?;
    let run = if args.linear {
        None
    } else {
        Some(run::solved(&RunArgs::of_model(&args.model))?)
    };
    let mut text = run
        .as_ref()
        .map_or_else(String::new, |(project, compiled, run, took)| {
            summary::text(project, compiled, run, *took)
        });
    let mut found = Vec::new();
    for (number, bode) in program.experiment.bodes.iter().enumerate() {
        let band = band(program, number, &p)
            .ok_or_else(|| wrong("the band of frequencies is empty".to_owned()))?;
        let linear = linear(program, bode, &tables, &p, band, args.points).map_err(wrong)?;
        let swept = match &run {
            Some((_, compiled, run, _)) => {
                let own = &compiled.program.experiment.bodes[number];
                swept_response(own, &run.results, band)
            }
            None => Vec::new(),
        };
        let _ = writeln!(
            text,
            "from {} over {} .. {} Hz",
            bode.input,
            significant(band.0, 3),
            significant(band.1, 3)
        );
        for (frequency, damping) in &linear.resonances {
            let _ = writeln!(
                text,
                "  mode at {:>8} Hz, damping {:<8} {}",
                significant(*frequency, 4),
                significant(*damping, 2),
                where_seen(*frequency, &linear)
            );
        }
        for (output, (name, response)) in linear.outputs.iter().enumerate() {
            let peaks = peaks(&linear.frequency, response);
            let list: Vec<String> = peaks
                .iter()
                .map(|f| format!("{} Hz", significant(*f, 3)))
                .collect();
            let seen = if list.is_empty() {
                "no peak".to_owned()
            } else {
                format!("peaks at {}", list.join(", "))
            };
            let _ = writeln!(text, "  {name}: {seen}");
            if let Some(folder) = &args.out {
                let unit = response_unit(program, bode, output);
                let figure = drawn(name, &unit, &linear, output, swept.get(output));
                let stem = if program.experiment.bodes.len() * linear.outputs.len() == 1 {
                    "bode".to_owned()
                } else {
                    format!("bode-{}", file_name(name))
                };
                leave(folder, &stem, &figure, &linear, output, swept.get(output)).map_err(wrong)?;
                let _ = writeln!(text, "    {}", folder.join(format!("{stem}.svg")).display());
            }
        }
        let outputs: Vec<_> = linear
            .outputs
            .iter()
            .map(|(name, response)| json!({ "name": name, "re_im": response }))
            .collect();
        found.push(json!({ "input": bode.input, "frequency_hz": linear.frequency, "outputs": outputs, "modes": linear.resonances }));
    }
    if args.model.json {
        return Ok(format!("{:#}", json!({ "ok": true, "responses": found })));
    }
    Ok(text)
}

fn band(program: &Program, number: usize, p: &[f64]) -> Option<(f64, f64)> {
    let from = program.kernels.constant(Constant::BandFrom(number), p)?;
    let to = program.kernels.constant(Constant::BandTo(number), p)?;
    (from > 0.0 && to > from).then_some((from, to))
}

fn linear(
    program: &Program,
    bode: &Bode,
    tables: &std::collections::BTreeMap<String, hyde_signal::Table>,
    p: &[f64],
    band: (f64, f64),
    points: usize,
) -> Result<LinearResponse, String> {
    let system = linearize(
        program,
        tables,
        p,
        std::slice::from_ref(&bode.input),
        &bode.modes,
    )
    .map_err(|error| match error {
        LinearizeError::NoInput(name) => format!("`{name}` is no free input"),
        LinearizeError::TooLarge(n) => {
            format!("{n} unknowns are too many for a dense linearised system")
        }
        LinearizeError::NoCommonPeriod => {
            "clocks that never tick together again have no common frequency response".to_owned()
        }
        LinearizeError::LongDelay => {
            "a clock whose held values change more than a period later has no response".to_owned()
        }
        LinearizeError::DelayAndClock => {
            "a model with both `delay` and a clocked part has no linearised response".to_owned()
        }
        LinearizeError::Singular => {
            "the algebraic variables are not determined in these modes".to_owned()
        }
        LinearizeError::Failed(failure) => {
            format!("no operating point was found: {:?}", failure.kind)
        }
    })?;
    let count = points.max(2);
    let frequency: Vec<f64> = (0..count)
        .map(|k| band.0 * (band.1 / band.0).powf(k as f64 / (count - 1) as f64))
        .collect();
    let outputs: Vec<usize> = bode.outputs.iter().map(|(_, output)| *output).collect();
    let all = frequency_response(&system, 0, &outputs, &frequency).map_err(|error| match error {
        BodeError::AboveNyquist(f, limit) => format!(
            "{} Hz is above half the sampling rate, {} Hz: the sampled loop has no response there",
            significant(f, 3),
            significant(limit, 3)
        ),
        BodeError::Singular(f) => format!("the system is singular at {} Hz", significant(f, 3)),
    })?;
    let outputs = bode
        .outputs
        .iter()
        .zip(all)
        .map(|((name, _), response)| {
            (
                name.clone(),
                response
                    .into_iter()
                    .map(|value| (value.re, value.im))
                    .collect(),
            )
        })
        .collect();
    let resonances = hyde_experiment::modes(&system)
        .into_iter()
        .filter(|mode| mode.damping < 0.3 && (0.5 * band.0..=band.1).contains(&mode.frequency_hz))
        .map(|mode| (mode.frequency_hz, mode.damping))
        .collect();
    Ok(LinearResponse {
        frequency,
        outputs,
        resonances,
    })
}

/// At which outputs a mode is seen: by how much each response stands out there.
fn where_seen(frequency_hz: f64, linear: &LinearResponse) -> String {
    let seen: Vec<String> = linear
        .outputs
        .iter()
        .filter_map(|(name, response)| {
            let height = prominence(frequency_hz, &linear.frequency, response)?;
            Some(format!("{name} {height:+.1} dB"))
        })
        .collect();
    seen.join(", ")
}

/// The magnitude at a frequency over the straight line in the Bode plot from 3/4 to 4/3 of it, in dB; the largest within a tenth around.
fn prominence(at: f64, frequency: &[f64], response: &[(f64, f64)]) -> Option<f64> {
    let gain = |f: f64| {
        let k = frequency.partition_point(|other| *other < f);
        let (re, im) = *response.get(k)?;
        (k > 0).then(|| 20.0 * re.hypot(im).log10())
    };
    let (low, high) = (gain(at * 0.75)?, gain(at / 0.75)?);
    (-10..=10)
        .filter_map(|k| {
            let f = at * 1.1_f64.powf(f64::from(k) / 10.0);
            let along = (f / (0.75 * at)).ln() / (1.0 / (0.75 * 0.75_f64)).ln();
            Some(gain(f)? - (low + along * (high - low)))
        })
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// Frequencies at which the magnitude stands out by more than a decibel from its valleys on both sides.
fn peaks(frequency: &[f64], response: &[(f64, f64)]) -> Vec<f64> {
    let gain: Vec<f64> = response
        .iter()
        .map(|(re, im)| 20.0 * re.hypot(*im).log10())
        .collect();
    let mut found = Vec::new();
    for k in 1..gain.len().saturating_sub(1) {
        if gain[k] < gain[k - 1] || gain[k] <= gain[k + 1] {
            continue;
        }
        // Down to the valley on either side, as long as nothing higher stands between.
        let valley = |side: &mut dyn Iterator<Item = &f64>| {
            side.take_while(|value| **value <= gain[k])
                .fold(gain[k], |least, value| least.min(*value))
        };
        let left = valley(&mut gain[..k].iter().rev());
        let right = valley(&mut gain[k + 1..].iter());
        if gain[k] - left.max(right) > 1.0 {
            found.push(frequency[k]);
        }
    }
    found
}

fn response_unit(program: &Program, bode: &Bode, output: usize) -> String {
    let input = program
        .parameters
        .iter()
        .find(|parameter| parameter.name == bode.input);
    let Some(input) = input else {
        return String::new();
    };
    let output = program.outputs[bode.outputs[output].1].dimension;
    let (of, per) = (output.usual_unit(), input.dimension.usual_unit());
    match (shown(&of), shown(&per)) {
        (of, "") => of.to_owned(),
        ("", per) => format!("1/{per}"),
        (of, per) => format!("{of} per {per}"),
    }
}

fn drawn(
    name: &str,
    unit: &str,
    linear: &LinearResponse,
    output: usize,
    swept: Option<&Swept>,
) -> Figure {
    let mut curves = vec![BodeCurve {
        label: "linearised".to_owned(),
        frequency: linear.frequency.clone(),
        response: linear.outputs[output].1.clone(),
        style: LineStyle::Solid,
        coherence: None,
    }];
    if let Some(swept) = swept {
        curves.push(BodeCurve {
            label: "swept".to_owned(),
            frequency: swept.response.frequency_hz.clone(),
            response: swept
                .response
                .response
                .iter()
                .map(|value| (value.re, value.im))
                .collect(),
            style: LineStyle::Points,
            coherence: Some(swept.response.coherence.clone()),
        });
    }
    let (from, to) = (
        linear.frequency[0],
        linear.frequency[linear.frequency.len() - 1],
    );
    let resonances: Vec<(f64, String)> = linear
        .resonances
        .iter()
        .filter(|(f, damping)| *damping < 0.1 && (from..=to).contains(f))
        .map(|(f, _)| (*f, format!("{} Hz", significant(*f, 3))))
        .collect();
    bode_plot(name, (name, unit), &curves, &resonances)
}

fn leave(
    folder: &Path,
    stem: &str,
    figure: &Figure,
    linear: &LinearResponse,
    output: usize,
    swept: Option<&Swept>,
) -> Result<(), String> {
    files::make_folder(folder)?;
    files::write(
        &folder.join(format!("{stem}.svg")),
        to_svg(figure).as_bytes(),
    )?;
    files::write(&folder.join(format!("{stem}.png")), &to_png(figure, 2.0))?;
    let mut csv = String::from("kind,f [Hz],re,im,coherence\n");
    for (f, (re, im)) in linear.frequency.iter().zip(&linear.outputs[output].1) {
        let _ = writeln!(csv, "linearised,{f},{re},{im},1");
    }
    if let Some(swept) = swept {
        let response = &swept.response;
        for ((f, value), coherence) in response
            .frequency_hz
            .iter()
            .zip(&response.response)
            .zip(&response.coherence)
        {
            let _ = writeln!(csv, "swept,{f},{},{},{coherence}", value.re, value.im);
        }
    }
    files::write(&folder.join(format!("{stem}.csv")), csv.as_bytes())
}

fn file_name(name: &str) -> String {
    name.chars()
        .map(|c| {
            if c.is_ascii_alphanumeric() || c == '.' {
                c
            } else {
                '_'
            }
        })
        .collect()
}
