//! Lenses over experiments and diagnoses, and what their commands run.

use crate::position::Encoding;
use hyde_syntax::ast::{ExperimentItem, File, Item, Name, StudyKind};
use lsp_types::{CodeLens, Command};
use serde_json::{Value, json};
use std::path::PathBuf;

/// What a lens runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Action {
    /// `hyde run`
    Run,
    /// `hyde bode`
    Bode,
    /// `hyde modes`
    Modes,
    /// `hyde diagnose`
    Diagnose,
}

impl Action {
    const ALL: [Self; 4] = [Self::Run, Self::Bode, Self::Modes, Self::Diagnose];

    /// The command of the editor.
    fn command(self) -> &'static str {
        match self {
            Self::Run => "hyde.run",
            Self::Bode => "hyde.bode",
            Self::Modes => "hyde.modes",
            Self::Diagnose => "hyde.diagnose",
        }
    }

    /// What stands over the experiment.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Run => "Run",
            Self::Bode => "Bode",
            Self::Modes => "Modes",
            Self::Diagnose => "Diagnose",
        }
    }

    fn of_command(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|own| own.command() == name)
    }
}

/// A command that an editor asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Order {
    /// What is to be run.
    pub action: Action,
    /// The model's file.
    pub file: PathBuf,
    /// The experiment or the study.
    pub name: String,
}

/// The command that chooses the instant of the values in hovers.
const AT: &str = "hyde.at";

/// The instant of a run whose values hovers show.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Instant {
    pub(crate) file: PathBuf,
    pub(crate) experiment: String,
    /// In s; the end of the run if there is none.
    pub(crate) time_s: Option<f64>,
}

/// What stands over an experiment that was run.
pub(crate) struct Choice {
    pub(crate) title: String,
    /// The instant that it chooses, in s; the end of the run if there is none.
    pub(crate) time_s: Option<f64>,
}

/// The commands that the server knows.
pub(crate) fn commands() -> Vec<String> {
    let all = Action::ALL.into_iter().map(Action::command);
    all.chain([AT]).map(str::to_owned).collect()
}

/// The instant in a request.
pub(crate) fn instant(command: &str, arguments: &[Value]) -> Option<Instant> {
    let text = |number: usize| arguments.get(number).and_then(Value::as_str);
    let uri: lsp_types::Uri = text(0).filter(|_| command == AT)?.parse().ok()?;
    Some(Instant {
        file: crate::uri::path(&uri)?,
        experiment: text(1)?.to_owned(),
        time_s: arguments.get(2).and_then(Value::as_f64),
    })
}

/// The order in a request.
pub(crate) fn order(command: &str, arguments: &[Value]) -> Option<Order> {
    let text = |number: usize| arguments.get(number).and_then(Value::as_str);
    let uri: lsp_types::Uri = text(0)?.parse().ok()?;
    Some(Order {
        action: Action::of_command(command)?,
        file: crate::uri::path(&uri)?,
        name: text(1)?.to_owned(),
    })
}

/// The lenses of a file.
/// Behind those of an experiment stand what `ran` says of its last run.
pub(crate) fn lenses(
    tree: &File,
    text: &str,
    uri: &str,
    encoding: Encoding,
    ran: &dyn Fn(&str) -> Vec<Choice>,
) -> Vec<CodeLens> {
    let mut found = Vec::new();
    let mut add = |name: &Name, actions: &[Action]| {
        let bytes = name.span.start as usize..name.span.end as usize;
        let range = encoding.range(text, bytes);
        found.extend(actions.iter().map(|own| CodeLens {
            range,
            command: Some(Command {
                title: own.title().to_owned(),
                command: own.command().to_owned(),
                arguments: Some(vec![json!(uri), json!(name.text)]),
            }),
            data: None,
        }));
        if actions.contains(&Action::Run) {
            found.extend(ran(&name.text).into_iter().map(|own| CodeLens {
                range,
                command: Some(Command {
                    title: own.title,
                    command: AT.to_owned(),
                    arguments: Some(vec![json!(uri), json!(name.text), json!(own.time_s)]),
                }),
                data: None,
            }));
        }
    };
    for item in &tree.items {
        match item {
            Item::Experiment(own) => {
                let response = |item: &ExperimentItem| {
                    matches!(item, ExperimentItem::Bode(_) | ExperimentItem::Margins(_))
                };
                match own.items.iter().any(response) {
                    true => add(&own.name, &[Action::Run, Action::Bode, Action::Modes]),
                    false => add(&own.name, &[Action::Run, Action::Modes]),
                }
            }
            Item::Study(own) if own.kind == StudyKind::Diagnose => {
                add(&own.name, &[Action::Diagnose]);
            }
            Item::Study(_) | Item::Class(_) | Item::Type(_) => {}
        }
    }
    found
}
