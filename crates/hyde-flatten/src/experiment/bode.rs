//! Frequency responses.

use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::lower::Resolved;
use crate::model::{Model, listed, quantity_of};
use hyde_diag::{Code, Diagnostic, MadeBy};
use hyde_ir::flat::{Bode, Moment};
use hyde_ir::{ExprId, Quantity};
use hyde_syntax::ast::{self, Reference};
use hyde_units::Dimension;

impl<'a> Model<'a, '_> {
    pub(super) fn bode(&mut self, bode: &'a ast::Bode, root: InstanceId) {
        let (input, outputs, band) = (&bode.input, &bode.outputs, &bode.band);
        let scope = Scope::new(root, Setting::Report);
        let driven = match self.resolve(input, &scope) {
            Some(Resolved::Variable(var, None)) if self.flat.variables[var].input => var,
            _ => {
                self.report(
                    Diagnostic::error(
                        Code::NotAnInput,
                        format!("`{}` is not an input", input.dotted()),
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
            let quantity = self.shown_quantity(&typed);
            list.push((hyde_syntax::format_expression(output), typed.id, quantity));
        }
        let band = Some(self.band(band, root));
        let at = self.moment(bode.at.as_ref(), root);
        let modes = self.chosen_modes(&bode.modes);
        let origin = self
            .tree
            .origin(root, input.span)
            .made_by(MadeBy::Experiment);
        let names: Vec<&str> = list.iter().map(|(name, ..)| name.as_str()).collect();
        let stepped = bode
            .steps
            .as_ref()
            .and_then(|(method, arguments)| self.stepped(driven, method, arguments, &names, root));
        self.flat.experiment.bodes.push(Bode {
            input: driven,
            outputs: list,
            band,
            stepped,
            at,
            modes,
            origin,
        });
    }

    /// Where the run is when it is linearised: `at 0.3 [s]`, `at start`, `at steady`.
    pub(super) fn moment(&mut self, at: Option<&'a ast::Expr>, root: InstanceId) -> Moment {
        let Some(at) = at else {
            return Moment::Start;
        };
        if let ast::ExprKind::Reference(reference) = &at.kind {
            match reference.as_word() {
                Some("start") => return Moment::Start,
                Some("steady") => return Moment::Steady,
                Some(_) | None => {}
            }
        }
        let time = self.value(at, &Scope::new(root, Setting::Parameter));
        self.agree_time(&time, "a run is linearised at a time, found", root);
        Moment::At(time.id)
    }

    /// How a value is shown: what stands alone in the unit that it is declared with.
    pub(super) fn shown_quantity(&mut self, typed: &Typed) -> Quantity {
        let dimension = self.dimensions.resolve(&typed.dim).as_known();
        let usual = Quantity::usual(dimension.unwrap_or(Dimension::DIMENSIONLESS));
        let declared = quantity_of(&self.flat, typed.id).cloned();
        let known = declared.filter(|known| known.unit.text() != "1");
        known.unwrap_or(usual)
    }

    /// The ends of a band of frequencies in Hz.
    pub(super) fn band(&mut self, band: &'a ast::Range, root: InstanceId) -> (ExprId, ExprId) {
        let parameter = Scope::new(root, Setting::Parameter);
        let (from, to) = (
            self.value(&band.from, &parameter),
            self.value(&band.to, &parameter),
        );
        let rate = Typed {
            dim: Dim::NUMBER.divide(&Dim::known(Dimension::TIME)),
            ..from.clone()
        };
        self.agree(
            &rate,
            &from,
            "the ends of a band are frequencies, found",
            root,
        );
        let rate = Typed {
            span: to.span,
            ..rate
        };
        self.agree(
            &rate,
            &to,
            "the ends of a band are frequencies, found",
            root,
        );
        (from.id, to.id)
    }

    /// `in guide = slip, …`: the modes in which the linearised system is taken.
    pub(super) fn chosen_modes(
        &mut self,
        modes: &[(Reference, ast::Name)],
    ) -> Vec<(hyde_ir::AutomatonId, usize)> {
        let chosen = modes.iter();
        chosen
            .filter_map(|(name, mode)| self.mode_of(name, mode))
            .collect()
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
}
