//! An experiment compiled for its linearised system, with the operating point that the command line and the experiment ask
//! for.

use crate::args::{AboutArgs, ModelArgs};
use crate::exit::Exit;
use crate::project::{self, Aim, Project, Records, Told as _, complain};
use hyde_compiler::Compiled;
use hyde_experiment::parameters;
use hyde_program::{Constant, Moment, Program};
use hyde_signal::Table;
use hyde_sim::PointTime;
use hyde_study::operating_point;
use hyde_study::settings::Setting;
use std::collections::BTreeMap;

/// An experiment ready to be linearised.
pub(crate) struct Prepared {
    pub(crate) project: Project,
    pub(crate) compiled: Compiled,
    pub(crate) tables: BTreeMap<String, Table>,
    pub(crate) parameters: Vec<f64>,
    /// Modes of automata.
    pub(crate) chosen: Vec<(usize, usize)>,
    /// The operating point.
    pub(crate) time: PointTime,
}

/// Compiles an experiment for its linearised system, with one more parameter set if so.
pub(crate) fn prepared(
    about: &AboutArgs,
    model: &ModelArgs,
    set: Option<&Setting>,
) -> Result<Prepared, Exit> {
    let mut project = project::load(model, Records::Needed)?;
    project.settings.extend(set.cloned());
    let compiled = project.compile_or_report(model, Aim::Linearize)?;
    project.print_warnings(model);
    let program = &compiled.program;
    let wrong = |reason: String| complain(model, Exit::CommandLine, &reason);
    let tables = hyde_study::tables(&project.records);
    let parameters = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(model, program, &error))?;
    let (mut chosen, moment, time) = asked_point(program, &parameters);
    for text in &about.in_modes {
        chosen.insert(0, operating_point::in_mode(program, text).map_err(wrong)?);
    }
    let time = operating_point::moment(about.at.as_deref(), moment, time).map_err(wrong)?;
    Ok(Prepared {
        project,
        compiled,
        tables,
        parameters,
        chosen,
        time,
    })
}

/// The operating point that the experiment asks for: modes of automata, and the moment with its time if it has one.
pub(crate) fn asked_point(
    program: &Program,
    parameters: &[f64],
) -> (Vec<(usize, usize)>, Moment, Option<f64>) {
    let experiment = &program.experiment;
    let constant = |which| program.kernels.constant(which, parameters);
    let bode = experiment.bodes.first();
    let modes = bode.map(|bode| bode.modes.clone()).unwrap_or_default();
    let of_bode = bode.map(|bode| (bode.at, Constant::RespondsAt(0)));
    let of_cut = || Some((experiment.cuts.first()?.at, Constant::CutAt(0)));
    let (moment, time) = of_bode
        .or_else(of_cut)
        .map_or((Moment::Start, None), |(at, time)| (at, constant(time)));
    (modes, moment, time)
}
