//! Frequency responses and stability margins: as text, as JSON, as figures with their numbers, and as a page.

mod draw;
mod margins;
mod measured;
mod open_loop;
mod page;
mod seen;
mod stepped;

pub use draw::drawn as response_figure;
pub use margins::text as margins_text;
pub use measured::table as errors_table;
pub use open_loop::figures as open_loop_figures;

use crate::{assumed, assumptions, summary};
use hyde_report::{Figure, to_html, to_png, to_svg};
use hyde_study::responses::{Compared, OfBode, Response, Responses};
use hyde_units::{difference_in, shown, significant};
use serde_json::{Map, Value, json};
use std::fmt::Write as _;
use std::time::Duration;

/// A file, by its name.
type File = (String, Vec<u8>);

/// All as one JSON object.
#[must_use]
pub fn json(all: &[Responses]) -> Value {
    let mut found = Vec::new();
    let mut margins = Vec::new();
    for asked in all {
        let program = &asked.compiled.program;
        for bode in &asked.bodes {
            let about = assumed::json(program, &bode.linear, bode.time, &bode.poles);
            found.push(of_bode(&bode.responses, &about));
        }
        margins.extend(asked.margins.iter().map(|one| margins::json(program, one)));
    }
    let notes: Vec<&String> = all.iter().flat_map(|asked| &asked.notes).collect();
    json!({ "ok": true, "responses": found, "margins": margins, "notes": notes })
}

/// The text, and the files that are to be left; `took` is the time of each run, `path` gives a file its path where files are
/// left, `title` is that of the figures if it is given, and `made` says when the page is made.
pub fn text(
    all: &[Responses],
    took: &[Option<Duration>],
    path: Option<&dyn Fn(&str) -> String>,
    title: Option<&str>,
    made: &str,
) -> (String, Vec<File>) {
    let several = all.len() > 1;
    let mut text = String::new();
    for (asked, took) in all.iter().zip(took) {
        text.push_str(&of_experiment(asked, *took, several));
    }
    let title = title.or_else(|| Some(all.first()?.title.as_str()));
    let title = title.unwrap_or_default();
    let mut files: Vec<File> = Vec::new();
    let every: Vec<&Response> = all
        .iter()
        .flat_map(|asked| asked.bodes.iter().flat_map(|bode| &bode.responses))
        .collect();
    let mut drawn: Vec<(&str, &str)> = Vec::new();
    for first in &every {
        let key = (first.input.as_str(), first.output.as_str());
        if drawn.contains(&key) {
            continue;
        }
        drawn.push(key);
        let is_same = |other: &&Response| (other.input.as_str(), other.output.as_str()) == key;
        let same: Vec<&Response> = every.iter().copied().filter(is_same).collect();
        let mut told: Vec<&str> = vec![&first.experiment];
        for other in &same {
            if !told.contains(&other.experiment.as_str()) {
                told.push(&other.experiment);
                let _ = writeln!(
                    text,
                    "{}: {} is {}",
                    key.1,
                    other.experiment,
                    seen::apart(first, other)
                );
            }
        }
        if let Some(path) = path {
            let stem = match every.iter().all(is_same) {
                true => "bode".to_owned(),
                false => format!("bode-{}", file_name(&first.output)),
            };
            files.extend(both(&stem, &draw::drawn(title, &same)));
            files.push((format!("{stem}.csv"), draw::csv(&same).into_bytes()));
            let _ = writeln!(text, "{}", path(&format!("{stem}.svg")));
        }
    }
    if let Some(path) = path {
        let page = to_html(&page::page(title, all, made));
        files.push(("bode.html".to_owned(), page.into_bytes()));
        let _ = writeln!(text, "{}", path("bode.html"));
        let loops: Vec<_> = all.iter().flat_map(|asked| &asked.margins).collect();
        for one in &loops {
            let suffix = match loops.as_slice() {
                [_] => String::new(),
                _ => format!("-{}-{}", file_name(&one.experiment), file_name(&one.signal)),
            };
            for (stem, figure) in &open_loop::figures(title, one) {
                let stem = format!("{stem}{suffix}");
                files.extend(both(&stem, figure));
                let _ = writeln!(text, "{}", path(&format!("{stem}.svg")));
            }
            let csv = open_loop::csv(one).into_bytes();
            files.push((format!("open-loop{suffix}.csv"), csv));
        }
    }
    (text, files)
}

/// A figure as SVG and PNG.
fn both(stem: &str, figure: &Figure) -> [File; 2] {
    [
        (format!("{stem}.svg"), to_svg(figure).into_bytes()),
        (format!("{stem}.png"), to_png(figure, 2.0)),
    ]
}

/// What one experiment asks for.
fn of_experiment(asked: &Responses, took: Option<Duration>, several: bool) -> String {
    let program = &asked.compiled.program;
    let mut text = match (&asked.run, took) {
        (Some(own), Some(took)) => summary::text(&asked.project, &own.compiled, &own.run, took),
        _ if several => format!("{} of {}\n", asked.name, program.name),
        _ => String::new(),
    };
    for (number, bode) in asked.bodes.iter().enumerate() {
        if let Some(unstable) = assumed::unstable(program, &bode.linear, &bode.poles)
            && !text.contains(&unstable)
        {
            text.insert_str(0, &unstable);
        }
        let before = asked.bodes[..number].iter();
        let told = before.flat_map(|bode| &bode.responses).any(|known| {
            let new = bode.responses.first();
            new.is_some_and(|new| known.input == new.input && known.output == new.output)
        });
        text.push_str(&of_responses(bode, told));
        let about = assumed::text(program, &bode.linear, bode.time);
        if !text.contains(&about) {
            text.push_str(&about);
        }
        if let Some(own) = &bode.stepped {
            let program = &own.compiled.program;
            let told = stepped::told(program, &bode.input, &bode.responses, &own.points);
            text.push_str(&told);
        }
        let measured = bode.responses.iter().flat_map(|own| &own.measured);
        let mut measured: Vec<&Compared> = measured.collect();
        measured.sort_by_key(|one| one.number);
        text.push_str(&measured::table(&measured));
    }
    for one in &asked.margins {
        text.push_str(&margins::text(one));
        let point = assumed::text(program, &one.linear, one.time);
        if !text.contains(&point) {
            text.push_str(&point);
        }
    }
    // A run has told them before.
    if asked.run.is_none() {
        text.push_str(&assumptions::text(&asked.notes));
    }
    text
}

/// The band, the modes and the peaks of the responses of one `bode`; those of the modes once for responses that were told.
fn of_responses(bode: &OfBode, told: bool) -> String {
    let mut text = String::new();
    let stepped = bode.stepped.is_some();
    if stepped || !told {
        let _ = writeln!(
            text,
            "from {} over {} .. {} Hz{}",
            bode.input,
            significant(bode.band.0, 3),
            significant(bode.band.1, 3),
            if stepped { ", stepped" } else { "" }
        );
    }
    if told {
        return text;
    }
    let first = bode.responses.first();
    for (frequency, damping) in first.map_or(&[][..], |response| &response.resonances) {
        let _ = writeln!(
            text,
            "  mode at {:>8} Hz, damping {:<8} {}",
            significant(*frequency, 4),
            significant(*damping, 2),
            seen::where_seen(*frequency, &bode.responses)
        );
    }
    for response in &bode.responses {
        let _ = writeln!(
            text,
            "  {}: {}",
            response.output,
            seen::peaks_told(response)
        );
    }
    text
}

/// The unit of an output over that of the input, for people, with how many of it one of SI is.
fn drawn(response: &Response) -> (String, f64) {
    let (of, per) = &response.units;
    let Some(per) = per else {
        return (String::new(), 1.0);
    };
    let (of, drawn) = difference_in(of);
    let (per, given) = difference_in(per);
    let text = match (shown(&of), shown(&per)) {
        (of, "") => of.to_owned(),
        ("", per) => format!("1/{per}"),
        (of, per) => format!("{of} per {per}"),
    };
    (text, given.to_si(drawn.from_si(1.0)))
}

fn of_bode(bode: &[Response], about: &Map<String, Value>) -> Value {
    let outputs: Vec<Value> = bode
        .iter()
        .map(|response| {
            let stepped: Vec<Value> = response
                .stepped
                .iter()
                .map(|(f, amplitude, found)| {
                    json!({
                        "frequency_hz": f, "amplitude": amplitude, "re_im": [found.response.re, found.response.im],
                        "coherence": found.coherence, "distortion": found.distortion,
                    })
                })
                .collect();
            let measured: Vec<Value> = response.measured.iter().map(measured::json).collect();
            json!({ "name": response.output, "re_im": response.linear, "stepped": stepped, "measured": measured })
        })
        .collect();
    let first = bode.first();
    let mut found = json!({
        "experiment": first.map(|response| &response.experiment),
        "input": first.map(|response| &response.input),
        "frequency_hz": first.map(|response| &response.frequency),
        "modes": first.map(|response| &response.resonances),
        "outputs": outputs,
    });
    for (key, value) in about {
        found[key] = value.clone();
    }
    found
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
