//! `max`, `min`, `rms`, `mean`, `first`, `last` of a signal over a run.

use crate::instance::{Scope, Setting, Typed};
use crate::model::Model;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::VariableKind;
use hyde_ir::flat::{Reduction, ReductionKind};
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    /// A reduction of a signal over the run, in a measure or expectation.
    pub(super) fn reduction(
        &mut self,
        name: &str,
        args: &[&'a Expr],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        let Some([a]) = self.exactly(name, args, span) else {
            return self.poison(span);
        };
        if scope.setting != Setting::Measure {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` of one value has a meaning over a whole run only"),
                )
                .label(span, "not in a measure or expectation")
                .help("write it in `measure` or `expect`"),
            );
            return self.poison(span);
        }
        let kind = match name {
            "max" => ReductionKind::Max,
            "min" => ReductionKind::Min,
            "rms" => ReductionKind::Rms,
            "mean" => ReductionKind::Mean,
            "first" => ReductionKind::First,
            _ => ReductionKind::Last,
        };
        let inner = self.value(a, &scope.with(Setting::Report));
        let number = self.flat.experiment.reductions.len();
        let text = format!("{name}({})", hyde_syntax::format_expression(a));
        let var = self.add_variable(
            scope.instance,
            text,
            VariableKind::Reduction(number),
            inner.dim.clone(),
            span,
            MadeBy::Experiment,
        );
        self.flat.experiment.reductions.push(Reduction {
            kind,
            value: inner.id,
            var,
        });
        let id = self.flat.exprs.var(var);
        self.typed(id, inner.dim, span)
    }
}
