//! Checks that ids, ranges and elements of a stage are in bounds: the invariants passes may rely on.
//!
//! A violation is a mistake of the compiler, told with the equation it is in; users never meet one.

use crate::dae::{Dae, Space};
use crate::expr::{Expr, ExprArena, Index, Range};
use crate::flat::{Equation, FlatModel};
use crate::id::{ExprId, Id, IdVec, ParamId, VarId};
use crate::{Parameter, Variable};

/// Checks a flat model.
///
/// # Errors
/// The first violation, in words.
pub fn validate_flat(flat: &FlatModel) -> Result<(), String> {
    let check = Check {
        exprs: &flat.exprs,
        variables: &flat.variables,
        parameters: &flat.parameters,
    };
    let modes = flat
        .automata
        .iter()
        .flat_map(|a| &a.modes)
        .flat_map(|mode| &mode.equations);
    let clocked = flat.clocked_equations.iter().map(|item| &item.equation);
    for equation in flat
        .equations
        .iter()
        .chain(&flat.initial_equations)
        .chain(modes)
        .chain(clocked)
    {
        check.equation(equation)?;
    }
    for delay in flat.delays.iter() {
        check.expr(delay.value, delay.range)?;
    }
    for automaton in flat.automata.iter() {
        let targets = automaton
            .modes
            .iter()
            .flat_map(|mode| &mode.exits)
            .map(|exit| exit.target);
        if targets
            .chain([automaton.initial])
            .any(|target| target >= automaton.modes.len())
        {
            return Err(format!(
                "automaton `{}` names a mode it does not have",
                automaton.name
            ));
        }
    }
    let mut known = vec![false; flat.parameters.len()];
    for &id in &flat.parameter_order {
        for &value in &flat.parameters[id].value {
            if flat.exprs.any(
                value,
                |e| matches!(e, Expr::Param(p, _) if !known[p.index()]),
            ) {
                return Err(format!(
                    "parameter `{}` uses a later one",
                    flat.parameters[id].name
                ));
            }
        }
        known[id.index()] = true;
    }
    Ok(())
}

/// Checks a DAE: every row has one residual, every leaf a place, every definition stands before its use.
///
/// # Errors
/// The first violation, in words.
pub fn validate_dae(dae: &Dae) -> Result<(), String> {
    let check = Check {
        exprs: &dae.exprs,
        variables: &dae.variables,
        parameters: &dae.parameters,
    };
    let mut rows = vec![0_u32; dae.n_unknowns];
    for residual in &dae.residuals {
        for counter in residual.range.iter() {
            let row = usize::try_from(residual.row.at(counter)).unwrap_or(usize::MAX);
            *rows
                .get_mut(row)
                .ok_or_else(|| format!("row {row} is outside the vector"))? += 1;
        }
        check.expr(residual.value, residual.range)?;
    }
    if let Some(row) = rows.iter().position(|&count| count != 1) {
        return Err(format!("row {row} has {} residuals", rows[row]));
    }
    let mut defined = vec![false; dae.n_work];
    for definition in &dae.definitions {
        check.expr(definition.value, definition.range)?;
        for id in dae.exprs.below(&[definition.value]) {
            let Expr::Var(var, index) = dae.exprs[id] else {
                continue;
            };
            let first = usize::try_from(index.at(definition.range.first)).unwrap_or(0);
            if dae
                .place(var)
                .is_some_and(|place| place.space == Space::Work && !defined[place.base + first])
            {
                return Err(format!(
                    "`{}` uses what is defined later",
                    dae.variables[definition.var].name
                ));
            }
        }
        let place = dae
            .place(definition.var)
            .ok_or("a definition of an eliminated variable")?;
        for counter in definition.range.iter() {
            defined[place.base + usize::try_from(definition.index.at(counter)).unwrap_or(0)] = true;
        }
    }
    Ok(())
}

struct Check<'a> {
    exprs: &'a ExprArena,
    variables: &'a IdVec<VarId, Variable>,
    parameters: &'a IdVec<ParamId, Parameter>,
}

impl Check<'_> {
    fn equation(&self, equation: &Equation) -> Result<(), String> {
        self.expr(equation.lhs, equation.range)?;
        self.expr(equation.rhs, equation.range)
    }

    fn expr(&self, root: ExprId, range: Range) -> Result<(), String> {
        for id in self.exprs.below(&[root]) {
            let (name, size, index) = match self.exprs[id] {
                Expr::Var(var, index) | Expr::Der(var, index) | Expr::Pre(var, index) => {
                    let variable = &self.variables[var];
                    (&variable.name, variable.size(), index)
                }
                Expr::Param(param, index) => {
                    let parameter = &self.parameters[param];
                    (&parameter.name, parameter.size(), index)
                }
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Unary(..)
                | Expr::Binary(..)
                | Expr::If(..)
                | Expr::NoEvent(_) => continue,
            };
            let inside = |index: Index, counter| {
                usize::try_from(index.at(counter)).is_ok_and(|at| at < size)
            };
            if !inside(index, range.first) || !inside(index, range.last) {
                return Err(format!("`{name}` is read outside its {size} elements"));
            }
        }
        Ok(())
    }
}
