//! `replay x = column;`: a cut. The recorded column takes the place of what the model says of x (C4).
//!
//! ```text
//! motor.i_ref = hold(cnc.control.i_ref)     with  replay motor.i_ref = file.i_ref;
//!                                           is    motor.i_ref = held(file.i_ref)
//! ```
//! A run keeps the loop closed. Calibration and diagnosis ask for the observed form, in which cuts are made: their
//! columns were measured with the true axis in the loop, so nothing that stands before a cut has to be known. Effects
//! that wrap the variable stay: they act on the column.

use crate::Form;
use crate::call::clocks_of;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, MadeBy};
use hyde_ir::flat::Measured;
use hyde_ir::{Expr as Ir, ExprId, Interpolation, Memo, VarId, VariableKind};
use hyde_syntax::ast::{Drive, ExperimentItem};

/// A clock ticks several times between two rows if its period is at most this part of their distance.
const SEVERAL: f64 = 0.6;

/// `replay x = column;` with the variable that it is about.
#[derive(Clone, Copy)]
pub(crate) struct Replay<'a> {
    drive: &'a Drive,
    var: VarId,
    root: InstanceId,
    used: bool,
    /// What the variable is without its effects: what its column is recorded of.
    value: Option<ExprId>,
}

impl<'a> Model<'a, '_> {
    /// Finds the variables that the experiment replays.
    pub(crate) fn find_replays(&mut self, root: InstanceId) {
        let experiment = self.input.experiment;
        let Some(experiment) = experiment.and_then(|name| self.names.own_experiment(name)) else {
            return;
        };
        for item in &experiment.items {
            let ExperimentItem::Replay(drives) = item else {
                continue;
            };
            for drive in drives {
                let scope = Scope::new(root, Setting::Report);
                if let Some(Resolved::Variable(var, None)) = self.resolve(&drive.target, &scope) {
                    self.replays.push(Replay {
                        drive,
                        var,
                        root,
                        used: false,
                        value: None,
                    });
                }
            }
        }
    }

    /// What a variable's equation says, or the column that takes its place.
    pub(crate) fn replayed(&mut self, var: VarId, value: Typed) -> Typed {
        let Some(number) = self.replays.iter().position(|replay| replay.var == var) else {
            return value;
        };
        self.replays[number].used = true;
        self.replays[number].value = Some(value.id);
        let Replay { drive, root, .. } = self.replays[number];
        if self.input.form != Form::Observed {
            return value;
        }
        let scope = Scope {
            records: true,
            ..Scope::new(root, Setting::Equation)
        };
        let mut column = self.value(&drive.value, &scope);
        let declared = self.typed(value.id, self.dim(var), drive.target.span);
        self.agree(&declared, &column, "the variable and its record are", root);
        self.noise_of_column(drive, (&declared, column.id), root);
        if self.is_held(var, value.id) {
            self.note_ticks_between_rows(var, value.id, column.id);
            column.id = self.with_held_columns(column.id);
        }
        column
    }

    /// Notes of a column how often what it replays changes, if that is several times between two rows of its record, which
    /// does not have all of it.
    fn note_ticks_between_rows(&mut self, var: VarId, value: ExprId, column: ExprId) {
        let mut kinds = vec![self.flat.variables[var].kind];
        for id in self.flat.exprs.below(&[value]) {
            if let Ir::Var(read, _) = self.flat.exprs[id] {
                kinds.push(self.flat.variables[read].kind);
            }
        }
        let clocks = kinds.into_iter().filter_map(|kind| match kind {
            VariableKind::Clocked(clock) | VariableKind::Held(clock, _) => Some(clock),
            VariableKind::Continuous
            | VariableKind::Discrete
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => None,
        });
        let periods: Vec<ExprId> = clocks.map(|clock| self.flat.clocks[clock].period).collect();
        let periods: Vec<f64> = periods
            .into_iter()
            .filter_map(|period| self.current_value(period))
            .collect();
        let Some(period) = periods.into_iter().reduce(f64::min) else {
            return;
        };
        for id in self.flat.exprs.below(&[column]) {
            if let Ir::Var(read, _) = self.flat.exprs[id]
                && let VariableKind::Column(column, _) = self.flat.variables[read].kind
            {
                let column = &mut self.flat.columns[column];
                let header = self.input.records.get(&column.record);
                let step_s = header.and_then(|header| header.step_s);
                if step_s.is_some_and(|step_s| period <= SEVERAL * step_s) {
                    column.ticks_s = Some(period);
                }
            }
        }
    }

    /// Puts columns in the place of equations that no effect wraps, those of connections last.
    pub(crate) fn replay_equations(&mut self, connections_made: bool) {
        for number in 0..self.replays.len() {
            if self.replays[number].used {
                continue;
            }
            let var = self.replays[number].var;
            let leaf = self.flat.exprs.var(var);
            if let Some(at) = self.flat.equations.iter().position(|e| e.lhs == leaf) {
                let value = self.typed(
                    self.flat.equations[at].rhs,
                    self.dim(var),
                    self.span_of(number),
                );
                self.flat.equations[at].rhs = self.replayed(var, value).id;
                continue;
            }
            let clocked = &self.flat.clocked_equations;
            if let Some(at) = clocked.iter().position(|e| e.equation.lhs == leaf) {
                let rhs = clocked[at].equation.rhs;
                let value = self.typed(rhs, self.dim(var), self.span_of(number));
                self.flat.clocked_equations[at].equation.rhs = self.replayed(var, value).id;
                continue;
            }
            // An input that is connected: the equation of the connection has it on either side.
            let input = self.flat.variables[var].input;
            let connected = self.flat.equations.iter().position(|e| e.rhs == leaf);
            if let Some(at) = connected.filter(|_| input) {
                let value = self.typed(
                    self.flat.equations[at].lhs,
                    self.dim(var),
                    self.span_of(number),
                );
                let column = self.replayed(var, value).id;
                let equation = &mut self.flat.equations[at];
                if self.input.form == Form::Observed {
                    (equation.lhs, equation.rhs) = (leaf, column);
                }
                continue;
            }
            if connections_made {
                self.no_equation_to_replay(number);
            }
        }
    }

    /// Makes a channel of each replayed column: what an axis would have recorded there.
    pub(super) fn record_replays(&mut self) {
        for number in 0..self.replays.len() {
            let Replay {
                drive,
                var,
                root,
                value,
                ..
            } = self.replays[number];
            let mut preparation = Vec::new();
            let column = self.recorded(&drive.value, root, false, &mut preparation);
            let (Some((column, _)), Some(value)) = (column, value) else {
                continue;
            };
            let origin = self.tree.origin(root, drive.target.span);
            let clocked = self.is_held(var, value) || !clocks_of(&self.flat, value).is_empty();
            self.flat.experiment.measured.push(Measured {
                name: drive.target.dotted(),
                column,
                preparation,
                value,
                clocked,
                noise: None,
                rounding: None,
                late: None,
                period: None,
                quantity: self.flat.variables[var].quantity.clone(),
                origin: origin.made_by(MadeBy::Experiment),
            });
        }
    }

    fn span_of(&self, replay: usize) -> hyde_diag::Span {
        self.replays[replay].drive.target.span
    }

    fn no_equation_to_replay(&mut self, number: usize) {
        let Replay { drive, .. } = self.replays[number];
        self.report(
            Diagnostic::error(
                Code::CannotReplay,
                format!("`{}` has no equation of its own", drive.target.dotted()),
            )
            .label(drive.target.span, "cannot be replayed")
            .note("a replayed column replaces the one equation that determines its variable")
            .help("replay an input, an output, or a variable declared with a value: `site Force force = …;`"),
        );
    }

    /// Whether a variable changes at instants only: clocked, or made of held values.
    fn is_held(&self, var: VarId, value: ExprId) -> bool {
        let held = |kind: VariableKind| {
            matches!(
                kind,
                VariableKind::Clocked(_)
                    | VariableKind::Held(..)
                    | VariableKind::Column(_, Interpolation::Held)
            )
        };
        held(self.flat.variables[var].kind)
            || self.flat.exprs.any(value, |expr| match expr {
                Ir::Var(read, _) => held(self.flat.variables[read].kind),
                Ir::Const(_)
                | Ir::Time
                | Ir::Counter
                | Ir::Param(..)
                | Ir::Der(..)
                | Ir::Pre(..)
                | Ir::Relation(_)
                | Ir::InMode(..)
                | Ir::Unary(..)
                | Ir::Binary(..)
                | Ir::If(..)
                | Ir::NoEvent(_) => false,
            })
    }

    /// The same with columns held between their rows.
    fn with_held_columns(&mut self, id: ExprId) -> ExprId {
        let mut memo = Memo::default();
        for below in self.flat.exprs.below(&[id]) {
            if let Ir::Var(var, _) = self.flat.exprs[below]
                && let VariableKind::Column(column, Interpolation::Linear) =
                    self.flat.variables[var].kind
            {
                let held = self.column_variables[&column].1;
                memo.insert(below, self.flat.exprs.var(held));
            }
        }
        self.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
    }
}
