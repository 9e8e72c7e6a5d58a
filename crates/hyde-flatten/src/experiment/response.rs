//! Measured frequency responses: `measured response(file.i, file.phi) = response(i, motor.phi)`, or the columns of a
//! record over frequency on the left.

use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, MadeBy};
use hyde_ir::VarId;
use hyde_ir::flat::{Bode, MeasuredResponse, Preparation, RecordedResponse, ScaledColumn};
use hyde_syntax::ast::{Channel, ExperimentItem, Expr, ExprKind};
use hyde_units::Dimension;

const HELP: &str = "write `response(file.u, file.y)` with columns over time, or `complex(frf.re, frf.im)` or `polar(frf.gain, frf.phase)` with columns over frequency";

/// Whether a channel compares frequency responses.
pub(super) fn is_response(channel: &Channel) -> bool {
    call(&channel.value).is_some_and(|(name, _)| name == "response")
}

fn call(expr: &Expr) -> Option<(&str, Vec<&Expr>)> {
    let ExprKind::Call(function, arguments) = &expr.kind else {
        return None;
    };
    let values = arguments.iter().map(|argument| &argument.value);
    Some((function.as_word()?, values.collect()))
}

impl<'a> Model<'a, '_> {
    /// The channels whose right side is `response(u, y)`. Stands behind what `bode` says: a response from u to y that is asked
    /// for already is the one compared.
    pub(super) fn measured_responses(&mut self, items: &'a [ExperimentItem], root: InstanceId) {
        for item in items {
            if let ExperimentItem::Measured(channels) = item {
                for channel in channels.iter().filter(|channel| is_response(channel)) {
                    self.measured_response(channel, root);
                }
            }
        }
        self.report_over_frequency();
    }

    fn measured_response(&mut self, channel: &'a Channel, root: InstanceId) {
        let Some((input, name, value)) = self.of_model(&channel.value, root) else {
            return;
        };
        let Some((source, dim)) = self.recorded_response(&channel.signal, root) else {
            return;
        };
        let over = self.dim(input);
        let model = self.typed(value.id, value.dim.divide(&over), channel.value.span);
        let left = self.typed(value.id, dim.clone(), channel.signal.span);
        self.agree(&left, &model, "the record and the model are", root);
        let deviation = match &channel.noise {
            Some(noise) => {
                let Some((column, of_noise)) = self.scaled_column(noise, root) else {
                    return;
                };
                let noise = self.typed(value.id, of_noise, noise.span);
                self.agree(&noise, &model, "the noise and the response are", root);
                Some(column)
            }
            None => None,
        };
        let place = self.place_of_response(input, &name, &value, root);
        let origin = self
            .tree
            .origin(root, channel.signal.span)
            .made_by(MadeBy::Experiment);
        self.flat
            .experiment
            .measured_responses
            .push(MeasuredResponse {
                name: channel.doc.clone().unwrap_or(name),
                source,
                deviation,
                place,
                origin,
            });
    }

    /// `response(u, y)`: the input, and the output with its name.
    fn of_model(&mut self, expr: &'a Expr, root: InstanceId) -> Option<(VarId, String, Typed)> {
        let scope = Scope::new(root, Setting::Report);
        let (_, arguments) = call(expr)?;
        let [input, output] = arguments.as_slice() else {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    "`response` takes an input of the model and a variable that responds to it",
                )
                .label(expr.span, "not two arguments")
                .help("write `response(i, motor.phi)`"),
            );
            return None;
        };
        let driven = match &input.kind {
            ExprKind::Reference(reference) => match self.resolve(reference, &scope) {
                Some(Resolved::Variable(var, None)) if self.flat.variables[var].input => Some(var),
                _ => None,
            },
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Call(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Comprehension(_)
            | ExprKind::Slice(..) => None,
        };
        let Some(driven) = driven else {
            let name = hyde_syntax::format_expression(input);
            self.report(
                Diagnostic::error(Code::NotAnInput, format!("`{name}` is not an input")).label(
                    input.span,
                    "a frequency response starts at an input of the model",
                ),
            );
            return None;
        };
        let value = self.value(output, &scope);
        Some((driven, hyde_syntax::format_expression(output), value))
    }

    /// The left side, with its dimension.
    fn recorded_response(
        &mut self,
        expr: &'a Expr,
        root: InstanceId,
    ) -> Option<(RecordedResponse, Dim)> {
        let known = call(expr);
        let parts = known
            .as_ref()
            .map(|(name, arguments)| (*name, &arguments[..]));
        match parts {
            Some(("complex", [re, im])) => {
                let (a, dim) = self.scaled_column(re, root)?;
                let (b, other) = self.scaled_column(im, root)?;
                self.same(&dim, re, &other, im, root);
                self.one_record(&a, &b, expr)?;
                Some((RecordedResponse::Complex(a, b), dim))
            }
            Some(("polar", [gain, phase])) => {
                let (a, dim) = self.scaled_column(gain, root)?;
                let (b, angle) = self.scaled_column(phase, root)?;
                self.same(&Dim::known(Dimension::ANGLE), phase, &angle, phase, root);
                self.one_record(&a, &b, expr)?;
                Some((RecordedResponse::Polar(a, b), dim))
            }
            Some(("response", [input, output, rest @ ..])) if rest.len() <= 1 => {
                let (u, below) = self.scaled_column(input, root)?;
                let (y, above) = self.scaled_column(output, root)?;
                self.one_record(&u, &y, expr)?;
                let period = match rest.first() {
                    Some(period) => {
                        let scope = Scope::new(root, Setting::Parameter);
                        let typed = self.value(period, &scope);
                        self.agree_time(&typed, "a period is a time, found", root);
                        Some(self.structural_number(&scope, period)?)
                    }
                    None => None,
                };
                let dim = above.divide(&below);
                Some((RecordedResponse::Periodic(u, y, period), dim))
            }
            _ => {
                self.report(
                    Diagnostic::error(Code::BadResponse, "this is not a measured response")
                        .label(expr.span, "cannot be compared with a frequency response")
                        .help(HELP),
                );
                None
            }
        }
    }

    fn same(&mut self, a: &Dim, at: &Expr, b: &Dim, other: &Expr, root: InstanceId) {
        let zero = self.flat.exprs.constant(0.0);
        let a = self.typed(zero, a.clone(), at.span);
        let b = self.typed(zero, b.clone(), other.span);
        self.agree(&a, &b, "the parts of a response are", root);
    }

    fn one_record(&mut self, a: &ScaledColumn, b: &ScaledColumn, expr: &Expr) -> Option<()> {
        let record = |column: &ScaledColumn| self.flat.columns[column.column].record.clone();
        let (first, second) = (record(a), record(b));
        if first == second {
            return Some(());
        }
        self.report(
            Diagnostic::error(Code::BadResponse, "a response is measured in one record")
                .label(expr.span, format!("columns of `{first}` and of `{second}`")),
        );
        None
    }

    /// A column, perhaps times a factor.
    fn scaled_column(&mut self, expr: &'a Expr, root: InstanceId) -> Option<(ScaledColumn, Dim)> {
        let mut steps = Vec::new();
        let (column, dim) = self.recorded(expr, root, false, &mut steps)?;
        let mut scale = 1.0;
        for step in steps {
            match step {
                Preparation::Scale(factor) => scale *= factor,
                Preparation::Lowpass(_) | Preparation::Slope => {
                    self.report(
                        Diagnostic::error(
                            Code::BadResponse,
                            "a column of a measured response may only be multiplied by a factor",
                        )
                        .label(expr.span, "filtered"),
                    );
                    return None;
                }
            }
        }
        Some((ScaledColumn { column, scale }, dim))
    }

    /// Columns over frequency that are read over time.
    fn report_over_frequency(&mut self) {
        let responses = &self.flat.experiment.measured_responses;
        let of_response = |id| {
            responses.iter().any(|measured| {
                let own = match &measured.source {
                    RecordedResponse::Complex(a, b) | RecordedResponse::Polar(a, b) => [a, b],
                    RecordedResponse::Periodic(..) => return false,
                };
                let mut all = own.into_iter().chain(&measured.deviation);
                all.any(|scaled| scaled.column == id)
            })
        };
        let over_frequency = |record: &String| {
            let header = self.input.records.get(record);
            let first = header.and_then(|header| header.columns.first());
            let unit = first.and_then(|(_, unit)| unit.as_ref());
            unit.is_some_and(|unit| unit.unit().dimension == Dimension::FREQUENCY)
        };
        let wrong: Vec<_> = self
            .flat
            .columns
            .enumerate()
            .filter(|(id, column)| over_frequency(&column.record) && !of_response(*id))
            .map(|(id, column)| {
                let (linear, _) = self.column_variables[&id];
                let span = self.flat.variables[linear].origin.span;
                (format!("{}.{}", column.record, column.column), span)
            })
            .collect();
        for (name, span) in wrong {
            self.report(
                Diagnostic::error(Code::BadRecord, format!("`{name}` is over frequency, not over time"))
                    .label(span, "read over time")
                    .help("only a measured response has such a record: `measured complex(frf.re, frf.im) = response(u, y);`"),
            );
        }
    }

    /// The response from that input to that value: what `bode` asks for, or one asked for by this.
    fn place_of_response(
        &mut self,
        input: VarId,
        name: &str,
        value: &Typed,
        root: InstanceId,
    ) -> (usize, usize) {
        let bodes = &self.flat.experiment.bodes;
        for (number, bode) in bodes
            .iter()
            .enumerate()
            .filter(|(_, bode)| bode.input == input)
        {
            let output = bode.outputs.iter().position(|(_, id, _)| *id == value.id);
            if let Some(output) = output {
                return (number, output);
            }
        }
        let output = (name.to_owned(), value.id, self.shown_quantity(value));
        let bodes = &mut self.flat.experiment.bodes;
        let own = |bode: &Bode| bode.input == input && bode.band.is_none();
        if let Some(number) = bodes.iter().position(own) {
            bodes[number].outputs.push(output);
            return (number, bodes[number].outputs.len() - 1);
        }
        // It is linearised where and in the modes in which that input is looked at elsewhere.
        let other = bodes.iter().find(|bode| bode.input == input);
        let (at, modes) = other.map_or_else(Default::default, |bode| (bode.at, bode.modes.clone()));
        let origin = self
            .tree
            .origin(root, value.span)
            .made_by(MadeBy::Experiment);
        self.flat.experiment.bodes.push(Bode {
            input,
            outputs: vec![output],
            band: None,
            stepped: None,
            at,
            modes,
            origin,
        });
        (self.flat.experiment.bodes.len() - 1, 0)
    }
}
