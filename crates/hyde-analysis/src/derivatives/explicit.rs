//! [`Explicit`]: which equation says the value of a variable, `cell = rhs`, and whether that value can be differentiated.
//!
//! The derivative of an array whose elements one equation gives by values that have derivatives is an array of its own:
//!
//! ```text
//! weights[i] = f(x, i),  … der(weights[3])        rate[i] = f'(x, i)*der(x),  … rate[3]
//! ```
//! Written out for every element, the derivative of what reads all of them would be as many copies of f'.
//!
//! One look at all equations, then each change is followed; to look at all of them for each variable took most of the time
//! of models of a thousand components.

use crate::cells::Cells;
use crate::system::{Cell, Equation, System};
use hyde_diag::MadeBy;
use hyde_ir::{Expr, ExprId, Index, Quantity, Range, StateChoice, VarId, Variable, VariableKind};
use rustc_hash::{FxHashMap, FxHashSet};
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Values through so many values at most.
const MAX_DEPTH: usize = 50;

/// The scalar equations by the cell on their left.
pub(super) struct Explicit {
    equations: FxHashMap<Cell, BTreeSet<usize>>,
    /// The array equations by the array that is their left side as a whole.
    arrays: FxHashMap<VarId, usize>,
    /// Cells that were found to have a derivative.
    derivable: RefCell<FxHashSet<Cell>>,
}

impl Explicit {
    pub(super) fn of(system: &System) -> Self {
        let mut equations: FxHashMap<Cell, BTreeSet<usize>> = FxHashMap::default();
        let mut arrays = FxHashMap::default();
        for number in 0..system.equations.len() {
            if let Some(var) = left_array(system, number) {
                arrays.entry(var).or_insert(number);
            }
            if let Some(cell) = left_cell(system, number) {
                equations.entry(cell).or_default().insert(number);
            }
        }
        Self {
            equations,
            arrays,
            derivable: RefCell::default(),
        }
    }

    /// Takes an equation out before it changes.
    pub(super) fn forget(&mut self, system: &System, number: usize) {
        if let Some(list) = left_cell(system, number).and_then(|cell| self.equations.get_mut(&cell))
        {
            list.remove(&number);
        }
        self.derivable.get_mut().clear();
    }

    /// Takes an equation in after it changed.
    pub(super) fn note(&mut self, system: &System, number: usize) {
        if let Some(cell) = left_cell(system, number) {
            self.equations.entry(cell).or_default().insert(number);
        }
    }

    /// What the first equation that is explicit in a cell says it to be.
    pub(super) fn value(&self, system: &System, cell: Cell) -> Option<ExprId> {
        let number = *self.equations.get(&cell)?.first()?;
        Some(system.equations[number].rhs)
    }

    /// Whether a cell has an explicit value whose variables can all be differentiated.
    pub(super) fn is_derivable(&self, system: &System, cell: Cell, states: &Cells) -> bool {
        self.is_derivable_below(system, cell, states, 0)
    }

    fn is_derivable_below(
        &self,
        system: &System,
        cell: Cell,
        states: &Cells,
        depth: usize,
    ) -> bool {
        if self.derivable.borrow().contains(&cell) {
            return true;
        }
        let value = self.value(system, cell);
        let value = value.or_else(|| self.value_of_element(system, cell));
        let Some(value) = value.filter(|_| depth <= MAX_DEPTH) else {
            return false;
        };
        let found = system.flat.exprs.below(&[value]).into_iter().all(|id| {
            let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
                return true;
            };
            match system.flat.variables[var].kind {
                _ if derivative => false,
                VariableKind::Continuous => System::cell(var, index).is_some_and(|inner| {
                    inner != cell
                        && (states.contains(&inner)
                            || self.is_derivable_below(system, inner, states, depth + 1))
                }),
                VariableKind::Discrete | VariableKind::Held(..) => true,
                VariableKind::Clocked(_)
                | VariableKind::Column(..)
                | VariableKind::Delayed(_)
                | VariableKind::Reduction(_) => false,
            }
        });
        if found {
            self.derivable.borrow_mut().insert(cell);
        }
        found
    }

    /// The time derivative of an expression of states, inputs of which nothing moves, and variables with a derivative;
    /// `None` if it reads the cell `of`.
    pub(super) fn derivative(
        &self,
        system: &mut System,
        id: ExprId,
        of: Cell,
        states: &Cells,
    ) -> Option<ExprId> {
        let mut known = FxHashMap::default();
        let rate = self.derivative_below(system, id, (of, states), &mut known, 0)?;
        system.note_differentiated(id);
        for cell in known.into_keys() {
            let value = self.value(system, cell);
            if let Some(value) = value.or_else(|| self.value_of_element(system, cell)) {
                system.note_differentiated(value);
            }
        }
        Some(rate)
    }

    fn derivative_below(
        &self,
        system: &mut System,
        id: ExprId,
        (of, states): (Cell, &Cells),
        known: &mut FxHashMap<Cell, ExprId>,
        depth: usize,
    ) -> Option<ExprId> {
        if depth > MAX_DEPTH {
            return None;
        }
        let below = system.flat.exprs.below(&[id]).into_iter();
        let leaves = below.filter_map(|id| {
            let Expr::Var(var, index) = system.flat.exprs[id] else {
                return None;
            };
            System::cell(var, index).filter(|_| system.is_continuous(var))
        });
        let mut rates = std::collections::BTreeMap::new();
        for cell in leaves.collect::<Vec<Cell>>() {
            if cell == of {
                return None;
            }
            let rate = if states.contains(&cell) {
                let der = Expr::Der(cell.0, System::cell_index(cell));
                system.exprs().add(der)
            } else if let Some(&rate) = known.get(&cell) {
                rate
            } else if let Some(value) = self.value(system, cell) {
                self.derivative_below(system, value, (of, states), known, depth + 1)?
            } else if let Some(&array) = system.rates_of_arrays.get(&cell.0) {
                let rate = Expr::Var(array, System::cell_index(cell));
                system.exprs().add(rate)
            } else {
                let value = self.value_of_element(system, cell)?;
                let rate = self.derivative_below(system, value, (of, states), known, depth + 1)?;
                let array = self.rate_array(system, cell.0, rate)?;
                let rate = Expr::Var(array, System::cell_index(cell));
                system.exprs().add(rate)
            };
            known.insert(cell, rate);
            rates.insert(cell, rate);
        }
        Some(super::chain_rule::attempt_by_rates(system, id, &rates))
    }
}

impl Explicit {
    /// What an element of an array is, by the counter of the array's equation.
    fn value_of_element(&self, system: &System, cell: Cell) -> Option<ExprId> {
        let number = *self.arrays.get(&cell.0)?;
        Some(system.equations[number].rhs)
    }

    /// An array for the derivatives of the elements of another one.
    fn rate_array(&self, system: &mut System, of: VarId, rate: ExprId) -> Option<VarId> {
        let number = *self.arrays.get(&of)?;
        let Equation {
            range, ref origin, ..
        } = system.equations[number];
        let origin = origin.made_by(MadeBy::Expression);
        let variable = &system.flat.variables[of];
        let dimension = variable.quantity.dimension;
        let array = system.flat.variables.push(Variable {
            name: format!("der({})", variable.name),
            quantity: Quantity::usual(dimension.divide(hyde_units::Dimension::TIME)),
            start: Vec::new(),
            fixed: false,
            state: StateChoice::Open,
            origin: origin.clone(),
            ..variable.clone()
        });
        system.rates_of_arrays.insert(of, array);
        let lhs = system.exprs().add(Expr::Var(array, Index::COUNTER));
        system.equations.push(Equation {
            range,
            lhs,
            rhs: rate,
            origin,
            order: 0,
            constraint: false,
        });
        Some(array)
    }
}

/// The array that an equation over a range gives as a whole, by numbers and scalars.
fn left_array(system: &System, number: usize) -> Option<VarId> {
    let equation = &system.equations[number];
    let Expr::Var(var, Index::COUNTER) = system.flat.exprs[equation.lhs] else {
        return None;
    };
    let size = system.flat.variables[var].size();
    let whole = System::interval(Index::COUNTER, equation.range) == (0, size.checked_sub(1)?);
    (equation.range != Range::SCALAR && whole).then_some(var)
}

fn left_cell(system: &System, number: usize) -> Option<Cell> {
    let equation = &system.equations[number];
    let Expr::Var(var, index) = system.flat.exprs[equation.lhs] else {
        return None;
    };
    System::cell(var, index).filter(|_| equation.range == Range::SCALAR)
}
