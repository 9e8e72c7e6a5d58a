//! What a calibration may vary of a model, by name.

use crate::refusals::calibrations as refused;
use hyde_calibrate::{CalibrationPlan, Per, Varied, Vary};
use hyde_diag::Diagnostic;
use hyde_program::{Given, Parameter, Program};
use hyde_units::Kind;

/// A parameter of a model that a calibration varies, and of what it has a value each.
pub(super) type Own = (Varied, Option<Per>);

/// What may be varied of a model, by name; `elsewhere` says what another model of the calibration has.
pub(super) fn varied(
    plan: &CalibrationPlan,
    program: &Program,
    p: &[f64],
    elsewhere: &dyn Fn(Option<&str>) -> bool,
    wrong: &mut Vec<Diagnostic>,
) -> Vec<Own> {
    let mut found: Vec<Own> = Vec::new();
    for vary in &plan.vary {
        match vary {
            Vary::Uncertain(span) => {
                let uncertain = Varied::uncertain(program, p);
                let steps = program.parameters.iter().filter(|q| q.prior.is_some());
                for (parameter, kind) in steps.filter_map(|q| Some((q, only_steps(q)?))) {
                    let name = &parameter.name;
                    wrong.push(refused::uncertain_step(
                        (name, kind),
                        *span,
                        parameter.origin.span,
                    ));
                }
                if uncertain.is_empty() && !elsewhere(None) {
                    wrong.push(refused::nothing_uncertain(*span));
                }
                found.extend(uncertain.into_iter().map(|own| (own, None)));
            }
            Vary::Parameter {
                name,
                bounds,
                per,
                span,
            } => {
                let mut own = Varied::of(program, name, p);
                let known = program.parameter(name).map(|(parameter, _)| parameter);
                if let Some((parameter, kind)) = known.and_then(|q| Some((q, only_steps(q)?)))
                    && !parameter.is_final
                {
                    wrong.push(refused::varies_by_steps((name, kind), *span));
                    continue;
                }
                let problem = match program.parameter(name) {
                    None if elsewhere(Some(name)) => None,
                    None => Some("no such parameter".to_owned()),
                    Some((parameter, _)) if parameter.structural => Some(
                        "it changes the structure of the equations: each value is a separate model"
                            .to_owned(),
                    ),
                    Some((parameter, _)) if parameter.is_final => Some("it is final".to_owned()),
                    Some((parameter, _)) => bounds.as_ref().and_then(|(from, to, unit)| {
                        let misfit = |value| {
                            let (unit, truth) = (Some(unit), false);
                            parameter.misfit(&Given { value, unit, truth })
                        };
                        let misfit = misfit(*from).or_else(|| misfit(*to))?;
                        let help = misfit
                            .help()
                            .map_or(String::new(), |help| format!("; {help}"));
                        Some(format!("it {}{help}", misfit.reason))
                    }),
                };
                if let Some(problem) = problem {
                    wrong.push(refused::cannot_vary(name, *span, &problem));
                }
                if let Some((from, to, _)) = bounds {
                    own.iter_mut()
                        .for_each(|varied| varied.bounds = (*from, *to));
                }
                found.extend(own.into_iter().map(|own| (own, per.clone())));
            }
        }
    }
    // Named after `uncertain`, a parameter has the bounds given to it.
    let mut last: Vec<Own> = Vec::new();
    for own in found {
        last.retain(|(other, _)| other.place != own.0.place);
        last.push(own);
    }
    last
}

/// What a parameter is that changes by whole steps alone, and does not change the equations.
fn only_steps(parameter: &Parameter) -> Option<&'static str> {
    match parameter.allowed.kind {
        Kind::Real => None,
        Kind::Integer | Kind::Boolean if parameter.structural => None,
        Kind::Integer => Some("an Integer"),
        Kind::Boolean => Some("a Boolean"),
    }
}
