//! The last run of each file: what a hover shows of its variables, at an instant that the user chooses; and why it failed.

use crate::analysis::{Analysis, Identity};
use crate::course;
use crate::lens::{Choice, Instant};
use crate::occurrences::Occurrence;
use crate::outcome::{Courses, Failure, Label};
use crate::position::Encoding;
use crate::server::Server;
use crate::uri;
use hyde_diag::Span;
use hyde_syntax::ast::Item;
use hyde_units::{Dimension, NamedUnit, format_value, significant};
use lsp_types::{
    DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString, Range,
};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Instances of a variable that a hover shows.
const SHOWN: usize = 4;
/// The source of diagnostics that ended a run.
pub(crate) const OF_RUN: &str = "hyde run";
/// A lens goes on or back by this part of a run.
const STEP: f64 = 0.05;

/// A run that was asked for.
pub(crate) struct Ran {
    pub(crate) experiment: String,
    /// The text that was run.
    pub(crate) text: String,
    pub(crate) courses: Courses,
    /// Whether it ended before its end.
    pub(crate) failed: bool,
    /// The instant that is shown; the last one if none was chosen.
    pub(crate) instant: Option<f64>,
}

/// The last run of each file.
#[derive(Default)]
pub(crate) struct Runs {
    of: BTreeMap<PathBuf, Ran>,
}

impl Runs {
    /// Takes the place of the last run of a file.
    pub(crate) fn put(&mut self, path: &Path, mut ran: Ran) {
        let known = self
            .of
            .get(path)
            .filter(|own| own.experiment == ran.experiment);
        ran.instant = known.and_then(|own| own.instant);
        self.of.insert(path.to_path_buf(), ran);
    }

    /// Forgets a file.
    pub(crate) fn forget(&mut self, path: &Path) {
        self.of.remove(path);
    }

    /// Chooses the instant of a run; false if there is no such run.
    pub(crate) fn choose(&mut self, chosen: &Instant) -> bool {
        let own = self.of.get_mut(&chosen.file);
        let Some(own) = own.filter(|own| own.experiment == chosen.experiment) else {
            return false;
        };
        own.instant = chosen.time_s;
        true
    }

    /// What stands over an experiment that was run.
    pub(crate) fn lenses(&self, path: &Path, experiment: &str) -> Vec<Choice> {
        let own = self.of.get(path);
        let own = own.filter(|own| own.experiment == experiment);
        let Some((own, span)) = own.and_then(|own| Some((own, own.span()?))) else {
            return Vec::new();
        };
        let at = own.at().unwrap_or(span.1);
        let step = STEP * (span.1 - span.0);
        let choice = |title: &str, time_s: Option<f64>| Choice {
            title: title.to_owned(),
            time_s,
        };
        vec![
            choice(&format!("Values at {}", seconds(at)), None),
            choice("Earlier", Some((at - step).max(span.0))),
            choice("Later", Some((at + step).min(span.1))),
        ]
    }
}

impl Ran {
    /// The first and the last instant.
    fn span(&self) -> Option<(f64, f64)> {
        Some((*self.courses.time.first()?, *self.courses.time.last()?))
    }

    /// The instant that is shown.
    fn at(&self) -> Option<f64> {
        let (first, last) = self.span()?;
        Some(self.instant.map_or(last, |own| own.clamp(first, last)))
    }
}

/// Lines about a name that means a variable: its values in the last run, in each instance.
pub(crate) fn of_name(server: &Server, analysis: &Analysis, found: &Occurrence<'_>) -> Vec<String> {
    let Some(meaning) = found.meaning else {
        return Vec::new();
    };
    let identity = analysis.identity(&meaning);
    let path = dotted(analysis.text(), found.span.end as usize);
    let runs = server.runs.borrow();
    let each = runs.of.iter();
    each.flat_map(|(file, ran)| lines(server, (file, ran), &identity, &path))
        .collect()
}

/// The values of a variable in a run.
fn lines(
    server: &Server,
    (file, ran): (&Path, &Ran),
    identity: &Identity,
    path: &str,
) -> Vec<String> {
    let Some(at) = ran.at() else {
        return Vec::new();
    };
    let courses = &ran.courses;
    let names = instances(server, (file, ran), identity, path);
    // A variable with elements has a course for each.
    let elements = |name: &String| {
        let first = format!("{name}[");
        let own = courses.list.iter();
        own.filter(move |own| own.name == *name || own.name.starts_with(&first))
            .collect::<Vec<_>>()
    };
    let all: Vec<_> = names.iter().flat_map(elements).collect();
    let shown = all.iter().take(SHOWN);
    let mut lines: Vec<String> = shown
        .filter_map(|own| course::line(own, &courses.time, at))
        .collect();
    if lines.is_empty() {
        return lines;
    }
    if all.len() > SHOWN {
        lines.push(format!("… and {} more", all.len() - SHOWN));
    }
    let old = match server.text(file).as_deref() == Some(ran.text.as_str()) {
        true => "",
        false => " of the text before its last change",
    };
    let end = match (ran.instant, ran.failed) {
        (None, true) => ", where it failed",
        (None, false) => ", its end",
        (Some(_), _) => "",
    };
    let experiment = &ran.experiment;
    lines.insert(
        0,
        format!("run `{experiment}`{old} at {}{end}:", seconds(at)),
    );
    lines
}

/// The full names of the variable that is declared at a place, in the model of a run; only those that end with the path that is
/// written there, if some do.
fn instances(
    server: &Server,
    (file, ran): (&Path, &Ran),
    identity: &Identity,
    path: &str,
) -> Vec<String> {
    let Some(analysis) = server.analysis(file) else {
        return Vec::new();
    };
    let is_run = |item: &Item| match item {
        Item::Experiment(own) => own.name.text == ran.experiment,
        Item::Class(_) | Item::Type(_) | Item::Study(_) => false,
    };
    let number = analysis.items().position(|(item, _)| is_run(item));
    let Some(meaning) = number.and_then(|number| analysis.meaning(number)) else {
        return Vec::new();
    };
    // A package of the library has a name; where it is open, it has a path that ends with it.
    let is_here = |span: Span| {
        let own = analysis.identity_of(span);
        own.start == identity.start && Path::new(&identity.source).ends_with(&own.source)
    };
    let here = meaning.names.iter().filter(|(span, _)| is_here(*span));
    let all: Vec<String> = here.map(|(_, name)| name.clone()).collect();
    let ends = |name: &&String| {
        let rest = name.strip_suffix(path);
        rest.is_some_and(|rest| rest.is_empty() || rest.ends_with('.'))
    };
    let meant: Vec<String> = all.iter().filter(ends).cloned().collect();
    match path.contains('.') && !meant.is_empty() {
        true => meant,
        false => all,
    }
}

/// The path that ends at a byte: `axis.guide.v`.
fn dotted(text: &str, end: usize) -> String {
    let before = text.get(..end).unwrap_or_default();
    let is_path = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
    let start = before.rfind(|c: char| !is_path(c)).map_or(0, |at| {
        at + before[at..].chars().next().map_or(1, char::len_utf8)
    });
    before[start..].to_owned()
}

fn seconds(time_s: f64) -> String {
    format_value(
        significant(time_s, 6).parse().unwrap_or(time_s),
        &NamedUnit::usual(Dimension::TIME),
    )
}

/// A failure in the text of a file: at its first equation there, or at the experiment.
pub(crate) fn marked(
    failure: &Failure,
    (path, text): (&Path, &str),
    experiment: &str,
    encoding: Encoding,
) -> lsp_types::Diagnostic {
    let own = |label: &&Label| Path::new(&label.file) == path;
    let shown = failure.labels.iter().find(own);
    let range = match shown {
        Some(label) => range_of(label, text, encoding),
        None => {
            let name = format!("experiment {experiment}");
            let at = text.find(&name).map_or(0..0, |at| at..at + name.len());
            encoding.range(text, at)
        }
    };
    let mut message = failure.message.clone();
    if let Some(label) = shown {
        message.push_str(&format!("\n{}", label.text));
    }
    // What the editor cannot jump to is told in words.
    let other = failure.labels.iter().filter(|own| Some(*own) != shown);
    let mut related = Vec::new();
    for label in other {
        match uri::of(Path::new(&label.file)) {
            Some(uri) if Path::new(&label.file) == path => {
                related.push(DiagnosticRelatedInformation {
                    location: Location::new(uri, range_of(label, text, encoding)),
                    message: label.text.clone(),
                });
            }
            _ => message.push_str(&format!(
                "\n{}: {}:{}",
                label.text, label.file, label.from.0
            )),
        }
    }
    for note in &failure.notes {
        message.push_str(&format!("\nnote: {note}"));
    }
    if let Some(help) = &failure.help {
        message.push_str(&format!("\nhelp: {help}"));
    }
    lsp_types::Diagnostic {
        range,
        severity: Some(DiagnosticSeverity::ERROR),
        code: Some(NumberOrString::String(failure.code.clone())),
        source: Some(format!("{OF_RUN} {experiment}")),
        message,
        related_information: (!related.is_empty()).then_some(related),
        ..lsp_types::Diagnostic::default()
    }
}

/// The range of a label in its text.
fn range_of(label: &Label, text: &str, encoding: Encoding) -> Range {
    let byte = |(line, column): (usize, usize)| {
        let lines = text.split_inclusive('\n');
        let start: usize = lines.take(line.saturating_sub(1)).map(str::len).sum();
        let rest = text.get(start..).unwrap_or_default();
        let letters = rest.char_indices().nth(column.saturating_sub(1));
        start + letters.map_or(rest.len(), |(at, _)| at)
    };
    let from = byte(label.from);
    encoding.range(text, from..byte(label.to).max(from))
}
