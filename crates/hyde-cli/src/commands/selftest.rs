//! `hyde selftest`: what the verdicts of a diagnosis are worth on this axis, with these sensors and these records.

use crate::args::{CaseKind, SelftestArgs};
use crate::batch::progress::Shown;
use crate::batch::store::Journals;
use crate::exit::Exit;
use crate::files;
use crate::interruption;
use crate::project::{Told as _, complain, print_error, print_output};
use crate::study;
use hyde_calibrate::{Asked, Size, Thresholds};
use hyde_experiment::batch::{Identity, digest};
use hyde_present::selftest::{json, text};
use hyde_study::Store;
use hyde_study::excitation;
use hyde_study::selftest::{Ended, Options, Subject, Tested, records_of, selftest as tested};
use hyde_units::counted;
use std::path::Path;

/// Plants, diagnoses, counts.
pub(crate) fn selftest(args: &SelftestArgs) -> Exit {
    match told(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn told(args: &SelftestArgs) -> Result<Exit, Exit> {
    let model_args = args.study.model_args();
    let refused = |reason: String| complain(&model_args, Exit::CommandLine, &reason);
    args.study.use_jobs().map_err(refused)?;
    let options = options(args).map_err(refused)?;
    let (plan, mut calibration) = study::diagnosis(&args.study)?;
    let candidates = calibration.project.candidates_or_report(&model_args)?;
    let laws = calibration.project.laws_or_report(&model_args)?;
    let signal = signal(args).map_err(refused)?;
    let designs = signal.map(|signal| study::designs(&args.study, &calibration, signal));
    let designs = designs.transpose()?;
    let subject = Subject {
        plan: &plan,
        calibration: &calibration,
        candidates,
        laws,
        thresholds: Thresholds::default(),
        designs: designs.as_ref(),
    };
    let told = match (&args.case, &args.out) {
        (Some(name), Some(folder)) => {
            let files = records_of(subject, &options, name);
            files.map(|files| leave(folder, &files))
        }
        (_, out) => {
            let keep = |identity: &Identity| {
                let store = out.as_ref().map(|folder| store(folder, identity));
                let store = store.transpose()?;
                Ok(store.map(|own| Box::new(own) as Box<dyn Store>))
            };
            let shown = Shown::new(false, args.study.json || args.study.quiet);
            tested(subject, &options, keep, &shown, |found| tell(args, found))
        }
    };
    match told {
        Ok(told) => told.map(|()| Exit::Done).map_err(refused),
        Err(Ended::Asked(reason)) => Err(refused(reason)),
        Err(Ended::Interrupted(done)) => {
            if let Some(done) = done {
                interrupted(args, done);
            }
            Ok(Exit::Interrupted)
        }
        Err(Ended::Cannot(diagnostic)) => {
            calibration.project.diagnostics.push(*diagnostic);
            Err(calibration.project.finish_with_errors(&model_args))
        }
    }
}

/// Prints what was found, and leaves it where a folder is asked for.
fn tell(args: &SelftestArgs, found: &Tested<'_>) -> Result<(), String> {
    let report = format!("{:#}", json(found));
    if let Some(folder) = &args.out {
        let path = folder.join("selftest.json");
        files::write(&path, format!("{report}\n").as_bytes())?;
    }
    if args.study.json {
        print_output(&report);
    } else if !args.study.quiet {
        print_output(text(found).trim_end());
    }
    Ok(())
}

/// Says what is kept of a self-test that was interrupted.
fn interrupted(args: &SelftestArgs, (done, total): (usize, usize)) {
    let kept = match &args.out {
        Some(folder) => format!(
            "; they are kept in `{}`: run the command again to resume",
            folder.display()
        ),
        None => "; use `--out DIR` to keep finished cases".to_owned(),
    };
    let total = counted(total, "case");
    print_error(&format!("interrupted after {done} of {total}{kept}"));
}

/// Leaves the records of a case.
fn leave(folder: &Path, records: &[(String, String)]) -> Result<(), String> {
    files::make_folder(folder)?;
    let mut records = records.iter();
    records.try_for_each(|(name, text)| files::write(&folder.join(name), text.as_bytes()))
}

/// What the arguments ask for.
fn options(args: &SelftestArgs) -> Result<Options, String> {
    Ok(Options {
        asked: asked(args)?,
        sample: args.sample,
        seed: args.seed,
        interrupted: interruption::interrupted(),
    })
}

/// The signal that the arguments ask for, if verdicts `one of` are to be diagnosed again with a designed record.
fn signal(args: &SelftestArgs) -> Result<Option<excitation::Options>, String> {
    let limits = &args.limits;
    let motion = limits.motion();
    if !args.designed {
        let mut all = motion.iter().chain([&limits.effort]);
        return match all.any(Option::is_some) {
            false => Ok(None),
            true => Err(
                "limits are those of a designed record, and none is asked for\n  help: add `--designed`"
                    .to_owned(),
            ),
        };
    }
    Ok(Some(excitation::Options {
        motion,
        effort: limits.effort.clone(),
        duration: args.duration.clone(),
        band: args.band.clone(),
        column: args.column.clone(),
        ..excitation::Options::default()
    }))
}

/// The cases that the arguments ask for.
fn asked(args: &SelftestArgs) -> Result<Asked, String> {
    let size = |text: &String| {
        let times = text.strip_suffix('x');
        let number = times.unwrap_or(text).trim().parse::<f64>().ok();
        match (number.filter(|number| *number > 0.0), times) {
            (Some(number), Some(_)) => Ok(Size::Detectable(number)),
            (Some(number), None) if number <= 1.0 => Ok(Size::Part(number)),
            (Some(_) | None, _) => Err(format!(
                "`{text}` is not a size: write a fraction of the range, `0.1`, or a multiple of the smallest detectable size, `2x`"
            )),
        }
    };
    let sizes: Result<Vec<Size>, String> = args.sizes.iter().map(size).collect();
    let wanted = |kind| args.only.is_empty() || args.only.contains(&kind);
    Ok(Asked {
        effects: args.effects.clone(),
        sizes: sizes?,
        seeds: args.seeds.max(1),
        empties: if wanted(CaseKind::Empty) {
            args.empties
        } else {
            0
        },
        planted: wanted(CaseKind::Planted),
        parameters: wanted(CaseKind::Parameters),
        open_set: wanted(CaseKind::Unknown),
        sensors: wanted(CaseKind::Sensors),
    })
}

/// The store of a folder; cases of another axis, seed or program are in others beside it.
fn store(folder: &Path, identity: &Identity) -> Result<Journals, String> {
    let identity = with_program(identity)?;
    files::make_folder(folder)?;
    let own: String = identity.0[..6].iter().map(|b| format!("{b:02x}")).collect();
    Journals::open(&folder.join(format!("journal-{own}")), identity)
}

/// The identity with that of this very program: another one may judge otherwise.
fn with_program(identity: &Identity) -> Result<Identity, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    Ok(digest(&[&identity.0, &files::read(&program)?]))
}
