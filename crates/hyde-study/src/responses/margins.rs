//! The stability margins of the loops that an experiment cuts.

use crate::Project;
use crate::operating_point;
use crate::refusals::responses as refused;
use hyde_diag::{Diagnostic, Diagnostics};
use hyde_experiment::{About, CutError, Linear, Margins, Pole, linearize_about, margins, poles};
use hyde_program::{Constant, Cut, Program};
use hyde_signal::Table;
use hyde_sim::PointTime;
use hyde_syntax::ast::Item;
use hyde_units::significant;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A loop that is cut.
pub struct OfLoop {
    /// The experiment.
    pub experiment: String,
    /// The signal, as it is written.
    pub signal: String,
    /// Its margins.
    pub found: Margins,
    /// Poles of the closed loop that grow.
    pub unstable: Vec<Pole>,
    /// The linearised loop, and about what it was asked.
    pub linear: Linear,
    /// That moment.
    pub time: PointTime,
    /// The band was asked for.
    pub given: bool,
}

/// Puts `margins of SIGNAL;` into the experiment, as if it were written there.
pub fn add_cuts(project: &mut Project, signals: &[String]) {
    for signal in signals {
        let text = format!("experiment cut of Model\n  margins of {signal};\nend cut;\n");
        let file = project.sources.add("--cut", &text);
        let tree = hyde_syntax::parse(&project.sources, file, &mut project.diagnostics);
        let items = tree.items.into_iter().filter_map(|item| match item {
            Item::Experiment(experiment) => Some(experiment.items),
            Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        });
        let added: Vec<_> = items.flatten().collect();
        let own = project.file.files.iter_mut().take(1);
        for item in own.flat_map(|(_, tree)| &mut Arc::make_mut(tree).items) {
            if let Item::Experiment(experiment) = item
                && Some(&experiment.name.text) == project.experiment.as_ref()
            {
                experiment.items.extend(added.iter().cloned());
            }
        }
    }
}

/// The margins of every loop that the program cuts; why there are none, where there are not.
pub fn all(
    experiment: &str,
    program: &Program,
    tables: &BTreeMap<String, Table>,
    p: &[f64],
    asked: (Option<&str>, &[(usize, usize)]),
    diagnostics: &mut Diagnostics,
) -> Option<Vec<OfLoop>> {
    let cuts = program.experiment.cuts.iter().enumerate();
    let found: Vec<Option<OfLoop>> = cuts
        .map(|(number, cut)| {
            let of = one(experiment, program, (number, cut), tables, p, asked);
            of.map_err(|diagnostic| diagnostics.push(*diagnostic)).ok()
        })
        .collect();
    found.into_iter().collect()
}

fn one(
    experiment: &str,
    program: &Program,
    (number, cut): (usize, &Cut),
    tables: &BTreeMap<String, Table>,
    p: &[f64],
    (asked, modes): (Option<&str>, &[(usize, usize)]),
) -> Result<OfLoop, Box<Diagnostic>> {
    if program.experiment.differentiated.contains(&cut.input) {
        let needs = refused::loop_needs_derivative(&cut.signal, cut.origin.span);
        return Err(Box::new(needs));
    }
    let input = std::slice::from_ref(&cut.input);
    let constant = |which| program.kernels.constant(which, p);
    let time = operating_point::moment(asked, cut.at, constant(Constant::CutAt(number)));
    let time = time.map_err(|reason| Box::new(refused::no_moment(&reason, cut.origin.span)))?;
    let about = About {
        time,
        modes: &[modes, &cut.modes].concat(),
        ..About::default()
    };
    let linear = linearize_about(program, tables, p, input, about).map_err(|error| {
        let why = operating_point::why_not(&error);
        Box::new(refused::loop_without_response(&why, cut.origin.span))
    })?;
    let band = constant(Constant::SearchedFrom(number)).zip(constant(Constant::SearchedTo(number)));
    let found = margins(program, &linear, cut, band).map_err(|error| cannot_cut(cut, error))?;
    Ok(OfLoop {
        experiment: experiment.to_owned(),
        signal: cut.signal.clone(),
        unstable: poles(&linear).unstable(),
        time: about.time,
        linear,
        found,
        given: band.is_some(),
    })
}

fn cannot_cut(cut: &Cut, error: CutError) -> Box<Diagnostic> {
    let (signal, span) = (&cut.signal, cut.origin.span);
    Box::new(match error {
        CutError::SampledLoop => refused::sampled_loop(signal, span),
        CutError::SlowerClock => refused::slower_clock(signal, span),
        CutError::Reversed => refused::no_direction(signal, span),
        CutError::NotHeld => refused::nothing_held(signal, span),
        CutError::EmptyBand => refused::empty_band(span),
        CutError::Singular(f) => refused::singular_loop(&significant(f, 3), span),
    })
}
