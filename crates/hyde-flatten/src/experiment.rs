//! The experiment: stimuli drive the free inputs, measured channels name their columns, measures reduce the run.

mod bode;
mod cut;
mod figure;
mod late;
mod measure;
mod measured;
mod observed;
mod outer;
mod record;
mod replay;
mod response;
mod stepped;
mod stimulus;
mod time;
mod wrapped;

pub(crate) use measure::add_measure;
pub(crate) use record::{record_column, report_units_in_names};
pub(crate) use replay::{Replay, find_replays, replay_equations, replayed};
pub(crate) use stimulus::{free_inputs, report_undriven};

use crate::input::Form;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::experiment as refused;
use bode::lower_bode;
use cut::lower_margins;
use figure::lower_figure;
use hyde_diag::{Diagnostics, Span};
use hyde_ir::FlatModel;
use hyde_ir::flat::Method;
use hyde_syntax::ast::{self, ExperimentItem};
use measure::push_measure;
use measured::measured;
use replay::{keep_commands, record_replays};
use response::measured_responses;
use stimulus::stimulus;
use time::agree_time;

/// Lowers the experiment asked for; without one, every input must have a value of its own.
pub(crate) fn experiment(model: &mut Model<'_, '_>, root: InstanceId) {
    let Some(name) = model.input.experiment else {
        return;
    };
    let Some(experiment) = model.names.own_experiment(name) else {
        if let Some((file, _)) = model.input.files.first() {
            let file = *file;
            model.report(refused::no_experiment(name, Span::new(file, 0, 0)));
        }
        return;
    };
    model.flat.experiment.name = experiment.name.text.clone();
    check_budget(model.diagnostics, &experiment.items);
    model.flat.experiment.observed = model.input.form != Form::Run;
    let at = |setting| Scope {
        records: true,
        ..Scope::new(root, setting)
    };
    for item in &experiment.items {
        match item {
            ExperimentItem::Stimulus(drives) => {
                drives.iter().for_each(|drive| stimulus(model, drive, root))
            }
            ExperimentItem::Measured(channels) => {
                let over_time = |channel: &&ast::Channel| !response::is_response(channel);
                for channel in channels.iter().filter(over_time) {
                    measured(model, channel, root);
                }
            }
            // Found before: effects that wrap the variable act on the column.
            ExperimentItem::Replay(_) => {}
            ExperimentItem::Expect(condition, text) => {
                let scope = at(Setting::Measure);
                let typed = model.lower(condition, &scope);
                if !typed.truth {
                    model.report(refused::expects_number(condition.span));
                }
                push_measure(
                    model,
                    text.clone()
                        .unwrap_or_else(|| hyde_syntax::format_expression(condition)),
                    typed,
                    true,
                    None,
                );
            }
            ExperimentItem::Measure(measure) => add_measure(model, measure, &at(Setting::Measure)),
            ExperimentItem::Solve(method, arguments) => solve(model, method, arguments, root),
            ExperimentItem::Start(expr) => {
                let time = model.value(expr, &at(Setting::Parameter));
                agree_time(model, &time, "a run starts at a time, found", root);
                model.flat.experiment.start = Some(time.id);
            }
            ExperimentItem::Stop(expr) => {
                let time = model.value(expr, &at(Setting::Parameter));
                agree_time(model, &time, "a run stops at a time, found", root);
                model.flat.experiment.stop = Some(time.id);
            }
            ExperimentItem::Every(expr) => {
                let step = model.value(expr, &at(Setting::Parameter));
                agree_time(model, &step, "rows follow each other in time, found", root);
                must_be_positive(&model.flat, model.diagnostics, "every", &step, expr.span);
                model.flat.experiment.every = Some(step.id);
            }
            ExperimentItem::Skip(expr) => {
                let time = model.value(expr, &at(Setting::Parameter));
                agree_time(model, &time, "what is skipped is a time, found", root);
                model.flat.experiment.skip = Some(time.id);
            }
            ExperimentItem::Bode(bode) => lower_bode(model, bode, root),
            ExperimentItem::Margins(_) => {} // Cut when every stimulus is there.

            ExperimentItem::Figure(figure) => lower_figure(model, figure, root),
            ExperimentItem::Budget(_) => {} // Each of them is a run of its own, of a changed model.
        }
    }
    for item in &experiment.items {
        if let ExperimentItem::Margins(margins) = item {
            lower_margins(model, margins, root);
        }
    }
    measured_responses(model, &experiment.items, root);
    match model.input.form {
        Form::Run => {}
        Form::Observed => keep_commands(model),
        Form::Recorded => record_replays(model),
    }
}

/// Every imperfection of a budget has a name of its own.
fn check_budget(diagnostics: &mut Diagnostics, items: &[ExperimentItem]) {
    let mut known: Vec<&ast::Name> = Vec::new();
    for item in items {
        let ExperimentItem::Budget(ideals) = item else {
            continue;
        };
        for ideal in ideals {
            let name = &ideal.name;
            if let Some(first) = known.iter().find(|known| known.text == name.text) {
                diagnostics.push(refused::twice_in_budget(name, first.span));
            }
            known.push(name);
        }
    }
}

fn solve<'a>(
    model: &mut Model<'a, '_>,
    method: &'a ast::Name,
    arguments: &'a [ast::Argument],
    root: InstanceId,
) {
    model.flat.experiment.method = match method.text.as_str() {
        "ida" => Method::Ida,
        "esdirk" => Method::Esdirk,
        "auto" => Method::Auto,
        _ => {
            model.report(refused::unknown_method(method));
            Method::Ida
        }
    };
    for argument in arguments {
        let name = argument.name.as_ref().map_or("", |name| name.text.as_str());
        if name == "conserve" {
            conserve(&mut model.flat, model.diagnostics, &argument.value);
            continue;
        }
        if !matches!(name, "rtol" | "atol" | "max_step") {
            let at = argument
                .name
                .as_ref()
                .map_or(argument.value.span, |name| name.span);
            model.report(refused::unknown_option(name, at));
            continue;
        }
        let value = model.value(&argument.value, &Scope::new(root, Setting::Parameter));
        if name == "max_step" {
            agree_time(model, &value, "a step is a time, found", root);
        }
        must_be_positive(
            &model.flat,
            model.diagnostics,
            name,
            &value,
            argument.value.span,
        );
        model
            .flat
            .experiment
            .solve
            .push((name.to_owned(), value.id));
    }
}

/// A tolerance or a step of the solver; the run looks at one that parameters give.
fn must_be_positive(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    name: &str,
    value: &Typed,
    span: Span,
) {
    let constant = flat.exprs.as_constant(value.id);
    if constant.is_none_or(|constant| constant > 0.0) {
        return;
    }
    diagnostics.push(refused::not_positive(name, span));
}

/// `conserve = true` or `conserve = false`.
fn conserve(flat: &mut FlatModel, diagnostics: &mut Diagnostics, value: &ast::Expr) {
    if let ast::ExprKind::Boolean(truth) = value.kind {
        flat.experiment.conserve = truth;
        return;
    }
    diagnostics.push(refused::conserve_is_no_truth(value.span));
}
