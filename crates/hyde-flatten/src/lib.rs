//! [`flatten`]: from trees to a [`FlatModel`]. Names become ids, components their equations.
//!
//! In order:
//! 1. the classes and types of every file are indexed (`names`);
//! 2. the model is instantiated: a tree of instances with their variables, parameters and parts, every modification
//!    laid where it belongs (`instantiate`);
//! 3. what a clocked part computes though it is declared outside is refused (`misplaced`);
//! 4. bindings, equations, modes, events and clocked parts are lowered to IR in the scope of their instance
//!    (`equation`, `modes`; in model/: `lower` the expressions, `field` the fields), each with its dimension (`dimension`);
//! 5. connection sets become equations (`connect`);
//! 6. the experiment drives the free inputs and names what is measured (`experiment`);
//! 7. what is known of dimensions is solved for the rest, and parameters are put in order (`finish`).
//!
//! Arrays and fields are not unrolled: a `for` equation or a field equation is one equation over a range.

mod additions;
mod allowed;
mod candidates;
mod connect;
mod dimension;
mod effect_words;
mod equation;
mod event_clock;
mod experiment;
mod finish;
mod foreign;
mod input;
mod instance;
mod instantiate;
mod law_roles;
mod law_shapes;
mod law_sites;
mod ledger;
mod meaning;
mod misplaced;
mod model;
mod modes;
mod names;
mod refusals;
mod shown;
mod site;
mod turns;
mod words;
mod wrap;
mod zero;

pub use additions::Additions;
pub use candidates::{Candidate, Knob};
pub use foreign::fmu_has_no_equations;
pub use input::{FmuInterface, Form, FreeInputs, Header, Input, TableFile};
pub use law_sites::{LawSite, LawVariable};
pub use meaning::{Meaning, MeaningOf, ValueOf};
pub use model::call::{FUNCTIONS, usage};
pub use words::nearest;

use hyde_diag::Diagnostics;
use hyde_ir::{FlatModel, LawShape};

/// Flattens a model with its experiment.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn flatten(input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<FlatModel> {
    flat_model(input, false, diagnostics).map(|(flat, _)| flat)
}

/// Every effect of the files at every site of the model where it fits; sites in the order of the model.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn candidates(input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<Vec<Candidate>> {
    flat_model(input, true, diagnostics).map(|(_, candidates)| candidates)
}

/// Where a law may act on a model, and what it may be made of.
#[derive(Clone, Debug, Default)]
pub struct Laws {
    /// The sites, in the order of the model.
    pub sites: Vec<LawSite>,
    /// The shapes of the files.
    pub shapes: Vec<LawShape>,
}

/// The sites of the model where a law may act, and the shapes that the files have for one.
///
/// `None` if there were errors; all of them are in `diagnostics`.
pub fn laws(input: &Input<'_>, diagnostics: &mut Diagnostics) -> Option<Laws> {
    let before = diagnostics.error_count();
    let mut model = model::Model::new(input, diagnostics);
    build(&mut model)?;
    if let Some(refused) = foreign::refuse_observer(&model.flat, input.form) {
        model.report(refused);
    }
    let sites = law_sites::named_law_sites(&mut model);
    let shapes = law_shapes::law_shapes(&mut model);
    (diagnostics.error_count() == before).then_some(Laws { sites, shapes })
}

/// What the expressions and parameters of the first file mean, as far as they are understood; what is wrong with the others
/// is in `diagnostics`.
pub fn meaning(input: &Input<'_>, diagnostics: &mut Diagnostics) -> Meaning {
    let mut model = model::Model::new(input, diagnostics);
    model.lowered = Some(Vec::new());
    match build(&mut model) {
        Some(()) => meaning::meaning(
            &model.lowered.unwrap_or_default(),
            &model.flat,
            &model.parameters,
            &model.dimensions,
            input.files.first().map(|(id, _)| *id),
        ),
        None => Meaning::default(),
    }
}

/// The flat model, with the effects that fit on it if they are asked for.
fn flat_model(
    input: &Input<'_>,
    offering: bool,
    diagnostics: &mut Diagnostics,
) -> Option<(FlatModel, Vec<Candidate>)> {
    let before = diagnostics.error_count();
    let mut model = model::Model::new(input, diagnostics);
    model.making.offering = offering;
    build(&mut model)?;
    let candidates = candidates::candidates(&mut model);
    let flat = model.flat;
    if !offering && let Some(refused) = foreign::refuse_observer(&flat, input.form) {
        diagnostics.push(refused);
    }
    (diagnostics.error_count() == before).then_some((flat, candidates))
}

/// Builds the flat model; `None` if there is no model of that name.
///
/// A pass that takes the whole [`model::Model`] lowers expressions: it may add to everything but the tree of instances, which
/// is read-only behind [`instantiate::instantiate_root`]. The others take what they read, and `&mut` what they write.
fn build(model: &mut model::Model<'_, '_>) -> Option<()> {
    let root = instantiate::instantiate_root(model)?;

    // Values and equations of every instance.
    experiment::find_replays(model, root);
    misplaced::find_misplaced(model);
    model.lower_bindings();
    allowed::check_parameters(model);
    equation::lower_equations(model);
    allowed::check_asserts(model);
    allowed::bounded_variables(model);
    wrap::finish_effects(model);

    // Connections.
    experiment::replay_equations(model, false);
    connect::connect(model);
    experiment::replay_equations(model, true);
    event_clock::event_clocks(model);

    // The experiment, and what it leaves open.
    experiment::experiment(model, root);
    experiment::free_inputs(model, root);
    ledger::accounts(model);
    model.flat.declared = model.tree.declared();
    experiment::report_undriven(model);

    // Dimensions are known from here on.
    model.solve_dimensions();
    let (flat, dimensions) = (&mut model.flat, &model.dimensions);
    finish::drop_empty_equations(flat);
    finish::single_elements(flat);
    finish::settle_variables(&mut flat.variables, &model.variables, dimensions);
    let columns = &model.column_variables;
    experiment::report_units_in_names(model.input, flat, columns, model.diagnostics);
    finish::settle_parameters(&mut flat.parameters, &model.parameters, dimensions);
    finish::order_parameters(flat, model.diagnostics);
    finish::starts_of_found(flat);
    ledger::ports(model.input, &model.tree, flat);
    effect_words::check_effect_words(model);
    law_sites::find_law_sites(model);
    Some(())
}
