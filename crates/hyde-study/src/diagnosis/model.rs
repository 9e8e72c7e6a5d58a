//! The model that has what was missing, its parameters calibrated with it.

use super::{Diagnosed, named};
use crate::unknown;
use hyde_calibrate::Relation;
use hyde_compiler::{Calibrated, Candidate, Found, Written, write_back};
use hyde_units::NamedUnit;

/// The user's file with the new model and its experiment behind.
pub(super) fn written(
    told: &Diagnosed<'_>,
    candidates: &[Candidate],
    own: &[&hyde_calibrate::Written],
) -> Written {
    let project = &told.calibration.project;
    // The text of an effect that was written has its values already.
    let own_candidates: Vec<Candidate> = own.iter().map(|own| unknown::candidate(own)).collect();
    let mut found: Vec<Found<'_>> = Vec::new();
    for finding in &told.found.findings {
        let Some(candidate) = candidates.get(finding.hypothesis) else {
            continue;
        };
        let declared = |name: &str| {
            let mut knobs = candidate.sizes.iter().chain(&candidate.shapes);
            knobs.any(|knob| knob.name == name)
        };
        let quantities = finding.sizes.iter().chain(&finding.shapes);
        // The phase of a sine and a cosine is in their sizes.
        let values = quantities
            .filter(|quantity| declared(&quantity.name))
            .map(|quantity| (quantity.name.clone(), quantity.value))
            .collect();
        found.push(Found { candidate, values });
    }
    found.extend(own_candidates.iter().map(|candidate| Found {
        candidate,
        values: Vec::new(),
    }));
    let program = &told.calibration.compiled.program;
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&told.calibration.set, &mut p);
    let unit = |name: &str| {
        let known = program.parameter(name);
        known.map_or_else(
            || NamedUnit::usual(hyde_units::Dimension::DIMENSIONLESS),
            |(parameter, _)| parameter.unit.clone(),
        )
    };
    let calibrated_too = |name: &str| told.parameters.iter().any(|(_, new)| new.name == name);
    let set = project.set().into_iter();
    let set = set.filter(|(name, _)| !calibrated_too(name));
    let new = told.parameters.iter();
    let new = new.map(|(_, new)| (new.name.clone(), new.value));
    let calibrated: Vec<Calibrated> = set
        .chain(new)
        .map(|(path, value)| Calibrated {
            unit: unit(&path),
            path,
            value,
        })
        .collect();
    let records: Vec<&str> = told
        .calibration
        .fitted
        .iter()
        .map(|recording| recording.name.as_str())
        .collect();
    let mut about = vec![format!(
        "Found by `hyde diagnose`, {} of {}, in {}:",
        told.plan.name,
        told.calibration.plan.model,
        records.join(", ")
    )];
    about.push(format!("{}.", super::verdict::sentence(told)));
    for finding in &told.found.findings {
        for other in finding.related(Relation::Another) {
            about.push(format!(
                "In these records it cannot be distinguished from {}.",
                named(&told.hypotheses[other.hypothesis])
            ));
        }
        let repeated = super::verdict::repeated(told, finding).into_iter();
        about.extend(repeated.map(|own| format!("{own}.")));
    }
    let files = project.file.files.first();
    let mut text = files.map_or_else(String::new, |(file, _)| {
        project.sources.get(*file).text.clone()
    });
    for own in own {
        text = format!("{}\n\n{}", text.trim_end(), own.text);
    }
    write_back(
        &project.file,
        &text,
        (&project.model, project.experiment.as_deref()),
        (&found, &calibrated),
        (program, &p),
        &about,
    )
}
