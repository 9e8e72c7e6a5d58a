//! What authors said of variables as states (`state = always`), held against what became of them.

use crate::derivatives::fixed_by_modes;
use crate::system::{Cell, System};
use hyde_diag::{Code, Diagnostic, Diagnostics};
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
        let names: Vec<String> = list
            .iter()
            .map(|&var| format!("`{}`", dae.variables[var].name))
            .collect();
        let word = dae.variables[list[0]].state.word();
        let mut diagnostic = Diagnostic::error(
            Code::StateChoice,
            format!(
                "{} cannot all {what}: {} tie{} {all} variables",
                names.join(", "),
                crate::matching::plural(constraints, "constraint"),
                if constraints == 1 { "s" } else { "" },
            ),
        );
        for &var in &list {
            let text = format!("`state = {word}`");
            diagnostic = diagnostic.label(dae.variables[var].origin.span, text);
        }
        for origin in dae.choice(selection).constraints {
            diagnostic = diagnostic.label(origin.span, "a constraint between them");
        }
        diagnostics.push(diagnostic.help(format!(
            "at most {states} of these variables can be states; write `{word}` for at most {most}"
        )));
    }
}

fn refused(dae: &Dae, system: &System, var: VarId, wanted: bool) -> Diagnostic {
    let variable = &dae.variables[var];
    let name = &variable.name;
    let make = match variable.state {
        StateChoice::Always | StateChoice::Never => Diagnostic::error,
        StateChoice::Prefer | StateChoice::Avoid | StateChoice::Open => Diagnostic::warning,
    };
    let message = match wanted {
        true => format!("`{name}` cannot be a state"),
        false => format!("`{name}` must be a state: there is no alternative"),
    };
    let place = system.component(&variable.origin);
    let said = format!("`state = {}`", variable.state.word());
    let mut diagnostic = make(Code::StateChoice, message);
    diagnostic = match place {
        Some((_, span)) => diagnostic
            .label(span, said)
            .label(variable.origin.span, "declared here"),
        None => diagnostic.label(variable.origin.span, said),
    };
    if !wanted {
        return diagnostic
            .note("no constraint determines it from other states, so it has to be integrated")
            .help(format!("remove `{}`", variable.state.word()));
    }
    let mut root = (var, 0);
    while let Some(Alias::Of { var, element, .. }) = system.aliases.get(&root) {
        root = (*var, *element);
    }
    if let Some(Alias::Value(_)) = system.aliases.get(&root) {
        return diagnostic
            .note("its value is known and constant")
            .help("remove the choice, or free it");
    }
    let Some(dependent) = dae.dependent.iter().find(|d| (d.var, d.element) == root) else {
        return diagnostic
            .note("no equation has its derivative, and no constraint between states could be solved for another one")
            .help("choose a variable that is differentiated, or the derivative of one");
    };
    diagnostic = diagnostic.label(
        dependent.origin.span,
        "this equation determines it from other states",
    );
    let others = given_by(system, root);
    let fixed = fixed_by_modes(system);
    let held: Vec<String> = others
        .iter()
        .filter(|cell| fixed.contains(cell))
        .map(|&cell| format!("`{}`", system.cell_name(cell)))
        .collect();
    let word = variable.state.word();
    let also_chosen = |&(var, _): &Cell| dae.variables[var].state >= StateChoice::Prefer;
    if !held.is_empty() {
        return diagnostic
            .note(format!(
                "modes fix {}, as a sticking friction does: a variable that a mode fixes has to be a state",
                crate::regularity::and(&held)
            ))
            .help(format!("remove `state = {word}`"));
    }
    diagnostic.help(match others.iter().any(also_chosen) {
        true => "write `prefer` or `always` only for it among the variables of this constraint"
            .to_owned(),
        false => {
            format!(
                "remove `state = {word}`, or write `avoid` for another variable of this constraint"
            )
        }
    })
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
