//! What a run reports: every variable of the model, then what the experiment measures and reduces.

use crate::layout::alias;
use crate::system::System;
use hyde_diag::MadeBy;
use hyde_ir::dae::{Alias, Dae, Output};
use hyde_ir::flat;
use hyde_ir::{BinaryOp, Expr, ExprId, Index, Quantity, Range, VariableKind};
use std::collections::BTreeSet;

/// Arrays longer than this are not reported element by element: more columns than a person looks at.
const MAX_ELEMENTS: usize = 32;

/// What results call the time.
const TIME: &str = "t";

/// What results call a variable `t` of the model.
#[must_use]
pub fn beside_time() -> String {
    format!("variable {TIME}")
}

/// Fills in the outputs of the DAE.
pub(crate) fn report(dae: &mut Dae, system: &mut System) {
    let mut skipped = Vec::new();
    let hidden: Vec<_> = system
        .groups
        .iter()
        .filter_map(|group| group.factors)
        .collect();
    let observed = system.flat.experiment.observed;
    let reported: Vec<_> = dae.variables.ids().filter(|_| !observed).collect();
    for id in reported {
        let variable = dae.variables[id].clone();
        if hidden.contains(&id) || variable.origin.made_by == MadeBy::Expression {
            continue;
        }
        let discrete = match variable.kind {
            VariableKind::Continuous => false,
            VariableKind::Discrete | VariableKind::Clocked(_) => true,
            VariableKind::Held(..)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => {
                continue;
            }
        };
        let (range, index) = match variable.len {
            None => (Range::SCALAR, Index::SCALAR),
            Some(len) if len <= MAX_ELEMENTS => (
                Range {
                    first: 0,
                    last: i32::try_from(len).unwrap_or(0) - 1,
                },
                Index::COUNTER,
            ),
            Some(_) => {
                skipped.push(variable.name.clone());
                continue;
            }
        };
        if range.is_empty() {
            continue;
        }
        let (value, discrete) = match alias(dae, id) {
            Some(Alias::Value(value)) => (value, true),
            Some(Alias::Of {
                var,
                element,
                negated,
            }) => {
                let index = Index::fixed(i32::try_from(element).unwrap_or(0));
                let value = dae.exprs.add(Expr::Var(var, index));
                let held = !matches!(
                    dae.variables[var].kind,
                    VariableKind::Continuous | VariableKind::Delayed(_)
                );
                (
                    if negated {
                        dae.exprs.negative(value)
                    } else {
                        value
                    },
                    discrete || held,
                )
            }
            None if dae.place(id).is_none() => continue,
            None => (dae.exprs.add(Expr::Var(id, index)), discrete),
        };
        let names = (0..variable.size())
            .map(|element| variable.element_name(element))
            .map(|name| if name == TIME { beside_time() } else { name })
            .collect();
        dae.outputs.push(Output {
            names,
            range,
            value,
            quantity: variable.quantity,
            discrete,
        });
    }
    if !skipped.is_empty() {
        dae.notes.push(format!(
            "not reported, more than {MAX_ELEMENTS} elements: {}",
            skipped.join(", ")
        ));
    }
    let experiment = &system.flat.experiment;
    dae.experiment = experiment.clone();
    let mut reductions = std::mem::take(&mut dae.experiment.reductions);
    for reduction in &mut reductions {
        reduction.margins = margins(dae, reduction);
    }
    dae.experiment.reductions = reductions;
    let single = |name: String, value, quantity: &Quantity, discrete| Output {
        names: vec![name],
        range: Range::SCALAR,
        value,
        quantity: quantity.clone(),
        discrete,
    };
    for measured in &experiment.measured {
        let name = format!("measured {}", measured.name);
        dae.outputs.push(single(
            name,
            measured.value,
            &measured.quantity,
            measured.clocked,
        ));
    }
    for replayed in &experiment.replayed {
        let values = [
            ("model has for", replayed.value),
            ("replayed for", replayed.recorded),
        ];
        for (what, value) in values {
            let name = format!("{what} {}", replayed.name);
            dae.outputs
                .push(single(name, value, &replayed.quantity, true));
        }
    }
    for (number, reduction) in experiment.reductions.iter().enumerate() {
        let quantity = dae.variables[reduction.var].quantity.clone();
        dae.outputs.push(single(
            format!("reduction {number}"),
            reduction.value,
            &quantity,
            false,
        ));
    }
    let plain = Quantity::usual(hyde_units::Dimension::DIMENSIONLESS);
    for condition in experiment.conditions() {
        let name = "condition of a reduction".to_owned();
        dae.outputs.push(single(name, condition, &plain, false));
    }
    for margin in dae.experiment.margins().collect::<Vec<_>>() {
        let name = "margin of a reduction".to_owned();
        dae.outputs.push(single(name, margin, &plain, false));
    }
    for (name, value, quantity) in experiment.bodes.iter().flat_map(|bode| &bode.outputs) {
        dae.outputs
            .push(single(format!("response {name}"), *value, quantity, false));
    }
    for cut in &experiment.cuts {
        let name = format!("cut {}", cut.signal);
        dae.outputs
            .push(single(name, cut.back, &Quantity::number(), false));
    }
    for curve in experiment.figures.iter().flat_map(flat::Figure::curves) {
        let name = format!("curve {}", curve.name);
        dae.outputs
            .push(single(name, curve.value, &curve.quantity, false));
    }
    for account in &experiment.ledger.accounts {
        let name = account.component.member(&account.name);
        for (range, value) in &account.pieces {
            dae.outputs.push(Output {
                names: range.iter().map(|_| format!("account {name}")).collect(),
                range: *range,
                value: *value,
                quantity: plain.clone(),
                discrete: false,
            });
        }
    }
    for port in &experiment.ledger.ports {
        let name = format!("port {}", port.component);
        for value in [port.flow, port.potential] {
            dae.outputs.push(single(name.clone(), value, &plain, false));
        }
    }
}

/// a - b of each comparison of `a` with `b` in what a reduction reads, itself or through explicit scalars: those of equations that
/// are events are relations by now.
fn margins(dae: &mut Dae, reduction: &flat::Reduction) -> Vec<ExprId> {
    let mut open: Vec<ExprId> = std::iter::once(reduction.value)
        .chain(reduction.condition)
        .collect();
    let (mut seen, mut compared) = (BTreeSet::new(), Vec::new());
    while let Some(root) = open.pop() {
        for id in dae.exprs.below(&[root]) {
            if let Expr::Binary(op, a, b) = dae.exprs[id] {
                use BinaryOp::{Ge, Gt, Le, Lt};
                if [Lt, Le, Gt, Ge].contains(&op) {
                    compared.push((a, b));
                }
            } else if let Expr::Var(var, _) = dae.exprs[id]
                && dae.variables[var].len.is_none()
                && seen.insert(var)
            {
                let definitions = dae.definitions.iter();
                let own = definitions.filter(|own| own.var == var && !own.slope);
                open.extend(own.map(|own| own.value));
            }
        }
    }
    let margins = compared
        .into_iter()
        .map(|(a, b)| dae.exprs.binary(BinaryOp::Sub, a, b));
    let mut margins: Vec<ExprId> = margins.collect();
    margins.retain(|margin| dae.exprs.as_constant(*margin).is_none());
    margins.sort_unstable();
    margins.dedup();
    margins
}
