//! [`prepared`]: a diagnosis on its way to its search: its block, and the calibration that it stands on.

use crate::asked::Asked;
use crate::calibration::{Calibration, calibration, chosen};
use crate::project::Loaded;
use crate::refused::Refused;
use hyde_compiler::DiagnosisPlan;
use hyde_syntax::ast::{Study, StudyKind};

/// Makes the diagnosis of a file that is loaded, with the whole library: the one named, or the file's only one.
///
/// # Errors
/// There is none of that name; its block, its calibration, its model or its records are at fault.
pub fn prepared(
    loaded: Loaded,
    asked: &Asked,
    name: Option<&str>,
) -> Result<(DiagnosisPlan, Calibration), Refused> {
    let mut loaded = loaded;
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let studies = loaded.file.studies();
    let studies: Vec<&Study> = studies
        .filter(|study| study.kind == StudyKind::Diagnose)
        .collect();
    let study = chosen(&studies, name, "diagnosis").map_err(Refused::Asked)?;
    let name = study.name.text.clone();
    let Some(plan) = DiagnosisPlan::read(&loaded.file, &name, &mut loaded.diagnostics) else {
        return Err(loaded.refused());
    };
    let calibration = calibration(loaded, asked, Some(&plan.calibration))?;
    Ok((plan, calibration))
}
