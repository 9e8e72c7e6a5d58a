//! The tables of a [`Program`], from the DAE.

mod experiment;

use self::experiment::experiment;
use crate::compiled::Compiled;
use crate::delays::delays;
use crate::{figures, ledger};
use hyde_ir::dae::{self, Dae, Target};
use hyde_ir::{ExprId, Id as _, Interpolation, VariableKind};
use hyde_program::{
    Assignment, Clock, Column, Derivatives, ForeignPart, InitialCondition, Output, Parameter, Pin,
    Program, Reaction, RecordValue, RecordValueKind, Relation, UnknownBlock,
};
use rustc_hash::FxHashMap;
use std::sync::Arc;

/// The program of compiled kernels.
pub(crate) fn program(kernels: Compiled) -> Program {
    let dae = &kernels.dae;
    let read = dae.read_by_conditions();
    Program {
        name: dae.name.clone(),
        unknowns: unknowns(dae),
        n_unknowns: dae.n_unknowns,
        n_memory: dae.n_memory,
        affine_in: dae.affine_in(),
        n_work: dae.n_work,
        n_parameters: dae.n_parameters.1,
        parameters: parameters(dae),
        record_values: record_values(dae),
        columns: columns(dae),
        outputs: outputs(dae),
        relations: dae
            .relations
            .iter()
            .zip(dae.arithmetic_relations())
            .map(|(known, arithmetic)| relation(known, arithmetic))
            .collect(),
        automata: dae.automata.iter().cloned().collect(),
        reactions: dae.reactions.iter().map(reaction).collect(),
        assignments: dae
            .assignments
            .iter()
            .map(|assignment| Assignment {
                target: assignment.target,
                counts: match assignment.target {
                    Target::Memory(position) => {
                        read.contains(&position) && dae.reads_memory(assignment.value)
                    }
                    Target::State(_) => false,
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
        selections: dae.selections.clone(),
        clocks: dae
            .ticks
            .iter()
            .map(|tick| Clock {
                name: tick.name.clone(),
                origin: tick.origin.clone(),
            })
            .collect(),
        clock_order: dae.tick_order.iter().map(|clock| clock.index()).collect(),
        holds: dae.holds.clone(),
        delays: delays(dae),
        turning: dae.turning.len(),
        angles: dae.angles.len(),
        exponential: dae.exponential,
        timed: dae.timed,
        foreign: dae.foreign.iter().map(|part| foreign(dae, part)).collect(),
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

fn foreign(dae: &Dae, part: &hyde_ir::flat::Foreign) -> ForeignPart {
    let positions = |list: &[hyde_ir::VarId]| {
        let places = list.iter().flat_map(|&var| {
            let base = dae.places[var].map_or(0, |place| place.base);
            base..base + dae.variables[var].size()
        });
        places.collect()
    };
    ForeignPart {
        name: part.name.clone(),
        file: part.file.clone(),
        source: part.source,
        clock: part.clock.index(),
        parameters: positions(&part.parameters),
        inputs: positions(&part.inputs),
        outputs: positions(&part.outputs),
        origin: part.origin.clone(),
        computed_by: None,
    }
}

fn unknowns(dae: &Dae) -> Vec<UnknownBlock> {
    dae.unknowns
        .iter()
        .zip(&dae.residuals)
        .map(|(block, residual)| {
            let variable = &dae.variables[block.var];
            let first = variable
                .len
                .map(|_| i64::from(variable.first) + i64::try_from(block.first).unwrap_or(0));
            UnknownBlock {
                name: variable.name.clone(),
                first,
                offset: block.offset,
                len: block.len,
                differential: block.differential,
                origins: residual.origins.clone(),
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
            prior: parameter.prior,
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
            noise: column.noise,
            ticks_s: column.ticks_s,
            drives: column.drives.clone(),
        })
        .collect()
}

fn outputs(dae: &Dae) -> Vec<Output> {
    let auxiliary_from = dae.outputs.len()
        - dae.experiment.measured.len()
        - dae.experiment.reductions.len()
        - dae.experiment.conditions().count()
        - dae.experiment.margins().count()
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
    let mut first_of: FxHashMap<(ExprId, i32), usize> = FxHashMap::default();
    for (number, output) in dae.outputs.iter().enumerate() {
        for (name, counter) in output.names.iter().zip(output.range.iter()) {
            let own = found.len();
            let first = *first_of.entry((output.value, counter)).or_insert(own);
            found.push(Output {
                name: name.clone(),
                dimension: output.quantity.dimension,
                unit: output.quantity.unit.clone(),
                discrete: output.discrete,
                auxiliary: number >= auxiliary_from,
                same_as: (first != own).then_some(first),
            });
        }
    }
    found
}

fn relation(relation: &dae::Relation, arithmetic: bool) -> Relation {
    Relation {
        inclusive: relation.inclusive,
        scheduled: relation.time_event.is_some(),
        arithmetic,
        used: relation.used,
        text: relation.text.clone(),
        origin: relation.origin.clone(),
    }
}

fn reaction(reaction: &dae::Reaction) -> Reaction {
    Reaction {
        kind: reaction.kind.clone(),
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
            firmness: *firmness,
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
