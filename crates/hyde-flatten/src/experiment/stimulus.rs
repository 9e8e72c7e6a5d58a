//! Free inputs: driven by stimuli, made parameters for linearisation, or reported.

use crate::FreeInputs;
use crate::bind::short;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Member, ParameterNotes, Scope, Setting, Typed};
use crate::model::{Model, listed};
use hyde_diag::{Code, Diagnostic, MadeBy, Origin};
use hyde_ir::flat::{Equation, Preparation};
use hyde_ir::{Expr as Ir, ExprId, Id as _, Parameter, Quantity, Range, VarId, VariableKind};
use hyde_syntax::ast::Drive;
use hyde_units::{Allowed, Kind};

impl<'a> Model<'a, '_> {
    /// `stimulus r = e`: drives a free input.
    pub(super) fn stimulus(&mut self, drive: &'a Drive, root: InstanceId) {
        let word = drive.target.as_word().unwrap_or("");
        let member = self.tree[root].members.get(word).cloned();
        let is_input = |var: VarId| self.flat.variables[var].input;
        let is_bound = |var: VarId| self.notes(var).binding.is_some();
        let input = match member {
            Some(Member::Variable(var)) => is_input(var).then_some(var),
            _ => None,
        };
        let Some(var) = input.filter(|&var| !is_bound(var)) else {
            // A declaration that is not understood is reported there.
            if self.undeclared.contains(drive.target.dotted().as_str()) {
                return;
            }
            let inputs: Vec<&str> = self.tree[root]
                .members
                .iter()
                .filter(|(_, member)| matches!(member, Member::Variable(var) if is_input(*var) && !is_bound(*var)))
                .map(|(name, _)| *name)
                .collect();
            let diagnostic = Diagnostic::error(
                Code::NotAnInput,
                format!(
                    "`{}` is not a free input of the model",
                    drive.target.dotted()
                ),
            )
            .label(drive.target.span, "cannot be driven");
            self.report(if input.is_some() {
                diagnostic.help("it has a value in the model: take that away, and it can be driven")
            } else if inputs.is_empty() {
                diagnostic.help("declare it in the model: `input Length r;`")
            } else {
                diagnostic.help(format!("its inputs are {}", listed(&inputs)))
            });
            return;
        };
        // A stepped sine takes its place.
        if self.is_stepped(word) {
            return;
        }
        let scope = Scope {
            records: true,
            ..Scope::new(root, Setting::Equation)
        };
        let boolean = self.flat.variables[var].boolean;
        let mut value = self.lower(&drive.value, &scope);
        if boolean && !value.truth {
            value = self.counted_column(value, Kind::Boolean, word);
        } else if self.notes(var).integer {
            value = self.counted_column(value, Kind::Integer, word);
        }
        let lhs = self.flat.exprs.var(var);
        let left = Typed {
            truth: boolean,
            ..self.typed(lhs, self.dim(var), drive.target.span)
        };
        self.same_kind(&left, &value);
        self.check_whole(&left, &value);
        self.agree(&left, &value, "the input and its stimulus are", root);
        self.noise_of_column(drive, (&left, value.id), root);
        let origin = self
            .tree
            .origin(root, drive.target.span)
            .made_by(MadeBy::Experiment);
        self.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs: value.id,
            origin,
        });
    }

    /// `~ sd` of a stimulus or a replay, in the unit of what is driven: what its column is not known to.
    pub(super) fn noise_of_column(
        &mut self,
        drive: &'a Drive,
        by: (&Typed, ExprId),
        root: InstanceId,
    ) {
        let Some(noise) = &drive.noise else {
            return;
        };
        let (driven, value) = by;
        let sd = self.value(noise, &Scope::new(root, Setting::Parameter));
        self.agree(&sd, driven, "the noise and what is driven are", root);
        let mut steps = Vec::new();
        let column = match self.reads_a_column(value) {
            true => self.recorded(&drive.value, root, false, &mut steps),
            false => None,
        };
        let factor = |step: &Preparation| match step {
            Preparation::Scale(factor) => Some(*factor),
            Preparation::Lowpass(_) | Preparation::Slope => None,
        };
        let factors: Option<Vec<f64>> = steps.iter().map(factor).collect();
        let (Some((column, _)), Some(factors)) = (column, factors) else {
            self.report(
                Diagnostic::error(
                    Code::NoColumn,
                    format!(
                        "`{}` has noise, but its stimulus is not a single column",
                        drive.target.dotted()
                    ),
                )
                .label(
                    drive.value.span,
                    "neither a column of a record nor a column times a number",
                )
                .help("only a recorded column has noise: remove `~`, or write `file.i ~ 15 [mA]`"),
            );
            return;
        };
        let scale: f64 = factors.into_iter().product();
        if let Some(sd) = self.current_value(sd.id) {
            self.flat.columns[column].noise = (sd / scale).abs();
        }
    }

    fn reads_a_column(&self, value: ExprId) -> bool {
        let column = |id: ExprId| {
            let read = self.flat.exprs[id].access();
            let kind = read.map(|(var, ..)| self.flat.variables[var].kind);
            matches!(kind, Some(VariableKind::Column(..)))
        };
        self.flat.exprs.below(&[value]).into_iter().any(column)
    }

    /// A column that drives a Boolean or an Integer is held between its rows; the run looks at the value of each.
    fn counted_column(&mut self, value: Typed, kind: Kind, input: &str) -> Typed {
        let Ir::Var(var, index) = self.flat.exprs[value.id] else {
            return value;
        };
        let VariableKind::Column(column, _) = self.flat.variables[var].kind else {
            return value;
        };
        let (_, held) = self.column_variables[&column];
        self.flat.columns[column].drives = Some((kind, input.to_owned(), value.span));
        let number = self.flat.exprs.add(Ir::Var(held, index));
        if kind == Kind::Integer {
            self.variables[held.index()].integer = true;
            return Typed {
                id: number,
                ..value
            };
        }
        let half = self.flat.exprs.constant(0.5);
        Typed {
            id: self.flat.exprs.binary(hyde_ir::BinaryOp::Gt, number, half),
            truth: true,
            ..value
        }
    }

    /// A parameter that the model does not declare, for what drives it from outside.
    pub(super) fn outer_parameter(
        &mut self,
        name: String,
        dim: Dim,
        quantity: Quantity,
        value: ExprId,
        origin: &Origin,
    ) -> ExprId {
        self.parameters.push(ParameterNotes::made(dim));
        let param = self.flat.parameters.push(Parameter {
            name,
            len: None,
            value: vec![value],
            quantity,
            allowed: Allowed::default(),
            structural: false,
            is_final: false,
            found: false,
            derived: false,
            prior: None,
            role: hyde_ir::Role::Plain,
            range: None,
            source: None,
            origin: origin.clone(),
        });
        self.flat.experiment.free.push(param);
        let parameter = Ir::Param(param, hyde_ir::Index::SCALAR);
        self.flat.exprs.add(parameter)
    }

    /// Makes free inputs parameters of their names with the value zero: what a linearised model is driven by, or what another
    /// tool sets. A stimulus is what such a parameter is added to; one of a truth stays alone.
    pub(crate) fn free_inputs(&mut self, root: InstanceId) {
        let free = self.input.free_inputs;
        if free == FreeInputs::None {
            return;
        }
        let members: Vec<VarId> = self.tree[root]
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
            let stimulus = self.stimulus_of(var);
            let variable = &self.flat.variables[var];
            if stimulus.is_some() && (variable.boolean || free == FreeInputs::Undriven) {
                continue;
            }
            let origin = variable.origin.clone().made_by(MadeBy::Experiment);
            let (name, quantity) = (variable.name.clone(), variable.quantity.clone());
            let zero = self.flat.exprs.constant(0.0);
            let free = self.outer_parameter(name, self.dim(var), quantity, zero, &origin);
            if let Some(number) = stimulus {
                let equation = &mut self.flat.equations[number];
                equation.rhs = self.flat.exprs.plus(equation.rhs, free);
                continue;
            }
            let lhs = self.flat.exprs.var(var);
            self.flat.equations.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs: free,
                origin,
            });
        }
    }

    /// The number of the equation by which a stimulus drives an input.
    fn stimulus_of(&self, input: VarId) -> Option<usize> {
        let target = Ir::Var(input, hyde_ir::Index::SCALAR);
        let mut equations = self.flat.equations.iter();
        equations.position(|equation| self.flat.exprs[equation.lhs] == target)
    }

    /// The free inputs of the model that nothing drives.
    pub(crate) fn report_undriven(&mut self) {
        let mut undriven = Vec::new();
        for (id, variable) in self.flat.variables.enumerate() {
            let notes = &self.variables[id.index()];
            let top = self.tree[notes.instance].parent.is_none();
            if !variable.input || !top || notes.binding.is_some() {
                continue;
            }
            if self.stimulus_of(id).is_none() {
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
