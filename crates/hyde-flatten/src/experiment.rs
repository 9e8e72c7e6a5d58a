//! The experiment: stimuli drive the free inputs, measured channels name their columns, measures reduce the run.

use crate::bind::short;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Lowering, Member, ParameterNotes, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::{Model, listed};
use crate::names::nearest;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::flat::{Bode, Equation, Measure, Measured, Preparation, Stop};
use hyde_ir::{
    Column, ColumnId, Expr as Ir, Id as _, Interpolation, Parameter, Quantity, Range, VarId,
    VariableKind,
};
use hyde_syntax::ast::{self, Channel, Drive, ExperimentItem, Expr, ExprKind, Reference};
use hyde_units::{Dimension, NamedUnit};

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
        let at = |setting| Scope {
            records: true,
            ..Scope::new(root, setting)
        };
        for item in &experiment.items {
            match item {
                // A linearised model is driven through its inputs themselves.
                ExperimentItem::Stimulus(_) if self.input.free_inputs => {}
                ExperimentItem::Stimulus(drives) => {
                    drives.iter().for_each(|drive| self.stimulus(drive, root))
                }
                ExperimentItem::Measured(channels) => channels
                    .iter()
                    .for_each(|channel| self.measured(channel, root)),
                ExperimentItem::Replay(_) => {} // A cut that fit and diagnose make; a run keeps the loop closed.
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
                ExperimentItem::Stop(expr) => self.stop(expr, &at(Setting::Parameter)),
                ExperimentItem::Every(expr) => {
                    let step = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&step, "rows follow each other in time, this relates", root);
                    self.flat.experiment.every = Some(step.id);
                }
                ExperimentItem::Skip(expr) => {
                    let time = self.value(expr, &at(Setting::Parameter));
                    self.agree_time(&time, "what is skipped is a time, this relates", root);
                    self.flat.experiment.skip = Some(time.id);
                }
                ExperimentItem::Bode(bode) => self.bode(bode, root),
            }
        }
    }

    /// `record.column`, `.next`, `.first`.
    pub(crate) fn record_column(
        &mut self,
        reference: &'a Reference,
        scope: &Scope<'a>,
    ) -> Option<Resolved> {
        let record = reference.parts.first()?.name.text.clone();
        let (column, suffix) = match reference.parts.as_slice() {
            [_, column] => (column.name.text.as_str(), None),
            [_, column, suffix] => (column.name.text.as_str(), Some(suffix.name.text.as_str())),
            _ => {
                self.report(
                    Diagnostic::error(Code::NoColumn, "which column of the record?")
                        .label(reference.span, "names a record")
                        .help(format!("write `{record}.column`")),
                );
                return None;
            }
        };
        let header = self.input.records.get(&record);
        let known =
            header.and_then(|header| header.columns.iter().find(|(name, _)| name == column));
        let Some((_, unit)) = known else {
            let names: Vec<&str> = header
                .map(|header| {
                    header
                        .columns
                        .iter()
                        .map(|(name, _)| name.as_str())
                        .collect()
                })
                .unwrap_or_default();
            let near = nearest(column, names.iter().copied());
            let diagnostic = Diagnostic::error(
                Code::NoColumn,
                format!("the record `{record}` has no column `{column}`"),
            )
            .label(
                reference
                    .parts
                    .get(1)
                    .map_or(reference.span, |part| part.name.span),
                "not in its header",
            );
            let diagnostic = match near {
                Some(near) => diagnostic
                    .note(format!("its columns are {}", listed(&names)))
                    .help(format!("did you mean `{record}.{near}`?")),
                None if names.is_empty() => {
                    diagnostic.help("the record was not given: `--record NAME=PATH`")
                }
                None => diagnostic.help(format!("its columns are {}", listed(&names))),
            };
            self.report(diagnostic);
            return None;
        };
        let unit = unit.clone();
        match suffix {
            None | Some("next") => {
                if scope.setting == Setting::Parameter {
                    self.not_constant(&format!("`{record}.{column}`"), reference.span);
                    return None;
                }
                let (_, linear, _) =
                    self.column(&record, column, unit, suffix.is_some(), reference.span);
                Some(Resolved::Variable(linear, None))
            }
            Some("first") => Some(Resolved::Parameter(
                self.first_value(&record, column, unit, reference.span),
                None,
            )),
            Some(other) => {
                self.report(
                    Diagnostic::error(Code::NoColumn, format!("a column has no `{other}`"))
                        .label(reference.span, "unknown")
                        .help("write `.next` for the value one row ahead, `.first` for the first"),
                );
                None
            }
        }
    }

    /// The column and its linear and held variables, made at first use.
    fn column(
        &mut self,
        record: &str,
        column: &str,
        unit: Option<NamedUnit>,
        next: bool,
        span: Span,
    ) -> (ColumnId, VarId, VarId) {
        let known = self.flat.columns.enumerate().find(|(_, known)| {
            known.record == record && known.column == column && known.next == next
        });
        if let Some((id, _)) = known {
            let (linear, held) = self.column_variables[&id];
            return (id, linear, held);
        }
        let id = self.flat.columns.push(Column {
            record: record.to_owned(),
            column: column.to_owned(),
            next,
            scale: (1.0, 0.0),
        });
        let dim = match &unit {
            Some(unit) => Dim::known(unit.unit().dimension),
            None => Dim::unknown(self.dimensions.fresh()),
        };
        let name = format!("{record}.{column}{}", if next { ".next" } else { "" });
        let linear = VariableKind::Column(id, Interpolation::Linear);
        let held = VariableKind::Column(id, Interpolation::Held);
        let linear = self.add_variable(
            0,
            name.clone(),
            linear,
            dim.clone(),
            span,
            MadeBy::Experiment,
        );
        let held = self.add_variable(
            0,
            format!("held({name})"),
            held,
            dim,
            span,
            MadeBy::Experiment,
        );
        if let Some(unit) = unit {
            let quantity = Quantity {
                dimension: unit.unit().dimension,
                unit,
            };
            self.flat.variables[linear].quantity = quantity.clone();
            self.flat.variables[held].quantity = quantity;
        }
        self.column_variables.insert(id, (linear, held));
        (id, linear, held)
    }

    /// The first value of a column: a parameter that the run fills in.
    fn first_value(
        &mut self,
        record: &str,
        column: &str,
        unit: Option<NamedUnit>,
        span: Span,
    ) -> hyde_ir::ParamId {
        let key = (record.to_owned(), column.to_owned());
        if let Some(&param) = self.column_firsts.get(&key) {
            return param;
        }
        let (_, linear, _) = self.column(record, column, unit.clone(), false, span);
        let dim = self.dim(linear);
        let zero = self.flat.exprs.constant(0.0);
        self.parameters.push(ParameterNotes {
            dim,
            binding: None,
            state: Lowering::Done,
            boolean: false,
        });
        let quantity = self.flat.variables[linear].quantity.clone();
        let origin = self.origin(0, span).made_by(MadeBy::Experiment);
        let param = self.flat.parameters.push(Parameter {
            name: format!("{record}.{column}.first"),
            len: None,
            value: vec![zero],
            quantity,
            structural: false,
            is_final: false,
            derived: false,
            prior: None,
            source: Some(format!("record {record}")),
            origin,
        });
        self.column_firsts.insert(key, param);
        param
    }

    /// `stimulus r = e`: drives a free input.
    fn stimulus(&mut self, drive: &'a Drive, root: InstanceId) {
        let word = drive.target.as_word().unwrap_or("");
        let member = self.instances[root].members.get(word).cloned();
        let free = match member {
            Some(Member::Variable(var)) => {
                let variable = &self.flat.variables[var];
                (variable.input && self.notes(var).binding.is_none()).then_some(var)
            }
            _ => None,
        };
        let Some(var) = free else {
            let inputs: Vec<&str> = self.instances[root]
                .members
                .iter()
                .filter(|(_, member)| matches!(member, Member::Variable(var) if self.flat.variables[*var].input))
                .map(|(name, _)| *name)
                .collect();
            let diagnostic = Diagnostic::error(
                Code::NotAnInput,
                format!("`{}` is no free input of the model", drive.target.dotted()),
            )
            .label(drive.target.span, "cannot be driven");
            self.report(if inputs.is_empty() {
                diagnostic.help("declare it in the model: `input Length r;`")
            } else {
                diagnostic.help(format!("its inputs are {}", listed(&inputs)))
            });
            return;
        };
        let scope = Scope {
            records: true,
            ..Scope::new(root, Setting::Equation)
        };
        let value = self.value(&drive.value, &scope);
        let lhs = self.flat.exprs.var(var);
        let left = self.typed(lhs, self.dim(var), drive.target.span);
        self.agree(&left, &value, "the input and its stimulus are", root);
        let origin = self
            .origin(root, drive.target.span)
            .made_by(MadeBy::Experiment);
        self.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs: value.id,
            origin,
        });
    }

    /// `measured column = e ~ noise`.
    fn measured(&mut self, channel: &'a Channel, root: InstanceId) {
        let mut preparation = Vec::new();
        let Some((column, mut dim)) = self.recorded(&channel.signal, root, &mut preparation) else {
            return;
        };
        let scope = Scope {
            records: true,
            ..Scope::new(root, Setting::Report)
        };
        let value = self.value(&channel.value, &scope);
        let left = self.typed(value.id, dim.clone(), channel.signal.span);
        self.agree(&left, &value, "the record and the model are", root);
        let noise = channel.noise.as_ref().map(|noise| {
            let typed = self.value(noise, &scope.with(Setting::Parameter));
            self.agree(&typed, &value, "the noise and the value are", root);
            typed.id
        });
        if dim.as_known().is_none() {
            dim = value.dim.clone();
        }
        let dimension = self
            .dimensions
            .resolve(&dim)
            .as_known()
            .unwrap_or(Dimension::DIMENSIONLESS);
        let written = &self.flat.variables[self.column_variables[&column].0].quantity;
        let quantity = if preparation.is_empty() && written.dimension == dimension {
            written.clone()
        } else {
            Quantity::usual(dimension)
        };
        let clocked = !self.clocks_of(value.id).is_empty();
        let signal = hyde_syntax::format_expression(&channel.signal);
        let name = match (&channel.doc, signal.split_once('.')) {
            (Some(doc), _) => doc.clone(),
            (None, Some((_, column))) if preparation.is_empty() => column.to_owned(),
            (None, _) => signal,
        };
        let origin = self
            .origin(root, channel.signal.span)
            .made_by(MadeBy::Experiment);
        self.flat.experiment.measured.push(Measured {
            name,
            column,
            preparation,
            value: value.id,
            clocked,
            noise,
            quantity,
            origin,
        });
    }

    /// The recorded signal of a measured channel: a column, low-passed, differentiated or scaled.
    fn recorded(
        &mut self,
        expr: &'a Expr,
        root: InstanceId,
        steps: &mut Vec<Preparation>,
    ) -> Option<(ColumnId, Dim)> {
        let scope = Scope {
            records: true,
            ..Scope::new(root, Setting::Report)
        };
        match &expr.kind {
            ExprKind::Reference(reference) => {
                if let Some(Resolved::Variable(var, None)) = self.resolve(reference, &scope) {
                    if let VariableKind::Column(column, _) = self.flat.variables[var].kind {
                        return Some((column, self.dim(var)));
                    }
                    self.report(
                        Diagnostic::error(
                            Code::NoColumn,
                            format!("`{}` is no column of a record", reference.dotted()),
                        )
                        .label(expr.span, "left of `=` stands what was measured")
                        .help("write `measured file.x = saddle.s;`"),
                    );
                }
                None
            }
            ExprKind::Call(function, arguments) => {
                match (function.as_word(), arguments.as_slice()) {
                    (Some("lowpass"), [inner, corner]) => {
                        let found = self.recorded(&inner.value, root, steps)?;
                        let parameter = scope.with(Setting::Parameter);
                        let corner_typed = self.value(&corner.value, &parameter);
                        let rate = Typed {
                            dim: Dim::NUMBER.divide(&Dim::known(Dimension::TIME)),
                            ..corner_typed.clone()
                        };
                        self.agree(
                            &corner_typed,
                            &rate,
                            "a corner is a frequency, this relates",
                            root,
                        );
                        let corner = self.structural_number(&parameter, &corner.value)?;
                        steps.push(Preparation::Lowpass(corner));
                        Some(found)
                    }
                    (Some("slope"), [inner]) => {
                        let (column, dim) = self.recorded(&inner.value, root, steps)?;
                        steps.push(Preparation::Slope);
                        Some((column, dim.divide(&Dim::known(Dimension::TIME))))
                    }
                    _ => {
                        self.report(
                        Diagnostic::error(Code::BadArguments, "a record is prepared with `lowpass(x, f)`, `slope(x)`, or a factor")
                            .label(expr.span, "not one of these"),
                    );
                        None
                    }
                }
            }
            ExprKind::Binary(ast::Binary::Mul, factor, inner) => {
                let parameter = scope.with(Setting::Parameter);
                let typed = self.value(factor, &parameter);
                let number = self.structural_number(&parameter, factor)?;
                let (column, dim) = self.recorded(inner, root, steps)?;
                steps.push(Preparation::Scale(number));
                Some((column, typed.dim.multiply(&dim)))
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..) => {
                self.report(
                    Diagnostic::error(Code::NoColumn, "what was measured is a column of a record")
                        .label(expr.span, "no column")
                        .help("write `measured file.x = saddle.s;`"),
                );
                None
            }
        }
    }

    pub(crate) fn add_measure(&mut self, measure: &'a ast::Measure, scope: &Scope<'a>) {
        let typed = self.lower(&measure.value, scope);
        let file = self.instances[scope.instance].file;
        let mut unit = None;
        match self.names.quantity(file, &measure.type_name) {
            Some(crate::names::TypeName::Quantity(_, item)) => {
                unit = item
                    .unit
                    .as_ref()
                    .and_then(|unit| NamedUnit::parse(&unit.text).ok());
                if let Some(unit) = &unit {
                    let declared = Typed {
                        dim: Dim::known(unit.unit().dimension),
                        span: measure.name.span,
                        ..typed.clone()
                    };
                    self.agree(
                        &declared,
                        &typed,
                        "the measure and its value are",
                        scope.instance,
                    );
                }
            }
            Some(_) => {}
            None => {
                let diagnostic = self.names.unknown(file, &measure.type_name);
                self.report(diagnostic);
            }
        }
        self.push_measure(measure.name.text.clone(), typed, false, unit);
    }

    fn push_measure(
        &mut self,
        name: String,
        typed: Typed,
        expectation: bool,
        unit: Option<NamedUnit>,
    ) {
        let dimension = self
            .dimensions
            .resolve(&typed.dim)
            .as_known()
            .unwrap_or(Dimension::DIMENSIONLESS);
        let quantity = match unit {
            Some(unit) => Quantity {
                dimension: unit.unit().dimension,
                unit,
            },
            None => Quantity::usual(dimension),
        };
        let origin = self.origin(0, typed.span).made_by(MadeBy::Experiment);
        self.flat.experiment.measures.push(Measure {
            name,
            value: typed.id,
            expectation,
            quantity,
            origin,
        });
    }

    fn solve(&mut self, method: &'a ast::Name, arguments: &'a [ast::Argument], root: InstanceId) {
        if !matches!(method.text.as_str(), "ida" | "auto") {
            self.report(
                Diagnostic::error(
                    Code::BadSolve,
                    format!("no method is called `{}`", method.text),
                )
                .label(method.span, "not known")
                .help("write `solve ida(rtol = 1e-6)`"),
            );
        }
        for argument in arguments {
            let name = argument.name.as_ref().map_or("", |name| name.text.as_str());
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
                        .help("options are `rtol`, `atol` and `max_step`"),
                );
                continue;
            }
            let value = self.value(&argument.value, &Scope::new(root, Setting::Parameter));
            if name == "max_step" {
                self.agree_time(&value, "a step is a time, this relates", root);
            }
            self.flat.experiment.solve.push((name.to_owned(), value.id));
        }
    }

    fn stop(&mut self, expr: &'a Expr, scope: &Scope<'a>) {
        if let ExprKind::Reference(reference) = &expr.kind
            && let [record, end] = reference.parts.as_slice()
            && end.name.text == "end"
            && self.flat.experiment.records.contains(&record.name.text)
        {
            self.flat.experiment.stop = Some(Stop::EndOf(record.name.text.clone()));
            return;
        }
        let time = self.value(expr, scope);
        self.agree_time(&time, "a run stops at a time, this relates", scope.instance);
        self.flat.experiment.stop = Some(Stop::At(time.id));
    }

    fn bode(&mut self, bode: &'a ast::Bode, root: InstanceId) {
        let (input, outputs, band) = (&bode.input, &bode.outputs, &bode.band);
        let scope = Scope::new(root, Setting::Report);
        let driven = match self.resolve(input, &scope) {
            Some(Resolved::Variable(var, None)) if self.flat.variables[var].input => var,
            _ => {
                self.report(
                    Diagnostic::error(
                        Code::NotAnInput,
                        format!("`{}` is no input", input.dotted()),
                    )
                    .label(
                        input.span,
                        "a frequency response starts at an input of the model",
                    ),
                );
                return;
            }
        };
        let mut list = Vec::new();
        for output in outputs {
            let typed = self.value(output, &scope);
            let dimension = self
                .dimensions
                .resolve(&typed.dim)
                .as_known()
                .unwrap_or(Dimension::DIMENSIONLESS);
            list.push((
                hyde_syntax::format_expression(output),
                typed.id,
                Quantity::usual(dimension),
            ));
        }
        let parameter = Scope::new(root, Setting::Parameter);
        let (from, to) = (
            self.value(&band.from, &parameter),
            self.value(&band.to, &parameter),
        );
        let rate = Typed {
            dim: Dim::NUMBER.divide(&Dim::known(Dimension::TIME)),
            ..from.clone()
        };
        self.agree(&from, &rate, "a band of frequencies relates", root);
        self.agree(&to, &rate, "a band of frequencies relates", root);
        let modes = bode
            .modes
            .iter()
            .filter_map(|(name, mode)| self.mode_of(name, mode))
            .collect();
        let origin = self.origin(root, input.span).made_by(MadeBy::Experiment);
        let band = (from.id, to.id);
        self.flat.experiment.bodes.push(Bode {
            input: driven,
            outputs: list,
            band,
            modes,
            origin,
        });
    }

    /// An automaton by the name of its instance, and one of its modes.
    fn mode_of(
        &mut self,
        name: &Reference,
        mode: &ast::Name,
    ) -> Option<(hyde_ir::AutomatonId, usize)> {
        let path = name.dotted();
        let found = self
            .flat
            .automata
            .enumerate()
            .find(|(_, automaton)| automaton.name == path);
        let Some((id, automaton)) = found else {
            let known: Vec<&str> = self
                .flat
                .automata
                .iter()
                .map(|automaton| automaton.name.as_str())
                .collect();
            let help = format!("modes are in {}", listed(&known));
            self.report(
                Diagnostic::error(Code::UnknownName, format!("`{path}` has no modes"))
                    .label(name.span, "no `modes` block")
                    .help(help),
            );
            return None;
        };
        let number = automaton
            .modes
            .iter()
            .position(|known| known.name == mode.text);
        if number.is_none() {
            let known: Vec<&str> = automaton
                .modes
                .iter()
                .map(|mode| mode.name.as_str())
                .collect();
            let help = format!("its modes are {}", listed(&known));
            self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    format!("`{path}` has no mode `{}`", mode.text),
                )
                .label(mode.span, "not known")
                .help(help),
            );
        }
        Some((id, number?))
    }

    fn agree_time(&mut self, value: &Typed, what: &'static str, instance: InstanceId) {
        let time = Typed {
            dim: Dim::known(Dimension::TIME),
            ..value.clone()
        };
        self.agree(value, &time, what, instance);
    }

    /// Makes every free input a parameter of its name with the value zero: what a linearised model is driven by.
    pub(crate) fn free_inputs(&mut self, root: InstanceId) {
        if !self.input.free_inputs {
            return;
        }
        let members: Vec<VarId> = self.instances[root]
            .members
            .values()
            .filter_map(|member| {
                if let Member::Variable(var) = member {
                    Some(*var)
                } else {
                    None
                }
            })
            .filter(|&var| self.flat.variables[var].input && self.notes(var).binding.is_none())
            .collect();
        for var in members {
            let (dim, quantity) = (self.dim(var), self.flat.variables[var].quantity.clone());
            let zero = self.flat.exprs.constant(0.0);
            self.parameters.push(ParameterNotes {
                dim,
                binding: None,
                state: Lowering::Done,
                boolean: false,
            });
            let origin = self.flat.variables[var]
                .origin
                .clone()
                .made_by(MadeBy::Experiment);
            let param = self.flat.parameters.push(Parameter {
                name: self.flat.variables[var].name.clone(),
                len: None,
                value: vec![zero],
                quantity,
                structural: false,
                is_final: false,
                derived: false,
                prior: None,
                source: None,
                origin: origin.clone(),
            });
            let lhs = self.flat.exprs.var(var);
            let rhs = self
                .flat
                .exprs
                .add(Ir::Param(param, hyde_ir::Index::SCALAR));
            self.flat.equations.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs,
                origin,
            });
        }
    }

    /// The free inputs of the model that nothing drives.
    pub(crate) fn report_undriven(&mut self) {
        let mut undriven = Vec::new();
        for (id, variable) in self.flat.variables.enumerate() {
            let notes = &self.variables[id.index()];
            let top = self.instances[notes.instance].parent.is_none();
            if !variable.input || !top || notes.binding.is_some() {
                continue;
            }
            let target = Ir::Var(id, hyde_ir::Index::SCALAR);
            let driven = self
                .flat
                .equations
                .iter()
                .any(|equation| self.flat.exprs[equation.lhs] == target);
            if !driven {
                undriven.push((variable.name.clone(), variable.origin.span));
            }
        }
        for (name, span) in undriven {
            let help = match self.input.experiment {
                Some(experiment) => {
                    format!("write in `experiment {experiment}`: `stimulus {name} = …;`")
                }
                None => format!("run an experiment that drives it: `stimulus {name} = …;`"),
            };
            self.report(
                Diagnostic::error(
                    Code::UndrivenInput,
                    format!("the input `{}` is not driven", short(&name)),
                )
                .label(span, "a free input of the model")
                .help(help),
            );
        }
    }
}
