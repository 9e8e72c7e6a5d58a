//! [`Model`]: the flat model while it is being built, with the tree of instances beside it.

use crate::Input;
use crate::bind::short;
use crate::dimension::{Demand, Dim, Dimensions};
use crate::instance::{Domain, InstanceId, Member, ParameterNotes, Scope, Typed, VariableNotes};
use crate::instantiate::InstanceTree;
use crate::names::{self, Names};
use crate::turns::{Sides, Turns};
use crate::zero::Zero;
use hyde_diag::{Code, Diagnostic, Diagnostics, InstancePath, MadeBy, Severity, Span};
use hyde_ir::{
    ClockId, ColumnId, Expr, ExprId, FlatModel, Id as _, ParamId, Quantity, VarId, Variable,
    VariableKind,
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
    /// Modifications with whether anything used them.
    pub(crate) modifications: Vec<(Span, String, bool)>,
    /// The instance that a modification with one word left was given to, by its number.
    pub(crate) modified: BTreeMap<usize, InstanceId>,
    /// The measures of the top so far, by name.
    pub(crate) measured_numbers: Vec<(&'a str, Typed)>,
    /// Effects to be put on instances, what they wrap and what they replace.
    pub(crate) hooks: Vec<crate::instantiate::Hook<'a>>,
    pub(crate) wraps: Vec<crate::wrap::Wrap<'a>>,
    pub(crate) replacements: Vec<crate::instantiate::Replacement<'a>>,
    /// The expressions of the first file as they were lowered, where somebody asks for them.
    pub(crate) lowered: Option<Vec<crate::meaning::Lowered>>,
    /// Whether effects are offered to what they fit on, and those that were.
    pub(crate) offering: bool,
    pub(crate) offers: Vec<crate::instantiate::Offer<'a>>,
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
    /// Classes that contain themselves, once reported.
    pub(crate) endless: Vec<&'a hyde_syntax::ast::Class>,
    /// The values that elements of parameters have now, once they are known.
    pub(crate) current_values: BTreeMap<(ParamId, usize), f64>,
    /// The functions whose calls are being replaced, the outermost first, and what is known of calls.
    pub(crate) calls: crate::call::Calls<'a>,
    /// The classes that the instance being made extends, by whatever way.
    pub(crate) extended: usize,
    /// A subscript met that keeps its `for` equation from being one equation over a range.
    pub(crate) needs_unrolling: bool,
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
            modifications: Vec::new(),
            modified: BTreeMap::new(),
            measured_numbers: Vec::new(),
            hooks: Vec::new(),
            wraps: Vec::new(),
            replacements: Vec::new(),
            lowered: None,
            offering: false,
            offers: Vec::new(),
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
            endless: Vec::new(),
            current_values: BTreeMap::new(),
            calls: crate::call::Calls::default(),
            extended: 0,
            needs_unrolling: false,
            diagnostics,
        }
    }

    pub(crate) fn report(&mut self, diagnostic: Diagnostic) {
        self.diagnostics.push(diagnostic);
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

    /// Demands that two dimensions agree, and reports it if they cannot.
    ///
    /// False where they are known to disagree; that is reported.
    pub(crate) fn agree(
        &mut self,
        a: &Typed,
        b: &Typed,
        what: &'static str,
        instance: InstanceId,
    ) -> bool {
        let sides = self.sides();
        let demand = Demand {
            what,
            spans: (a.span, b.span),
            instance,
            bare: (a.bare, b.bare),
            written: (self.bare_text(a), self.bare_text(b)),
            said: (sides.said(a), sides.said(b)),
            sides: (a.id, b.id),
        };
        let Self {
            dimensions,
            tree,
            parameters,
            flat,
            ..
        } = self;
        let found = dimensions.agree(&a.dim, &b.dim, demand, &|id| {
            in_scope(tree, parameters, flat, id)
        });
        let Some(diagnostic) = found.or_else(|| self.sides().lost_turn(a, b)) else {
            return true;
        };
        let error = diagnostic.severity == Severity::Error;
        let diagnostic = self.with_parts(diagnostic, (a.id, b.id));
        self.report(diagnostic);
        !error
    }

    /// Says what the names in two sides are, where one of them is more than a name. What was set in another file than that of
    /// the sides, as a parameter of a library's component, is where the mistake is.
    fn with_parts(&self, diagnostic: Diagnostic, sides: (ExprId, ExprId)) -> Diagnostic {
        let exprs = &self.flat.exprs;
        let written_in = diagnostic.labels.first().map(|label| label.span.file);
        let mut set: Vec<(&str, &Dim, Span)> = Vec::new();
        let mut named: Vec<(&str, &Dim, &Quantity)> = Vec::new();
        let composed = [sides.0, sides.1].into_iter().filter(|&side| {
            matches!(
                exprs[side],
                Expr::Unary(..) | Expr::Binary(..) | Expr::If(..)
            )
        });
        for id in exprs.below(&composed.collect::<Vec<_>>()) {
            let part = match exprs[id] {
                Expr::Param(param, _) => {
                    let own = &self.flat.parameters[param];
                    let (name, dim) = (own.name.as_str(), &self.parameters[param.index()].dim);
                    let span = own.origin.span;
                    let known = set.iter().any(|(known, ..)| *known == name);
                    if !known && !own.derived && Some(span.file) != written_in {
                        set.push((name, dim, span));
                    }
                    (name, dim, &own.quantity)
                }
                Expr::Var(var, _) => (
                    self.flat.variables[var].name.as_str(),
                    &self.variables[var.index()].dim,
                    &self.flat.variables[var].quantity,
                ),
                Expr::Const(_)
                | Expr::Time
                | Expr::Counter
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Unary(..)
                | Expr::Binary(..)
                | Expr::If(..)
                | Expr::NoEvent(_) => continue,
            };
            if !named.iter().any(|(name, ..)| *name == part.0) {
                named.push(part);
            }
        }
        let mut diagnostic = diagnostic;
        for (name, dim, span) in set.into_iter().rev() {
            if let Some(dimension) = self.dimensions.resolve(dim).as_known() {
                let text = format!(
                    "`{}` is {} here",
                    short(name),
                    crate::dimension::short(dimension)
                );
                diagnostic.labels.insert(0, hyde_diag::Label { span, text });
            }
        }
        let parts: Vec<String> = named
            .iter()
            .take(6)
            .filter_map(|(name, dim, quantity)| {
                let dimension = self.dimensions.resolve(dim).as_known()?;
                // In the unit it was declared in, as long as that says what it is.
                let declared = quantity.unit.text();
                let unit = match quantity.dimension == dimension && declared != "1" {
                    true => declared.to_owned(),
                    false => crate::dimension::short(dimension),
                };
                Some(format!("`{}` is {unit}", short(name)))
            })
            .collect();
        match parts.as_slice() {
            [] => diagnostic,
            _ => diagnostic.note(parts.join(", ")),
        }
    }

    /// A bare number as written, for a repair that gives it a unit.
    fn bare_text(&self, typed: &Typed) -> String {
        if typed.bare {
            self.input.sources.text(typed.span).to_owned()
        } else {
            String::new()
        }
    }

    /// Solves the dimensions that are still unknown, and reports what disagrees.
    pub(crate) fn solve_dimensions(&mut self) {
        let Self {
            dimensions,
            tree,
            parameters,
            flat,
            ..
        } = self;
        let found = dimensions.solve(&|id| in_scope(tree, parameters, flat, id));
        for (diagnostic, sides) in found {
            let diagnostic = self.with_parts(diagnostic, sides);
            self.report(diagnostic);
        }
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
        self.flat.variables.push(Variable {
            name,
            len: None,
            first: 1,
            kind,
            quantity: Quantity::number(),
            start: Vec::new(),
            fixed: false,
            start_given: false,
            freed: false,
            state: hyde_ir::StateChoice::Open,
            flow: false,
            boolean: false,
            input: false,
            trace: None,
            origin,
        })
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
        let diagnostic = Diagnostic::error(
            Code::UnknownName,
            format!("there is no `{word}` in {place}"),
        )
        .label(
            whole
                .parts
                .iter()
                .rev()
                .find(|part| part.name.text == word)
                .map_or(whole.span, |part| part.name.span),
            "not known",
        );
        let diagnostic = match names::nearest(word, known.iter().copied()) {
            _ if word == "Modelica" => {
                let help = hyde_syntax::instead_of(&whole.dotted());
                diagnostic.help(help.unwrap_or_default())
            }
            _ if word == "dt" => diagnostic.help("the derivative of `x` by the time is `der(x)`"),
            Some(near) => diagnostic.help(format!("did you mean `{near}`?")),
            None if known.is_empty() => diagnostic,
            None => diagnostic.help(format!("known here: {}", listed(&known))),
        };
        self.report(diagnostic);
    }
}

/// What a mere name means and is shown in: that of a variable or a parameter.
pub(crate) fn quantity_of(flat: &FlatModel, id: ExprId) -> Option<&Quantity> {
    if let Expr::Var(var, _) = flat.exprs[id] {
        return Some(&flat.variables[var].quantity);
    }
    if let Expr::Param(param, _) = flat.exprs[id] {
        return Some(&flat.parameters[param].quantity);
    }
    None
}

/// The path of an instance and its parameters with their dimensions, those of its parent after its own.
fn in_scope(
    tree: &InstanceTree<'_>,
    parameters: &[ParameterNotes<'_>],
    flat: &FlatModel,
    id: InstanceId,
) -> (InstancePath, Vec<(String, Dim)>) {
    let mut found = Vec::new();
    let chain = [Some(id), tree[id].parent];
    for instance in chain.into_iter().flatten() {
        for member in tree[instance].members.values() {
            if let Member::Parameter(param) = member {
                let name = &flat.parameters[*param].name;
                let dim = parameters[hyde_ir::Id::index(*param)].dim.clone();
                found.push((short(name).to_owned(), dim));
            }
        }
    }
    (tree[id].path.clone(), found)
}

/// A few names for a message.
pub(crate) fn listed(names: &[&str]) -> String {
    let mut sorted: Vec<&str> = names.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let shown: Vec<String> = sorted
        .iter()
        .take(8)
        .map(|name| format!("`{name}`"))
        .collect();
    let more = if sorted.len() > 8 { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}
