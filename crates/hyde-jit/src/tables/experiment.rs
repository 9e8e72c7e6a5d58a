//! The table of an experiment: measures, what is measured, responses, figures.

use crate::flows::flows;
use crate::{figures, ledger};
use hyde_ir::dae::Dae;
use hyde_ir::flat;
use hyde_ir::{Expr, ExprId, Id as _, VariableKind};
use hyde_program::{
    Bode, Cut, Experiment, Measure, Measured, MeasuredResponse, Moment, RecordedResponse,
    Reduction, Replayed, ScaledColumn, Stepped,
};

/// What is asked of a run, with the outputs that it reads.
pub(super) fn experiment(dae: &Dae) -> Experiment {
    let known = &dae.experiment;
    let columns: usize = dae.outputs.iter().map(|output| output.names.len()).sum();
    let responses: usize = known.bodes.iter().map(|bode| bode.outputs.len()).sum();
    let first_account = columns - ledger::columns(&known.ledger);
    let first_curve = first_account - figures::outputs(&known.figures);
    let first_cut = first_curve - known.cuts.len();
    let (conditions, margins) = (known.conditions().count(), known.margins().count());
    let first_response = first_cut - responses;
    let first_margin = first_response - margins;
    let first_reduction = first_margin - conditions - known.reductions.len();
    let first_replayed = first_reduction - 2 * known.replayed.len();
    let first_measured = first_replayed - known.measured.len();
    let first_condition = first_reduction + known.reductions.len();
    let mut conditions_before = first_condition..;
    let mut margins_before = first_margin..;
    let mut next_response = first_response;
    Experiment {
        name: known.name.clone(),
        records: known.records.clone(),
        measured: known
            .measured
            .iter()
            .zip(first_measured..)
            .map(|(measured, output)| Measured {
                name: measured.name.clone(),
                source: {
                    let column = &dae.columns[measured.column];
                    (column.record.clone(), column.column.clone())
                },
                preparation: measured.preparation.clone(),
                output,
                clocked: measured.clocked,
                late: measured.late.clone(),
                unit: measured.quantity.unit.clone(),
                origin: measured.origin.clone(),
            })
            .collect(),
        replayed: known
            .replayed
            .iter()
            .zip((first_replayed..).step_by(2))
            .map(|(replayed, output)| Replayed {
                name: replayed.name.clone(),
                column: replayed.column.map(|column| column.index()),
                output,
                recorded: output + 1,
                register: replayed.register.clone(),
                origin: replayed.origin.clone(),
            })
            .collect(),
        reductions: known
            .reductions
            .iter()
            .zip(first_reduction..)
            .map(|(reduction, output)| Reduction {
                kind: reduction.kind,
                text: dae.variables[reduction.var].name.to_string(),
                output,
                condition: reduction.condition.and_then(|_| conditions_before.next()),
                margins: margins_before
                    .by_ref()
                    .take(reduction.margins.len())
                    .collect(),
            })
            .collect(),
        measures: known
            .measures
            .iter()
            .map(|measure| Measure {
                name: measure.name.clone(),
                expectation: measure.expectation,
                reductions: reductions_read(dae, measure.value),
                unit: measure.quantity.unit.clone(),
                origin: measure.origin.clone(),
            })
            .collect(),
        bodes: known
            .bodes
            .iter()
            .map(|bode| {
                let name = dae.variables[bode.input.0].element_name(bode.input.1);
                let outputs = bode
                    .outputs
                    .iter()
                    .map(|(name, ..)| {
                        next_response += 1;
                        (name.clone(), next_response - 1)
                    })
                    .collect();
                let mut at = 0;
                let mut input_output = None;
                for output in &dae.outputs {
                    if let Some(place) = output.names.iter().position(|own| *own == name) {
                        input_output = Some(at + place);
                        break;
                    }
                    at += output.names.len();
                }
                Bode {
                    input: name,
                    input_output,
                    outputs,
                    at: moment(bode.at),
                    modes: chosen_modes(&bode.modes),
                    stepped: bode.stepped.as_ref().map(|stepped| Stepped {
                        keep: stepped.keep.map(|(output, _)| output),
                    }),
                    origin: bode.origin.clone(),
                }
            })
            .collect(),
        differentiated: known
            .differentiated
            .iter()
            .map(|&param| dae.parameters[param].name.clone())
            .collect(),
        cuts: known
            .cuts
            .iter()
            .zip(first_cut..)
            .map(|(cut, back)| Cut {
                signal: cut.signal.clone(),
                input: cut.input.clone(),
                back,
                clock: cut.clock.map(|clock| clock.index()),
                at: moment(cut.at),
                modes: chosen_modes(&cut.modes),
                origin: cut.origin.clone(),
            })
            .collect(),
        figures: figures::figures(&known.figures, first_curve),
        flows: flows(dae),
        measured_responses: known
            .measured_responses
            .iter()
            .map(|measured| measured_response(dae, measured))
            .collect(),
        ledger: ledger::ledger(&known.ledger, first_account),
        method: known.method,
        conserve: known.conserve,
    }
}

fn moment(at: flat::Moment) -> Moment {
    match at {
        flat::Moment::Start => Moment::Start,
        flat::Moment::At(_) => Moment::At,
        flat::Moment::Steady => Moment::Steady,
    }
}

fn chosen_modes(modes: &[(hyde_ir::AutomatonId, usize)]) -> Vec<(usize, usize)> {
    let chosen = modes.iter();
    chosen
        .map(|(automaton, mode)| (automaton.index(), *mode))
        .collect()
}

/// The reductions that an expression reads.
fn reductions_read(dae: &Dae, value: ExprId) -> Vec<usize> {
    let nodes = dae.exprs.below(&[value]).into_iter();
    let number = |id| {
        if let Expr::Var(var, _) = dae.exprs[id]
            && let VariableKind::Reduction(number) = dae.variables[var].kind
        {
            Some(number)
        } else {
            None
        }
    };
    nodes.filter_map(number).collect()
}

fn measured_response(dae: &Dae, measured: &flat::MeasuredResponse) -> MeasuredResponse {
    let of = |scaled: &flat::ScaledColumn| {
        let column = &dae.columns[scaled.column];
        ScaledColumn {
            record: column.record.clone(),
            column: column.column.clone(),
            scale: scaled.scale,
        }
    };
    MeasuredResponse {
        name: measured.name.clone(),
        source: match &measured.source {
            flat::RecordedResponse::Complex(re, im) => RecordedResponse::Complex(of(re), of(im)),
            flat::RecordedResponse::Polar(gain, phase) => {
                RecordedResponse::Polar(of(gain), of(phase))
            }
            flat::RecordedResponse::Periodic(input, output, period) => {
                RecordedResponse::Periodic(of(input), of(output), *period)
            }
        },
        deviation: measured.deviation.as_ref().map(of),
        place: measured.place,
        origin: measured.origin.clone(),
    }
}
