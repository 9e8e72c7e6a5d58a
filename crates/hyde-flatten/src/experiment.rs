//! The experiment: stimuli drive the free inputs, measured channels name their columns, measures reduce the run.

mod bode;
mod cut;
mod figure;
mod late;
mod measure;
mod measured;
mod observed;
mod record;
mod replay;
mod response;
mod stepped;
mod stimulus;
mod wrapped;

pub(crate) use replay::Replay;

use crate::Form;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_ir::flat::Method;
use hyde_syntax::ast::{self, ExperimentItem};
use hyde_units::Dimension;

impl<'a> Model<'a, '_> {
    /// Lowers the experiment asked for; without one, every input must have a value of its own.
    pub(crate) fn experiment(&mut self, root: InstanceId) {
        let Some(name) = self.input.experiment else {
            return;
        };
        let Some(experiment) = self.names.own_experiment(name) else {
            if let Some((file, _)) = self.input.files.first() {
                let file = *file;
                self.report(
                    Diagnostic::error(
                        Code::NoExperiment,
                        format!("the file has no experiment `{name}`"),
                    )
                    .label(Span::new(file, 0, 0), "searched in this file"),
                );
            }
            return;
        };
        self.flat.experiment.name = experiment.name.text.clone();
        self.check_budget(&experiment.items);
        self.flat.experiment.observed = self.input.form != Form::Run;
        let at = |setting| Scope {
            records: true,
            ..Scope::new(root, setting)
        };
        for item in &experiment.items {
            match item {
                ExperimentItem::Stimulus(drives) => {
                    drives.iter().for_each(|drive| self.stimulus(drive, root))
                }
                ExperimentItem::Measured(channels) => {
                    let over_time = |channel: &&ast::Channel| !response::is_response(channel);
                    for channel in channels.iter().filter(over_time) {
                        self.measured(channel, root);
                    }
                }
                // Found before: effects that wrap the variable act on the column.
                ExperimentItem::Replay(_) => {}
                ExperimentItem::Expect(condition, text) => {
                    let scope = at(Setting::Measure);
                    let typed = self.lower(condition, &scope);
                    if !typed.truth {
                        self.report(
                            Diagnostic::error(Code::WrongType, "an expectation is a condition")
                                .label(condition.span, "a number")
                                .help("compare it: `expect max(abs(e)) < 10 [um]`"),
                        );
                    }
                    self.push_measure(
                        text.clone()
                            .unwrap_or_else(|| hyde_syntax::format_expression(condition)),
                        typed,
                        true,
                        None,
                    );
                }
                ExperimentItem::Measure(measure) => {
                    self.add_measure(measure, &at(Setting::Measure))
                }
                ExperimentItem::Solve(method, arguments) => self.solve(method, arguments, root),
                ExperimentItem::Start(expr) => {
                    let time = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&time, "a run starts at a time, found", root);
                    self.flat.experiment.start = Some(time.id);
                }
                ExperimentItem::Stop(expr) => {
                    let time = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&time, "a run stops at a time, found", root);
                    self.flat.experiment.stop = Some(time.id);
                }
                ExperimentItem::Every(expr) => {
                    let step = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&step, "rows follow each other in time, found", root);
                    self.must_be_positive("every", &step, expr.span);
                    self.flat.experiment.every = Some(step.id);
                }
                ExperimentItem::Skip(expr) => {
                    let time = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&time, "what is skipped is a time, found", root);
                    self.flat.experiment.skip = Some(time.id);
                }
                ExperimentItem::Bode(bode) => self.bode(bode, root),
                ExperimentItem::Margins(_) => {} // Cut when every stimulus is there.

                ExperimentItem::Figure(figure) => self.figure(figure, root),
                ExperimentItem::Budget(_) => {} // Each of them is a run of its own, of a changed model.
            }
        }
        for item in &experiment.items {
            if let ExperimentItem::Margins(margins) = item {
                self.margins(margins, root);
            }
        }
        self.measured_responses(&experiment.items, root);
        if self.input.form == Form::Recorded {
            self.record_replays();
        }
    }

    /// Every imperfection of a budget has a name of its own.
    fn check_budget(&mut self, items: &'a [ExperimentItem]) {
        let mut known: Vec<&ast::Name> = Vec::new();
        for item in items {
            let ExperimentItem::Budget(ideals) = item else {
                continue;
            };
            for ideal in ideals {
                let name = &ideal.name;
                if let Some(first) = known.iter().find(|known| known.text == name.text) {
                    let message = format!("the budget has `{}` twice", name.text);
                    let diagnostic = Diagnostic::error(Code::Duplicate, message)
                        .label(name.span, "here again")
                        .label(first.span, "here first")
                        .help("give it another name, or combine all changes in one: `play(a.gap = 0, b.gap = 0)`");
                    self.report(diagnostic);
                }
                known.push(name);
            }
        }
    }

    fn solve(&mut self, method: &'a ast::Name, arguments: &'a [ast::Argument], root: InstanceId) {
        self.flat.experiment.method = match method.text.as_str() {
            "ida" => Method::Ida,
            "esdirk" => Method::Esdirk,
            "auto" => Method::Auto,
            other => {
                self.report(
                    Diagnostic::error(Code::BadSolve, format!("there is no method `{other}`"))
                        .label(method.span, "not known")
                        .help("methods are `ida`, `esdirk` and `auto`: `solve ida(rtol = 1e-6)`"),
                );
                Method::Ida
            }
        };
        for argument in arguments {
            let name = argument.name.as_ref().map_or("", |name| name.text.as_str());
            if name == "conserve" {
                self.conserve(&argument.value);
                continue;
            }
            if !matches!(name, "rtol" | "atol" | "max_step") {
                self.report(
                    Diagnostic::error(Code::BadSolve, format!("the solver has no option `{name}`"))
                        .label(
                            argument
                                .name
                                .as_ref()
                                .map_or(argument.value.span, |name| name.span),
                            "not known",
                        )
                        .help("options are `rtol`, `atol`, `max_step` and `conserve`"),
                );
                continue;
            }
            let value = self.value(&argument.value, &Scope::new(root, Setting::Parameter));
            if name == "max_step" {
                self.agree_time(&value, "a step is a time, found", root);
            }
            self.must_be_positive(name, &value, argument.value.span);
            self.flat.experiment.solve.push((name.to_owned(), value.id));
        }
    }

    /// A tolerance or a step of the solver; the run looks at one that parameters give.
    fn must_be_positive(&mut self, name: &str, value: &Typed, span: Span) {
        let constant = self.flat.exprs.as_constant(value.id);
        if constant.is_none_or(|constant| constant > 0.0) {
            return;
        }
        let usual = match name {
            "rtol" => "rtol = 1e-6",
            "atol" => "atol = 1e-9",
            "max_step" => "max_step = 1 [ms]",
            _ => "every 1 [ms]",
        };
        self.report(
            Diagnostic::error(Code::BadSolve, format!("`{name}` must be positive"))
                .label(span, "zero or less")
                .help(format!("write `{usual}`, for example, or leave it out")),
        );
    }

    /// `conserve = true` or `conserve = false`.
    fn conserve(&mut self, value: &ast::Expr) {
        if let ast::ExprKind::Boolean(truth) = value.kind {
            self.flat.experiment.conserve = truth;
            return;
        }
        self.report(
            Diagnostic::error(Code::BadSolve, "`conserve` is `true` or `false`")
                .label(value.span, "neither of them")
                .help("write `conserve = true` where energy must be kept over a long run, else leave it out"),
        );
    }

    fn agree_time(&mut self, value: &Typed, what: &'static str, instance: InstanceId) {
        let time = Typed {
            dim: Dim::known(Dimension::TIME),
            ..value.clone()
        };
        self.agree(&time, value, what, instance);
    }
}
