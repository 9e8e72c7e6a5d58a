//! What authors said of variables as states (`state = always`), held against what became of them.

use crate::derivatives::fixed_by_modes;
use crate::refusals::place_of;
use crate::refusals::states::{self as refused, NoState};
use crate::system::{Cell, System};
use hyde_diag::{Diagnostic, Diagnostics, Severity, Span};
use hyde_ir::dae::{Alias, Dae, Space};
use hyde_ir::{Expr, Range, StateChoice, VarId};

/// What became of a variable.
enum Fate {
    /// A state for the whole run.
    State,
    /// The run chooses it or others.
    Chosen,
    /// No state.
    Other,
}

/// Reports every choice that could not be met: `always` and `never` as errors, `prefer` and `avoid` as warnings.
pub(crate) fn check(dae: &mut Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    // The expressions belong to the equations again, which tell the causes.
    std::mem::swap(&mut dae.exprs, &mut system.flat.exprs);
    report(dae, system, diagnostics);
    std::mem::swap(&mut dae.exprs, &mut system.flat.exprs);
}

fn report(dae: &Dae, system: &System, diagnostics: &mut Diagnostics) {
    for (var, variable) in dae.variables.enumerate() {
        let choice = variable.state;
        let wanted = choice >= StateChoice::Prefer;
        if choice == StateChoice::Open || system.aliases.contains_key(&(var, 0)) && !wanted {
            continue;
        }
        let unmet = match fate(dae, system, var) {
            Fate::State => choice <= StateChoice::Avoid,
            Fate::Other => wanted,
            Fate::Chosen => false,
        };
        if unmet {
            diagnostics.push(refused(dae, system, var, wanted));
        }
    }
    for group in 0..dae.selections.len() {
        too_many(dae, group, diagnostics);
    }
}

fn place(dae: &Dae, var: VarId) -> Option<usize> {
    let place = dae.places[var]?;
    (place.space == Space::Unknown).then_some(place.base)
}

fn fate(dae: &Dae, system: &System, var: VarId) -> Fate {
    let mut at = (var, 0);
    while let Some(Alias::Of { var, element, .. }) = system.aliases.get(&at) {
        at = (*var, *element);
    }
    let Some(position) = place(dae, at.0).map(|base| base + at.1) else {
        return Fate::Other;
    };
    let in_group = |group: &hyde_ir::dae::Selection| group.candidates.contains(&position);
    if dae.selections.iter().any(in_group) {
        return Fate::Chosen;
    }
    let state = dae.unknowns.iter().any(|block| {
        block.differential && (block.offset..block.offset + block.len).contains(&position)
    });
    if state { Fate::State } else { Fate::Other }
}

/// More variables that must be states, or must not, than the constraints leave.
fn too_many(dae: &Dae, group: usize, diagnostics: &mut Diagnostics) {
    let selection = &dae.selections[group];
    let of = |choice: StateChoice| -> Vec<VarId> {
        let said = dae.variables.enumerate().filter(|&(var, variable)| {
            let position = place(dae, var);
            variable.state == choice && position.is_some_and(|p| selection.candidates.contains(&p))
        });
        said.map(|(var, _)| var).collect()
    };
    let (constraints, all) = (selection.constraints.len(), selection.candidates.len());
    let states = all - constraints;
    for (list, most, what) in [
        (of(StateChoice::Always), states, "be states"),
        (of(StateChoice::Never), constraints, "follow from others"),
    ] {
        if list.len() <= most {
            continue;
        }
        let chosen = list.iter().map(|&var| {
            let variable = &dae.variables[var];
            (variable.name.clone(), variable.origin.span)
        });
        let chosen: Vec<(String, Span)> = chosen.collect();
        let word = dae.variables[list[0]].state.word();
        let counts = (constraints, all, most);
        let places = dae.choice(selection).constraints;
        diagnostics.push(refused::too_many_chosen(
            &chosen,
            (what, word),
            counts,
            &places,
        ));
    }
}

fn refused(dae: &Dae, system: &System, var: VarId, wanted: bool) -> Diagnostic {
    let variable = &dae.variables[var];
    let name = (variable.name.as_str(), variable.state.word());
    let place = place_of(system, &variable.origin);
    let mut diagnostic = match wanted {
        true => refused::cannot_be_state(name, place, &no_state(dae, system, var)),
        false => refused::must_be_state(name, place),
    };
    diagnostic.severity = match variable.state {
        StateChoice::Always | StateChoice::Never => Severity::Error,
        StateChoice::Prefer | StateChoice::Avoid | StateChoice::Open => Severity::Warning,
    };
    diagnostic
}

fn no_state(dae: &Dae, system: &System, var: VarId) -> NoState {
    let mut root = (var, 0);
    while let Some(Alias::Of { var, element, .. }) = system.aliases.get(&root) {
        root = (*var, *element);
    }
    if let Some(Alias::Value(_)) = system.aliases.get(&root) {
        return NoState::Constant;
    }
    let Some(dependent) = dae.dependent.iter().find(|d| (d.var, d.element) == root) else {
        return NoState::NotDifferentiated;
    };
    let equation = dependent.origin.span;
    let others = given_by(system, root);
    let fixed = fixed_by_modes(system);
    let held: Vec<String> = others
        .iter()
        .filter(|cell| fixed.contains(cell))
        .map(|&cell| format!("`{}`", system.cell_name(cell)))
        .collect();
    if !held.is_empty() {
        return NoState::OthersAreFixed(equation, held);
    }
    let also_chosen = |&(var, _): &Cell| dae.variables[var].state >= StateChoice::Prefer;
    match others.iter().any(also_chosen) {
        true => NoState::OthersAreChosen(equation),
        false => NoState::Follows(equation),
    }
}

/// The variables in the equation that gives a variable.
fn given_by(system: &System, cell: Cell) -> Vec<Cell> {
    let leaf = Expr::Var(cell.0, System::cell_index(cell));
    let exprs = &system.flat.exprs;
    let rate = |expr| matches!(expr, Expr::Der(..));
    let mut equations = system.equations.iter();
    let found = equations.find(|equation| {
        let scalar = equation.range == Range::SCALAR;
        scalar && exprs[equation.lhs] == leaf && !exprs.any(equation.rhs, rate)
    });
    let below = found.map_or_else(Vec::new, |equation| exprs.below(&[equation.rhs]));
    let cells = below.into_iter().filter_map(|id| {
        let (var, index, derivative) = exprs[id].access()?;
        System::cell(var, index).filter(|_| !derivative && system.is_continuous(var))
    });
    cells.collect()
}
