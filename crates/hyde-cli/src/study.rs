//! The studies on records that the arguments name, loaded by [`hyde_study`]; what is wrong with them is printed.

use crate::args::{ModelArgs, StudyArgs};
use crate::exit::Exit;
use crate::project::{self, Asked, Loaded, Told as _, complain};
use hyde_compiler::DiagnosisPlan;
use hyde_study::excitation::Bench;
use hyde_study::{Calibration, JointCalibration, Refused};
use hyde_units::NamedUnit;

/// Loads the calibration that the arguments name.
pub(crate) fn calibration(args: &StudyArgs) -> Result<JointCalibration, Exit> {
    let model_args = args.model_args();
    let calibration = loaded(&model_args, |loaded, asked| {
        hyde_study::joint_calibration(loaded, asked, args.study.as_deref())
    })?;
    for (number, own) in calibration.experiments.iter().enumerate() {
        let model = &own.project.model;
        let before = &calibration.experiments[..number];
        if !before.iter().any(|known| known.project.model == *model) {
            own.project.print_warnings(&model_args);
        }
    }
    Ok(calibration)
}

/// Loads the diagnosis that the arguments name. Effects of packages that the model itself need not use may be named.
pub(crate) fn diagnosis(args: &StudyArgs) -> Result<(DiagnosisPlan, Calibration), Exit> {
    let model_args = ModelArgs {
        whole_library: true,
        ..args.model_args()
    };
    let (plan, calibration) = loaded(&model_args, |loaded, asked| {
        hyde_study::diagnosis(loaded, asked, args.study.as_deref())
    })?;
    calibration.project.print_warnings(&model_args);
    Ok((plan, calibration))
}

/// Loads the model of a calibration, for records that are to be designed.
pub(crate) fn bench(
    model_args: &ModelArgs,
    study: Option<&str>,
    step_s: f64,
    column: Option<&str>,
    unit: &NamedUnit,
) -> Result<Bench, Exit> {
    let bench = loaded(model_args, |loaded, asked| {
        hyde_study::excitation::bench(loaded, asked, study, step_s, column, unit)
    })?;
    bench.project.print_warnings(model_args);
    Ok(bench)
}

/// What is made of the file that the arguments name, parsed once.
fn loaded<T>(
    args: &ModelArgs,
    make: impl FnOnce(Loaded, &Asked) -> Result<T, Refused>,
) -> Result<T, Exit> {
    let asked = project::asked(args)?;
    let loaded = Loaded::of(&asked);
    let loaded = loaded.map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
    make(loaded, &asked).map_err(|own| project::refused(args, &own))
}
