//! An experiment compiled for its linearised model, with the operating point that is asked for.

use crate::operating_point;
use crate::settings::Setting;
use crate::{Aim, Project, Refused, run_failure};
use hyde_compiler::Compiled;
use hyde_experiment::parameters;
use hyde_program::{Constant, Moment, Program};
use hyde_signal::Table;
use hyde_sim::PointTime;
use std::collections::BTreeMap;

/// An operating point as it is asked for; what it leaves out the experiment says.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// `0.3 [s]`, `start` or `steady`.
    pub at: Option<String>,
    /// Modes to linearise in: `guide=slip`.
    pub in_modes: Vec<String>,
}

/// An experiment ready to be linearised.
pub struct Prepared {
    /// The model and the experiment.
    pub project: Project,
    /// The model, compiled.
    pub compiled: Compiled,
    /// Its records.
    pub tables: BTreeMap<String, Table>,
    /// Its parameters.
    pub parameters: Vec<f64>,
    /// Modes of automata.
    pub chosen: Vec<(usize, usize)>,
    /// The operating point.
    pub time: PointTime,
}

impl Prepared {
    /// Compiles an experiment for its linearised model, with one more parameter set if so.
    ///
    /// # Errors
    /// The model is at fault, or there is no such operating point.
    pub fn new(
        mut project: Project,
        point: &Point,
        set: Option<&Setting>,
    ) -> Result<Self, Refused> {
        project.settings.extend(set.cloned());
        let compiled = match project.compile(Aim::Linearize) {
            Ok(compiled) => compiled,
            Err(fault) => return Err(project.refused(fault)),
        };
        let program = &compiled.program;
        let tables = crate::tables(&project.records);
        let parameters = match parameters(program, &tables, &project.set()) {
            Ok(parameters) => parameters,
            Err(error) => {
                let (diagnostic, fault) = run_failure::diagnostic(&error, program, None);
                project.diagnostics.push(diagnostic);
                return Err(project.refused(fault));
            }
        };
        let (mut chosen, moment, time) = asked_point(program, &parameters);
        for text in &point.in_modes {
            let mode = operating_point::in_mode(program, text).map_err(Refused::Asked)?;
            chosen.insert(0, mode);
        }
        let time = operating_point::moment(point.at.as_deref(), moment, time);
        Ok(Self {
            time: time.map_err(Refused::Asked)?,
            project,
            compiled,
            tables,
            parameters,
            chosen,
        })
    }

    /// The project as a refusal, as its run does not come to the operating point.
    pub(crate) fn no_point(mut self, failure: Box<hyde_sim::Failure>) -> Refused {
        let error = hyde_experiment::RunError::Failed(failure);
        let (diagnostic, fault) = run_failure::diagnostic(&error, &self.compiled.program, None);
        self.project.diagnostics.push(diagnostic);
        self.project.refused(fault)
    }
}

/// The operating point that the experiment asks for: modes of automata, and the moment with its time if it has one.
pub fn asked_point(
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
