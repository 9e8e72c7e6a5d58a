//! The tables of a [`Program`], from the DAE.

use crate::compiled::Compiled;
use crate::delays::delays;
use crate::flows::flows;
use crate::{figures, ledger};
use hyde_ir::dae::{self, Dae};
use hyde_ir::flat;
use hyde_ir::{Expr, ExprId, Id as _, Interpolation, VariableKind};
use hyde_program::{
    Assignment, Automaton, Bode, Clock, Column, Cut, Derivatives, Experiment, Firmness, Hold,
    InitialCondition, Measure, Measured, MeasuredResponse, Method, Output, Parameter, Pin,
    Preparation, Prior, Program, Reaction, ReactionKind, RecordValue, RecordValueKind,
    RecordedResponse, Reduction, ReductionKind, Relation, RelationUse, ScaledColumn, Selection,
    Stepped, Target, UnknownBlock,
};
use std::sync::Arc;

/// The program of compiled kernels.
pub(crate) fn program(kernels: Compiled) -> Program {
    let dae = &kernels.dae;
    Program {
        name: dae.name.clone(),
        unknowns: unknowns(dae),
        n_unknowns: dae.n_unknowns,
        n_memory: dae.n_memory,
        n_work: dae.n_work,
        n_parameters: dae.n_parameters.1,
        parameters: parameters(dae),
        record_values: record_values(dae),
        columns: columns(dae),
        outputs: outputs(dae),
        relations: dae.relations.iter().map(relation).collect(),
        automata: automata(dae),
        reactions: dae.reactions.iter().map(reaction).collect(),
        assignments: dae
            .assignments
            .iter()
            .map(|assignment| Assignment {
                target: match assignment.target {
                    dae::Target::State(position) => Target::State(position),
                    dae::Target::Memory(position) => Target::Memory(position),
                },
                origin: assignment.origin.clone(),
            })
            .collect(),
        pins: dae
            .pins
            .iter()
            .map(|pin| Pin {
                automaton: pin.automaton.index(),
                mode: pin.mode,
                state: pin.state,
                origin: pin.origin.clone(),
            })
            .collect(),
        selections: dae
            .selections
            .iter()
            .map(|selection| Selection {
                candidates: selection.candidates.clone(),
                constraints: selection.constraints.clone(),
                weights: selection.weights.clone(),
                factors: selection.factors,
            })
            .collect(),
        clocks: dae
            .ticks
            .iter()
            .map(|tick| Clock {
                name: tick.name.clone(),
                origin: tick.origin.clone(),
            })
            .collect(),
        clock_order: dae.tick_order.iter().map(|clock| clock.index()).collect(),
        holds: dae
            .holds
            .iter()
            .map(|hold| Hold {
                clock: hold.clock.index(),
                source: hold.source,
                target: hold.target,
                len: hold.len,
                read: hold.read,
            })
            .collect(),
        delays: delays(dae),
        initial: dae
            .initial
            .iter()
            .map(|condition| initial(dae, condition))
            .collect(),
        derivatives: Derivatives::default(),
        experiment: experiment(dae),
        notes: dae.notes.clone(),
        kernels: Arc::new(kernels),
    }
}

fn unknowns(dae: &Dae) -> Vec<UnknownBlock> {
    dae.unknowns
        .enumerate()
        .map(|(id, block)| {
            let variable = &dae.variables[block.var];
            let first = variable
                .len
                .map(|_| i64::from(variable.first) + i64::try_from(block.first).unwrap_or(0));
            let residual = dae.residuals.iter().find(|residual| residual.unknown == id);
            UnknownBlock {
                name: variable.name.clone(),
                first,
                offset: block.offset,
                len: block.len,
                differential: block.differential,
                origins: residual
                    .map(|residual| residual.origins.clone())
                    .unwrap_or_default(),
            }
        })
        .collect()
}

fn parameters(dae: &Dae) -> Vec<Parameter> {
    let plain = dae
        .parameters
        .enumerate()
        .filter(|(_, parameter)| !parameter.derived);
    plain
        .map(|(id, parameter)| Parameter {
            name: parameter.name.clone(),
            place: dae.parameter_places[id],
            len: parameter.size(),
            dimension: parameter.quantity.dimension,
            unit: parameter.quantity.unit.clone(),
            structural: parameter.structural,
            is_final: parameter.is_final,
            found: parameter.found,
            prior: parameter.prior.map(|prior| match prior {
                hyde_ir::Prior::Relative(part) => Prior::Relative(part),
                hyde_ir::Prior::Absolute(spread) => Prior::Absolute(spread),
            }),
            is_size: parameter.role == hyde_ir::Role::Size,
            allowed: parameter.allowed,
            range: parameter.range,
            source: parameter.source.clone(),
            origin: parameter.origin.clone(),
        })
        .collect()
}

/// `file.begin`, `file.end`, `file.x.first` and `file.x.mean`: parameters whose numbers the record has.
fn record_values(dae: &Dae) -> Vec<RecordValue> {
    let mut found = Vec::new();
    for (id, parameter) in dae.parameters.enumerate() {
        let kinds = [
            (".first", RecordValueKind::First),
            (".mean", RecordValueKind::Mean),
            (".begin", RecordValueKind::First),
            (".end", RecordValueKind::Last),
        ];
        let known = kinds
            .iter()
            .find_map(|(suffix, kind)| Some((parameter.name.strip_suffix(suffix)?, *kind)));
        let Some((path, kind)) = known else {
            continue;
        };
        let (record, column) = match path.split_once('.') {
            Some((record, column)) => (record, Some(column.to_owned())),
            None => (path, None),
        };
        if dae.experiment.records.iter().any(|known| known == record) {
            found.push(RecordValue {
                place: dae.parameter_places[id],
                record: record.to_owned(),
                column,
                kind,
            });
        }
    }
    found
}

fn columns(dae: &Dae) -> Vec<Column> {
    let mut roots = dae.equation_values();
    roots.extend(dae.outputs.iter().map(|output| output.value));
    roots.extend(dae.delays.iter().map(|delay| delay.value));
    let mut read = vec![(false, false); dae.columns.len()];
    for id in dae.exprs.below(&roots) {
        if let hyde_ir::Expr::Var(var, _) = dae.exprs[id]
            && let VariableKind::Column(column, interpolation) = dae.variables[var].kind
        {
            let steps = interpolation == Interpolation::Held || dae.columns[column].next;
            let read = &mut read[column.index()];
            *read = (true, read.1 || steps);
        }
    }
    dae.columns
        .iter()
        .zip(read)
        .map(|(column, (continuous, stepped))| Column {
            record: column.record.clone(),
            column: column.column.clone(),
            next: column.next,
            continuous,
            stepped,
        })
        .collect()
}

fn chosen_modes(modes: &[(hyde_ir::AutomatonId, usize)]) -> Vec<(usize, usize)> {
    let chosen = modes.iter();
    chosen
        .map(|(automaton, mode)| (automaton.index(), *mode))
        .collect()
}

fn outputs(dae: &Dae) -> Vec<Output> {
    let auxiliary_from = dae.outputs.len()
        - dae.experiment.measured.len()
        - dae.experiment.reductions.len()
        - dae.experiment.conditions().count()
        - dae
            .experiment
            .bodes
            .iter()
            .map(|bode| bode.outputs.len())
            .sum::<usize>()
        - dae.experiment.cuts.len()
        - figures::outputs(&dae.experiment.figures)
        - ledger::outputs(&dae.experiment.ledger);
    let mut found = Vec::new();
    for (number, output) in dae.outputs.iter().enumerate() {
        for name in &output.names {
            found.push(Output {
                name: name.clone(),
                dimension: output.quantity.dimension,
                unit: output.quantity.unit.clone(),
                discrete: output.discrete,
                auxiliary: number >= auxiliary_from,
            });
        }
    }
    found
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

fn relation(relation: &dae::Relation) -> Relation {
    Relation {
        inclusive: relation.inclusive,
        scheduled: relation.time_event.is_some(),
        used: match relation.used {
            dae::RelationUse::Equation => RelationUse::Equation,
            dae::RelationUse::Exit(automaton, mode) => {
                RelationUse::Exit(automaton.index(), mode as usize)
            }
            dae::RelationUse::When => RelationUse::When,
            dae::RelationUse::Assert => RelationUse::Assert,
        },
        text: relation.text.clone(),
        origin: relation.origin.clone(),
    }
}

fn automata(dae: &Dae) -> Vec<Automaton> {
    let list = dae.automata.iter();
    list.map(|automaton| Automaton {
        name: automaton.name.clone(),
        modes: automaton.modes.clone(),
        holds_speed: automaton.holds_speed.clone(),
        place: automaton.place,
        origin: automaton.origin.clone(),
    })
    .collect()
}

fn reaction(reaction: &dae::Reaction) -> Reaction {
    Reaction {
        kind: match &reaction.kind {
            dae::ReactionKind::Transition {
                automaton,
                from,
                to,
                impact,
            } => ReactionKind::Transition {
                automaton: automaton.index(),
                from: *from,
                to: *to,
                impact: *impact,
            },
            dae::ReactionKind::When { clause } => ReactionKind::When { clause: *clause },
            dae::ReactionKind::Edge(place) => ReactionKind::Edge(*place),
            dae::ReactionKind::Assert(message) => ReactionKind::Assert(message.clone()),
        },
        assignments: reaction.assignments.clone(),
        text: reaction.text.clone(),
        origin: reaction.origin.clone(),
    }
}

fn initial(dae: &Dae, condition: &dae::InitialCondition) -> InitialCondition {
    match condition {
        dae::InitialCondition::Fixed {
            state,
            len,
            firmness,
            yields,
            origin,
        } => InitialCondition::Fixed {
            state: *state,
            len: *len,
            firmness: match firmness {
                dae::Firmness::Free => Firmness::Free,
                dae::Firmness::Open => Firmness::Open,
                dae::Firmness::Guess => Firmness::Guess,
                dae::Firmness::Default => Firmness::Default,
                dae::Firmness::Given => Firmness::Given,
            },
            yields: *yields,
            origin: origin.clone(),
        },
        dae::InitialCondition::Equation { range, origin, .. } => InitialCondition::Equation {
            len: range.len(),
            origin: origin.clone(),
        },
        dae::InitialCondition::Check { var, .. } => InitialCondition::Check {
            name: dae.variables[*var].name.clone(),
            origin: dae.variables[*var].origin.clone(),
        },
    }
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

fn experiment(dae: &Dae) -> Experiment {
    let known = &dae.experiment;
    let columns: usize = dae.outputs.iter().map(|output| output.names.len()).sum();
    let responses: usize = known.bodes.iter().map(|bode| bode.outputs.len()).sum();
    let first_account = columns - ledger::columns(&known.ledger);
    let first_curve = first_account - figures::outputs(&known.figures);
    let first_cut = first_curve - known.cuts.len();
    let conditions = known.conditions().count();
    let first_measured =
        first_cut - known.measured.len() - known.reductions.len() - conditions - responses;
    let first_reduction = first_measured + known.measured.len();
    let first_condition = first_reduction + known.reductions.len();
    let mut conditions_before = first_condition..;
    let mut next_response = first_condition + conditions;
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
                preparation: measured
                    .preparation
                    .iter()
                    .map(|step| match step {
                        flat::Preparation::Lowpass(corner) => Preparation::Lowpass(*corner),
                        flat::Preparation::Slope => Preparation::Slope,
                        flat::Preparation::Scale(factor) => Preparation::Scale(*factor),
                    })
                    .collect(),
                output,
                clocked: measured.clocked,
                unit: measured.quantity.unit.clone(),
                origin: measured.origin.clone(),
            })
            .collect(),
        reductions: known
            .reductions
            .iter()
            .zip(first_reduction..)
            .map(|(reduction, output)| Reduction {
                kind: match reduction.kind {
                    flat::ReductionKind::Max => ReductionKind::Max,
                    flat::ReductionKind::Min => ReductionKind::Min,
                    flat::ReductionKind::Rms => ReductionKind::Rms,
                    flat::ReductionKind::Mean => ReductionKind::Mean,
                    flat::ReductionKind::First => ReductionKind::First,
                    flat::ReductionKind::Last => ReductionKind::Last,
                    flat::ReductionKind::Integral => ReductionKind::Integral,
                    flat::ReductionKind::Settling => ReductionKind::Settling,
                    flat::ReductionKind::Resonance => ReductionKind::Resonance,
                },
                text: dae.variables[reduction.var].name.to_string(),
                output,
                condition: reduction.condition.and_then(|_| conditions_before.next()),
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
                let name = dae.variables[bode.input].name.clone();
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
                    if output.names.len() == 1 && output.names[0] == name {
                        input_output = Some(at);
                        break;
                    }
                    at += output.names.len();
                }
                Bode {
                    input: name,
                    input_output,
                    outputs,
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
        method: match known.method {
            flat::Method::Ida => Method::Ida,
            flat::Method::Esdirk => Method::Esdirk,
            flat::Method::Auto => Method::Auto,
        },
    }
}
