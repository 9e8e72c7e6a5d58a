//! The model while it is analysed: its equations as one list, those of modes in slots.

use crate::solve::divisor;
use hyde_diag::{InstancePath, Origin, Span};
use hyde_ir::dae::{Alias, Dependent};
use hyde_ir::flat::{self, Action, FlatModel};
use hyde_ir::{
    AutomatonId, Expr, ExprArena, ExprId, Id as _, Index, Memo, Range, VarId, VariableKind,
};
use std::collections::BTreeMap;

/// An element of a variable, counted from 0.
pub(crate) type Cell = (VarId, usize);

/// A mode's equation in a slot.
#[derive(Clone, Debug)]
pub(crate) struct Branch {
    pub(crate) lhs: ExprId,
    pub(crate) rhs: ExprId,
    pub(crate) origin: Origin,
    /// It fixes this state to a value that is constant between events (M3).
    pub(crate) pin: Option<(Cell, ExprId)>,
}

/// The equations that one position of a `modes` block has in its modes.
#[derive(Clone, Debug)]
pub(crate) struct Slot {
    pub(crate) automaton: AutomatonId,
    pub(crate) branches: Vec<Branch>,
}

/// An equation of the system.
#[derive(Clone, Debug)]
pub(crate) struct Equation {
    pub(crate) range: Range,
    pub(crate) lhs: ExprId,
    pub(crate) rhs: ExprId,
    pub(crate) origin: Origin,
    /// How often it was differentiated.
    pub(crate) order: u8,
    /// It constrains variables of a group, and has been differentiated for that.
    pub(crate) constraint: bool,
}

/// Constraints between variables of one order.
#[derive(Clone, Debug, Default)]
pub(crate) struct Group {
    /// The variables with their rates.
    pub(crate) candidates: Vec<(Cell, ExprId)>,
    /// Number of constraints.
    pub(crate) constraints: usize,
    /// The factors of the rows, row by row, in the memory; `None` if the constraints determine every variable.
    pub(crate) factors: Option<VarId>,
}

/// The model under analysis.
#[derive(Clone)]
pub(crate) struct System {
    pub(crate) flat: FlatModel,
    pub(crate) equations: Vec<Equation>,
    pub(crate) slots: Vec<Slot>,
    /// Eliminated cells with what they stand for, in the order eliminated; targets may be eliminated later.
    pub(crate) aliases: BTreeMap<Cell, Alias>,
    /// Start values that joined variables gave to the one kept: value, fixed, and who gave it.
    pub(crate) starts: BTreeMap<Cell, Vec<(ExprId, bool, VarId)>>,
    /// Fixed start values of variables that equal what is known: who gave it, the known value, the start value.
    pub(crate) known_starts: Vec<(VarId, ExprId, ExprId)>,
    /// Variables that constraints tie to each other.
    pub(crate) groups: Vec<Group>,
    /// The array of the derivatives of each array that has one.
    pub(crate) rates_of_arrays: BTreeMap<VarId, VarId>,
    pub(crate) relations: hyde_ir::IdVec<hyde_ir::RelationId, hyde_ir::dae::Relation>,
    pub(crate) notes: Vec<String>,
    /// Variables that equations give by states, so that they are none.
    pub(crate) dependent: Vec<Dependent>,
    /// What a mode fixes and several states would give: it is to be a state itself.
    pub(crate) to_be_states: Vec<Cell>,
}

impl System {
    /// Splits the equations of modes into slots; everything else as it is.
    pub(crate) fn new(mut flat: FlatModel) -> Self {
        let notes = std::mem::take(&mut flat.notes);
        let equations = std::mem::take(&mut flat.equations);
        let equations = equations
            .into_iter()
            .map(|e| Equation {
                range: e.range,
                lhs: e.lhs,
                rhs: e.rhs,
                origin: e.origin,
                order: 0,
                constraint: false,
            })
            .collect();
        let mut slots = Vec::new();
        for (automaton, block) in flat.automata.enumerate() {
            let count = block.modes.first().map_or(0, |mode| mode.equations.len());
            for position in 0..count {
                let branches = block
                    .modes
                    .iter()
                    .filter_map(|mode| mode.equations.get(position))
                    .map(|equation| Branch {
                        lhs: equation.lhs,
                        rhs: equation.rhs,
                        origin: equation.origin.clone(),
                        pin: None,
                    });
                slots.push(Slot {
                    automaton,
                    branches: branches.collect(),
                });
            }
        }
        let mut starts: BTreeMap<Cell, Vec<(ExprId, bool, VarId)>> = BTreeMap::new();
        for (id, variable) in flat.variables.enumerate() {
            if let (None, Some(&start)) = (variable.len, variable.start.first()) {
                starts
                    .entry((id, 0))
                    .or_default()
                    .push((start, variable.fixed, id));
            }
        }
        Self {
            flat,
            equations,
            slots,
            aliases: BTreeMap::new(),
            starts,
            known_starts: Vec::new(),
            groups: Vec::new(),
            rates_of_arrays: BTreeMap::new(),
            relations: hyde_ir::IdVec::new(),
            notes,
            dependent: Vec::new(),
            to_be_states: Vec::new(),
        }
    }

    pub(crate) fn exprs(&mut self) -> &mut ExprArena {
        &mut self.flat.exprs
    }

    /// Where the top of the model declares the component that an origin is in, with its name; `None` at the top.
    pub(crate) fn component(&self, origin: &Origin) -> Option<(String, Span)> {
        let name = origin.instance.as_str().split('.').next()?;
        let span = self.flat.declared.get(&InstancePath::root().child(name))?;
        (!name.is_empty()).then(|| (name.to_owned(), *span))
    }

    /// The variable that stands for the derivative of a variable of a group.
    pub(crate) fn rate_of(&self, cell: Cell) -> Option<ExprId> {
        let candidates = self.groups.iter().flat_map(|group| &group.candidates);
        let mut found = candidates.filter(|(own, _)| *own == cell);
        found.next().map(|(_, rate)| *rate)
    }

    /// Whether a variable is determined by the continuous equations.
    pub(crate) fn is_continuous(&self, var: VarId) -> bool {
        self.flat.variables[var].kind == VariableKind::Continuous
    }

    /// Passes every leaf of every expression of the model through `replace`. Equation `except` is left as it is.
    pub(crate) fn rewrite_all(
        &mut self,
        except: Option<usize>,
        mut replace: impl FnMut(&mut ExprArena, Expr) -> Option<ExprId>,
    ) {
        let mut memo = Memo::default();
        let flat = &mut self.flat;
        let mut each = |arena: &mut ExprArena, id: &mut ExprId| {
            *id = arena.rewrite(*id, &mut memo, |arena, _, expr| replace(arena, expr));
        };
        let arena = &mut flat.exprs;
        for (number, equation) in self.equations.iter_mut().enumerate() {
            if except != Some(number) {
                each(arena, &mut equation.lhs);
                each(arena, &mut equation.rhs);
            }
        }
        for branch in self.slots.iter_mut().flat_map(|slot| &mut slot.branches) {
            each(arena, &mut branch.lhs);
            each(arena, &mut branch.rhs);
        }
        for equation in &mut flat.initial_equations {
            each(arena, &mut equation.lhs);
            each(arena, &mut equation.rhs);
        }
        for item in &mut flat.clocked_equations {
            each(arena, &mut item.equation.lhs);
            each(arena, &mut item.equation.rhs);
        }
        for automaton in flat.automata.iter_mut() {
            for action in &mut automaton.initial_actions {
                each(arena, action_value(action));
            }
            for exit in automaton.modes.iter_mut().flat_map(|mode| &mut mode.exits) {
                each(arena, &mut exit.guard);
                for action in &mut exit.actions {
                    each(arena, action_value(action));
                }
            }
        }
        for (condition, actions) in flat.whens.iter_mut().flat_map(|when| &mut when.branches) {
            each(arena, condition);
            for action in actions {
                each(arena, action_value(action));
            }
        }
        for delay in flat.delays.iter_mut() {
            each(arena, &mut delay.value);
        }
        for edge in &mut flat.edges {
            each(arena, &mut edge.condition);
        }
        for assert in &mut flat.asserts {
            each(arena, &mut assert.condition);
        }
        for measured in &mut flat.experiment.measured {
            each(arena, &mut measured.value);
        }
        for replayed in &mut flat.experiment.replayed {
            each(arena, &mut replayed.value);
            each(arena, &mut replayed.recorded);
        }
        for reduction in &mut flat.experiment.reductions {
            each(arena, &mut reduction.value);
            if let Some(condition) = &mut reduction.condition {
                each(arena, condition);
            }
        }
        for (_, value, _) in flat
            .experiment
            .bodes
            .iter_mut()
            .flat_map(|bode| &mut bode.outputs)
        {
            each(arena, value);
        }
        for cut in &mut flat.experiment.cuts {
            each(arena, &mut cut.back);
        }
        let figures = flat.experiment.figures.iter_mut();
        for curve in figures.flat_map(flat::Figure::curves_mut) {
            each(arena, &mut curve.value);
        }
        let ledger = &mut flat.experiment.ledger;
        for (_, value) in ledger.accounts.iter_mut().flat_map(|a| &mut a.pieces) {
            each(arena, value);
        }
        for port in &mut ledger.ports {
            each(arena, &mut port.flow);
            each(arena, &mut port.potential);
        }
    }

    /// Notes what drives the model from outside in an expression that is differentiated by the time: it is taken for
    /// constant there.
    pub(crate) fn note_differentiated(&mut self, id: ExprId) {
        let experiment = &mut self.flat.experiment;
        if experiment.free.is_empty() {
            return;
        }
        for below in self.flat.exprs.below(&[id]) {
            if let Expr::Param(param, _) = self.flat.exprs[below]
                && experiment.free.contains(&param)
                && !experiment.differentiated.contains(&param)
            {
                experiment.differentiated.push(param);
            }
        }
    }

    /// The cells an access reaches over a range: first, last, and stride.
    pub(crate) fn interval(index: Index, range: Range) -> (usize, usize) {
        let (a, b) = (index.at(range.first), index.at(range.last));
        let at = |value: i32| usize::try_from(value).unwrap_or(0);
        (at(a.min(b)), at(a.max(b)))
    }

    /// A cell as a scalar access.
    pub(crate) fn cell_index(cell: Cell) -> Index {
        Index::fixed(i32::try_from(cell.1).unwrap_or(i32::MAX))
    }

    /// The name of a cell.
    pub(crate) fn cell_name(&self, cell: Cell) -> String {
        self.flat.variables[cell.0].element_name(cell.1)
    }

    /// The cell of a scalar access, `None` of one that moves with a counter.
    pub(crate) fn cell(var: VarId, index: Index) -> Option<Cell> {
        (index.stride == 0).then(|| (var, usize::try_from(index.offset).unwrap_or(0)))
    }

    /// Whether an expression is made of parameters and numbers alone.
    pub(crate) fn is_parametric(&self, id: ExprId) -> bool {
        self.flat.exprs.is_parametric(id)
    }

    /// The declared values of all parameters, element by element; empty where they cannot be told.
    pub(crate) fn declared_values(&self) -> Vec<Vec<f64>> {
        let flat = &self.flat;
        let mut values: Vec<Vec<f64>> = vec![Vec::new(); flat.parameters.len()];
        for &param in &flat.parameter_order {
            let parameter = &flat.parameters[param];
            let list: Result<Vec<f64>, ()> = (0..parameter.size())
                .map(|element| {
                    let value = *parameter
                        .value
                        .get(element)
                        .or_else(|| parameter.value.first())
                        .ok_or(())?;
                    flat.exprs
                        .evaluate(value, |expr| declared(&values, element, expr))
                })
                .collect();
            values[param.index()] = list.unwrap_or_default();
        }
        values
    }

    /// Whether `lhs = rhs` solved for a leaf divides by parameters that are declared 0 together: a slide along y has no
    /// component along x.
    pub(crate) fn divides_by_zero(
        &mut self,
        declared: &[Vec<f64>],
        lhs: ExprId,
        rhs: ExprId,
        leaf: Expr,
    ) -> bool {
        let divisor = divisor(&mut self.flat.exprs, lhs, rhs, leaf);
        divisor.is_some_and(|divisor| self.value_with(declared, divisor) == Some(0.0))
    }

    /// The value of an expression at the start of time, with the parameters and variables given; `None` if it has others.
    pub(crate) fn value_at(
        &self,
        values: &[Vec<f64>],
        cells: &BTreeMap<Cell, f64>,
        id: ExprId,
    ) -> Option<f64> {
        let leaf = |expr: Expr| {
            if let Expr::Var(var, index) = expr {
                let cell = Self::cell(var, index).ok_or(())?;
                return cells.get(&cell).copied().ok_or(());
            }
            if expr == Expr::Time {
                return Ok(0.0);
            }
            declared(values, 0, expr)
        };
        self.flat.exprs.evaluate(id, leaf).ok()
    }

    /// The value of an expression of parameters with the values given; `None` if it is not one.
    pub(crate) fn value_with(&self, values: &[Vec<f64>], id: ExprId) -> Option<f64> {
        self.flat
            .exprs
            .evaluate(id, |expr| declared(values, 0, expr))
            .ok()
    }
}

/// The value of a leaf of parameters alone.
fn declared(values: &[Vec<f64>], counter: usize, expr: Expr) -> Result<f64, ()> {
    if expr == Expr::Counter {
        return Ok(counter as f64);
    }
    let Expr::Param(param, index) = expr else {
        return Err(());
    };
    let at = usize::try_from(index.at(i32::try_from(counter).unwrap_or(0))).unwrap_or(0);
    values[param.index()].get(at).copied().ok_or(())
}

fn action_value(action: &mut Action) -> &mut ExprId {
    match action {
        Action::Reinit(_, _, value) | Action::Assign(_, _, value) => value,
    }
}
