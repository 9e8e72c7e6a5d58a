//! The studies on records that the arguments name, loaded by [`hyde_study`]; what is wrong with them is printed.

use crate::args::{ModelArgs, StudyArgs};
use crate::exit::Exit;
use crate::project::{self, Asked, Loaded, Told as _, complain};
use hyde_compiler::DiagnosisPlan;
use hyde_study::excitation::{self, Comparison, Options, Wished};
use hyde_study::selftest::Designs;
use hyde_study::{Calibration, JointCalibration, Project, Refused};

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
        hyde_study::diagnosis::prepared(loaded, asked, args.study.as_deref())
    })?;
    calibration.project.print_warnings(&model_args);
    Ok((plan, calibration))
}

/// Makes the signals of a self-test on the model of its calibration. Effects of all packages may be put on the model.
pub(crate) fn designs(
    args: &StudyArgs,
    calibration: &Calibration,
    options: Options,
) -> Result<Designs, Exit> {
    let model_args = ModelArgs {
        whole_library: true,
        ..args.model_args()
    };
    loaded(&model_args, |loaded, asked| {
        Designs::new(&loaded, asked, calibration, options)
    })
}

/// Compares signals on the model of a calibration.
pub(crate) fn comparison(
    model_args: &ModelArgs,
    study: Option<&str>,
    options: (&Options, Wished),
) -> Result<Comparison, Exit> {
    loaded(model_args, |loaded, asked| {
        let ready = |project: &Project| project.print_warnings(model_args);
        excitation::compared(loaded, asked, study, options, ready)
    })
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
