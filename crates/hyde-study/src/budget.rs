//! [`budget`]: which imperfection of a model contributes how much to the measures of an experiment.

use crate::asked::Asked;
use crate::runs::{How, project_of, solved};
use crate::{Fault, Loaded, Project, Refused};
use hyde_compiler::{changed, ideals};
use hyde_experiment::BudgetOf;
use hyde_syntax::ast::{Experiment, Ideal};
use hyde_units::NamedUnit;

/// What came out.
pub struct Budget {
    /// The experiment and the model.
    pub title: String,
    /// The imperfections.
    pub ideals: Vec<Ideal>,
    /// Each measure with its unit and what it is made of.
    pub measures: Vec<(String, NamedUnit, BudgetOf)>,
}

/// Why there is no budget: the reason, and which of the runs it is about if it is not the first.
pub struct NoBudget {
    /// The reason.
    pub refused: Refused,
    /// `with all of the budget ideal`
    pub of: Option<String>,
}

/// The measures of one run, in their order.
type Measures = Vec<(String, NamedUnit, f64)>;

/// Runs the experiment as it is, with all ideal, without each imperfection and with it alone. `ready` gets the model before it
/// is run.
///
/// # Errors
/// The experiment has no budget, or one of the runs fails.
pub fn budget(
    loaded: &Loaded,
    asked: &Asked,
    how: &How,
    ready: impl FnOnce(&Project),
) -> Result<Budget, NoBudget> {
    let first = |refused: Refused| NoBudget { refused, of: None };
    let load = || project_of(loaded, asked);
    let project = load().map_err(first)?;
    let experiment = of_experiment(&project).map_err(|reason| first(Refused::Asked(reason)))?;
    let model = project.model.clone();
    let ideals: Vec<Ideal> = ideals(&experiment).cloned().collect();
    let experiment = experiment.name.text;
    let real = measures(project, how, ready).map_err(first)?;
    if real.is_empty() {
        return Err(first(Refused::Asked(format!(
            "`{experiment}` has no `measure`: add the error to be split, `measure Length lag = max(abs(r - s));`"
        ))));
    }
    let run = |what: String, chosen: &dyn Fn(&Ideal) -> bool| -> Result<Measures, NoBudget> {
        let found = load().and_then(|mut project| {
            project.file = project.file.idealised(&experiment, chosen);
            measures(project, how, |_| {})
        });
        found.map_err(|refused| NoBudget {
            refused,
            of: Some(what),
        })
    };
    let all = run("with all of the budget ideal".to_owned(), &|_| true)?;
    let mut each = Vec::new();
    for ideal in &ideals {
        let name = &ideal.name.text;
        let without = run(format!("without `{name}`"), &|other| {
            other.name.text == *name
        })?;
        let alone = run(format!("with `{name}` alone"), &|other| {
            other.name.text != *name
        })?;
        each.push((without, alone));
    }
    let measures = real
        .into_iter()
        .enumerate()
        .map(|(number, (name, unit, value))| {
            let of = |measures: &Measures| measures[number].2;
            let each: Vec<(f64, f64)> = each.iter().map(|(a, b)| (of(a), of(b))).collect();
            (name, unit, BudgetOf::new(value, of(&all), &each))
        });
    Ok(Budget {
        title: format!("{experiment} of {model}"),
        measures: measures.collect(),
        ideals,
    })
}

/// The experiment, if it has a budget and nothing set from outside is part of it.
fn of_experiment(project: &Project) -> Result<Experiment, String> {
    let mut known = project.file.experiments();
    let name = project.experiment.as_deref();
    let Some(experiment) = known.find(|known| name == Some(known.name.text.as_str())) else {
        return Err("a budget needs an experiment, and the file has none".to_owned());
    };
    if ideals(experiment).next().is_none() {
        return Err(format!(
            "`{}` has no `budget`: list the imperfections with their ideal values, `budget play(nut.gap = 0), belt(belt.k = 1e9 [N/m]);`",
            experiment.name.text
        ));
    }
    for ideal in ideals(experiment) {
        let changed = changed(ideal);
        let both = project
            .settings
            .iter()
            .find(|setting| changed.contains(&setting.path));
        if let Some(setting) = both {
            return Err(format!(
                "`--set {}` sets a parameter that `{}` of the budget varies",
                setting.path, ideal.name.text
            ));
        }
    }
    Ok(experiment.clone())
}

/// Runs, and takes the measures.
fn measures(
    project: Project,
    how: &How,
    ready: impl FnOnce(&Project),
) -> Result<Measures, Refused> {
    let (compiled, run) = solved(project, how, ready)?;
    let mut missing = run
        .measures
        .iter()
        .filter(|measure| measure.missing.is_some());
    if let Some(measure) = missing.next() {
        let why = measure.missing.as_ref();
        let why = why.map_or(String::new(), |missing| format!(": {}", missing.text()));
        let reason = format!("`{}` has no value{why}", measure.name);
        return Err(Refused::Because(reason, Fault::Expectation));
    }
    let both = run
        .measures
        .iter()
        .zip(&compiled.program.experiment.measures);
    let measures = both.filter(|(measure, _)| !measure.expectation);
    Ok(measures
        .map(|(measure, known)| (measure.name.clone(), known.unit.clone(), measure.value))
        .collect())
}
