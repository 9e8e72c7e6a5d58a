//! The stability margins of the loops that an experiment cuts.

use crate::Project;
use crate::operating_point;
use hyde_diag::{Code, Diagnostic, Diagnostics};
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
        let message = format!(
            "the loop needs the derivative of `{}` by the time, which a test signal does not have",
            cut.signal
        );
        let help = "open the loop at another signal: at the output of the controller, or before the differentiation";
        let diagnostic = Diagnostic::error(Code::CannotCut, message);
        let diagnostic = diagnostic.label(cut.origin.span, "differentiated by what reads it");
        return Err(Box::new(diagnostic.help(help)));
    }
    let input = std::slice::from_ref(&cut.input);
    let constant = |which| program.kernels.constant(which, p);
    let time = operating_point::moment(asked, cut.at, constant(Constant::CutAt(number)));
    let time = time.map_err(|reason| {
        let diagnostic = Diagnostic::error(Code::NoResponse, reason);
        Box::new(diagnostic.label(cut.origin.span, "linearised there"))
    })?;
    let about = About {
        time,
        modes: &[modes, &cut.modes].concat(),
        ..About::default()
    };
    let linear = linearize_about(program, tables, p, input, about).map_err(|error| {
        let diagnostic = Diagnostic::error(Code::NoResponse, operating_point::why_not(&error));
        Box::new(diagnostic.label(cut.origin.span, "the loop has no response here"))
    })?;
    let band = constant(Constant::SearchedFrom(number)).zip(constant(Constant::SearchedTo(number)));
    let found = margins(program, &linear, cut, band).map_err(|error| refused(cut, error))?;
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

fn refused(cut: &Cut, error: CutError) -> Box<Diagnostic> {
    let signal = &cut.signal;
    let (code, message, label, help) = match error {
        CutError::SampledLoop => (
            Code::CannotCut,
            format!(
                "`{signal}` is continuous, but clocks close its loop: it has no single open-loop response"
            ),
            "continuous, in a sampled loop",
            "cut where the loop is sampled: at a clocked variable, or at a signal that is `hold(…)` of one",
        ),
        CutError::SlowerClock => (
            Code::CannotCut,
            format!(
                "`{signal}` is in a loop with a slower clock: its response differs from tick to tick"
            ),
            "sampled faster than its loop",
            "cut at a signal of the slowest clock of the loop, or open the outer loop: set its gain to 0",
        ),
        CutError::Reversed => (
            Code::CannotCut,
            format!(
                "the equation of `{signal}` does not determine it: other equations do, so its direction is not defined"
            ),
            "no signal with a direction",
            "cut at a signal of the loop: an input, an output or a clocked variable; or let the loop read one: `Angle measured = rotor.phi;`",
        ),
        CutError::NotHeld => (
            Code::CannotCut,
            format!("no clocked part is held: `{signal}` drives nothing"),
            "in no loop",
            "cut at a signal whose value the model reads",
        ),
        CutError::EmptyBand => (
            Code::NoResponse,
            "the band of frequencies is empty".to_owned(),
            "nothing to search",
            "write `over 1 .. 500 [Hz]`, of a sampled loop below half its rate",
        ),
        CutError::Singular(f) => (
            Code::NoResponse,
            format!("the loop is singular at {} Hz", significant(f, 3)),
            "no response there",
            "search beside it: `over 1 .. 500 [Hz]`",
        ),
    };
    let diagnostic = Diagnostic::error(code, message);
    Box::new(diagnostic.label(cut.origin.span, label).help(help))
}
