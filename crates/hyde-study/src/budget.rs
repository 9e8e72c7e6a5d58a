//! [`budget`]: which imperfection of a model contributes how much to the measures of an experiment. Every variant is run at the
//! tolerances of the experiment and at tighter ones: what these change is no contribution.

use crate::asked::Asked;
use crate::runs::{How, project_of, solved};
use crate::{Fault, Loaded, Project, Refused};
use hyde_compiler::{Compiled, changed, covers, ideals};
use hyde_experiment::{BudgetOf, Estimate, Run};
use hyde_syntax::ast::{Experiment, Ideal};
use hyde_units::NamedUnit;
use rayon::prelude::*;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The tighter tolerances, as a part of those of the experiment.
const TIGHTER: f64 = 0.1;

/// What came out.
pub struct Budget {
    /// The experiment and the model.
    pub title: String,
    /// The imperfections.
    pub ideals: Vec<Ideal>,
    /// Each measure with its unit and what it is made of.
    pub measures: Vec<(String, NamedUnit, BudgetOf)>,
    /// Relative and absolute tolerance of the experiment.
    pub tolerances: (f64, f64),
}

/// Why there is no budget: the reason, and which of the runs it is about if it is not the first.
pub struct NoBudget {
    /// The reason.
    pub refused: Refused,
    /// `with all of the budget ideal`
    pub of: Option<String>,
}

/// The measures of one run, in their order.
type Measures = Vec<(String, NamedUnit, Estimate)>;

/// A variant of the model.
#[derive(Clone, Copy)]
enum Variant<'m> {
    AllIdeal,
    Without(&'m str),
    Alone(&'m str),
}

impl Variant<'_> {
    /// Whether an imperfection is made ideal.
    fn idealises(self, ideal: &Ideal) -> bool {
        let own = ideal.name.text.as_str();
        match self {
            Self::AllIdeal => true,
            Self::Without(name) => own == name,
            Self::Alone(name) => own != name,
        }
    }

    fn text(self) -> String {
        match self {
            Self::AllIdeal => "with all of the budget ideal".to_owned(),
            Self::Without(name) => format!("without `{name}`"),
            Self::Alone(name) => format!("with `{name}` alone"),
        }
    }
}

/// Runs the experiment as it is, with all ideal, without each imperfection and with it alone, each at its tolerances and at
/// tighter ones; several at once. `how` counts the variants that are done. `ready` gets the model before it is run.
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
    let runs = Runs {
        load,
        how,
        done: AtomicUsize::new(0),
        count: 2 * ideals.len() + 2,
    };
    let (real, tolerances) = runs.measures(&|_| {}, ready).map_err(first)?;
    if real.is_empty() {
        return Err(first(Refused::Asked(format!(
            "`{experiment}` has no `measure`: add the error to be split, `measure Length lag = max(abs(r - s));`"
        ))));
    }
    let each = ideals.iter().map(|ideal| ideal.name.text.as_str());
    let each = each.flat_map(|name| [Variant::Without(name), Variant::Alone(name)]);
    let variants: Vec<Variant<'_>> = std::iter::once(Variant::AllIdeal).chain(each).collect();
    let run = |&variant: &Variant<'_>| {
        let idealised = |project: &mut Project| {
            let chosen = |ideal: &Ideal| variant.idealises(ideal);
            project.file = project.file.idealised(&experiment, chosen);
        };
        let found = runs.measures(&idealised, |_| {});
        found
            .map(|(measures, _)| measures)
            .map_err(|refused| NoBudget {
                refused,
                of: Some(variant.text()),
            })
    };
    let found = variants.par_iter().with_max_len(1).map(run);
    // Of several that fail the first one is told.
    let found: Vec<Result<Measures, NoBudget>> = found.collect();
    let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
    let measures = real
        .into_iter()
        .enumerate()
        .map(|(number, (name, unit, value))| {
            let of = |measures: &Measures| measures[number].2;
            let each = found[1..]
                .chunks(2)
                .map(|both| (of(&both[0]), of(&both[1])));
            let each: Vec<(Estimate, Estimate)> = each.collect();
            (name, unit, BudgetOf::new(value, of(&found[0]), &each))
        });
    Ok(Budget {
        title: format!("{experiment} of {model}"),
        measures: measures.collect(),
        tolerances,
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
        let same = |name: &str, set: &str| covers(name, set) || covers(set, name);
        let both = project
            .settings
            .iter()
            .find(|setting| changed.iter().any(|name| same(name, &setting.path)));
        if let Some(setting) = both {
            return Err(format!(
                "`--set {}` sets a parameter that `{}` of the budget varies",
                setting.path, ideal.name.text
            ));
        }
    }
    Ok(experiment.clone())
}

/// What runs variants, and counts them.
struct Runs<'s, L> {
    load: L,
    how: &'s How,
    done: AtomicUsize,
    count: usize,
}

impl<L: Fn() -> Result<Project, Refused>> Runs<'_, L> {
    /// The measures of a variant with its tolerances, each with its difference from that at tighter ones. Where the variant
    /// cannot be run at these, the errors are not known.
    fn measures(
        &self,
        variant: &dyn Fn(&mut Project),
        ready: impl FnOnce(&Project),
    ) -> Result<(Measures, (f64, f64)), Refused> {
        let own = How {
            reached: Arc::default(),
            ..self.how.clone()
        };
        let (compiled, run) = self.run(variant, &own, ready)?;
        let measures = valued(&run)?;
        let (rtol, atol) = run.tolerances;
        let tighter = How {
            rtol: Some(TIGHTER * rtol),
            atol: Some(TIGHTER * atol),
            ..own
        };
        let tighter = self.run(variant, &tighter, |_| {});
        let tighter = match tighter.and_then(|(_, run)| valued(&run)) {
            Ok(tighter) => Some(tighter),
            Err(refused) if refused.fault() == Fault::Interrupted => return Err(refused),
            Err(_) => None,
        };
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.how.reached.set(done as f64, self.count as f64);
        let known = compiled.program.experiment.measures.iter();
        let known = known.filter(|known| !known.expectation);
        let all = measures.into_iter().zip(known).enumerate();
        let all = all.map(|(number, ((name, value), known))| {
            let tighter = tighter.as_ref().map_or(f64::NAN, |own| own[number].1);
            (
                name,
                known.unit.clone(),
                Estimate::new(value, tighter, rtol),
            )
        });
        Ok((all.collect(), run.tolerances))
    }

    fn run(
        &self,
        variant: &dyn Fn(&mut Project),
        how: &How,
        ready: impl FnOnce(&Project),
    ) -> Result<(Compiled, Run), Refused> {
        let mut project = (self.load)()?;
        variant(&mut project);
        solved(project, how, ready)
    }
}

/// The measures of a run by name.
fn valued(run: &Run) -> Result<Vec<(String, f64)>, Refused> {
    let mut missing = run.measures.iter().filter(|measure| measure.value.is_nan());
    if let Some(measure) = missing.next() {
        let why = measure.missing.as_ref();
        let why = why.map_or(String::new(), |missing| format!(": {}", missing.text()));
        let reason = format!("`{}` has no value{why}", measure.name);
        return Err(Refused::Because(reason, Fault::Expectation));
    }
    let measures = run.measures.iter().filter(|measure| !measure.expectation);
    let measures = measures.map(|measure| (measure.name.clone(), measure.value));
    Ok(measures.collect())
}
