//! The head of every page: from what, with what and when it was made; and the model in words and as a picture.

use hyde_report::{Block, Diagram, DiagramPart, Section};
use hyde_study::Project;
use hyde_study::topology::topology;
use hyde_syntax::Lookup;
use hyde_syntax::ast::{Experiment, Item};

/// Digits of the hash of the file that are shown; all are in the JSON file beside the page.
const DIGITS: usize = 12;
/// A picture of more parts than these shows nothing.
const MOST_PARTS: usize = 60;

/// File, model, experiment, version, hash and date; `made` says when the page is made.
pub fn facts(project: &Project, made: &str) -> Vec<(String, String)> {
    facts_of_all(&[project], made)
}

/// The same of several experiments of one file.
pub fn facts_of_all(projects: &[&Project], made: &str) -> Vec<(String, String)> {
    let Some(first) = projects.first() else {
        return Vec::new();
    };
    let file = first.sources.iter().next();
    let file = file.map_or("", |(_, source)| source.name.as_str());
    let hash = first.hash.get(..DIGITS).unwrap_or(&first.hash);
    let models = projects.iter().map(|project| project.model.clone());
    let mut facts = vec![("Model", each_once(models).join(", "))];
    let experiments = projects.iter().filter_map(|project| {
        let name = project.experiment.as_ref()?;
        let doc = experiment(project, name).and_then(|own| own.doc.clone());
        Some(doc.map_or_else(|| name.clone(), |doc| format!("{name}: {doc}")))
    });
    let experiments = each_once(experiments);
    if !experiments.is_empty() {
        facts.push(("Experiment", experiments.join("; ")));
    }
    facts.push(("File", format!("{file}, SHA-256 {hash}…")));
    facts.push((
        "Made",
        format!("{made} by Hyde {}", env!("CARGO_PKG_VERSION")),
    ));
    let owned = |(name, value): (&str, String)| (name.to_owned(), value);
    facts.into_iter().map(owned).collect()
}

/// Texts in their order, none twice.
fn each_once(texts: impl Iterator<Item = String>) -> Vec<String> {
    let mut found = Vec::new();
    for text in texts {
        if !found.contains(&text) {
            found.push(text);
        }
    }
    found
}

/// The models of several experiments, each once.
pub fn models(projects: &[&Project]) -> Vec<Section> {
    let mut sections: Vec<Section> = Vec::new();
    let several = projects
        .iter()
        .any(|own| projects.first().is_some_and(|one| one.model != own.model));
    for project in projects {
        let Some(mut section) = model(project) else {
            continue;
        };
        if several {
            section.heading = format!("Model {}", project.model);
        }
        if !sections.contains(&section) {
            sections.push(section);
        }
    }
    sections
}

/// What the model says of itself, and its components with their connections; nothing of a model without either.
pub fn model(project: &Project) -> Option<Section> {
    let (_, own) = project.file.files.first()?;
    let doc = own.items.iter().find_map(|item| match item {
        Item::Class(class) if class.name.text == project.model => class.doc.clone(),
        Item::Class(_) | Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
    });
    let mut blocks: Vec<Block> = doc.map(Block::Text).into_iter().collect();
    let lookup = Lookup {
        files: &project.file.files,
    };
    let known = topology(lookup, &project.model);
    let shown = !known.joints.is_empty() || !known.signals.is_empty();
    if shown && known.parts.len() <= MOST_PARTS {
        let part = |part: &hyde_study::topology::Part| DiagramPart {
            name: part.name.clone(),
            class: part.class.clone(),
        };
        blocks.push(Block::Diagram(Diagram {
            parts: known.parts.iter().map(part).collect(),
            joints: known.joints,
            signals: known.signals,
        }));
    }
    let heading = "Model".to_owned();
    (!blocks.is_empty()).then_some(Section { heading, blocks })
}

fn experiment<'p>(project: &'p Project, name: &str) -> Option<&'p Experiment> {
    let (_, own) = project.file.files.first()?;
    own.items.iter().find_map(|item| match item {
        Item::Experiment(experiment) if experiment.name.text == name => Some(experiment),
        Item::Experiment(_) | Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
    })
}
