//! [`Model`]: the flat model while it is being built, with the tree of instances beside it.

pub(crate) mod bind;
pub(crate) mod call;
pub(crate) mod field;
pub(crate) mod lower;
pub(crate) mod structural;
pub(crate) mod together;

mod agreement;

use crate::dimension::Dim;
use crate::dimension::constraints::Dimensions;
use crate::input::Input;
use crate::instance::{Domain, InstanceId, ParameterNotes, Scope, Typed, VariableNotes};
use crate::instantiate::{InstanceTree, Making, Wrap};
use crate::model::together::Together;
use crate::names::Names;
use crate::refusals::names as refused;
use crate::turns::{Sides, Turns};
use crate::zero::Zero;
use call::Calls;
use hyde_diag::{Diagnostic, Diagnostics, MadeBy, Span};
use hyde_ir::{
    ClockId, ColumnId, ExprId, FlatModel, ParamId, Quantity, VarId, Variable, VariableKind,
};
use hyde_syntax::ast::Reference;
use std::collections::{BTreeMap, BTreeSet};

/// Everything flatten knows so far.
pub(crate) struct Model<'a, 'd> {
    pub(crate) input: &'a Input<'a>,
    pub(crate) names: Names<'a>,
    pub(crate) flat: FlatModel,
    pub(crate) tree: InstanceTree<'a>,
    /// Beside `flat.variables`.
    pub(crate) variables: Vec<VariableNotes<'a>>,
    /// Beside `flat.parameters`.
    pub(crate) parameters: Vec<ParameterNotes<'a>>,
    pub(crate) domains: Vec<Domain<'a>>,
    pub(crate) dimensions: Dimensions,
    /// What instantiation notes; of it, later passes tell what nothing used.
    pub(crate) making: Making<'a>,
    /// The measures of the top so far, by name.
    pub(crate) measured_numbers: Vec<(&'a str, Typed)>,
    /// What effects wrap.
    pub(crate) wraps: Vec<Wrap<'a>>,
    /// The expressions of the first file as they were lowered, where somebody asks for them.
    pub(crate) lowered: Option<Vec<crate::meaning::Lowered>>,
    /// The sites where a law may act, each with its instance.
    pub(crate) law_sites: Vec<(InstanceId, crate::law_sites::LawSite)>,
    /// Variables whose equations recorded columns take the place of.
    pub(crate) replays: Vec<crate::experiment::Replay<'a>>,
    /// Connectors of effects with those of their hosts: they join connection sets after everything written.
    pub(crate) joined: Vec<crate::connect::Connection>,
    /// Connected connectors and signals, in the order written.
    pub(crate) connections: Vec<crate::connect::Connection>,
    /// Clocks that tick at events: the condition and the variable that is the time of the last tick.
    pub(crate) event_clocks: BTreeMap<ClockId, (ExprId, VarId)>,
    /// The numbers that the clocks of the instances have since those that tick at events are gone; none before that.
    pub(crate) kept_clocks: Option<BTreeMap<ClockId, ClockId>>,
    /// Held variables by clock and source.
    pub(crate) held: BTreeMap<(ClockId, VarId), VarId>,
    /// Delayed variables by what is delayed and the time.
    pub(crate) delayed: BTreeMap<(ExprId, ExprId), VarId>,
    /// Column variables: linear and held.
    pub(crate) column_variables: BTreeMap<ColumnId, (VarId, VarId)>,
    /// Parameters that stand for the first value of a column or its mean.
    pub(crate) column_values: BTreeMap<String, ParamId>,
    /// Names whose declaration has an unknown type: their uses are no mistake of their own.
    pub(crate) undeclared: BTreeSet<&'a str>,
    /// Continuous variables that a clocked part computes: that is told, and their uses are no mistake of their own.
    pub(crate) misplaced: BTreeSet<VarId>,
    /// The values that elements of parameters have now, once they are known.
    pub(crate) current_values: BTreeMap<(ParamId, usize), f64>,
    /// The functions whose calls are being replaced, the outermost first, and what is known of calls.
    pub(crate) calls: Calls<'a>,
    /// Whether what is lowered now stands for many elements at once.
    pub(crate) together: Together,
    pub(crate) diagnostics: &'d mut Diagnostics,
}

impl<'a, 'd> Model<'a, 'd> {
    pub(crate) fn new(input: &'a Input<'a>, diagnostics: &'d mut Diagnostics) -> Self {
        Self {
            input,
            names: Names::new(input),
            flat: FlatModel::default(),
            tree: InstanceTree::default(),
            variables: Vec::new(),
            parameters: Vec::new(),
            domains: Vec::new(),
            dimensions: Dimensions::default(),
            making: Making::default(),
            measured_numbers: Vec::new(),
            wraps: Vec::new(),
            lowered: None,
            law_sites: Vec::new(),
            replays: Vec::new(),
            joined: Vec::new(),
            connections: Vec::new(),
            event_clocks: BTreeMap::new(),
            kept_clocks: None,
            held: BTreeMap::new(),
            delayed: BTreeMap::new(),
            column_variables: BTreeMap::new(),
            column_values: BTreeMap::new(),
            undeclared: BTreeSet::new(),
            misplaced: BTreeSet::new(),
            current_values: BTreeMap::new(),
            calls: Calls::default(),
            together: Together::No,
            diagnostics,
        }
    }

    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
    }

    pub(crate) fn report_any(&mut self, doubt: Option<Diagnostic>) {
        if let Some(doubt) = doubt {
            self.report(doubt);
        }
    }

    /// The clock of an instance, if it still has one.
    pub(crate) fn clock_of(&self, instance: InstanceId) -> Option<ClockId> {
        let declared = self.tree[instance].clock?;
        match &self.kept_clocks {
            Some(kept) => kept.get(&declared).copied(),
            None => Some(declared),
        }
    }

    pub(crate) fn dim(&self, var: VarId) -> Dim {
        self.variables[hyde_ir::Id::index(var)].dim.clone()
    }

    pub(crate) fn notes(&self, var: VarId) -> &VariableNotes<'a> {
        &self.variables[hyde_ir::Id::index(var)]
    }

    /// What tells how the sides of an operation are written.
    pub(crate) fn sides(&self) -> Sides<'_> {
        Sides::new(self.input.sources, &self.flat)
    }

    /// Adds a variable that the compiler makes.
    pub(crate) fn add_variable(
        &mut self,
        instance: InstanceId,
        name: String,
        kind: VariableKind,
        dim: Dim,
        span: Span,
        made_by: MadeBy,
    ) -> VarId {
        self.variables.push(VariableNotes {
            instance,
            dim,
            binding: None,
            start: None,
            bounds: [None, None],
            integer: false,
            difference: false,
            fixed_elements: Vec::new(),
            field: None,
        });
        let origin = self.tree.origin(instance, span).made_by(made_by);
        let variable = Variable::new(name, kind, Quantity::number(), origin);
        self.flat.variables.push(variable)
    }

    /// A placeholder for what could not be lowered; its mistake is already reported.
    pub(crate) fn poison(&mut self, span: Span) -> Typed {
        let id = self.flat.exprs.constant(0.0);
        Typed {
            id,
            dim: Dim::Any,
            truth: false,
            bare: false,
            turns: Turns::Plain,
            zero: Zero::Open,
            difference: None,
            span,
        }
    }

    pub(crate) fn typed(&self, id: ExprId, dim: Dim, span: Span) -> Typed {
        Typed {
            id,
            dim,
            truth: false,
            bare: false,
            turns: Turns::Plain,
            zero: Zero::Open,
            difference: None,
            span,
        }
    }

    /// "nothing is called that", with the nearest name there is.
    pub(crate) fn unknown_name(
        &mut self,
        scope: &Scope<'a>,
        at: InstanceId,
        word: &str,
        whole: &Reference,
    ) {
        // A declaration whose type is unknown is reported there, not at every use.
        if self.undeclared.contains(word) {
            return;
        }
        let mut known: Vec<&str> = self.tree[at].members.keys().copied().collect();
        let mut outer = self.tree[at].outer;
        while let Some(instance) = outer {
            known.extend(self.tree[instance].members.keys().copied());
            outer = self.tree[instance].outer;
        }
        if at == scope.instance {
            known.extend(scope.locals.iter().map(|(name, _)| *name));
            known.extend(scope.counters.iter().map(|(name, _)| *name));
            known.extend(["time", "pi"]);
            if scope.records {
                known.extend(self.input.records.keys().map(String::as_str));
            }
        }
        let instance = &self.tree[at];
        let place = match (instance.path.as_str(), instance.class.name.text.as_str()) {
            ("", class) => format!("model `{class}`"),
            (path, class) => format!("`{path}` ({class})"),
        };
        let mut parts = whole.parts.iter().rev();
        let part = parts.find(|part| part.name.text == word);
        let here = part.map_or(whole.span, |part| part.name.span);
        self.report(refused::unknown_name((word, here), &place, whole, &known));
    }
}
